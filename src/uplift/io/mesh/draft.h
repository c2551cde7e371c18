#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "uplift/base/error.h"
#include "uplift/mesh/mesh.h"

// What the readers of mesh files share: from nodes, cells and groups as a file knows them to a Mesh.
namespace uplift {

/// A group as a file knows it: one name may stand for cells of several dimensions and for nodes as well.
struct DraftGroup {
  static constexpr int of_nodes = -1;
  std::string name;
  int dimension = 0;          // of its cells, or of_nodes
  std::vector<CellId> cells;  // any order, repetitions allowed
  std::vector<int> nodes;     // when of_nodes
};

/// Entities of Gmsh and families of MED may be in so many groups. Without a limit a small file could list a million cells in each of a
/// million groups.
inline constexpr std::size_t most_groups = 100;

/// Makes a mesh of what was read (nodes and blocks of `parts`; its groups and dimension are set here).
/// - Nodes that no cell uses (centres of arcs) are dropped, unless a group of nodes names them.
/// - The mesh is plane (dimension 2) when it has no volume cells and all z are equal.
/// - Volumes, and surfaces of a plane mesh, whose nodes run the wrong way round are mirrored: the order of nodes is a convention of the
///   writing program, and programs that write MED files do not agree on it. Surfaces and lines in space keep their sense.
/// - Groups of equal name and dimension are merged. A name of several dimensions gets the dimension ("base_1d", "base_2d"); a group of
/// nodes
///   that is called like a group of cells becomes "NAME_nodes".
/// Throws InputError at `where` when there are no cells or when such a name is taken.
Mesh finish_mesh(Mesh parts, std::vector<DraftGroup> groups, const Where& where);

/// Nodes of the mirror image: its node k is node mirrored_nodes(cell)[k]. The cell occupies the same space with its normal, or the sign of
/// its volume, reversed; a symmetric permutation. Empty for points and lines.
std::span<const int> mirrored_nodes(Cell cell);

/// A name as UTF-8 without white space at its ends: text that is not UTF-8 is taken as Latin-1, as older programs write it.
std::string name_as_utf8(std::string_view text);

}  // namespace uplift
