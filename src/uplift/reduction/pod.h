#pragma once
#include <memory>
#include <utility>

#include "uplift/reduction/projection.h"

namespace uplift {

/// Work space of decompositions, which those that take turns share: new pages for every batch would cost as much as the arithmetic.
struct PodWork {
  Matrix product, part, part_product, turned;
};

/// Proper orthogonal decomposition of many displacements, batch by batch (docs/theory/reduced_models.md, R7): what is kept of them are
/// the leading left singular vectors of all that was added, orthonormal in the energy product, with their singular values.
class Pod {
 public:
  /// `beside`: orthonormal vectors that are taken out of what is added first; it must stay alive. `least`: directions with a smaller share
  /// of the largest singular value are dropped. `most`: directions that are kept.
  Pod(const EnergyProduct& product, const Matrix& beside, double least, Index most,
      std::shared_ptr<PodWork> work = std::make_shared<PodWork>())
      : product_(product), beside_(beside), least_(least), most_(most), work_(std::move(work)) {}
  /// Adds displacements, one a column, and leaves in their place what the basis and `beside` did not contain: a batch is too large to copy.
  void add(Matrix& displacements);
  const Matrix& basis() const { return basis_; }
  /// Singular values, descending: square roots of sums of energies.
  const Vector& values() const { return values_; }
  /// Of all that was added, with what `beside` takes.
  double energy() const { return energy_; }
  /// The basis leaves; nothing is kept.
  Matrix release();

 private:
  /// What x has beside the given vectors and the basis, down to a size `least`: orthonormal vectors and the coefficients of x in them.
  struct Added {
    Matrix vectors, coefficients;
  };
  /// The product of x is in the work space.
  Added beside_basis(Matrix& x, double least) const;
  /// Takes given vectors, basis and `added` out of x, of which the product is known.
  void remove(const Matrix& added, const Matrix& product, Matrix& x) const;

  const EnergyProduct& product_;
  const Matrix& beside_;
  double least_;
  Index most_;
  std::shared_ptr<PodWork> work_;
  Matrix basis_;
  Vector values_;
  double energy_ = 0;
};

}  // namespace uplift
