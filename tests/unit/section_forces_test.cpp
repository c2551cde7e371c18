// Section forces, storey shears, drifts and reactions against free bodies: masses times accelerations from the recorded velocities.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "text_support.h"
#include "uplift/analysis/case.h"
#include "uplift/elements/space_beam.h"
#include "uplift/io/toml.h"

namespace uplift {
namespace {

using Column = std::vector<double>;

struct Ran {
  Built built;
  RunResult result;
  const Column& operator[](const std::string& name) const {
    for (std::size_t k = 0; k < result.columns.size(); ++k)
      if (result.columns[k].name == name) return result.table[k + 1];
    ADD_FAILURE() << "no column " << name;
    return result.table[0];
  }
  std::size_t rows() const { return result.table[0].size(); }
};

Ran run_text(const std::string& text) {
  static std::vector<std::unique_ptr<Case>> kept;  // a model points into its case
  kept.push_back(std::make_unique<Case>(check_case(read_toml_text(text, "case.toml"), "case.toml")));
  Ran ran{build(*kept.back(), runs_of_case(*kept.back()).front()), {}};
  ran.result = run(ran.built.model, ran.built.plan, ran.built.behaviours);
  EXPECT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
  EXPECT_LT(ran.result.equilibrium.residual, 1e-9);
  EXPECT_FALSE(ran.result.equilibrium.instants.empty());
  return ran;
}

std::string history(const std::string& keys) {
  return "[[output.history]]\n" + keys + "\n";
}
std::string node_histories(const std::vector<std::string>& nodes, const std::vector<std::string>& quantities) {
  std::string text;
  for (const std::string& node : nodes)
    for (const std::string& quantity : quantities) text += history(fmt::format("node = \"{}\"\nquantity = \"{}\"", node, quantity));
  return text;
}

/// Every step after the first row: |column - expected(step)| <= 1e-9 of the peak. The expected value is of the step from row i - 1 to i.
void expect_column(const Ran& ran, const Column& column, const std::function<double(std::size_t)>& expected, const std::string& what,
                   double floor = 0) {
  double peak = floor, error = 0;
  for (std::size_t i = 1; i < ran.rows(); ++i) {
    peak = std::max(peak, std::abs(column[i]));
    error = std::max(error, std::abs(column[i] - expected(i)));
  }
  EXPECT_GT(peak, 0) << what;
  EXPECT_LT(error, 1e-9 * peak) << what << ", peak " << peak;
}

constexpr double dt = 2e-3;
/// Derivative over the step and mean of both ends.
double rate(const Column& column, std::size_t i) {
  return (column[i] - column[i - 1]) / dt;
}
double mean(const Column& column, std::size_t i) {
  return (column[i] + column[i - 1]) / 2;
}

constexpr const char* shaking = R"(
[[function]]
name = "shake"
shape = { type = "ricker", frequency = "2 Hz", delay = "0.4 s" }
[[stage]]
type = "dynamic"
duration = 1
step = 2e-3
)";
double shake(double t) {  // of functions.cpp, written down again
  const double a = std::pow(M_PI * 2 * (t - 0.4), 2);
  return (1 - 2 * a) * std::exp(-a);
}

// ---- a cantilever in the plane with distributed mass ----

constexpr const char* mast = R"(title = "mast"
[nodes]
foot = [0, 0]
head = [0, 12]
[[beam]]
name = "mast"
nodes = ["foot", "head"]
E = 2e10
I = 0.05
A = 0.8
density = 2500
mass = "consistent"
elements = 2
THEORY
[[mass]]
node = "head"
mass = 4000
inertia = 900
[[support]]
node = "foot"
fixed = ["ux", "uy", "rz"]
[damping]
rayleigh = [{ frequency = "1 Hz", ratio = 0.03 }, { frequency = "20 Hz", ratio = 0.05 }]
[output]
automatic = false
energies = false
)";

/// Hermite interpolation of nodal (w, r) over a length.
double hermite(double s, double l, double w0, double r0, double w1, double r1) {
  const double x = s / l;
  return (1 - 3 * x * x + 2 * x * x * x) * w0 + l * (x - 2 * x * x + x * x * x) * r0 + (3 * x * x - 2 * x * x * x) * w1 +
         l * (x * x * x - x * x) * r1;
}

