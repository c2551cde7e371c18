// Solving with a system that is prepared: one column after another, or several at once where the method is a back-solve alone.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "uplift/distributed/system.h"

namespace uplift {

/// An iterative method on one load, of changing signs in every unknown: what does not converge now would not in a step either.
PetscErrorCode System::try_out(SystemOutcome& outcome) {
  PetscFunctionBeginUser;
  PetscInt first = 0;
  PetscCall(MatGetOwnershipRange(matrix_, &first, nullptr));
  std::vector<double> load(static_cast<std::size_t>(local_)), solution(load.size());
  for (std::size_t i = 0; i < load.size(); ++i) {
    const double k = static_cast<double>(first) + static_cast<double>(i) + 1;
    load[i] = std::sin(1.618 * k * k);
  }
  PetscCall(solve_columns(load.data(), solution.data(), 1, outcome));
  PetscFunctionReturn(0);
}

SystemOutcome System::solve(const double* b, double* x, PetscInt columns, double residual) {
  SystemOutcome outcome;
  KSPSetTolerances(solver_, std::max(tolerance_, residual), PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT);
  const PetscErrorCode error = solve_columns(b, x, columns, outcome);
  return agree(error, std::move(outcome));
}

PetscErrorCode System::solve_columns(const double* b, double* x, PetscInt columns, SystemOutcome& outcome) {
  PetscFunctionBeginUser;
  iterations_ = 0;
  if (block_ && columns > 1) {
    PetscCall(solve_block(b, x, columns));
    PetscCall(converged(outcome));
    PetscFunctionReturn(0);
  }
  for (PetscInt c = 0; c < columns && outcome.ok(); ++c) {
    PetscCall(solve_column(b + static_cast<std::ptrdiff_t>(c) * local_, x + static_cast<std::ptrdiff_t>(c) * local_));
    PetscCall(converged(outcome));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode System::solve_column(const double* b, double* x) {
  PetscFunctionBeginUser;
  if (blocks_.any()) {
    double* numbers = nullptr;
    PetscCall(VecGetArray(given_, &numbers));
    blocks_.put(b, numbers);
    PetscCall(VecRestoreArray(given_, &numbers));
    PetscCall(KSPSolve(solver_, given_, solved_));
    PetscCall(VecGetArray(solved_, &numbers));
    blocks_.take(numbers, x);
    PetscCall(VecRestoreArray(solved_, &numbers));
    PetscFunctionReturn(0);
  }
  PetscCall(VecPlaceArray(given_, b));
  PetscCall(VecPlaceArray(solved_, x));
  const PetscErrorCode error = KSPSolve(solver_, given_, solved_);
  PetscCall(VecResetArray(given_));
  PetscCall(VecResetArray(solved_));
  PetscCall(error);
  PetscFunctionReturn(0);
}

PetscErrorCode System::solve_block(const double* b, double* x, PetscInt columns) {
  PetscFunctionBeginUser;
  Mat right = nullptr, left = nullptr;
  PetscCall(MatCreateDense(ranks_, local_, PETSC_DECIDE, rows_, columns, const_cast<double*>(b), &right));
  PetscCall(MatCreateDense(ranks_, local_, PETSC_DECIDE, rows_, columns, x, &left));
  PetscCall(KSPMatSolve(solver_, right, left));
  PetscCall(MatDestroy(&right));
  PetscCall(MatDestroy(&left));
  PetscFunctionReturn(0);
}

PetscErrorCode System::converged(SystemOutcome& outcome) {
  PetscFunctionBeginUser;
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  KSPType method = nullptr;
  PetscInt iterations = 0;
  PetscCall(KSPGetConvergedReason(solver_, &reason));
  PetscCall(KSPGetIterationNumber(solver_, &iterations));
  PetscCall(KSPGetType(solver_, &method));
  iterations_ += iterations;
  if (reason < 0)
    outcome.why =
        fmt::format("the solver \"{}\" of PETSc did not converge in {} iterations ({})", method, iterations, KSPConvergedReasons[reason]);
  PetscFunctionReturn(0);
}

}  // namespace uplift
