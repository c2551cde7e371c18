#include "uplift/contact/held_rows.h"

#include <algorithm>

#include "uplift/math/dense.h"
#include "uplift/math/small.h"

namespace uplift {

void HeldRows::size(Index most, Index r) {
  if (most_ == most && r_ == r) return;
  most_ = most, r_ = r;
  const Index least = std::min(most, r);
  transposed_.setZero(r, most);
  gram_.setZero(least, least);
  product_.setZero(most, least);
  range_ = image_ = Orthonormal();
  range_.size(r, most);
  image_.size(most, least);
  rest_.setZero(r);
  part_.setZero(std::max(most, r));
  push_.setZero(std::max(most, r));
}

void HeldRows::compute(Index count) {
  count_ = count;
  cholesky_ = false;
  if (count == 0) return;
  wide_ = count <= r_;
  order_ = std::min(count, r_);
  auto gram = gram_.topLeftCorner(order_, order_);
  const auto a = transposed_.leftCols(count);
  if (wide_)
    gram.noalias() = a.transpose() * a;
  else
    gram.noalias() = a * a.transpose();
  const Eigen::LLT<Eigen::Ref<Matrix>> factored(gram);  // in place
  if (factored.info() == Success) cholesky_ = gram.diagonal().minCoeff() > 1e-4 * gram.diagonal().maxCoeff();
  if (cholesky_) return;
  range_.compute(transposed_, r_, count, 1e-10);
  product_.topLeftCorner(count, range_.rank()).noalias() = a.transpose() * range_.basis().leftCols(range_.rank());
  image_.compute(product_, count, range_.rank(), 0);
}

void HeldRows::solve_gram(Vector& x) const {
  const auto lower = gram_.topLeftCorner(order_, order_).triangularView<lower_triangle>();
  auto head = x.head(order_);
  lower.solveInPlace(head);
  lower.transpose().solveInPlace(head);
}

void HeldRows::least_norm(const Vector& b, Vector& z) {
  if (count_ == 0) {
    z.setZero();
    return;
  }
  const auto a = transposed_.leftCols(count_);
  if (!cholesky_) {
    image_.solve(b, part_);
    z.noalias() = range_.basis().leftCols(range_.rank()) * part_.head(range_.rank());
  } else if (wide_) {
    part_.head(count_) = b.head(count_);
    solve_gram(part_);
    z.noalias() = a * part_.head(count_);
  } else {
    z.noalias() = a * b.head(count_);
    solve_gram(z);
  }
}

/// q += factor * the shortest q' with A^T q' = z.
void HeldRows::add_transposed(double factor, const Vector& z, Vector& q) {
  const auto a = transposed_.leftCols(count_);
  if (!cholesky_) {
    part_.head(range_.rank()).noalias() = range_.basis().leftCols(range_.rank()).transpose() * z;
    image_.solve_transposed(part_, push_);
  } else if (wide_) {
    push_.head(count_).noalias() = a.transpose() * z;
    solve_gram(push_);
  } else {
    part_.head(r_) = z;
    solve_gram(part_);
    push_.head(count_).noalias() = a.transpose() * part_.head(r_);
  }
  q.head(count_) += factor * push_.head(count_);
}

void HeldRows::multipliers(const Vector& z, Vector& q) {
  q.head(count_).setZero();
  if (count_ == 0) return;
  for (int pass = 0; pass < 3; ++pass) {
    rest_ = z;
    rest_.noalias() += transposed_.leftCols(count_) * q.head(count_);
    add_transposed(-1, rest_, q);
  }
}

}  // namespace uplift