TEST(SectionForces, MastWithDistributedMassBalancesTheFreeBodyAboveEverySection) {
  std::string text = support::replaced(mast, "THEORY", "");
  text += "[[ground_acceleration]]\nname = \"quake\"\ndirection = [1, 0]\namplitude = 3\nfunction = \"shake\"\n";
  text += std::string(shaking);
  text += node_histories({"foot", "mast.1", "head"}, {"ux", "vx", "vrz"});
  const std::vector<double> levels{0, 2.5, 6, 9.5, 12};
  for (const double z : levels) {
    text += history(fmt::format("beam = \"mast\"\nposition = {}\nquantity = \"shear\"", z));
    text += history(fmt::format("beam = \"mast\"\nposition = {}\nquantity = \"moment\"", z));
    if (z < 12) text += history(fmt::format("level = {}\nquantity = \"storey_shear\"", z));
  }
  text += node_histories({"foot"}, {"reaction_x", "reaction_y", "reaction_moment"});
  const Ran ran = run_text(text);
  const double alpha = ran.built.model.assembly.mass_damping;
  EXPECT_GT(alpha, 0);
  const double rho = 2500 * 0.8;
  // deflection rate, rotation rate and their mean values at the three nodes; w is the displacement to the left, -ux
  const std::vector<std::string> nodes{"foot", "mast.1", "head"};
  const auto inertia_of = [&](std::size_t i, double z, double& force, double& moment) {
    // absolute acceleration plus alpha times the mean velocity, of the node's w and r
    double w[3], r[3];
    const double ground = -3 * (shake(dt * static_cast<double>(i)) + shake(dt * static_cast<double>(i - 1))) / 2;
    for (int k = 0; k < 3; ++k) {
      if (k == 0) {
        w[k] = ground, r[k] = 0;
        continue;
      }
      const std::string& node = nodes[static_cast<std::size_t>(k)];
      w[k] = -(rate(ran[node + ".vx"], i) + alpha * mean(ran[node + ".vx"], i)) + ground;
      r[k] = rate(ran[node + ".vrz"], i) + alpha * mean(ran[node + ".vrz"], i);
    }
    force = 4000 * w[2], moment = 4000 * w[2] * (12 - z) + 900 * r[2];
    for (int e = 0; e < 2; ++e) {
      const double from = std::max(z, 6.0 * e), to = 6.0 * (e + 1);
      if (from >= to) continue;
      const int points = 400;  // Simpson's rule, far finer than the cubic needs
      for (int p = 0; p <= points; ++p) {
        const double h = from + (to - from) * p / points, weight = (to - from) / points / 3 * (p == 0 || p == points ? 1 : p % 2 ? 4 : 2);
        const double a = hermite(h - 6.0 * e, 6, w[e], r[e], w[e + 1], r[e + 1]);
        force += weight * rho * a;
        moment += weight * rho * a * (h - z);
      }
    }
  };
  for (const double z : levels) {
    // the part above: its inertia is what the part below exerts on it; the section force is the opposite
    const auto value = [&](std::size_t i, bool of_moment) {
      double force = 0, moment = 0;
      inertia_of(i, z, force, moment);
      return of_moment ? -moment : -force;
    };
    expect_column(
        ran, ran[fmt::format("mast.{:.6g}.shear", z)], [&](std::size_t i) { return value(i, false); }, fmt::format("shear at {}", z));
    expect_column(
        ran, ran[fmt::format("mast.{:.6g}.moment", z)], [&](std::size_t i) { return value(i, true); }, fmt::format("moment at {}", z),
        z == 12 ? 1e5 : 0);
    if (z < 12)  // along x, where the local y points to -x
      expect_column(
          ran, ran[fmt::format("storey_shear.{:.6g}", z)], [&](std::size_t i) { return -value(i, false); }, "storey shear");
  }
  // the support pushes back what the section exerts on it; the two halves of Rayleigh's alpha at the foot itself are zero
  expect_column(
      ran, ran["foot.reaction_x"], [&](std::size_t i) { return ran["mast.0.shear"][i]; }, "reaction");
  expect_column(
      ran, ran["foot.reaction_moment"], [&](std::size_t i) { return -ran["mast.0.moment"][i]; }, "reaction moment");
}

