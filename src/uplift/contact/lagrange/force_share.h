#pragma once
#include <array>
#include <vector>

#include "uplift/contact/orthonormal.h"
#include "uplift/contact/problem.h"
#include "uplift/math/linalg.h"

namespace uplift {

/// How the closed points of cones share a force that equilibrium alone does not give them: a rigid base has a few coordinates and many
/// points. Of all forces with the resultant f = C^T p of those that a step has found, the one of least sum |p|^2 / area under
///     open     p = 0
///     slides   p_t = -mu p_n d, p_n <= 0      d: direction of its slip
///     sticks   |p_t| <= -mu p_n, p_n <= 0: also where the slip is within what a method that holds a point leaves of it
/// It is unique. Its dual has as few unknowns as the base has coordinates:
///     p_i = area_i P_i(C_i y)      minimise sum area_i |P_i(C_i y)|^2 / 2 - f . y
/// with the projection P_i on the set of point i; the gradient is C^T p - f, piecewise smooth, and monotone: Newton's method with a
/// generalised Hessian (L. Qi & J. Sun, Math. Program. 58, 1993, 353-367) and a line search (math/line_search.h).
class ForceShare {
 public:
  /// Shares the force of the cones in `solution`, whose opening and resultant stay. `gap` [m]: opening up to which a point is closed, and
  /// what a point that sticks may be off. False, and the force stays, where many rows can be independent (PointRows), where those of the
  /// closed points are, where no such force is found (a resultant beyond what the closed points can bear), or where the contact residual
  /// would be above 1e-8 + 4 gap / max|opening - free opening| and above that of the force found.
  bool solve(const InterfaceProblem&, double gap, InterfaceSolution&);
  /// The contact residual, the last time that the force was shared.
  double residual() const { return residual_; }
  /// Of Newton's method, the last time.
  int iterations() const { return iterations_; }

 private:
  /// A closed point. Its rows times the root of its area are rows of given_; a slide has one, in the direction of its force.
  struct Point {
    Index first = 0, stride = 0;  // row of component c: first + c * stride
    Index column = 0;             // of rows_
    int components = 1;
    bool slides = false;
    double root = 0, friction = 0;
    std::array<double, 3> ray{};      // of a slide: force per unit of its column, of length one
    std::array<double, 3> force{};    // per root of area
    std::array<double, 3> pressed{};  // C_i y, per root of area
  };

  void size(Index rows, Index r);
  void list(const InterfaceProblem&, double gap, const InterfaceSolution&);
  void add_slide(const InterfaceProblem&, const InterfaceSolution&, Point&);
  void add_given(Index row, double factor, const Matrix& factors);
  bool find_resultant();
  bool is_good(const InterfaceProblem&, double gap, InterfaceSolution&);
  double evaluate(const Vector& dual);
  void fill_hessian(double share);
  void add_outer(double weight, const double* column);
  bool find_step();
  bool newton();

  std::vector<Point> points_;
  Index columns_ = 0, rank_ = 0;  // rows of given_ and columns of rows_ in use; rows of rows_ in use
  Matrix given_;                  // columns x r
  Orthonormal range_;             // of given_, in whose coordinates the Hessian of points that all bear is the identity
  Matrix rows_, hessian_;         // rank x columns; rank x rank, then its factor: in the upper left corner
  Vector found_, more_, kept_;    // columns: the forces on entry, per root of area; work; rows [N]
  Vector rest_, pull_;            // r: resultant of what found_ does not contain; of all
  Vector resultant_, dual_, step_, tried_, gradient_, column_;  // rank, in the first places
  ResidualScratch scratch_;
  double residual_ = 0;
  int iterations_ = 0;
};

}  // namespace uplift
