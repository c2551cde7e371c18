// The azimuth of a [[foundation]]: its stiffness and its dashpots turned by hand, and the [[interface]] footing with the same azimuth.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "ran_support.h"
#include "text_support.h"
#include "uplift/verdict/verdict.h"

namespace uplift::foundation_azimuth_test {
namespace {

using support::Ran;
using support::refusal_of;

constexpr double azimuth = 37 * std::numbers::pi / 180;
constexpr std::array<double, 3> stiffness{3e8, 2e8, 6e8}, rocking{1.2e9, 2.1e9, 1.7e9};  // along t1, t2, up; about t1 (K_r2), t2 (K_r), up

/// One node above a foundation of 6 m x 4 m, under a force and a moment; no unknown is held.
std::string block(const std::string& ground) {
  return "title = \"block\"\n[nodes]\nbase = [0, 0, 0]\n[[rigid]]\nname = \"footing\"\nnode = \"base\"\nmass = 30e3\n"
         "inertias = [60e3, 70e3, 100e3]\n" +
         ground +
         "[[load]]\nnode = \"base\"\nforce = [40e3, 90e3, -2e6]\n[[load]]\nnode = \"base\"\nmoments = [300e3, -500e3, 200e3]\n"
         "[[stage]]\ntype = \"static\"\n[output]\nframes = 0\n";
}
std::string foundation(const std::string& more) {
  return fmt::format(
             "[[foundation]]\nname = \"soil\"\nbody = \"base\"\nwidth = 6\nlength = 4\nazimuth = \"37 deg\"\noffset = [0.3, -0.2, -1]\n"
             "model = {{ type = \"elastic\", K_h = {}, K_h2 = {}, K_v = {}, K_r2 = {}, K_r = {}, K_t = {} }}\n",
             stiffness[0], stiffness[1], stiffness[2], rocking[0], rocking[1], rocking[2]) +
         more;
}
std::string histories(std::initializer_list<const char*> quantities) {
  std::string text;
  for (const char* each : quantities) text += fmt::format("[[output.history]]\ninterface = \"soil\"\nquantity = \"{}\"\n", each);
  return text;
}
constexpr const char* motions =
    "[[output.history]]\nnode = \"base\"\nquantity = \"ux\"\n[[output.history]]\nnode = \"base\"\nquantity = \"uy\"\n"
    "[[output.history]]\nnode = \"base\"\nquantity = \"uz\"\n[[output.history]]\nnode = \"base\"\nquantity = \"rx\"\n"
    "[[output.history]]\nnode = \"base\"\nquantity = \"ry\"\n[[output.history]]\nnode = \"base\"\nquantity = \"rz\"\n";

Vec3 at_end(const Ran& ran, const std::string& x, const std::string& y, const std::string& z) {
  return {ran[x].back(), ran[y].back(), ran[z].back()};
}

/// R diag(values) R^T v, where the columns of R are the axes of the foundation.
Vec3 turned(const std::array<double, 3>& values, const Vec3& v) {
  const Vec3 t1(std::cos(azimuth), std::sin(azimuth), 0), t2(-std::sin(azimuth), std::cos(azimuth), 0);
  return values[0] * t1.dot(v) * t1 + values[1] * t2.dot(v) * t2 + values[2] * v.z() * Vec3::UnitZ();
}

TEST(FoundationAzimuth, TurnsTheStiffness) {
  const Ran ran = support::run_text(block(foundation("")) + motions + histories({"rotation_1", "rotation_2"}));
  ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
  const Vec3 u = at_end(ran, "base.ux", "base.uy", "base.uz"), theta = at_end(ran, "base.rx", "base.ry", "base.rz"), arm(0.3, -0.2, -1);
  const Vec3 force = turned(stiffness, u + cross(theta, arm)), moment = turned(rocking, theta) + cross(arm, force);
  EXPECT_LT((force - Vec3(40e3, 90e3, -2e6)).norm(), 1e-9 * 2e6);
  EXPECT_LT((moment - Vec3(300e3, -500e3, 200e3)).norm(), 1e-9 * 2e6);
  EXPECT_NEAR(ran["soil.rotation_1"].back(), theta.x(), 1e-12 * theta.norm());
  EXPECT_NEAR(ran["soil.rotation_2"].back(), theta.y(), 1e-12 * theta.norm());
}

TEST(FoundationAzimuth, TurnsTheDashpots) {
  const std::string soil = "[foundation.soil]\nradiation = true\nfrequency = 2\nG = 60e6\npoisson = 0.3\ndensity = 1900\n";
  const Ran ran = support::run_text(block(foundation(soil)));
  const std::vector<double> c = radiation_damping(*ran.built.model.interfaces.front().footprint);
  ASSERT_EQ(c.size(), 6u);
  EXPECT_GT(std::abs(c[3] - c[4]), 0.1 * c[3]);  // those of the two horizontal motions are the same
  const Vec3 velocity(0.3, -0.5, 0.2), spin(0.02, 0.05, -0.03), arm(0.3, -0.2, -1);
  const Vec3 force = turned({c[0], c[1], c[2]}, velocity + cross(spin, arm)), moment = turned({c[3], c[4], c[5]}, spin) + cross(arm, force);
  Vector motion(6), expected(6);
  motion << velocity, spin;
  expected << force, moment;
  EXPECT_LT((ran.built.model.damping * motion - expected).norm(), 1e-12 * expected.norm());
}

// Two by two Gauss points on springs have exactly the stiffnesses of a uniform bed.
TEST(FoundationAzimuth, AgreesWithAFootingOfPoints) {
  constexpr double kn = 25e6, kt = 10e6, area = 24;
  const std::string whole = fmt::format(
      "[[foundation]]\nname = \"soil\"\nbody = \"base\"\nwidth = 6\nlength = 4\nazimuth = \"37 deg\"\noffset = [0.3, -0.2, -1]\n"
      "model = {{ type = \"elastic\", K_h = {}, K_v = {}, K_r2 = {}, K_r = {}, K_t = {} }}\n",
      kt * area, kn * area, kn * area * 16 / 12, kn * area * 36 / 12, kt * area * (36 + 16) / 12);
  const std::string points = fmt::format(
      "[[interface]]\nname = \"soil\"\nlaw = {{ type = \"elastic\", K_n = {}, K_t = {} }}\n[interface.footing]\nbody = \"base\"\n"
      "width = 6\nlength = 4\nazimuth = \"37 deg\"\noffset = [0.3, -0.2, -1]\npoints = 2\npoints_across = 2\nrule = \"gauss\"\n",
      kn, kt);
  const auto quantities = {"axial",    "shear_1", "shear_2", "moment_1",   "moment_2",   "torsion",
                           "rotation", "shear",   "moment",  "rotation_1", "rotation_2", "settlement"};
  const Ran one = support::run_text(block(whole) + histories(quantities)), other = support::run_text(block(points) + histories(quantities));
  for (const std::string quantity : quantities) {
    const double expected = other["soil." + quantity].back();
    EXPECT_NEAR(one["soil." + quantity].back(), expected, 1e-9 * std::abs(expected)) << quantity;
  }
  const auto outline = [](const Ran& ran) {
    std::vector<std::array<double, 3>> corners;
    for (const Place& corner : ran.built.facts.front().corners) corners.push_back({corner.x(), corner.y(), corner.z()});
    std::ranges::sort(corners);
    return corners;
  };
  const auto found = outline(one), expected = outline(other);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[i][k], expected[i][k], 1e-12);
}

// Shapes that look the same from all sides, to the eccentricity in the verdict; and the plane, which has one direction.
TEST(FoundationAzimuth, OfADiscAndInThePlane) {
  const auto disc = [](const std::string& more) {
    std::string text = "[[foundation]]\nname = \"soil\"\nbody = \"base\"\nshape = \"disc\"\nwidth = 6\noffset = [0.3, -0.2, -1]\n" + more +
                       "model = { type = \"macro_element\", K_h = 3e8, K_v = 6e8, K_r = 2e9, K_t = 1e9, V_s = 4e6, V_u = 9e6, "
                       "w_ref = 0.02, friction_angle = 0.5 }\n";
    return support::run_text(block(text) + motions);
  };
  const Ran ran = disc(""), other = disc("azimuth = \"37 deg\"\n");
  ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
  for (const char* motion : {"base.ux", "base.uy", "base.uz", "base.rx", "base.ry", "base.rz"})
    EXPECT_NEAR(other[motion].back(), ran[motion].back(), 1e-9 * std::abs(ran[motion].back())) << motion;
  const auto corners = [](const Ran& of) { return of.built.facts.front().corners; };
  ASSERT_EQ(corners(ran).size(), corners(other).size());
  for (std::size_t i = 0; i < corners(ran).size(); ++i) EXPECT_EQ((corners(ran)[i] - corners(other)[i]).norm(), 0);

  const std::string plane =
      "title = \"plane\"\n[nodes]\nbase = [0, 0]\n[[rigid]]\nname = \"footing\"\nnode = \"base\"\nmass = 3e4\ninertia = 6e4\n"
      "[[foundation]]\nname = \"soil\"\nbody = \"base\"\nwidth = 6\nazimuth = \"37 deg\"\n"
      "model = { type = \"elastic\", K_v = 4e8, K_h = 3e8, K_r = 2e9 }\n[gravity]\n[[stage]]\ntype = \"static\"\n";
  const std::string said = refusal_of([&] { support::run_text(plane); });
  EXPECT_NE(said.find("no azimuth in the plane"), std::string::npos) << said;
}

}  // namespace
}  // namespace uplift::foundation_azimuth_test