TEST(SectionForces, WeightOfACantileverGivesTheParabola) {
  // statics: N = -q (L - x) standing, M = -q (L - x)^2 / 2 and V = q (L - x) lying along x; Timoshenko does not matter
  for (const char* theory : {"", "theory = \"timoshenko\"\nshear_area = 0.3"}) {
    std::string standing = support::replaced(mast, "THEORY", theory);
    standing = support::replaced(standing, "mass = 4000\ninertia = 900", "mass = 1e-9");
    standing += "[gravity]\nacceleration = [0, -10]\n[[stage]]\ntype = \"static\"\n";
    std::string lying = support::replaced(standing, "head = [0, 12]", "head = [12, 0]");
    for (const double x : {0.0, 1.3, 6.0, 7.7})
      for (const char* word : {"axial", "shear", "moment"}) {
        const std::string more = history(fmt::format("beam = \"mast\"\nposition = {}\nquantity = \"{}\"", x, word));
        standing += more, lying += more;
      }
    const Ran up = run_text(standing), along = run_text(lying);
    const double q = 2500 * 0.8 * 10, total = q * 12;
    for (const double x : {0.0, 1.3, 6.0, 7.7}) {
      const auto name = [&](const char* word) { return fmt::format("mast.{:.6g}.{}", x, word); };
      const double rest = 12 - x;
      EXPECT_NEAR(up[name("axial")][0], -q * rest, 1e-9 * total);
      EXPECT_NEAR(up[name("shear")][0], 0, 1e-9 * total);
      EXPECT_NEAR(along[name("axial")][0], 0, 1e-9 * total);
      // the part beyond pulls the part before it down, and turns it clockwise: tension on the upper side
      EXPECT_NEAR(along[name("shear")][0], -q * rest, 1e-9 * total);
      EXPECT_NEAR(along[name("moment")][0], -q * rest * rest / 2, 1e-9 * total * 12);
    }
  }
}

// ---- a portal: two storeys of columns of different stiffness, a girder, masses; bases that move ----

constexpr const char* portal = R"(title = "portal"
[nodes]
a0 = [0, 0]
a1 = [0, 4]
b0 = [6, 0]
b1 = [6, 4]
c = [3, 4]
[[beam]]
name = "left"
nodes = ["a0", "a1"]
E = 3e10
I = 0.004
A = 0.16
damping_beta = 2e-3
[[beam]]
name = "right"
nodes = ["b1", "b0"]
E = 3e10
I = 0.001
A = 0.16
[[beam]]
name = "girder"
nodes = ["a1", "b1"]
E = 3e10
I = 0.006
GIRDER
density = 2500
mass = "consistent"
elements = 2
[[mass]]
node = "a1"
mass = 5000
inertia = 300
[[mass]]
node = "b1"
mass = 8000
[[support]]
node = "a0"
fixed = ["rz"]
[[support]]
node = "b0"
fixed = ["rz"]
[output]
automatic = false
energies = false
[gravity]
acceleration = [0, -9.81]
[[stage]]
type = "static"
)";

std::string moving_bases() {
  std::string text;
  for (const char* node : {"a0", "b0"}) {
    text += fmt::format("[[motion]]\nnode = \"{}\"\ndirection = \"ux\"\namplitude = 0.05\nfunction = \"shake\"\n", node);
    text += fmt::format("[[motion]]\nnode = \"{}\"\ndirection = \"uy\"\namplitude = 0.01\nfunction = \"shake\"\n", node);
  }
  return text;
}

