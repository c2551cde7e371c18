#include "uplift/linear/solver.h"
#include "uplift/math/sparse_solvers.h"

namespace uplift {

namespace {

class EigenFactor : public Factor {
 public:
  explicit EigenFactor(std::unique_ptr<const SparseLdlt> ldlt) : ldlt_(std::move(ldlt)) {}
  void solve(const Matrix& b, Matrix& x) const override { x = ldlt_->solve(b).eval(); }
  double nonzeros() const override { return static_cast<double>(ldlt_->matrixL().nestedExpression().nonZeros() + ldlt_->rows()); }  // and D

 private:
  std::unique_ptr<const SparseLdlt> ldlt_;
};

class EigenSolver : public LinearSolver {
 public:
  Factorisation factorise(const Sparse& a) const override {
    auto ldlt = std::make_unique<SparseLdlt>(Sparse(a.transpose()));  // which reads the lower triangle
    const Vector diagonal = ldlt->permutationP() * Vector(a.diagonal());
    const auto& pivots = ldlt->vectorD();
    for (Index k = 0; k < pivots.size(); ++k)
      if (!(pivots[k] > least_pivot * diagonal[k])) return singular_at(ldlt->permutationPinv().indices()[k]);
    return {.factor = std::make_unique<EigenFactor>(std::move(ldlt)), .failed_unknown = -1, .why = {}};
  }
};

}  // namespace

const Entry<LinearSolver>& entry_solver_eigen() {
  static const Entry<LinearSolver> entry{{.name = "eigen",
                                          .summary = "sparse LDL^T of Eigen, without BLAS: good enough in 2D, slow for large 3D soil",
                                          .equations = "P A P^T = L D L^T, P: approximate minimum degree",
                                          .source = "Eigen 3.4, SimplicialLDLT",
                                          .params = {}},
                                         [](const Values&) { return std::make_unique<EigenSolver>(); }};
  return entry;
}

}  // namespace uplift
