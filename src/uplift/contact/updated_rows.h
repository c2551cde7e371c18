#pragma once
#include <vector>

#include "uplift/math/dense.h"

namespace uplift {

/// A square matrix A of order n, of which few rows change from one solve to the next: A = A0 + E D, A0 factored once, D the changes of the
/// rows E (Sherman, Morrison & Woodbury; Hager, SIAM Review 31, 1989):
///     A^-1 b = y - X (I + D X)^-1 D y        y = A0^-1 b, X = A0^-1 E
/// A new factor costs 2 n^3/3 operations, a row that changes 2 n^2 once (its column of X is kept), a solve 2 n^2.
/// Included by sources only.
class UpdatedRows {
 public:
  void size(Index n);
  /// A0 transposed: column i holds row i. To be filled before `factorise`.
  Matrix& base() { return base_; }
  /// False when A0 is singular.
  bool factorise();
  /// So many rows may change before a new factor is cheaper.
  Index most() const { return most_; }
  /// Forgets the changes.
  void restore() { changed_.clear(); }
  /// Room for the n entries of a new row i.
  double* change(Index i);
  /// After the last change; false when A is singular.
  bool prepare();
  /// A x = b, in place.
  void solve(Vector& x);
  /// A^T x = b, in place.
  void solve_transposed(Vector& x);

 private:
  void find_columns();
  template <class Columns>
  void solve_base(Columns&& x);

  Index n_ = -1, most_ = 0, used_ = 0;
  Matrix base_, columns_, gathered_, delta_, small_;  // X of all rows that changed since the factor, X of this set, D^T, I + D X
  PartialLu lu_, small_lu_;
  std::vector<Index> changed_, column_of_, row_of_;
  Vector work_, part_, answer_;
};

}  // namespace uplift
