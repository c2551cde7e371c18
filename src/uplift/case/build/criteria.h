#pragma once
#include "uplift/case/case.h"
#include "uplift/case/schema/verdict_sections.h"

namespace uplift {

/// What the case asks of the verdict, with the interfaces of the model. InputError for an interface that there is not, a quantity that its
/// role does not have.
VerdictRequest verdict_request(const CaseVerdict& verdict, const BuiltCase& built);

}  // namespace uplift
