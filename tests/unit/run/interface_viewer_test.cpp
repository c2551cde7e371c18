// What is looked up at an interface beyond its points: the largest gap at the edge of a rigid base that has turned, for every rule.
#include "uplift/run/interface_viewer.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "unit/mesh/split_support.h"
#include "unit/verdict/verdict_support.h"
#include "uplift/verdict/verdict.h"

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

/// The largest pressure of one interface with these pressures at its points.
double largest_pressure(const std::vector<JointPoint>& points, Space space, Facets facets, const std::vector<double>& pressure) {
  Model model;
  model.space = space;
  model.interfaces.push_back(interface_of(points, space));
  InterfaceViewer viewer(model, 1e-9, {}, {std::make_shared<const Facets>(std::move(facets))});
  State state;
  state.opening = state.force = state.mean_force = Vector::Zero(static_cast<Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    state.force[static_cast<Index>(i)] = state.mean_force[static_cast<Index>(i)] = -pressure[i] * points[i].area;
  std::vector<InterfaceView> views;
  viewer.look(state, views);
  return views.front().max_pressure;
}

// At midpoints the pressure at the toe is 3/2 of that of the last point less 1/2 of the next one's; it does not jump where that one begins
// to bear, and a point that pulls or is open takes nothing from it.
TEST(InterfaceViewer, PressureAtTheToeDoesNotJump) {
  const auto joints = footing_points({.width = 4, .points = 4, .rule = FootingRule::midpoint}, here);
  const auto at_toe = [&](double last, double next) { return largest_pressure(joints, {2}, line_facets(joints, 1), {last, next, 0, 0}); };
  EXPECT_NEAR(at_toe(8, 4), 10, 1e-12);
  EXPECT_NEAR(at_toe(8, 1e-9), 12, 1e-8);
  EXPECT_NEAR(at_toe(8, 0), 12, 1e-12);
  EXPECT_NEAR(at_toe(8, -3), 12, 1e-12);
  EXPECT_NEAR(at_toe(0, 8), 8, 1e-12);
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

// A rigid raft of 6 x 4 m of which a corner alone is open: the plane uz - ry x + rx y passes zero 0.4 and 0.27 m from the corner, which
// is a triangle of the underside. No midpoint lies in it, one node does.
TEST(InterfaceViewer, OpenCornerOfARigidRaft) {
  const double slope_x = 1e-3, slope_y = 1.5e-3, gap = 0.4e-3, down = 3 * slope_x + 2 * slope_y - gap;  // at the corner (3, 2)
  const double counted = gap - 1e-9, share = (counted / slope_x) * (counted / slope_y) / 2 / 24;        // gaps count from 1e-9 m on
  for (const char* rule : {"nodal", "midpoint", "gauss"})
    for (const bool turned : {false, true}) {  // the length along x, too
      const BuiltCase built = support::built_of(
          "title = \"corner\"\n[limits]\ngap_tolerance = 1e-9\n[nodes]\nbase = [0, 0, 0]\n[[rigid]]\nname = \"raft\"\nnode = "
          "\"base\"\nmass = 1e4\ninertia = 7500\n"
          "[[support]]\nnode = \"base\"\nfixed = [\"ux\", \"uy\", \"rz\"]\n[[interface]]\nname = \"soil\"\n"
          "footing = { body = \"base\", points = 12, points_across = 13, rule = \"" +
          std::string(rule) + (turned ? "\", width = 4, length = 6, azimuth = \"90 deg\"" : "\", width = 6, length = 4") +
          " }\nlaw = { type = \"springs\", K_n = 2e8, tangential = \"none\" }\n" +
          fmt::format("[[motion]]\nnode = \"base\"\ndirection = \"uz\"\namplitude = {}\n", -down) +
          fmt::format("[[motion]]\nnode = \"base\"\ndirection = \"rx\"\namplitude = {}\n", slope_y) +
          fmt::format("[[motion]]\nnode = \"base\"\ndirection = \"ry\"\namplitude = {}\n[[stage]]\ntype = \"static\"\n", -slope_x));
      const RunResult result = support::run_of(built);
      ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
      EXPECT_NEAR(result.max_opening.value, gap, 1e-12) << rule;
      EXPECT_NEAR(result.max_uplifted_ratio.value, share, 1e-9) << rule;
    }
}

/// A strip of 4 m on five midpoints, k = 5e7 Pa/m, under a weight of 0.8 MN and a moment. All points are closed, so that the settlement is
/// W/(k B) and the rotation M/(k I) with I = (B^3/12)(1 - 1/n^2) of n midpoints: zero is 0.2 m from the edge, the last point 0.4 m.
struct StripOnMidpoints {
  static constexpr double width = 4, stiffness = 5e7, weight = 8e5, points = 5, open = 0.2;
  static constexpr double rotation = weight / (stiffness * width) / (width / 2 - open);
  static BuiltCase built(const std::string& law, const std::string& gaps = "") {
    const double moment = rotation * stiffness * width * width * width / 12 * (1 - 1 / (points * points));
    return support::built_of(
        "title = \"edge\"\n[nodes]\nbase = [0, 0]\n[[rigid]]\nname = \"strip\"\nnode = \"base\"\n[[support]]\nnode = \"base\"\nfixed = "
        "[\"ux\"]\n[[interface]]\nname = \"soil\"\nfooting = { body = \"base\", width = 4, points = 5, rule = \"midpoint\" }\n" +
        gaps + "law = { type = \"" + law + "\", K_n = 5e7, tangential = \"none\" }\n" +
        fmt::format("[[load]]\nnode = \"base\"\nforce = [0, {}]\nmoment = {}\n[[stage]]\ntype = \"static\"\n", -weight, moment));
  }
};

// The edge of a strip that its loads lift off beyond the last midpoint. An uneven gap of the ground beneath is no plane: nothing is known
// between points.
TEST(InterfaceViewer, OpenEdgeBeyondTheMidpoints) {
  using Strip = StripOnMidpoints;
  for (const bool uneven : {false, true}) {
    const RunResult result = support::run_of(
        Strip::built("springs", uneven ? "gap_profile = { along = \"x\", positions = [-1, 0, 1], gaps = [0, 1e-9, 0] }\n" : ""));
    ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
    EXPECT_NEAR(result.max_opening.value, uneven ? 0 : Strip::open * Strip::rotation, 1e-9 * Strip::rotation);
    EXPECT_NEAR(result.max_uplifted_ratio.value, uneven ? 0 : Strip::open / Strip::width, 1e-6);
  }
}

// A bonded strip under the same loads pulls there.
TEST(InterfaceViewer, TensionBeyondTheMidpoints) {
  const BuiltCase built = StripOnMidpoints::built("elastic");
  const RunResult result = support::run_of(built);
  ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
  const VerdictNumbers numbers = numbers_of(built, result, &result);
  EXPECT_NEAR(find_number(numbers.interfaces.at(0).numbers, "linear_tension_ratio")->value,
              StripOnMidpoints::open / StripOnMidpoints::width, 1e-9);
}

// What a base settles by does not depend on where its nodes stand close together: a strip from 0 to 4 m that turns about 1 m.
TEST(InterfaceViewer, SettlementInTheMiddleOfUnevenNodes) {
  const BuiltCase built = support::built_of(R"(title = "uneven"
[nodes]
body = [1, 1]
a = [0, 0]
b = [3, 0]
c = [3.5, 0]
d = [4, 0]
[[rigid]]
name = "strip"
node = "body"
slaves = ["a", "b", "c", "d"]
mass = 1e4
inertia = 1e4
[[support]]
node = "body"
fixed = ["ux"]
[[interface]]
name = "soil"
line = { upper = ["a", "b", "c", "d"], nodes_per_element = 2 }
law = { type = "springs", K_n = 5e7, tangential = "none" }
[[motion]]
node = "body"
direction = "uy"
amplitude = -5e-3
[[motion]]
node = "body"
direction = "rz"
amplitude = 1e-3
[[stage]]
type = "static"
)");
  const RunResult result = support::run_of(built);
  ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
  const Verdict verdict = judge(built, result, nullptr);
  EXPECT_NEAR(find_number(verdict.numbers.interfaces.at(0).numbers, "residual_settlement")->value, 5e-3 - 1e-3, 1e-12);  // of x = 2 m
}

}  // namespace
}  // namespace uplift::interface_viewer_test