TEST(SectionForces, PortalOnMovingBasesBalancesItsMassesAndItsJoints) {
  std::string text = support::replaced(portal, "GIRDER", "A = 0.2");
  text += moving_bases() + shaking;
  text += node_histories({"a1", "b1", "girder.1"}, {"ux", "uy", "vx", "vy", "vrz"});
  text += history("level = 2\nquantity = \"storey_shear\"") + history("level = 0\nquantity = \"storey_shear\"");
  for (const char* word : {"axial", "shear", "moment"})
    text += history(fmt::format("beam = \"left\"\nposition = 4\nquantity = \"{}\"", word)) +
            history(fmt::format("beam = \"girder\"\nposition = 0\nquantity = \"{}\"", word)) +
            history(fmt::format("beam = \"right\"\nposition = 4\nquantity = \"{}\"", word));
  text += node_histories({"a0", "b0"}, {"reaction_x", "reaction_y", "reaction_moment"});
  text += history("node = \"a1\"\nbelow = \"a0\"\nquantity = \"drift_x\"") +
          history("node = \"a1\"\nbelow = \"a0\"\nquantity = \"drift_ratio_x\"");
  const Ran ran = run_text(text);
  // horizontal: point masses, and the girder as the integral of its consistent (linear) axial inertia
  const double rho = 2500 * 0.2, l = 3;
  const auto inertia_x = [&](std::size_t i) {
    const double a = rate(ran["a1.vx"], i), g = rate(ran["girder.1.vx"], i), b = rate(ran["b1.vx"], i);
    return 5000 * a + 8000 * b + rho * l * ((a + g) / 2 + (g + b) / 2);
  };
  for (const char* level : {"2", "0"})
    expect_column(
        ran, ran[std::string("storey_shear.") + level], [&](std::size_t i) { return -inertia_x(i); }, "storey shear");
  expect_column(
      ran, ran["a0.reaction_x"], [&](std::size_t i) { return inertia_x(i) - ran["b0.reaction_x"][i]; }, "horizontal reactions");
  const auto inertia_y = [&](std::size_t i) {  // with gravity; Hermite shapes integrate to l/2 (w0 + w1) + l^2/12 (r0 - r1)
    const double a = rate(ran["a1.vy"], i), g = rate(ran["girder.1.vy"], i), b = rate(ran["b1.vy"], i);
    const double ra = rate(ran["a1.vrz"], i), rg = rate(ran["girder.1.vrz"], i), rb = rate(ran["b1.vrz"], i);
    return 5000 * (a + 9.81) + 8000 * (b + 9.81) + rho * l * ((a + 2 * g + b) / 2 + 2 * 9.81) + rho * l * l / 12 * (ra - rg + rg - rb);
  };
  expect_column(
      ran, ran["a0.reaction_y"], [&](std::size_t i) { return inertia_y(i) - ran["b0.reaction_y"][i]; }, "vertical reactions");
  // the joint a1: what the column below and the girder exert on it, and its own mass. The girder's beginning: what lies beyond pulls.
  expect_column(
      ran, ran["left.4.axial"], [&](std::size_t i) { return ran["girder.0.shear"][i] - 5000 * (rate(ran["a1.vy"], i) + 9.81); },
      "joint, vertical");
  expect_column(
      ran, ran["left.4.shear"],  // local y of the column points to -x
      [&](std::size_t i) { return -ran["girder.0.axial"][i] + 5000 * rate(ran["a1.vx"], i); }, "joint, horizontal");
  expect_column(
      ran, ran["left.4.moment"], [&](std::size_t i) { return ran["girder.0.moment"][i] - 300 * rate(ran["a1.vrz"], i); }, "joint, moment");
  // "right" runs downwards: what lies beyond its end is the support, whose force is the reaction
  expect_column(
      ran, ran["right.4.axial"], [&](std::size_t i) { return -ran["b0.reaction_y"][i]; }, "axial force");
  expect_column(
      ran, ran["right.4.shear"], [&](std::size_t i) { return ran["b0.reaction_x"][i]; }, "shear, local y points to +x");
  expect_column(
      ran, ran["right.4.moment"], [&](std::size_t i) { return ran["b0.reaction_moment"][i]; }, "moment");
  for (std::size_t i = 0; i < ran.rows(); ++i) {
    const double drift = ran["a1.ux"][i] - 0.05 * shake(dt * static_cast<double>(i));
    EXPECT_NEAR(ran["a1.drift_x"][i], drift, 1e-14);
    EXPECT_NEAR(ran["a1.drift_ratio_x"][i], drift / 4, 1e-14);
  }
}

TEST(SectionForces, InextensibleGirderCarriesItsConstraintForce) {
  std::string text = support::replaced(portal, "GIRDER\ndensity = 2500\nmass = \"consistent\"\nelements = 2", "");
  text += "[[ground_acceleration]]\nname = \"quake\"\ndirection = [1, 0]\namplitude = 3\nfunction = \"shake\"\n";
  text = support::replaced(text, "fixed = [\"rz\"]", "fixed = [\"ux\", \"uy\", \"rz\"]");
  text = support::replaced(text, "fixed = [\"rz\"]", "fixed = [\"ux\", \"uy\", \"rz\"]");
  text = support::replaced(text, "c = [3, 4]\n", "");
  text += shaking + node_histories({"a1"}, {"vx"});
  for (const char* word : {"axial", "shear"})
    text += history(fmt::format("beam = \"left\"\nposition = 4\nquantity = \"{}\"", word)) +
            history(fmt::format("beam = \"girder\"\nposition = 3\nquantity = \"{}\"", word));
  const Ran ran = run_text(text);
  expect_column(
      ran, ran["girder.3.axial"],
      [&](std::size_t i) {
        const double ground = 3 * (shake(dt * static_cast<double>(i)) + shake(dt * static_cast<double>(i - 1))) / 2;
        return -ran["left.4.shear"][i] + 5000 * (rate(ran["a1.vx"], i) + ground);
      },
      "axial force of an inextensible girder");
}

