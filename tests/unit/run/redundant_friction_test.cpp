// Friction by constraints at more points than have independent openings, as those of a rigid footing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "unit/case/cut_support.h"
#include "unit/contact/least_norm.h"

namespace uplift::redundant_friction_test {
namespace {

using namespace support;

/// The largest pressure of least sum p^2/area on an edge of points at y along x = 1 m that do not move, by Dykstra's projections.
double least_on_edge(double force, double moment, double shear_x, double shear_y, double friction, const std::vector<double>& y,
                     const std::vector<double>& area) {
  Matrix rows = Matrix::Zero(5, 3 * static_cast<Index>(y.size()));  // force, moment, shears, torque about x = y = 0
  std::vector<contact_test::ConePart> cones;
  for (std::size_t i = 0; i < y.size(); ++i) {
    const Index at = 3 * static_cast<Index>(i);
    const double root = std::sqrt(area[i]);
    rows(2, at) = rows(3, at + 1) = rows(4, at + 1) = rows(0, at + 2) = root;
    rows(4, at) = -root * y[i], rows(1, at + 2) = root * y[i];
    cones.push_back({at, 3, friction});
  }
  Vector resultant(5);
  resultant << -force, -moment, shear_x, shear_y, 0;
  const Vector x = contact_test::least_norm(cones, rows, resultant, 1e-10);
  double largest = 0;
  for (std::size_t i = 0; i < y.size(); ++i) largest = std::max(largest, -x[3 * static_cast<Index>(i) + 2] / std::sqrt(area[i]));
  return largest;
}

/// A rigid block that rocks on an edge of five points, rolls a little about the other axis and does not slide: all of
/// them touch, and Navier's distribution over the edge is the one of least norm, N/L + M y/I with L = 2.5 m and I of the trapezoidal rule,
/// as long as friction can be shared evenly. In the other steps a convex programme for the reported resultants gives it.
TEST(RedundantFriction, TheEdgeOfARockingBlockPressesByNavier) {
  const RunResult result = run_on(R"(title = "block"
bonded = false
[nodes]
top = [0, 0, 3]
[[rigid]]
name = "body"
node = "top"
mass = 50000
inertias = [40000, 50000, 20000]
[gravity]
acceleration = [0, 0, -9.81]
[[interface]]
name = "base"
law = { type = "coulomb", friction = 0.5 }
footing = { body = "top", width = 2, length = 2.5, points = 5, points_across = 5, offset = [0, 0, -3] }
[[function]]
name = "pulse"
shape = { type = "half_sine", duration = 0.4 }
[[ground_acceleration]]
function = "pulse"
direction = [0.8, 0.6, 0]
amplitude = 6
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 0.8
step = 2e-3
)",
                                  {});
  constexpr double length = 2.5, width = 0.25;  // m: of the edge, and what a point of it stands for
  const std::vector<double> y = {-1.25, -0.625, 0, 0.625, 1.25};
  std::vector<double> areas(5, width * length / 4);
  areas.front() = areas.back() = width * length / 8;
  const double area = 2 * areas[0] + 3 * areas[1], inertia = 2 * areas[0] * 1.25 * 1.25 + 2 * areas[1] * 0.625 * 0.625;
  const auto axial = history(result, "base.axial"), roll = history(result, "base.moment_1"),
             pressure = history(result, "base.max_pressure"), open = history(result, "base.uplifted_ratio"),
             shear = history(result, "base.shear"), shear_1 = history(result, "base.shear_1"), shear_2 = history(result, "base.shear_2");
  int on_edge = 0, compared = 0;
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (open[i] < 0.9) continue;
    const double mean = -axial[i] / area, more = std::abs(roll[i]) * 1.25 / inertia;
    if (0.5 * (mean - more) < shear[i] / area) {
      if (i % 4 != 0) continue;
      ++compared;
      const double expected = least_on_edge(-axial[i], std::abs(roll[i]), std::abs(shear_1[i]), std::abs(shear_2[i]), 0.5, y, areas);
      EXPECT_NEAR(pressure[i], expected, 1e-6 * expected) << result.table[0][i];
      continue;
    }
    ++on_edge;
    EXPECT_NEAR(pressure[i], mean + more, 1e-9 * mean) << result.table[0][i];
  }
  EXPECT_GT(on_edge, 100);
  EXPECT_GT(compared, 20);
}

}  // namespace
}  // namespace uplift::redundant_friction_test
