#include "uplift/verdict/standing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/base/format.h"

namespace uplift {
namespace {

struct Said {
  QuantityName name;
  const char* label;
};
constexpr Said standing_numbers[] = {{"max_uplifted_ratio", "Uplifted area"},
                                     {"max_opening", "Largest gap"},
                                     {"max_slip", "Largest slip"},
                                     {"max_toe_pressure", "Largest pressure"},
                                     {"residual_settlement", "Settlement"},
                                     {"residual_rotation", "Rotation"},
                                     {"residual_slip", "Slip"},
                                     {"max_compression", "Compression"},
                                     {"max_shear", "Base shear"},
                                     {"max_moment", "Base moment"},
                                     {"max_eccentricity", ""},
                                     {"min_sliding_safety", "Safety against sliding"},
                                     {"max_bearing_utilisation", "Utilisation of bearing capacity"},
                                     {"max_sliding_utilisation", "Utilisation of sliding resistance"},
                                     {"share_of_horizontal_force", "Share of the horizontal force"},
                                     {"share_of_base_moment", "Share of the base moment"}};

/// What is nothing but round-off beside what the base carries is not worth a line.
bool counts(const InterfaceVerdict& said, const VerdictNumber& number) {
  constexpr double little = 1e-9;
  const VerdictQuantity& quantity = *number.quantity;
  if (quantity.is("max_shear")) return number.value > little * said.weight;
  if (quantity.is("max_moment")) return number.value > little * said.weight * std::max(said.width[0], said.width[1]);
  if (quantity.is("max_eccentricity") || quantity.is("residual_rotation")) return std::abs(number.value) > little;
  if (quantity.is("residual_slip")) return std::abs(number.value) > 1e-3 * little;
  if (quantity.is("min_sliding_safety")) return number.value < 1 / little;
  return true;
}

void say_standing(const InterfaceVerdict& said, const std::string& of, Verdict& verdict) {
  for (const Said& each : standing_numbers) {
    const VerdictNumber* number = find_number(said.numbers, each.name);
    if (!number || !counts(said, *number)) continue;
    std::string detail;
    const VerdictNumber* ratio = find_number(said.numbers, "toe_pressure_ratio");
    if (number->quantity->is("max_toe_pressure") && ratio)
      detail = fmt::format("{:.3g} times the mean {}", ratio->value, format_quantity(said.mean_pressure, "Pa"));
    if (number->quantity->is("residual_settlement")) detail = "mean of the base, from the unloaded structure";
    if (number->quantity->is("max_eccentricity")) detail = words_of_eccentricity(said);
    if (number->quantity->is("max_uplifted_ratio")) detail = "share with an open gap";
    const std::string label = number->quantity->is("max_eccentricity") ? label_of_eccentricity(said) : each.label;
    verdict.facts.push_back({label + of, uplift::format_value(*number->quantity, number->value), detail});
  }
}

}  // namespace

Verdict judge_standing(const BuiltCase& built, const RunResult& run) {
  Verdict verdict;
  verdict.numbers = numbers_of(built, run, nullptr);
  const bool open = run.max_uplifted_ratio.value > 0;
  if (open) verdict.level = Verdict::Level::uplift;
  verdict.headline = built.facts.empty() ? "A static run without an interface"
                     : open              ? fmt::format("Under its constant loads the base is open: {} of its area, by up to {}",
                                                       percent(run.max_uplifted_ratio.value), format_quantity(run.max_opening.value, "m"))
                                         : "Under its constant loads the base is in full contact";
  const bool several = verdict.numbers.bases() > 1;
  for (const InterfaceVerdict& said : verdict.numbers.interfaces)
    say_standing(said, several || said.role == Role::wall ? " of " + said.name : "", verdict);
  verdict.paragraphs.push_back("The case has static stages alone: all numbers are those of the state at their end, not of an earthquake.");
  for (const std::string& note : run.notes) verdict.paragraphs.push_back(note);
  return verdict;
}

}  // namespace uplift
