#pragma once
#include "uplift/analysis/case_model.h"

namespace uplift {

/// What the report and the verdict look at: Built::top, base, sway and weight. Nodes of the mesh that are shown get names. Used by build()
/// alone, after everything else is made.
void find_shown(const Case& read, const CaseNames& names, Built& built);

}  // namespace uplift
