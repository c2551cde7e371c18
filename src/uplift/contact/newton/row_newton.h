#pragma once
#include <vector>

#include "uplift/contact/newton/newton.h"
#include "uplift/math/partial_lu.h"

namespace uplift {

/// Newton's method for laws on some hundred independent rows, in the openings g and the forces P of the rows instead of the coordinates z:
///     g = free opening - F P        s = p(g) - P, zero at the solution        F = C C^T
///     (I + F k) dg = -F s        dP = s + k dg
/// With the slopes k0 of a reference, its compliance F0 = (I + F k0)^-1 F, and q = (k - k0) dg,
///     (I + (k - k0) F0) q = -(k - k0) F0 s        dg = -F0 (s + q)        dP = s + q + k0 dg
/// The matrix has only the rows whose force has other slopes than in the reference (none: k0 = 0, F0 = F): of a point that slides the
/// tangential ones, of one that stays as it was none. A reference is made when the last factors would have been cheaper with it by as much
/// as it costs. The factor is kept, over iterations and steps, while no slope has left that of the factor by much: the iteration is then
/// that of a chord. It begins where the points come to when they move on as in the last step.
///
/// s, too, has only entries where a law bends on its way; those that cannot matter are taken as zero, so that a product with F0 costs as
/// many columns as there are others. The openings follow from dg, whose round-off is that of F0; where the iteration has arrived they are
/// made anew from the forces. Whether they solve the problem is judged as by Newton's method in z, |C^T s| against the largest of |z| and
/// |C^T p|, or, where that suffices, by bounds that need no product with C and are never less strict (is_solution). It is no method of its
/// own: where it does not arrive soon, the general method starts anew.
class RowNewton final : public MethodWork {
 public:
  /// Beyond so many rows iterations of Krylov's kind are faster than factors (PointRows).
  static constexpr Index most_rows = 500;
  static bool suits(const ContactModel&);

  struct Result {
    bool arrived = false;    // the guess of the general method is better than it was
    bool converged = false;  // and it needs none
    int iterations = 0;
    double residual = 0;
  };
  /// Solves from the guess in solution.z, or from the last step. Leaves z, forces and slopes at the solution; the guess in its place where
  /// it does not arrive. Where forces suffice (ContactModel) they are the guess as well, and a solution has no z.
  Result solve(const InterfaceProblem&, double tolerance, NewtonWork&, InterfaceSolution&);
  /// Order of the matrix that was factorised last.
  Index order() const { return static_cast<Index>(rows_.size()); }

 private:
  void begin(const InterfaceProblem&);
  void guess(NewtonWork&, InterfaceSolution&);
  double change_of_slopes(const Vector& slopes) const;
  void rows_apart(const Vector& slopes, const Vector& from, std::vector<Index>& rows);
  bool own_changes(const std::vector<Index>& rows);
  void fill(const Matrix& compliance, const std::vector<Index>& rows);
  bool look_for_reference(const Vector& slopes, double paid);
  void refer_to(const Vector& slopes);
  void choose_rows(const Vector& slopes);
  bool factorise(const Vector& slopes);
  void slope_product(const Vector& slopes, const double* moved, double* force) const;
  bool direction(const Vector& slopes, InterfaceSystems& counts);
  void look(double alpha, NewtonWork&, InterfaceSolution&);
  void measure();
  void shorten(double before, NewtonWork&, InterfaceSolution&);
  void look_at_forces(NewtonWork&, InterfaceSolution&);
  void opening_of(const Vector& force, Vector& opening);
  void coordinates_of(const Vector& force, Vector& z);
  bool iterate(double tolerance, NewtonWork&, InterfaceSolution&, Result&);
  bool is_solution(double tolerance, NewtonWork&, InterfaceSolution&, Result&);

  const InterfaceProblem* problem_ = nullptr;
  SeenModel seen_;
  Matrix compliance_;  // F; its columns and those of F0 fill whole registers
  LuInPlace lu_;
  std::vector<Index> rows_, other_rows_;  // of the factor, ascending
  std::vector<Index> bent_;               // rows where s is not zero
  Vector slopes_, change_;                // of the factor, as in NewtonWork; less those of the reference where it is one of its changes
  bool valid_ = false, slow_ = false, follows_ = false;
  bool opens_anew_ = false;              // the openings of the next look follow from the forces, not from the direction
  Matrix reference_compliance_;          // F0
  Vector none_, reference_, candidate_;  // slopes: 0, k0, those of the next reference
  bool has_reference_ = false, from_reference_ = false;
  double spared_ = 0;                              // by the candidate, had it been the reference; cubes of rows
  int candidate_age_ = 0, updates_ = 0;            // updates: of the reference, one from the other
  Matrix chosen_, images_;                         // work space of refer_to: columns and rows of F0
  Vector force_, opening_, rest_, moved_;          // P, g, s, F0 s and then -dg
  Vector share_;                                   // sqrt(F_ii)
  Vector flexible_;                                // largest F_ii of a point, at its first row
  Index largest_ = 0;                              // of the coordinates z, when they were last known
  Vector product_, apart_;                         // work space: k dg; of rows_apart
  Vector origin_force_, origin_opening_, kept_;    // where a line search begins; the guess
  Vector opening_step_, force_step_, part_, sum_;  // dg, dP; k dg
  Vector from_, end_;                              // the last step
  double aim_ = 0, size_ = 0;  // root of the sum of F_ii s_i^2 [sqrt(J)], an estimate of |C^T s|: wanted, now; is_solution() judges
};

/// By RowNewton where that suits the problem, from the work space of Newton's method.
RowNewton::Result solve_by_rows(const InterfaceProblem&, const NewtonOptions&, NewtonWork&, InterfaceSolution&);

}  // namespace uplift
