#pragma once
#include <array>
#include <span>

#include "uplift/math/linalg.h"
#include "uplift/mesh/cells.h"

namespace uplift {

inline constexpr std::size_t max_corners = 8;

/// Lines, triangles and tets.
bool is_simplex(Cell cell);
/// Length, area or volume of a cell over that of its reference cell, from the columns dx/dr_k of the Jacobian.
double cell_measure(int dimension, const std::array<Vec3, 3>& tangent);

/// A linear cell at its place, and its mapping from the reference cell: what all of its parts have in common.
class PlacedCell {
 public:
  PlacedCell(Cell cell, std::span<const Vec3> corners);
  Cell type() const { return type_; }
  std::span<const Vec3> corners() const { return {corners_.data(), count_}; }
  /// The Jacobian is the same everywhere.
  bool parallel() const { return parallel_; }
  /// Place of the centre [m], and dx/dr_k there [m per unit of r_k].
  const Vec3& centre() const { return centre_; }
  const Vec3& tangent(int k) const { return tangent_[static_cast<std::size_t>(k)]; }
  /// m: the largest distance of a corner from the first one.
  double size() const { return size_; }
  /// Local coordinates of a place: without iterations where the sides are parallel, else by Newton's method.
  Vec3 local(const Vec3& place) const;
  Vec3 place(const Vec3& local) const;
  /// Shape functions at local coordinates, without their slopes; 0 beyond the corners.
  std::array<double, max_corners> shares(const Vec3& local) const;
  /// Length, area or volume of the cell over that of the reference cell.
  double measure(const Vec3& local) const;
  /// Local coordinates of many places, and the measures there.
  void find(std::span<const Vec3> places, std::span<Vec3> local, std::span<double> measure) const;

 private:
  void find_in_warped(std::span<const Vec3> places, std::span<Vec3> local, std::span<double> measure) const;

  Cell type_;
  std::size_t count_;
  std::array<Vec3, max_corners> corners_;
  Vec3 middle_, centre_;
  std::array<Vec3, 3> tangent_, dual_;  // dual_: 1/m, gradients of the local coordinates in the middle
  double measure_ = 0, size_ = 0;       // measure_: in the middle
  bool parallel_ = false;
};

/// Local coordinates of a place in a linear cell, by Newton's method.
Vec3 local_coordinates(Cell cell, std::span<const Vec3> corners, const Vec3& place);

}  // namespace uplift
