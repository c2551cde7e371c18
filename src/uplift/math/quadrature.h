#pragma once
#include "uplift/math/linalg.h"

namespace uplift {

/// A rule on [-1, 1]: sum of weight * f(point). The weights add up to 2.
struct Quadrature {
  Vector point, weight;
};

/// Gauss-Legendre with n >= 1 points, exact for polynomials of degree 2n - 1. Points in ascending order, to round-off
/// (Newton's method on the Legendre polynomial; Press et al., Numerical Recipes, section 4.6).
Quadrature gauss_legendre(int n);
/// Gauss-Lobatto with n >= 2 points, the ends included, exact for degree 2n - 3. For n = 2, 3 it is the trapezoidal and Simpson's rule,
/// whose points are the nodes of a 2- or 3-node line.
Quadrature gauss_lobatto(int n);
/// Composite trapezoidal rule with n >= 2 equidistant points, ends with half weight.
Quadrature trapezoid(int n);
/// Composite midpoint rule with n >= 1 equal cells.
Quadrature midpoint(int n);

}  // namespace uplift