// ---- P-Delta ----

TEST(SectionForces, PDeltaMovesTheWeightToItsDisplacedPlace) {
  std::string text = support::replaced(mast, "THEORY", "");
  text = support::replaced(text, "density = 2500\nmass = \"consistent\"\n", "");  // the axial force is then the same everywhere
  text = support::replaced(text, "mass = 4000\n", "mass = 60000\n");
  text += "[gravity]\nacceleration = [0, -9.81]\n[[stage]]\ntype = \"static\"\n";
  text += "[[ground_acceleration]]\nname = \"quake\"\ndirection = [1, 0]\namplitude = 3\nfunction = \"shake\"\n";
  text += support::replaced(shaking, "step = 2e-3", "step = 2e-3\np_delta = true");
  text += node_histories({"mast.1", "head"}, {"ux", "vx", "vrz", "ux"});
  for (const double z : {0.0, 6.0})
    for (const char* word : {"shear", "moment"}) text += history(fmt::format("beam = \"mast\"\nposition = {}\nquantity = \"{}\"", z, word));
  text += node_histories({"foot"}, {"reaction_x", "reaction_moment"});
  const Ran ran = run_text(text);
  const double m = 60000, alpha = ran.built.model.assembly.mass_damping;
  for (const double z : {0.0, 6.0}) {
    const auto horizontal = [&](std::size_t i) {  // on the part below, along x
      const double ground = 3 * (shake(dt * static_cast<double>(i)) + shake(dt * static_cast<double>(i - 1))) / 2;
      return -m * (rate(ran["head.vx"], i) + ground + alpha * mean(ran["head.vx"], i));
    };
    const auto moment = [&](std::size_t i) {
      const double lever = mean(ran["head.ux"], i) - (z > 0 ? mean(ran["mast.1.ux"], i) : 0);
      return -(12 - z) * horizontal(i) - m * 9.81 * lever - 900 * (rate(ran["head.vrz"], i) + alpha * mean(ran["head.vrz"], i));
    };
    expect_column(
        ran, ran[fmt::format("mast.{:.6g}.shear", z)], [&](std::size_t i) { return -horizontal(i); }, "shear");
    expect_column(ran, ran[fmt::format("mast.{:.6g}.moment", z)], moment, "moment");
    // the lever of the weight is no small correction here
    double second = 0;
    for (const double u : ran["head.ux"]) second = std::max(second, m * 9.81 * std::abs(u));
    double first = 0;
    for (const double value : ran[fmt::format("mast.{:.6g}.moment", z)]) first = std::max(first, std::abs(value));
    EXPECT_GT(second, 1e-3 * first);
  }
  expect_column(
      ran, ran["foot.reaction_moment"], [&](std::size_t i) { return -ran["mast.0.moment"][i]; }, "reaction moment");
}

