// What is looked up at an interface beyond its points: the largest gap at the edge of a rigid base that has turned, for every rule.
#include "uplift/run/interface_viewer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "unit/mesh/split_support.h"
#include "unit/verdict/verdict_support.h"

namespace uplift::interface_viewer_test {
namespace {

using support::mesh_file;

const Where here{"case.toml", 7};
constexpr std::array<FootingRule, 3> all_rules{FootingRule::nodal, FootingRule::midpoint, FootingRule::gauss};

Interface interface_of(const std::vector<JointPoint>& points, Space space) {
  Interface made;
  made.batch.points = static_cast<int>(points.size());
  made.batch.components = 1;
  made.space = space;
  made.area.resize(made.batch.points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    made.position.push_back(points[i].position);
    made.normal.push_back(points[i].normal);
    made.area[static_cast<Index>(i)] = points[i].area;
  }
  made.reference = points.front().position;
  return made;
}

/// The largest gap of one interface whose opening is this function of the position.
template <class F>
double largest_gap(const std::vector<JointPoint>& points, Space space, Facets facets, F&& opening) {
  Model model;
  model.space = space;
  model.interfaces.push_back(interface_of(points, space));
  InterfaceViewer viewer(model, 1e-9, {}, {std::make_shared<const Facets>(std::move(facets))});
  State state;
  state.opening = state.force = state.mean_force = Vector::Zero(model.interfaces.front().batch.points);
  for (std::size_t i = 0; i < points.size(); ++i) state.opening[static_cast<Index>(i)] = opening(points[i].position);
  std::vector<InterfaceView> views;
  viewer.look(state, views);
  return views.front().max_opening;
}

// Turned by theta about its toe, a rigid strip of the half width b has the gap 2 b theta at the heel.
TEST(InterfaceViewer, GapAtTheHeelOfARigidStrip) {
  const double width = 3, theta = 2e-4;
  for (const FootingRule rule : all_rules)
    for (const int points : {2, 3, 8, 40}) {
      const auto joints = footing_points({.centre = {1, 2}, .width = width, .thickness = 0.7, .points = points, .rule = rule}, here);
      for (const double side : {-1.0, 1.0})
        EXPECT_NEAR(
            largest_gap(joints, {2}, line_facets(joints, 0.7), [&](const Place& x) { return theta * (width / 2 + side * (x.x() - 1)); }),
            width * theta, 1e-12 * width * theta)
            << points;
    }
}

// A gap is extrapolated from open points only: next to a closed one the opening may bend.
TEST(InterfaceViewer, NoGapIsExtrapolatedFromClosedPoints) {
  const auto joints = footing_points({.width = 2, .points = 4, .rule = FootingRule::midpoint}, here);
  const auto bent = [](const Place& x) { return std::max(0.0, x.x() - 0.5); };
  EXPECT_NEAR(largest_gap(joints, {2}, line_facets(joints, 1), bent), 0.25, 1e-12);  // the last point alone is open
  EXPECT_EQ(largest_gap(joints, {2}, line_facets(joints, 1), [](const Place& x) { return -1e-3 * (x.x() + 2); }), 0);
}

// A raft that is turned about both axes has its largest gap at a corner.
TEST(InterfaceViewer, GapAtTheCornerOfARigidRaft) {
  for (const FootingRule rule : all_rules)
    for (const auto& [along, across] : {std::pair{2, 2}, {5, 3}, {9, 12}}) {
      const Footing raft{
          .centre = {1, 2, 3}, .normal = {0, 0, 1}, .width = 6, .points = along, .rule = rule, .length = 4, .points_across = across};
      const auto joints = footing_points(raft, here);
      const double turned = 1e-3, tilted = 5e-4;  // about a corner: 6 m and 4 m to the opposite one
      EXPECT_NEAR(largest_gap(joints, {3}, rectangle_facets(raft, joints),
                              [&](const Place& x) { return turned * (x.x() + 2) + tilted * (4 - x.y()); }),
                  6 * turned + 4 * tilted, 1e-12);
    }
}

// Faces in space and lines of a mesh: the same plane, on points that do not lie on the edge too.
TEST(InterfaceViewer, GapAtTheCornerOfFaces) {
  for (const Cell cell :
       {Cell::quad4, Cell::quad8, Cell::tri3, Cell::tet4, Cell::tet10, Cell::hex8, Cell::hex20, Cell::hex27, Cell::wedge15}) {
    const int dimension = info(cell).dimension;
    const std::array<int, 3> cells = dimension == 2 ? std::array<int, 3>{3, 2, 0} : std::array<int, 3>{3, 2, 2};
    Mesh mesh = support::parted(
        cells, [&](int, int j, int k) { return (dimension == 2 ? j : k) == 0; }, cell);
    const std::vector<FacePair> faces = split(mesh, {"joint"}, {"soil"}, mesh_file)[0].faces;
    for (const FaceQuadrature rule : {FaceQuadrature::nodal, FaceQuadrature::gauss}) {
      const FaceJoints joints = face_joints(mesh, faces, rule, 0.7, 0);
      const Facets facets = dimension == 2 ? line_facets(joints.points, 0.7) : face_facets(mesh, faces, rule, joints);
      const double depth = dimension == 2 ? 0 : 2;
      EXPECT_NEAR(largest_gap(joints.points, {dimension}, facets,
                              [&](const Place& x) { return 1e-3 * (x.x() + 0.01) + 2e-3 * (dimension == 2 ? 0 : x.y()); }),
                  1e-3 * 3.01 + 2e-3 * depth, 1e-12)
          << info(cell).name;
    }
  }
}

// The same in a run: the verdict's largest gap of a footing that is turned by a prescribed motion about its toe.
TEST(InterfaceViewer, GapAtTheHeelInTheVerdict) {
  const double width = 3, theta = 4e-4;
  for (const char* rule : {"nodal", "midpoint", "gauss"}) {
    const BuiltCase built = support::built_of(
        "title = \"turned\"\n[nodes]\nbase = [0, 0]\n[[rigid]]\nname = \"footing\"\nnode = \"base\"\nmass = 1e4\ninertia = 7500\n"
        "[[support]]\nnode = \"base\"\nfixed = [\"ux\"]\n[[interface]]\nname = \"soil\"\n"
        "footing = { body = \"base\", width = 3, points = 6, rule = \"" +
        std::string(rule) +
        "\" }\nlaw = { type = \"springs\", K_n = 2e8, tangential = \"none\" }\n"
        "[[motion]]\nnode = \"base\"\ndirection = \"uy\"\namplitude = 6e-4\n"
        "[[motion]]\nnode = \"base\"\ndirection = \"rz\"\namplitude = 4e-4\n[[stage]]\ntype = \"static\"\nsteps = 4\n");
    const RunResult result = support::run_of(built);
    ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
    EXPECT_NEAR(result.max_opening.value, width * theta, 1e-12) << rule;
  }
}

}  // namespace
}  // namespace uplift::interface_viewer_test
