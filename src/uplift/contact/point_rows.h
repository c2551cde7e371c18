#pragma once
#include <array>
#include <vector>

#include "uplift/contact/problem.h"
#include "uplift/math/partial_lu.h"

namespace uplift {

/// How force P [N] and opening g [m] of one point depend on each other, linearised. The force has `count` unknowns q and as many equations:
///     P_c = known_c + sum over f of basis_fc q_f          sum over c of (opening_fc g_c - force_fc P_c) = right_f
/// Equations are scaled so that their residual is a force.
struct PointRelation {
  using Local = std::array<double, most_components>;
  int count = 0;
  int kind = 0;  // equal kinds have the same unknowns
  Local known{}, right{};
  std::array<Local, most_components> basis{}, opening{}, force{};
};

/// The linear problem of an interface with many independent rows, as between meshes: opening = free opening - F P with F = C C^T regular,
/// and a relation between the two at every point. Only forces that depend on the opening are unknown: an open point has none, a slipping
/// one two of three. Methods bring the relations (Newton: the slopes of the laws; Lagrange: the contact status).
///
/// By generalised conjugate residuals (Eisenstat, Elman & Schultz, SIAM J. Numer. Anal. 20, 1983), which need products with F only, or by a
/// factor of the matrix, as the problem says:
///  - automatic  the last factor preconditions the iteration while no point changes its kind; when one does, the matrix is factored anew,
///               from `enough_to_iterate` unknowns on only where the iteration without a factor does not arrive
///  - direct     the matrix is factored every time
///  - krylov     the iteration without a factor; where it does not arrive, the matrix is factored
class PointRows {
 public:
  /// From so many rows on, when they can be independent, methods use this class.
  static constexpr Index many = 12;
  /// Unknown forces from which products with F are cheaper than a factor (docs/performance.md).
  static constexpr Index enough_to_iterate = 300;
  static bool suits(const ContactModel& model) { return model.rows() > many && model.rows() <= model.factor.cols(); }

  /// Takes up a problem; what belongs to its model is kept from the one before as long as that is the same.
  void begin(const InterfaceProblem&);
  /// F_ii [m/N].
  double compliance(Index row) const { return compliance_(row, row); }
  /// Relation of point i, all blocks one after another, to be filled before `solve`.
  PointRelation& relation(Index point) { return relations_[static_cast<std::size_t>(point)]; }
  /// Relations of the points of a block from forces p [N] and slopes k [N/m] (all as in NewtonWork::slope) at an opening, the shift
  /// D of statics taken back: P + D g - k g = p - k opening.
  void linearise(std::size_t block, const double* slope, const Vector& force, const Vector& opening);
  /// Forces P (rows), opening g (rows) and z = -C^T P; false when the matrix is singular or the residual does not fall to round-off.
  bool solve(Vector& forces, Vector& opening, Vector& z, InterfaceSystems& counts);

 private:
  struct Place {  // of a point
    Index first = 0, stride = 0, unknown = 0;
    int components = 1, kind = -1;
    Index row(int component) const { return first + component * stride; }
  };
  void list_unknowns();
  bool same_kinds() const;
  bool factorise();
  void put_forces(const Vector& unknowns, bool with_known, Vector& forces) const;
  void spread(const Vector& forces, Vector& opening) const;
  double start(Vector& forces, Vector& opening);
  void apply(const Vector& moved, const Vector& forces, Vector& result) const;
  bool iterate(int most, double size, Vector& forces, Vector& opening);
  bool iterate_alone(double& size, Vector& forces, Vector& opening);
  bool factor_and_correct(double size, Vector& forces, Vector& opening);

  const InterfaceProblem* problem_ = nullptr;
  SeenModel seen_;
  bool valid_ = false;
  Index unknowns_ = 0;
  Matrix compliance_;
  LuInPlace matrix_;
  std::vector<Place> places_;
  std::vector<std::size_t> first_point_;  // of a block
  std::vector<PointRelation> relations_;
  Vector residual_, direction_, image_, unknown_, change_, moved_, column_;
  Matrix directions_, images_;  // of the iteration
  double rest_ = 0;             // largest residual [N]
};

}  // namespace uplift