TEST(SectionForces, PDeltaKnowsOnlyDisplacementsRelativeToTheBase) {
  // the same structure in the frame of its base and in a frame in which the base moves: the same forces. Without damping, since Rayleigh's
  // mass damping acts on velocities in the frame
  std::string text = support::replaced(mast, "THEORY", "");
  text = support::replaced(text, "rayleigh = [{ frequency = \"1 Hz\", ratio = 0.03 }, { frequency = \"20 Hz\", ratio = 0.05 }]\n", "");
  text = support::replaced(text, "mass = 4000\n", "mass = 60000\n");
  text += "[gravity]\nacceleration = [0, -9.81]\n[[stage]]\ntype = \"static\"\n";
  text += "[[stage]]\ntype = \"dynamic\"\nduration = 1\nstep = 2e-3\np_delta = true\n";
  text += history("beam = \"mast\"\nposition = 3\nquantity = \"moment\"");
  // d = 0.2 sin(w t) - 0.2 w t starts at rest; its acceleration is -0.2 w^2 sin(w t)
  const auto wave = [](const char* name, double amplitude) {
    return fmt::format("[[function]]\nname = \"{}\"\nshape = {{ type = \"harmonic\", frequency = 1.5, amplitude = {:.17g} }}\n", name,
                       amplitude);
  };
  const double w = 3 * M_PI;
  const Ran relative =
      run_text(text + wave("a", -0.2 * w * w) + "[[ground_acceleration]]\nname = \"quake\"\ndirection = [1, 0]\nfunction = \"a\"\n");
  std::string moving = support::replaced(text, "fixed = [\"ux\", \"uy\", \"rz\"]", "fixed = [\"uy\", \"rz\"]");
  moving += wave("d", 0.2) + "[[motion]]\nnode = \"foot\"\ndirection = \"ux\"\nfunction = \"d\"\n";
  // the base starts with 0.2 w: so does everything on it
  for (const char* node : {"head", "mast.1"}) moving += fmt::format("[[initial]]\nnode = \"{}\"\nvelocity = [{:.17g}, 0]\n", node, 0.2 * w);
  const Ran absolute = run_text(moving);
  const Column& expected = relative["mast.3.moment"];
  double peak = 0, error = 0;
  for (std::size_t i = 1; i < expected.size(); ++i) {
    peak = std::max(peak, std::abs(expected[i]));
    error = std::max(error, std::abs(absolute["mast.3.moment"][i] - expected[i]));
  }
  // the rule takes the sine of the base's own motion as its load and not as its kinematics: second order in the step, here 1e-4
  EXPECT_LT(error, 1e-3 * peak);
}

// ---- in space: a leaning Timoshenko beam with distributed mass, shaken in all directions ----

TEST(SectionForces, LeaningBeamInSpaceHandsToItsSupportWhatItsSectionsCarry) {
  std::string text = R"(title = "leaning"
[nodes]
foot = [0, 0, 0]
head = [3, 2, 6]
[[beam]]
name = "mast"
nodes = ["foot", "head"]
E = 2e10
I_y = 0.03
I_z = 0.05
J = 0.04
A = 0.8
theory = "timoshenko"
shear_area = 0.5
density = 2500
mass = "MASS"
[[mass]]
node = "head"
mass = 4000
inertias = [800, 500, 900]
[[support]]
node = "foot"
fixed = ["ux", "uy", "uz", "rx", "ry", "rz"]
[gravity]
acceleration = [0, 0, -9.81]
[output]
automatic = false
energies = false
[[stage]]
type = "static"
)" + std::string(shaking);
  for (const char* direction : {"[3, 0, 0]", "[0, -2, 0]", "[0, 0, 1]"})
    text += fmt::format("[[ground_acceleration]]\nname = \"quake {0}\"\ndirection = {0}\nfunction = \"shake\"\n", direction);
  for (const double x : {0.0, 7.0})
    for (const char* word : {"axial", "shear_y", "shear_z", "torsion", "moment_y", "moment_z", "moment"})
      text += history(fmt::format("beam = \"mast\"\nposition = {}\nquantity = \"{}\"", x, word));
  text += node_histories({"foot"}, {"reaction_x", "reaction_y", "reaction_z", "reaction_mx", "reaction_my", "reaction_mz"});
  text += node_histories({"head"}, {"vx", "vy", "vz", "vrx", "vry", "vrz"});
  text += history("level = 0\nquantity = \"storey_shear_x\"") + history("level = 0\nquantity = \"storey_shear_y\"");
  for (const char* mass : {"consistent", "lumped", "none"}) {
    const Ran ran = run_text(support::replaced(text, "MASS", mass));
    const Vec3 head(3, 2, 6), along = head / 7;
    const Mat3 axes = beam_axes(head, std::nullopt).value();
    const auto of = [&](const char* x, std::size_t i) {
      const std::string start = std::string("mast.") + x + ".";
      const Vec3 force(ran[start + "axial"][i], ran[start + "shear_y"][i], ran[start + "shear_z"][i]);
      const Vec3 moment(ran[start + "torsion"][i], ran[start + "moment_y"][i], ran[start + "moment_z"][i]);
      return std::pair(Vec3(axes.transpose() * force), Vec3(axes.transpose() * moment));
    };
    double force_peak = 0, moment_peak = 0, foot_error = 0, head_error = 0, foot_moment_error = 0, head_moment_error = 0;
    for (std::size_t i = 1; i < ran.rows(); ++i) {
      const auto [foot_force, foot_moment] = of("0", i);
      const Vec3 reaction(ran["foot.reaction_x"][i], ran["foot.reaction_y"][i], ran["foot.reaction_z"][i]);
      const Vec3 turning(ran["foot.reaction_mx"][i], ran["foot.reaction_my"][i], ran["foot.reaction_mz"][i]);
      foot_error = std::max(foot_error, (reaction + foot_force).norm());
      foot_moment_error = std::max(foot_moment_error, (turning + foot_moment).norm());
      EXPECT_NEAR(ran["mast.0.moment"][i], std::hypot(ran["mast.0.moment_y"][i], ran["mast.0.moment_z"][i]), 1e-6);
      EXPECT_NEAR(ran["storey_shear_x.0"][i], foot_force.x(), 1e-9 * (1 + foot_force.norm()));
      // the mass at the head: what the section before it feels
      const double time = shake(dt * static_cast<double>(i)) + shake(dt * static_cast<double>(i - 1));
      const Vec3 acceleration =
          Vec3(rate(ran["head.vx"], i), rate(ran["head.vy"], i), rate(ran["head.vz"], i)) + Vec3(3, -2, 1) * time / 2 + Vec3(0, 0, 9.81);
      const Vec3 turn(800 * rate(ran["head.vrx"], i), 500 * rate(ran["head.vry"], i), 900 * rate(ran["head.vrz"], i));
      const auto [head_force, head_moment] = of("7", i);
      head_error = std::max(head_error, (head_force + 4000 * acceleration).norm());
      head_moment_error = std::max(head_moment_error, (head_moment + turn).norm());
      force_peak = std::max(force_peak, foot_force.norm());
      moment_peak = std::max(moment_peak, foot_moment.norm());
    }
    EXPECT_LT(foot_error, 1e-9 * force_peak) << mass;
    EXPECT_LT(head_error, 1e-9 * force_peak) << mass;
    EXPECT_LT(foot_moment_error, 1e-9 * moment_peak) << mass;
    EXPECT_LT(head_moment_error, 1e-9 * moment_peak) << mass;
    EXPECT_GT(std::abs(along.x()), 0);
  }
}

