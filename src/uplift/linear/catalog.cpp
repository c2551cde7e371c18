#include <fmt/format.h>

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

SplitFactorisation LinearSolver::factorise_split(const Sparse&, const std::vector<int>&) const {
  return {};
}

Factorisation Factor::refactorise(const Sparse&) const {
  return {};
}

SplitFactorisation SplitFactor::refactorise(const Sparse&) const {
  return {};
}

void SplitFactor::forward_all(std::span<const Vector* const> b, std::span<Vector* const> y) const {
  for (std::size_t k = 0; k < b.size(); ++k) forward(*b[k], *y[k]);
}

void SplitFactor::backward_all(std::span<const Vector* const> y, std::span<Vector* const> x) const {
  for (std::size_t k = 0; k < y.size(); ++k) backward(*y[k], *x[k]);
}

std::shared_ptr<const SymmetricPair> LinearSolver::pair(const Sparse& a, const Sparse& b) const {
  return std::make_shared<const SymmetricPair>(a, b);
}

FactorCost LinearSolver::predict(const Sparse& a, const std::vector<int>&) const {
  FactorCost cost;
  cost.unknowns = static_cast<double>(a.rows());
  return cost;
}

Factorisation singular_at(int unknown) {
  return {.factor = nullptr, .failed_unknown = unknown, .why = fmt::format("the matrix is not positive definite at unknown {}", unknown)};
}

}  // namespace uplift
