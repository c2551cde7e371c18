#include "uplift/mesh/parts.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "uplift/mesh/clip.h"
#include "uplift/mesh/index.h"
#include "uplift/mesh/placed_cell.h"

namespace uplift {
namespace {

/// The nodes of the pieces: a node of the cell where one of its shape functions is 1, else a follower. Followers are known by their nodes
/// and weights; they stand in the order in which they are met. They are chained at their lowest node, so neighbours in the mesh are
/// neighbours in memory.
class Followers {
 public:
  /// `expected`: about as many; more may come.
  Followers(Mesh& mesh, std::size_t expected) : mesh_(mesh), head_(mesh.nodes.size(), -1) {
    mesh_.nodes.reserve(mesh_.nodes.size() + expected);
    mesh_.followers.reserve(expected);
    known_.reserve(expected);
  }

  /// Room for what the other cells need, if they need as much as those that are done. Lists that grow would be written several times.
  void expect(std::size_t done, std::size_t cells) {
    const double more = 1.05 * static_cast<double>(cells - done) / static_cast<double>(done);
    const auto make_room = [&](auto& list, std::size_t made) {
      list.reserve(list.size() + static_cast<std::size_t>(more * static_cast<double>(made)));
    };
    make_room(mesh_.nodes, known_.size());
    make_room(mesh_.followers, known_.size());
    make_room(known_, known_.size());
    make_room(terms_, terms_.size());
  }

  int node_at(std::span<const int> nodes, const std::array<double, max_corners>& share, const Vec3& place) {
    assert(nodes.size() <= max_corners);
    std::array<Term, max_corners> key;
    std::size_t count = 0;
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      if (share[a] > 1 - 1e-9) return nodes[a];
      if (std::abs(share[a]) < 1e-12) continue;
      const Term term{nodes[a], std::lround(1e9 * share[a])};
      std::size_t k = count++;
      for (; k > 0 && term < key[k - 1]; --k) key[k] = key[k - 1];  // ascending
      key[k] = term;
    }
    const std::span<const Term> terms = std::span(key).first(count);
    int& head = head_[at(terms.front().first)];
    for (int k = head; k >= 0; k = known_[at(k)].next)
      if (std::ranges::equal(terms_of(k), terms)) return mesh_.followers[at(k)].node;
    known_.push_back({head, terms_.size(), count});
    head = static_cast<int>(known_.size()) - 1;
    terms_.insert(terms_.end(), terms.begin(), terms.end());
    Follower& follower = mesh_.followers.emplace_back();
    follower.node = static_cast<int>(mesh_.nodes.size());
    follower.of.reserve(count);
    for (std::size_t a = 0; a < nodes.size(); ++a)
      if (std::abs(share[a]) >= 1e-12) follower.of.emplace_back(nodes[a], share[a]);
    mesh_.nodes.push_back(place);
    return follower.node;
  }

 private:
  using Term = std::pair<int, long>;  // a node, 1e9 times its weight
  struct Known {
    int next;  // in the chain
    std::size_t first, count;
  };
  std::span<const Term> terms_of(int follower) const {
    return std::span(terms_).subspan(known_[at(follower)].first, known_[at(follower)].count);
  }

  Mesh& mesh_;
  std::vector<int> head_;     // of each node
  std::vector<Known> known_;  // followers in their order
  std::vector<Term> terms_;   // of all of them
};

/// Whether a simplex of full dimension is numbered the wrong way round.
bool is_inside_out(int dimension, Cell piece, std::span<const Vec3> x) {
  if (piece == Cell::tri3 && dimension == 2) return cross(x[1] - x[0], x[2] - x[0]).z() < 0;
  return piece == Cell::tet4 && (x[3] - x[0]).dot(cross(x[1] - x[0], x[2] - x[0])) < 0;
}

/// A cell at its place; `places` gets its corners.
PlacedCell placed(const Mesh& mesh, CellId id, std::array<Vec3, max_corners>& places) {
  const std::span<const int> nodes = mesh.cell(id);
  for (std::size_t a = 0; a < nodes.size(); ++a) places[a] = mesh.nodes[at(nodes[a])];
  return {mesh.type(id), std::span(places).first(nodes.size())};
}

}  // namespace

CellRule rule_of_part(const Mesh& mesh, CellId id) {
  const CellPart& part = *mesh.part(id);
  std::array<Vec3, max_corners> places;
  return rule_within(placed(mesh, id, places), mesh.limits[at(part.limits)], part.tolerance);
}

void add_pieces(Mesh& mesh) {
  const std::vector<CellId> cells = mesh.parts.cells();
  Followers followers(mesh, cells.size());
  std::vector<std::pair<Vec3, int>> known;  // simplices share their corners
  std::array<Vec3, max_corners> places;
  DrawnPart drawn;
  std::size_t done = 0;
  for (const CellId id : cells) {
    if (done++ == cells.size() / 16 && done > 1000) followers.expect(done - 1, cells.size());
    const std::span<const int> nodes = mesh.cell(id);
    const PlacedCell cell = placed(mesh, id, places);
    CellPart& part = mesh.parts[id];
    draw_within(cell, mesh.limits[at(part.limits)], part.tolerance, drawn);
    part.piece = drawn.piece;
    part.nodes.reserve(drawn.corners.size());
    if (!drawn.local.empty()) {
      for (std::size_t k = 0; k < drawn.local.size(); ++k)
        part.nodes.push_back(followers.node_at(nodes, cell.shares(drawn.local[k]), drawn.corners[k]));
      continue;
    }
    known.clear();
    for (std::size_t a = 0; a < nodes.size(); ++a) known.emplace_back(places[a], nodes[a]);
    const auto node_at = [&](const Vec3& place) {
      for (std::size_t k = known.size(); k-- > 0;) {  // the pieces before have most of them
        const Vec3& there = known[k].first;
        if (there[0] == place[0] && there[1] == place[1] && there[2] == place[2]) return known[k].second;
      }
      const int node = followers.node_at(nodes, cell.shares(cell.local(place)), place);
      return known.emplace_back(place, node).second;
    };
    const std::span<const Vec3> all = drawn.corners;
    const auto n = at(info(part.piece).nodes);
    for (std::size_t first = 0; first < all.size(); first += n) {
      const std::span<const Vec3> piece = all.subspan(first, n);
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
