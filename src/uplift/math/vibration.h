#pragma once
#include "uplift/math/linalg.h"

namespace uplift {

/// Eigenpairs of K x = w^2 M x, ascending.
struct Vibration {
  Vector omega_squared;  // rad2/s2; exactly 0 for rigid motions
  Matrix shape;          // columns, x^T M x = 1; the largest component is positive
};

/// The lowest `count` natural vibrations of dense symmetric K (positive semidefinite) and M (positive semidefinite).
///
/// With M = W W^T (rank r) and A = K + s M the problem is (W^T A^-1 W) y = y / (w^2 + s), x = (w^2 + s) A^-1 W y: the massless
/// unknowns drop out exactly (the r x r matrix is the flexibility seen by the masses) and the lowest modes are the most accurate ones.
/// s = 0 when K is regular; else it is lowered to the first elastic w^2, so that rigid motions are told from slow ones.
/// Empty when a massless unknown has no stiffness either.
Vibration vibration(const Matrix& stiffness, const Matrix& mass, int count);

/// W with W W^T = A for a positive semidefinite matrix, as many columns as its rank (relative to its diagonal).
Matrix semidefinite_root(const Matrix& a);

}  // namespace uplift
