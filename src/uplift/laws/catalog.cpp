#include <array>

#include "uplift/laws/law.h"

// The laws and cones of parts.def. A part is found because it is listed there, not because its object file registers itself.
namespace uplift {

#define LAW(name) const Entry<InterfaceLaw>& entry_law_##name();
#define CONE(name) const Entry<Cone>& entry_cone_##name();
#include "uplift/parts.def"

std::span<const Entry<InterfaceLaw>* const> law_catalog() {
  static const std::array laws{
#define LAW(name) &entry_law_##name(),
#include "uplift/parts.def"
  };
  return laws;
}

std::span<const Entry<Cone>* const> cone_catalog() {
  static const std::array cones{
#define CONE(name) &entry_cone_##name(),
#include "uplift/parts.def"
  };
  return cones;
}

std::span<const PartInfo* const> interface_behaviours() {
  static const std::array behaviours{
#define LAW(name) static_cast<const PartInfo*>(&entry_law_##name()),
#define CONE(name) static_cast<const PartInfo*>(&entry_cone_##name()),
#include "uplift/parts.def"
  };
  return behaviours;
}

}  // namespace uplift
