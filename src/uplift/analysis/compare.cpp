#include "uplift/analysis/compare.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "uplift/analysis/verdict.h"
#include "uplift/model/builder.h"

namespace uplift {
namespace {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

std::vector<std::size_t> compared_columns(const RunResult& result, const std::vector<std::string>& names, int sway, int turn) {
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < result.columns.size(); ++k) {
    const Request& column = result.columns[k];
    const bool named = std::find(names.begin(), names.end(), column.name) != names.end();
    const bool motion = column.kind == Request::Kind::displacement && (column.unknown == sway || column.unknown == turn);
    const bool standard = motion || (column.kind == Request::Kind::max_opening && column.interface == 0);
    if (names.empty() ? standard : named) chosen.push_back(k);
  }
  return chosen;
}

}  // namespace

bool is_sound(const RunResult& result, const RunSpec& spec) {
  return result.status == RunStatus::completed && !spec.expected_to_fail && !spec.bonded;
}

std::string_view to_string(Agreement::Word word) {
  switch (word) {
    case Agreement::Word::agrees:
      return "agrees";
    case Agreement::Word::differs:
      return "differs";
    case Agreement::Word::failed:
      return "failed";
    case Agreement::Word::not_counted:
      return "-";
  }
  return "";
}

std::vector<Agreement> agreement(const std::vector<RunResult>& results, const std::vector<RunSpec>& specs,
                                 const std::vector<std::string>& columns, double band, int sway, int turn) {
  std::map<std::string, std::map<std::size_t, std::vector<double>>> peaks;  // group, column: magnitudes
  for (std::size_t i = 0; i < results.size(); ++i)
    if (is_sound(results[i], specs[i]))
      for (const std::size_t k : compared_columns(results[i], columns, sway, turn))
        peaks[results[i].group][k].push_back(std::abs(results[i].peaks[k].value));
  std::vector<Agreement> made(results.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (specs[i].bonded) continue;
    if (results[i].status == RunStatus::failed) {
      made[i].word = Agreement::Word::failed;
      continue;
    }
    for (const std::size_t k : compared_columns(results[i], columns, sway, turn)) {
      const std::vector<double>& sound_peaks = peaks[results[i].group][k];
      if (sound_peaks.empty()) continue;
      const double middle = median(sound_peaks);
      const double deviation = std::abs(std::abs(results[i].peaks[k].value) - middle) / std::max(middle, 1e-300);
      if (made[i].word == Agreement::Word::not_counted) made[i].word = Agreement::Word::agrees;
      if (deviation >= made[i].deviation) {
        made[i].deviation = deviation;
        made[i].column = results[i].columns[k].name;
      }
    }
    if (made[i].word == Agreement::Word::agrees && !(made[i].deviation <= band)) made[i].word = Agreement::Word::differs;
  }
  return made;
}

std::vector<std::string> compared_names(const RunResult& result, const std::vector<std::string>& columns, int sway, int turn) {
  std::vector<std::string> names;
  for (const std::size_t k : compared_columns(result, columns, sway, turn)) names.push_back(result.columns[k].name);
  return names;
}

double created_share(const RunResult& result) {
  return result.energy_scale > 0 ? result.energy_created / result.energy_scale : 0;
}

std::vector<SweepRow> sweep_table(const std::vector<RunSpec>& specs, const std::vector<RunResult>& results) {
  std::vector<SweepRow> rows;
  for (std::size_t i = 0; i + 1 < results.size(); i += 2)
    rows.push_back({specs[i].stiffness_ratio.value_or(0), created_share(results[i]), created_share(results[i + 1]),
                    std::string(to_string(results[i].status)),
                    std::string(to_string(results[i + 1].status)) + (results[i + 1].status == RunStatus::failed ? " (expected)" : "")});
  return rows;
}

}  // namespace uplift
