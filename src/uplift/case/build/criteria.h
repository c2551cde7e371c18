#pragma once
#include "uplift/case/case.h"

namespace uplift {

/// The table [verdict] of a case.
const Section& verdict_section();
/// What the case asks of the verdict, with the interfaces of the model. InputError for an unknown quantity, a limit in another unit, an
/// interface that there is not, a quantity that its role does not have.
VerdictRequest verdict_request(const Values& root, const BuiltCase& built);

}  // namespace uplift
