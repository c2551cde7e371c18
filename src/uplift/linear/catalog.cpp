#include <array>

#include "uplift/linear/solver.h"

namespace uplift {

#define SOLVER(name) const Entry<LinearSolver>& entry_solver_##name();
#include "uplift/parts.def"

std::span<const Entry<LinearSolver>* const> solver_catalog() {
  static const std::array entries{
#define SOLVER(name) &entry_solver_##name(),
#include "uplift/parts.def"
  };
  return entries;
}

std::span<const PartInfo* const> linear_solvers() {
  static const std::vector<const PartInfo*> infos(solver_catalog().begin(), solver_catalog().end());
  return infos;
}

}  // namespace uplift
