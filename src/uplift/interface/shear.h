#pragma once
#include "uplift/interface/interface.h"

namespace uplift {

/// Whether an interface can exert a force across its mean normal: through tangential components, or because normals of its points differ
/// from the mean, as those of opposite walls or of a wedge, whose pressures alone hold the structure sideways.
bool bears_shear(const Interface&);

}  // namespace uplift
