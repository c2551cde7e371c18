#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "uplift/base/error.h"
#include "uplift/math/linalg.h"
#include "uplift/mesh/cells.h"
#include "uplift/mesh/half_space.h"

namespace uplift {

/// One cell of a mesh: its block and its number inside the block.
struct CellId {
  int block = 0, index = 0;
  auto operator<=>(const CellId&) const = default;  // NOLINT(modernize-use-nullptr): false alarm of clang-tidy 14
};

/// All cells of one type.
struct CellBlock {
  Cell cell = Cell::point;
  std::vector<int> nodes;                      // cell after cell
  std::vector<std::int64_t> file_number = {};  // of each cell in the mesh file; empty for a mesh from elsewhere
  int count() const { return static_cast<int>(nodes.size()) / info(cell).nodes; }
  std::span<const int> operator[](int index) const {
    const auto n = static_cast<std::size_t>(info(cell).nodes);
    return {nodes.data() + static_cast<std::size_t>(index) * n, n};
  }
};

/// A named set. Cells of one dimension (a physical group of Gmsh, a family's group of MED); nodes only for groups of nodes.
struct Group {
  int dimension = 0;          // of its cells; 0 for nodes
  std::vector<CellId> cells;  // ascending
  std::vector<int> nodes;     // of a group of nodes, ascending
};

/// What a plane leaves of a cell that it cuts (mesh/cut.h): the cell's nodes and shape functions, integrated over one side of the plane
/// (rule_of_part, mesh/parts.h).
struct CellPart {
  int limits = 0;               // Mesh::limits that hold the part
  Cell piece = Cell::point;     // it is drawn as cells of this type
  double tolerance = 0;         // m: corners of the cell so near a limit count as on it
  std::vector<int> nodes = {};  // of the pieces: nodes of the mesh, also followers
};

/// The parts of the cells of a mesh. A part has a number, which it keeps while the numbers of cells change.
class CellParts {
 public:
  bool empty() const { return count_ == 0; }
  const CellPart* find(CellId id) const;  // null: the cell is whole
  int number(CellId id) const;            // of the cell's part, -1: none
  CellPart& operator[](CellId id);        // made when it is not there
  std::vector<CellId> cells() const;      // that have parts, ascending
  void erase(CellId id);
  /// Room for so many more.
  void reserve(std::size_t more) { parts_.reserve(parts_.size() + more); }
  /// After cells have got new numbers: `now` has those of each block, less than 0 for none. Cells with parts must be there.
  void renumber(const std::vector<std::vector<int>>& now);

 private:
  std::vector<std::vector<int>> number_;  // of blocks and cells as far as there are parts
  std::vector<CellPart> parts_;
  int count_ = 0;
};

/// A node of drawings alone: it moves as these nodes with these weights.
struct Follower {
  int node = 0;
  std::vector<std::pair<int, double>> of;
};

/// Nodes, cells, named groups. In plane models z = 0. A value: checked by `check_mesh`, never half valid.
struct Mesh {
  int dimension = 3;              // 2: all z equal
  std::vector<Vec3> nodes;        // m
  std::vector<CellBlock> blocks;  // at most one per type
  std::map<std::string, Group> groups;
  CellParts parts = {};                             // of cells that are filled in part; all others are whole
  std::vector<std::vector<HalfSpace>> limits = {};  // of parts
  std::vector<Follower> followers = {};             // used by the pieces of parts
  std::vector<std::string> emptied = {};            // groups of which nothing is left, for messages
  std::vector<int> places = {};     // of the first nodes, ascending: where each stood before some were removed; empty: where it stands
  CellBlock& block(Cell cell);      // made when it is not there (references to other blocks end then)
  int find_block(Cell cell) const;  // -1 when absent
  std::span<const int> cell(CellId id) const { return blocks[static_cast<std::size_t>(id.block)][id.index]; }
  Cell type(CellId id) const { return blocks[static_cast<std::size_t>(id.block)].cell; }
  int cells() const;
  const CellPart* part(CellId id) const;  // null: the cell is whole
  int number(int node) const;             // by which users call it: from 1 on in the order of the file, then the nodes that were added
};

/// Nodes of a group: of its cells, or its own; ascending, each once.
std::vector<int> nodes_of(const Mesh& mesh, const Group& group);

/// Length [m], area [m2] or volume [m3] of the cell with straight edges between its corners; 0 for a point. Negative when a volume, or a
/// surface in a plane mesh, is inside out.
double signed_size(const Mesh& mesh, CellId id);

/// "cell 12 of group "soil_1" (hex8 at (1, 2, -3))" for messages: counted from 1 in the first group that has it, else in its block. For a
/// cell from a file its number there follows the type: "(hex8, number 571 in the mesh file, at (1, 2, -3))".
std::string describe_cell(const Mesh& mesh, CellId id);

/// Throws InputError unless the mesh is whole: blocks and groups refer to nodes and cells that are there, groups hold cells of one
/// dimension in ascending order, coordinates are finite (in a plane mesh all z equal), no cell has a node twice, every cell has a
/// positive size (see signed_size; less than 1e-12 of longest edge to the power of the dimension counts as zero), and the Jacobian of every
/// cell of full dimension is positive where the program uses it (see least_jacobian).
void check_mesh(const Mesh& mesh, const Where& where);

}  // namespace uplift
