#include "uplift/verdict/numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "uplift/base/format.h"
#include "uplift/interface/shear.h"
#include "uplift/laws/macro_element.h"
#include "uplift/verdict/base_over_time.h"
#include "uplift/verdict/beams.h"
#include "uplift/verdict/criteria.h"
#include "uplift/verdict/foundation.h"
#include "uplift/verdict/motion.h"

namespace uplift {
namespace {

/// The largest magnitude of a quantity over the steps, or the least value; nothing when it is nowhere finite.
template <class Of>
std::optional<VerdictNumber> extreme(const BaseOverTime& base, QuantityName name, const Of& of, bool least = false) {
  VerdictNumber found{name};
  for (std::size_t i = 0; i < base.run.steps.size(); ++i) {
    const double value = of(i), now = least ? value : std::abs(value);
    if (std::isfinite(now) && (!found.time || (least ? now < found.value : now > found.value)))
      found.value = now, found.time = base.run.steps.time[i];
  }
  return found.time ? std::optional(found) : std::nullopt;
}

void add(std::vector<VerdictNumber>& numbers, const std::optional<VerdictNumber>& number) {
  if (number) numbers.push_back(*number);
}
void add(std::vector<VerdictNumber>& numbers, QuantityName name, double value, std::optional<double> time = {}) {
  numbers.push_back({name, value, time});
}
void add(std::vector<VerdictNumber>& numbers, QuantityName name, const StepRecord::Reached& reached) {
  add(numbers, name, reached.value, reached.value != 0 ? std::optional(reached.time) : std::nullopt);
}

/// Sum of the steps at whose end something holds [s].
template <class Holds>
double duration_of(const StepRecord& steps, const Holds& holds) {
  double sum = 0;
  for (std::size_t i = 1; i < steps.size(); ++i)
    if (holds(i)) sum += steps.time[i] - steps.time[i - 1];
  return sum;
}

void add_uplift(const BaseOverTime& base, const VerdictRequest& request, InterfaceVerdict& said) {
  const StepRecord& steps = base.run.steps;
  add(said.numbers, extreme(base, "max_uplifted_ratio", [&](std::size_t i) { return base.at(i).open_area; }));
  add(said.numbers, "uplifted_time", duration_of(steps, [&](std::size_t i) { return base.at(i).open_area > 0; }));
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (base.at(i).open_area > 0) {
      add(said.numbers, "first_uplift", steps.time[i], steps.time[i]);
      break;
    }
  add(said.numbers, "max_opening", base.extremes().max_opening);
  add(said.numbers, "max_penetration", base.extremes().penetration);
  for (const double threshold : request.thresholds)
    said.above.push_back({threshold, duration_of(steps, [&](std::size_t i) { return base.at(i).open_area > threshold; })});
}

void add_pressure(const BaseOverTime& base, InterfaceVerdict& said) {
  const StepRecord::Reached& pressure = base.extremes().max_pressure;
  const bool known = !base.interface.footprint;  // a whole foundation has forces, no pressures
  if (known) add(said.numbers, "max_toe_pressure", pressure);
  if (known && base.pressed()) add(said.numbers, "toe_pressure_ratio", {pressure.value * base.facts.area / base.rest.force, pressure.time});
  add(said.numbers, extreme(base, "max_eccentricity", [&](std::size_t i) { return base.eccentricity(i); }));
  if (base.interface.space.dimension == 3) {
    const auto along = [&](std::size_t axis) { return [&base, axis](std::size_t i) { return base.eccentricity(i, axis); }; };
    add(said.numbers, extreme(base, "max_eccentricity_1", along(0)));
    add(said.numbers, extreme(base, "max_eccentricity_2", along(1)));
    if (base.shape.outline == BaseShape::Outline::rectangle)
      add(said.numbers, extreme(base, "max_eccentricity_sum",
                                [&](std::size_t i) { return std::abs(base.eccentricity(i, 0)) + std::abs(base.eccentricity(i, 1)); }));
  }
  add(said.numbers, extreme(
                        base, "min_overturning_safety", [&](std::size_t i) { return base.overturning(i); }, true));
  add(said.numbers, extreme(
                        base, "min_sliding_safety", [&](std::size_t i) { return base.sliding(i); }, true));
}

/// How much of its strength the ground under a whole foundation uses, at the end of a step.
void add_strength(const BaseOverTime& base, std::vector<VerdictNumber>& numbers) {
  const MacroElement* foundation = as_macro_element(base.interface.law.get());
  if (foundation == nullptr) return;
  if (foundation->surfaces().has_bearing()) add(numbers, "max_bearing_utilisation", base.extremes().bearing_utilisation);
  if (foundation->surfaces().has_sliding()) add(numbers, "max_sliding_utilisation", base.extremes().sliding_utilisation);
}

void add_full_loss(const BaseOverTime& base, InterfaceVerdict& said) {
  said.full_loss = base.extremes().full_loss;
  double sum = 0;
  Interval longest;
  for (const Interval& each : said.full_loss) {
    sum += each.to - each.from;
    if (each.to - each.from > longest.to - longest.from) longest = each;
  }
  add(said.numbers, "full_loss_time", sum);
  if (!said.full_loss.empty()) add(said.numbers, "longest_full_loss", longest.to - longest.from, longest.from);
}

void add_forces(const BaseOverTime& base, std::vector<VerdictNumber>& numbers) {
  if (bears_shear(base.interface)) add(numbers, extreme(base, "max_shear", [&](std::size_t i) { return base.shear(i); }));
  add(numbers, extreme(base, "max_moment", [&](std::size_t i) { return base.moment(i); }));
  const auto compression = [&](std::size_t i) { return -base.at(i).axial; };
  add(numbers, extreme(base, "max_compression", [&](std::size_t i) { return std::max(0.0, compression(i)); }));
  add(numbers, extreme(base, "min_compression", compression, true));
}

/// Largest means over one step, where the numbers are means over the window; and the impulse of impacts.
void add_step_peaks(const StepRecord::Extremes& most, std::vector<VerdictNumber>& numbers) {
  const auto add_peak = [&numbers](QuantityName name, double peak) {
    for (VerdictNumber& number : numbers)
      if (number.quantity->is(name) && peak > 0) number.step_peak = peak;
  };
  add_peak("max_shear", most.step_shear);
  add_peak("max_moment", most.step_moment);
  add_peak("max_compression", most.step_compression);
  add_peak("max_toe_pressure", most.step_pressure);
  if (most.impulse.value > 0) add(numbers, "max_impulse", most.impulse);
}

/// Mean over the last tenth of the planned time less the value at rest, and half of the range over which it moves there.
VerdictNumber residual(const std::vector<BasePose>& tail, QuantityName name, double BasePose::*of, double rest) {
  double sum = 0, least = INFINITY, most = -INFINITY;
  for (const BasePose& pose : tail) {
    sum += pose.*of;
    least = std::min(least, pose.*of), most = std::max(most, pose.*of);
  }
  return {name, sum / static_cast<double>(tail.size()) - rest, {}, {}, (most - least) / 2};
}

void add_residuals(const BaseOverTime& base, std::vector<VerdictNumber>& numbers) {
  const StepRecord& steps = base.run.steps;
  const std::vector<BasePose>& tail = steps.tail[base.index];
  if (tail.empty() || (base.run.status != RunStatus::completed && base.run.status != RunStatus::interrupted)) return;
  const BasePose rest = steps.rest_poses.empty() ? BasePose() : steps.rest_poses[base.index];
  const auto left = [&](QuantityName name, double BasePose::*of) { return residual(tail, name, of, rest.*of); };
  const auto length = [&](QuantityName name, double BasePose::*one, double BasePose::*two) {
    const VerdictNumber a = left(name, one);
    if (base.interface.space.dimension == 2) return a;  // with its sign, which is that of the history
    const VerdictNumber b = left(name, two);
    const double mean_1 = a.value + rest.*one, mean_2 = b.value + rest.*two;
    double farthest = 0;
    for (const BasePose& pose : tail) farthest = std::max(farthest, std::hypot(pose.*one - mean_1, pose.*two - mean_2));
    return VerdictNumber{a.quantity, std::hypot(a.value, b.value), {}, {}, farthest};
  };
  numbers.push_back(length("residual_rotation", &BasePose::tilt_1, &BasePose::tilt_2));
  numbers.push_back(left("residual_settlement", &BasePose::settlement));
  if (base.interface.batch.components > 1) numbers.push_back(length("residual_slip", &BasePose::slip_1, &BasePose::slip_2));
  numbers.push_back(residual(tail, "residual_opening", &BasePose::max_opening, 0));
  numbers.push_back(residual(tail, "residual_uplifted_ratio", &BasePose::open_area, 0));
}

/// Below this a number of a base is noise, in its own unit.
double least_of(const VerdictQuantity& quantity, const BaseOverTime& base) {
  if (quantity.unit == "N") return base.least_force;
  if (quantity.unit == "N m") return base.least_force * std::max(base.shape.width[0], base.shape.width[1]);
  return quantity.name.starts_with("max_eccentricity") ? noise_share : 0;
}

/// What is left of forces that cancel is round-off: none.
void clear_round_off(const BaseOverTime& base, std::vector<VerdictNumber>& numbers) {
  const double force = round_off_share * base.largest_force, moment = force * std::max(base.shape.width[0], base.shape.width[1]);
  for (VerdictNumber& number : numbers) {
    const double least = number.quantity->unit == "N" ? force : number.quantity->unit == "N m" ? moment : 0;
    if (std::abs(number.value) < least) number.value = 0, number.time.reset();
  }
}

/// What a base carries, of a bonded run too.
InterfaceVerdict carried_by(const BaseOverTime& base) {
  InterfaceVerdict said;
  add_pressure(base, said);
  add_forces(base, said.numbers);
  add_step_peaks(base.extremes(), said.numbers);
  clear_round_off(base, said.numbers);
  for (VerdictNumber& number : said.numbers) number.least = least_of(*number.quantity, base);
  return said;
}

/// The numbers of the bonded run for those of the same name, and what has changed.
void add_bonded(const BaseOverTime& base, const BaseOverTime& bonded, std::vector<VerdictNumber>& numbers) {
  const InterfaceVerdict reference = carried_by(bonded);
  for (VerdictNumber& number : numbers)
    if (const VerdictNumber* other = find_number(reference.numbers, *number.quantity)) {
      number.bonded = other->value;
      number.change = change_beside(number.value, other->value, std::max(number.least, other->least));
    }
  const auto add_change = [&numbers](QuantityName name, QuantityName of) {
    if (const VerdictNumber* number = find_number(numbers, of); number && number->change) add(numbers, name, *number->change);
  };
  add_change("change_of_shear", "max_shear");
  add_change("change_of_moment", "max_moment");
  add_change("change_of_compression", "max_compression");
  if (base.interface.footprint) return;  // no tension under parts of it is known
  const StepRecord::Reached& pulls = bonded.extremes().tension_area;
  add(numbers, "linear_tension_ratio", pulls);
  if (const std::optional<double> uplift = uplift_of_tension(pulls.value); uplift && base.pressed())
    add(numbers, "predicted_uplifted_ratio", *uplift);
}

/// A number of the run as a whole, with that of the bonded run.
void add_whole(std::vector<VerdictNumber>& numbers, QuantityName name, const std::optional<Peak>& peak, const std::optional<Peak>& bonded,
               double least) {
  if (!peak) return;
  add(numbers, name, std::abs(peak->value), peak->time);
  numbers.back().least = least;
  if (!bonded) return;
  numbers.back().bonded = std::abs(bonded->value);
  numbers.back().change = change_beside(std::abs(peak->value), std::abs(bonded->value), least);
}

void add_motions(const BuiltCase& built, const RunResult& run, const RunResult* bonded, std::vector<VerdictNumber>& numbers) {
  const double range = std::max(range_of_top(built, run), bonded ? range_of_top(built, *bonded) : 0);
  const double least = std::max(noise_share * range, nothing_beside("m"));
  const auto add_motion = [&](QuantityName name, const auto& of) {
    add_whole(numbers, name, of(run), bonded ? of(*bonded) : std::nullopt, least);
  };
  add_motion("max_top_motion", [&](const RunResult& each) { return top_motion(built, each); });
  if (!numbers.empty() && numbers.back().change) add(numbers, "change_of_top_motion", *numbers.back().change);
  add_motion("max_drift", [&](const RunResult& each) { return largest_drift(built, each, Drift::with_rotation); });
  add_motion("max_drift_without_rotation", [&](const RunResult& each) { return largest_drift(built, each, Drift::without_rotation); });
}

/// What several bases, or bases and walls, carry together, and the shares of the walls.
void add_foundation(const BuiltCase& built, const RunResult& run, const RunResult* bonded, VerdictNumbers& numbers) {
  if (built.facts.size() < 2 || run.steps.size() == 0) return;
  const FoundationForces forces = foundation_forces(built, run), beside = bonded ? foundation_forces(built, *bonded) : FoundationForces();
  const double least = std::max(forces.least, beside.least);
  const auto peak = [](const StepRecord::Reached& reached) { return Peak{"", "", reached.value, reached.time}; };
  const auto reference = [&](const StepRecord::Reached& reached) { return bonded ? std::optional(peak(reached)) : std::nullopt; };
  double width = 0;
  for (const InterfaceVerdict& said : numbers.interfaces) width = std::max({width, said.width[0], said.width[1]});
  const double least_moment = least * width;
  add_whole(numbers.whole, "max_total_shear", peak(forces.shear), reference(beside.shear), least);
  add_whole(numbers.whole, "max_total_moment", peak(forces.moment), reference(beside.moment), least_moment);
  for (std::size_t k = built.bases(); k < built.facts.size(); ++k) {
    std::vector<VerdictNumber>& wall = numbers.interfaces[k].numbers;
    if (forces.shear.value > least) add(wall, "share_of_horizontal_force", forces.share_of_shear[k], forces.shear.time);
    if (forces.moment.value > least_moment) add(wall, "share_of_base_moment", forces.share_of_moment[k], forces.moment.time);
  }
}

/// A wall beside the structure.
InterfaceVerdict wall_of(const StepRecord::Extremes& most, const Interface& interface) {
  InterfaceVerdict said;
  said.role = Role::wall;
  add(said.numbers, "max_opening", most.max_opening);
  if (interface.batch.components > 1) add(said.numbers, "max_slip", most.max_slip);
  add(said.numbers, "max_toe_pressure", most.max_pressure);
  add(said.numbers, "max_penetration", most.penetration);
  return said;
}

/// A base: uplift, forces, safeties, what is left.
InterfaceVerdict base_of(const BuiltCase& built, const RunResult& run, const RunResult* bonded, std::size_t number) {
  const BaseOverTime base(built, run, number);
  InterfaceVerdict said = carried_by(base);
  if (base.pressed()) said.weight = base.rest.force, said.mean_pressure = base.rest.force / base.facts.area;
  said.width = base.shape.width;
  said.round = base.shape.outline == BaseShape::Outline::round;
  said.springs = !base.interface.cone && !base.interface.footprint;
  said.counted_as_weight = base.counted_as_weight;
  add_uplift(base, built.verdict_request, said);
  add_strength(base, said.numbers);
  add_full_loss(base, said);
  add_residuals(base, said.numbers);
  if (bonded) add_bonded(base, BaseOverTime(built, *bonded, number), said.numbers);
  return said;
}

void in_order(std::vector<VerdictNumber>& numbers) {
  std::ranges::stable_sort(numbers, {}, [](const VerdictNumber& number) { return number.quantity; });
}

}  // namespace

const VerdictNumber* find_number(const std::vector<VerdictNumber>& numbers, QuantityName name) {
  const auto found = std::ranges::find_if(numbers, [&](const VerdictNumber& number) { return number.quantity->is(name); });
  return found == numbers.end() ? nullptr : &*found;
}

std::string swing_text(const VerdictNumber& number) {
  const std::string_view unit = number.quantity->unit;
  const double swing = number.swing.value_or(0);
  if (!(swing > 0) || swing < nothing_beside(unit)) return "";
  return is_share(*number.quantity) ? percent(swing) : format_quantity_within(swing, swing, unit);
}

std::string text_of(const VerdictNumber& number) {
  const bool moves = !swing_text(number).empty() && !is_share(*number.quantity);
  return moves ? format_quantity_within(number.value, *number.swing, number.quantity->unit) : format_value(*number.quantity, number.value);
}

std::string words_of_eccentricity(const InterfaceVerdict& said) {
  constexpr double counts = 1.1;  // times the eccentricity along one side
  const VerdictNumber *one = find_number(said.numbers, "max_eccentricity"), *both = find_number(said.numbers, "max_eccentricity_sum");
  if (said.round) return "largest of M/N over the diameter";
  return one && both && both->value > counts * one->value
             ? fmt::format("e1/B1 + e2/B2 up to {}{}; largest of M/N over the width", format_value(*both->quantity, both->value),
                           said.springs ? " (full contact: up to 1/6)" : "")
             : "largest of M/N over the width";
}

std::string label_of_eccentricity(const InterfaceVerdict& said) {
  return said.round ? "Eccentricity e/D" : "Eccentricity e/B";
}

std::optional<double> uplift_of_tension(double t) {
  if (!(t < 0.5)) return std::nullopt;
  if (t <= 0) return 0;
  const double y = 1 / (1 - 2 * t), root = (2 + std::sqrt(1.5 * y * y - 0.5)) / 3;  // root: sqrt(theta/theta_u)
  return 1 - 1 / root;
}

std::optional<double> change_of(double value, double reference, double least) {
  if (!std::isfinite(value) || !std::isfinite(reference) || value < 0 || reference < 0) return std::nullopt;
  const double from = std::max(reference, least);
  return std::max(value, reference) > least && from > 0 ? std::optional(value / from - 1) : std::nullopt;
}

std::optional<double> change_beside(double value, double reference, double least) {
  return reference > least ? change_of(value, reference, least) : std::nullopt;
}

VerdictNumbers numbers_of(const BuiltCase& built, const RunResult& run, const RunResult* bonded) {
  VerdictNumbers numbers;
  if (bonded && (bonded->status != RunStatus::completed || run.status != RunStatus::completed)) bonded = nullptr;
  add_motions(built, run, bonded, numbers.whole);
  add_storeys(built, run, bonded, numbers);
  numbers.beams = beam_verdicts(run, bonded);
  for (std::size_t k = 0; k < built.facts.size() && run.steps.size() > 0; ++k) {
    const bool is_base = k < built.bases();
    InterfaceVerdict said = is_base ? base_of(built, run, bonded, k) : wall_of(run.steps.extremes[k], built.model.interfaces[k]);
    said.name = built.facts[k].name;
    numbers.interfaces.push_back(std::move(said));
  }
  if (!numbers.interfaces.empty()) {
    numbers.full_loss = run.steps.full_loss(built.plan.is_wall);
    double sum = 0;
    for (const Interval& each : numbers.full_loss) sum += each.to - each.from;
    add(numbers.whole, "full_loss_of_contact", sum);
  }
  add_foundation(built, run, bonded, numbers);
  in_order(numbers.whole);
  for (InterfaceVerdict& said : numbers.interfaces) in_order(said.numbers);
  for (const Criterion& criterion : built.verdict_request.criteria) add_results(criterion, numbers);
  for (CriterionResult& result : numbers.criteria)  // a run that did not get to its end has not shown that a limit is kept
    if (run.status != RunStatus::completed && result.state == CriterionResult::State::met)
      result.state = CriterionResult::State::undetermined;
  return numbers;
}

bool numbers_need(const Request& column) {
  using enum Request::Kind;  // of the top, the base, drifts; of the base of a block; storey shears
  return column.kind == displacement || column.kind == tilt_1 || column.kind == tilt_2 || column.kind == force;
}

}  // namespace uplift