// ---- on a joint that opens ----

constexpr const char* rocking = R"(title = "rocking"
[nodes]
base = [0, 0]
deck = [0, 10]
[[beam]]
name = "pier"
nodes = ["base", "deck"]
E = 3e10
I = 0.7
A = 3.8
density = 2500
mass = "consistent"
elements = 3
[[mass]]
node = "deck"
mass = 3e5
[[rigid]]
name = "footing"
node = "base"
mass = 1e5
inertia = 4e5
[[interface]]
name = "soil"
footing = { body = "base", width = 6, thickness = 6, points = 21 }
LAW
[gravity]
acceleration = [0, -9.81]
[[stage]]
type = "static"
[output]
automatic = false
energies = false
[[ground_acceleration]]
name = "quake"
direction = [1, 0]
amplitude = 5
function = "shake"
)";

TEST(SectionForces, FootOfAPierPlusTheInertiaOfItsFootingIsWhatTheJointCarries) {
  std::string text =
      support::replaced(rocking, "LAW", "law = { type = \"springs\", K_n = 1e8, K_t = 1e8, tangential = \"elastic\" }") + shaking;
  for (const char* word : {"axial", "shear", "moment"})
    text += history(fmt::format("beam = \"pier\"\nposition = 0\nquantity = \"{}\"", word));
  text += node_histories({"base"}, {"vx", "vy", "vrz"});
  for (int point = 1; point <= 21; ++point)
    for (const char* word : {"mean_traction", "mean_shear_traction"})
      text += history(fmt::format("interface = \"soil\"\npoint = {}\nquantity = \"{}\"", point, word));
  text += history("interface = \"soil\"\nquantity = \"uplifted_ratio\"");
  text += "[[output.beam_envelope]]\nbeam = \"pier\"\n";
  const Ran ran = run_text(text);
  const Interface& joint = ran.built.model.interfaces.front();
  const auto sum = [&](const char* word, std::size_t i, bool lever) {
    double total = 0;
    for (std::size_t k = 0; k < 21; ++k)
      total += ran[fmt::format("soil.{}.{}", k + 1, word)][i] * joint.area[static_cast<Index>(k)] * (lever ? joint.position[k].x() : 1);
    return total;
  };
  double open = 0;
  for (const double share : ran["soil.uplifted_ratio"]) open = std::max(open, share);
  EXPECT_GT(open, 0.2);  // it rocks
  // the footing: the pier's section acts on it, the joint pulls it with the opposite of its traction
  expect_column(
      ran, ran["pier.0.axial"], [&](std::size_t i) { return sum("mean_traction", i, false) + 1e5 * (rate(ran["base.vy"], i) + 9.81); },
      "axial force");
  expect_column(
      ran, ran["pier.0.shear"],
      [&](std::size_t i) {
        const double ground = 5 * (shake(dt * static_cast<double>(i)) + shake(dt * static_cast<double>(i - 1))) / 2;
        const double along = local_axis(joint.space, joint.normal.front(), 0).x();
        return -(along * sum("mean_shear_traction", i, false) + 1e5 * (rate(ran["base.vx"], i) + ground));
      },
      "shear");
  expect_column(
      ran, ran["pier.0.moment"], [&](std::size_t i) { return sum("mean_traction", i, true) + 4e5 * rate(ran["base.vrz"], i); }, "moment");
  // the envelope knows the extremes of every step
  const BeamEnvelope& envelope = ran.result.envelopes.at(0);
  ASSERT_EQ(envelope.components.size(), 3U);
  EXPECT_DOUBLE_EQ(envelope.at(0, 2).most, *std::ranges::max_element(ran["pier.0.moment"]));
  EXPECT_DOUBLE_EQ(envelope.at(0, 2).least, *std::ranges::min_element(ran["pier.0.moment"]));
  EXPECT_DOUBLE_EQ(envelope.at(0, 1).most, *std::ranges::max_element(ran["pier.0.shear"]));
  EXPECT_EQ(envelope.sections.front().along, 0);
  EXPECT_DOUBLE_EQ(envelope.sections.back().along, 10);
}

