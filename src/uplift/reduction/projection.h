#pragma once
#include <algorithm>
#include <cmath>

#include "uplift/model/model.h"

namespace uplift {

/// Makes a reduced model of a model: its free unknowns q become basis * q (free unknowns x coordinates), and everything that stands on them
/// is projected symmetrically (Galerkin, docs/theory/reduced_models.md, R2): K, M, C, loads, rows of the interfaces, displacements of the
/// nodes. Laws, gaps and prescribed motions stay as they are.
void project(Model& model, const Matrix& basis);

/// The inner product x^T (K + w^2 M) y of displacements, an energy.
class EnergyProduct {
 public:
  EnergyProduct(const Sparse& stiffness, const Sparse& mass, double w) : matrix_(stiffness + (w * w) * mass) {}
  Matrix times(const Matrix& x) const { return matrix_ * x; }
  double norm(const Vector& x) const { return std::sqrt(std::max(0.0, x.dot(matrix_ * x))); }

 private:
  Sparse matrix_;
};

/// Adds to an orthonormal basis what is left of a vector beside it, where that is more than `least` of its norm.
void append(const EnergyProduct& product, const Vector& x, double least, Matrix& basis);

}  // namespace uplift
