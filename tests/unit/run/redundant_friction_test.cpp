// Friction by constraints at more points than have independent openings: a plane through tetrahedra crosses more edges than there are
// nodes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "unit/case/cut_support.h"
#include "unit/contact/least_norm.h"

namespace uplift::redundant_friction_test {
namespace {

using namespace support;

/// A block of W = 11.77 kN on a slope: W sin(0.2) = 2.34 kN and 0.5 kN that push are less than 0.3 W cos(0.2) = 3.46 kN, so that it sticks.
/// Some closed points bear nothing, since their neighbours do; they are not open, and nothing strikes. A cube under 0.5 kN, twice as
/// much where the push is sudden, shears by 2 F h/(G A) = 1e3/4.17e8 = 2.4 micrometres, and bends by about as much.
TEST(RedundantFriction, ABlockThatIsPushedOnASlopeSticks) {
  const auto lines = uniform_lines(0, 1, 2);
  const std::string damped = "damping_beta = 2e-4\n";
  const std::string text = "title = \"cube\"\nbonded = false\n[mesh]\nfile = \"cube.msh\"\n" + solid("volume", 1e9, 0.2, 2000, damped) +
                           solid("block", 1e9, 0.2, 2000, damped) + "[[support]]\ngroup = \"bottom\"\nfixed = [\"ux\", \"uy\", \"uz\"]\n" +
                           fmt::format("[gravity]\nacceleration = [{}, 0, {}]\n", 9.81 * std::sin(0.2), -9.81 * std::cos(0.2)) +
                           "[[interface]]\nname = \"base\"\ncut = { through = [\"volume\"], level = 0.4, upper = \"block\" }\n"
                           "law = { type = \"coulomb\", friction = 0.3 }\n"
                           "[[function]]\nname = \"f\"\nshape = { type = \"harmonic\", frequency = 50 }\n"
                           "[[load]]\ngroup = \"top\"\ntraction = [500, 0, 0]\nfunction = \"f\"\n"
                           "[[output.history]]\nname = \"top\"\nat = [1, 1, 1]\nquantity = \"ux\"\n"
                           "[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\nduration = 0.01\nstep = 5e-4\n";
  const RunResult result = run_on(text, box(lines, lines, lines, Cell::tet4));
  const auto top = history(result, "top");
  ASSERT_GT(top.size(), 20u);
  double moved = 0;
  for (const double at : top) moved = std::max(moved, std::abs(at - top.front()));
  EXPECT_GT(moved, 1e-7);
  EXPECT_LT(moved, 5e-6);
  const double weight = 0.6 * 2000 * 9.81 * std::cos(0.2);
  for (const double axial : history(result, "base.axial")) EXPECT_NEAR(axial, -weight, 0.02 * weight);
}

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
