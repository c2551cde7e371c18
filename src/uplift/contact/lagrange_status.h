#pragma once
#include <array>
#include <vector>

#include "uplift/contact/lagrange.h"
#include "uplift/math/dense.h"

namespace uplift {

/// A point of a cone block, with friction or without.
struct FrictionPoint {
  int block = 0, components = 1;
  Index first = 0, stride = 0;             // row of component c: first + c * stride
  Index index = 0;                         // among all points of the problem, for its status
  double area = 0, friction = 0;           // the coefficient in force
  double full_friction = 0;                // the cone's
  double rho_normal = 0, rho_tangent = 0;  // N/m: 1 / F_ii
  Status status = Status::open;
  std::array<double, 2> direction{};  // of the slip
  double turning = 0;                 // N/m, 3D slip: slope of the friction force across its direction
  Index row(int component) const { return first + component * stride; }
  Index normal() const { return row(components - 1); }
  int tangents() const { return components - 1; }
};

/// The linear problem of one contact status, laws and shift linearised at the present z. E are the held rows: normal rows of closed points
/// (opening 0), tangential rows of sticking ones (opening as at the beginning of the step). A slipping point has p_t = -mu p_n d, which
/// adds to the column of its normal row:
///     H z + V^T p_E = right     C_E z = target     H = I + slopes of laws and of slip - shift of the rows that are not held
/// H is regular where closed rows hold the body; E may be redundant: p_E of least norm, sum p^2 / area, among those that balance.
class StatusStep {
 public:
  StatusStep(const InterfaceProblem&, double gap_tolerance, InterfaceSolution&);

  /// Statuses and slip directions as solution.status and solution.force (or a fresh opening) show them.
  void guess_from_solution();
  /// Closed and sticking where the free opening penetrates; everywhere when no point does.
  void guess_from_free_opening();
  /// Takes a share of the cones' friction coefficients.
  void scale_friction(double share);
  /// Moves z, opening and force to the solution for the status; false when the held rows contradict each other or H is singular.
  bool solve();
  /// Looks at the trial of every point; true when a status changed. `single`: only the first that wants to.
  bool update_status(bool single);
  /// Balance with the true law forces (which it evaluates), and friction directions, relative.
  double residual();
  void write_status();

  const std::vector<FrictionPoint>& points() const { return points_; }
  /// Statuses and slip senses, to recognise a set.
  std::vector<signed char> code() const;
  /// Normal rows of the points that changed last.
  const std::vector<std::ptrdiff_t>& changed() const { return changed_; }
  bool finite() const { return finite_; }

 private:
  struct Held {
    Index row = 0;
    double target = 0, area = 0;
    const FrictionPoint* slipping = nullptr;  // normal row of a slipping point
  };
  void list_held();
  void linearise_laws();
  void assemble(Matrix& hessian, Vector& right);
  Vector excess(const Vector& z) const;
  bool hold(const PartialLu& hessian, const Matrix& u, const Matrix& v, Vector& z, Vector& q);
  void write_forces(const Vector& p);
  std::array<double, 2> slip(const FrictionPoint&) const;
  Status trial(const FrictionPoint&, std::array<double, 2>& direction) const;

  const InterfaceProblem& problem_;
  double gap_;
  InterfaceSolution& solution_;
  std::vector<FrictionPoint> points_;
  std::vector<Held> held_;
  std::vector<int> offsets_;
  Vector slope_, linear_force_;  // law forces = linear_force_ + slope C z
  Vector field_;                 // C y, pressure that an open row would carry; empty when the held rows are independent
  double largest_force_ = 0;
  bool finite_ = true;
  std::vector<std::ptrdiff_t> changed_;
};

}  // namespace uplift
