#include "uplift/io/results/verdict_json.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "uplift/base/format.h"
#include "uplift/io/report/parts.h"

namespace uplift {
namespace {

void write_numbers(JsonWriter& json, const std::vector<VerdictNumber>& numbers) {
  json.begin_object();
  for (const VerdictNumber& number : numbers) {
    json.key(number.quantity->name).begin_object().member("value", number.value).member("unit", number.quantity->unit);
    if (number.time) json.member("time", *number.time);
    if (number.step_peak) json.member("peak_of_step_mean", *number.step_peak);
    if (number.coarse) json.member("at_twice_the_step", *number.coarse);
    if (number.step_change) json.member("step_change_percent", 100 * *number.step_change);
    if (number.swing) json.member("swing", *number.swing);
    if (number.bonded) json.member("bonded", *number.bonded);
    if (number.change) json.member("change_percent", 100 * *number.change);
    if (number.bonded && !number.change) json.member("change_note", "no excitation in this direction");
    json.end_object();
  }
  json.end_object();
}

/// What the verdict follows over time, in few points that keep its peaks. Safeties that are infinite, or of a base that carries nothing,
/// are left out.
void write_over_time(JsonWriter& json, const BuiltCase& built, const RunResult& run, std::size_t interface) {
  constexpr std::size_t points = 200;
  constexpr double highest = 100;
  using enum BaseHistory;
  json.key("over_time").begin_object();
  for (const auto& [name, which] : {std::pair{"uplifted_ratio", uplifted_ratio},
                                    {"eccentricity_1", eccentricity_1},
                                    {"eccentricity_2", eccentricity_2},
                                    {"overturning_safety", overturning_safety},
                                    {"sliding_safety", sliding_safety}}) {
    const std::vector<double> all = base_history(built, run, interface, which);
    std::vector<double> time, values;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (std::isfinite(all[i])) time.push_back(run.steps.time[i]), values.push_back(std::min(all[i], highest));
    if (values.empty()) continue;
    thin_history(time, values, points);
    json.key(name).begin_object().key("time").numbers(time).key("value").numbers(values).end_object();
  }
  json.end_object();
}

void write_interface(JsonWriter& json, const InterfaceVerdict& said) {
  json.begin_object().member("name", said.name).member("role", to_string(said.role));
  if (said.role == Role::wall) {
    write_numbers(json.key("numbers"), said.numbers);
    return;
  }
  json.key("static_force").begin_object().member("value", said.weight).member("unit", "N").end_object();
  json.key("mean_pressure").begin_object().member("value", said.mean_pressure).member("unit", "Pa").end_object();
  json.key("width").begin_object().key("value").numbers(said.width).member("unit", "m").end_object();
  json.key("numbers");
  write_numbers(json, said.numbers);
  json.key("above").begin_array();
  for (const InterfaceVerdict::Above& above : said.above)
    json.begin_object().member("uplifted_ratio", above.threshold).member("duration", above.duration).member("unit", "s").end_object();
  json.end_array().key("full_loss").begin_array();
  for (const Interval& interval : said.full_loss)
    json.begin_object().member("from", interval.from).member("to", interval.to).member("unit", "s").end_object();
  json.end_array();
}

void write_criterion(JsonWriter& json, const CriterionResult& result) {
  const VerdictQuantity& quantity = *result.criterion.quantity;
  json.begin_object()
      .member("quantity", quantity.name)
      .member(quantity.of_beam ? "beam" : "interface", result.interface)
      .member("result", to_string(result.state));
  json.key("value");
  if (result.value)
    json.value(*result.value);
  else
    json.null();
  if (result.time) json.member("time", *result.time);
  json.member("limit", result.criterion.limit).member("unit", quantity.unit);
  json.member("kind", quantity.at_least ? "at_least" : "at_most").member("source", result.criterion.source).end_object();
}

}  // namespace

void write_step_check(JsonWriter& json, const StepCheck& check) {
  json.begin_object().member("result", to_string(check.state)).member("sentence", check.sentence());
  if (check.coarse_step > 0) json.member("step", check.step).member("coarse_step", check.coarse_step).member("unit", "s");
  if (check.largest > 0) {
    json.member("largest_change_percent", 100 * check.largest);
    json.member("quantity", check.quantity ? check.quantity->name : "floor_spectrum");
    if (!check.of.empty()) json.member("of", check.of);
  }
  if (check.floors_to > 0) json.member("floor_spectra_change_percent", 100 * check.floors).member("floor_spectra_to", check.floors_to);
  if (check.sufficient_step > 0) json.member("sufficient_step", check.sufficient_step);
  json.end_object();
}

void write_floor_changes(JsonWriter& json, const FloorAnswers* floors) {
  json.begin_array();
  const FloorRun none, &run = floors && !floors->runs.empty() ? floors->runs.front() : none;
  for (std::size_t k = 0; k < run.beside.size(); ++k)
    for (const FloorChange& change : run.beside[k]) {
      json.begin_object().member("floor", run.floors[k].name).member("damping", change.damping).key("bands").begin_array();
      for (const FloorChange::Band& band : change.bands)
        json.begin_object()
            .member("band", to_string(band.band))
            .member("change_percent", 100 * band.change)
            .member("change", format_change(band.change))
            .end_object();
      json.end_array();
      if (change.bands.empty()) json.member("note", "no excitation in this direction");
      json.end_object();
    }
  json.end_array();
}

void write_verdict_numbers(JsonWriter& json, const Verdict& verdict, const std::vector<RunResult>& runs, const FloorAnswers* floors,
                           const BuiltCase* built) {
  json.begin_object().member("level", to_string(verdict.level)).member("headline", verdict.headline);
  json.member("consequence", verdict.consequence);
  json.key("step_check");
  write_step_check(json, verdict.step_check);
  json.member("run", runs.empty() ? "" : runs.front().name);
  json.member("per_metre", built && built->is_strip());
  json.key("full_loss_of_contact").begin_array();
  for (const Interval& each : verdict.numbers.full_loss)
    json.begin_object().member("from", each.from).member("to", each.to).member("unit", "s").end_object();
  json.end_array().key("numbers");
  write_numbers(json, verdict.numbers.whole);
  json.key("interfaces").begin_array();
  for (std::size_t k = 0; k < verdict.numbers.interfaces.size(); ++k) {
    write_interface(json, verdict.numbers.interfaces[k]);
    const bool is_base = verdict.numbers.interfaces[k].role == Role::base;
    if (is_base && built && !runs.empty() && runs.front().steps.size() > 0) write_over_time(json, *built, runs.front(), k);
    json.end_object();
  }
  json.end_array();
  if (!verdict.numbers.beams.empty()) {
    json.key("beams").begin_array();
    for (const BeamVerdict& beam : verdict.numbers.beams) {
      json.begin_object().member("name", beam.name).key("numbers");
      write_numbers(json, beam.numbers);
      json.end_object();
    }
    json.end_array();
  }
  json.key("criteria").begin_array();
  for (const CriterionResult& result : verdict.numbers.criteria) write_criterion(json, result);
  json.end_array().key("floors");
  write_floor_changes(json, floors);
  json.end_object();
}

}  // namespace uplift
