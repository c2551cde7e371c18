#include "uplift/case/ground/ground.h"

#include <fmt/format.h>

#include <algorithm>

#include "uplift/base/text.h"
#include "uplift/mesh/cells.h"

namespace uplift {
namespace {

/// One side of a tie: nodes of the mesh, sorted by height.
struct Side {
  std::vector<int> nodes;
  Vec3 low, high;
};

Side side_of(const NameUsed& group, const CaseNames& names) {
  Side side{names.mesh_for(group).nodes(group), {}, {}};
  const std::vector<Vec3>& places = names.solids->mesh().nodes;
  side.low = side.high = places[static_cast<std::size_t>(side.nodes.front())];
  for (const int node : side.nodes) {
    side.low = side.low.cwiseMin(places[static_cast<std::size_t>(node)]);
    side.high = side.high.cwiseMax(places[static_cast<std::size_t>(node)]);
  }
  const int up = names.space.up();
  std::ranges::sort(side.nodes, {}, [&](int node) { return places[static_cast<std::size_t>(node)][up]; });
  return side;
}

/// Pairs the nodes of two opposite sides by their place across the direction from one to the other.
class Partners {
 public:
  Partners(const CaseTie& tie, const Side& from, const Side& to, const CaseNames& names)
      : tie_(tie), places_(names.solids->mesh().nodes), up_(names.space.up()) {
    const Vec3 apart = (to.low + to.high - from.low - from.high) / 2;
    apart.cwiseAbs().maxCoeff(&across_);
    tolerance_ = 1e-6 * (from.high.cwiseMax(to.high) - from.low.cwiseMin(to.low)).norm();
    if (across_ == up_ || !(apart.norm() > tolerance_))
      fail(tie, "to", "the opposite side of the ground, at a distance sideways (a tie makes the ground go on; it does not join two meshes)",
           fmt::format("{}, at the same place or above or below", in_quotes(tie.to.name)));
    find_cells(names.solids->mesh());
  }

  /// The node of the other side (sorted by height) with the same place; of several, as both sides of an interface, the one whose cells lie
  /// in the same direction. InputError without one.
  int find(int node, const std::vector<int>& others, std::string_view group) const {
    const Vec3& place = at(node);
    const auto height = [&](int other) { return at(other)[up_]; };
    int best = -1;
    double least = 0;
    for (auto other = std::ranges::lower_bound(others, place[up_] - tolerance_, {}, height); other != others.end(); ++other) {
      Vec3 apart = at(*other) - place;
      if (apart[up_] > tolerance_) break;
      apart[across_] = 0;
      if (apart.norm() > tolerance_) continue;
      Vec3 turned = cells_[static_cast<std::size_t>(*other)] - cells_[static_cast<std::size_t>(node)];
      turned[across_] = 0;
      if (const double off = turned.norm(); best < 0 || off < least) best = *other, least = off;
    }
    if (best >= 0) return best;
    fail(tie_, "group", "nodes with a partner on the opposite side, at the same height",
         fmt::format("node {} at ({:g}, {:g}, {:g}) without one in {}", node + 1, place.x(), place.y(), place.z(),
                     in_quotes(std::string(group))));
  }

 private:
  const Vec3& at(int node) const { return places_[static_cast<std::size_t>(node)]; }
  /// For each node the way to the middle of its cells, or of what is left of them.
  void find_cells(const Mesh& mesh) {
    std::vector<int> count(mesh.nodes.size(), 0);
    cells_.assign(mesh.nodes.size(), Vec3::Zero());
    for (int b = 0; b < static_cast<int>(mesh.blocks.size()); ++b) {
      if (info(mesh.blocks[static_cast<std::size_t>(b)].cell).dimension != mesh.dimension) continue;
      for (int i = 0; i < mesh.blocks[static_cast<std::size_t>(b)].count(); ++i) {
        const Vec3 middle = middle_of(mesh, {b, i});
        for (const int node : mesh.cell({b, i}))
          cells_[static_cast<std::size_t>(node)] += middle - at(node), ++count[static_cast<std::size_t>(node)];
      }
    }
    for (std::size_t node = 0; node < count.size(); ++node)
      if (count[node] > 0) cells_[node] /= count[node];
  }
  static Vec3 middle_of(const Mesh& mesh, CellId id) {
    Vec3 sum = Vec3::Zero();
    double count = 0;
    const auto add = [&](std::span<const int> nodes) {
      for (const int node : nodes) sum += mesh.nodes[static_cast<std::size_t>(node)], ++count;
    };
    if (const CellPart* part = mesh.part(id))
      add(part->nodes);
    else
      add(mesh.cell(id));
    return sum / count;
  }
  const CaseTie& tie_;
  const std::vector<Vec3>& places_;
  int up_, across_ = 0;
  double tolerance_ = 0;     // m
  std::vector<Vec3> cells_;  // m
};

std::vector<Dof> unknowns_of(const CaseTie& tie, Space space) {
  std::vector<Dof> unknowns;
  for (const NameUsed& word : tie.unknowns) {
    int found = -1;
    for (int k = 0; k < space.dimension; ++k)
      if (to_string(space.dof(k)) == word.name) found = k;
    if (found < 0) fail(word, space.dimension == 2 ? "ux or uy" : "ux, uy or uz", in_quotes(word.name));
    unknowns.push_back(space.dof(found));
  }
  return unknowns;
}

}  // namespace

void add_ties(const CaseInput& input, ModelBuilder& builder, const CaseNames& names) {
  for (const CaseTie& tie : input.ties) {
    const Side from = side_of(tie.group, names), to = side_of(tie.to, names);
    const Partners partners(tie, from, to, names);
    const std::vector<Dof> unknowns = unknowns_of(tie, names.space);
    for (const int node : from.nodes) {
      const int partner = partners.find(node, to.nodes, tie.to.name);
      for (const Dof unknown : unknowns) builder.tie_equal(names.first_of_mesh + node, names.first_of_mesh + partner, unknown, tie.where());
    }
    for (const int node : to.nodes) partners.find(node, from.nodes, tie.group.name);
  }
}

}  // namespace uplift
