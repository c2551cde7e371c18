#include "uplift/io/results/floors.h"

#include <algorithm>

#include "uplift/io/text/numbers.h"

namespace uplift {
namespace {

void write_block(std::string& text, const std::string& head, const FloorSpectra& floor, std::size_t damping, const FloorChange* change) {
  const Spectrum& raw = floor.raw[damping];
  std::size_t next = 0;  // of the change's frequencies: those of the spectrum, less the ones at which the bonded floor rests
  for (std::size_t i = 0; i < raw.frequencies.size(); ++i) {
    text += head;
    append_number(text, raw.damping);
    for (const double value : {raw.frequencies[i], raw.values[i]}) {
      text += ',';
      append_number(text, value);
    }
    text += ',';
    if (!floor.broadened.empty()) append_number(text, value_at(floor.broadened[damping], raw.frequencies[i]));
    const bool beside = change && next < change->frequencies.size() && change->frequencies[next] == raw.frequencies[i];
    text += ',';
    if (beside) append_number(text, change->bonded[next]);
    text += ',';
    if (beside) append_number(text, change->ratio[next++]);
    text += '\n';
  }
}

void write_peak(JsonWriter& json, std::string_view key, const Spectrum& spectrum) {
  const auto most = std::ranges::max_element(spectrum.values) - spectrum.values.begin();
  json.key(key).begin_object().member("value", spectrum.values[static_cast<std::size_t>(most)]);
  json.member("frequency", spectrum.frequencies[static_cast<std::size_t>(most)]).member("unit", "m/s2").end_object();
}

void write_change(JsonWriter& json, const FloorChange& change) {
  json.begin_array();
  for (const FloorChange::Band& band : change.bands) {
    json.begin_object().member("band", to_string(band.band)).member("from", band.band.from).key("to");
    if (band.band.to)
      json.value(*band.band.to);
    else
      json.null();
    json.member("change", band.change).member("least_ratio", band.least).member("largest_ratio", band.most).end_object();
  }
  json.end_array();
}

void write_floor(JsonWriter& json, const FloorSpectra& floor, const std::vector<FloorChange>* changes) {
  const Peak& rigid = floor.zero_period;
  json.begin_object().member("name", floor.name);
  json.key("zero_period_acceleration").begin_object().member("value", rigid.value).member("time", rigid.time);
  json.member("unit", rigid.unit).end_object();
  json.key("spectra").begin_array();
  for (std::size_t d = 0; d < floor.raw.size(); ++d) {
    json.begin_object().member("damping", floor.raw[d].damping);
    write_peak(json, "peak", floor.raw[d]);
    if (changes) write_change(json.key("beside_bonded"), (*changes)[d]);
    json.end_object();
  }
  json.end_array().end_object();
}

}  // namespace

std::string floor_spectra_csv(const std::vector<RunResult>& runs, const FloorAnswers& floors) {
  std::string text =
      "group,run,floor,damping [1],frequency [Hz],pseudo-acceleration [m/s2],broadened [m/s2],bonded [m/s2],ratio to bonded [1]\n";
  for (std::size_t i = 0; i < runs.size(); ++i)
    for (std::size_t k = 0; k < floors.runs[i].floors.size(); ++k) {
      const FloorSpectra& floor = floors.runs[i].floors[k];
      const std::string head = csv_cell(runs[i].group) + "," + csv_cell(runs[i].name) + "," + csv_cell(floor.name) + ",";
      for (std::size_t d = 0; d < floor.raw.size(); ++d)
        write_block(text, head, floor, d, floors.runs[i].beside.empty() ? nullptr : &floors.runs[i].beside[k][d]);
    }
  for (const FloorEnvelope& envelope : floors.envelopes)
    for (std::size_t k = 0; k < envelope.floors.size(); ++k)
      for (std::size_t d = 0; d < envelope.floors[k].raw.size(); ++d)
        write_block(text, csv_cell(envelope.damping) + ",envelope," + csv_cell(envelope.floors[k].name) + ",", envelope.floors[k], d,
                    envelope.beside.empty() ? nullptr : &envelope.beside[k][d]);
  return text;
}

void write_floors(JsonWriter& json, const FloorRun& run) {
  json.begin_array();
  for (std::size_t k = 0; k < run.floors.size(); ++k) write_floor(json, run.floors[k], run.beside.empty() ? nullptr : &run.beside[k]);
  json.end_array();
}

void write_floor_envelopes(JsonWriter& json, const FloorAnswers& floors) {
  json.begin_array();
  for (const FloorEnvelope& envelope : floors.envelopes) {
    json.begin_object().member("damping_case", envelope.damping).member("runs", envelope.runs).key("floors").begin_array();
    for (std::size_t k = 0; k < envelope.floors.size(); ++k)
      write_floor(json, envelope.floors[k], envelope.beside.empty() ? nullptr : &envelope.beside[k]);
    json.end_array().end_object();
  }
  json.end_array();
}

}  // namespace uplift
