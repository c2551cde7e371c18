#include "uplift/verdict/step_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/base/format.h"

namespace uplift {
namespace {

constexpr double least_share_of_change = 0.1;                  // of an area, and of an inverse safety: below it a change is no matter
constexpr double least_motion = 0.05;                          // of the largest motion
constexpr double steps_per_period = 20, least_spectrum = 0.1;  // of floor spectra; least value beside their peak
constexpr double least_eccentricity = 0.01;                    // of the width
constexpr double long_loss = 0.05;                             // s without contact: shorter ones are hops within one impact

/// What a change of the numbers of one interface, or of the whole run, is measured by.
struct Scale {
  double motion = 0;       // m: largest of the top and of the gap
  double rotation = 0;     // rad: that opens the gap over the width
  double compression = 0;  // N
};

double value_or(const std::vector<VerdictNumber>& numbers, QuantityName name, double otherwise) {
  const VerdictNumber* number = find_number(numbers, name);
  return number ? std::abs(number->value) : otherwise;
}

bool is_safety(const VerdictQuantity& quantity) {
  return quantity.name.ends_with("_safety");
}

/// Durations and instants depend on gaps that vanish, and the compression of the joint on its stiffness, which is a choice of the
/// computation; one axis of a storey may hold little of its vector. Their changes are stated but decide nothing.
bool decides(const VerdictQuantity& quantity) {
  return quantity.unit != "s" && !quantity.is("max_penetration") && !quantity.name.ends_with("_x") && !quantity.name.ends_with("_y");
}

bool is_force(const VerdictQuantity& quantity) {
  return quantity.is("max_moment") || quantity.is("max_shear") || quantity.is("max_compression") || quantity.is("max_toe_pressure");
}

double accepted_change(const VerdictQuantity& quantity) {
  return is_force(quantity) ? accepted_force_change : accepted_step_change;
}

/// What the change of a number is divided by.
double reference(const VerdictNumber& number, double other, const Scale& scale) {
  const VerdictQuantity& quantity = *number.quantity;
  const double size = std::max({std::abs(number.value), std::abs(other), number.least, nothing_beside(quantity.unit)});
  if (quantity.name.starts_with("change_of")) return std::max(1 + std::max(number.value, other), least_share_of_change);
  if (quantity.is("residual_uplifted_ratio")) return 1;  // gaps of micrometres count: beside the whole area
  if (is_share(quantity)) return std::max(size, least_share_of_change);
  if (quantity.is("min_compression")) return std::max(size, scale.compression);
  if (quantity.name.starts_with("max_eccentricity")) return std::max(size, least_eccentricity);
  if (quantity.name.starts_with("residual"))
    return std::max({size, number.swing.value_or(0), least_motion * (quantity.unit == "rad" ? scale.rotation : scale.motion)});
  return size;
}

double change_of_step(const VerdictNumber& number, double other, const Scale& scale) {
  if (is_safety(*number.quantity)) {
    const double here = 1 / number.value, there = 1 / other;
    if (number.value == other) return 0;
    return std::abs(here - there) / std::max({std::abs(here), std::abs(there), least_share_of_change});
  }
  return number.value == other ? 0 : std::abs(number.value - other) / reference(number, other, scale);  // of two zeros too
}

/// Noise in both runs.
bool is_noise_in_both(const VerdictNumber& number) {
  return number.coarse && number.least > 0 && std::max(std::abs(number.value), std::abs(*number.coarse)) <= number.least;
}

/// The largest acceleration of the ground, over the three axes [m/s2].
double ground_peak(const Model& model, const StepRecord& steps) {
  double largest = 0;
  for (const GroundAcceleration& ground : model.grounds)
    for (const double time : steps.time) largest = std::max(largest, ground.direction.norm() * std::abs(ground.function->value(time)));
  return largest;
}

/// Accelerations below this are noise: beside those of the ground, and beside the weight what is left of forces that cancel [m/s2].
double least_acceleration(const BuiltCase& built, const RunResult& run) {
  return std::max(noise_share * ground_peak(built.model, run.steps), round_off_share * built.model.assembly.gravity.norm());
}

/// `quantity` null: a floor spectrum.
void note_change(double change, double accepted, const VerdictQuantity* quantity, const std::string& of, StepCheck& check) {
  if (change > check.largest) check.largest = change, check.quantity = quantity, check.of = of;
  if (change / accepted > check.decisive.excess()) check.decisive = {change, accepted, quantity, of};
}

/// Compares the numbers of one table; keeps the one that changes most.
void compare_numbers(std::vector<VerdictNumber>& numbers, const std::vector<VerdictNumber>& coarse, const std::string& of,
                     const Scale& scale, StepCheck& check) {
  for (VerdictNumber& number : numbers) {
    const VerdictNumber* other = find_number(coarse, *number.quantity);
    if (!other || !std::isfinite(number.value) || !std::isfinite(other->value)) continue;
    number.coarse = other->value;
    if (!decides(*number.quantity) || is_noise_in_both(number)) continue;
    number.step_change = change_of_step(number, other->value, scale);
    note_change(*number.step_change, accepted_change(*number.quantity), number.quantity, of, check);
  }
}

template <class Named>
const std::vector<VerdictNumber>& numbers_named(const std::vector<Named>& list, const std::string& name) {
  static const std::vector<VerdictNumber> none;
  const auto found = std::ranges::find(list, name, &Named::name);
  return found == list.end() ? none : found->numbers;
}

Scale scale_of(const VerdictNumbers& numbers) {
  Scale scale{value_or(numbers.whole, "max_top_motion", 0)};
  for (const InterfaceVerdict& said : numbers.interfaces) scale.motion = std::max(scale.motion, value_or(said.numbers, "max_opening", 0));
  return scale;
}

std::string how_it_ended(const RunResult& run) {
  if (run.status == RunStatus::completed) return "reaches its end";
  return run.status == RunStatus::failed ? "fails: " + run.reason : fmt::format("ends early ({})", to_string(run.status));
}

void judge(StepCheck& check) {
  const bool moves = check.decisive.excess() > 1, in_a_part = check.part.change > accepted_force_change;
  const bool loses = check.lost > accepted_energy_loss;
  check.state = moves || in_a_part || loses ? StepCheck::State::not_converged : StepCheck::State::converged;
  // after a long loss of contact the impacts of the two runs are others: the change in a part says nothing of the step
  const double excess_in_a_part = check.no_contact < long_loss ? check.part.change / accepted_force_change : 0;
  check.sufficient_step = moves ? rounded_down(check.step / std::max(check.decisive.excess(), excess_in_a_part)) : 0;
}

std::string what_changes(const VerdictQuantity* quantity, const std::string& of) {
  if (!quantity) return of.empty() ? "" : "floor spectrum of " + of;
  std::string_view brief = quantity->brief;
  constexpr std::string_view of_the_beam = " of the beam";
  const bool names_beam = !of.empty() && brief.ends_with(of_the_beam);
  if (names_beam) brief.remove_suffix(of_the_beam.size());
  return of.empty() ? std::string(brief) : fmt::format("{} of {}{}", brief, names_beam ? "beam " : "", of);
}

/// Relative to the larger of both values, 0.3 %.
std::string change_in_words(const VerdictNumber& number, double difference) {
  const double size = std::max(std::abs(number.value), std::abs(*number.coarse));
  const double share = size > nothing_beside(number.quantity->unit) ? difference / size : 0;
  return share < 0.0005 ? "< 0.1 %" : "\u00b1" + percent(share);
}

using Instant = StepRecord::Instant;
using OfInstant = double (*)(const Instant&);
struct ComparedForce {
  QuantityName name;
  OfInstant of;
};
/// Without the shear, which friction redistributes with every slip.
constexpr ComparedForce forces_of_a_base[] = {
    {"max_moment", [](const Instant& now) { return std::sqrt(now.moment_1 * now.moment_1 + now.moment_2 * now.moment_2); }},
    {"max_compression", [](const Instant& now) { return -now.axial; }},
    {"max_toe_pressure", [](const Instant& now) { return now.pressure; }}};

/// A force on a base over time.
struct StepHistory {
  const StepRecord& steps;
  std::size_t interface;
  OfInstant of;
  /// The largest value from one time to another [s]; 0 where there is none above it.
  double peak(double from, double to) const {
    double largest = 0;
    for (auto i = static_cast<std::size_t>(std::ranges::lower_bound(steps.time, from) - steps.time.begin());
         i < steps.size() && steps.time[i] <= to; ++i)
      largest = std::max(largest, of(steps.at(i, interface)));
    return largest;
  }
};

}  // namespace

double longest_step(const RunPlan& plan) {
  double step = 0;
  for (const Stage& stage : plan.stages)
    if (stage.type == Stage::Type::dynamics) step = std::max(step, stage.step);
  return step;
}

std::string_view to_string(StepCheck::State state) {
  switch (state) {
    case StepCheck::State::not_made:
      return "not made";
    case StepCheck::State::converged:
      return "converged";
    case StepCheck::State::not_converged:
      return "not converged";
  }
  return "";
}

void mark_criteria(VerdictNumbers& numbers, const VerdictNumbers& coarse) {
  using enum CriterionResult::State;
  for (CriterionResult& result : numbers.criteria) {
    const VerdictNumber* number = nullptr;
    const auto look = [&](const std::vector<VerdictNumber>& list) {
      if (const VerdictNumber* found = find_number(list, *result.criterion.quantity)) number = found;
    };
    if (result.interface.empty()) look(numbers.whole);
    for (const InterfaceVerdict& said : numbers.interfaces)
      if (said.name == result.interface) look(said.numbers);
    for (const BeamVerdict& beam : numbers.beams)
      if (beam.name == result.interface) look(beam.numbers);
    if (!number || !number->coarse || !result.value) {  // one of the runs has no such number: what it says of the criterion
      const auto other = std::ranges::find_if(coarse.criteria, [&](const CriterionResult& each) {
        return each.criterion.quantity == result.criterion.quantity && each.criterion.limit == result.criterion.limit &&
               each.interface == result.interface;
      });
      result.within_step_change =
          other != coarse.criteria.end() && result.state != undetermined && other->state != undetermined && other->state != result.state;
      continue;
    }
    const bool sign_counts = result.criterion.quantity->at_least || number->quantity->name.starts_with("change_of");
    const double size = sign_counts ? number->value : std::abs(number->value);
    const double change = std::abs(*number->coarse - number->value);
    result.within_step_change = change > 0 && change >= std::abs(result.criterion.limit - size);
  }
}

void compare_steps(VerdictNumbers& numbers, const VerdictNumbers& coarse, StepCheck& check) {
  const Scale scale = scale_of(numbers);
  compare_numbers(numbers.whole, coarse.whole, "", scale, check);
  for (InterfaceVerdict& said : numbers.interfaces) {
    Scale here = scale;
    const double width = std::max(said.width[0], said.width[1]);
    here.rotation = width > 0 ? value_or(said.numbers, "max_opening", 0) / width : 0;
    here.compression = value_or(said.numbers, "max_compression", 0);
    compare_numbers(said.numbers, numbers_named(coarse.interfaces, said.name), said.name, here, check);
  }
  for (BeamVerdict& beam : numbers.beams) compare_numbers(beam.numbers, numbers_named(coarse.beams, beam.name), beam.name, scale, check);
  for (StoreyVerdict& storey : numbers.storeys)
    compare_numbers(storey.numbers, numbers_named(coarse.storeys, storey.name), storey.name, scale, check);
  mark_criteria(numbers, coarse);
  judge(check);
}

void compare_floors(const std::vector<FloorSpectra>& floors, const std::vector<FloorSpectra>& coarse, StepCheck& check, double least) {
  const double to = 1 / (steps_per_period * check.coarse_step);
  least = std::max(least, least_excitation(floors, coarse));
  for (std::size_t k = 0; k < std::min(floors.size(), coarse.size()); ++k)
    for (std::size_t d = 0; d < std::min(floors[k].raw.size(), coarse[k].raw.size()); ++d) {
      const Spectrum &fine = floors[k].raw[d], &other = coarse[k].raw[d];
      const double peak = fine.values.empty() ? 0 : *std::ranges::max_element(fine.values);
      for (std::size_t f = 0; f < std::min(fine.values.size(), other.values.size()) && fine.frequencies[f] <= to && peak > least; ++f) {
        check.floors_to = std::max(check.floors_to, fine.frequencies[f]);
        const double size = std::max({fine.values[f], other.values[f], least_spectrum * peak});
        const double change = std::abs(fine.values[f] - other.values[f]) / size;
        check.floors = std::max(check.floors, change);
        note_change(change, accepted_step_change, nullptr, floors[k].name, check);
      }
    }
  judge(check);
}

void compare_parts(const StepRecord& steps, const StepRecord& coarse, const VerdictNumbers& numbers, StepCheck& check) {
  if (steps.size() < 2 || coarse.size() < 2) return;
  for (std::size_t k = 0; k < numbers.bases(); ++k)
    for (const auto& [name, of] : forces_of_a_base) {
      const VerdictNumber* number = find_number(numbers.interfaces[k].numbers, name);
      if (!number || !number->coarse || !(number->value > number->least)) continue;
      const StepHistory fine{steps, k, of}, other{coarse, k, of};
      const double peak = std::max(number->value, *number->coarse), length = (steps.time.back() - steps.time.front()) / parts_of_time;
      for (int i = 0; i < parts_of_time; ++i) {
        const double from = steps.time.front() + i * length, to = from + length, beside = length / 10;
        const double change = std::max(fine.peak(from, to) - other.peak(from - beside, to + beside),
                                       other.peak(from, to) - fine.peak(from - beside, to + beside)) /
                              peak;
        if (change > check.part.change) check.part = {change, number->quantity, numbers.interfaces[k].name, from, to};
      }
    }
  judge(check);
}

StepCheck check_step(const BuiltCase& built, const RunResult& run, const FloorRun* floors, const Companion& companion,
                     VerdictNumbers& numbers) {
  StepCheck check;
  check.step = longest_step(built.plan);
  check.coarse_step = companion.step;
  for (const Interval& lost : numbers.full_loss) check.no_contact = std::max(check.no_contact, lost.to - lost.from);
  const RunStatus ended = companion.run->status;
  if (ended == RunStatus::interrupted || run.status == RunStatus::interrupted) {
    check.reason = "interrupted";
  } else if (ended != run.status) {
    check.state = StepCheck::State::not_converged;
    check.reason = "with twice the step the run " + how_it_ended(*companion.run);
  } else {
    compare_steps(numbers, numbers_of(*companion.built, *companion.run, companion.bonded), check);
    compare_parts(run.steps, companion.run->steps, numbers, check);
    if (floors) compare_floors(floors->floors, floor_spectra(companion.built->plan, *companion.run), check, least_acceleration(built, run));
    check.lost = run.energy_scale > 0 ? run.energy_lost / run.energy_scale : 0;
    judge(check);
  }
  return check;
}

std::string StepCheck::sentence() const {
  if (state == State::not_made) return "Error of the time step: not examined" + (reason.empty() ? "" : " (" + reason + ")") + ".";
  const std::string steps = fmt::format("{} instead of {}", format_quantity(coarse_step, "s"), format_quantity(step, "s"));
  if (state == State::not_converged)
    return "Not converged: " + why_not(steps) + after_loss() + " The changes beside the numbers are no bounds of their errors.";
  constexpr double shown = 1e-3;
  if (largest < shown)
    return fmt::format("Converged: with twice the step ({}) no number of the verdict changes by {} or more.", steps, percent(shown));
  const std::string changes = what_changes(quantity, of);
  return fmt::format("Converged: with twice the step ({}) no number of the verdict changes by more than {}{}.", steps, percent(largest),
                     changes.empty() ? "" : " (" + changes + ")");
}

std::string StepCheck::after_loss() const {
  if (no_contact < long_loss) return "";
  return fmt::format(" There is no contact for {}: every impact depends on the one before, so that a smaller step need not settle the run.",
                     format_quantity(no_contact, "s"));
}

std::string StepCheck::why_not(const std::string& steps) const {
  if (!reason.empty()) return fmt::format("{} ({}).", reason, steps);
  if (decisive.excess() > 1)
    return fmt::format("with twice the step ({}) {} changes by {}; a step of {} is expected to be sufficient.", steps,
                       what_changes(decisive.quantity, decisive.of), percent(decisive.change), format_quantity(sufficient_step, "s"));
  if (part.change > accepted_force_change)
    return fmt::format("with twice the step ({}) the {} of {} from {} to {} changes by {} of that of the whole time.", steps,
                       part.quantity->brief, part.of, format_quantity(part.from, "s"), format_quantity(part.to, "s"), percent(part.change));
  return fmt::format("the time scheme lost {} of the energy that was put in, because a step of {} does not resolve the motion.",
                     percent(lost), format_quantity(step, "s"));
}

std::string format_step_change(const VerdictNumber& number) {
  if (!number.coarse || is_noise_in_both(number)) return "";
  const VerdictQuantity& quantity = *number.quantity;
  const double difference = std::abs(*number.coarse - number.value);
  if (is_share(quantity)) return difference < 0.0005 ? "< 0.1 points" : fmt::format("\u00b1{:.2g} points", 100 * difference);
  if (!near_zero(quantity)) return change_in_words(number, difference);
  const bool nothing = difference <= nothing_beside(quantity.unit) || difference < 0.01 * number.swing.value_or(0);
  return "\u00b1" + (nothing ? "0" : format_quantity_within(difference, difference, quantity.unit));
}

}  // namespace uplift
