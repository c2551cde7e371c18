#include <gtest/gtest.h>

#include "unit/model/model_support.h"
#include "uplift/math/fixed.h"
#include "uplift/math/quadrature.h"
#include "uplift/math/shapes.h"

namespace uplift::interface_test {
namespace {

using support::here;

TEST(Quadrature, IsExactForPolynomials) {
  const auto integral = [](const Quadrature& rule, int degree) {
    double sum = 0;
    for (Index i = 0; i < rule.point.size(); ++i) sum += rule.weight[i] * std::pow(rule.point[i], degree);
    return sum;
  };
  const auto exact = [](int degree) { return degree % 2 ? 0.0 : 2.0 / (degree + 1); };
  for (int n = 1; n <= 30; ++n)
    for (int degree = 0; degree < 2 * n; ++degree)
      EXPECT_NEAR(integral(gauss_legendre(n), degree), exact(degree), 2e-15 * (n + 4)) << n << " " << degree;
  for (int n = 2; n <= 20; ++n)
    for (int degree = 0; degree < 2 * n - 2; ++degree)
      EXPECT_NEAR(integral(gauss_lobatto(n), degree), exact(degree), 2e-15 * (n + 4)) << n << " " << degree;
  EXPECT_GT(std::abs(integral(gauss_legendre(3), 6) - exact(6)), 1e-3);
  EXPECT_NEAR(gauss_lobatto(3).weight[1], 4.0 / 3, 1e-15);  // Simpson
  for (int n = 2; n <= 9; ++n) {
    EXPECT_NEAR(integral(trapezoid(n), 0), 2, 1e-15);
    EXPECT_NEAR(integral(trapezoid(n), 1), 0, 1e-15);
    EXPECT_NEAR(integral(midpoint(n), 0), 2, 1e-15);
    EXPECT_NEAR(integral(midpoint(n), 1), 0, 1e-15);
  }
  EXPECT_DOUBLE_EQ(trapezoid(5).weight[0], 0.25);
  EXPECT_DOUBLE_EQ(trapezoid(5).weight[1], 0.5);
}

TEST(Shapes, InterpolateAndDifferentiate) {
  const double h = 1e-6;
  for (const int nodes : {2, 3})
    for (const double xi : {-0.9, -0.3, 0.0, 0.4}) {
      const LineShape s = line_shape(nodes, xi), next = line_shape(nodes, xi + h), last = line_shape(nodes, xi - h);
      EXPECT_NEAR(s.value.sum(), 1, 1e-15);
      EXPECT_LE(((next.value - last.value) / (2 * h) - s.slope).norm(), 1e-9);
    }
  for (const double phi : {0.0, 0.8})
    for (const double xi : {0.1, 0.5, 0.7}) {
      const double l = 1.7;
      const BeamShape s = beam_shape(xi, l, phi), next = beam_shape(xi + h, l, phi), last = beam_shape(xi - h, l, phi);
      EXPECT_LE(((next.deflection - last.deflection) / (2 * h * l) - s.slope).norm(), 1e-8);
      // the shear strain w' - rotation is constant along the beam, phi/2 (theory of the exact element)
      const Vec4 shear = s.slope - s.rotation, shear_next = next.slope - next.rotation;
      EXPECT_LE((shear - shear_next).norm(), 1e-12);
      EXPECT_NEAR(shear[0], -phi / ((1 + phi) * l), 1e-14);
    }
}

TEST(Joint, TangentAndNormalAreRightHanded) {
  EXPECT_EQ(local_axis({2}, Vec3::UnitY(), 0), Vec3::UnitX());
  const Vec3 n = Vec3(3, -4, 0) / 5, t = local_axis({2}, n, 0);
  EXPECT_DOUBLE_EQ(t.x() * n.y() - t.y() * n.x(), 1);
  EXPECT_DOUBLE_EQ(t.dot(n), 0);
  EXPECT_EQ(local_axis({3}, Vec3::UnitZ(), 0), Vec3::UnitX());
  EXPECT_EQ(local_axis({3}, Vec3::UnitZ(), 1), Vec3::UnitY());
  for (const Vec3& any : {Vec3(1, 2, -3), Vec3(-1, 0, 0), Vec3(5, 1, 1)}) {
    Mat3 axes;
    for (int k = 0; k < 3; ++k) axes.col(k) = local_axis({3}, any.normalized(), k);
    EXPECT_LE((axes.transpose() * axes - Mat3::Identity()).norm(), 1e-15);
    EXPECT_NEAR(cross(axes.col(0), axes.col(1)).dot(any.normalized()), 1, 1e-15);
  }
}

TEST(Joint, FootingRules) {
  const Place n = Place(1, 2).normalized(), centre(0.5, -1);
  for (const FootingRule rule : {FootingRule::nodal, FootingRule::midpoint, FootingRule::gauss}) {
    const auto points = footing_points(
        {.body = 3, .centre = centre, .normal = 7 * n, .width = 3, .thickness = 0.5, .points = 6, .rule = rule, .gap = 0.01}, here);
    ASSERT_EQ(points.size(), 6u);
    double area = 0, inertia = 0, last = -2;
    for (const JointPoint& p : points) {
      const double s = (p.position - centre).dot(local_axis({2}, n, 0));
      EXPECT_NEAR((p.position - centre).dot(n), 0, 1e-15);
      EXPECT_GT(s, last);
      last = s;
      EXPECT_NEAR((p.normal - n).norm(), 0, 1e-15);
      EXPECT_EQ(p.upper.size(), 1u);
      EXPECT_EQ(p.upper[0].first, 3);
      EXPECT_TRUE(p.lower.empty());
      EXPECT_TRUE(p.rigid_upper);
      EXPECT_DOUBLE_EQ(p.gap, 0.01);
      area += p.area;
      inertia += p.area * s * s;
    }
    EXPECT_NEAR(area, 1.5, 1e-14);
    // width^3/12: gauss exact, trapezoid (1 + 2/k^2) with k intervals, midpoint (1 - 1/k^2) with k cells
    const double factor = rule == FootingRule::nodal ? 1 + 2.0 / 25 : rule == FootingRule::midpoint ? 1 - 1.0 / 36 : 1;
    EXPECT_NEAR(inertia, 0.5 * 27 / 12 * factor, 1e-13);
  }
}

TEST(Joint, RefusesWhatMakesNoSense) {
  const auto message = [](auto call) { return support::refusal(call); };
  EXPECT_EQ(message([] { footing_points({.width = 3, .points = 1}, here); }),
            "case.toml:7: interface.points: expected at least 2, found 1");
  EXPECT_EQ(message([] { footing_points({.width = -3, .points = 4}, here); }),
            "case.toml:7: interface.width: expected a width > 0 m, found -3");
  const SideNode a{0, {0, 0}}, b{1, {0, 1}}, c{2, {1, 0}}, d{3, {1, 1}};
  EXPECT_EQ(message([&] {
              pair_points({b}, {a, c}, {0, 1}, 1, 0, Space{2}, here);
            }),
            "case.toml:7: interface.lower: expected as many nodes as the upper side (1), found 2");
  EXPECT_EQ(message([&] {
              pair_points({b}, {a}, {0, -1}, 1, 0, Space{2}, here);
            }),
            "case.toml:7: interface.normal: expected a normal from the lower to the upper side, found an interface inside out: the upper "
            "node at (0, 1) m lies on "
            "the lower side of its partner at (0, 0) m");
  EXPECT_EQ(message([&] { pair_points({b}, {a}, {0, 1}, 1, 0, Space{2}, here); }), "");
  // in space a place has three numbers, on the ground plane z = 0 too
  EXPECT_EQ(message([&] {
              pair_points({b}, {a}, {0, -1, 0}, 1, 0, Space{3}, here);
            }),
            "case.toml:7: interface.normal: expected a normal from the lower to the upper side, found an interface inside out: the upper "
            "node at (0, 1, 0) m lies on "
            "the lower side of its partner at (0, 0, 0) m");
  EXPECT_EQ(message([&] {
              pair_points({b}, {a}, {0, 1}, 0, 0, Space{2}, here);
            }),
            "case.toml:7: interface.area: expected an area > 0 m2, found 0");
  EXPECT_EQ(message([&] { line_points({.upper = {b, d}, .lower = {a, c}}, here); }), "");
  EXPECT_NE(message([&] { line_points({.upper = {d, b}, .lower = {c, a}}, here); }).find("inside out"), std::string::npos);
  EXPECT_EQ(message([&] {
              line_points({.upper = {a, c, d, b}, .lower = {}, .nodes_per_element = 3}, here);
            }),
            "case.toml:7: interface.upper: expected 3 nodes for the first joint element and 2 more for each further one, found 4 nodes");
  EXPECT_EQ(message([&] {
              line_points({.upper = {a, a}, .lower = {}}, here);
            }),
            "case.toml:7: interface.upper: expected nodes in order along a line, found neighbours that coincide");
}

Interface plane_interface() {
  Interface face;
  face.batch.points = 3;
  face.position = {{-1, 0}, {0, 0}, {2, 0}};
  face.normal.assign(3, {0, 1});
  face.area = Vec3(0.5, 1, 0.5);
  face.reference = {0, 1};
  return face;
}

TEST(Interface, ResultantIsWhatTheStructureExertsOnTheGround) {
  const Interface face = plane_interface();
  Vector p(6);
  p << 1, 2, 3, -10, -20, -40;  // tangential, then normal
  const Resultant r = resultant(face, p.data());
  EXPECT_DOUBLE_EQ(r.axial, -70);
  EXPECT_DOUBLE_EQ(r.shear, 6);
  EXPECT_DOUBLE_EQ(r.moment, 10 - 80 + 6);  // sum x fy - (y - 1) fx
}

TEST(Interface, ResultantOfAnInclinedInterface) {
  Interface face = plane_interface();
  const double c = 0.8, s = 0.6;
  const auto turn = [&](const Vec3& v) { return Place(c * v.x() - s * v.y(), s * v.x() + c * v.y()); };
  for (int i = 0; i < 3; ++i) face.position[i] = turn(face.position[i]), face.normal[i] = turn(face.normal[i]);
  face.reference = turn(face.reference);
  Vector p(6);
  p << 1, 2, 3, -10, -20, -40;
  const Resultant r = resultant(face, p.data());
  EXPECT_NEAR(r.axial, -70, 1e-13);
  EXPECT_NEAR(r.shear, 6, 1e-13);
  EXPECT_NEAR(r.moment, -64, 1e-13);
}

// Two walls of a pit: their normals have no mean, so N is the vertical force and V the one to the right, whatever point is the first.
TEST(Interface, ResultantOfTheWallsOfAPit) {
  for (const bool left_first : {true, false}) {
    Interface walls;
    walls.batch.points = 3;
    walls.position = {{-2, -1}, {-2, 0}, {2, -1}};
    walls.normal = {{1, 0}, {1, 0}, {-1, 0}};
    walls.area = Vec3(0.5, 0.5, 1);
    Vector p(6);
    p << 1, 2, 4, -10, -20, -5;  // tangential (down on the left, up on the right), then normal
    if (!left_first) {
      std::swap(walls.position[0], walls.position[2]);
      std::swap(walls.normal[0], walls.normal[2]);
      walls.area = Vec3(1, 0.5, 0.5);
      p << 4, 2, 1, -5, -20, -10;
    }
    const Resultant r = resultant(walls, p.data());
    EXPECT_DOUBLE_EQ(r.axial, 4 - 3);
    EXPECT_DOUBLE_EQ(r.shear, 5 - 30);
    EXPECT_DOUBLE_EQ(r.moment, 2 * 1 + 2 * 2 + 2 * 4 - 10 + 5);  // sum x fy - y fx
  }
}

TEST(Interface, UpliftedRatioCountsByGap) {
  const Interface face = plane_interface();
  Vector opening(6);
  opening << 9, 9, 9, 1e-10, 1e-3, -1e-3;
  EXPECT_DOUBLE_EQ(uplifted_ratio(face, opening.data(), 1e-9), 0.5);
  EXPECT_DOUBLE_EQ(uplifted_ratio(face, opening.data(), 0), 0.75);
}

}  // namespace
}  // namespace uplift::interface_test
