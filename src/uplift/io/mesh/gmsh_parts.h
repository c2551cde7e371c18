#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "uplift/io/mesh/draft.h"
#include "uplift/io/mesh/gmsh_cursor.h"
#include "uplift/io/mesh/gmsh_types.h"

// The parts of a .msh file, common to its versions and of each.
namespace uplift {

/// Physical groups by dimension and tag; a negative tag of Gmsh (reversed orientation) is the same group.
class GmshGroups {
 public:
  /// Takes a name of $PhysicalNames.
  void name(int dimension, int tag, std::string name);
  /// Number of the group, made when it is new; -1 for tag 0, which means none.
  int find(int dimension, int tag);
  void add(int group, CellId cell) { groups_[static_cast<std::size_t>(group)].cells.push_back(cell); }
  std::vector<DraftGroup>& groups() { return groups_; }

 private:
  std::map<std::pair<int, int>, int> numbers_;
  std::vector<DraftGroup> groups_;
};

/// Position of nodes by their tag: a table when tags are dense, a sorted list when not.
class GmshNodes {
 public:
  /// Throws InputError at the cursor when a tag occurs twice.
  GmshNodes(const std::vector<std::int64_t>& tags, const GmshCursor& at);
  /// -1 when there is no such node.
  int find(std::int64_t tag) const;

 private:
  std::vector<int> table_;
  std::vector<std::pair<std::int64_t, int>> sorted_;
};

/// Nodes as read.
struct GmshNodeList {
  std::vector<std::int64_t> tags;
  std::vector<Vec3> nodes;
};

/// Groups of each entity of the geometry (format 4).
using GmshEntities = std::map<std::pair<int, int>, std::vector<int>>;

GmshNodeList read_gmsh_nodes_2(GmshCursor at, bool parametric);
GmshNodeList read_gmsh_nodes_4(GmshCursor at);
GmshEntities read_gmsh_entities(GmshCursor at, bool partitioned, GmshGroups& groups);
void read_gmsh_elements_2(GmshCursor at, const GmshNodes& nodes, GmshGroups& groups, Mesh& mesh);
void read_gmsh_elements_4(GmshCursor at, const GmshNodes& nodes, const GmshEntities& entities, GmshGroups& groups, Mesh& mesh);

/// The type of element with this number. Throws InputError at the cursor when the program has no such cells.
const GmshType& wanted_gmsh_type(int number, const GmshCursor& at);
/// Appends a cell: reads its tags as text or bytes (of 8 when `wide`), looks them up and orders them.
void read_gmsh_cell(GmshCursor& at, bool wide, const GmshType& type, const GmshNodes& nodes, CellBlock& block);

}  // namespace uplift
