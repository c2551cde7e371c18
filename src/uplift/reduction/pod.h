#pragma once
#include "uplift/reduction/projection.h"

namespace uplift {

/// Proper orthogonal decomposition of many displacements, batch by batch (docs/theory/reduced_models.md, R7): what is kept of them are
/// the leading left singular vectors of all that was added, orthonormal in the energy product, with their singular values.
class Pod {
 public:
  /// `unknowns`: rows of what is added. `least`: directions with a smaller share of the largest singular value are dropped.
  Pod(const EnergyProduct& product, Index unknowns, double least, Index most)
      : product_(product), least_(least), most_(most), basis_(unknowns, 0), values_(0) {}
  /// Adds displacements, one a column.
  void add(const Matrix& displacements);
  const Matrix& basis() const { return basis_; }
  /// Singular values, descending: square roots of sums of energies.
  const Vector& values() const { return values_; }

 private:
  const EnergyProduct& product_;
  double least_;
  Index most_;
  Matrix basis_;
  Vector values_;
};

}  // namespace uplift
