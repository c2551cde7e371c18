#pragma once
#include "uplift/case/build/model.h"

namespace uplift {

/// What the report and the verdict look at: BuiltCase::top, base, sway and constant loads. Nodes of the mesh that are shown get names. Used
/// by build() alone, after everything else is made.
void find_shown(const Case& read, const CaseNames& names, BuiltCase& built);

}  // namespace uplift
