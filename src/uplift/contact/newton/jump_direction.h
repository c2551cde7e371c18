#pragma once
#include <vector>

#include "uplift/contact/newton/newton.h"
#include "uplift/math/dense.h"

namespace uplift {

/// Newton's direction where C = W L (JumpFactor), in the increments w = L d of the jumps:
///     (A + S) w = -L^-T G        A = (L L^T)^-1        S = W^T (k - D) W        d = L^-1 w
/// S is summed over the points, each of which feels the jumps of its cell alone. The factor of A + S is kept: while the slopes k of some
/// points alone differ from those of the factor, generalised conjugate residuals (as in PointRows) find w with products of the difference
/// at these points, (A + S) K^-1 r = r + (S - S_K) K^-1 r. Where they need more than `enough` iterations, the matrix is factored anew.
class JumpDirection {
 public:
  /// Writes the direction; false, with nothing of use written, where the matrix has no accurate factor.
  bool solve(const InterfaceProblem&, NewtonWork&, InterfaceSystems&);

 private:
  struct Place {                             // of a point
    Index first = 0, stride = 0, slope = 0;  // first row, between rows; first slope, those of (a, c) (a * components + c) * stride on
    int components = 1;
  };
  struct Change {  // of the slopes of a point [N/m]
    const Place* place = nullptr;
    double slope[most_components * most_components] = {};
  };
  void begin(const ContactModel&);
  double slope(const Vector& slopes, const Place&, int a, int c) const;
  void list_changes(const Vector& slopes, bool all);
  void sum();
  void factorise(const Vector& slopes);
  void divide(const Vector& right, Vector& solution) const;
  void add_changes(const Vector& moved, Vector& result) const;
  double size(const Vector&) const;
  bool iterate(int most);
  bool solve_anew(const Vector& slopes);

  const ContactModel* model_ = nullptr;
  SeenModel seen_;
  std::vector<Place> places_;
  std::vector<Change> changes_;
  Vector slopes_;              // of the factor, as in NewtonWork
  Matrix stiffness_, matrix_;  // A, A + S [N/m]
  Cholesky cholesky_;
  PartialLu lu_;
  bool valid_ = false, symmetric_ = true;  // the factor: is that of slopes_; is Cholesky's
  Matrix directions_, images_;
  Vector right_, rest_, solution_, direction_, image_;
  Vector weight_;  // of squares of forces, one over the diagonal of the matrix [m/N]
};

}  // namespace uplift
