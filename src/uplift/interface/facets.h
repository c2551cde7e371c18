#pragma once
#include "uplift/interface/face_joint.h"

namespace uplift {

/// The surface of an interface in straight pieces between its points: lines in the plane, triangles in space. What varies linearly between
/// the points is cut on them where it changes its sign, so that shares of the area have an error of order 2 in the distance of the points
/// (docs/theory/README.md, section 1). Quadrilaterals count both ways to halve them. Node pairs on their own have no surface: no pieces.
struct Facets {
  using Corner = std::vector<std::pair<int, double>>;  // sum of weight * value of these points
  struct Piece {
    std::array<int, 3> corner;  // in the plane two; numbers of points, or num_points + k for corners[k]
    double area;                // m2, in the plane any multiple of it
  };
  int num_points = 0, dimension = 2;
  std::vector<Corner> corners = {};  // that are no points: extrapolated linearly
  std::vector<Piece> pieces = {};
  bool at_edge = false;  // the corners bound the whole surface: pressures may be extrapolated to them
};

/// Points in order along lines in the plane, `thickness` [m] out of it. What the areas reach beyond the first and the last point is added
/// there. A distance that is clearly longer than the areas of two neighbours separates two lines.
Facets line_facets(const std::vector<JointPoint>& points, double thickness);
inline double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  return cross(b - a, c - a).norm() / 2;
}

/// The rectangle of a footing in space.
Facets rectangle_facets(const Footing& footing, const std::vector<JointPoint>& points);
/// Faces in space.
Facets face_facets(const Mesh& mesh, const std::vector<FacePair>& faces, FaceQuadrature quadrature, const FaceJoints& joints);

/// The share of the area of the pieces on which a quantity that is linear on each is above a level.
class PositiveShare {
 public:
  PositiveShare() = default;
  explicit PositiveShare(const Facets& facets);
  bool empty() const { return total_ == 0; }
  /// Whether all corners are points.
  bool points_alone() const { return facets_.corners.empty(); }
  /// Of values at the points and, behind them, at the other corners.
  double above(double level, const double* value) const;
  /// Numbers of points and other corners.
  Index room() const;
  /// Above zero; the values of the other corners are made from those of the points.
  double positive(double* value) const;

 private:
  double along_lines(double level, const double* value) const;
  double on_triangles(double level, const double* value) const;
  Facets facets_;  // lines: those that do not join neighbours
  Vector length_;  // lines: from each point to the next
  Vector last_;    // of the last register of these, 0 for those that the register before has too
  double total_ = 0;
};

}  // namespace uplift
