#include "uplift/io/verdict_json.h"

namespace uplift {
namespace {

void write_numbers(JsonWriter& json, const std::vector<VerdictNumber>& numbers) {
  json.begin_object();
  for (const VerdictNumber& number : numbers) {
    json.key(number.quantity->name).begin_object().member("value", number.value).member("unit", number.quantity->unit);
    if (number.time) json.member("time", *number.time);
    if (number.swing) json.member("swing", *number.swing);
    if (number.bonded) json.member("bonded", *number.bonded);
    if (number.bonded && *number.bonded != 0) json.member("change_percent", 100 * (number.value / *number.bonded - 1));
    json.end_object();
  }
  json.end_object();
}

void write_interface(JsonWriter& json, const InterfaceVerdict& said) {
  json.begin_object().member("name", said.name);
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
  json.end_array().end_object();
}

void write_criterion(JsonWriter& json, const CriterionResult& result) {
  const VerdictQuantity& quantity = *result.criterion.quantity;
  json.begin_object().member("quantity", quantity.name).member("interface", result.interface).member("result", to_string(result.state));
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

void write_floor_changes(JsonWriter& json, const FloorAnswers* floors) {
  json.begin_array();
  const FloorRun none, &run = floors && !floors->runs.empty() ? floors->runs.front() : none;
  for (std::size_t k = 0; k < run.beside.size(); ++k)
    for (const FloorChange& change : run.beside[k]) {
      json.begin_object().member("floor", run.floors[k].name).member("damping", change.damping).key("bands").begin_array();
      for (const FloorChange::Band& band : change.bands)
        json.begin_object().member("band", to_string(band.band)).member("change_percent", 100 * band.change).end_object();
      json.end_array().end_object();
    }
  json.end_array();
}

void write_verdict_numbers(JsonWriter& json, const Verdict& verdict, const std::vector<RunResult>& runs, const FloorAnswers* floors) {
  json.begin_object().member("level", to_string(verdict.level)).member("headline", verdict.headline);
  json.member("consequence", verdict.consequence);
  json.member("run", runs.empty() ? "" : runs.front().name);
  json.key("numbers");
  write_numbers(json, verdict.numbers.whole);
  json.key("interfaces").begin_array();
  for (const InterfaceVerdict& said : verdict.numbers.interfaces) write_interface(json, said);
  json.end_array().key("criteria").begin_array();
  for (const CriterionResult& result : verdict.numbers.criteria) write_criterion(json, result);
  json.end_array().key("floors");
  write_floor_changes(json, floors);
  json.end_object();
}

}  // namespace uplift
