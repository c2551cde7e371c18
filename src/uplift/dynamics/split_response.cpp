#include "uplift/dynamics/split_response.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "uplift/math/dense.h"

namespace uplift {

namespace {

/// B_t = W V^T with one column of W for all columns of B_t that are multiples of each other, as those of the two nodes between which an
/// interface feels the jump alone.
struct JumpRows {
  Matrix w, v;  // rows x r, touched unknowns x r
};

JumpRows jump_rows(const Matrix& b) {
  std::map<std::vector<std::pair<Index, double>>, Index> numbers;  // of columns over their first entry
  std::vector<Index> column, number;                               // of W: one of B_t; of B_t: that of W
  std::vector<double> factor;
  for (Index j = 0; j < b.cols(); ++j) {
    std::vector<std::pair<Index, double>> entries;
    for (Index i = 0; i < b.rows(); ++i)
      if (b(i, j) != 0) entries.emplace_back(i, b(i, j));
    factor.push_back(entries.empty() ? 0 : entries.front().second);  // 0: entries that cancel
    number.push_back(-1);
    if (entries.empty()) continue;
    for (auto& [row, value] : entries) value /= factor.back();
    const auto [found, added] = numbers.try_emplace(std::move(entries), static_cast<Index>(column.size()));
    if (added) column.push_back(j);
    number.back() = found->second;
  }
  const Index r = static_cast<Index>(column.size());
  JumpRows made{Matrix(b.rows(), r), Matrix::Zero(b.cols(), r)};
  for (Index k = 0; k < r; ++k)
    made.w.col(k) = b.col(column[static_cast<std::size_t>(k)]) / factor[static_cast<std::size_t>(column[static_cast<std::size_t>(k)])];
  for (Index j = 0; j < b.cols(); ++j)
    if (const Index k = number[static_cast<std::size_t>(j)]; k >= 0) made.v(j, k) = factor[static_cast<std::size_t>(j)];
  return made;
}

}  // namespace

SplitResponse::SplitResponse(const BulkFactor& factor, const Sparse& b, LinearCounts& counts) : factor_(factor), counts_(counts) {
  const Index touched = static_cast<Index>(factor.last().size());
  Matrix at_touched(b.rows(), touched);
  for (Index j = 0; j < touched; ++j) at_touched.col(j) = b.col(factor.last()[static_cast<std::size_t>(j)]);
  const Matrix l = factor.split()->last();
  if (JumpRows jumps = jump_rows(at_touched); jumps.w.cols() > 0 && jumps.w.cols() < std::min(touched, b.rows())) {
    l.triangularView<lower_triangle>().solveInPlace(jumps.v);
    const Qr qr(jumps.v);
    jumps_.lower = Matrix(qr->matrixQR().topRows(jumps.w.cols()).triangularView<upper_triangle>()).transpose();
    jumps_.rows = jumps.w.sparseView();
    q_ = columns_of_q(qr, jumps.w.cols()).transpose();
    c_.noalias() = jumps.w * jumps_.lower;
    return;
  }
  c_ = l.triangularView<lower_triangle>().solve(at_touched.transpose()).transpose();  // B_t L_tt^-T
  if (b.rows() >= touched) return;
  const Qr qr(c_.transpose());  // touched x rows
  q_ = columns_of_q(qr, b.rows()).transpose();
  c_ = Matrix(qr->matrixQR().topRows(b.rows()).triangularView<upper_triangle>()).transpose();
}

void SplitResponse::forward(const Vector& right, Vector& opening) {
  factor_.split()->forward(right, half_);
  const auto touched = half_.tail(static_cast<Index>(factor_.last().size()));
  if (q_.size() > 0)
    tail_.noalias() = q_ * touched;
  else
    tail_ = touched;
  if (jumps_.given())
    jumps_.spread(tail_, jump_, opening);
  else
    opening.noalias() += c_ * tail_;
}

void SplitResponse::forward_of_nothing(Index unknowns) {
  half_.setZero(unknowns);
}

void SplitResponse::backward(const Vector& z, Vector& x) {
  auto touched = half_.tail(static_cast<Index>(factor_.last().size()));
  if (q_.size() > 0)
    touched.noalias() += q_.transpose() * z;
  else
    touched += z;
  factor_.split()->backward(half_, x);
  ++counts_.back_solves;
}

namespace {

/// X z = P^T L^-T [0; Q^T z]
class SplitSpreader final : public Spreader {
 public:
  SplitSpreader(const BulkFactor& factor, const Sparse& b, LinearCounts& counts) : response_(factor, b, counts) {}
  Matrix take_factor() { return response_.take_factor(); }
  void add(double scale, const Vector& z, Vector& x) const override {
    response_.forward_of_nothing(x.size());
    response_.backward(z, solution_);
    x += scale * solution_;
  }

 private:
  mutable SplitResponse response_;  // its work space: a spread belongs to one run
  mutable Vector solution_;
};

}  // namespace

Spread split_spread(const BulkFactor& factor, const Sparse& b, LinearCounts& counts) {
  auto through = std::make_shared<SplitSpreader>(factor, b, counts);
  Matrix c = through->take_factor();
  return {.factor = std::move(c), .spread = {}, .through = std::move(through)};
}

}  // namespace uplift
