#pragma once
#include <span>
#include <vector>

#include "uplift/mesh/mesh.h"

// Cells that are filled in part, as they are drawn and as users see them.
namespace uplift {

/// Corners of the pieces of parts, until they have nodes.
struct PieceCorners {
  struct Range {
    std::size_t first = 0, count = 0;
  };
  std::vector<Vec3> all = {};    // m
  std::vector<Range> part = {};  // those of each part, in the order of the parts' numbers
  std::span<const Vec3> of(int number) const {
    const Range& range = part[static_cast<std::size_t>(number)];
    return std::span(all).subspan(range.first, range.count);
  }
};

/// Gives the parts of a mesh the nodes of their pieces, with followers at the corners that are no nodes.
void add_pieces(const PieceCorners& corners, Mesh& mesh);

/// The mesh as it is drawn: parts are replaced by their pieces. Nodes keep their numbers.
Mesh drawn_mesh(const Mesh& mesh);

/// Nodes that stand outside of all cells that use them: doubles beyond the plane with nothing of their side around them.
std::vector<bool> bare_nodes(const Mesh& mesh);

}  // namespace uplift
