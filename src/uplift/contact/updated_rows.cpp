#include "uplift/contact/updated_rows.h"

#include <algorithm>
#include <cassert>

namespace uplift {

void UpdatedRows::size(Index n) {
  if (n_ == n) return;
  n_ = n;
  most_ = std::clamp<Index>(n / 8, 4, 240);
  base_.setZero(n, n);
  for (Matrix* m : {&columns_, &gathered_, &delta_}) m->setZero(n, most_);
  small_.setIdentity(most_, most_);
  column_of_.assign(static_cast<std::size_t>(n), -1);
  row_of_.reserve(static_cast<std::size_t>(most_));
  changed_.reserve(static_cast<std::size_t>(most_));
  work_.setZero(n);
  part_.setZero(most_);
  answer_.setZero(most_);
}

bool UpdatedRows::factorise() {
  restore();
  used_ = 0;
  row_of_.clear();
  std::fill(column_of_.begin(), column_of_.end(), Index{-1});
  lu_.compute(base_);
  const auto pivots = lu_.matrixLU().diagonal().cwiseAbs();
  return pivots.minCoeff() > 1e-14 * pivots.maxCoeff();
}

double* UpdatedRows::change(Index i) {
  assert(static_cast<Index>(changed_.size()) < most_);
  changed_.push_back(i);
  return delta_.col(static_cast<Index>(changed_.size()) - 1).data();
}

/// A0 X = B in place: the factor is that of A0^T, P A0^T = L U, A0 = U^T L^T P.
template <class Columns>
void UpdatedRows::solve_base(Columns&& x) {
  lu_.matrixLU().triangularView<upper_triangle>().transpose().solveInPlace(x);
  lu_.matrixLU().triangularView<Eigen::UnitLower>().transpose().solveInPlace(x);
  const auto& place = lu_.permutationP().indices();
  for (Index j = 0; j < x.cols(); ++j) {
    work_ = x.col(j);
    for (Index i = 0; i < n_; ++i) x(i, j) = work_[place[i]];
  }
}

/// Columns of X for the rows that have none yet; when there is no room, those of other sets are given up.
void UpdatedRows::find_columns() {
  Index missing = 0;
  for (const Index row : changed_) missing += column_of_[static_cast<std::size_t>(row)] < 0;
  if (missing == 0) return;
  if (used_ + missing > most_) {
    used_ = 0;
    row_of_.clear();
    std::fill(column_of_.begin(), column_of_.end(), Index{-1});
  }
  const Index first = used_;
  for (const Index row : changed_) {
    if (column_of_[static_cast<std::size_t>(row)] >= 0) continue;
    column_of_[static_cast<std::size_t>(row)] = used_;
    columns_.col(used_).setZero();
    columns_(row, used_++) = 1;
  }
  solve_base(columns_.middleCols(first, used_ - first));
}

bool UpdatedRows::prepare() {
  const Index q = static_cast<Index>(changed_.size());
  if (q == 0) return true;
  find_columns();
  for (Index k = 0; k < q; ++k) {
    const Index row = changed_[static_cast<std::size_t>(k)];
    delta_.col(k) -= base_.col(row);
    gathered_.col(k) = columns_.col(column_of_[static_cast<std::size_t>(row)]);
  }
  small_.setIdentity();
  small_.topLeftCorner(q, q).noalias() += delta_.leftCols(q).transpose() * gathered_.leftCols(q);
  small_lu_.compute(small_);
  const auto pivots = small_lu_.matrixLU().diagonal().cwiseAbs();
  return pivots.minCoeff() > 1e-12 * pivots.maxCoeff();
}

void UpdatedRows::solve(Vector& x) {
  const Index q = static_cast<Index>(changed_.size());
  solve_base(x);
  if (q == 0) return;
  part_.setZero();
  part_.head(q).noalias() = delta_.leftCols(q).transpose() * x;
  answer_ = small_lu_.solve(part_);
  x.noalias() -= gathered_.leftCols(q) * answer_.head(q);
}

void UpdatedRows::solve_transposed(Vector& x) {
  const Index q = static_cast<Index>(changed_.size());
  if (q > 0) {  // A^-T b = A0^-T (b - D^T (I + D X)^-T X^T b)
    part_.setZero();
    part_.head(q).noalias() = gathered_.leftCols(q).transpose() * x;
    small_lu_.matrixLU().triangularView<upper_triangle>().transpose().solveInPlace(part_);
    small_lu_.matrixLU().triangularView<Eigen::UnitLower>().transpose().solveInPlace(part_);
    const auto& order = small_lu_.permutationP().indices();  // Eigen's own transposed solve allocates
    for (Index i = 0; i < most_; ++i) answer_[i] = part_[order[i]];
    x.noalias() -= delta_.leftCols(q) * answer_.head(q);
  }
  const auto& place = lu_.permutationP().indices();
  work_ = x;
  for (Index i = 0; i < n_; ++i) x[place[i]] = work_[i];
  lu_.matrixLU().triangularView<Eigen::UnitLower>().solveInPlace(x);
  lu_.matrixLU().triangularView<upper_triangle>().solveInPlace(x);
}

}  // namespace uplift
