#include "uplift/interface/cut_joint.h"

#include <gtest/gtest.h>

#include <map>

#include "uplift/math/singular_values.h"
#include "uplift/mesh/box.h"
#include "uplift/mesh/cut.h"

// Points on a cut: whether their openings are independent, as constraints at all of them need.
namespace uplift {
namespace {

/// Singular values of the rows that take the jumps of the nodes to the openings of the points: how many are not zero.
Index rank_of(const std::vector<JointPoint>& points) {
  std::map<int, Index> column;
  for (const JointPoint& point : points)
    for (const auto& [node, weight] : point.lower) column.try_emplace(node, static_cast<Index>(column.size()));
  Matrix rows = Matrix::Zero(static_cast<Index>(points.size()), static_cast<Index>(column.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    for (const auto& [node, weight] : points[i].lower) rows(static_cast<Index>(i), column.at(node)) = weight;
  const Vector values = SingularValues(rows).values();
  return (values.array() > 1e-10 * values[0]).count();
}

TEST(CutJoint, SaysWhereOpeningsDependOnEachOther) {
  const auto lines = uniform_lines(0, 1, 3);
  for (const Cell cell : {Cell::tri3, Cell::quad4, Cell::tet4, Cell::wedge6, Cell::hex8})
    for (const double level : {0.41, 0.5, 2.0 / 3})
      for (const bool clipped : {false, true}) {
        const bool plane = info(cell).dimension == 2;
        Mesh mesh = plane ? rectangle(lines, lines, cell) : box(lines, lines, lines, cell);
        const Vec3 up = plane ? Vec3::UnitY() : Vec3::UnitZ();
        CutPlane made{{"volume"}, {up, level}, {{{}, "raft"}}};
        if (clipped) made.outlines.front().within = {{-Vec3::UnitX(), -0.21}, {Vec3::UnitX(), 0.83}};
        const auto faces = cut(mesh, {made}, {{}});
        const CutJoints joints = cut_joints(mesh, faces[0], up, 1, 0);
        if (joints.inclined) continue;
        EXPECT_EQ(joints.dependent, rank_of(joints.points) < static_cast<Index>(joints.points.size()))
            << info(cell).name << " at " << level << (clipped ? " clipped" : "");
        if (cell == Cell::tet4 && level < 0.6)
          EXPECT_TRUE(joints.dependent) << "a section with four corners has four crossings on four nodes";
        if (cell == Cell::hex8 && !clipped) EXPECT_FALSE(joints.dependent) << "each crossing has two nodes of its own";
      }
}

}  // namespace
}  // namespace uplift
