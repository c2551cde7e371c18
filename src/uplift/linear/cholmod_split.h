#pragma once
#include "uplift/linear/solver.h"

namespace uplift {

/// See SplitFactor. Nested dissection of the other unknowns; `last` must hold distinct unknowns, at least one.
SplitFactorisation cholmod_split(const Sparse& a, const std::vector<int>& last);
/// What it takes; see LinearSolver::predict.
FactorCost cholmod_split_cost(const Sparse& a, const std::vector<int>& last);

}  // namespace uplift
