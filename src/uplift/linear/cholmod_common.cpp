#include "uplift/linear/cholmod_common.h"

#include <algorithm>
#include <mutex>

#include "uplift/linear/blas.h"
#include "uplift/linear/memory.h"

namespace uplift {

Common::Common() {
  cholmod_start(&common);
  common.print = 0;
  common.nmethods = 2;
  common.method[0].ordering = CHOLMOD_NESDIS;
  common.method[1].ordering = CHOLMOD_AMD;
  common.postorder = 1;
  common.supernodal = CHOLMOD_SUPERNODAL;
  common.final_ll = 1;
}

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

cholmod_sparse sparse_view(Sparse& upper) {
  upper.makeCompressed();
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(upper.rows());
  view.nzmax = static_cast<std::size_t>(upper.nonZeros());
  view.p = upper.outerIndexPtr();
  view.i = upper.innerIndexPtr();
  view.x = upper.valuePtr();
  view.stype = 1;  // the upper triangle is stored
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = view.packed = 1;
  return view;
}

Supernodes supernodes(const cholmod_factor& factor) {
  return {factor.nsuper,
          static_cast<const int*>(factor.super),
          static_cast<const int*>(factor.pi),
          static_cast<const int*>(factor.px),
          static_cast<const int*>(factor.s),
          static_cast<const double*>(factor.x)};
}

bool has_room(const cholmod_factor& factor, const Sparse& a) {
  if (factor.is_super == 0 || a.rows() != static_cast<Index>(factor.n)) return false;
  const Supernodes nodes = supernodes(factor);
  const auto* order = static_cast<const int*>(factor.Perm);
  std::vector<int> place(factor.n), node(factor.n);
  for (std::size_t s = 0; s < nodes.count; ++s)
    for (int k = nodes.super[s]; k < nodes.super[s + 1]; ++k) {
      place[static_cast<std::size_t>(order[k])] = k;
      node[static_cast<std::size_t>(k)] = static_cast<int>(s);
    }
  for (int column = 0; column < a.outerSize(); ++column)
    for (Sparse::InnerIterator entry(a, column); entry && entry.row() <= column; ++entry) {
      const auto [low, high] = std::minmax(place[static_cast<std::size_t>(entry.row())], place[static_cast<std::size_t>(column)]);
      const int s = node[static_cast<std::size_t>(low)];
      if (!std::binary_search(nodes.rows + nodes.pi[s], nodes.rows + nodes.pi[s + 1], high)) return false;
    }
  return true;
}

FactorCost cost_of(const cholmod_factor& analysed, const cholmod_common& common, Index entries) {
  const auto n = static_cast<double>(analysed.n), values = static_cast<double>(analysed.xsize);
  const double numbers = static_cast<double>(analysed.ssize) + 3 * static_cast<double>(analysed.nsuper) + 2 * n;
  FactorCost cost;
  cost.unknowns = n;
  cost.entries = values;
  cost.operations = common.fl;
  cost.bytes = 8 * values + 4 * numbers;
  // the matrix as it was given and permuted, the largest update of a supernode, CHOLMOD's work space
  cost.working_bytes = 2 * (12 * static_cast<double>(entries) + 4 * n) + 8 * static_cast<double>(analysed.maxcsize) + 16 * n;
  return cost;
}

std::string refusal(const FactorCost& cost) {
  constexpr double small = 16e6;  // bytes, not worth asking the system for
  const double needed = cost.bytes + cost.working_bytes;
  std::string why;
  if (needed >= small) {
    give_back_free_memory();  // of the analysis
    why = memory_refusal(needed, available_memory());
  }
  if (why.empty()) prepare_blas();
  return why;
}

cholmod_factor* analyse(cholmod_sparse& matrix, Common& settings) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  return cholmod_analyze(&matrix, &settings.common);
}

std::string why_not_analysed(const cholmod_common& common) {
  if (common.status == CHOLMOD_TOO_LARGE) return "the factor has more than 2.1e9 entries, more than CHOLMOD counts: coarsen the mesh";
  return "the sparse factorisation ran out of memory in its analysis";
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
