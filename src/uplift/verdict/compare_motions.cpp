#include "uplift/verdict/compare_motions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>
#include <utility>

#include "uplift/base/format.h"
#include "uplift/case/schema/analysis_sections.h"
#include "uplift/interface/shear.h"

namespace uplift {
namespace {

using Quantity = MotionTable::Quantity;

/// What is compared of a run, with its value.
std::vector<std::pair<Quantity, double>> quantity_peaks(const RunSpec& spec, const BuiltCase& built, const RunResult& run) {
  std::vector<std::pair<Quantity, double>> peaks;
  const std::vector<Quantity> all = motion_quantities();
  const auto add = [&](const char* key, double value) { peaks.emplace_back(*std::ranges::find(all, key, &Quantity::key), value); };
  const std::optional<Peak> top = top_motion(built, run);
  if (top) add("top", std::abs(top->value));
  if (built.facts.empty()) return peaks;
  if (!spec.bonded) {
    add("ratio", run.max_uplifted_ratio.value);
    add("opening", run.max_opening.value);
  }
  // where bases carry no shear, a support does
  if (std::ranges::any_of(std::span(built.model.interfaces).first(built.bases()), bears_shear))
    add("shear", std::abs(run.max_base_shear.value));
  add("moment", std::abs(run.max_base_moment.value));
  const auto has_pressure = [](const Interface& interface) { return !interface.footprint; };
  if (std::ranges::any_of(built.model.interfaces, has_pressure)) add("pressure", run.max_pressure.value);
  return peaks;
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
    constexpr double round_off = 1e-12;  // equal values have a mean that is not quite theirs
    if (table.counted > 1) table.spread[k] = std::sqrt(squares / (n - 1));
    if (table.spread[k] < round_off * table.envelope[k]) table.spread[k] = 0;
  }
}

std::ptrdiff_t not_met(const JudgedMotion& judged) {
  return std::ranges::count(judged.verdict.numbers.criteria, CriterionResult::State::not_met, &CriterionResult::state);
}

/// "Top motion 17.2 mm and 18.0 mm, uplifted 22 % and 25 %": mean and largest.
std::string mean_and_largest(const MotionTable& table) {
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < table.quantities.size(); ++k) {
    const Quantity& quantity = table.quantities[k];
    const auto shown_value = [&](double value) { return quantity.unit == "1" ? percent(value) : format_quantity(value, quantity.unit); };
    std::string label = quantity.label;
    label.front() = static_cast<char>(label.front() - 'A' + 'a');
    parts.push_back(fmt::format("{} {} and {}", label, shown_value(table.mean[k]), shown_value(table.envelope[k])));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// Under which motions how many criteria are not met; empty when the case has none.
std::string criteria_over_motions(const std::vector<JudgedMotion>& judged) {
  const std::size_t count = judged.front().verdict.numbers.criteria.size();
  if (count == 0) return {};
  std::vector<std::string> broken;
  for (const JudgedMotion& each : judged)
    if (const auto number = not_met(each); number > 0) broken.push_back(fmt::format("{} under {}", number, each.motion));
  if (broken.empty()) return fmt::format(" All criteria are met under each of the {} motions.", judged.size());
  return fmt::format(" Criteria that are not met, of {}: {}.", count, fmt::join(broken, ", "));
}

}  // namespace

std::vector<MotionTable::Quantity> motion_quantities() {
  return {{"top", "Top motion", "m"},   {"ratio", "Uplifted", "1"},       {"opening", "Gap", "m"},
          {"shear", "Base shear", "N"}, {"moment", "Base moment", "N m"}, {"pressure", "Pressure", "Pa"}};
}

std::size_t hardest(const std::vector<JudgedMotion>& judged) {
  const auto rank = [](const JudgedMotion& each) {
    return std::tuple(each.verdict.level, not_met(each), each.run->max_uplifted_ratio.value, each.run->max_opening.value,
                      std::abs(each.run->max_base_moment.value));
  };
  return static_cast<std::size_t>(std::ranges::max_element(judged, {}, rank) - judged.begin());
}

std::string said_over_motions(const std::vector<JudgedMotion>& judged, const MotionTable& table) {
  std::string text = fmt::format("This page shows the most demanding of {} motions, {}.", judged.size(), judged[hardest(judged)].motion);
  if (table.counted > 0) text += fmt::format(" Mean and maximum over the {} completed runs: {}.", table.counted, mean_and_largest(table));
  return text + criteria_over_motions(judged);
}

std::vector<MotionTable> motion_tables(const std::vector<RunSpec>& specs, const std::deque<BuiltCase>& built,
                                       const std::vector<RunResult>& results) {
  std::vector<MotionTable> tables;
  std::vector<std::pair<std::string, const CaseDamping*>> keys;  // label and damping of a table
  for (std::size_t i = 0; i < results.size(); ++i) {
    const RunSpec& spec = specs[i];
    if (spec.motion_label.empty()) continue;
    const std::pair key(spec.label, spec.damping);
    const auto place = std::ranges::find(keys, key) - keys.begin();
    const auto peaks = quantity_peaks(spec, built[i], results[i]);
    if (place == std::ssize(keys)) {
      keys.push_back(key);
      MotionTable& made = tables.emplace_back();
      made.run = spec.label;
      if (spec.damping) made.damping = spec.damping->label;
      for (const auto& [quantity, value] : peaks) made.quantities.push_back(quantity);
    }
    MotionTable::Row row{spec.motion_label, results[i].status, {}};
    for (const auto& [quantity, value] : peaks) row.peaks.push_back(value);
    tables[static_cast<std::size_t>(place)].rows.push_back(std::move(row));
  }
  for (MotionTable& table : tables) summarise(table);
  return tables;
}

}  // namespace uplift
