#pragma once
#include <array>
#include <vector>

#include "uplift/contact/lagrange_status.h"
#include "uplift/contact/updated_rows.h"

// The linear problem of one contact status for interfaces with many independent rows (F = C C^T regular, as between meshes), in the forces
// P = p - D opening on all rows, opening = free opening - F P, z = -C^T P. Every row has one equation:
//     closed, normal      F_n P / F_nn = free_n / F_nn
//     sticks              F_t P / F_tt = (free_t - from_t) / F_tt
//     open, frictionless  P + D opening = 0
//     slips               P_t + mu d_t P_n + D_t opening_t - s ((I - d d^T) slip)_t = 0
//     law                 P - p_0 - k (opening - opening_0) + D opening = 0
// A point that changes its status changes its own equations only: the factor of an earlier status goes on serving (updated_rows.h), across
// steps too. Slip directions and law slopes that moved a little are left in the matrix; the residual is that of the present ones.
namespace uplift {

class StatusRows final {
 public:
  /// What the equations need beside the problem.
  struct System {
    const InterfaceProblem& problem;
    const std::vector<FrictionPoint>& points;
    const std::vector<int>& offsets;  // of the slopes of law blocks
    const Vector& slope;
    const Vector& linear_force;  // p_0 - k C z
  };
  /// z and P; false when the matrix is singular or the solution does not settle.
  bool solve(const System&, Vector& z, Vector& forces);

 private:
  using Signature = std::array<double, 9>;
  struct Place {  // of a point
    Index first = 0, stride = 0;
    int components = 1;
    bool law = false;
  };
  void prepare(const InterfaceProblem&);
  void describe(const System&);
  bool factorise(const System&);
  bool update(const System&);
  bool iterate(const System&, Vector& z, Vector& forces);
  void fill_row(const System&, std::size_t point, int component, double* row) const;
  double fill_residual(const System&, const Vector& forces);
  static bool same(const Signature& a, const Signature& b, bool law);

  const double* seen_ = nullptr;  // the factor that F belongs to, and its mark
  double mark_ = 0;
  bool valid_ = false;
  Matrix compliance_;
  UpdatedRows matrix_;
  std::vector<Place> places_;
  std::vector<Signature> now_, base_;
  std::vector<std::size_t> list_;
  Vector right_, opening_;
};

}  // namespace uplift
