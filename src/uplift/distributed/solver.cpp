// The matrix is solved as D^-1/2 A D^-1/2 with D its diagonal: pivots and residuals have no unit then, and conjugate gradients on it are
// those with Jacobi's preconditioner, whose residual is measured with the weights 1/sqrt(A_ii).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "uplift/base/text.h"
#include "uplift/distributed/kept.h"
#include "uplift/distributed/ranks.h"
#include "uplift/linear/large.h"
#include "uplift/linear/petsc.h"
#include "uplift/math/dense.h"

namespace uplift {

namespace {

class PetscFactor : public FactorWithReach {
 public:
  PetscFactor(std::int64_t system, Index rows, double nonzeros, double reach)
      : system_(system), rows_(rows), nonzeros_(nonzeros), reach_(reach) {}
  ~PetscFactor() override { Ranks::all().release(system_); }
  PetscFactor(const PetscFactor&) = delete;
  PetscFactor& operator=(const PetscFactor&) = delete;

  /// An iterative method that does not converge leaves no number: the step that asked fails, and the program says why in the end.
  void solve(const Matrix& b, Matrix& x) const override { solve_to(b, x, 0); }
  void solve_to(const Matrix& b, Matrix& x, double residual) const override {
    if (!Ranks::all().solve(system_, b, x, residual).ok()) x.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  /// (A^-1)_tt of chosen unknowns t.
  SystemOutcome flexibility(const std::vector<int>& chosen, Matrix& entries) const {
    SystemOutcome outcome = Ranks::all().flexibility(system_, rows_, chosen, entries);
    entries = (0.5 * (entries + entries.transpose())).eval();
    return outcome;
  }
  double nonzeros() const override { return nonzeros_; }
  double reach() const override { return reach_; }

 private:
  std::int64_t system_;
  Index rows_;
  double nonzeros_, reach_;
};

/// Chosen unknowns t "last" by solves with the whole matrix: with G = (A^-1)_tt = U U^T, U upper triangular, L_tt = U^-T. What a forward
/// half keeps is u = A^-1 b, and behind it the tail y_t = U^-1 u_t. A tail that was changed since then by d is a force U^-T d on the chosen
/// unknowns:
///   x = u + A^-1 (U^-T d)_t
/// Nothing larger than G is kept: X = A^-1 B^T, unknowns x rows, would take more memory than the factor.
class PetscSplit final : public SplitFactor {
 public:
  PetscSplit(std::unique_ptr<const Factor> factor, Index rows, std::vector<int> last, Matrix upper)
      : factor_(std::move(factor)), last_(std::move(last)), upper_(std::move(upper)), rows_(rows) {}
  void forward(const Vector& b, Vector& y) const override {
    Matrix u = b;
    factor_->solve(u, u);
    const Vector tail = tail_of(u.col(0));
    y.resize(b.size() + std::ssize(last_));
    y << u, tail;
  }
  /// `y` of a forward half, or as long as the matrix has rows with nothing but a tail.
  void backward(const Vector& y, Vector& x) const override {
    const Index chosen = std::ssize(last_);
    const bool of_forward = y.size() == rows_of_half();
    x = of_forward ? Vector(y.head(y.size() - chosen)) : Vector(Vector::Zero(y.size()));
    const Vector change = of_forward ? Vector(y.tail(chosen) - tail_of(x)) : Vector(y.tail(chosen));
    if (change.isZero(0)) return;
    const Vector force = upper_.triangularView<upper_triangle>().transpose().solve(change);
    Matrix load = Matrix::Zero(x.size(), 1);
    for (Index k = 0; k < chosen; ++k) load(last_[static_cast<std::size_t>(k)], 0) = force[k];
    factor_->solve(load, load);
    x += load.col(0);
  }
  Matrix last() const override {
    return upper_.triangularView<upper_triangle>().transpose().solve(Matrix::Identity(upper_.rows(), upper_.rows()));
  }
  double nonzeros() const override { return factor_->nonzeros(); }

