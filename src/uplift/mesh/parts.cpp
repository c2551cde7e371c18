#include "uplift/mesh/parts.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>

#include "uplift/mesh/cell_shapes.h"
#include "uplift/mesh/index.h"
#include "uplift/mesh/placed_cell.h"

namespace uplift {
namespace {

/// The nodes of the pieces: a node of the cell where one of its shape functions is 1, else a follower. Followers are known by their nodes
/// and weights; they stand in the order in which they are met.
class Followers {
 public:
  explicit Followers(Mesh& mesh) : mesh_(mesh), table_(1024, -1) {}

  int node_at(std::span<const int> nodes, const CellShape& shape, const Vec3& place) {
    assert(nodes.size() <= max_corners);
    std::array<Term, max_corners> key;
    std::size_t count = 0;
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      if (shape.value[a] > 1 - 1e-9) return nodes[a];
      if (std::abs(shape.value[a]) < 1e-12) continue;
      const Term term{nodes[a], std::lround(1e9 * shape.value[a])};
      std::size_t k = count++;
      for (; k > 0 && term < key[k - 1]; --k) key[k] = key[k - 1];  // ascending
      key[k] = term;
    }
    const int found = find(std::span(key).first(count));
    if (found < static_cast<int>(mesh_.followers.size())) return mesh_.followers[at(found)].node;
    Follower& follower = mesh_.followers.emplace_back();
    follower.node = static_cast<int>(mesh_.nodes.size());
    follower.of.reserve(count);
    for (std::size_t a = 0; a < nodes.size(); ++a)
      if (std::abs(shape.value[a]) >= 1e-12) follower.of.emplace_back(nodes[a], shape.value[a]);
    mesh_.nodes.push_back(place);
    return follower.node;
  }

 private:
  using Term = std::pair<int, long>;  // a node, 1e9 times its weight

  static std::size_t hash(std::span<const Term> key) {
    std::uint64_t sum = key.size();
    for (const auto& [node, weight] : key)
      for (const std::uint64_t word : {static_cast<std::uint64_t>(node), static_cast<std::uint64_t>(weight)})
        sum = (sum ^ word) * 0x9E3779B97F4A7C15U, sum ^= sum >> 29U;
    return sum;
  }
  /// The number of a follower; its key is kept when it is a new one.
  int find(std::span<const Term> key) {
    if (2 * first_.size() > table_.size()) grow();
    for (std::size_t slot = hash(key) & (table_.size() - 1);; slot = (slot + 1) & (table_.size() - 1)) {
      if (table_[slot] < 0) {
        table_[slot] = static_cast<int>(first_.size() - 1);
        terms_.insert(terms_.end(), key.begin(), key.end());
        first_.push_back(terms_.size());
        return table_[slot];
      }
      if (std::ranges::equal(key_of(table_[slot]), key)) return table_[slot];
    }
  }
  void grow() {
    table_.assign(2 * table_.size(), -1);
    for (int follower = 0; follower + 1 < static_cast<int>(first_.size()); ++follower) {
      std::size_t slot = hash(key_of(follower)) & (table_.size() - 1);
      while (table_[slot] >= 0) slot = (slot + 1) & (table_.size() - 1);
      table_[slot] = follower;
    }
  }
  std::span<const Term> key_of(int follower) const {
    return std::span(terms_).subspan(first_[at(follower)], first_[at(follower) + 1] - first_[at(follower)]);
  }

  Mesh& mesh_;
  std::vector<Term> terms_;               // keys of the followers, one after another
  std::vector<std::size_t> first_ = {0};  // where each begins, and the end of the last one
  std::vector<int> table_;                // numbers of followers by the hash of their key; -1: free. A power of two, at most half full
};

/// Whether a simplex of full dimension is numbered the wrong way round.
bool is_inside_out(int dimension, Cell piece, std::span<const Vec3> x) {
  if (piece == Cell::tri3 && dimension == 2) return cross(x[1] - x[0], x[2] - x[0]).z() < 0;
  return piece == Cell::tet4 && (x[3] - x[0]).dot(cross(x[1] - x[0], x[2] - x[0])) < 0;
}

}  // namespace

void add_pieces(std::vector<std::vector<Vec3>> corners, Mesh& mesh) {
  Followers followers(mesh);
  std::vector<std::pair<Vec3, int>> known;  // pieces share their corners
  std::array<Vec3, max_corners> places;
  for (const CellId id : mesh.parts.cells()) {
    const std::span<const int> nodes = mesh.cell(id);
    for (std::size_t a = 0; a < nodes.size(); ++a) places[a] = mesh.nodes[at(nodes[a])];
    const PlacedCell cell(mesh.type(id), std::span(places).first(nodes.size()));
    known.clear();
    for (std::size_t a = 0; a < nodes.size(); ++a) known.emplace_back(places[a], nodes[a]);
    const auto node_at = [&](const Vec3& place) {
      for (const auto& [there, node] : known)
        if (there[0] == place[0] && there[1] == place[1] && there[2] == place[2]) return node;
      const int node = followers.node_at(nodes, cell_shape(cell.type(), cell.local(place)), place);
      return known.emplace_back(place, node).second;
    };
    const int number = mesh.parts.number(id);
    CellPart& part = mesh.parts.numbered(number);
    const std::vector<Vec3> all = std::move(corners[at(number)]);  // gives its memory to what follows
    const auto n = at(info(part.piece).nodes);
    part.nodes.reserve(all.size());
    for (std::size_t first = 0; first < all.size(); first += n) {
      const std::span<const Vec3> piece = std::span(all).subspan(first, n);
      const bool turned = is_inside_out(mesh.dimension, part.piece, piece);
      for (std::size_t k = 0; k < n; ++k) part.nodes.push_back(node_at(piece[turned && k < 2 ? 1 - k : k]));
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
        for (const int node : part->nodes) filled[at(node)] = true;
    }
  for (std::size_t node = 0; node < bare.size(); ++node) bare[node] = bare[node] && !filled[node];
  return bare;
}

Mesh drawn_mesh(const Mesh& mesh) {
  Mesh drawn;
  drawn.dimension = mesh.dimension;
  drawn.nodes = mesh.nodes;
  struct Drawn {
    int block, first, count;  // cells of the drawn mesh
  };
  std::vector<std::vector<Drawn>> drawn_as;
  for (int b = 0; b < static_cast<int>(mesh.blocks.size()); ++b) {
    const CellBlock& block = mesh.blocks[at(b)];
    std::vector<Drawn>& of_block = drawn_as.emplace_back();
    of_block.reserve(at(block.count()));
    for (int i = 0; i < block.count(); ++i) {
      const CellPart* part = mesh.part({b, i});
      const std::span<const int> nodes = part ? std::span<const int>(part->nodes) : block[i];
      if (nodes.empty()) {
        of_block.push_back({0, 0, 0});
        continue;
      }
      CellBlock& into = drawn.block(part ? part->piece : block.cell);
      const int first = into.count();
      into.nodes.insert(into.nodes.end(), nodes.begin(), nodes.end());
      of_block.push_back({drawn.find_block(into.cell), first, into.count() - first});
    }
  }
  for (const auto& [name, group] : mesh.groups) {
    Group& made = drawn.groups[name];
    made = {group.dimension, {}, group.nodes};
    for (const CellId id : group.cells) {
      const auto [block, first, count] = drawn_as[at(id.block)][at(id.index)];
      for (int k = first; k < first + count; ++k) made.cells.push_back({block, k});
    }
    std::ranges::sort(made.cells);
  }
  return drawn;
}

}  // namespace uplift
