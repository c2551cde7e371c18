// Section forces, storey shears, drifts and reactions in the plane against free bodies: masses times accelerations from the recorded
// velocities.
#include "unit/run/section_forces_support.h"

namespace uplift::section_forces_test {
namespace {

using namespace support;

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
  const Ran ran = run_balanced(text);
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
    const Ran up = run_balanced(standing), along = run_balanced(lying);
    const double q = 2500 * 0.8 * 10, total = q * 12;
    for (const double x : {0.0, 1.3, 6.0, 7.7}) {
      const auto name = [&](const char* word) { return fmt::format("mast.{:.6g}.{}", x, word); };
      const double rest = 12 - x;
      EXPECT_NEAR(up[name("axial")].back(), -q * rest, 1e-9 * total);
      EXPECT_NEAR(up[name("shear")].back(), 0, 1e-9 * total);
      EXPECT_NEAR(along[name("axial")].back(), 0, 1e-9 * total);
      // the part beyond pulls the part before it down, and turns it clockwise: tension on the upper side
      EXPECT_NEAR(along[name("shear")].back(), -q * rest, 1e-9 * total);
      EXPECT_NEAR(along[name("moment")].back(), -q * rest * rest / 2, 1e-9 * total * 12);
      EXPECT_NEAR(along[name("moment")][5], -q * rest * rest / 4, 1e-9 * total * 12);  // at the load factor 0.5
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
  const Ran ran = run_balanced(text);
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
  const Ran ran = run_balanced(text);
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
  const Ran ran = run_balanced(text);
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
      run_balanced(text + wave("a", -0.2 * w * w) + "[[ground_acceleration]]\nname = \"quake\"\ndirection = [1, 0]\nfunction = \"a\"\n");
  std::string moving = support::replaced(text, "fixed = [\"ux\", \"uy\", \"rz\"]", "fixed = [\"uy\", \"rz\"]");
  moving += wave("d", 0.2) + "[[motion]]\nnode = \"foot\"\ndirection = \"ux\"\nfunction = \"d\"\n";
  // the base starts with 0.2 w: so does everything on it
  for (const char* node : {"head", "mast.1"}) moving += fmt::format("[[initial]]\nnode = \"{}\"\nvelocity = [{:.17g}, 0]\n", node, 0.2 * w);
  const Ran absolute = run_balanced(moving);
  const Column& expected = relative["mast.3.moment"];
  double peak = 0, error = 0;
  for (std::size_t i = 1; i < expected.size(); ++i) {
    peak = std::max(peak, std::abs(expected[i]));
    error = std::max(error, std::abs(absolute["mast.3.moment"][i] - expected[i]));
  }
  // the rule takes the sine of the base's own motion as its load and not as its kinematics: second order in the step, here 1e-4
  EXPECT_LT(error, 1e-3 * peak);
}

// ---- what is refused ----

TEST(SectionForces, RefusesWhatTheModelDoesNotHave) {
  const auto said = [](const std::string& keys) {
    const std::string text = support::replaced(portal, "GIRDER", "A = 0.2") + moving_bases() + shaking + history(keys);
    return support::refusal_of([&] { run_balanced(text); });
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
}  // namespace uplift::section_forces_test
