#include "uplift/io/results/verdict_json.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "uplift/base/format.h"
#include "uplift/io/results/thin_history.h"
#include "uplift/io/results/words.h"
#include "uplift/verdict/base_over_time.h"

namespace uplift {
namespace {

constexpr std::string_view not_excited = "no excitation in this direction";

void write_number(ResultWriter& out, const VerdictNumber& number) {
  constexpr std::string_view unit = "as stated in unit";
  out.number("value", number.value, unit, "value of the run");
  out.text("unit", number.quantity->unit, "unit of the numbers beside it");
  out.number("time", number.time, "s", "time at which it is reached");
  out.number("peak_of_step_mean", number.step_peak, unit, "largest mean over one step, of a number that is a mean over the window");
  out.number("at_twice_the_step", number.coarse, unit, "value of the companion run with twice the step");
  std::optional<double> step_change, change;
  if (number.step_change) step_change = 100 * *number.step_change;
  if (number.change) change = 100 * *number.change;
  out.number("step_change_percent", step_change, "%", "change with twice the step, relative to the reference of the number");
  out.number(
      "swing", number.swing, unit,
      "half of the range in which a residual value still varies; in space, of rotation and slip, the largest distance from the mean");
  out.number("bonded", number.bonded, unit, "value of the bonded reference run");
  out.number("change_percent", change, "%", "change compared with the bonded reference run");
  out.when(number.bonded && !number.change).constant("change_note", not_excited, "why there is no change");
}

/// `whose`: the numbers that there can be.
void write_numbers(ResultWriter& out, const std::vector<VerdictNumber>& numbers, bool (*whose)(const VerdictQuantity&)) {
  out.object("numbers", "the numbers that apply, by quantity", [&] {
    const auto write = [&](const VerdictNumber& number) {
      const VerdictQuantity& quantity = *number.quantity;
      out.when(true).object_of("number", quantity.name, quantity.unit, quantity.meaning, [&] { write_number(out, number); });
    };
    for (const VerdictNumber& number : numbers) write(number);
    for (const VerdictQuantity& quantity : verdict_quantities)
      if (out.is_schema() && whose(quantity)) write({.quantity = &quantity});
  });
}

/// What the verdict follows over time, in few points that keep its peaks. Safeties that are infinite, or of a base that carries nothing,
/// are left out.
void write_over_time(ResultWriter& out, const BuiltCase* built, const RunResult* run, std::size_t interface) {
  constexpr std::size_t points = 200;
  constexpr double highest = 100;
  using enum BaseHistory;
  const bool any = built != nullptr && run != nullptr && run->steps.size() > 0;
  out.when(any).object("over_time", "histories in at most 200 points that keep their peaks", [&] {
    for (const auto& [name, which, meaning] :
         {std::tuple{"uplifted_ratio", uplifted_ratio, "share of the area with a gap"},
          {"eccentricity_1", eccentricity_1,
           "eccentricity over the width along t, in space along x (along the side nearest to x of a turned rectangle)"},
          {"eccentricity_2", eccentricity_2, "in space: the same along y"},
          {"overturning_safety", overturning_safety, "safety against overturning, at most 100"},
          {"sliding_safety", sliding_safety, "safety against sliding, at most 100"}}) {
      const std::vector<double> all = any ? base_history(*built, *run, interface, which) : std::vector<double>();
      std::vector<double> time, values;
      for (std::size_t i = 0; i < all.size(); ++i)
        if (std::isfinite(all[i])) time.push_back(run->steps.time[i]), values.push_back(std::min(all[i], highest));
      if (!values.empty()) thin_history(time, values, points);
      out.when(!values.empty()).object(name, meaning, [&] {
        out.numbers("time", time, "s", "times");
        out.numbers("value", values, "1", "values");
      });
    }
  });
}

void write_base(ResultWriter& out, const InterfaceVerdict& said) {
  const auto one = [&](const char* key, double value, const char* unit, const char* meaning) {
    out.when(said.role == Role::base).object(key, meaning, [&] {
      out.number("value", value, unit, "value");
      out.unit(unit);
    });
  };
  one("static_force", said.weight, "N", "compression at rest");
  one("mean_pressure", said.mean_pressure, "Pa", "mean pressure at rest");
  out.when(said.role == Role::base).object("width", "extent of the interface along t1 and t2 (in the plane along t)", [&] {
    out.numbers("value", said.width, "m", "extents");
    out.unit("m");
  });
}

void write_interface(ResultWriter& out, const InterfaceVerdict& said, const BuiltCase* built, const RunResult* run, std::size_t k) {
  const bool base = said.role == Role::base;
  out.text("name", said.name, "name of the interface");
  out.word("role", to_string(said.role), {"base", "wall"}, "base, or wall of an embedded base");
  write_base(out, said);
  write_numbers(out, said.numbers, [](const VerdictQuantity& quantity) { return quantity.of_interface(); });
  out.when(base).list("above", "how long the uplifted share exceeds the thresholds of the case", said.above,
                      [&](const InterfaceVerdict::Above& above) {
                        out.number("uplifted_ratio", above.threshold, "1", "threshold");
                        out.number("duration", above.duration, "s", "total time above it");
                        out.unit("s");
                      });
  out.when(base);
  write_intervals(out, "full_loss", said.full_loss, "intervals without any contact");
  write_over_time(out, base ? built : nullptr, run, k);
}

void write_criterion(ResultWriter& out, const CriterionResult& result) {
  static const VerdictQuantity none{"", "", "", ""};
  const VerdictQuantity& quantity = result.criterion.quantity ? *result.criterion.quantity : none;
  using enum CriterionResult::State;
  out.text("quantity", quantity.name, "quantity of the verdict");
  out.when(!quantity.of_beam()).text("interface", result.interface, "interface that it is evaluated for; empty: the run as a whole");
  out.when(quantity.of_beam()).text("beam", result.interface, "beam that it is evaluated for");
  out.word("result", to_string(result.state), {to_string(met), to_string(not_met), to_string(undetermined)}, "result");
  constexpr std::string_view unit = "as stated in unit";
  out.number_or_null("value", result.value, unit, "value of the run; null: not computed");
  out.number("time", result.time, "s", "time at which the value is reached");
  out.number("limit", result.criterion.limit, unit, "limit of the case");
  out.text("unit", quantity.unit, "unit of value and limit");
  out.word("kind", quantity.at_least ? "at_least" : "at_most", {"at_least", "at_most"}, "side of the limit on which the criterion is met");
  out.text("source", result.criterion.source, "source of the limit, as the case states it");
  out.flag("within_step_change", result.within_step_change,
           "whether doubling the step changes the value by at least its distance from the limit");
}

void write_step_check(ResultWriter& out, const StepCheck& check) {
  using enum StepCheck::State;
  out.object("step_check", "how far the numbers depend on the time step", [&] {
    out.word("result", to_string(check.state), {to_string(not_made), to_string(converged), to_string(not_converged)}, "result");
    out.text("sentence", check.sentence(), "the result as a sentence");
    const bool made = check.coarse_step > 0, changed = check.largest > 0, floors = check.floors_to > 0;
    out.when(made).number("step", check.step, "s", "time step of the run");
    out.when(made).number("coarse_step", check.coarse_step, "s", "time step of the companion run");
    out.when(made).unit("s");
    out.when(changed).number("largest_change_percent", 100 * check.largest, "%", "largest change of a number of the verdict");
    out.when(changed).text("quantity", check.quantity ? check.quantity->name : "floor_spectrum", "number with this change");
    out.when(changed && !check.of.empty()).text("of", check.of, "interface, beam or floor of that number");
    const StepCheck::Decisive& decisive = check.decisive;
    out.when(decisive.excess() > 1).object("decisive", "number that changes most beside what is accepted for it", [&] {
      out.number("change_percent", 100 * decisive.change, "%", "its change");
      out.number("accepted_percent", 100 * decisive.accepted, "%", "change that is accepted");
      out.text("quantity", decisive.quantity ? decisive.quantity->name : "floor_spectrum", "number");
      out.text("of", decisive.of, "its interface, beam or floor; empty: of the whole run");
    });
    out.when(check.part.quantity != nullptr)
        .object("peaks_within_parts",
                "largest change of a peak of moment, compression or pressure of a base within a twentieth of the time", [&] {
                  out.number("change_percent", 100 * check.part.change, "%", "change, relative to the peak of the whole time");
                  out.text("quantity", check.part.quantity ? check.part.quantity->name : "", "number whose history it is");
                  out.text("of", check.part.of, "base");
                  out.number("from", check.part.from, "s", "beginning of the part");
                  out.number("to", check.part.to, "s", "its end");
                });
    out.when(floors).number("floor_spectra_change_percent", 100 * check.floors, "%", "largest change of a floor spectrum");
    out.when(floors).number("floor_spectra_to", check.floors_to, "Hz", "frequency up to which floor spectra were compared");
    out.when(check.sufficient_step > 0)
        .number("sufficient_step", check.sufficient_step, "s", "time step that is expected to be sufficient");
  });
}

/// Change of every floor spectrum of the first run compared with the bonded one in each frequency band.
void write_floor_changes(ResultWriter& out, const FloorAnswers* floors) {
  struct Floor {
    std::string name;
    FloorChange change;
  };
  std::vector<Floor> all;
  const FloorRun none, &run = floors && !floors->runs.empty() ? floors->runs.front() : none;
  for (std::size_t k = 0; k < run.beside.size(); ++k)
    for (const FloorChange& change : run.beside[k]) all.push_back({run.floors[k].name, {change.damping, {}, {}, {}, change.bands}});
  out.list("floors", "changes of the floor spectra of the run compared with the bonded reference run", all, [&](const Floor& floor) {
    out.text("floor", floor.name, "name of the floor");
    out.number("damping", floor.change.damping, "1", "damping ratio of the equipment");
    out.list("bands", "frequency bands", floor.change.bands, [&](const FloorChange::Band& band) {
      out.text("band", to_string(band.band), "frequency band");
      out.number("change_percent", 100 * band.change, "%", "change of the largest value in the band");
      out.text(
          "change",
          band.arises ? "up to " + format_quantity(band.largest, "m/s2") + " where the bonded model has none" : format_change(band.change),
          "the same as text");
      out.flag("arises", band.arises, "the bonded floor is not excited in the band: the change is that of a threshold");
    });
    out.when(floor.change.bands.empty()).constant("note", not_excited, "why there are no bands");
  });
}

}  // namespace

void write_verdict_numbers(ResultWriter& out, const Verdict& verdict, const std::vector<RunResult>& runs, const FloorAnswers* floors,
                           const BuiltCase* built, bool histories) {
  using enum Verdict::Level;
  const VerdictNumbers& numbers = verdict.numbers;
  out.object("verdict", "whether the base uplifts and what that changes", [&] {
    out.word("level", to_string(verdict.level),
             {to_string(none), to_string(uplift), to_string(overturned), to_string(separated), to_string(failed)}, "outcome in one word");
    out.text("headline", verdict.headline, "first sentence of the report");
    out.text("consequence", verdict.consequence, "second sentence: comparison with the bonded model and with the criteria");
    write_step_check(out, verdict.step_check);
    out.when(built && built->top >= 0).object("top", "what the motion of the top and the drift are those of", [&] {
      const bool any = built && built->top >= 0;
      const Place place = any ? built->top_place() : Place();
      out.text("node", any ? built->model.nodes[static_cast<std::size_t>(built->top)].name : "", "node");
      out.flag("centre_of_mass", any && !built->top_arm.isZero(0), "it is the centre of mass of the rigid body of this node, not the node");
      out.numbers("place", {place.data(), any ? static_cast<std::size_t>(built->model.space.dimension) : 0}, "m", "where it stands");
    });
    out.text("run", runs.empty() ? "" : runs.front().name, "name of the run that the verdict describes");
    out.flag("per_metre", built && built->is_strip(), "whether forces are per metre of depth");
    write_intervals(out, "full_loss_of_contact", numbers.full_loss, "intervals during which no base has any contact");
    write_numbers(out, numbers.whole, [](const VerdictQuantity& quantity) { return !quantity.of_interface() && !quantity.of_beam(); });
    struct Entry {
      const InterfaceVerdict* verdict = nullptr;
      std::size_t k = 0;
    };
    std::vector<Entry> interfaces;
    for (std::size_t k = 0; k < numbers.interfaces.size(); ++k) interfaces.push_back({&numbers.interfaces[k], k});
    out.list("interfaces", "the interfaces, bases first", interfaces, [&](const Entry& entry) {
      write_interface(out, entry.verdict ? *entry.verdict : InterfaceVerdict(), histories ? built : nullptr,
                      runs.empty() ? nullptr : &runs.front(), entry.k);
    });
    out.when(!numbers.beams.empty()).list("beams", "beams with an envelope", numbers.beams, [&](const BeamVerdict& beam) {
      out.text("name", beam.name, "name of the beam");
      write_numbers(out, beam.numbers, [](const VerdictQuantity& quantity) { return quantity.of_beam(); });
    });
    out.when(!numbers.storeys.empty())
        .list("storeys", "in space, storeys of which both axes are recorded", numbers.storeys, [&](const StoreyVerdict& storey) {
          out.text("name", storey.name, "level of the shear, or the nodes of the drift");
          write_numbers(out, storey.numbers, [](const VerdictQuantity& quantity) {
            return quantity.name.starts_with("max_storey_shear") || quantity.name.starts_with("max_drift_ratio");
          });
        });
    out.list("criteria", "criteria of the case", numbers.criteria, [&](const CriterionResult& result) { write_criterion(out, result); });
    write_floor_changes(out, floors);
  });
}

}  // namespace uplift
