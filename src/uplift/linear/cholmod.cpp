// CHOLMOD's supernodal Cholesky with nested dissection (Chen, Davis, Hager & Rajamanickam, ACM TOMS 35, 2008): the default for the bulk.
#include <algorithm>
#include <mutex>
#include <utility>

#include "uplift/linear/cholmod_common.h"
#include "uplift/linear/cholmod_split.h"
#include "uplift/linear/memory.h"

namespace uplift {

namespace {

class CholmodFactor : public Factor {
 public:
  CholmodFactor(std::unique_ptr<Common> settings, cholmod_factor* factor) : settings_(std::move(settings)), factor_(factor) {}
  ~CholmodFactor() override { cholmod_free_factor(&factor_, &settings_->common); }
  CholmodFactor(const CholmodFactor&) = delete;
  CholmodFactor& operator=(const CholmodFactor&) = delete;

  void solve(const Matrix& b, Matrix& x) const override {
    if (b.cols() == 1 && factor_->is_super) return solve_one(b, x);
    std::unique_ptr<Workspace> work = take();
    cholmod_dense right = dense_view(b.data(), b.rows(), b.cols());
    if (b.size() > 0) {
      cholmod_solve2(CHOLMOD_A, factor_, &right, nullptr, &work->x, nullptr, &work->y, &work->e, &work->settings.common);
      if (&x != &b) x.resize(b.rows(), b.cols());
      const auto* solution = static_cast<const double*>(work->x->x);
      std::copy(solution, solution + x.size(), x.data());
    } else {
      x = b;
    }
    give_back(std::move(work));
  }

  Factorisation refactorise(const Sparse& a) const override;
  /// The numbers: `upper` is the triangle of `a`.
  static Factorisation fill(std::unique_ptr<CholmodFactor> factor, cholmod_sparse& upper, const Sparse& a);

  double nonzeros() const override { return static_cast<double>(factor_->is_super ? factor_->xsize : factor_->nzmax); }

 private:
  /// One right-hand side through our own loops (supernodal.h).
  void solve_one(const Matrix& b, Matrix& x) const {
    const auto* order = static_cast<const int*>(factor_->Perm);
    std::unique_ptr<Workspace> work = take();
    work->column.resize(2 * static_cast<Index>(factor_->n));
    double *solution = work->column.data(), *scratch = solution + factor_->n;
    for (Index k = 0; k < b.rows(); ++k) solution[k] = b(order[k], 0);
    solve_lower(supernodes(*factor_), solution, scratch);
    solve_lower_transposed(supernodes(*factor_), solution, scratch);
    x.resize(b.rows(), 1);
    for (Index k = 0; k < x.rows(); ++k) x(order[k], 0) = solution[k];
    give_back(std::move(work));
  }
  std::unique_ptr<Workspace> take() const {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<Workspace>();
    std::unique_ptr<Workspace> work = std::move(idle_.back());
    idle_.pop_back();
    return work;
  }
  void give_back(std::unique_ptr<Workspace> work) const {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(work));
  }

  std::unique_ptr<Common> settings_;
  cholmod_factor* factor_;
  mutable std::mutex mutex_;  // guards the idle workspaces only; the factor itself is read-only in a solve
  mutable std::vector<std::unique_ptr<Workspace>> idle_;
};

Factorisation failed(std::string why) {
  return {.factor = nullptr, .failed_unknown = -1, .why = std::move(why), .too_large = true};
}

Factorisation CholmodFactor::fill(std::unique_ptr<CholmodFactor> factor, cholmod_sparse& upper, const Sparse& a) {
  cholmod_factorize(&upper, factor->factor_, &factor->settings_->common);
  if (factor->settings_->common.status < 0) return failed("the sparse factorisation ran out of memory");
  if (const int broken = broken_unknown(*factor->factor_, a); broken >= 0) return singular_at(broken);
  return {.factor = std::move(factor), .failed_unknown = -1, .why = {}};
}

Factorisation CholmodFactor::refactorise(const Sparse& a) const {
  if (!has_room(*factor_, a)) return {};
  Sparse upper = a.triangularView<upper_triangle>();
  cholmod_sparse view = sparse_view(upper);
  auto settings = std::make_unique<Common>();
  if (std::string why = refusal(cost_of(*factor_, settings->common, upper.nonZeros())); !why.empty()) return failed(std::move(why));
  cholmod_factor* copy = cholmod_copy_factor(factor_, &settings->common);
  if (copy == nullptr) return failed("the sparse factorisation ran out of memory");
  return fill(std::make_unique<CholmodFactor>(std::move(settings), copy), view, a);
}

/// The analysis of a matrix: its upper triangle and the factor without numbers, null when there is none.
struct Analysed {
  explicit Analysed(const Sparse& given) : upper(given.triangularView<upper_triangle>()), settings(std::make_unique<Common>()) {
    view = sparse_view(upper);
    factor = analyse(view, *settings);
  }
  ~Analysed() {
    if (settings != nullptr) cholmod_free_factor(&factor, &settings->common);
  }
  Analysed(const Analysed&) = delete;
  Analysed& operator=(const Analysed&) = delete;
  Sparse upper;
  cholmod_sparse view{};
  std::unique_ptr<Common> settings;
  cholmod_factor* factor = nullptr;
};

class Cholmod : public LinearSolver {
 public:
  Factorisation factorise(const Sparse& given) const override {
    Analysed analysed(given);
    if (analysed.factor == nullptr) return failed(why_not_analysed(analysed.settings->common));
    const FactorCost cost = cost_of(*analysed.factor, analysed.settings->common, analysed.upper.nonZeros());
    if (std::string why = refusal(cost); !why.empty()) return failed(std::move(why));
    cholmod_factor* raw = std::exchange(analysed.factor, nullptr);
    return CholmodFactor::fill(std::make_unique<CholmodFactor>(std::move(analysed.settings), raw), analysed.view, given);
  }
  SplitFactorisation factorise_split(const Sparse& a, const std::vector<int>& last) const override { return cholmod_split(a, last); }
  FactorCost predict(const Sparse& a, const std::vector<int>& last) const override {
    if (!last.empty()) return cholmod_split_cost(a, last);
    const Analysed analysed(a);
    if (analysed.factor != nullptr) return cost_of(*analysed.factor, analysed.settings->common, analysed.upper.nonZeros());
    FactorCost cost;
    cost.why = why_not_analysed(analysed.settings->common);
    return cost;
  }
};

}  // namespace

const Entry<LinearSolver>& entry_solver_cholmod() {
  static const Entry<LinearSolver> entry{{.name = "cholmod",
                                          .summary = "supernodal sparse Cholesky with nested dissection: the default",
                                          .equations = "P A P^T = L L^T",
                                          .source = "SuiteSparse 5.12; Chen, Davis, Hager & Rajamanickam, ACM TOMS 35 (2008)",
                                          .params = {}},
                                         [](const Values&) { return std::make_unique<Cholmod>(); }};
  return entry;
}

}  // namespace uplift
