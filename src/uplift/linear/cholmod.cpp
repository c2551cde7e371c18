// CHOLMOD's supernodal Cholesky with nested dissection (Chen, Davis, Hager & Rajamanickam, ACM TOMS 35, 2008): the default for the bulk.
#include <algorithm>
#include <mutex>

#include "uplift/linear/cholmod_common.h"
#include "uplift/linear/cholmod_split.h"

namespace uplift {

namespace {

class CholmodFactor : public Factor {
 public:
  CholmodFactor(std::unique_ptr<Common> settings, cholmod_factor* factor) : settings_(std::move(settings)), factor_(factor) {}
  ~CholmodFactor() override { cholmod_free_factor(&factor_, &settings_->common); }
  CholmodFactor(const CholmodFactor&) = delete;
  CholmodFactor& operator=(const CholmodFactor&) = delete;

  void solve(const Matrix& b, Matrix& x) const override {
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

  double nonzeros() const override { return static_cast<double>(factor_->is_super ? factor_->xsize : factor_->nzmax); }

 private:
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

class Cholmod : public LinearSolver {
 public:
  Factorisation factorise(const Sparse& given) const override {
    Sparse lower = given.triangularView<lower_triangle>();
    cholmod_sparse a = sparse_view(lower);
    auto settings = std::make_unique<Common>();
    cholmod_common& common = settings->common;
    cholmod_factor* raw = cholmod_analyze(&a, &common);
    if (!raw) return {.factor = nullptr, .failed_unknown = -1, .why = "the sparse factorisation ran out of memory in its analysis"};
    cholmod_factorize(&a, raw, &common);
    const int status = common.status;
    auto factor = std::make_unique<CholmodFactor>(std::move(settings), raw);
    if (status < 0) return {.factor = nullptr, .failed_unknown = -1, .why = "the sparse factorisation ran out of memory"};
    if (const int broken = broken_unknown(*raw, given); broken >= 0) return singular_at(broken);
    return {.factor = std::move(factor), .failed_unknown = -1, .why = {}};
  }
  SplitFactorisation factorise_split(const Sparse& a, const std::vector<int>& last) const override { return cholmod_split(a, last); }
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
