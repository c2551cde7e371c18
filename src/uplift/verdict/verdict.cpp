#include "uplift/verdict/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "uplift/base/format.h"
#include "uplift/verdict/energy_facts.h"
#include "uplift/verdict/result_warnings.h"
#include "uplift/verdict/second_order.h"
#include "uplift/verdict/standing.h"

namespace uplift {
namespace {

/// "0.687" at "1.45 s"; eccentricities and safeties have no unit.
std::string at(const VerdictNumber& number) {
  return number.time ? "at " + format_quantity(*number.time, "s") : "";
}

/// Adds a fact for a number that there is: its value in the words of its unit, `detail` with its time behind.
void say(const VerdictNumber* number, const std::string& label, std::string detail, Verdict& verdict, bool tile = false) {
  if (!number) return;
  if (number->time) detail += (detail.empty() ? "" : ", ") + at(*number);
  verdict.facts.push_back({label, text_of(*number), std::move(detail), tile, format_step_change(*number)});
}

std::string of_interface(const Verdict& verdict, const InterfaceVerdict& said) {
  return verdict.numbers.bases() > 1 ? " of " + said.name : "";
}

std::span<const InterfaceVerdict> bases_of(const Verdict& verdict) {
  return std::span(verdict.numbers.interfaces).first(verdict.numbers.bases());
}

bool has_base(const BuiltCase& built) {
  return std::ranges::any_of(built.facts, [](const InterfaceFacts& each) { return each.role == Role::base; });
}

/// Forces of a strip are those of one metre of it.
std::string per_metre(const BuiltCase& built) {
  return built.is_strip() ? " per metre" : "";
}

/// "1.2 s to 1.35 s, 2.1 s to 2.2 s and 3 more": when an interval lasts.
std::string times_of(const std::vector<Interval>& intervals) {
  constexpr std::size_t most = 3;
  std::vector<std::string> parts;
  for (const Interval& each : intervals)
    if (parts.size() < most) parts.push_back(fmt::format("{} to {}", format_quantity(each.from, "s"), format_quantity(each.to, "s")));
  const std::string more = intervals.size() > most ? fmt::format(" and {} more", intervals.size() - most) : "";
  return fmt::format("{}{}", fmt::join(parts, ", "), more);
}

double full_loss_of(const Verdict& verdict) {
  const VerdictNumber* lost = find_number(verdict.numbers.whole, "full_loss_of_contact");
  return lost ? lost->value : 0;
}

/// The headline of a run that came to its end (or was interrupted).
std::string headline_of(const BuiltCase& built, const RunResult& run, const Verdict& verdict) {
  if (built.facts.empty()) return "A linear run without an interface";
  const char* what = has_base(built) ? "base" : "interface";
  if (!(run.max_uplifted_ratio.value > 0)) return fmt::format("The {} does not {}", what, has_base(built) ? "uplift" : "open");
  if (const double lost = full_loss_of(verdict); lost > 0)
    return fmt::format("Full loss of contact: {} no contact for {} in total, the gap reaches {}",
                       verdict.numbers.bases() > 1 ? "all bases at once have" : fmt::format("the {} has", what), format_quantity(lost, "s"),
                       format_quantity(run.max_opening.value, "m"));
  return fmt::format("The {} {}: up to {} of its area, by up to {}", what, has_base(built) ? "uplifts" : "opens",
                     percent(run.max_uplifted_ratio.value), format_quantity(run.max_opening.value, "m"));
}

/// The foundation whose ground uses all of its bearing capacity; empty: none.
std::string failed_ground(const Verdict& verdict) {
  constexpr double all = 0.999;
  for (const InterfaceVerdict& said : bases_of(verdict))
    if (const VerdictNumber* used = find_number(said.numbers, "max_bearing_utilisation"); used && used->value >= all) return said.name;
  return "";
}

/// Level, headline and what an extraordinary end means.
void say_outcome(const BuiltCase& built, const RunResult& run, Verdict& verdict) {
  using Level = Verdict::Level;
  const bool in_statics = statics_alone(built.plan) || run.steps.size() == 0;
  const std::string end = format_quantity(run.end_time, "s"), when = in_statics ? "under the static loads" : "at " + end;
  if (run.status == RunStatus::failed) {
    verdict.level = Level::failed;
    verdict.headline = "The run failed: " + run.reason;
    verdict.paragraphs.push_back(in_statics ? "The load steps up to the last equilibrium are kept; they are not a result."
                                            : fmt::format("The values up to {} are shown and marked; they are not a result.", end));
  } else if (run.status == RunStatus::overturned) {
    verdict.level = Level::overturned;
    const std::string failed = failed_ground(verdict);
    verdict.headline = fmt::format("{}: the rotation exceeds {} {}", failed.empty() ? "Overturning" : "Bearing failure under " + failed,
                                   format_quantity(built.plan.rotation_limit, "rad"), when);
    verdict.paragraphs.push_back(fmt::format(
        "The run ended because {}. Beyond this rotation (limits.rotation) the small-displacement model is not valid: the {}. All values "
        "are "
        "those reached until then.",
        run.reason,
        failed.empty() ? "structure overturns or comes close to it" : "ground uses its whole bearing capacity, and the foundation tilts"));
  } else if (run.status == RunStatus::separated) {
    verdict.level = Level::separated;
    verdict.headline = fmt::format("Full loss of contact: {} the base is open everywhere by more than {}", when,
                                   format_quantity(built.plan.separation_limit, "m"));
    verdict.paragraphs.push_back(
        "The run ended because the whole base left the ground by more than limits.separation. Beyond this gap the small-displacement model "
        "is not valid; it cannot tell whether and where the structure comes down. All values are those reached until then.");
  } else {
    verdict.level = run.max_uplifted_ratio.value > 0 ? Level::uplift : Level::none;
    verdict.headline = headline_of(built, run, verdict);
  }
  if (run.status == RunStatus::interrupted) verdict.headline += fmt::format(" (interrupted at {})", end);
}

/// What the weight does to the structure that has moved, where that is more than may be neglected.
void say_second_order(const BuiltCase& built, const RunResult& run, Verdict& verdict) {
  const std::optional<SecondOrderMoment> effects = second_order_of(built, run, verdict.numbers);
  if (!effects || !effects->counts()) return;
  if (const std::string clause = effects->clause(); !clause.empty() && run.status == RunStatus::completed)
    verdict.headline += "; " + clause;
  verdict.facts.push_back({"Weight times drift", format_quantity(effects->moment(), "N m"),
                           fmt::format("second-order moment, left out: {} of the base moment{}", percent(effects->ratio()),
                                       std::isfinite(effects->least_left)
                                           ? fmt::format("; until it overturns {} are left", format_quantity(effects->least_left, "N m"))
                                           : ""),
                           effects->exceeds_what_is_left()});
}

void say_full_loss(Verdict& verdict) {
  const std::vector<Interval>& intervals = verdict.numbers.full_loss;
  const bool several = verdict.numbers.bases() > 1;
  for (const InterfaceVerdict& said : bases_of(verdict))
    if (const VerdictNumber* lost = find_number(said.numbers, "full_loss_time"); several && lost && lost->value > 0)
      verdict.facts.push_back({"No contact of " + said.name, format_quantity(lost->value, "s"), times_of(said.full_loss), false});
  if (intervals.empty()) return;
  verdict.facts.push_back({several ? "No contact of all bases at once" : "Full loss of contact",
                           format_quantity(full_loss_of(verdict), "s"), times_of(intervals), true});
  verdict.paragraphs.push_back(fmt::format(
      "During a full loss of contact no force acts between base and ground: the structure moves freely, and the next contact is "
      "an impact. This happens {} for {} in total ({}).",
      intervals.size() == 1 ? "once" : fmt::format("{} times", intervals.size()), format_quantity(full_loss_of(verdict), "s"),
      times_of(intervals)));
}

void say_uplift(const BuiltCase& built, const RunResult& run, Verdict& verdict) {
  if (built.facts.empty()) {
    verdict.paragraphs.push_back("The model has no interface: a linear analysis, which cannot tell whether anything uplifts.");
    return;
  }
  if (run.max_uplifted_ratio.value <= 0) {
    verdict.paragraphs.push_back(fmt::format("No point of any {} opened: a linear analysis of the bonded model is enough for these loads.",
                                             has_base(built) ? "base" : "interface"));
    return;
  }
  for (const InterfaceVerdict& said : bases_of(verdict)) {
    const std::string of = of_interface(verdict, said);
    say(find_number(said.numbers, "max_uplifted_ratio"), "Uplifted area" + of, "largest share with an open gap", verdict, true);
    say(find_number(said.numbers, "max_opening"), "Largest gap" + of, "", verdict, true);
    for (const InterfaceVerdict::Above& above : said.above)
      verdict.facts.push_back({fmt::format("Uplifted above {}{}", percent(above.threshold), of), format_quantity(above.duration, "s"),
                               "threshold of the case", false});
  }
  std::string text = fmt::format("The {} first opens at {}. A gap is open during {} of {} ({}).", has_base(built) ? "base" : "interface",
                                 format_quantity(run.first_uplift, "s"), format_quantity(run.time_uplifted, "s"),
                                 format_quantity(run.end_time, "s"), percent(run.end_time > 0 ? run.time_uplifted / run.end_time : 0));
  if (verdict.numbers.full_loss.empty()) text += " There is no full loss of contact.";
  if (run.max_penetration > built.plan.gap_tolerance)
    text += fmt::format(" Largest compression of the joint: {}.", format_quantity(run.max_penetration, "m"));
  verdict.paragraphs.push_back(std::move(text));
  say_full_loss(verdict);
}

/// What walls carry of the moment of the foundation: "; the walls carry 24 % of the total 5.4 MN m".
std::string carried_by_walls(const Verdict& verdict, const std::string& unit) {
  const VerdictNumber* total = find_number(verdict.numbers.whole, "max_total_moment");
  double share = 0;
  bool known = false;
  for (const InterfaceVerdict& said : verdict.numbers.interfaces)
    if (const VerdictNumber* each = find_number(said.numbers, "share_of_base_moment")) share += each->value, known = true;
  return total && known ? fmt::format("; the walls carry {} of the total {}{}", percent(share), format_quantity(total->value, "N m"), unit)
                        : "";
}

std::string compared(const VerdictNumber& number) {
  return number.change ? format_change(*number.change) + " compared with the bonded model" : "largest";
}

void say_forces(const BuiltCase& built, const RunResult& run, Verdict& verdict) {
  if (built.facts.empty()) return;
  const VerdictNumber* moment = nullptr;  // of the base with the largest one
  std::string of_base;
  for (const InterfaceVerdict& said : bases_of(verdict))
    if (const VerdictNumber* each = find_number(said.numbers, "max_moment"); each && (!moment || each->value > moment->value))
      moment = each, of_base = of_interface(verdict, said);
  verdict.facts.push_back({"Base moment" + of_base + per_metre(built), format_quantity(std::abs(run.max_base_moment.value), "N m"),
                           fmt::format("{}, at {}{}", moment ? compared(*moment) : "largest",
                                       format_quantity(run.max_base_moment.time, "s"), carried_by_walls(verdict, per_metre(built))),
                           true, moment ? format_step_change(*moment) : ""});
  for (const InterfaceVerdict& said : bases_of(verdict)) {
    const std::string of = of_interface(verdict, said);
    say(find_number(said.numbers, "max_eccentricity"), label_of_eccentricity(said) + of, words_of_eccentricity(said), verdict);
    say(find_number(said.numbers, "min_overturning_safety"), "Safety against overturning" + of, "least, about the toe", verdict);
    say(find_number(said.numbers, "min_sliding_safety"), "Safety against sliding" + of, "least", verdict);
    say(find_number(said.numbers, "max_bearing_utilisation"), "Utilisation of bearing capacity" + of,
        "largest, of the capacity under the shear and the moment at that time", verdict);
    say(find_number(said.numbers, "max_sliding_utilisation"), "Utilisation of sliding resistance" + of, "largest", verdict);
    const VerdictNumber* ratio = find_number(said.numbers, "toe_pressure_ratio");
    say(find_number(said.numbers, "max_toe_pressure"), "Largest pressure" + of,
        ratio ? fmt::format("{:.3g} times the mean {}", ratio->value, format_quantity(said.mean_pressure, "Pa")) : "", verdict);
  }
}

/// Which forces the numbers of a foundation with radiation dashpots are made of.
void say_radiation(const BuiltCase& built, Verdict& verdict) {
  for (const Interface& interface : built.model.interfaces)
    if (interface.footprint && !radiation_damping(*interface.footprint).empty())
      verdict.paragraphs.push_back(
          fmt::format("The forces of {} are those of its law and of the radiation dashpots beside it: base shear, moment, eccentricity and "
                      "safeties contain both, uplift and utilisations belong to the law.",
                      interface.name));
}

/// What is noise beside the excitation, or nothing beside the precision of a run.
bool is_negligible(const VerdictNumber& number) {
  return std::abs(number.value) <= std::max(number.least, nothing_beside(number.quantity->unit));
}

void say_structure(const BuiltCase& built, Verdict& verdict) {
  const auto fact = [&](QuantityName name, const char* label, const std::string& detail, bool tile) {
    const VerdictNumber* number = find_number(verdict.numbers.whole, name);
    if (!number || is_negligible(*number)) return;
    const std::string change = number->change ? compared(*number) + ", " : "";
    verdict.facts.push_back({label, text_of(*number), change + detail + at(*number), tile, format_step_change(*number)});
  };
  fact("max_top_motion", "Top motion", built.name_of_top() + ", ", true);
  fact("max_drift", "Drift of the top", "relative to " + (verdict.numbers.bases() > 1 ? built.facts.front().name : "the base") + ", ",
       false);
  fact("max_drift_without_rotation", "Drift without base rotation", "deformation of the structure, ", false);
  fact("max_storey_shear", "Storey shear", "largest of those recorded, ", false);
  fact("max_drift_ratio", "Drift ratio", "largest of those recorded, ", false);
}

void say_compared(const BuiltCase& built, const RunResult& bonded, Verdict& verdict) {
  if (bonded.status != RunStatus::completed) {
    verdict.paragraphs.push_back(
        fmt::format("The bonded reference run did not reach its end ({}): there is nothing to compare with.", bonded.reason));
    return;
  }
  std::vector<std::string> parts;
  const auto add = [&parts](const std::string& what, const VerdictNumber* number, std::string_view unit) {
    if (!number || !number->bonded) return;
    parts.push_back(number->change ? fmt::format("{}: {} ({} instead of {})", what, format_change(*number->change),
                                                 format_quantity(number->value, unit), format_quantity(*number->bonded, unit))
                                   : what + ": no excitation in this direction");
  };
  for (const InterfaceVerdict& said : bases_of(verdict))
    add("largest base moment" + of_interface(verdict, said) + per_metre(built), find_number(said.numbers, "max_moment"), "N m");
  if (built.top >= 0) add("largest motion of " + built.name_of_top(), find_number(verdict.numbers.whole, "max_top_motion"), "m");
  if (!parts.empty()) verdict.paragraphs.push_back(fmt::format("Compared with the bonded model, {}.", fmt::join(parts, "; ")));
}

/// What the walls of the foundation do.
void say_walls(Verdict& verdict) {
  for (const InterfaceVerdict& said : verdict.numbers.interfaces) {
    if (said.role != Role::wall) continue;
    say(find_number(said.numbers, "max_opening"), "Largest gap of " + said.name, "", verdict);
    say(find_number(said.numbers, "max_slip"), "Largest slip of " + said.name, "", verdict);
    say(find_number(said.numbers, "max_toe_pressure"), "Largest pressure of " + said.name, "", verdict);
    say(find_number(said.numbers, "share_of_horizontal_force"), "Share of horizontal force, " + said.name, "", verdict);
    say(find_number(said.numbers, "share_of_base_moment"), "Share of base moment, " + said.name, "", verdict);
  }
}

/// The linear tension ratio compared with what happened.
void say_tension(Verdict& verdict) {
  for (const InterfaceVerdict& said : bases_of(verdict)) {
    const VerdictNumber *pulls = find_number(said.numbers, "linear_tension_ratio"),
                        *uplift = find_number(said.numbers, "predicted_uplifted_ratio"),
                        *happened = find_number(said.numbers, "max_uplifted_ratio");
    if (!pulls || !happened || pulls->value <= 0) continue;
    std::string text =
        fmt::format("A linear analysis finds tension on {} of the base{}. ", percent(pulls->value), of_interface(verdict, said));
    text += uplift ? fmt::format("By equal energy this corresponds to an uplift of {} (strip on Winkler springs); {} was computed.",
                                 percent(uplift->value), percent(happened->value))
                   : fmt::format(
                         "The estimate of the uplift by equal energy does not apply for tension ratios of 0.5 or more; {} was computed.",
                         percent(happened->value));
    verdict.paragraphs.push_back(std::move(text));
  }
}

void say_residual(Verdict& verdict) {
  const auto fact = [&verdict](const VerdictNumber* left, const std::string& label) {
    if (!left) return;
    const std::string swing = swing_text(*left);
    verdict.facts.push_back({label, text_of(*left),
                             swing.empty() ? "at rest" : fmt::format("mean of the last tenth of the run, remaining variation ±{}", swing),
                             false, format_step_change(*left)});
  };
  for (const InterfaceVerdict& said : bases_of(verdict)) {
    const std::string of = of_interface(verdict, said);
    fact(find_number(said.numbers, "residual_rotation"), "Residual rotation" + of);
    fact(find_number(said.numbers, "residual_settlement"), "Residual settlement" + of);
    fact(find_number(said.numbers, "residual_slip"), "Residual slip" + of);
  }
}

/// Why the case was not run with twice the step, where that is not the user's choice.
std::string reason_of_no_companion(const RunPlan& plan) {
  for (const Stage& stage : plan.stages)
    if (stage.type == Stage::Type::dynamics && stage.duration < least_steps_to_compare * stage.step)
      return fmt::format("a dynamic stage has fewer than {:g} steps", least_steps_to_compare);
  return "";
}

/// What the uplift changes: forces, motion and floors compared with the bonded model, then the user's limits.
void say_consequence(const FloorRun* floors, Verdict& verdict) {
  std::vector<std::string> parts;
  const auto add = [&parts](const char* what, const VerdictNumber* number) {
    if (number && number->change) parts.push_back(fmt::format("{} {}", what, format_change(*number->change)));
  };
  const bool several = verdict.numbers.bases() > 1, walls = verdict.numbers.bases() < verdict.numbers.interfaces.size();
  if (verdict.numbers.bases() == 1) {
    add("base moment", find_number(verdict.numbers.interfaces.front().numbers, "max_moment"));
    add("base shear", find_number(verdict.numbers.interfaces.front().numbers, "max_shear"));
  }
  add(!walls    ? "moment of all bases"
      : several ? "moment of bases and walls"
                : "moment of base and walls",
      find_number(verdict.numbers.whole, "max_total_moment"));
  if (several)
    add(walls ? "horizontal force of bases and walls" : "shear of all bases", find_number(verdict.numbers.whole, "max_total_shear"));
  add("top motion", find_number(verdict.numbers.whole, "max_top_motion"));
  if (const std::string range = floors ? range_of_bands(*floors) : ""; !range.empty()) {
    parts.push_back("floor spectra " + range);
    const StepCheck& check = verdict.step_check;
    const std::string with =
        check.floors_to > 0 ? fmt::format("; change with twice the step up to {}", format_quantity(check.floors_to, "Hz")) : "";
    verdict.facts.push_back({"Floor spectra", range, "peaks of the bands, compared with the bonded model" + with, true,
                             check.floors_to > 0 ? "\u00b1" + percent(check.floors) : ""});
  }
  if (const std::string arising = floors ? arising_floors(*floors) : ""; !arising.empty()) parts.push_back(arising);
  if (!parts.empty()) verdict.consequence = fmt::format("Compared with the bonded model: {}.", fmt::join(parts, ", "));
  const auto& criteria = verdict.numbers.criteria;
  if (criteria.empty()) return;
  const auto met = std::ranges::count(criteria, CriterionResult::State::met, &CriterionResult::state);
  verdict.consequence += fmt::format("{}{} of {} criteria met.", parts.empty() ? "" : " ", met, criteria.size());
}

}  // namespace

std::string_view to_string(Verdict::Level level) {
  switch (level) {
    case Verdict::Level::none:
      return "none";
    case Verdict::Level::uplift:
      return "uplift";
    case Verdict::Level::overturned:
      return "overturned";
    case Verdict::Level::separated:
      return "separated";
    case Verdict::Level::failed:
      return "failed";
  }
  return "";
}

Verdict judge(const BuiltCase& built, const RunResult& run, const RunResult* bonded, const FloorRun* floors, const Companion* companion) {
  if (statics_alone(built.plan) && run.status == RunStatus::completed) return judge_standing(built, run);
  Verdict verdict;
  const bool nothing = run.status != RunStatus::completed && run.counts.steps == 0;
  if (!nothing) verdict.numbers = numbers_of(built, run, bonded);
  if (!nothing && companion) verdict.step_check = check_step(built, run, floors, *companion, verdict.numbers);
  if (!companion) verdict.step_check.reason = reason_of_no_companion(built.plan);
  say_outcome(built, run, verdict);
  if (nothing) return verdict;
  say_second_order(built, run, verdict);
  if (verdict.step_check.state == StepCheck::State::not_converged) verdict.headline += " (not converged)";
  say_uplift(built, run, verdict);
  say_forces(built, run, verdict);
  say_radiation(built, verdict);
  say_structure(built, verdict);
  if (bonded) say_compared(built, *bonded, verdict);
  say_consequence(floors, verdict);
  say_walls(verdict);
  say_tension(verdict);
  say_residual(verdict);
  say_energy(built, run, verdict);
  for (const std::string& note : run.notes) verdict.paragraphs.push_back(note);
  return verdict;
}

}  // namespace uplift
