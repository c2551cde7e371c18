#include "uplift/contact/compliance.h"

#include <cassert>
#include <vector>

#include "uplift/math/dense.h"

namespace uplift {

namespace {

struct RankFactors {
  Matrix w;  // rows x r
  Matrix v;  // touched unknowns x r
};

/// Clearly regular: no pivot of the Gram matrix, scaled to a unit diagonal, is small.
bool independent(Matrix gram) {
  const Vector scale = gram.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return false;
  gram = (scale.asDiagonal() * gram * scale.asDiagonal()).eval();
  const Cholesky cholesky(gram);
  return cholesky.info() == Success && cholesky.matrixLLT().diagonal().minCoeff() > 1e-4;
}

/// B = W V^T. The two common cases are tried first; else a QR decides about the rank, on columns scaled to length one, so that units play
/// no part.
RankFactors rank_factors(const Matrix& b) {
  const Index rows = b.rows(), columns = b.cols();
  const RankFactors by_columns{b, Matrix::Identity(columns, columns)}, by_rows{Matrix::Identity(rows, rows), b.transpose()};
  const Sparse sparse = b.sparseView();
  if (columns <= rows ? independent(Sparse(sparse.transpose() * sparse)) : independent(Sparse(sparse * sparse.transpose())))
    return columns <= rows ? by_columns : by_rows;
  const Vector scale = b.colwise().norm().cwiseInverse();
  const PivotedQr qr(b * scale.asDiagonal());
  const double largest = qr.maxPivot();
  Index rank = 0;
  while (rank < std::min(rows, columns) && std::abs(qr.matrixR()(rank, rank)) > 1e-11 * largest) ++rank;
  if (rank == columns) return by_columns;
  if (rank == rows) return by_rows;
  Matrix q = Matrix::Identity(rows, rank);
  q.applyOnTheLeft(qr.householderQ());
  Matrix r = qr.matrixR().topRows(rank).triangularView<upper_triangle>();
  r = (r * qr.colsPermutation().transpose()).eval();
  return {q, scale.cwiseInverse().asDiagonal() * r.transpose()};
}

}  // namespace

Spread spread_through(const Factor& a, const Sparse& b) {
  std::vector<Index> touched;
  for (Index j = 0; j < b.cols(); ++j)
    for (Sparse::InnerIterator entry(b, j); entry; ++entry)
      if (entry.value() != 0) {
        touched.push_back(j);
        break;
      }
  Matrix dense(b.rows(), static_cast<Index>(touched.size()));
  for (Index k = 0; k < dense.cols(); ++k) dense.col(k) = b.col(touched[k]);
  if (dense.size() == 0) return {Matrix(b.rows(), 0), Matrix(b.cols(), 0)};

  const RankFactors parts = rank_factors(dense);
  const Index rank = parts.w.cols();
  Matrix unit = Matrix::Zero(b.cols(), rank);
  for (Index k = 0; k < dense.cols(); ++k) unit.row(touched[k]) = parts.v.row(k);
  Matrix answer;
  a.solve(unit, answer);
  Matrix at_touched(dense.cols(), rank);
  for (Index k = 0; k < dense.cols(); ++k) at_touched.row(k) = answer.row(touched[k]);
  Matrix flexibility = parts.v.transpose() * at_touched;
  flexibility = ((flexibility + flexibility.transpose()) / 2).eval();
  const Cholesky cholesky(flexibility);
  assert(cholesky.info() == Success);  // A is positive definite and V has full rank
  Spread result;
  result.factor = parts.w * cholesky.matrixL();
  result.spread = cholesky.matrixU().solve<OnTheRight>(answer);
  return result;
}

}  // namespace uplift
