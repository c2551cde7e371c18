#include <optional>
#include <utility>

#include "uplift/case/build/output.h"

namespace uplift {
namespace {

using Column = Request::Kind;
using Terms = std::vector<CombinedRequest::Term>;
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

/// What moves the top along an axis like a rigid body on the base, `h` above it. In space: along x about y, along y about x.
Sum turned(const BuiltCase& built, int axis, double h) {
  const bool plane = built.model.space.dimension == 2, of_nodes = built.facts.front().upper.size() > 1;
  const bool second = !plane && axis == 0;
  const double factor = second ? h : -h;
  if (Sum tilt = recorded(built.plan, second ? Column::tilt_2 : Column::tilt_1, 0, factor)) return tilt;
  return of_nodes ? std::nullopt : displacement(built, built.base, plane ? rz : second ? ry : rx, factor);
}

void take_off(Terms& from, const Terms& what) {
  for (const auto& [kind, of, factor] : what) from.push_back({kind, of, -factor});
}

/// Motion of the top relative to the base; `rigid`: without what the rotation of the base makes of it.
std::optional<CombinedRequest> drift(const BuiltCase& built, std::string_view name, bool rigid) {
  const Space space = built.model.space;
  const auto height = [&](int node) { return built.model.nodes[static_cast<std::size_t>(node)].position[space.up()]; };
  CombinedRequest made{std::string(name), {}};
  for (int axis = 0; axis < space.dimension; ++axis) {
    if (axis == space.up()) continue;
    Sum sum = displacement(built, built.top, space.dof(axis), 1);
    const Sum base = displacement(built, built.base, space.dof(axis), 1);
    const Sum turns = rigid ? turned(built, axis, height(built.top) - height(built.base)) : Sum(Terms());
    if (!sum || !base || !turns) return std::nullopt;
    take_off(*sum, *base);
    take_off(*sum, *turns);
    made.components.push_back(std::move(*sum));
  }
  return made;
}

}  // namespace

void add_combined(BuiltCase& built) {
  if (built.top < 0) return;
  const Space space = built.model.space;
  CombinedRequest along{std::string(combined_top), {}}, up{std::string(combined_top_up), {}};
  for (int axis = 0; axis < space.dimension; ++axis)
    if (Sum sum = recorded(built.plan, Column::displacement, built.model.at(built.top, space.dof(axis)), 1))
      (axis == space.up() ? up : along).components.push_back(std::move(*sum));
  for (CombinedRequest* each : {&along, &up})
    if (!each->components.empty()) built.plan.combined.push_back(std::move(*each));
  if (built.base < 0 || built.top == built.base || built.facts.empty()) return;
  for (const bool rigid : {false, true})
    if (auto made = drift(built, rigid ? combined_bending : combined_drift, rigid)) built.plan.combined.push_back(std::move(*made));
}

}  // namespace uplift
