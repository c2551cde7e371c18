#pragma once
#include <memory>

#include "uplift/dynamics/condensed.h"

namespace uplift {

/// The oracle of the condensed step: Newton on all unknowns at once, the matrix K_eff + B^T k B formed and factorised in every iteration,
/// constraints as a saddle point [K_eff, C^T; C, 0] with an active set of its own. It shares nothing with the condensed path but the laws
/// and the problem's data. K_eff is dense inside: for checking, not for large models.
std::unique_ptr<StepSolver> make_monolithic(const Sparse& matrix, const Sparse& b, const Vector& gap, ContactModel frame);

/// `solver` beside the oracle: both take every step from the same beginning, and a step fails when their increments differ by more than
/// `tolerance` of the displacement (norm of K_eff). Unlike two whole runs this also judges marches in which a difference of round-off grows
/// exponentially.
std::unique_ptr<StepSolver> make_compared(const Sparse& matrix, std::unique_ptr<StepSolver> solver, std::unique_ptr<StepSolver> oracle,
                                          double tolerance);

}  // namespace uplift
