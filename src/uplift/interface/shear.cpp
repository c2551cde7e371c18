#include "uplift/interface/shear.h"

#include <algorithm>

namespace uplift {

bool bears_shear(const Interface& interface) {
  constexpr double round_off = 1e-9;
  const Vec3 mean = mean_normal(interface);
  const auto differs = [&](const Vec3& normal) { return (normal - mean).norm() > round_off; };
  return interface.batch.components > 1 || std::ranges::any_of(interface.normal, differs);
}

}  // namespace uplift
