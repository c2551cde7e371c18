#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/io/report/parts.h"

// The page's floor spectra: a figure for every floor and damping, and one of the ratio to the bonded run.
namespace uplift {
namespace {

std::string percent_of_damping(double damping) {
  return fmt::format("{:g} %", 100 * damping);
}

Curve spectrum_curve(std::string label, std::string run, const Spectrum& spectrum) {
  return {std::move(label), std::move(run), spectrum.frequencies, spectrum.values, false, false};
}

/// The runs of the first one's group that have floors, by their index.
std::vector<std::size_t> shown_runs(const ReportInput& input) {
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < input.runs.size(); ++i)
    if (input.runs[i].result->group == input.runs.front().result->group && !input.floors->runs[i].floors.empty()) shown.push_back(i);
  return shown;
}

/// That of the first damping of the structure, which the runs of the figures have.
const FloorEnvelope* envelope_of(const ReportInput& input) {
  return input.floors->envelopes.empty() ? nullptr : &input.floors->envelopes.front();
}

/// ", Kobe": which of several motions and dampings the figures show.
std::string shown_group(const ReportInput& input) {
  const std::string& group = input.runs.front().result->group;
  return group.empty() ? "" : ", " + group;
}

/// The envelope where it is over several motions, and so beside several bonded runs; else null.
const FloorEnvelope* motion_envelope(const ReportInput& input) {
  const auto beside = std::ranges::count_if(
      input.runs, [&](const ReportRun& run) { return run.spec->bonded && run.spec->damping == input.runs.front().spec->damping; });
  const FloorEnvelope* envelope = envelope_of(input);
  return beside > 1 && envelope && !envelope->beside.empty() ? envelope : nullptr;
}

/// Raw curves of all runs, the bonded one dashed; what is broadened: the envelope, or the first run without one.
Chart spectrum_chart(const ReportInput& input, const FloorRequest& floor, std::size_t k, std::size_t d) {
  const std::string damping = percent_of_damping(floor.dampings[d]);
  Chart chart{fmt::format("floor_{}_{:g}", floor.name, 100 * floor.dampings[d]),
              "floors",
              fmt::format("{}: floor spectrum, {} damping{}", floor.name, damping, shown_group(input)),
              "",
              {"Frequency", "Hz", true},
              {"Pseudo-acceleration", "m/s2"},
              {}};
  for (const std::size_t i : shown_runs(input)) {
    const ReportRun& run = input.runs[i];
    chart.curves.push_back(spectrum_curve(run.result->label, run.result->label, input.floors->runs[i].floors[k].raw[d]));
    chart.curves.back().dash = run.spec->bonded;
  }
  chart.caption = "Raw spectra; the bonded model is dashed.";
  if (const FloorEnvelope* all = motion_envelope(input)) {
    const FloorChange& change = all->beside[k][d];
    chart.curves.push_back({"envelope of the bonded runs", "", change.frequencies, change.bonded, true, false});
  }
  if (!(floor.broadening > 0)) return chart;
  const FloorEnvelope* envelope = envelope_of(input);
  const std::string share = fmt::format("{:g} %", 100 * floor.broadening);
  if (envelope) {
    chart.curves.push_back(
        spectrum_curve(fmt::format("envelope of {} runs, broadened by {}", envelope->runs, share), "", envelope->floors[k].broadened[d]));
  } else if (!input.floors->runs.front().floors.empty()) {
    const std::string& label = input.runs.front().result->label;
    chart.curves.push_back(
        spectrum_curve(fmt::format("{}, broadened by {}", label, share), "", input.floors->runs.front().floors[k].broadened[d]));
  }
  return chart;
}

/// All dampings of the one run, or all runs with the first damping.
Chart ratio_chart(const ReportInput& input, const FloorRequest& floor, std::size_t k) {
  Chart chart{"floor_ratio_" + floor.name,
              "floors",
              floor.name + ": floor spectrum relative to the bonded model" + shown_group(input),
              "Raw spectrum divided by that of the bonded model. Above 1, uplift increases the demand on equipment of this frequency.",
              {"Frequency", "Hz", true},
              {"Ratio to bonded", "1"},
              {}};
  std::vector<std::size_t> runs;
  for (const std::size_t i : shown_runs(input))
    if (!input.floors->runs[i].beside.empty()) runs.push_back(i);
  if (runs.size() > 1) chart.title += fmt::format(", {} damping", percent_of_damping(floor.dampings.front()));
  for (const std::size_t i : runs)
    for (const FloorChange& change : input.floors->runs[i].beside[k]) {
      const std::string& label = input.runs[i].result->label;
      chart.curves.push_back({runs.size() > 1 ? label : percent_of_damping(change.damping) + " damping", runs.size() > 1 ? label : "",
                              change.frequencies, change.ratio, false, false});
      if (runs.size() > 1) break;
    }
  if (const FloorEnvelope* all = motion_envelope(input)) {
    const FloorChange& change = all->beside[k].front();
    chart.curves.push_back(
        {fmt::format("envelope of {} runs divided by that of the bonded runs, {} damping", all->runs, percent_of_damping(change.damping)),
         "", change.frequencies, change.ratio, true, false});
  }
  std::erase_if(chart.curves, [](const Curve& curve) { return curve.x.empty(); });
  return chart;
}

}  // namespace

bool has_floors(const ReportInput& input) {
  return input.floors && input.floors->any();
}

void write_floor_charts(JsonWriter& json, const ReportInput& input) {
  if (!has_floors(input)) return;
  const std::vector<FloorRequest>& floors = input.runs.front().built->plan.floors;
  for (std::size_t k = 0; k < floors.size(); ++k) {
    for (std::size_t d = 0; d < floors[k].dampings.size(); ++d) write_chart(json, spectrum_chart(input, floors[k], k, d));
    write_chart(json, ratio_chart(input, floors[k], k));
  }
}

}  // namespace uplift
