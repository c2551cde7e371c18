#include "uplift/analysis/compare_motions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "uplift/analysis/verdict.h"

namespace uplift {
namespace {

using Quantity = MotionTable::Quantity;

/// What is compared of a run, with its value.
std::vector<std::pair<Quantity, double>> peaks_of(const RunSpec& spec, const Built& built, const RunResult& run) {
  std::vector<std::pair<Quantity, double>> peaks;
  const Peak* top = top_motion(built, run);
  if (top) peaks.emplace_back(Quantity{"top", "Top motion", "m"}, std::abs(top->value));
  if (built.facts.empty()) return peaks;
  if (!spec.bonded) {
    peaks.emplace_back(Quantity{"ratio", "Uplifted", "1"}, run.max_uplifted_ratio.value);
    peaks.emplace_back(Quantity{"opening", "Gap", "m"}, run.max_opening.value);
  }
  peaks.emplace_back(Quantity{"shear", "Base shear", "N"}, std::abs(run.max_base_shear.value));
  peaks.emplace_back(Quantity{"moment", "Base moment", "N m"}, std::abs(run.max_base_moment.value));
  peaks.emplace_back(Quantity{"pressure", "Pressure", "Pa"}, run.max_pressure.value);
  return peaks;
}

std::string shown(const Values& table) {
  return table.has("label") ? table.text("label") : table.text("name");
}

/// Envelope, mean and standard deviation over the runs that were completed.
void summarise(MotionTable& table) {
  const std::size_t count = table.quantities.size();
  table.envelope.assign(count, 0);
  table.mean = table.spread = table.envelope;
  for (const MotionTable::Row& row : table.rows) table.counted += row.status == RunStatus::completed;
  if (table.counted == 0) return;
  const double n = table.counted;
  for (std::size_t k = 0; k < count; ++k) {
    for (const MotionTable::Row& row : table.rows) {
      if (row.status != RunStatus::completed) continue;
      table.envelope[k] = std::max(table.envelope[k], row.peaks[k]);
      table.mean[k] += row.peaks[k] / n;
    }
    double squares = 0;
    for (const MotionTable::Row& row : table.rows)
      if (row.status == RunStatus::completed) squares += std::pow(row.peaks[k] - table.mean[k], 2);
    if (table.counted > 1) table.spread[k] = std::sqrt(squares / (n - 1));
  }
}

}  // namespace

std::vector<MotionTable> motion_tables(const std::vector<RunSpec>& specs, const std::deque<Built>& built,
                                       const std::vector<RunResult>& results) {
  std::vector<MotionTable> tables;
  std::vector<std::pair<std::string, const Values*>> keys;  // label and damping of a table
  for (std::size_t i = 0; i < results.size(); ++i) {
    const RunSpec& spec = specs[i];
    if (!spec.motion) continue;
    const std::pair key(spec.label, spec.damping);
    const auto place = std::ranges::find(keys, key) - keys.begin();
    const auto peaks = peaks_of(spec, built[i], results[i]);
    if (place == std::ssize(keys)) {
      keys.push_back(key);
      MotionTable& made = tables.emplace_back();
      made.run = spec.label;
      if (spec.damping && spec.damping->items().contains("name")) made.damping = shown(*spec.damping);
      for (const auto& [quantity, value] : peaks) made.quantities.push_back(quantity);
    }
    MotionTable::Row row{shown(*spec.motion), results[i].status, {}};
    for (const auto& [quantity, value] : peaks) row.peaks.push_back(value);
    tables[static_cast<std::size_t>(place)].rows.push_back(std::move(row));
  }
  for (MotionTable& table : tables) summarise(table);
  return tables;
}

}  // namespace uplift
