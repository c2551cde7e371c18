// A structure that is turned with its gravity and its motion has the same numbers.
#include <fmt/format.h>

#include <cmath>

#include "unit/verdict/verdict_support.h"
#include "uplift/math/linalg.h"
#include "uplift/verdict/second_order.h"

namespace uplift::turned_test {
namespace {

using namespace support;

Mat3 rotation(const Vec3& axis, double angle) {
  Mat3 made;
  for (int k = 0; k < 3; ++k) {
    const Vec3 v = Vec3::Unit(k);
    made.col(k) = v * std::cos(angle) + cross(axis, v) * std::sin(angle) + axis * axis.dot(v) * (1 - std::cos(angle));
  }
  return made;
}

std::string text_of(const Mat3& turn, const Vec3& vector, int dimension) {
  const Vec3 v = turn * vector;
  return dimension == 2 ? fmt::format("[{}, {}]", v.x(), v.y()) : fmt::format("[{}, {}, {}]", v.x(), v.y(), v.z());
}

/// A column on a footing that rocks with uplift and slides.
BuiltCase tower(const Mat3& turn, int dimension) {
  const bool plane = dimension == 2;
  const auto at = [&](double x, double y, double up) { return text_of(turn, plane ? Vec3(x, up, 0) : Vec3(x, y, up), dimension); };
  const Vec3 normal = turn * (plane ? Vec3::UnitY() : Vec3::UnitZ()), width = turn * Vec3::UnitX();
  const Space space{dimension};
  const double azimuth = std::atan2(width.dot(local_axis(space, normal, 1)), width.dot(local_axis(space, normal, 0)));
  const std::string in_space = fmt::format(", length = 4, points_across = 5, azimuth = {}", azimuth);
  return built_of(
      "title = \"tower\"\nbonded = false\n[nodes]\nfoot = " + at(0, 0, 0) + "\nhead = " + at(0.5, 0.3, 9) + "\n" +
      "[[beam]]\nname = \"shaft\"\nnodes = [\"foot\", \"head\"]\nE = \"30 GPa\"\nA = 0.8\n" +
      (plane ? "I = 0.15\n" : "I_y = 0.15\nI_z = 0.1\nJ = 0.2\nup = " + at(1, 0.2, 0) + "\n") +
      "[[mass]]\nnode = \"head\"\nmass = \"150 t\"\n[[rigid]]\nnode = \"foot\"\nmass = \"100 t\"\n" +
      (plane ? "inertia = 1e6\n" : "inertias = [1e6, 1e6, 1e6]\n") + "centre = " + at(0.2, 0.1, 0.5) +
      "\n[[interface]]\nname = \"base\"\nfooting = { body = \"foot\", width = 5, points = 9, offset = " + at(0, 0, -0.5) +
      ", normal = " + at(0, 0, 1) + (plane ? ", thickness = 4" : in_space) +
      " }\nlaw = { type = \"springs\", K_n = 2e8, K_t = 1e8, tangential = \"coulomb\", friction = 0.6 }\n[gravity]\nacceleration = " +
      at(0, 0, -9.81) +
      "\n[[function]]\nname = \"r\"\nshape = { type = \"ricker\", frequency = 1.2 }\n[[ground_acceleration]]\nfunction = \"r\"\n" +
      "amplitude = 3.5\ndirection = " + (plane ? at(1, 0, 0) : at(0.8, 0.6, 0)) + "\n[[load]]\nnode = \"head\"\nforce = " +
      at(2e4, -1e4, 0) + "\n[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\nduration = 2\nstep = 0.005\n");
}

void expect_same(const std::vector<VerdictNumber>& as_drawn, const std::vector<VerdictNumber>& turned, double angle) {
  ASSERT_EQ(as_drawn.size(), turned.size());
  for (std::size_t i = 0; i < as_drawn.size(); ++i) {
    ASSERT_EQ(as_drawn[i].quantity, turned[i].quantity);
    const double value = std::abs(as_drawn[i].value);  // a drift in the plane has a sign, which is that of an axis
    EXPECT_NEAR(std::abs(turned[i].value), value, 1e-6 * value + 1e-12) << as_drawn[i].quantity->name << " at " << angle;
    EXPECT_NEAR(turned[i].swing.value_or(0), as_drawn[i].swing.value_or(0), 1e-6 * value + 1e-12) << as_drawn[i].quantity->name;
  }
}

void expect_same_when_turned(int dimension, const Vec3& axis, const std::vector<double>& angles) {
  const BuiltCase drawn = tower(Mat3::Identity(), dimension);
  const RunResult run = run_of(drawn);
  ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
  const VerdictNumbers numbers = numbers_of(drawn, run, nullptr);
  EXPECT_GT(number(numbers, "max_uplifted_ratio"), 0.2);
  EXPECT_GT(find_number(numbers.whole, "max_drift")->value, 2 * find_number(numbers.whole, "max_drift_without_rotation")->value);
  EXPECT_GT(std::abs(number(numbers, "residual_settlement")), 0);
  for (const double angle : angles) {
    const BuiltCase built = tower(rotation(axis, angle), dimension);
    EXPECT_EQ(built.name_of_top(), "node head");
    EXPECT_NEAR(swaying_weight(built), swaying_weight(drawn), 1e-9 * swaying_weight(drawn));
    const RunResult turned = run_of(built);
    ASSERT_EQ(turned.status, RunStatus::completed) << turned.reason;
    const VerdictNumbers same = numbers_of(built, turned, nullptr);
    expect_same(numbers.whole, same.whole, angle);
    expect_same(numbers.interfaces[0].numbers, same.interfaces[0].numbers, angle);
  }
}

TEST(TurnedStructure, HasTheSameNumbersInThePlane) {
  expect_same_when_turned(2, Vec3::UnitZ(), {0.3, M_PI / 2, M_PI, -1.2});
}

TEST(TurnedStructure, HasTheSameNumbersInSpace) {
  expect_same_when_turned(3, Vec3(0.48, 0.36, 0.8), {0.4, -0.5});
}

}  // namespace
}  // namespace uplift::turned_test
