#include "uplift/case/schema/verdict_quantities.h"

#include <fmt/format.h>

#include <cmath>

#include "uplift/base/format.h"

namespace uplift {
bool is_share(const VerdictQuantity& quantity) {
  return quantity.name.starts_with("change_of") || quantity.name.starts_with("share_of") || quantity.name.ends_with("uplifted_ratio") ||
         quantity.is("linear_tension_ratio");
}

bool near_zero(const VerdictQuantity& quantity) {
  return is_share(quantity) || quantity.name.starts_with("residual") || quantity.is("first_uplift");
}

double nothing_beside(std::string_view unit) {
  if (unit == "m" || unit == "rad" || unit == "N" || unit == "N m" || unit == "N s" || unit == "Pa") return 1e-9;
  return unit == "1" ? 1e-6 : 0;
}

std::string format_value(const VerdictQuantity& quantity, double value) {
  if (std::abs(value) < nothing_beside(quantity.unit)) value = 0;
  if (!is_share(quantity)) return format_quantity(value, quantity.unit);
  if (quantity.name.starts_with("change_of") && std::abs(value) >= 10) return fmt::format("{:.3g} %", 100 * value);  // not "11 times"
  if (std::abs(value) >= 5e-4) return percent(value);
  return std::abs(value) < 5e-5 ? "0 %" : fmt::format("{:.2f} %", 100 * value);
}

}  // namespace uplift
