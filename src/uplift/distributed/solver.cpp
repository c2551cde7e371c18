// The matrix is solved as D^-1/2 A D^-1/2 with D its diagonal: pivots and residuals have no unit then, and conjugate gradients on it are
// those with Jacobi's preconditioner, whose residual is measured with the weights 1/sqrt(A_ii).
#include <fmt/format.h>

#include <limits>
#include <utility>

#include "uplift/base/text.h"
#include "uplift/distributed/ranks.h"
#include "uplift/linear/petsc.h"

namespace uplift {

namespace {

class PetscFactor : public Factor {
 public:
  PetscFactor(std::int64_t system, Vector scale, double nonzeros) : system_(system), scale_(std::move(scale)), nonzeros_(nonzeros) {}
  ~PetscFactor() override { Ranks::all().release(system_); }
  PetscFactor(const PetscFactor&) = delete;
  PetscFactor& operator=(const PetscFactor&) = delete;

  /// An iterative method that does not converge leaves no number: the step that asked fails, and the program says why in the end.
  void solve(const Matrix& b, Matrix& x) const override {
    const Matrix given = scale_.asDiagonal() * b;
    Matrix solved;
    if (Ranks::all().solve(system_, given, solved).ok())
      x = scale_.asDiagonal() * solved;
    else
      x = Matrix::Constant(b.rows(), b.cols(), std::numeric_limits<double>::quiet_NaN());
  }
  double nonzeros() const override { return nonzeros_; }

 private:
  std::int64_t system_;
  Vector scale_;
  double nonzeros_;
};

class PetscSolver final : public LinearSolver {
 public:
  explicit PetscSolver(std::string options) : options_(std::move(options)) {}
  Factorisation factorise(const Sparse& a) const override {
    Vector scale = a.diagonal();
    for (Index i = 0; i < scale.size(); ++i) {
      if (!(scale[i] > 0)) return singular_at(static_cast<int>(i));
      scale[i] = 1 / std::sqrt(scale[i]);
    }
    const Sparse upper = scale.asDiagonal() * Sparse(a.triangularView<upper_triangle>()) * scale.asDiagonal();
    Sparse full = upper.selfadjointView<upper_triangle>();
    full.makeCompressed();
    Ranks::Made made = Ranks::all().make(full, options_);
    if (!made.outcome.ok())
      return {.factor = nullptr, .failed_unknown = -1, .why = std::move(made.outcome.why), .too_large = made.outcome.too_large};
    return {.factor = std::make_unique<PetscFactor>(made.system, std::move(scale), made.nonzeros), .failed_unknown = -1, .why = {}};
  }

 private:
  std::string options_;
};

}  // namespace

std::unique_ptr<const LinearSolver> make_petsc(const Values& values) {
  const std::string& options = values.text("options");
  const auto refuse = [&](const std::string& found) {
    fail(values, "options", "options with which PETSc solves a matrix, as \"-ksp_type cg -pc_type jacobi\"", found);
  };
  if (!options.empty() && options.front() != '-') refuse(in_quotes(options));
  if (const std::string why = Ranks::all().refuse(options); !why.empty()) refuse(fmt::format("{}: {}", in_quotes(options), why));
  return std::make_unique<PetscSolver>(options);
}

}  // namespace uplift
