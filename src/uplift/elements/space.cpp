#include "uplift/elements/space.h"

#include <fmt/format.h>

namespace uplift {

std::string_view to_string(Dof dof) {
  constexpr std::string_view names[] = {"ux", "uy", "uz", "rx", "ry", "rz"};
  return names[static_cast<int>(dof)];
}

std::string to_string(const Vec3& v, Space space, int digits) {
  std::string text = "(";
  for (int k = 0; k < space.dimension; ++k) text += fmt::format("{}{:.{}g}", k > 0 ? ", " : "", v[k] + 0.0, digits);  // + 0: no "-0"
  return text + ")";
}

}  // namespace uplift
