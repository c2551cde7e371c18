#pragma once
#include "uplift/base/resolved.h"
#include "uplift/case/case.h"

namespace uplift {

/// What a case that leaves a key out gets instead of the key's default, because of other keys: the traction at the end of the step with a
/// scheme that has no path average, friction in the tangential direction with a coefficient of friction.
DecidedTexts decided_texts(const Case& read);

}  // namespace uplift
