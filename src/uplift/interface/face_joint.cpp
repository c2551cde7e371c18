#include "uplift/interface/face_joint.h"

#include <algorithm>
#include <map>

#include "uplift/interface/face_order.h"
#include "uplift/mesh/cell_quadrature.h"
#include "uplift/mesh/cell_shapes.h"

namespace uplift {

namespace {

constexpr double same_normal = 1 - 1e-9;  // cosine: nine seconds of arc

/// Shape functions of one side at a point of its face.
std::vector<std::pair<int, double>> side(std::span<const int> nodes, const CellShape& shape) {
  std::vector<std::pair<int, double>> terms;
  for (std::size_t a = 0; a < nodes.size(); ++a)
    if (std::abs(shape.value[a]) > 1e-14) terms.emplace_back(nodes[a], shape.value[a]);
  return terms;
}

/// Points at node pairs that were met, by pair; several where normals differ.
class Pairs {
 public:
  explicit Pairs(std::vector<JointPoint>& points) : points_(points) {}
  /// The number of the point.
  int add(int lower, int upper, const JointPoint& point) {
    std::vector<int>& here = known_[{lower, upper}];
    for (const int k : here)
      if (JointPoint& known = points_[static_cast<std::size_t>(k)]; known.normal.dot(point.normal) > same_normal) {
        known.area += point.area;
        return k;
      }
    here.push_back(static_cast<int>(points_.size()));
    points_.push_back(point);
    return here.back();
  }

 private:
  std::vector<JointPoint>& points_;
  std::map<std::pair<int, int>, std::vector<int>> known_;
};

/// What a node has of a bilinear face, int N_a n dA [m2]: that of the corner alone, det J times the weight, would not balance a uniform
/// pressure where opposite edges are not parallel.
Vec3 share_of_corner(Cell cell, std::size_t corner, const std::vector<Vec3>& positions) {
  const CellRule rule = cell_rule(cell, 3);  // a linear vector of area times a bilinear shape function
  Vec3 share = Vec3::Zero();
  for (std::size_t i = 0; i < rule.point.size(); ++i) {
    const CellShape shape = cell_shape(cell, rule.point[i]);
    share += rule.weight[i] * shape.value[corner] * cell_area_vector(shape, positions, cell);
  }
  return share;
}

}  // namespace

FaceJoints face_joints(const Mesh& mesh, const std::vector<FacePair>& faces, FaceQuadrature quadrature, double thickness, double gap) {
  FaceJoints joints;
  std::vector<JointPoint>& points = joints.points;
  Pairs pairs(points);
  std::vector<Vec3> positions;
  for (const FacePair& face : faces) {
    std::vector<int>& numbers = joints.of_face.emplace_back();
    const Cell cell = mesh.type(face.lower);
    const std::span<const int> lower = mesh.cell(face.lower), upper = mesh.cell(face.upper);
    if (std::ranges::equal(lower, upper)) continue;  // all nodes where the surface ends: nothing can part
    const int degree = info(cell).linear == cell ? 1 : 2;
    const CellRule rule = quadrature == FaceQuadrature::nodal ? nodal_rule(cell) : cell_rule(cell, 2 * degree);
    numbers.assign(rule.point.size(), -1);
    positions.clear();
    for (const int node : lower) positions.push_back(mesh.nodes[static_cast<std::size_t>(node)]);
    for (std::size_t i = 0; i < rule.point.size(); ++i) {
      const CellShape shape = cell_shape(cell, rule.point[i]);
      const bool bilinear = cell == Cell::quad4 && quadrature == FaceQuadrature::nodal;
      const Vec3 area = bilinear ? share_of_corner(cell, i, positions) : Vec3(rule.weight[i] * cell_area_vector(shape, positions, cell));
      JointPoint point;
      point.position = cell_position(shape, positions);
      point.normal = area.normalized();
      point.area = area.norm() * (mesh.dimension == 2 ? thickness : 1);
      point.gap = gap;
      point.lower = side(lower, shape);
      point.upper = side(upper, shape);
      const bool at_node = quadrature == FaceQuadrature::nodal && i < lower.size();
      if (!at_node) {
        numbers[i] = static_cast<int>(points.size());
        points.push_back(point);
      } else if (lower[i] != upper[i]) {
        numbers[i] = pairs.add(lower[i], upper[i], point);
      }
    }
  }
  renumber(mesh.dimension == 2 ? order_along_lines(mesh, faces, quadrature, joints) : order_in_rows(points), joints);
  return joints;
}

std::vector<JointPoint> face_points(const Mesh& mesh, const std::vector<FacePair>& faces, FaceQuadrature quadrature, double thickness,
                                    double gap) {
  return face_joints(mesh, faces, quadrature, thickness, gap).points;
}

}  // namespace uplift
