#pragma once
#include "uplift/analysis/case.h"

namespace uplift {

/// The table [verdict] of a case.
const Section& verdict_section();
/// What the case asks of the verdict. InputError for an unknown quantity, a limit in another unit, an interface that there is not.
VerdictWishes verdict_wishes(const Values& root, const Built& built);

}  // namespace uplift
