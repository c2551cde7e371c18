#include "uplift/math/dense.h"

#include "uplift/linear/memory.h"
#include "uplift/linear/solver.h"

namespace uplift {

namespace {

class DenseFactor : public Factor {
 public:
  explicit DenseFactor(Cholesky cholesky) : cholesky_(std::move(cholesky)) {}
  void solve(const Matrix& b, Matrix& x) const override {
    if (&x != &b) x = b;
    cholesky_->solveInPlace(x);
  }
  double nonzeros() const override { return 0.5 * static_cast<double>(cholesky_->rows()) * static_cast<double>(cholesky_->rows() + 1); }

 private:
  Cholesky cholesky_;
};

/// First column whose pivot is not positive beyond round-off; the size of the matrix when there is none.
Index broken_column(Matrix a) {
  const Index n = a.rows();
  const Vector diagonal = a.diagonal();
  for (Index j = 0; j < n; ++j) {
    a.col(j).tail(n - j) -= a.bottomLeftCorner(n - j, j) * a.row(j).head(j).transpose();
    if (!(a(j, j) > LinearSolver::least_pivot * diagonal[j])) return j;
    a.col(j).tail(n - j) /= std::sqrt(a(j, j));
  }
  return n;
}

class Dense : public LinearSolver {
 public:
  Factorisation factorise(const Sparse& a) const override {
    const FactorCost cost = predict(a, {});
    if (std::string why = memory_refusal(cost.bytes + cost.working_bytes, available_memory()); !why.empty())
      return {.factor = nullptr, .failed_unknown = -1, .why = std::move(why), .too_large = true};
    const Matrix full = Matrix(a).selfadjointView<upper_triangle>();
    Cholesky cholesky(full);
    const Vector pivots = cholesky->matrixLLT().diagonal().cwiseAbs2();
    if (cholesky->info() != Success || !((pivots.array() > least_pivot * full.diagonal().array()).all())) {
      const Index broken = broken_column(full);
      // a pivot on the edge may pass the second, unblocked factorisation: then its smallest ratio is named
      Index smallest = 0;
      pivots.cwiseQuotient(full.diagonal()).minCoeff(&smallest);
      return singular_at(static_cast<int>(broken < full.rows() ? broken : smallest));
    }
    return {.factor = std::make_unique<DenseFactor>(std::move(cholesky)), .failed_unknown = -1, .why = {}};
  }
  FactorCost predict(const Sparse& a, const std::vector<int>&) const override {
    const auto n = static_cast<double>(a.rows());
    return {.unknowns = n, .entries = n * n, .operations = n * n * n / 3, .bytes = 8 * n * n, .working_bytes = 8 * n * n, .why = {}};
  }
};

}  // namespace

const Entry<LinearSolver>& entry_solver_dense() {
  static const Entry<LinearSolver> entry{
      {.name = "dense",
       .summary = "dense Cholesky: the fastest for a few hundred unknowns, and the oracle of the sparse solvers",
       .equations = "A = L L^T",
       .source = "Eigen 3.4, LLT",
       .params = {}},
      [](const Values&) { return std::make_unique<Dense>(); }};
  return entry;
}

}  // namespace uplift
