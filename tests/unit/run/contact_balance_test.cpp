// Energy and forces of contact by constraints where the step does not resolve what moves the base: loads that turn round within a few
// steps. Contact and friction then take energy, and none is created.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "unit/case/cut_support.h"

namespace uplift::contact_balance_test {
namespace {

using namespace support;

/// A rigid block of 6.1 t, 9.2 m wide on some points.
struct Body {
  std::string name;
  double height;  // m: of its centre over the ground
  int points;
  std::string law;
  bool held = false;  // horizontally
};

constexpr const char* unilateral = R"(type = "unilateral")";

/// Bodies 50 m apart on ground that moves 5.36 times a second with 6 m/s2. The history "path" is the displacement of the first one.
std::string shaken(const std::vector<Body>& bodies, double step, double duration = 3) {
  std::string nodes = "[nodes]\n", parts;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const Body& body = bodies[k];
    const double x = 50.0 * static_cast<double>(k);
    nodes += fmt::format("{} = [{}, 0]\n", body.name, x);
    parts += fmt::format(R"([[rigid]]
name = "raft of {0}"
node = "{0}"
mass = 6100
inertia = 190000
centre = [{1}, {2}]
[[interface]]
name = "under {0}"
footing = {{ body = "{0}", width = 9.2, thickness = 4.9, points = {3} }}
law = {{ {4} }}
)",
                         body.name, x, body.height, body.points, body.law);
    if (body.held) parts += fmt::format("[[support]]\nnode = \"{}\"\nfixed = [\"ux\"]\n", body.name);
  }
  return fmt::format(R"(title = "bodies"
bonded = false
method = "lagrange"
{}{}[gravity]
acceleration = [0, -9.81]
[[function]]
name = "shake"
shape = {{ type = "harmonic", frequency = 5.36, end = 0.56 }}
[[ground_acceleration]]
function = "shake"
direction = [1, 0]
amplitude = 6
[[output.history]]
node = "{}"
quantity = "ux"
name = "path"
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = {}
step = {}
)",
                     nodes, parts, bodies.front().name, duration, step);
}

// The first rise of the block takes the force of the beginning of its step over half a step: energy that no impact before has taken.
TEST(ContactBalance, ContactGivesBackNoMoreThanItHasTaken) {
  for (const double step : {0.01, 0.015, 0.02}) {
    const RunResult result = run_on(shaken({{"rocker", 8.5, 2, unilateral, true}}, step), {});
    EXPECT_EQ(result.status, RunStatus::completed) << result.reason;
    EXPECT_GT(result.max_opening.value, 1e-4) << step;
    EXPECT_LE(result.energy_created, 1e-7 * result.energy_scale) << step;
    EXPECT_GE(result.final_energy.impact, -1e-7 * result.energy_scale) << step;
  }
}

// A low block slides to and fro and does not lift off: what the ground puts in, friction and the ends of slips take.
TEST(ContactBalance, FrictionThatTurnsRoundGivesNothingBack) {
  for (const double step : {0.01, 0.03, 0.048}) {
    const RunResult result = run_on(shaken({{"slider", 1, 8, R"(type = "coulomb", friction = 0.17)"}}, step), {});
    EXPECT_EQ(result.status, RunStatus::completed) << result.reason;
    EXPECT_LT(result.max_opening.value, 1e-12);
    EXPECT_LE(result.energy_created, 1e-8 * result.energy_scale) << step;
    EXPECT_GT(result.final_energy.friction, 0.9 * result.energy_scale) << step;
  }
}

// What a step drops for one body is of no concern to another one.
TEST(ContactBalance, BodiesWithoutConnectionMoveAsIfAlone) {
  for (const double step : {0.015, 0.02, 0.04, 0.048}) {
    const Body slider{"slider", 1, 8, R"(type = "coulomb", friction = 0.17)"}, rocker{"rocker", 8.5, 2, unilateral, true};
    const RunResult alone = run_on(shaken({slider}, step, 1), {}), beside = run_on(shaken({slider, rocker}, step, 1), {});
    const auto one = history(alone, "path"), other = history(beside, "path");
    ASSERT_EQ(one.size(), other.size());
    double largest = 0;
    for (const double x : one) largest = std::max(largest, std::abs(x));
    for (std::size_t i = 0; i < one.size(); ++i) ASSERT_NEAR(one[i], other[i], 1e-9 * largest) << step << ' ' << i;
  }
}

