#include "uplift/motion/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace uplift {

std::string_view to_string(MotionKind kind) {
  switch (kind) {
    case MotionKind::acceleration:
      return "acceleration";
    case MotionKind::velocity:
      return "velocity";
    case MotionKind::displacement:
      return "displacement";
  }
  return "";
}

std::string_view unit_of(MotionKind kind) {
  switch (kind) {
    case MotionKind::acceleration:
      return "m/s2";
    case MotionKind::velocity:
      return "m/s";
    case MotionKind::displacement:
      return "m";
  }
  return "";
}

MotionPeak peak_of(const Motion& motion) {
  MotionPeak peak;
  for (std::size_t i = 0; i < motion.values.size(); ++i)
    if (std::abs(motion.values[i]) > std::abs(peak.value)) peak = {motion.values[i], motion.step * static_cast<double>(i)};
  return peak;
}

constexpr double most_possible = 1e6;

bool has_possible_values(const Motion& motion) {
  return std::ranges::all_of(motion.values, [](double value) { return std::abs(value) <= most_possible; });
}

void check_values(const Motion& motion, const Where& where, const std::string& path) {
  if (!has_possible_values(motion))
    throw InputError(where, path, fmt::format("values of a ground motion, at most {:g} {}", most_possible, unit_of(motion.kind)),
                     fmt::format("{:.4g} {}", peak_of(motion).value, unit_of(motion.kind)));
}

}  // namespace uplift
