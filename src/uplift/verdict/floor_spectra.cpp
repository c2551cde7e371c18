#include "uplift/verdict/floor_spectra.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "uplift/base/format.h"
#include "uplift/case/schema/analysis_sections.h"
#include "uplift/verdict/compare.h"
#include "uplift/verdict/numbers.h"

namespace uplift {
namespace {

void broaden(FloorSpectra& floor, double share) {
  if (!(share > 0)) return;
  for (const Spectrum& raw : floor.raw) floor.broadened.push_back(broadened(raw, share));
}

FloorChange compare(const Spectrum& raw, const Spectrum& bonded, const std::vector<FrequencyBand>& bands, double least) {
  FloorChange change;
  change.damping = raw.damping;
  for (const FrequencyBand& band : bands) {
    FloorChange::Band made{band, 0, INFINITY, 0};
    double largest = 0, bonded_largest = 0;
    for (std::size_t i = 0; i < raw.frequencies.size(); ++i) {
      const double f = raw.frequencies[i];
      const std::optional<double> moved = change_of(raw.values[i], bonded.values[i], least);
      if (f < band.from || (band.to && f >= *band.to) || !moved) continue;
      change.frequencies.push_back(f);
      change.bonded.push_back(bonded.values[i]);
      change.ratio.push_back(1 + *moved);
      made.least = std::min(made.least, change.ratio.back());
      made.most = std::max(made.most, change.ratio.back());
      largest = std::max(largest, raw.values[i]);
      bonded_largest = std::max(bonded_largest, bonded.values[i]);
    }
    const std::optional<double> moved = change_of(largest, bonded_largest, least);
    if (!moved) continue;
    made.change = *moved;
    made.largest = largest;
    made.arises = bonded_largest <= least;
    change.bands.push_back(made);
  }
  return change;
}

/// The completed bonded run of a group; -1 without one.
int bonded_of(const std::string& group, const std::vector<RunResult>& results, const std::vector<RunSpec>& specs) {
  for (std::size_t i = 0; i < results.size(); ++i)
    if (specs[i].bonded && results[i].group == group && results[i].status == RunStatus::completed) return static_cast<int>(i);
  return -1;
}

/// The same floor over some runs.
FloorSpectra over_runs(const std::vector<FloorRun>& runs, const std::vector<std::size_t>& chosen, std::size_t floor, double broadening) {
  std::vector<const FloorSpectra*> same;
  for (const std::size_t i : chosen) same.push_back(&runs[i].floors[floor]);
  return floor_envelope(same, broadening);
}

void add_envelopes(const RunPlan& plan, const std::vector<RunResult>& results, const std::vector<RunSpec>& specs, FloorAnswers& answers) {
  std::vector<const CaseDamping*> dampings;
  for (const RunSpec& spec : specs)
    if (std::ranges::find(dampings, spec.damping) == dampings.end()) dampings.push_back(spec.damping);
  for (const CaseDamping* damping : dampings) {
    std::vector<std::size_t> sound, bonded;
    for (std::size_t i = 0; i < results.size(); ++i) {
      if (specs[i].damping != damping || answers.runs[i].floors.size() != plan.floors.size()) continue;
      if (is_sound(results[i], specs[i])) sound.push_back(i);
      if (specs[i].bonded && results[i].status == RunStatus::completed) bonded.push_back(i);
    }
    if (sound.size() < 2) continue;
    FloorEnvelope made{dampings.size() > 1 && damping != nullptr ? damping->label : "", static_cast<int>(sound.size()), {}, {}};
    for (std::size_t k = 0; k < plan.floors.size(); ++k) {
      made.floors.push_back(over_runs(answers.runs, sound, k, plan.floors[k].broadening));
    }
    std::vector<FloorSpectra> references;
    for (std::size_t k = 0; k < plan.floors.size() && !bonded.empty(); ++k) references.push_back(over_runs(answers.runs, bonded, k, 0));
    const double least = least_excitation(made.floors, references);
    for (std::size_t k = 0; k < references.size(); ++k)
      made.beside.push_back(floor_change(made.floors[k], references[k], plan.floor_bands, least));
    if (!made.floors.empty()) answers.envelopes.push_back(std::move(made));
  }
}

}  // namespace

std::string to_string(const FrequencyBand& band) {
  if (band.from == 0 && !band.to) return "all frequencies";
  if (band.from == 0) return fmt::format("below {:g} Hz", *band.to);
  if (!band.to) return fmt::format("above {:g} Hz", band.from);
  return fmt::format("{:g} to {:g} Hz", band.from, *band.to);
}

std::vector<FrequencyBand> frequency_bands(const std::vector<double>& edges) {
  std::vector<FrequencyBand> bands{{0, std::nullopt}};
  for (const double edge : edges) {
    bands.back().to = edge;
    bands.push_back({edge, std::nullopt});
  }
  return bands;
}

bool FloorAnswers::any() const {
  return std::ranges::any_of(runs, [](const FloorRun& run) { return !run.floors.empty(); });
}

std::vector<FloorSpectra> floor_spectra(const RunPlan& plan, const RunResult& result) {
  if (result.status == RunStatus::failed || result.floors.size() != plan.floors.size()) return {};
  std::vector<FloorSpectra> made;
  for (std::size_t k = 0; k < plan.floors.size(); ++k) {
    const FloorRequest& asked = plan.floors[k];
    const FloorRecord& record = result.floors[k];
    FloorSpectra floor{asked.name, {asked.name, "m/s2", 0, 0}, {}, {}};
    for (std::size_t i = 0; i < record.acceleration.size(); ++i)
      if (const double now = record.acceleration[i]; std::abs(now) > std::abs(floor.zero_period.value))
        floor.zero_period.value = now, floor.zero_period.time = static_cast<double>(i) * record.step;
    floor.raw =
        response_spectra(record.acceleration, record.step, asked.frequencies, asked.dampings, Spectrum::Kind::psa, 0, Peaks::between);
    broaden(floor, asked.broadening);
    made.push_back(std::move(floor));
  }
  return made;
}

std::vector<FloorChange> floor_change(const FloorSpectra& floor, const FloorSpectra& bonded, const std::vector<double>& bands,
                                      double least) {
  std::vector<FloorChange> changes;
  for (std::size_t d = 0; d < floor.raw.size(); ++d) changes.push_back(compare(floor.raw[d], bonded.raw[d], frequency_bands(bands), least));
  return changes;
}

double least_excitation(const std::vector<FloorSpectra>& floors, const std::vector<FloorSpectra>& bonded) {
  double largest = 0;
  for (const std::vector<FloorSpectra>* some : {&floors, &bonded})
    for (const FloorSpectra& floor : *some) largest = std::max(largest, std::abs(floor.zero_period.value));
  constexpr double round_off = 1e-8;  // m/s2: what 1e-9 of the weight leaves
  return std::max(noise_share * largest, round_off);
}

std::string range_of_bands(const FloorRun& floors) {
  double least = INFINITY, most = -INFINITY;
  for (const std::vector<FloorChange>& floor : floors.beside)
    for (const FloorChange& change : floor)
      for (const FloorChange::Band& band : change.bands)
        if (!band.arises) least = std::min(least, band.change), most = std::max(most, band.change);
  if (!(least <= most)) return "";
  const std::string from = format_change(least), to = format_change(most);
  if (from == to) return to;
  const bool both = from.ends_with(" %") && to.ends_with(" %");
  return fmt::format("{} to {}", both ? from.substr(0, from.size() - 2) : from, to);
}

std::string arising_floors(const FloorRun& floors) {
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < floors.beside.size(); ++k) {
    double largest = 0;
    for (const FloorChange& change : floors.beside[k])
      for (const FloorChange::Band& band : change.bands)
        if (band.arises) largest = std::max(largest, band.largest);
    if (largest > 0) parts.push_back(fmt::format("of {} up to {}", floors.floors[k].name, format_quantity(largest, "m/s2")));
  }
  return parts.empty() ? "" : fmt::format("accelerations {} where the bonded model has none", fmt::join(parts, ", "));
}

