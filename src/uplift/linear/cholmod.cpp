// CHOLMOD's supernodal Cholesky with nested dissection (Chen, Davis, Hager & Rajamanickam, ACM TOMS 35, 2008): the default for the bulk.
#include <cholmod.h>

#include <algorithm>
#include <mutex>

#include "uplift/linear/solver.h"

namespace uplift {

namespace {

/// CHOLMOD's settings and scratch memory: one object per thread that works.
struct Common {
  Common() {
    cholmod_start(&common);
    common.print = 0;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_NESDIS;
    common.postorder = 1;
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.final_ll = 1;
  }
  ~Common() { cholmod_finish(&common); }
  Common(const Common&) = delete;
  Common& operator=(const Common&) = delete;
  cholmod_common common;
};

/// Solution and scratch of one back-solve, kept for the next one of the same size.
struct Workspace {
  Common settings;
  cholmod_dense *x = nullptr, *y = nullptr, *e = nullptr;
  ~Workspace() {
    for (cholmod_dense** matrix : {&x, &y, &e}) cholmod_free_dense(matrix, &settings.common);
  }
};

class CholmodFactor : public Factor {
 public:
  CholmodFactor(std::unique_ptr<Common> settings, cholmod_factor* factor) : settings_(std::move(settings)), factor_(factor) {}
  ~CholmodFactor() override { cholmod_free_factor(&factor_, &settings_->common); }
  CholmodFactor(const CholmodFactor&) = delete;
  CholmodFactor& operator=(const CholmodFactor&) = delete;

  void solve(const Matrix& b, Matrix& x) const override {
    std::unique_ptr<Workspace> work = take();
    cholmod_dense right{};
    right.nrow = right.d = static_cast<std::size_t>(b.rows());
    right.ncol = static_cast<std::size_t>(b.cols());
    right.nzmax = right.nrow * right.ncol;
    right.x = const_cast<double*>(b.data());  // only read
    right.xtype = CHOLMOD_REAL;
    right.dtype = CHOLMOD_DOUBLE;
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

/// Square roots of the pivots, in the order of the factorisation.
Vector pivots(const cholmod_factor& factor) {
  Vector values(static_cast<Index>(factor.n));
  const auto* x = static_cast<const double*>(factor.x);
  if (factor.is_super) {
    const auto *super = static_cast<const int*>(factor.super), *pi = static_cast<const int*>(factor.pi),
               *px = static_cast<const int*>(factor.px);
    for (std::size_t s = 0; s < factor.nsuper; ++s)
      for (int k = super[s]; k < super[s + 1]; ++k) values[k] = x[px[s] + (k - super[s]) * static_cast<Index>(pi[s + 1] - pi[s] + 1)];
  } else {
    const auto* p = static_cast<const int*>(factor.p);
    for (Index k = 0; k < values.size(); ++k) values[k] = x[p[k]];
  }
  return values;
}

/// First unknown whose pivot is not positive beyond round-off; -1 when all are.
int broken_unknown(const cholmod_factor& factor, const Sparse& a) {
  const auto* permutation = static_cast<const int*>(factor.Perm);
  if (factor.minor < factor.n) return permutation[factor.minor];
  const Vector roots = pivots(factor);
  for (Index k = 0; k < roots.size(); ++k)
    if (!(roots[k] * roots[k] > LinearSolver::least_pivot * a.coeff(permutation[k], permutation[k]))) return permutation[k];
  return -1;
}

class Cholmod : public LinearSolver {
 public:
  Factorisation factorise(const Sparse& given) const override {
    Sparse lower = given.triangularView<lower_triangle>();
    lower.makeCompressed();
    cholmod_sparse a{};
    a.nrow = a.ncol = static_cast<std::size_t>(lower.rows());
    a.nzmax = static_cast<std::size_t>(lower.nonZeros());
    a.p = lower.outerIndexPtr();
    a.i = lower.innerIndexPtr();
    a.x = lower.valuePtr();
    a.stype = -1;  // the lower triangle is stored
    a.itype = CHOLMOD_INT;
    a.xtype = CHOLMOD_REAL;
    a.dtype = CHOLMOD_DOUBLE;
    a.sorted = a.packed = 1;
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