// Under a horizontal load, whatever its direction, a column presses with its weight as long as its base stays on the ground: in the steps
// where a part of the points bears nothing too.
TEST(ContactBalance, AColumnPressesWithItsWeight) {
  constexpr double raft = 1636352, mass = 282442, weight = 9.81 * (raft + 3 * mass);
  for (const double load : {8.7e6, -8.7e6, 8.8e6, -8.8e6}) {
    const std::string text = fmt::format(R"(title = "column"
bonded = false
method = "lagrange"
[nodes]
base = [0, 0]
n0 = [0, 3.26]
n1 = [0, 6.52]
n2 = [0, 9.78]
[[beam]]
name = "b0"
nodes = ["base", "n0"]
E = 3e10
I = 44.6
[[beam]]
name = "b1"
nodes = ["n0", "n1"]
E = 3e10
I = 56.5
A = 678
[[beam]]
name = "b2"
nodes = ["n1", "n2"]
E = 3e10
I = 45
A = 185
[[mass]]
node = "n0"
mass = {1}
[[mass]]
node = "n1"
mass = {1}
[[mass]]
node = "n2"
mass = {1}
inertia = 4.36e6
[[rigid]]
name = "raft"
node = "base"
mass = {0}
inertia = 3.325e7
[[interface]]
name = "ground"
footing = {{ body = "base", width = 12.17, thickness = 8.4, points = 11, rule = "gauss" }}
law = {{ type = "coulomb", friction = 0.49 }}
[gravity]
acceleration = [0, -9.81]
[[function]]
name = "push"
shape = {{ type = "harmonic", frequency = 25, end = 0.12 }}
[[load]]
node = "n2"
force = [{2}, 0]
function = "push"
[damping]
rayleigh = [{{ frequency = 14.1, ratio = 0.05 }}]
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 0.28
step = 7e-4
p_delta = true
)",
                                         raft, mass, load);
    const RunResult result = run_on(text, {});
    ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
    EXPECT_LT(result.max_opening.value, 1e-12);
    const auto axial = history(result, "ground.axial");
    ASSERT_GT(axial.size(), 300u);
    for (std::size_t i = 0; i < axial.size(); ++i) ASSERT_NEAR(axial[i], -weight, 1e-8 * weight) << i << ' ' << load;
  }
}

// A rigid block that slides one way presses by the same forces all the time: directions of its slips that differ by round-off tell nothing
// of how the points share the force.
TEST(ContactBalance, ABlockThatSlidesOnPressesEvenly) {
  constexpr double mass = 415, friction = 0.198, weight = 9.81 * mass;
  const RunResult result = run_on(R"(title = "slide"
bonded = false
method = "lagrange"
[nodes]
base = [0, 0, 0]
[[rigid]]
name = "raft"
node = "base"
mass = 415
inertias = [98.86, 103, 44.73]
centre = [0, 0.039, 0.754]
[[interface]]
name = "ground"
footing = { body = "base", width = 0.841, points = 5, rule = "gauss", length = 0.766, points_across = 2 }
law = { type = "coulomb", friction = 0.198 }
[gravity]
acceleration = [0, 0, -9.81]
[[function]]
name = "shake"
shape = { type = "half_sine", duration = 0.214 }
[[ground_acceleration]]
function = "shake"
direction = [1, 0, 0]
amplitude = 7.47
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 0.25
step = 1.464e-3
)",
                                  {});
  ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
  const auto shear = history(result, "ground.shear"), pressure = history(result, "ground.max_pressure");
  double first = 0;
  int slides = 0;
  for (std::size_t i = 0; i < shear.size(); ++i) {
    if (std::abs(shear[i] - friction * weight) > 1e-6 * weight) continue;
    if (slides++ == 0) first = pressure[i];
    EXPECT_NEAR(pressure[i], first, 1e-5 * first) << i;
  }
  EXPECT_GT(slides, 100);
}

}  // namespace
}  // namespace uplift::contact_balance_test
