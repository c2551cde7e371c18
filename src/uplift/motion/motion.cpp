#include "uplift/motion/motion.h"

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

}  // namespace uplift
