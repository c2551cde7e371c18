#include "uplift/analysis/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "uplift/analysis/verdict_standing.h"
#include "uplift/analysis/wording.h"
#include "uplift/model/builder.h"

namespace uplift {
namespace {

using Column = Request::Kind;

constexpr double round_off = 1e-9;  // of the energy put in: below, nothing was created that a ledger in double precision can tell

int find_index(const RunResult& result, Request::Kind kind, int of) {
  for (std::size_t k = 0; k < result.columns.size(); ++k) {
    const Request& column = result.columns[k];
    const bool node =
        kind == Column::displacement || kind == Column::velocity || kind == Column::acceleration || kind == Column::absolute_acceleration;
    if (column.kind == kind && (node ? column.unknown : column.interface) == of) return static_cast<int>(k);
  }
  return -1;
}

/// "0.687" at "1.45 s"; eccentricities and safeties have no unit.
std::string at(const VerdictNumber& number) {
  return number.time ? "at " + spoken(*number.time, "s") : "";
}

/// Adds a fact for a number that there is: its value in the words of its unit, `detail` with its time behind.
void say(const VerdictNumber* number, const std::string& label, std::string detail, Verdict& verdict, bool tile = false) {
  if (!number) return;
  if (number->time) detail += (detail.empty() ? "" : ", ") + at(*number);
  verdict.facts.push_back({label, said(*number->quantity, number->value), std::move(detail), tile});
}

std::string of_interface(const Verdict& verdict, const InterfaceVerdict& said) {
  return verdict.numbers.interfaces.size() > 1 ? " of " + said.name : "";
}

void say_uplift(const Built& built, const RunResult& run, Verdict& verdict) {
  const double duration = run.end_time;
  if (built.facts.empty()) {
    verdict.paragraphs.push_back("The model has no interface: a linear analysis, which cannot say whether anything lifts off.");
    return;
  }
  if (run.max_uplifted_ratio.value <= 0) {
    verdict.paragraphs.push_back(
        "No point of any interface opened: a linear analysis of the bonded model would have been enough for these loads.");
    return;
  }
  for (const InterfaceVerdict& said : verdict.numbers.interfaces) {
    const std::string of = of_interface(verdict, said);
    say(find_number(said.numbers, "max_uplifted_ratio"), "Uplifted area" + of, "largest; counted by gap", verdict, true);
    say(find_number(said.numbers, "max_opening"), "Largest gap" + of, "", verdict, true);
    for (const InterfaceVerdict::Above& above : said.above)
      verdict.facts.push_back(
          {fmt::format("Uplifted above {}{}", percent(above.threshold), of), spoken(above.duration, "s"), "threshold of the case", false});
  }
  std::string text =
      fmt::format("The base first opens at {}. A gap stands open during {} of {} ({}).", spoken(run.first_uplift, "s"),
                  spoken(run.time_uplifted, "s"), spoken(duration, "s"), percent(duration > 0 ? run.time_uplifted / duration : 0));
  text += run.full_loss > 0 ? fmt::format(" All contact is lost during {} in total.", spoken(run.full_loss, "s"))
                            : " Contact is never lost altogether.";
  if (run.max_penetration > built.plan.gap_tolerance)
    text += fmt::format(" Where it is closed the joint is pressed together by at most {}.", spoken(run.max_penetration, "m"));
  verdict.paragraphs.push_back(std::move(text));
}

void say_forces(const Built& built, const RunResult& run, Verdict& verdict) {
  if (built.facts.empty()) return;
  const VerdictNumber* moment =
      verdict.numbers.interfaces.size() == 1 ? find_number(verdict.numbers.interfaces.front().numbers, "max_moment") : nullptr;
  const std::string change = moment && moment->bonded ? beside(moment->value, *moment->bonded) + " beside the bonded base" : "largest";
  verdict.facts.push_back({"Base moment", spoken(std::abs(run.max_base_moment.value), "N m"),
                           fmt::format("{}, at {}", change, spoken(run.max_base_moment.time, "s"))});
  for (const InterfaceVerdict& said : verdict.numbers.interfaces) {
    const std::string of = of_interface(verdict, said);
    say(find_number(said.numbers, "max_eccentricity"), "Eccentricity e/B" + of, "largest of M/N over the width", verdict);
    say(find_number(said.numbers, "min_overturning_safety"), "Safety against overturning" + of, "least, about the toe", verdict);
    say(find_number(said.numbers, "min_sliding_safety"), "Safety against sliding" + of, "least", verdict);
    const VerdictNumber* ratio = find_number(said.numbers, "toe_pressure_ratio");
    say(find_number(said.numbers, "max_toe_pressure"), "Largest pressure" + of,
        ratio ? fmt::format("{:.3g} times the mean {}", ratio->value, spoken(said.mean_pressure, "Pa")) : "", verdict);
  }
}

void say_beside_bonded(const Built& built, const RunResult& run, const RunResult& bonded, Verdict& verdict) {
  if (bonded.status != RunStatus::completed) {
    verdict.paragraphs.push_back(
        fmt::format("The bonded model could not be run to the end ({}): there is nothing to compare with.", bonded.reason));
    return;
  }
  std::string text;
  if (bonded.max_base_moment.value != 0)
    text += fmt::format("Beside the bonded base, the largest base moment is {} ({} instead of {})",
                        beside(run.max_base_moment.value, bonded.max_base_moment.value), spoken(std::abs(run.max_base_moment.value), "N m"),
                        spoken(std::abs(bonded.max_base_moment.value), "N m"));
  const VerdictNumber* top = find_number(verdict.numbers.whole, "max_top_motion");
  if (top && top->bonded) {
    text += fmt::format("{} the largest motion of {} is {} ({} instead of {})", text.empty() ? "Beside the bonded base," : ", and",
                        built.model.nodes[static_cast<std::size_t>(built.top)].name, beside(top->value, *top->bonded),
                        spoken(top->value, "m"), spoken(*top->bonded, "m"));
    verdict.facts.push_back(
        {"Top motion", spoken(top->value, "m"), fmt::format("{} beside the bonded base, {}", beside(top->value, *top->bonded), at(*top))});
  }
  if (!text.empty()) verdict.paragraphs.push_back(text + ".");
}

/// The linear tension ratio beside what happened.
void say_tension(Verdict& verdict) {
  for (const InterfaceVerdict& said : verdict.numbers.interfaces) {
    const VerdictNumber *pulls = find_number(said.numbers, "linear_tension_ratio"),
                        *uplift = find_number(said.numbers, "predicted_uplifted_ratio"),
                        *happened = find_number(said.numbers, "max_uplifted_ratio");
    if (!pulls || !happened || pulls->value <= 0) continue;
    std::string text =
        fmt::format("A linear analysis sees tension on {} of the base{}. ", percent(pulls->value), of_interface(verdict, said));
    text += uplift ? fmt::format("By equal energy that stands for an uplift of {} (strip on Winkler springs); {} was computed.",
                                 percent(uplift->value), percent(happened->value))
                   : fmt::format("From one half on no uplift can be told from it; {} was computed.", percent(happened->value));
    verdict.paragraphs.push_back(std::move(text));
  }
}

void say_residual(Verdict& verdict) {
  for (const InterfaceVerdict& said : verdict.numbers.interfaces)
    for (const auto& [name, label] : {std::pair{"residual_rotation", "Rotation left at the end"},
                                      {"residual_settlement", "Settlement left at the end"},
                                      {"residual_slip", "Slip left at the end"}}) {
      const VerdictNumber* left = find_number(said.numbers, name);
      if (!left) continue;
      const std::string_view unit = left->quantity->unit;
      const double nothing = nothing_beside(unit), swing = left->swing.value_or(0);
      const bool moves = swing >= nothing;
      verdict.facts.push_back(
          {label + of_interface(verdict, said),
           moves ? spoken_within(left->value, swing, unit) : spoken(std::abs(left->value) < nothing ? 0 : left->value, unit),
           moves ? fmt::format("mean of the last tenth; it still moves by +-{}", spoken_within(swing, swing, unit)) : "at rest", false});
    }
}

/// "-1.5 to +2.1 %": how far the bands of all floors and dampings change beside the bonded run.
std::string range_of_bands(const FloorRun& floors) {
  double least = INFINITY, most = -INFINITY;
  for (const std::vector<FloorChange>& floor : floors.beside)
    for (const FloorChange& change : floor)
      for (const FloorChange::Band& band : change.bands) least = std::min(least, band.change), most = std::max(most, band.change);
  if (!(least <= most)) return "";
  const auto shown = [](double share) { return fmt::format("{:+.{}f}", 100 * share, std::abs(share) < 0.0995 ? 1 : 0); };
  return fmt::format("{} to {} %", shown(least), shown(most));
}

/// What the uplift does: forces, motion and floors beside the bonded base, then the user's limits.
void say_consequence(const FloorRun* floors, Verdict& verdict) {
  std::vector<std::string> parts;
  const auto add = [&parts](const char* what, const VerdictNumber* number) {
    if (number && number->bonded.value_or(0) != 0) parts.push_back(fmt::format("{} {}", what, beside(number->value, *number->bonded)));
  };
  if (!verdict.numbers.interfaces.empty()) {
    add("base moment", find_number(verdict.numbers.interfaces.front().numbers, "max_moment"));
    add("base shear", find_number(verdict.numbers.interfaces.front().numbers, "max_shear"));
  }
  add("top motion", find_number(verdict.numbers.whole, "max_top_motion"));
  if (const std::string range = floors ? range_of_bands(*floors) : ""; !range.empty()) {
    parts.push_back("floor spectra " + range);
    verdict.facts.push_back({"Floor spectra", range, "peaks of the bands, beside the bonded base"});
  }
  if (!parts.empty()) verdict.consequence = fmt::format("Beside the bonded base: {}.", fmt::join(parts, ", "));
  const auto& criteria = verdict.numbers.criteria;
  if (criteria.empty()) return;
  const auto met = std::ranges::count(criteria, CriterionResult::State::met, &CriterionResult::state);
  verdict.consequence += fmt::format("{}{} of {} criteria met.", parts.empty() ? "" : " ", met, criteria.size());
}

void say_energy(const Built& built, const RunResult& run, Verdict& verdict) {
  const double scale = run.energy_scale;
  const double created = scale > 0 ? run.energy_created / scale : 0, lost = scale > 0 ? run.energy_lost / scale : 0;
  const bool too_much = created > built.plan.created_limit;
  verdict.facts.push_back({"Energy created by the computation", created < round_off ? "none" : percent(created),
                           fmt::format("of {}; limit {}", spoken(scale, "J"), percent(built.plan.created_limit)), too_much});
  std::string text =
      too_much ? fmt::format("The computation created {} of the energy put in ({} at {}): these results are not to be used.",
                             percent(created), spoken(run.energy_created, "J"), spoken(run.energy_created_time, "s"))
      : created < round_off
          ? "The energy balance closes: the computation created none of the energy put in."
          : fmt::format("The energy balance closes: the computation created at most {} of the energy put in.", percent(created));
  const Energies& end = run.final_energy;
  if (scale > 0) {
    if (end.damping > 1e-6 * scale) text += fmt::format(" Damping took {}.", percent(end.damping / scale));
    if (end.interface_dissipated > 1e-6 * scale) text += fmt::format(" The interface took {}.", percent(end.interface_dissipated / scale));
    if (std::abs(end.impact) > 1e-6 * scale) text += fmt::format(" Impacts took {}.", percent(end.impact / scale));
    if (lost > 0.001 && lost > created) text += fmt::format(" {} vanished by numerical damping.", percent(lost));
  }
  verdict.paragraphs.push_back(std::move(text));
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

const std::vector<double>* find_column(const RunResult& result, Request::Kind kind, int of) {
  const int index = find_index(result, kind, of);
  return index < 0 || static_cast<std::size_t>(index) + 1 >= result.table.size() ? nullptr
                                                                                 : &result.table[static_cast<std::size_t>(index) + 1];
}

const Peak* top_motion(const Built& built, const RunResult& result) {
  const Peak* largest = nullptr;
  for (int axis = 0; built.top >= 0 && axis < built.model.space.dimension; ++axis) {
    if (axis == built.model.space.up()) continue;
    const Peak* peak = find_peak(result, Column::displacement, built.model.at(built.top, built.model.space.dof(axis)));
    if (peak && (!largest || std::abs(peak->value) > std::abs(largest->value))) largest = peak;
  }
  return largest;
}

const Peak* find_peak(const RunResult& result, Request::Kind kind, int of) {
  const int index = find_index(result, kind, of);
  return index < 0 || static_cast<std::size_t>(index) >= result.peaks.size() ? nullptr : &result.peaks[static_cast<std::size_t>(index)];
}

Verdict judge(const Built& built, const RunResult& run, const RunResult* bonded, const FloorRun* floors) {
  if (statics_alone(built.plan) && run.status == RunStatus::completed) return judge_standing(built, run);
  Verdict verdict;
  if (run.status == RunStatus::failed) {
    verdict.level = Verdict::Level::failed;
    verdict.headline = "The run failed: " + run.reason;
    verdict.paragraphs.push_back(
        fmt::format("What was computed up to {} is shown and marked; it is not a result.", spoken(run.end_time, "s")));
  } else if (run.status == RunStatus::overturned) {
    verdict.level = Verdict::Level::overturned;
    verdict.headline =
        fmt::format("It overturns: at {} the rotation passes {}", spoken(run.end_time, "s"), spoken(built.plan.rotation_limit, "rad"));
    verdict.paragraphs.push_back("Beyond this rotation the small-displacement model says nothing; the run ended there.");
  } else if (run.status == RunStatus::separated) {
    verdict.level = Verdict::Level::separated;
    verdict.headline = fmt::format("It leaves the ground: at {} the base is open everywhere by more than {}", spoken(run.end_time, "s"),
                                   spoken(built.plan.separation_limit, "m"));
    verdict.paragraphs.push_back(
        "Beyond this gap the small-displacement model says nothing, nor whether and where the structure comes down; the run ended there.");
  } else if (run.max_uplifted_ratio.value > 0) {
    verdict.level = Verdict::Level::uplift;
    verdict.headline = fmt::format("The base uplifts: up to {} of its area, by up to {}", percent(run.max_uplifted_ratio.value),
                                   spoken(run.max_opening.value, "m"));
  } else {
    verdict.headline = built.facts.empty() ? "A linear run without an interface" : "The base does not uplift";
  }
  if (run.status == RunStatus::interrupted) verdict.headline += fmt::format(" (interrupted at {})", spoken(run.end_time, "s"));
  if (run.status == RunStatus::failed && run.counts.steps == 0) return verdict;
  verdict.numbers = numbers_of(built, run, bonded);
  say_uplift(built, run, verdict);
  say_forces(built, run, verdict);
  if (bonded) say_beside_bonded(built, run, *bonded, verdict);
  say_consequence(floors, verdict);
  say_tension(verdict);
  say_residual(verdict);
  say_energy(built, run, verdict);
  for (const std::string& note : run.notes) verdict.paragraphs.push_back(note);
  return verdict;
}

}  // namespace uplift
