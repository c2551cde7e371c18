#include "uplift/verdict/beams.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace uplift {
namespace {

struct Reached {
  double value = 0, time = 0;
  void add(double candidate, double at) {
    if (candidate > value) value = candidate, time = at;
  }
};

/// `least`: a smaller number is noise.
void add_number(std::vector<VerdictNumber>& numbers, QuantityName name, const Reached& reached, const Reached* bonded, double least) {
  VerdictNumber number;
  number.quantity = name;
  number.value = reached.value;
  number.time = reached.time;
  number.least = least;
  if (bonded != nullptr) {
    number.bonded = bonded->value;
    number.change = change_beside(reached.value, bonded->value, least);
  }
  numbers.push_back(number);
}

/// Largest value of a component over all sections, of the given sign; 0: of either.
Reached largest(const BeamEnvelope& envelope, std::string_view component, int sign) {
  Reached reached;
  const auto k = static_cast<std::size_t>(std::ranges::find(envelope.components, component) - envelope.components.begin());
  for (std::size_t s = 0; s < envelope.sections.size(); ++s) {
    const ForceRange& range = envelope.at(s, k);
    if (sign >= 0) reached.add(range.most, range.most_time);
    if (sign <= 0) reached.add(-range.least, range.least_time);
  }
  return reached;
}

/// Largest range over time of the forces of any section [N].
double range_of_forces(const BeamEnvelope& envelope) {
  double most = 0;
  for (std::size_t s = 0; s < envelope.sections.size(); ++s)
    for (std::size_t k = 0; k < envelope.components.size(); ++k)
      if (const std::string& name = envelope.components[k]; name.starts_with("axial") || name.starts_with("shear"))
        most = std::max(most, envelope.at(s, k).most - envelope.at(s, k).least);
  return most;
}

/// Largest peak of the columns that `wanted` accepts; nothing without any.
template <class Wanted>
std::optional<Reached> largest_peak(const RunResult& run, Wanted wanted) {
  std::optional<Reached> reached;
  for (std::size_t k = 0; k < run.columns.size() && k < run.peaks.size(); ++k) {
    if (!wanted(run.columns[k])) continue;
    if (!reached) reached.emplace();
    reached->add(std::abs(run.peaks[k].value), run.peaks[k].time);
  }
  return reached;
}

/// Storey shears, or drift ratios. In space the number of both axes together is the length of the vector.
struct Storeys {
  QuantityName together, along_x, along_y;
  std::string_view unit;
  bool is(const Request& column) const { return column.unit == unit && (unit == "N" ? column.level.has_value() : column.below >= 0); }

  /// One axis of all storeys, or of the one with the column of this name.
  std::optional<Reached> along(const RunResult& run, int axis, std::string_view column = {}) const {
    return largest_peak(run,
                        [&](const Request& each) { return is(each) && each.component == axis && (column.empty() || each.name == column); });
  }
  /// Of one CombinedRequest of the plan.
  std::optional<Reached> length(const RunResult& run, std::size_t number) const {
    if (number >= run.combined.size() || !run.combined[number].known) return std::nullopt;
    return Reached{run.combined[number].value, run.combined[number].time};
  }
  /// Of all storeys: vectors, and axes that are recorded alone.
  std::optional<Reached> all(const BuiltCase& built, const RunResult& run) const {
    std::optional<Reached> most = largest_peak(run, [&](const Request& each) { return is(each); });
    for (std::size_t k = 0; most && k < built.plan.combined.size(); ++k)
      if (built.plan.combined[k].unit == unit)
        if (const auto one = length(run, k)) most->add(one->value, one->time);
    return most;
  }
};

}  // namespace

std::vector<BeamVerdict> beam_verdicts(const RunResult& run, const RunResult* bonded) {
  std::vector<BeamVerdict> verdicts;
  for (std::size_t k = 0; k < run.envelopes.size(); ++k) {
    const BeamEnvelope& envelope = run.envelopes[k];
    const BeamEnvelope* other = bonded != nullptr && k < bonded->envelopes.size() ? &bonded->envelopes[k] : nullptr;
    BeamVerdict verdict{envelope.beam, {}};
    const double least = noise_share * std::max(range_of_forces(envelope), other != nullptr ? range_of_forces(*other) : 0);
    const double length = envelope.sections.empty() ? 0 : envelope.sections.back().along - envelope.sections.front().along;
    const auto add = [&](QuantityName name, const VerdictQuantity* change, std::string_view component, int sign) {
      const Reached reached = largest(envelope, component, sign);
      const Reached reference = other != nullptr ? largest(*other, component, sign) : Reached{};
      add_number(verdict.numbers, name, reached, other != nullptr ? &reference : nullptr, component == "moment" ? least * length : least);
      const std::optional<double> changed = verdict.numbers.back().change;
      if (change != nullptr && changed) add_number(verdict.numbers, *change, {*changed, reached.time}, nullptr, 0);
    };
    add("max_beam_compression", nullptr, "axial", -1);
    add("max_beam_tension", nullptr, "axial", 1);
    add("max_beam_shear", QuantityName("change_of_beam_shear"), "shear", 0);
    add("max_beam_moment", QuantityName("change_of_beam_moment"), "moment", 0);
    verdicts.push_back(std::move(verdict));
  }
  return verdicts;
}

void add_storeys(const BuiltCase& built, const RunResult& run, const RunResult* bonded, VerdictNumbers& numbers) {
  for (const Storeys& storeys : {Storeys{"max_storey_shear", "max_storey_shear_x", "max_storey_shear_y", "N"},
                                 Storeys{"max_drift_ratio", "max_drift_ratio_x", "max_drift_ratio_y", "1"}}) {
    const bool in_space = built.model.space.dimension == 3;
    double least = 0;
    const auto add = [&](std::vector<VerdictNumber>& to, QuantityName name, const auto& of) {
      const std::optional<Reached> reached = of(run);
      if (!reached) return;
      const std::optional<Reached> other = bonded != nullptr ? of(*bonded) : std::nullopt;
      add_number(to, name, *reached, other ? &*other : nullptr, least);
    };
    const auto all = [&](const RunResult& each) { return storeys.all(built, each); };
    if (in_space)
      least = noise_share * std::max(all(run).value_or(Reached()).value, bonded != nullptr ? all(*bonded).value_or(Reached()).value : 0);
    if (in_space) add(numbers.whole, storeys.along_x, [&](const RunResult& each) { return storeys.along(each, 0); });
    if (in_space) add(numbers.whole, storeys.along_y, [&](const RunResult& each) { return storeys.along(each, 1); });
    add(numbers.whole, storeys.together, all);
    for (std::size_t k = 0; k < built.plan.combined.size(); ++k) {
      const CombinedRequest& storey = built.plan.combined[k];
      if (storey.unit != storeys.unit) continue;
      StoreyVerdict said{storey.name, {}};
      for (const int axis : {0, 1})
        add(said.numbers, axis == 0 ? storeys.along_x : storeys.along_y, [&](const RunResult& each) {
          return storeys.along(each, axis, storey.components[static_cast<std::size_t>(axis)].front().column);
        });
      add(said.numbers, storeys.together, [&](const RunResult& each) { return storeys.length(each, k); });
      numbers.storeys.push_back(std::move(said));
    }
  }
}

}  // namespace uplift