TEST(SectionForces, EquilibriumHoldsForOtherSchemesAndForConstraints) {
  for (const char* law : {"law = { type = \"springs\", K_n = 1e8, tangential = \"none\" }", "law = { type = \"contact\" }"})
    for (const char* scheme :
         {"scheme = { type = \"hht\", alpha = -0.1 }", "scheme = { type = \"generalised_alpha\", rho = 0.6 }", "traction = \"end\""}) {
      std::string text = support::replaced(rocking, "LAW", law);
      text += support::replaced(shaking, "step = 2e-3", std::string("step = 2e-3\n") + scheme);
      text += "[[support]]\nnode = \"base\"\nfixed = [\"ux\"]\n";
      if (std::string(law).find("contact") != std::string::npos) text += "[method]\ntype = \"lagrange\"\n";
      text += node_histories({"base"}, {"reaction_x"}) + history("beam = \"pier\"\nposition = 0\nquantity = \"shear\"");
      run_text(text);
    }
}

// ---- what is refused ----

TEST(SectionForces, RefusesWhatTheModelDoesNotHave) {
  const auto said = [](const std::string& keys) {
    const std::string text = support::replaced(portal, "GIRDER", "A = 0.2") + moving_bases() + shaking + history(keys);
    return support::refusal_of([&] { run_text(text); });
  };
  EXPECT_NE(said("beam = \"lefd\"\nposition = 1\nquantity = \"moment\"").find("did you mean \"left\""), std::string::npos)
      << said("beam = \"lefd\"\nposition = 1\nquantity = \"moment\"");
  EXPECT_NE(said("beam = \"left\"\nposition = 4.2\nquantity = \"moment\"").find("at most 4 m"), std::string::npos);
  EXPECT_NE(said("beam = \"left\"\nposition = 1\nquantity = \"moment_y\"").find("axial, shear, moment"), std::string::npos);
  EXPECT_NE(said("level = 5\nquantity = \"storey_shear\"").find("from 0 m to below 4 m"), std::string::npos);
  EXPECT_NE(said("node = \"a1\"\nquantity = \"reaction_x\"").find("which none holds"), std::string::npos);
  EXPECT_NE(said("node = \"a0\"\nbelow = \"a1\"\nquantity = \"drift_x\"").find("a node below"), std::string::npos);
}

}  // namespace
}  // namespace uplift
