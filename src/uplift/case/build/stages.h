#pragma once
#include <vector>

#include "uplift/case/case.h"
#include "uplift/case/schema/case_input.h"

namespace uplift {

/// The stages of a run. Throws InputError where there are none, or where keys of one do not go together.
std::vector<Stage> stages_of(const Case& read, const RunSpec& spec);

/// Released supports do not come back, and the second order begins with the state that they have borne. Throws InputError.
void check_release(const std::vector<CaseStage>& tables, const std::vector<Stage>& stages);

}  // namespace uplift
