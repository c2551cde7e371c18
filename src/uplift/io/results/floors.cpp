#include "uplift/io/results/floors.h"

#include <algorithm>

#include "uplift/io/results/words.h"
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

void write_spectrum(ResultWriter& out, const Spectrum& spectrum, const FloorChange* change) {
  out.number("damping", spectrum.damping, "1", "damping ratio of the equipment");
  out.object("peak", "peak of the raw spectrum", [&] {
    const auto most = static_cast<std::size_t>(std::ranges::max_element(spectrum.values) - spectrum.values.begin());
    const bool any = most < spectrum.values.size();
    out.number("value", any ? spectrum.values[most] : 0, "m/s2", "largest pseudo-acceleration");
    out.number("frequency", any ? spectrum.frequencies[most] : 0, "Hz", "frequency at which it occurs");
    out.unit("m/s2");
  });
  out.when(change != nullptr)
      .list("beside_bonded", "comparison with the bonded reference run in frequency bands",
            change ? change->bands : std::vector<FloorChange::Band>(), [&](const FloorChange::Band& band) {
              out.text("band", to_string(band.band), "frequency band");
              out.number("from", band.band.from, "Hz", "lower limit of the band");
              out.number_or_null("to", band.band.to, "Hz", "upper limit of the band; null: none");
              out.number("change", band.change, "1", "change of the largest value in the band: 0.1 is 10 % more than bonded");
              out.flag("arises", band.arises, "the bonded floor is not excited in the band: change and ratios are those of a threshold");
              out.number("least_ratio", band.least, "1", "smallest ratio to the bonded spectrum in the band");
              out.number("largest_ratio", band.most, "1", "largest ratio to the bonded spectrum in the band");
            });
}

void write_floor(ResultWriter& out, const FloorSpectra& floor, const std::vector<FloorChange>* changes) {
  out.text("name", floor.name, "name of the floor");
  write_peak(out, "zero_period_acceleration", floor.zero_period, "m/s2",
             "largest absolute acceleration of the floor: demand on rigid equipment");
  struct Damping {
    const Spectrum* raw = nullptr;
    const FloorChange* change = nullptr;
  };
  std::vector<Damping> dampings;
  for (std::size_t d = 0; d < floor.raw.size(); ++d) dampings.push_back({&floor.raw[d], changes ? &(*changes)[d] : nullptr});
  out.list("spectra", "response spectra of the floor, one per damping", dampings,
           [&](const Damping& each) { write_spectrum(out, each.raw ? *each.raw : Spectrum(), each.change); });
}

void write_list(ResultWriter& out, std::string_view key, std::string_view meaning, const std::vector<FloorSpectra>& floors,
                const std::vector<std::vector<FloorChange>>& beside) {
  struct Floor {
    const FloorSpectra* spectra = nullptr;
    const std::vector<FloorChange>* changes = nullptr;
  };
  std::vector<Floor> all;
  for (std::size_t k = 0; k < floors.size(); ++k) all.push_back({&floors[k], beside.empty() ? nullptr : &beside[k]});
  out.list(key, meaning, all, [&](const Floor& each) { write_floor(out, each.spectra ? *each.spectra : FloorSpectra(), each.changes); });
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

void write_floors(ResultWriter& out, std::string_view key, const FloorRun& run) {
  write_list(out, key, "floor spectra", run.floors, run.beside);
}

void write_floor_envelopes(ResultWriter& out, std::string_view key, const FloorAnswers& floors) {
  out.list(key, "envelopes of the floor spectra over the runs of a comparison", floors.envelopes, [&](const FloorEnvelope& envelope) {
    out.text("damping_case", envelope.damping, "label of the damping of the structure; empty where there is only one");
    out.count("runs", envelope.runs, "number of runs");
    write_list(out, "floors", "envelopes of the floors", envelope.floors, envelope.beside);
  });
}

}  // namespace uplift
