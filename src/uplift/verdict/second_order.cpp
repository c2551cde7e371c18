#include "uplift/verdict/second_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "uplift/base/format.h"
#include "uplift/case/advice/swaying_solids.h"
#include "uplift/case/mesh/mesh.h"
#include "uplift/verdict/base_over_time.h"

namespace uplift {
namespace {

constexpr double negligible = 0.1;  // of the base moment
constexpr double noise = 1e-4;      // of the stabilising moment: a base that next to nothing tilts

double height_of(const Model& model, int node) {
  return model.nodes[static_cast<std::size_t>(node)].position.dot(model.up());
}

bool leaves_out(const RunPlan& plan) {
  return std::ranges::none_of(plan.stages, &Stage::p_delta);
}

/// Nothing moves the ground.
bool is_forced(const Model& model) {
  return model.grounds.empty() && model.motions.empty() && model.time_load_tables.empty();
}

}  // namespace

double swaying_weight(const BuiltCase& built) {
  const Model& model = built.model;
  if (built.top < 0 || built.base < 0 || built.facts.empty()) return 0;
  const double foot = height_of(model, built.base), height = built.top_place().dot(model.up()) - foot;
  if (!(height > 0)) return 0;
  double sum = 0;  // N m
  for (const auto& [weight, at] : weights_at_heights(model, part_of(model, built.facts.front().upper)))
    sum += weight * std::max(0.0, at - foot);
  return sum / height;
}

std::optional<SecondOrderMoment> second_order_of(const BuiltCase& built, const RunResult& run, const VerdictNumbers& numbers) {
  const VerdictNumber* drift = find_number(numbers.whole, "max_drift");
  if (numbers.bases() != 1 || !drift || run.status == RunStatus::failed) return std::nullopt;
  const double of_solids = second_order_of_solids(built), share = leaves_out(built.plan) ? 1 : of_solids;
  const VerdictNumber* moment = find_number(numbers.interfaces.front().numbers, "max_moment");
  SecondOrderMoment found{share * swaying_weight(built), std::abs(drift->value), moment ? moment->value : 0,
                          std::numeric_limits<double>::infinity()};
  found.p_delta = !leaves_out(built.plan);
  found.solids = of_solids > least_of_solids;
  if (!(found.weight > 0) || !moment || !(moment->value > moment->least)) return std::nullopt;
  const BaseOverTime base(built, run, 0);
  for (std::size_t i = 0; i < run.steps.size(); ++i) {
    const double safety = base.overturning(i), driving = base.moment(i);
    if (!(safety >= 1) || driving * (safety - 1) >= found.least_left) continue;
    found.least_left = driving * (safety - 1);
    found.stabilising = driving * safety;
  }
  found.forced = is_forced(built.model);
  return found;
}

bool SecondOrderMoment::counts() const {
  return moment() > std::max(negligible * base_moment, noise * stabilising);
}

bool SecondOrderMoment::overturns() const {
  return exceeds_what_is_left() && (forced || moment() > stabilising / 2);
}

std::string SecondOrderMoment::warning() const {
  if (!counts()) return "";
  const std::string left = exceeds_what_is_left()
                               ? fmt::format(" and more than the {} that are left until it overturns", format_quantity(least_left, "N m"))
                               : "";
  const char *what = p_delta ? "second-order effects of solids are left out, p_delta = true does not give solids any, and they count"
                             : "second-order effects are left out, and they count",
             *advice =
                 solids
                     ? "solids have no geometric stiffness: make the part that stands on the base rigid with [[rigid]], or of beams, and "
                       "take p_delta = true in the stages after the first static one"
                     : "take p_delta = true in the stages after the first static one";
  return fmt::format(
      "{}: the weight times the drift of the top is {} ({} x {}), {} of the base moment{}; EN 1998-1 neglects at most a tenth; {}", what,
      format_quantity(moment(), "N m"), format_quantity(weight, "N"), format_quantity(drift, "m"), percent(ratio()), left, advice);
}

std::string SecondOrderMoment::clause() const {
  if (overturns()) return "second-order effects, which are left out, would overturn it";
  return exceeds_what_is_left() ? "second-order effects, which are left out, exceed what is left until it overturns" : "";
}

}  // namespace uplift
