#pragma once
#include "uplift/math/linalg.h"

namespace uplift {

/// A = U diag(s) V^T: s descending, small values to the precision of the largest; U has as many columns as there are values.
class SingularValues {
 public:
  explicit SingularValues(const Matrix& a);
  const Vector& values() const { return values_; }
  const Matrix& left() const { return left_; }

 private:
  Vector values_;
  Matrix left_;
};

}  // namespace uplift
