#pragma once
#include "uplift/base/declare.h"

namespace uplift {

/// [[interface]] with everything below it.
const Section& interface_section();
/// [[foundation]].
const Section& foundation_section();

}  // namespace uplift
