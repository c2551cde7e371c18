#pragma once
#include <array>
#include <string>
#include <vector>

#include "uplift/mesh/mesh.h"

// What is drawn of a mesh.
namespace uplift {

struct MeshOutline {
  struct Part {
    std::string name;                     // of the group
    std::vector<std::vector<int>> lines;  // nodes along its boundary, the group on the left
  };
  std::vector<Part> parts;
  std::vector<int> nodes;                 // of all lines, ascending, each once
  std::vector<std::array<int, 2>> edges;  // of all cells, each once; empty when there are too many cells
};

/// Boundaries of groups of cells of a plane mesh. Of straight stretches only every n-th node is taken, so that there are about `most_nodes`
/// besides the corners. Edges of all cells come with at most `most_cells` cells.
MeshOutline outline_of(const Mesh& mesh, const std::vector<std::string>& groups, int most_nodes, int most_cells);

}  // namespace uplift
