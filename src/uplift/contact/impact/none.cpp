#include "uplift/contact/impact/impact.h"

namespace uplift {
const Entry<ImpactRule>& entry_impact_none() {
  static const Entry<ImpactRule> entry{{.name = "none",
                                        .summary = "the integrator's velocity is kept: shows the energy that constraint contact creates",
                                        .equations = "v' = v",
                                        .source = "Cherubini, Richard & Frau, section 2",
                                        .params = {}},
                                       [](const Values&) { return std::make_unique<const NoImpact>(); }};
  return entry;
}

}  // namespace uplift
