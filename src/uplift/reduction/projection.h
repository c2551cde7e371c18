#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "uplift/math/symmetric_product.h"
#include "uplift/model/model.h"

namespace uplift {

/// Makes a reduced model of a model: its free unknowns q become basis * q (free unknowns x coordinates), and everything that stands on them
/// is projected symmetrically (Galerkin, docs/theory/reduced_models.md, R2): K, M, C, loads, rows of the interfaces, displacements of the
/// nodes. Laws, gaps and prescribed motions stay as they are. `shown`: the full unknowns whose displacements are wanted, ascending; the
/// model has none of the others, as if they were held. Null: all.
void project(Model& model, const Matrix& basis, const std::vector<int>* shown = nullptr);

/// The same with the modes of the reduced model as coordinates: turns the basis so that K and M become diagonal, and C with Rayleigh
/// damping alone, and projects. A step then multiplies with vectors instead of full matrices. `w` [rad/s]: a frequency that makes K + w^2 M
/// positive definite. A mass that is singular in the basis leaves the basis as it is, and full matrices.
void project_on_modes(Model& model, double w, Matrix& basis, const std::vector<int>* shown = nullptr);

/// The part of project() that belongs to the loads: matrices, constraints and rows of the interfaces are projected already.
void project_loads(Model& model, const Matrix& basis);

/// V^T A V of a symmetric matrix, symmetric to the last bit.
Matrix symmetric_projection(const Sparse& a, const Matrix& v);

/// The inner product x^T (K + w^2 M) y of displacements, an energy.
class EnergyProduct {
 public:
  EnergyProduct(const Sparse& stiffness, const Sparse& mass, double w) : matrix_(stiffness + (w * w) * mass) {}
  Matrix times(const Matrix& x) const {
    Matrix product;
    times(x, product);
    return product;
  }
  void times(const Matrix& x, Matrix& product) const {
    product.setZero(x.rows(), x.cols());
    add_symmetric_product(1, matrix_, x, product);
  }
  double norm(const Vector& x) const { return std::sqrt(std::max(0.0, x.dot(matrix_ * x))); }

 private:
  Sparse matrix_;
};

/// Adds to an orthonormal basis what is left of a vector beside it, where that is more than `least` of its norm.
void append(const EnergyProduct& product, const Vector& x, double least, Matrix& basis);

/// Makes vectors orthonormal, beside an orthonormal basis too; those of which no more than `least` of their norm is left are dropped.
/// Returns the number of those that stay.
Index orthonormalise(const EnergyProduct& product, const Eigen::Ref<const Matrix>& basis, double least, Matrix& vectors);

}  // namespace uplift
