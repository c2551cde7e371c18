#include "uplift/interface/cut_joint.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "simple_meshes.h"
#include "uplift/interface/interface.h"
#include "uplift/mesh/cell_quadrature.h"
#include "uplift/mesh/cell_shapes.h"
#include "uplift/mesh/placed_cell.h"

// Points of joints on parallelograms across hexahedra with parallel sides.
namespace uplift::cut_joint_test {
namespace {

/// Sum of the areas of points times the weights of the nodes of one side, and the integral of their shape functions over the face by
/// Gauss's rule of degree 7 in both directions: what a constant traction does to the nodes.
TEST(CutJoint, ConstantTractionOnParallelograms) {
  for (const bool clipped : {false, true}) {
    const std::vector<double> lines{0, 0.5, 1};
    Mesh mesh = box(lines, lines, std::vector<double>{0, 1});
    for (Vec3& x : mesh.nodes) x = Vec3(2 * x[0] + 0.3 * x[1], x[1] + 0.2 * x[2], 0.7 * x[2] - 0.1 * x[0]);
    const Vec3 normal = Vec3(0.15, -0.1, 1).normalized();
    CutPlane plane{{"volume"}, {normal, 0.35}, {{{}, "above"}}};
    // parallel to faces of the cells
    const Vec3 across = cross(Vec3(0.3, 1, 0), Vec3(0, 0.2, 0.7)).normalized();
    if (clipped) plane.outlines[0].within = {{across, across.dot(Vec3(1.5, 0, -0.075))}};
    const std::vector<CutFace> faces = cut(mesh, {plane}, {{}}).front();
    ASSERT_EQ(faces.size(), 4U);
    const CutJoints joint = cut_joints(mesh, faces, normal, 1, 0);
    EXPECT_TRUE(joint.inclined);
    EXPECT_EQ(joint.points.size(), 9U + 4U);  // corners, which neighbours share, and middles
    double area = 0, of_pieces = 0;
    std::map<int, double> sum, exact;
    for (const JointPoint& point : joint.points) {
      EXPECT_GT(point.area, 0);
      area += point.area;
      for (const auto& [node, weight] : point.upper) sum[node] += point.area * weight;
    }
    for (const Facets::Piece& piece : joint.facets.pieces) of_pieces += piece.area;
    double whole = 0;
    const CellRule gauss = cell_rule(Cell::quad4, 7);
    for (const CutFace& face : faces) {
      ASSERT_EQ(face.corners.size(), 4U);
      std::vector<Vec3> places;
      for (const int node : mesh.cell(face.upper)) places.push_back(mesh.nodes[static_cast<std::size_t>(node)]);
      const double size = cross(face.corners[1] - face.corners[0], face.corners[3] - face.corners[0]).norm();
      whole += size;
      for (std::size_t p = 0; p < gauss.weight.size(); ++p) {
        const Vec3 place = cell_position(cell_shape(Cell::quad4, gauss.point[p]), face.corners);
        const CellShape shape = cell_shape(Cell::hex8, local_coordinates(Cell::hex8, places, place));
        for (std::size_t a = 0; a < 8; ++a) exact[mesh.cell(face.upper)[a]] += gauss.weight[p] * size / 4 * shape.value[a];
      }
    }
    EXPECT_NEAR(area, whole, 1e-14);
    EXPECT_NEAR(of_pieces, whole, 1e-14);
    for (const auto& [node, value] : exact) EXPECT_NEAR(sum[node], value, 1e-15) << node;
  }
}

}  // namespace
}  // namespace uplift::cut_joint_test
