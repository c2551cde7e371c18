#include "uplift/interface/facets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "unit/mesh/split_support.h"

// Shares of the area of an interface on which a quantity is positive. References: lengths and polygons cut by hand.
namespace uplift::facets_test {
namespace {

using support::mesh_file;

const Where here{"case.toml", 7};
constexpr std::array<FootingRule, 3> all_rules{FootingRule::nodal, FootingRule::midpoint, FootingRule::gauss};

template <class F>
double share_of(const Facets& facets, const std::vector<JointPoint>& points, F&& quantity) {
  const PositiveShare share(facets);
  Vector value = Vector::Zero(share.room());
  for (std::size_t i = 0; i < points.size(); ++i) value[static_cast<Index>(i)] = quantity(points[i].position);
  return share.positive(value.data());
}

/// Area of the part of a polygon in which c + a x + b y > 0 (Sutherland and Hodgman, then the shoelace formula).
double cut_area(const std::vector<Vec2>& polygon, double c, double a, double b) {
  const auto level = [&](const Vec2& p) { return c + a * p.x() + b * p.y(); };
  std::vector<Vec2> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    if (level(p) > 0) kept.push_back(p);
    if ((level(p) > 0) != (level(q) > 0)) kept.push_back(p + level(p) / (level(p) - level(q)) * (q - p));
  }
  double area = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const Vec2 &p = kept[i], &q = kept[(i + 1) % kept.size()];
    area += (p.x() * q.y() - p.y() * q.x()) / 2;
  }
  return area;
}

// A linear quantity is cut exactly, between any two points and beyond the last ones.
TEST(Facets, LinearOnAStrip) {
  for (const FootingRule rule : all_rules)
    for (const int points : {2, 5, 8, 21, 40}) {
      const Footing strip{.centre = {1, 2}, .width = 3, .thickness = 0.7, .points = points, .rule = rule};
      const auto joints = footing_points(strip, here);
      const Facets facets = line_facets(joints, strip.thickness);
      for (const double edge : {-0.6, -0.49, -0.2, 0.0, 1.0, 2.3, 2.43, 2.499, 2.7}) {
        const double positive = std::clamp((2.5 - edge) / 3, 0.0, 1.0);
        EXPECT_NEAR(share_of(facets, joints, [&](const Place& x) { return 1e-3 * (x.x() - edge); }), positive, 1e-12)
            << points << " " << edge;
        EXPECT_NEAR(share_of(facets, joints, [&](const Place& x) { return 1e-3 * (edge - x.x()); }), 1 - positive, 1e-12)
            << points << " " << edge;
      }
    }
}

TEST(Facets, NothingIsPositiveWhereAllIsZero) {
  const auto joints = footing_points({.width = 3, .points = 9}, here);
  const Facets facets = line_facets(joints, 1);
  EXPECT_EQ(share_of(facets, joints, [](const Place&) { return 0; }), 0);
  EXPECT_EQ(share_of(facets, joints, [](const Place&) { return 1e-30; }), 1);
}

// A parabola, positive on 1/sqrt(2) of the strip: order 2.
TEST(Facets, OrderTwoOnAStrip) {
  for (const FootingRule rule : all_rules) {
    std::vector<double> error;
    for (const int points : {10, 20, 40, 80}) {
      const auto joints = footing_points({.width = 2, .points = points, .rule = rule}, here);
      error.push_back(
          std::abs(share_of(line_facets(joints, 1), joints, [](const Place& x) { return 0.5 - x.x() * x.x(); }) - std::sqrt(0.5)));
      EXPECT_LT(error.back(), 1.0 / (points * points)) << points;
    }
  }
}

// Two lines, apart, that are one interface: the space between them is no part of it.
TEST(Facets, TwoLines) {
  std::vector<JointPoint> joints = footing_points({.centre = {0, 0}, .width = 2, .points = 6}, here);
  for (JointPoint& more : footing_points({.centre = {4, 0}, .width = 2, .points = 6}, here)) joints.push_back(more);
  EXPECT_NEAR(share_of(line_facets(joints, 1), joints, [](const Place& x) { return x.x() - 2; }), 0.5, 1e-12);
  EXPECT_NEAR(share_of(line_facets(joints, 1), joints, [](const Place& x) { return x.x() - 3.7; }), 1.3 / 4, 1e-12);
}

// A plane over a rectangle that is turned in plan, cut at random.
TEST(Facets, LinearOnARectangle) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const std::vector<Vec2> corners{{-3, -2}, {3, -2}, {3, 2}, {-3, 2}};
  for (const FootingRule rule : all_rules)
    for (const auto& [along, across] : {std::pair{2, 2}, {5, 3}, {9, 12}}) {
      Footing raft{
          .centre = {1, 2, 3}, .normal = {0, 0, 1}, .width = 6, .points = along, .rule = rule, .length = 4, .points_across = across};
      raft.azimuth = 0.4;
      const auto joints = footing_points(raft, here);
      const Facets facets = rectangle_facets(raft, joints);
      for (int i = 0; i < 20; ++i) {
        const double c = uniform(random), a = uniform(random), b = uniform(random);
        const auto plane = [&](const Place& x) {
          const Vec3 arm = x - raft.centre;
          return c + a * (std::cos(0.4) * arm.x() + std::sin(0.4) * arm.y()) + b * (std::cos(0.4) * arm.y() - std::sin(0.4) * arm.x());
        };
        EXPECT_NEAR(share_of(facets, joints, plane), cut_area(corners, c, a, b) / 24, 1e-12);
      }
    }
}

