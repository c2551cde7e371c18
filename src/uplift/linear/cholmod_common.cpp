#include "uplift/linear/cholmod_common.h"

namespace uplift {

cholmod_dense dense_view(const double* values, Index rows, Index columns) {
  cholmod_dense view{};
  view.nrow = view.d = static_cast<std::size_t>(rows);
  view.ncol = static_cast<std::size_t>(columns);
  view.nzmax = view.nrow * view.ncol;
  view.x = const_cast<double*>(values);
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  return view;
}

cholmod_sparse sparse_view(Sparse& lower) {
  lower.makeCompressed();
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(lower.rows());
  view.nzmax = static_cast<std::size_t>(lower.nonZeros());
  view.p = lower.outerIndexPtr();
  view.i = lower.innerIndexPtr();
  view.x = lower.valuePtr();
  view.stype = -1;  // the lower triangle is stored
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = view.packed = 1;
  return view;
}

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

int broken_unknown(const cholmod_factor& factor, const Sparse& a) {
  const auto* permutation = static_cast<const int*>(factor.Perm);
  if (factor.minor < factor.n) return permutation[factor.minor];
  const Vector roots = pivots(factor);
  for (Index k = 0; k < roots.size(); ++k)
    if (!(roots[k] * roots[k] > LinearSolver::least_pivot * a.coeff(permutation[k], permutation[k]))) return permutation[k];
  return -1;
}

}  // namespace uplift