 private:
  Index rows_of_half() const { return rows_ + std::ssize(last_); }
  Vector tail_of(const Eigen::Ref<const Vector>& u) const {
    Vector tail(std::ssize(last_));
    for (Index k = 0; k < tail.size(); ++k) tail[k] = u[last_[static_cast<std::size_t>(k)]];
    upper_.triangularView<upper_triangle>().solveInPlace(tail);
    return tail;
  }
  std::unique_ptr<const Factor> factor_;
  std::vector<int> last_;
  Matrix upper_;
  Index rows_;  // of the matrix
};

/// 1 / sqrt(A_ii), and the first unknown without it; -1: all have one.
int find_scale(const SymmetricSum& a, Vector& scale) {
  scale = a.diagonal();
  for (Index i = 0; i < scale.size(); ++i) {
    if (!(scale[i] > 0)) return static_cast<int>(i);
    scale[i] = 1 / std::sqrt(scale[i]);
  }
  return -1;
}

class PetscSolver final : public DistributedSolver {
 public:
  struct Settings {
    std::string options, of_statics;  // of PETSc
    double reach = 0;                 // m
    bool stiff_block = true;
  };
  explicit PetscSolver(Settings settings, RigidMotions motions = {}) : settings_(std::move(settings)), motions_(std::move(motions)) {}
  Factorisation factorise(const Sparse& a) const override { return factorise_sum(a); }
  FactorCost predict(const Sparse& a, const std::vector<int>&) const override { return predict_sum(a); }
  SplitFactorisation factorise_split(const Sparse& a, const std::vector<int>& last) const override { return factorise_split_sum(a, last); }
  std::shared_ptr<const MatrixHome> home() const override {
    return std::make_shared<const HomeOnRanks>(no_entries(settings_.options) && no_entries(settings_.of_statics));
  }
  Factorisation factorise_sum(const SymmetricSum& a) const override {
    Vector scale;
    if (const int loose = find_scale(a, scale); loose >= 0) return singular_at(loose);
    Ranks::Made made = Ranks::all().make(a, scale, settings_.options, motions_, stiff_part(a, scale));
    if (!made.outcome.ok())
      return {.factor = nullptr, .failed_unknown = -1, .why = std::move(made.outcome.why), .too_large = made.outcome.too_large};
    return {.factor = std::make_unique<PetscFactor>(made.system, a.rows(), made.nonzeros, settings_.reach),
            .failed_unknown = -1,
            .why = {},
            .remark = std::move(made.remark)};
  }
  FactorCost predict_sum(const SymmetricSum& a) const override {
    FactorCost cost;
    cost.unknowns = static_cast<double>(a.rows());
    Vector scale;
    if (find_scale(a, scale) >= 0) return cost;  // the factorisation will refuse it
    const Ranks::Forecast forecast = Ranks::all().foretell(a, scale, settings_.options, stiff_part(a, scale));
    cost.entries = forecast.mine.entries, cost.operations = forecast.mine.operations;
    cost.bytes = forecast.mine.bytes;
    cost.why = forecast.outcome.why;
    cost.most_elsewhere = forecast.most_elsewhere, cost.beside = forecast.beside;
    return cost;
  }
  SplitFactorisation factorise_split_sum(const SymmetricSum& a, const std::vector<int>& last) const override {
    if (settings_.reach > 0) return {};
    Factorisation whole = factorise_sum(a);
    if (whole.factor == nullptr)
      return {.factor = nullptr, .failed_unknown = whole.failed_unknown, .why = std::move(whole.why), .too_large = whole.too_large};
    Matrix compliance;
    if (SystemOutcome outcome = static_cast<const PetscFactor&>(*whole.factor).flexibility(last, compliance); !outcome.ok())
      return {.factor = nullptr, .failed_unknown = -1, .why = std::move(outcome.why)};
    const Cholesky turned(Matrix(compliance.reverse()));  // from the last row to the first: G = U U^T
    if (turned->info() != Success)
      return {.factor = nullptr, .failed_unknown = -1, .why = "the flexibility of the interfaces is not positive definite"};
    return {.factor = std::make_unique<PetscSplit>(std::move(whole.factor), a.rows(), last, Matrix(turned->matrixL()).reverse()),
            .failed_unknown = -1,
            .why = {},
            .remark = std::move(whole.remark)};
  }

  static bool no_entries(const std::string& options) { return SolverOptions(options).need_no_entries(); }

  /// Multigrid alone makes use of the motions.
  std::unique_ptr<const LinearSolver> for_statics(const RigidMotions& motions) const override {
    const std::string& options = settings_.of_statics;
    return std::make_unique<PetscSolver>(Settings{options, options, settings_.reach, settings_.stiff_block},
                                         options.find("gamg") != std::string::npos ? motions : RigidMotions());
  }
  /// None: it would be one more copy of both matrices on rank 0.
  std::shared_ptr<const SymmetricPair> pair(const Sparse&, const Sparse&) const override { return nullptr; }
  bool distributed() const override { return true; }

 private:
  /// Of the matrix of a step, a sum of mass and other terms.
  std::vector<int> stiff_part(const SymmetricSum& a, const Vector& scale) const {
    const auto mass = std::ranges::find_if(a.there, &DistributedTerm::is_mass);
    if (!settings_.stiff_block || !no_entries(settings_.options) || mass == a.there.end() || a.there.size() < 2) return {};
    return stiff_unknowns(scale, mass->factor * mass->matrix->diagonal());
  }

  Settings settings_;
  RigidMotions motions_;
};

}  // namespace

std::unique_ptr<const LinearSolver> make_petsc(const Values& values) {
  const auto options = [&](const char* key) -> const std::string& {
    const std::string& given = values.text(key);
    const auto refuse = [&](const std::string& found) {
      fail(values, key, "options with which PETSc solves a matrix, as \"-ksp_type cg -pc_type jacobi\"", found);
    };
    if (!given.empty() && given.front() != '-') refuse(in_quotes(given));
    if (const std::string why = Ranks::all().refuse(given); !why.empty()) refuse(fmt::format("{}: {}", in_quotes(given), why));
    return given;
  };
  const std::string& of_steps = options("options");
  return std::make_unique<PetscSolver>(PetscSolver::Settings{of_steps, values.has("static_options") ? options("static_options") : of_steps,
                                                             values.number("reach"), values.flag("stiff_block")});
}

}  // namespace uplift