// ---- faces of a mesh ----

class FaceFacets : public testing::TestWithParam<Cell> {
 protected:
  int dimension() const { return info(GetParam()).dimension; }
  /// Unit cells, 3 wide (and 2 deep), opened at the height 1.
  std::pair<Mesh, std::vector<FacePair>> slab() const {
    const std::array<int, 3> cells = dimension() == 2 ? std::array<int, 3>{3, 2, 0} : std::array<int, 3>{3, 2, 2};
    Mesh mesh = support::parted(
        cells, [&](int, int j, int k) { return (dimension() == 2 ? j : k) == 0; }, GetParam());
    std::vector<FacePair> faces = split(mesh, {"joint"}, {"soil"}, mesh_file)[0].faces;
    return {std::move(mesh), std::move(faces)};
  }
};
INSTANTIATE_TEST_SUITE_P(Cells, FaceFacets,
                         testing::Values(Cell::tri3, Cell::quad4, Cell::quad8, Cell::quad9, Cell::tet4, Cell::tet10, Cell::wedge6,
                                         Cell::wedge15, Cell::hex8, Cell::hex20, Cell::hex27),
                         [](const auto& test) { return std::string(uplift::info(test.param).name); });

TEST_P(FaceFacets, LinearOnFaces) {
  const auto [mesh, faces] = slab();
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const std::vector<Vec2> corners{{0, 0}, {3, 0}, {3, 2}, {0, 2}};
  for (const FaceQuadrature rule : {FaceQuadrature::nodal, FaceQuadrature::gauss}) {
    const FaceJoints joints = face_joints(mesh, faces, rule, 0.7, 0);
    const Facets facets = dimension() == 2 ? line_facets(joints.points, 0.7) : face_facets(mesh, faces, rule, joints);
    for (int i = 0; i < 20; ++i) {
      const double a = uniform(random), b = dimension() == 2 ? 0 : uniform(random), c = -1.5 * a - b + 0.5 * uniform(random);
      EXPECT_NEAR(share_of(facets, joints.points, [&](const Place& x) { return c + a * x.x() + b * x.y(); }),
                  cut_area(corners, c, a, b) / 6, 1e-12)
          << i;
    }
  }
}

// Points are numbered along the line, or in rows: x grows along each, y from row to row.
TEST_P(FaceFacets, PointsAreNumberedInRows) {
  const auto [mesh, faces] = slab();
  for (const FaceQuadrature rule : {FaceQuadrature::nodal, FaceQuadrature::gauss}) {
    const FaceJoints joints = face_joints(mesh, faces, rule, 1, 0);
    for (std::size_t i = 1; i < joints.points.size(); ++i) {
      const Place &last = joints.points[i - 1].position, &next = joints.points[i].position;
      const bool new_row = next.y() > last.y() + 1e-9;
      EXPECT_TRUE(new_row || next.x() > last.x()) << i;
      EXPECT_GE(next.y(), last.y() - 1e-9) << i;
    }
    for (std::size_t f = 0; f < faces.size(); ++f)
      for (const int k : joints.of_face[f]) {
        Vec3 middle = Vec3::Zero();
        const auto nodes = mesh.cell(faces[f].lower);
        for (const int node : nodes) middle += mesh.nodes[static_cast<std::size_t>(node)] / static_cast<double>(nodes.size());
        EXPECT_LT((joints.points[static_cast<std::size_t>(k)].position - middle).norm(), 0.8) << "point " << k << " is not of face " << f;
      }
  }
}

// A sunk raft in the plane: down one wall, along the underside, up the other wall; neighbours in number are neighbours in place.
TEST(FaceNumbers, AlongAnOpenedRaft) {
  Mesh mesh = support::parted(
      {6, 4, 0}, [](int i, int j, int) { return j < 2 || i < 1 || i > 4; }, Cell::quad4);
  const std::vector<FacePair> faces = split(mesh, {"joint"}, {"soil"}, mesh_file)[0].faces;
  const FaceJoints joints = face_joints(mesh, faces, FaceQuadrature::nodal, 1, 0);
  ASSERT_EQ(joints.points.size(), 3U + 5U + 3U);  // the corners have one point for each normal
  EXPECT_EQ(joints.points.front().position.x(), 1);
  EXPECT_EQ(joints.points.back().position.x(), 5);
  for (std::size_t i = 1; i < joints.points.size(); ++i)
    EXPECT_LT((joints.points[i].position - joints.points[i - 1].position).norm(), 1 + 1e-9) << i;
}

}  // namespace
}  // namespace uplift::facets_test
