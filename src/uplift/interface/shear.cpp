#include "uplift/interface/shear.h"

#include <algorithm>

namespace uplift {

bool bears_shear(const Interface& interface) {
  constexpr double same = 1e-5;  // coordinates of a mesh have some seven digits
  const Vec3 mean = mean_normal(interface);
  const auto differs = [&](const Vec3& normal) { return (normal - mean).norm() > same; };
  return interface.batch.components > 1 || std::ranges::any_of(interface.normal, differs);
}

}  // namespace uplift
