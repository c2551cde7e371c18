#pragma once
#include <optional>

#include "uplift/linear/solver.h"
#include "uplift/model/model.h"

namespace uplift {

/// Share of the dead loads under which the structure buckles with its interfaces bonded: the least s in (0, 1] for which K + s K_g is not
/// positive definite, with the geometric stiffness K_g of the whole dead loads (relative error 1e-4). Empty when K + K_g is positive
/// definite, or when K itself is not (a free body).
std::optional<double> buckling_share(const Model& model, const Sparse& geometric, const LinearSolver& solver);

}  // namespace uplift
