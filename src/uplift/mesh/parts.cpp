#include "uplift/mesh/parts.h"

#include <algorithm>
#include <cmath>

#include "uplift/mesh/cell_shapes.h"
#include "uplift/mesh/index.h"

namespace uplift {
namespace {

/// The nodes of the pieces: a node of the cell where one of its shape functions is 1, else a follower.
class Followers {
 public:
  explicit Followers(Mesh& mesh) : mesh_(mesh) {}
  int node_at(Cell cell, std::span<const int> nodes, const LocalCoordinates& find_local, const Vec3& place) {
    const CellShape shape = cell_shape(cell, find_local(place));
    Follower follower;
    std::vector<std::pair<int, long>> key;
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      if (shape.value[a] > 1 - 1e-9) return nodes[a];
      if (std::abs(shape.value[a]) < 1e-12) continue;
      follower.of.emplace_back(nodes[a], shape.value[a]);
      key.emplace_back(nodes[a], std::lround(1e9 * shape.value[a]));
    }
    std::ranges::sort(key);
    const auto [known, is_new] = known_.try_emplace(std::move(key), static_cast<int>(mesh_.nodes.size()));
    if (is_new) {
      follower.node = known->second;
      mesh_.nodes.push_back(place);
      mesh_.followers.push_back(std::move(follower));
    }
    return known->second;
  }

 private:
  Mesh& mesh_;
  std::map<std::vector<std::pair<int, long>>, int> known_;
};

/// Whether a simplex of full dimension is numbered the wrong way round.
bool is_inside_out(const Mesh& mesh, const ClippedCell::Piece& piece) {
  const std::vector<Vec3>& x = piece.corners;
  if (piece.cell == Cell::tri3 && mesh.dimension == 2) return cross(x[1] - x[0], x[2] - x[0]).z() < 0;
  return piece.cell == Cell::tet4 && (x[3] - x[0]).dot(cross(x[1] - x[0], x[2] - x[0])) < 0;
}

}  // namespace

void add_pieces(const std::map<CellId, std::vector<ClippedCell::Piece>>& pieces_of, Mesh& mesh) {
  Followers followers(mesh);
  for (const auto& [id, pieces] : pieces_of) {
    const std::vector<int> nodes(mesh.cell(id).begin(), mesh.cell(id).end());
    std::vector<Vec3> corners;
    for (const int node : nodes) corners.push_back(mesh.nodes[at(node)]);
    const LocalCoordinates find_local(mesh.type(id), corners);
    std::vector<std::pair<Vec3, int>> known;  // pieces share their corners
    const auto node_at = [&](const Vec3& place) {
      for (const auto& [there, node] : known)
        if (there == place) return node;
      return known.emplace_back(place, followers.node_at(mesh.type(id), nodes, find_local, place)).second;
    };
    for (ClippedCell::Piece piece : pieces) {
      if (is_inside_out(mesh, piece)) std::swap(piece.corners[0], piece.corners[1]);
      CellPart::Piece& made = mesh.parts.at(id).pieces.emplace_back(CellPart::Piece{piece.cell});
      for (const Vec3& corner : piece.corners) made.nodes.push_back(node_at(corner));
    }
  }
}

std::vector<bool> bare_nodes(const Mesh& mesh) {
  std::vector<bool> bare(mesh.nodes.size(), false), filled(mesh.nodes.size(), false);
  for (int b = 0; b < static_cast<int>(mesh.blocks.size()); ++b)
    for (int i = 0; i < mesh.blocks[at(b)].count(); ++i) {
      const CellPart* part = mesh.part({b, i});
      for (const int node : mesh.blocks[at(b)][i]) (part ? bare : filled)[at(node)] = true;
      if (part)
        for (const CellPart::Piece& piece : part->pieces)
          for (const int node : piece.nodes) filled[at(node)] = true;
    }
  for (std::size_t node = 0; node < bare.size(); ++node) bare[node] = bare[node] && !filled[node];
  return bare;
}

Mesh drawn_mesh(const Mesh& mesh) {
  Mesh drawn;
  drawn.dimension = mesh.dimension;
  drawn.nodes = mesh.nodes;
  std::vector<std::vector<std::vector<CellId>>> replaced;
  for (int b = 0; b < static_cast<int>(mesh.blocks.size()); ++b) {
    const CellBlock& block = mesh.blocks[at(b)];
    replaced.emplace_back(at(block.count()));
    for (int i = 0; i < block.count(); ++i) {
      const auto add = [&](Cell cell, std::span<const int> nodes) {
        CellBlock& into = drawn.block(cell);
        replaced.back()[at(i)].push_back({drawn.find_block(cell), into.count()});
        into.nodes.insert(into.nodes.end(), nodes.begin(), nodes.end());
      };
      if (const CellPart* part = mesh.part({b, i}))
        for (const CellPart::Piece& piece : part->pieces) add(piece.cell, piece.nodes);
      else
        add(block.cell, block[i]);
    }
  }
  for (const auto& [name, group] : mesh.groups) {
    Group& made = drawn.groups[name];
    made = {group.dimension, {}, group.nodes};
    for (const CellId id : group.cells)
      made.cells.insert(made.cells.end(), replaced[at(id.block)][at(id.index)].begin(), replaced[at(id.block)][at(id.index)].end());
    std::ranges::sort(made.cells);
  }
  return drawn;
}

}  // namespace uplift
