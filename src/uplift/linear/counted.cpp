#include <fmt/format.h>

#include "uplift/linear/solver.h"

namespace uplift {

namespace {

class CountedFactor : public Factor {
 public:
  CountedFactor(std::unique_ptr<const Factor> factor, std::shared_ptr<SolverCounters> counters)
      : factor_(std::move(factor)), counters_(std::move(counters)) {}
  void solve(const Matrix& b, Matrix& x) const override {
    ++counters_->back_solves;
    counters_->columns += b.cols();
    factor_->solve(b, x);
  }
  double nonzeros() const override { return factor_->nonzeros(); }

 private:
  std::unique_ptr<const Factor> factor_;
  std::shared_ptr<SolverCounters> counters_;
};

class CountedSolver : public LinearSolver {
 public:
  CountedSolver(std::shared_ptr<const LinearSolver> solver, std::shared_ptr<SolverCounters> counters)
      : solver_(std::move(solver)), counters_(std::move(counters)) {}
  Factorisation factorise(const Sparse& a) const override {
    ++counters_->factorisations;
    Factorisation result = solver_->factorise(a);
    if (result.factor) result.factor = std::make_unique<CountedFactor>(std::move(result.factor), counters_);
    return result;
  }

 private:
  std::shared_ptr<const LinearSolver> solver_;
  std::shared_ptr<SolverCounters> counters_;
};

}  // namespace

std::unique_ptr<const LinearSolver> counted(std::shared_ptr<const LinearSolver> solver, std::shared_ptr<SolverCounters> counters) {
  return std::make_unique<CountedSolver>(std::move(solver), std::move(counters));
}

Factorisation singular_at(int unknown) {
  return {.factor = nullptr, .failed_unknown = unknown, .why = fmt::format("the matrix is not positive definite at unknown {}", unknown)};
}

}  // namespace uplift