FloorSpectra floor_envelope(const std::vector<const FloorSpectra*>& floors, double broadening) {
  assert(!floors.empty());
  FloorSpectra made{floors.front()->name, floors.front()->zero_period, {}, {}};
  for (std::size_t d = 0; d < floors.front()->raw.size(); ++d) {
    std::vector<Spectrum> same;
    for (const FloorSpectra* floor : floors) same.push_back(floor->raw[d]);
    made.raw.push_back(envelope(same));
  }
  for (const FloorSpectra* floor : floors)
    if (std::abs(floor->zero_period.value) > std::abs(made.zero_period.value)) made.zero_period = floor->zero_period;
  broaden(made, broadening);
  return made;
}

FloorAnswers floor_answers(const RunPlan& plan, const std::vector<RunResult>& results, const std::vector<RunSpec>& specs) {
  FloorAnswers answers;
  for (const RunResult& result : results) answers.runs.push_back({floor_spectra(plan, result), {}});
  for (std::size_t i = 0; i < results.size(); ++i) {
    const int bonded = bonded_of(results[i].group, results, specs);
    if (bonded < 0 || specs[i].bonded) continue;
    const std::vector<FloorSpectra>&floors = answers.runs[i].floors, &references = answers.runs[static_cast<std::size_t>(bonded)].floors;
    const double least = least_excitation(floors, references);
    for (std::size_t k = 0; k < std::min(floors.size(), references.size()); ++k)
      answers.runs[i].beside.push_back(floor_change(floors[k], references[k], plan.floor_bands, least));
  }
  add_envelopes(plan, results, specs, answers);
  return answers;
}

}  // namespace uplift
