#include "uplift/analysis/wording.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace uplift {
namespace {

/// Three significant digits, not in powers of ten between 0.001 and 100000.
std::string digits(double value) {
  if (value == 0) return "0";
  const double size = std::abs(value);
  if (size < 1e-3 || size >= 1e5) return fmt::format("{:.2e}", value);
  const int decimals = std::clamp(2 - static_cast<int>(std::floor(std::log10(size * 1.0005))), 0, 6);
  return fmt::format("{:.{}f}", value, decimals);
}

}  // namespace

std::string spoken(double value, std::string_view unit) {
  if (!std::isfinite(value)) return "not finite";
  if (unit == "1") return digits(value);
  struct Prefix {
    double factor;
    const char* text;
  };
  static constexpr std::array<Prefix, 5> prefixes{{{1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1, ""}, {1e-3, "m"}}};
  const double size = std::abs(value) * 1.0005;  // what rounds to 1000 kN is 1 MN
  const bool small_only = unit == "m" || unit == "rad" || unit == "s" || unit == "m/s" || unit == "rad/s";
  const bool scales = small_only || unit == "N" || unit == "N m" || unit == "Pa" || unit == "J" || unit == "Pa/m" || unit == "N/m";
  if (!scales || size == 0) return fmt::format("{} {}", digits(value), unit);
  for (const Prefix& prefix : prefixes) {
    if (small_only && prefix.factor > 1) continue;
    // Lengths and angles stay in m and rad down to a tenth: 0.5 m, but 35.9 mm.
    if (size >= prefix.factor * (small_only && prefix.factor == 1 ? 0.1 : 1))
      return fmt::format("{} {}{}", digits(value / prefix.factor), prefix.text, unit);
  }
  return fmt::format("{} m{}", digits(value * 1e3), unit);
}

std::string percent(double fraction) {
  if (std::abs(fraction) >= 10) return fmt::format("{:.3g} times", fraction);
  const double value = 100 * fraction;
  if (std::abs(value) < 0.05 && value != 0) return fmt::format("{:.2g} %", value);
  return fmt::format("{:.{}f} %", value, std::abs(value) < 10 ? 1 : 0);
}

std::string beside(double value, double reference) {
  const double ratio = std::abs(value) / std::abs(reference);
  if (!std::isfinite(ratio)) return "not comparable";
  if (std::abs(ratio - 1) < 0.005) return "the same";
  if (ratio >= 2) return fmt::format("{} times as large", digits(ratio));
  return fmt::format("{} {}", percent(std::abs(ratio - 1)), ratio > 1 ? "more" : "less");
}

}  // namespace uplift
