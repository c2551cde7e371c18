#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "uplift/contact/orthonormal.h"
#include "uplift/contact/problem.h"
#include "uplift/math/dense.h"

namespace uplift {

class PointRows;
struct PointRelation;

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
/// H is regular where closed rows hold the body; E may be redundant: p_E of least norm, sum p^2 / area, among those that balance. With N
/// an orthonormal basis of the range of V^T only the resultant V^T p_E = N s is known: (C_E H^-1 N) s = excess, in the sense of least
/// squares, then the shortest p_E.
class StatusStep {
 public:
  StatusStep();
  ~StatusStep();
  /// Takes up a problem; keeps the work space of the one before.
  void begin(const InterfaceProblem&, double gap_tolerance, InterfaceSolution&);

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
  /// Hash of statuses and slip senses, to recognise a set.
  std::uint64_t code() const;
  /// Normal rows of the points that changed last.
  const std::vector<std::ptrdiff_t>& changed() const { return changed_; }
  bool finite() const { return finite_; }
  /// m: a point is closed up to this opening.
  double gap() const { return gap_; }

 private:
  struct Held {
    Index row = 0;
    double target = 0, area = 0;
    const FrictionPoint* slipping = nullptr;  // normal row of a slipping point
  };
  bool solve_by_rows();
  void relate(const FrictionPoint&, PointRelation&) const;
  void size_work();
  void list_points();
  void list_held();
  void linearise_laws();
  void turn_slip();
  bool assemble();
  void list_held_rows();
  bool hold();
  void measure_excess();
  void open_at(const Vector& z);
  void write_forces();
  std::array<double, 2> slip(const FrictionPoint&) const;
  Status trial(const FrictionPoint&, std::array<double, 2>& direction) const;

  const InterfaceProblem* problem_ = nullptr;
  InterfaceSolution* solution_ = nullptr;
  double gap_ = 0;
  std::vector<FrictionPoint> points_;
  std::vector<Held> held_;
  std::vector<int> offsets_;
  Vector motion_;                // C z [m]
  Vector slope_, linear_force_;  // law forces = linear_force_ + slope C z
  double largest_force_ = 0;
  bool finite_ = true;
  std::vector<std::ptrdiff_t> changed_;
  std::unique_ptr<PointRows> rows_;  // many independent rows
  // of the linear problem
  bool plain_ = true;  // H is the identity
  Matrix hessian_, work_;
  PartialLu lu_;
  Matrix u_, v_;                         // r x rows: U^T and V^T, each held row times the root of its area
  Orthonormal range_, image_, reduced_;  // of V^T; of V on that range; of U H^-1 on that range
  Matrix inverse_, product_;             // H^-1 N; V N or U H^-1 N
  Vector right_, z_, q_, excess_, more_, resultant_, moved_, taken_, known_, force_, reaction_;
};

}  // namespace uplift
