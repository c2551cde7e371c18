#include "uplift/verdict/edge_warnings.h"

#include <fmt/format.h>

#include <algorithm>

#include "uplift/base/format.h"
#include "uplift/laws/macro_element.h"
#include "uplift/model/rigid_parts.h"

namespace uplift {
namespace {

/// The points of a rigid base that stand on its edge are the last one alone: its area is that of the division, not of the ground.
std::string unbounded_pressure(const BuiltCase& built, std::size_t k, double uplifted, const std::vector<bool>& tied,
                               const InterfaceVerdict& said) {
  const VerdictNumber* pressure = find_number(said.numbers, "max_toe_pressure");
  if (!built.model.interfaces[k].cone || !pressure || !(uplifted > 0) || !is_one_body(built.facts[k].upper, tied)) return "";
  return fmt::format(
      "the largest pressure of {} ({}) is no pressure of the ground: a rigid base that opens on constraints stands on its edge, where the "
      "pressure has no bound and grows with the number of points; forces and moments hold; take a joint of finite stiffness for pressures",
      said.name, format_quantity(pressure->value, "Pa"));
}

std::string few_points(const Interface& interface, double uplifted, const InterfaceVerdict& said) {
  constexpr double enough = 4;
  const double closed = (1 - uplifted) * interface.batch.points;
  if (interface.cone || interface.footprint || !(uplifted > 0) || uplifted >= 1 || closed >= enough) return "";
  return fmt::format(
      "at the largest uplift of {} ({} of the area) about {:.2g} of its {} points are in contact: the pressures and the last digits of "
      "the moment are rough; take more points",
      said.name, percent(uplifted), closed, interface.batch.points);
}

/// docs/theory, eq (29).
std::string constant_loads_as_weight(const InterfaceVerdict& said) {
  if (!find_number(said.numbers, "min_overturning_safety") || !(said.counted_as_weight > 0)) return "";
  return fmt::format(
      "the safety against overturning of {} counts the moment of constant loads other than the weight, {} where the base bears them, with "
      "what stabilises, because other bases, walls or supports share the loads; compare the moments about the toe by hand",
      said.name, format_quantity(said.counted_as_weight, "N m"));
}

/// docs/theory/macro_element.md: M is 4 % too small at x = 2, and the rotation at a given moment 31 % too large at e/D = 0.3.
std::string beyond_disc_on_springs(const Interface& interface, const InterfaceVerdict& said) {
  constexpr double of_a_disc = 8, most = 0.3;
  const MacroElement* foundation = as_macro_element(interface.law.get());
  const VerdictNumber* reached = find_number(said.numbers, "max_eccentricity");
  if (foundation == nullptr || foundation->elasticity().shape != of_a_disc || !reached || !(std::abs(reached->value) > most)) return "";
  return fmt::format(
      "{} reaches e/D = {:.2g}, beyond what shape_number = 8 is meant for: compared with a disc on no-tension springs, the uplifted "
      "share is too small (46.7 instead of 51.8 %) and the rotation 31 % too large at e/D = 0.3; 73.3 instead of 81.8 % and 86 % at 0.4",
      said.name, std::abs(reached->value));
}

}  // namespace

std::string damped_impacts(const BuiltCase& built, const VerdictNumbers& numbers, double beta) {
  const RunPlan& plan = built.plan;
  if (!(beta > 0) || numbers.beams.empty() || !dynamic_stage(plan) || !plan.method->constrains() || !plan.impact->acts()) return "";
  for (std::size_t k = 0; k < std::min(numbers.interfaces.size(), built.model.interfaces.size()); ++k) {
    const std::vector<VerdictNumber>& said = numbers.interfaces[k].numbers;
    const VerdictNumber *ratio = find_number(said, "max_uplifted_ratio"), *opening = find_number(said, "max_opening");  // of a wall
    const bool opens = (ratio && ratio->value > 0) || (opening && opening->value > plan.gap_tolerance);
    if (built.model.interfaces[k].cone && opens)
      return fmt::format(
          "{} opens on constraints, whose impacts change velocities at once: with damping in proportion to the stiffness (beta = {:.3g} s) "
          "the largest section forces of the beams contain a damping force that grows as the step falls and does not converge; use a joint "
          "of finite stiffness, or mass-proportional damping only",
          numbers.interfaces[k].name, beta);
  }
  return "";
}

std::vector<std::string> edge_warnings(const BuiltCase& built, const VerdictNumbers& numbers) {
  std::vector<std::string> found;
  const std::vector<bool> tied = tied_nodes(built.model);
  for (std::size_t k = 0; k < std::min(numbers.bases(), built.model.interfaces.size()); ++k) {
    const InterfaceVerdict& said = numbers.interfaces[k];
    const VerdictNumber* ratio = find_number(said.numbers, "max_uplifted_ratio");
    const double uplifted = ratio ? ratio->value : 0;
    const Interface& interface = built.model.interfaces[k];
    for (std::string text : {unbounded_pressure(built, k, uplifted, tied, said), few_points(interface, uplifted, said),
                             constant_loads_as_weight(said), beyond_disc_on_springs(interface, said)})
      if (!text.empty()) found.push_back(std::move(text));
  }
  return found;
}

}  // namespace uplift
