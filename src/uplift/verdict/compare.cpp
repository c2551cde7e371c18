#include "uplift/verdict/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "uplift/verdict/verdict.h"

namespace uplift {
namespace {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

/// A value that is compared; differences are relative to the median, at least to `least`.
struct Compared {
  std::string name;
  double value = 0, least = 0;
};

std::vector<Compared> peaks_of(const RunResult& result, const std::vector<std::string>& columns) {
  std::vector<Compared> made;
  for (std::size_t k = 0; k < result.columns.size(); ++k)
    if (std::ranges::find(columns, result.columns[k].name) != columns.end())
      made.push_back({result.columns[k].name, std::abs(result.peaks[k].value), 0});
  return made;
}

/// What a number of the verdict is a part of.
double least_of_number(const VerdictNumber& number, const std::vector<VerdictNumber>& same, const InterfaceVerdict* of,
                       const RunResult& run) {
  const VerdictQuantity& quantity = *number.quantity;
  const auto value_of = [&](QuantityName name) {
    const VerdictNumber* found = find_number(same, name);
    return found ? found->value : 0;
  };
  if (quantity.unit == "s") return run.end_time;
  if (quantity.name.starts_with("share_of")) return 1;
  if (quantity.is("residual_uplifted_ratio")) return value_of("max_uplifted_ratio");
  if (!quantity.name.starts_with("residual")) return number.least;
  const std::optional<double> width = of ? std::optional(std::max(of->width[0], of->width[1])) : std::nullopt;
  if (quantity.unit == "rad") return width.value_or(0) > 0 ? value_of("max_opening") / *width : 0;
  return value_of("max_opening");
}

std::vector<Compared> numbers_of_verdict(const BuiltCase& built, const RunResult& run) {
  const VerdictNumbers numbers = numbers_of(built, run, nullptr);
  std::vector<Compared> made;
  const auto take = [&](const std::vector<VerdictNumber>& some, const InterfaceVerdict* of) {
    const std::string behind = of && numbers.interfaces.size() > 1 ? " of " + of->name : "";
    for (const VerdictNumber& number : some)
      if (!number.quantity->is("max_penetration") && std::isfinite(number.value))
        made.push_back({std::string(number.quantity->name) + behind, number.value, least_of_number(number, some, of, run)});
  };
  take(numbers.whole, nullptr);
  for (const InterfaceVerdict& each : numbers.interfaces) take(each.numbers, &each);
  return made;
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
                                 const std::deque<BuiltCase>& built, const std::vector<std::string>& columns, double band) {
  std::vector<std::vector<Compared>> values;
  std::map<std::string, std::map<std::string, std::vector<double>>> sound;  // by group and name
  for (std::size_t i = 0; i < results.size(); ++i) {
    const bool counts = !specs[i].bonded && results[i].status != RunStatus::failed && results[i].status != RunStatus::interrupted;
    values.push_back(!counts           ? std::vector<Compared>()
                     : columns.empty() ? numbers_of_verdict(built[i], results[i])
                                       : peaks_of(results[i], columns));
    if (is_sound(results[i], specs[i]))
      for (const Compared& each : values[i]) sound[results[i].group][each.name].push_back(each.value);
  }
  std::vector<Agreement> made(results.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (specs[i].bonded) continue;
    if (results[i].status == RunStatus::failed) made[i].word = Agreement::Word::failed;
    for (const Compared& each : values[i]) {
      const std::vector<double>& others = sound[results[i].group][each.name];
      if (others.empty()) continue;
      const double middle = median(others);
      const double deviation = std::abs(each.value - middle) / std::max({std::abs(middle), each.least, 1e-300});
      if (made[i].word == Agreement::Word::not_counted) made[i].word = Agreement::Word::agrees;
      if (deviation >= made[i].deviation) made[i].deviation = deviation, made[i].column = each.name;
    }
    if (made[i].word == Agreement::Word::agrees && !(made[i].deviation <= band)) made[i].word = Agreement::Word::differs;
  }
  return made;
}

std::string compared_text(const std::vector<std::string>& columns) {
  return columns.empty() ? "all numbers of the verdict" : fmt::format("their peaks of {}", fmt::join(columns, ", "));
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
