#include "uplift/verdict/base_over_time.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "uplift/verdict/numbers.h"

namespace uplift {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr double least_share = 1e-3;    // of the static force: below it the place of the thrust has no meaning
constexpr double largest_safety = 1e6;  // beyond it round-off is what drives

/// std::hypot without its care for squares that overflow, which costs ten times as much.
double length(double x, double y) {
  return std::sqrt(x * x + y * y);
}

}  // namespace

BaseOverTime::BaseOverTime(const BuiltCase& built, const RunResult& result, std::size_t number)
    : run(result),
      index(number),
      interface(built.model.interfaces[index]),
      facts(built.facts[index]),
      shape(built.model, interface, facts) {
  if (!run.steps.rest.empty()) {
    const Resultant& sum = run.steps.rest[index];
    const bool plane = interface.space.dimension == 2;
    rest = thrust_of(interface.space, sum.axial, plane ? sum.moment : sum.moment_1, sum.moment_2);
  } else if (built.bases() == 1) {
    rest.force = built.weight();
  }
  find_what_stabilises(built);
  const auto square = [](double axial, double shear_1, double shear_2) { return axial * axial + shear_1 * shear_1 + shear_2 * shear_2; };
  double largest = 0, largest_change = 0;  // squares
  for (std::size_t i = 0; i < run.steps.size(); ++i) {
    const StepRecord::Instant &now = at(i), &first = at(0);
    largest = std::max(largest, square(now.axial, now.shear_1, now.shear_2));
    largest_change = std::max(largest_change, square(now.axial - first.axial, now.shear_1 - first.shear_1, now.shear_2 - first.shear_2));
  }
  largest_force = std::sqrt(largest);
  least_force = std::max(noise_share * std::sqrt(largest_change), round_off_share * largest_force);
}

/// The weight, where this base alone bears the constant loads: they then give the thrust at rest. Without a static stage one base is taken
/// to bear them.
void BaseOverTime::find_what_stabilises(const BuiltCase& built) {
  stabilises = rest;
  if (!(rest.force > 0)) return;
  const ConstantLoads& loads = built.constant_loads[index];
  if (run.steps.rest.empty()) {
    if (built.bases() == 1) stabilises = loads.weight;
    return;
  }
  const double arm = std::max(shape.width[0], shape.width[1]);
  const bool leans = std::ranges::any_of(built.plan.stages, &Stage::p_delta);  // the moment of the weight that has moved
  const double tolerance = leans ? 0.02 : 1e-3;
  bool alone = built.bases() == 1 && std::abs(loads.all.force - rest.force) <= 1e-3 * rest.force;
  for (std::size_t k = 0; k < 2; ++k) alone = alone && std::abs(loads.all.first[k] - rest.first[k]) <= tolerance * rest.force * arm;
  if (alone)
    stabilises = loads.weight;
  else if (loads.lateral() > 1e-3 * rest.force * arm)
    counted_as_weight = loads.lateral();
}

double BaseOverTime::shear(std::size_t step) const {
  return length(at(step).shear_1, at(step).shear_2);
}

double BaseOverTime::moment(std::size_t step) const {
  return length(at(step).moment_1, at(step).moment_2);
}

bool BaseOverTime::carries(std::size_t step) const {
  return pressed() && -at(step).axial > least_share * rest.force;
}

double BaseOverTime::eccentricity(std::size_t step) const {
  return carries(step) && shape.width[0] > 0 ? shape.eccentricity(thrust(step)) : nothing;
}

double BaseOverTime::eccentricity(std::size_t step, std::size_t axis) const {
  return carries(step) && shape.width[axis] > 0 ? shape.eccentricity(thrust(step), axis) : nothing;
}

double BaseOverTime::overturning(std::size_t step) const {
  const double safety = pressed() ? shape.overturning_safety(stabilises, thrust(step)) : nothing;
  return safety < largest_safety ? safety : nothing;
}

double BaseOverTime::sliding(std::size_t step) const {
  if (facts.friction < 0 || interface.batch.components == 1 || !carries(step)) return nothing;
  const double holds = -facts.friction * at(step).axial + facts.cohesion * facts.area * cohesive_share(step);
  return shear(step) > least_force ? holds / shear(step) : nothing;
}

/// Of the area: where it is in contact; under a whole foundation the effective area (docs/theory/macro_element.md, eq M6).
double BaseOverTime::cohesive_share(std::size_t step) const {
  if (!interface.footprint) return 1 - at(step).open_area;
  const double one = 2 * std::abs(eccentricity(step, 0)), two = interface.space.dimension == 3 ? 2 * std::abs(eccentricity(step, 1)) : 0;
  const bool disc = interface.footprint->shape == Footprint::Shape::disc;
  return disc ? std::max(0.0, 1 - length(one, two)) : std::max(0.0, 1 - one) * std::max(0.0, 1 - two);
}

std::vector<double> base_history(const BuiltCase& built, const RunResult& run, std::size_t interface, BaseHistory which) {
  const BaseOverTime base(built, run, interface);
  std::vector<double> history(run.steps.size());
  for (std::size_t i = 0; i < history.size(); ++i) {
    switch (which) {
      case BaseHistory::uplifted_ratio:
        history[i] = base.at(i).open_area;
        break;
      case BaseHistory::eccentricity_1:
        history[i] = base.eccentricity(i, 0);
        break;
      case BaseHistory::eccentricity_2:
        history[i] = base.eccentricity(i, 1);
        break;
      case BaseHistory::overturning_safety:
        history[i] = base.overturning(i);
        break;
      case BaseHistory::sliding_safety:
        history[i] = base.sliding(i);
        break;
    }
    if (!std::isfinite(history[i])) history[i] = nothing;
  }
  return history;
}

}  // namespace uplift
