#pragma once
#include <span>

#include "uplift/linear/solver.h"

namespace uplift {

/// The solvers that need no other program: all but the last one, "petsc".
inline std::span<const Entry<LinearSolver>* const> local_solvers() {
  return solver_catalog().first(solver_catalog().size() - 1);
}

}  // namespace uplift
