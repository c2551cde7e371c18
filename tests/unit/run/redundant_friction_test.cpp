// Friction by constraints at more points than have independent openings: a plane through tetrahedra crosses more edges than there are
// nodes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "unit/case/cut_support.h"

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

/// A rigid block that rocks on an edge of five points, rolls a little about the other axis and does not slide: all of
/// them touch, and Navier's distribution over the edge is the one of least norm, N/L + M y/I with L = 2.5 m and I of the trapezoidal rule.
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
  const double areas[] = {width * length / 8, width * length / 4};
  const double area = 2 * areas[0] + 3 * areas[1], inertia = 2 * areas[0] * 1.25 * 1.25 + 2 * areas[1] * 0.625 * 0.625;
  const auto axial = history(result, "base.axial"), roll = history(result, "base.moment_1"),
             pressure = history(result, "base.max_pressure"), open = history(result, "base.uplifted_ratio"),
             shear = history(result, "base.shear");
  int on_edge = 0;
  for (std::size_t i = 0; i < open.size(); ++i) {
    const double mean = -axial[i] / area, more = std::abs(roll[i]) * 1.25 / inertia;
    if (open[i] < 0.9 || 0.5 * (mean - more) < shear[i] / area) continue;  // friction is evenly shared where each point can bear it
    ++on_edge;
    EXPECT_NEAR(pressure[i], mean + more, 1e-6 * mean) << result.table[0][i];
  }
  EXPECT_GT(on_edge, 100);
}

}  // namespace
}  // namespace uplift::redundant_friction_test
