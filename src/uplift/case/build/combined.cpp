#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "uplift/case/build/output.h"
#include "uplift/interface/interface.h"

namespace uplift {
namespace {

using Column = Request::Kind;
using Terms = std::vector<CombinedRequest::Term>;
constexpr double no_component = 1e-12;  // of an axis that does not have a direction
/// A sum of columns, empty: zero. Nothing where a column is needed that is not recorded.
using Sum = std::optional<Terms>;

Sum recorded(const RunPlan& plan, Column kind, int of, double factor) {
  return find_request(plan.requests, kind, of) < 0 ? std::nullopt : Sum({{kind, of, factor}});
}

/// The displacement of an unknown; zero where it is held.
Sum displacement(const BuiltCase& built, int node, Dof dof, double factor) {
  const int unknown = built.model.at(node, dof);
  if (Sum found = recorded(built.plan, Column::displacement, unknown, factor)) return found;
  return moves(built.model, unknown) ? std::nullopt : Sum(Terms());
}

/// The displacement along a direction of a point that is rigidly offset from a node.
Sum displacement(const BuiltCase& built, int node, const Vec3& arm, const Vec3& direction) {
  const Space space = built.model.space;
  Terms sum;
  for (int k = 0; k < space.unknowns(); ++k) {
    const double factor = space.motion(k, arm).dot(direction);
    if (std::abs(factor) < no_component * (space.is_rotation(k) ? arm.norm() : 1) || factor == 0) continue;
    const Sum part = displacement(built, node, space.dof(k), factor);
    if (!part) return std::nullopt;
    sum.insert(sum.end(), part->begin(), part->end());
  }
  return sum;
}

/// What moves the top along a horizontal direction like a rigid body on the base: theta x (x_top - x_base). The tilt of a base of several
/// nodes is about the horizontal axes alone.
Sum turned(const BuiltCase& built, const Vec3& direction) {
  const Model& model = built.model;
  const Space space = model.space;
  const Vec3 arm = built.top_place() - model.nodes[static_cast<std::size_t>(built.base)].position;
  const bool of_nodes = built.facts.front().upper.size() > 1;
  Terms sum;
  for (int k = 0; k < (of_nodes ? space.dimension - 1 : space.rotations()); ++k) {
    const Vec3 axis = of_nodes && space.dimension == 3 ? local_axis(space, model.up(), k) : space.axis(space.dimension + k);
    const double factor = cross(axis, arm).dot(direction);
    if (std::abs(factor) <= no_component * arm.norm()) continue;
    const Sum part = of_nodes ? recorded(built.plan, k == 0 ? Column::tilt_1 : Column::tilt_2, 0, factor)
                              : displacement(built, built.base, space.dof(space.dimension + k), factor);
    if (!part) return std::nullopt;
    sum.insert(sum.end(), part->begin(), part->end());
  }
  return sum;
}

void take_off(Terms& from, const Terms& what) {
  for (CombinedRequest::Term term : what) {
    term.factor = -term.factor;
    from.push_back(std::move(term));
  }
}

/// Motion of the top relative to the base; `rigid`: without what the rotation of the base makes of it.
std::optional<CombinedRequest> drift(const BuiltCase& built, std::string_view name, bool rigid) {
  const Model& model = built.model;
  CombinedRequest made{.name = std::string(name)};
  for (int axis = 0; axis < model.space.dimension - 1; ++axis) {
    const Vec3 along = local_axis(model.space, model.up(), axis);
    Sum sum = displacement(built, built.top, built.top_arm, along);
    const Sum base = displacement(built, built.base, Vec3::Zero(), along);
    const Sum turns = rigid ? turned(built, along) : Sum(Terms());
    if (!sum || !base || !turns) return std::nullopt;
    take_off(*sum, *base);
    take_off(*sum, *turns);
    made.components.push_back(std::move(*sum));
  }
  return made;
}

/// In space: every storey whose shears, or drift ratios, are recorded along both axes.
void add_storeys(BuiltCase& built) {
  const int each = built.model.space.unknowns();
  const auto node = [&](int unknown) { return built.model.nodes[static_cast<std::size_t>(unknown / each)].name; };
  const std::vector<Request>& requests = built.plan.requests;
  for (const Request& x : requests) {
    const bool is_drift = x.below >= 0 && x.unit == "1";
    if ((!x.level && !is_drift) || x.component != 0) continue;
    const auto y = std::ranges::find_if(requests, [&](const Request& other) {
      return other.component == 1 &&
             (is_drift ? other.unit == "1" && other.below == x.below + 1 && other.unknown == x.unknown + 1 : other.level == x.level);
    });
    if (y == requests.end()) continue;
    std::string name = is_drift ? fmt::format("{} over {}", node(x.unknown), node(x.below)) : fmt::format("level {:.6g} m", *x.level);
    if (std::ranges::find(built.plan.combined, name, &CombinedRequest::name) != built.plan.combined.end()) continue;  // recorded twice
    const auto alone = [](const Request& of) { return Terms{{.kind = of.kind, .column = of.name}}; };
    built.plan.combined.push_back({std::move(name), x.unit, {alone(x), alone(*y)}});
  }
}

}  // namespace

void add_combined(BuiltCase& built) {
  if (built.model.space.dimension == 3) add_storeys(built);
  if (built.top < 0) return;
  const Space space = built.model.space;
  CombinedRequest along{.name = std::string(combined_top)}, up{.name = std::string(combined_top_up)};
  for (int axis = 0; axis < space.dimension; ++axis)  // the last one is the vertical
    if (Sum sum = displacement(built, built.top, built.top_arm, local_axis(space, built.model.up(), axis)); sum && !sum->empty())
      (axis == space.up() ? up : along).components.push_back(std::move(*sum));
  for (CombinedRequest* each : {&along, &up})
    if (!each->components.empty()) built.plan.combined.push_back(std::move(*each));
  if (built.base < 0 || (built.top == built.base && built.top_arm.isZero(0)) || built.facts.empty()) return;
  if (auto made = drift(built, combined_drift, false)) built.plan.combined.push_back(std::move(*made));
  if (built.bases() > 1) return;  // each base turns by itself: none of their rotations is that of the structure
  if (auto made = drift(built, combined_bending, true)) built.plan.combined.push_back(std::move(*made));
}

}  // namespace uplift
