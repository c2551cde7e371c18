#include "uplift/contact/compliance.h"

#include <cassert>
#include <vector>

#include "uplift/math/dense.h"
#include "uplift/math/small.h"

namespace uplift {

namespace {

struct RankFactors {
  Matrix w;  // rows x r; empty: the identity
  Sparse v;  // touched unknowns x r
};

/// a^T b; by full matrices where few entries of a are zero, as in a reduced model.
Matrix transposed_product(const Sparse& a, const Matrix& b) {
  if (a.nonZeros() > a.size() / 2) return Matrix(a).transpose() * b;
  return a.transpose() * b;
}

/// a^T a
Matrix gram(const Sparse& a) {
  if (a.nonZeros() > a.size() / 2) return transposed_product(a, Matrix(a));
  return Sparse(a.transpose() * a);
}

/// Clearly regular: no pivot of the Gram matrix, scaled to a unit diagonal, is small.
bool independent(Matrix gram) {
  const Vector scale = gram.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return false;
  gram = (scale.asDiagonal() * gram * scale.asDiagonal()).eval();
  const Cholesky cholesky(gram);
  return cholesky->info() == Success && cholesky->matrixLLT().diagonal().minCoeff() > 1e-4;
}

/// B = W V^T. The two common cases are tried first; else a QR decides about the rank, on columns scaled to length one, so that units play
/// no part; those of round-off, which walls with computed normals have, count as zero.
RankFactors rank_factors(const Sparse& b) {
  const Index rows = b.rows(), columns = b.cols();
  Sparse identity(columns, columns);
  identity.setIdentity();
  if (columns <= rows && independent(gram(b))) return {Matrix(b), identity};
  if (columns > rows && independent(gram(b.transpose()))) return {Matrix(), b.transpose()};
  const Matrix dense = b;
  constexpr double nothing = 1e-15;
  Vector size = dense.colwise().norm();
  size = (size.array() > nothing * size.maxCoeff()).select(size, 0).eval();
  const PivotedQr qr(dense * (size.array() > 0).select(size.cwiseInverse(), 0).matrix().asDiagonal());
  const double largest = qr->maxPivot();
  Index rank = 0;
  while (rank < std::min(rows, columns) && std::abs(qr->matrixR()(rank, rank)) > 1e-11 * largest) ++rank;
  if (rank == columns) return {dense, identity};
  if (rank == rows) return {Matrix(), b.transpose()};
  Matrix r = qr->matrixR().topRows(rank).triangularView<upper_triangle>();
  r = (r * qr->colsPermutation().transpose()).eval();
  return {columns_of_q(qr, rank), Matrix(size.asDiagonal() * r.transpose()).sparseView()};
}

/// The unknowns that B touches, as columns of an identity.
Sparse touched_unknowns(const Sparse& b) {
  std::vector<Triplet> entries;
  for (Index j = 0; j < b.cols(); ++j)
    for (Sparse::InnerIterator entry(b, j); entry; ++entry)
      if (entry.value() != 0) {
        entries.emplace_back(j, static_cast<Index>(entries.size()), 1.0);
        break;
      }
  Sparse select(b.cols(), static_cast<Index>(entries.size()));
  select.setFromTriplets(entries.begin(), entries.end());
  return select;
}

}  // namespace

void Spread::add(double scale, const Vector& z, Vector& x) const {
  if (through != nullptr) {
    through->add(scale, z, x);
    return;
  }
  small::affine(spread, x.data(), z.data(), x.data(), scale);
}

Spread spread_through(const Factor& a, const Sparse& b) {
  const Sparse touched = touched_unknowns(b);
  if (b.rows() == 0 || touched.cols() == 0) return {Matrix(b.rows(), 0), Matrix(b.cols(), 0)};
  const RankFactors parts = rank_factors(b * touched);
  const Sparse right = touched * parts.v;  // A^-1 V, all columns at once
  Matrix answer;
  a.solve(Matrix(right), answer);
  Matrix flexibility = transposed_product(right, answer);
  flexibility = ((flexibility + flexibility.transpose()) / 2).eval();
  const Cholesky cholesky(flexibility);
  assert(cholesky->info() == Success);  // A is positive definite and V has full rank
  Spread result;
  if (parts.w.size() > 0)
    result.factor = parts.w * Matrix(cholesky->matrixL());
  else
    result.factor = cholesky->matrixL();
  result.spread = divided_by_upper(cholesky, answer);
  return result;
}

}  // namespace uplift
