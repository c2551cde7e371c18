#include "uplift/statistics/ida_fractiles.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace uplift {

double percentile(std::span<const double> sorted, double share) {
  assert(!sorted.empty() && share >= 0 && share <= 1);
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const double rest = at - static_cast<double>(below), low = sorted[below];
  if (below + 1 >= sorted.size() || rest == 0 || std::isinf(low)) return low;
  return low + rest * (sorted[below + 1] - low);
}

double intensity_at_demand(std::span<const IdaPoint> curve, double demand) {
  IdaPoint before;  // the origin
  for (const IdaPoint& now : curve) {
    if (now.demand >= demand) return before.im + (now.im - before.im) * (demand - before.demand) / (now.demand - before.demand);
    if (now.lost) return now.im;
    before = now;
  }
  return std::numeric_limits<double>::infinity();
}

IdaFractiles ida_fractiles(std::span<const std::vector<IdaPoint>> curves, std::vector<double> demands) {
  IdaFractiles made;
  std::vector<double> intensities(curves.size());
  const auto add = [&](std::vector<std::optional<double>>& to, double share) {
    const double value = percentile(intensities, share);
    to.push_back(std::isfinite(value) ? std::optional(value) : std::nullopt);
  };
  for (const double demand : demands) {
    std::ranges::transform(curves, intensities.begin(), [&](const auto& curve) { return intensity_at_demand(curve, demand); });
    std::ranges::sort(intensities);
    add(made.p16, 0.16);
    add(made.p50, 0.5);
    add(made.p84, 0.84);
  }
  made.demands = std::move(demands);
  return made;
}

}  // namespace uplift
