#include <array>

#include "uplift/contact/impact/impact.h"

namespace uplift {

#define IMPACT(name) const Entry<ImpactRule>& entry_impact_##name();
#include "uplift/parts.def"

std::span<const Entry<ImpactRule>* const> impact_catalog() {
  static const std::array entries{
#define IMPACT(name) &entry_impact_##name(),
#include "uplift/parts.def"
  };
  return entries;
}

std::span<const PartInfo* const> impact_rules() {
  static const std::vector<const PartInfo*> infos(impact_catalog().begin(), impact_catalog().end());
  return infos;
}

}  // namespace uplift
