#pragma once
#include "uplift/base/declare.h"

namespace uplift {

/// The declaration of the whole case file: the one source of its check, of `uplift describe` and of `uplift schema`.
const Section& case_section();

}  // namespace uplift
