#include "uplift/base/format.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace uplift {
namespace {

/// Decimals that show so many significant digits of a size.
int decimals_of(double size, int significant) {
  return std::clamp(significant - 1 - static_cast<int>(std::floor(std::log10(size * 1.0005))), 0, 6);
}

/// Three significant digits, not in powers of ten between 1e-6 and 100000.
std::string digits(double value) {
  if (value == 0) return "0";
  const double size = std::abs(value);
  if (size < 1e-6 || size >= 1e5) return fmt::format("{:.2e}", value);
  return fmt::format("{:.{}f}", value, decimals_of(size, 3));
}

struct Prefix {
  double factor;
  const char* text;
};

/// The prefix in which a size of this unit reads well. Lengths and angles stay in m and rad down to a tenth: 0.5 m, but 35.9 mm.
Prefix prefix_of(double magnitude, std::string_view unit) {
  static constexpr std::array<Prefix, 5> prefixes{{{1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1, ""}, {1e-3, "m"}}};
  const double size = magnitude * 1.0005;  // what rounds to 1000 kN is 1 MN
  const bool small_only = unit == "m" || unit == "rad" || unit == "s" || unit == "m/s" || unit == "rad/s";
  const bool scales = small_only || unit == "N" || unit == "N m" || unit == "Pa" || unit == "J" || unit == "Pa/m" || unit == "N/m";
  if (!scales || size == 0) return {1, ""};
  for (const Prefix& prefix : prefixes)
    if ((!small_only || prefix.factor <= 1) && size >= prefix.factor * (small_only && prefix.factor == 1 ? 0.1 : 1)) return prefix;
  return prefixes.back();
}

}  // namespace

std::string format_unit(std::string_view unit) {
  static constexpr std::array<const char*, 3> raised{"²", "³", "⁴"};
  std::string text;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const bool power = i > 0 && std::isalpha(static_cast<unsigned char>(unit[i - 1])) && unit[i] >= '2' && unit[i] <= '4';
    if (power)
      text += raised[static_cast<std::size_t>(unit[i] - '2')];
    else
      text += unit[i];
  }
  return text;
}

std::string format_quantity(double value, std::string_view unit) {
  if (!std::isfinite(value)) return "not finite";
  if (unit == "1") return digits(value);
  const Prefix prefix = prefix_of(std::abs(value), unit);
  return fmt::format("{} {}{}", digits(value / prefix.factor), prefix.text, format_unit(unit));
}

std::string format_quantity_within(double value, double resolution, std::string_view unit) {
  const double largest = std::max(std::abs(value), resolution);
  if (!std::isfinite(largest) || !(resolution > 0)) return format_quantity(value, unit);
  const Prefix prefix = prefix_of(largest, unit);
  const double shown = value / prefix.factor;
  int decimals = decimals_of(resolution / prefix.factor, 2);
  if (shown != 0) decimals = std::min(decimals, decimals_of(std::max(std::abs(shown), resolution / prefix.factor), 3));
  std::string text = fmt::format("{:.{}f}", shown, decimals);
  if (text.starts_with('-') && text.find_first_not_of("-0.") == text.npos) text.erase(0, 1);
  return unit == "1" ? text : fmt::format("{} {}{}", text, prefix.text, format_unit(unit));
}

std::string percent(double fraction) {
  if (std::abs(fraction) >= 10) return fmt::format("{:.3g} times", fraction);
  const double value = 100 * fraction;
  if (std::abs(value) < 0.05 && value != 0) return fmt::format("{:.2g} %", value);
  const int decimals = std::abs(value) < 9.95 ? 1 : 0;
  const double power = decimals == 1 ? 10 : 1;
  return fmt::format("{:.{}f} %", std::round(value * power) / power, decimals);
}

double rounded_down(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double factor : {5.0, 2.0})
    if (factor * power <= value * (1 + 1e-12)) return factor * power;
  return power;
}

std::string format_change(double change) {
  if (!std::isfinite(change)) return "not comparable";
  if (std::abs(change) < 0.0005) return "unchanged";
  if (change >= 9) return digits(1 + change) + " times as large";
  return (change > 0 ? "+" : "") + percent(change);
}

}  // namespace uplift
