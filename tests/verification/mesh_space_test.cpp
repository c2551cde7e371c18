// Blocks, towers and soil in space against the same case seen otherwise: as a plane model, turned in plan, and with the step taken on all
// unknowns at once. No numbers of the program are expected here, only that they do not depend on the way.
#include <gtest/gtest.h>

#include "manual.h"
#include "mesh_support.h"
#include "uplift/mesh/soil_box.h"

namespace uplift::verification::mesh_space_test {
namespace {

constexpr double turned_by = 37 * pi / 180;

Vec3 turn(const Vec3& v, double angle) {
  return {std::cos(angle) * v.x() - std::sin(angle) * v.y(), std::sin(angle) * v.x() + std::cos(angle) * v.y(), v.z()};
}

struct Contact {
  const char *name, *law, *impact;
};
const Contact springs{"springs with friction", "{ type = \"springs\", K_n = 2e9, tangential = \"coulomb\", K_t = 1e9, friction = 0.4 }",
                      "none"};
const Contact sdm{"sdm with friction",
                  "{ type = \"sdm\", K_n = 2e9, F_u = 1e4, G_f = 5, F_c = -1e3, tangential = \"coulomb\", K_t = 1e9, friction = 0.4 }",
                  "none"};

const Contact held{"constraints", "\"unilateral\"", "project_hold"};
const Contact held_friction{"constraints with friction", "{ type = \"coulomb\", friction = 0.4 }", "project_hold"};

/// A block on soil, pushed at its top.
struct Block {
  SoilBox box;
  Contact contact = springs;
  Vec3 push{1.2e6, 0, 0};  // N in all, half a sine of 0.2 s
  double angle = 0;        // rad: mesh and push are turned by it
  bool slice = false;      // one element thick, nothing moves across
  std::string extra = {};
  double duration = 0.2, step = 2e-3;

  Mesh mesh() const {
    Mesh made = soil_box(box, {});
    for (Vec3& x : made.nodes) x = turn(x, angle);
    return made;
  }

  std::string text() const {
    const int d = box.dimension;
    const auto hold = [](const char* group, const char* fixed) {
      return fmt::format("[[support]]\ngroup = \"{}\"\nfixed = [{}]\n", group, fixed);
    };
    std::string out =
        "title = \"block\"\n[mesh]\nfile = \"block.msh\"\n[[solid]]\ngroup = \"soil_1\"\nE = 200e6\npoisson = 0.3\ndensity = "
        "2000\ndamping_beta = 1e-3\n[[solid]]\ngroup = \"block\"\nE = 20e9\npoisson = 0.2\ndensity = 2500\ndamping_beta = 1e-4\n";
    out += "[limits]\ngap_tolerance = 1e-9\n";  // by itself it is one of the size of the interface, to which a slice adds its thickness
    out += hold("soil_bottom", d == 2 ? "\"ux\", \"uy\"" : "\"ux\", \"uy\", \"uz\"");
    if (slice) out += hold("soil_1", "\"uy\"") + hold("block", "\"uy\"");
    for (const char* side : {"soil_left", "soil_right", "soil_front", "soil_back"})
      if (side[5] == 'l' || side[5] == 'r' || (d == 3 && !slice)) out += fmt::format("[[absorbing]]\ngroup = \"{}\"\n", side);
    out += fmt::format(
        "[[interface]]\nname = \"base\"\nsurface = {{ group = \"interface\", lower = [\"soil_1\"] }}\nlaw = {}\n[gravity]\nacceleration = "
        "{}\n[[function]]\nname = \"pulse\"\nshape = {{ type = \"half_sine\", duration = 0.2 }}\n[[load]]\nname = \"push\"\ngroup = "
        "\"block_top\"\nforce = {}\nfunction = \"pulse\"\n",
        contact.law, triple(d == 2 ? Vec3(0, -9.81, 0) : Vec3(0, 0, -9.81), d), triple(turn(push, angle), d));
    return "impact = \"" + std::string(contact.impact) + "\"\n" + out + extra +
           fmt::format(
               "[[stage]]\ntype = \"static\"\nsteps = 4\n[[stage]]\ntype = \"dynamic\"\nduration = {}\nstep = {}\n[energy]\ncreated_limit "
               "= 1e9\n[output]\nframes = 0\n",
               duration, step);
  }

  MeshRun run(const std::function<void(BuiltCase&)>& change = {}) const {
    MeshRun made = run_mesh(text(), mesh(), change);
    EXPECT_TRUE(made.completed()) << made.result.reason;
    return made;
  }
};

Block plane_block() {
  Block block;
  block.box.soil.width = {16, 1};
  block.box.soil.layers = {{6, 2}};
  block.box.soil.size = 2;
  block.box.block.size = 1;
  block.box.block.width = {4, 1};
  block.box.block.height = 10;
  return block;
}

/// Not square, pushed in no direction of symmetry: biaxial uplift.
Block space_block() {
  Block block = plane_block();
  block.box.dimension = 3;
  block.box.cell = Cell::hex8;
  block.box.soil.width = {12, 12};
  block.box.soil.layers = {{4, 2}};
  block.box.block.width = {4, 6};
  block.box.block.height = 8;
  block.box.block.size = 2;
  block.push = {5e6, 3e6, 0};
  return block;
}

double largest_difference = 0;  // of all that were looked at, for the record

/// Largest difference of factor * a and b over the rows, relative to the peak of a.
double difference(const std::vector<double>& a, const std::vector<double>& b, double factor = 1) {
  double worst = 0, peak = 0;
  EXPECT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(factor * a[i] - b[i])), peak = std::max(peak, std::abs(a[i]));
  const double relative = worst / peak;
  largest_difference = std::max(largest_difference, relative);
  return relative;
}

// Claim: a slice of one element, held across, is the plane strain model: motions, resultants and uplift ratio to 1e-8 of their peaks (quad4
// against hex8 with their bubbles, nodal joints, absorbing sides).
TEST(MeshSpace, ExtrusionGivesThePlaneAnswer) {
  VERIFIES({"Models in space", "A slice of one element is the plane model", "The plane-strain model of the program, verified on its own"});
  largest_difference = 0;
  for (const Contact& contact : {springs, sdm, held_friction}) {
    SCOPED_TRACE(contact.name);
    Block plane = plane_block();
    plane.contact = contact;
    Block slice = plane;
    slice.box.dimension = 3;
    slice.box.cell = Cell::hex8;
    slice.slice = true;
    const MeshRun two = plane.run(), three = slice.run();
    VERIFY_GT("uplifted share (the case uplifts)", "1", two.peak("base.uplifted_ratio"), 0.3);
    VERIFY_GT("largest gap", "m", two.peak("base.max_opening"), 1e-4);
    VERIFY_LT("difference of the horizontal motion over its peak", "1", difference(two["top.ux"], three["top.ux"]), 1e-8);
    VERIFY_LT("difference of the vertical motion over its peak", "1", difference(two["top.uy"], three["top.uz"]), 1e-8);
    VERIFY_LT("difference of the normal force over its peak", "1", difference(two["base.axial"], three["base.axial"]), 1e-8);
    VERIFY_LT("difference of the moment over its peak", "1", difference(two["base.moment"], three["base.moment_2"], -1),
              1e-8);  // about y: from z to x, against x to y of the plane
    VERIFY_LT("difference of the uplifted share over its peak", "1", difference(two["base.uplifted_ratio"], three["base.uplifted_ratio"]),
              1e-8);
    VERIFY_LT("difference of the largest gap over its peak", "1", difference(two["base.max_opening"], three["base.max_opening"]), 1e-8);
    VERIFY_LT("difference of the shear over its peak", "1", difference(two["base.shear"], three["base.shear_1"]), 1e-8);
  }
  RecordProperty("largest_difference", fmt::format("{:.1e}", largest_difference));
}

/// Compares a run with that of the same case turned about the vertical: vectors turn, scalars stay.
void expect_turned(const MeshRun& straight, const MeshRun& turned, double tolerance) {
  const double c = std::cos(turned_by), s = std::sin(turned_by);
  const std::size_t rows = straight.time().size();
  ASSERT_EQ(rows, turned.time().size());
  for (const auto& [x, y] :
       {std::pair{"top.ux", "top.uy"}, std::pair{"base.shear_1", "base.shear_2"}, std::pair{"base.moment_1", "base.moment_2"}}) {
    double worst = 0, peak = 0;
    for (std::size_t i = 0; i < rows; ++i) {
      const double a = straight[x][i], b = straight[y][i];
      worst = std::max({worst, std::abs(c * a - s * b - turned[x][i]), std::abs(s * a + c * b - turned[y][i])});
      peak = std::max(peak, std::hypot(a, b));
    }
    EXPECT_LT(worst, tolerance * peak) << x;
    largest_difference = std::max(largest_difference, worst / peak);
  }
  for (const char* scalar : {"top.uz", "base.axial", "base.max_opening", "base.uplifted_ratio", "base.max_pressure"})
    EXPECT_LT(difference(straight[scalar], turned[scalar]), tolerance) << scalar;
}

// Claim: mesh and load turned by 37 degrees in plan give the turned answer: 1e-10 of the peaks. Tangents of the joint are no principal
// directions: friction and stiffness are isotropic.
TEST(MeshSpace, TurnedMeshGivesTheTurnedAnswer) {
  VERIFIES({"Models in space", "A mesh turned in plan gives the turned answer", "Invariance under rotation"});
  largest_difference = 0;
  for (const Contact& contact : {springs, held_friction}) {
    SCOPED_TRACE(contact.name);
    Block block = space_block();
    block.contact = contact;
    block.duration = 0.12;
    Block turned = block;
    turned.angle = turned_by;
    const MeshRun one = block.run(), other = turned.run();
    VERIFY_GT("uplifted share (the case uplifts)", "1", one.peak("base.uplifted_ratio"), 0.1);
    expect_turned(one, other, 1e-10);
    VERIFY_LT("largest difference of vectors and scalars over their peaks", "1", largest_difference, 1e-10);
  }
  RecordProperty("largest_difference", fmt::format("{:.1e}", largest_difference));
}

/// An eccentric tower of beams on a rigid raft.
std::string tower(const Contact& contact, double angle, const char* bed) {
  const auto at = [&](double x, double y, double z) { return triple(turn({x, y, z}, angle), 3); };
  std::string out = fmt::format("impact = \"{}\"\ntitle = \"tower\"\n[nodes]\nbase = [0, 0, 0]\nknee = {}\ntop = {}\n", contact.impact,
                                at(0, 0, 4), at(1, 0.4, 9));
  for (const auto& [name, from, to] : {std::tuple{"stem", "base", "knee"}, std::tuple{"mast", "knee", "top"}})
    out += fmt::format(
        "[[beam]]\nname = \"{}\"\nnodes = [\"{}\", \"{}\"]\nE = 30e9\nA = 1.5\nI_y = 0.3\nI_z = 0.15\nJ = 0.25\nup = {}\nmass = "
        "\"consistent\"\ndensity = 2500\n",
        name, from, to, at(1, 0.3, 0));
  out += "[[mass]]\nnode = \"top\"\nmass = 6e4\n[[rigid]]\nname = \"raft\"\nnode = \"base\"\nmass = 9e4\ninertia = 3e5\n";
  out += fmt::format(
      "[[interface]]\nname = \"base\"\nfooting = {{ body = \"base\", width = 6, length = 4, points = 7, points_across = 5, azimuth = "
      "{:.17g}{} "
      "}}\nlaw = {}\n[gravity]\nacceleration = [0, 0, -9.81]\n[[function]]\nname = \"pulse\"\nshape = {{ type = \"half_sine\", duration = "
      "0.2 }}\n[[load]]\nnode = \"top\"\nforce = {}\nfunction = \"pulse\"\n",
      angle, bed, contact.law, at(5e5, 3e5, 0));
  return out +
         "[[stage]]\ntype = \"static\"\nsteps = 2\n[[stage]]\ntype = \"dynamic\"\nduration = 0.5\nstep = 2e-3\n[output]\nframes = 0\n";
}

// Claim: a rigid raft with azimuth 37 degrees under a tower of beams (principal axes, eccentricity and load turned too) gives the turned
// answer: 1e-10 of the peaks. Coulomb friction by springs on fixed ground, and by constraints on a bed.
TEST(MeshSpace, TurnedRaftGivesTheTurnedAnswer) {
  VERIFIES({"Models in space", "A raft with an azimuth gives the turned answer", "Invariance under rotation"});
  largest_difference = 0;
  for (const auto& [contact, bed] :
       {std::pair{springs, ""}, std::pair{held_friction, ", bed = { stiffness = 1e8, damping = 1e5, mass = 50 }"}}) {
    SCOPED_TRACE(contact.name);
    const MeshRun one = run_mesh(tower(contact, 0, bed), {}), other = run_mesh(tower(contact, turned_by, bed), {});
    ASSERT_TRUE(one.completed()) << one.result.reason;
    ASSERT_TRUE(other.completed()) << other.result.reason;
    VERIFY_GT("uplifted share (the case uplifts)", "1", one.peak("base.uplifted_ratio"), 0.1);
    VERIFY_GT("torsion", "N m", one.peak("base.torsion"), 1e3);
    expect_turned(one, other, 1e-10);
    VERIFY_LT("largest difference of vectors and scalars over their peaks", "1", largest_difference, 1e-10);
  }
  RecordProperty("largest_difference", fmt::format("{:.1e}", largest_difference));
}

// Claim: each condensed step (split factor, interface unknowns only) equals Newton's method on all unknowns from the same beginning: 1e-8;
// in space, with biaxial uplift, on traction laws with friction and with constraints (without: springs hold the block sideways).
TEST(MeshSpace, CondensedStepEqualsTheMonolithicOne) {
  VERIFIES({"Models in space", "The condensed step equals Newton's method on all unknowns",
            "Monolithic solution of each step, to 1e-8 (docs/theory, section 4)"});
  for (const Contact& contact : {springs, sdm, held}) {
    SCOPED_TRACE(contact.name);
    Block block = space_block();
    block.contact = contact;
    block.duration = 0.06;
    block.box.soil.width = {8, 10};  // the oracle is dense
    if (contact.law == held.law) {
      const std::vector<int> top =
          nodes_where(block.mesh(), [](const Vec3& x) { return x.z() > 8 - 1e-9 && std::abs(std::abs(x.x()) - 2) < 1e-9; });
      for (const int node : {top.front(), top.back()})
        for (const char* along : {"[1, 0, 0]", "[0, 1, 0]"})
          block.extra += fmt::format("[[spring]]\nnodes = [\"mesh.{}\"]\ndirection = {}\nstiffness = 1e6\n", node + 1, along);
    }
    const MeshRun run = block.run([](BuiltCase& built) {
      built.plan.oracle_tolerance = 1e-8;
      for (Stage& stage : built.plan.stages) stage.halvings = 0;
    });
    VERIFY_EQ("run completed: every step within 1e-8 of the monolithic solution (1: yes)", "1", run.completed(), 1);
    VERIFY_GT("uplifted share (the case uplifts)", "1", run.peak("base.uplifted_ratio"), 0.1);
  }
}

// Claim: the same of constraints with friction: nine node pairs under a block of bricks, uplift about both axes, slip in directions that
// turn (those of the oracle come from Newton's method on states of open, sticking and slipping pairs): each step to 1e-8.
TEST(MeshSpace, CondensedStepEqualsTheMonolithicOneUnderFriction) {
  VERIFIES({"Models in space", "The condensed step with friction equals Newton's method on all unknowns",
            "Monolithic solution of each step, to 1e-8 (docs/theory, section 4)"});
  Block block = space_block();
  block.contact = held_friction;
  block.box.soil.width = {8, 10};
  block.box.soil.layers = {{4, 4}};
  block.box.block.height = 6;
  block.box.block.size = 3;
  block.duration = 0.06;
  block.step = 4e-3;
  const MeshRun run = block.run([](BuiltCase& built) {
    built.plan.oracle_tolerance = 1e-8;
    for (Stage& stage : built.plan.stages) stage.halvings = 0;
  });
  VERIFY_GT("uplifted share (the case uplifts)", "1", run.peak("base.uplifted_ratio"), 0.1);
  VERIFY_EQ("run completed: every step within 1e-8 of the monolithic solution (1: yes)", "1", run.completed(), 1);
  VERIFY_GT("energy dissipated by slip", "J", run.peak("energy.interface_dissipated"), 1);  // J: by slip alone
}

// Claim: constraints with friction are the limit of stiff springs with friction, which are checked above: under weight and a biaxial push
// in statics, with uplift and slip, motion and resultants come nearer in proportion to 1/K (order 1) and to 1e-4 at K = 1e13 Pa/m.
TEST(MeshSpace, ConstraintsWithFrictionAreTheLimitOfStiffSprings) {
  VERIFIES({"Friction", "Constraints with friction are the limit of stiff springs",
            "Springs with K = 1e11, 1e12 and 1e13 Pa/m, verified on their own"});
  Block block = space_block();
  block.contact = held_friction;
  block.duration = block.step = 1e-9;
  block.extra = "[[load]]\nname = \"dead\"\ngroup = \"block_top\"\nforce = [9e5, 6e5, 0]\n";
  const MeshRun rigid = block.run();
  VERIFY_GT("uplifted share (the case uplifts)", "1", rigid["base.uplifted_ratio"][0], 0.1);
  std::map<std::string, std::vector<double>> error;
  const std::vector<double> stiffness{1e11, 1e12, 1e13};
  for (const double k : stiffness) {
    const std::string law = fmt::format("{{ type = \"springs\", K_n = {}, tangential = \"coulomb\", K_t = {}, friction = 0.4 }}", k, k);
    block.contact = {"", law.c_str(), "none"};
    const MeshRun run = block.run();
    for (const char* name : {"top.ux", "top.uy", "top.uz", "base.max_opening", "base.moment_1", "base.moment_2"})
      error[name].push_back(std::abs(run[name][0] / rigid[name][0] - 1));
  }
  for (const auto& [name, values] : error) {
    RecordProperty(name, fmt::format("{:.2e} {:.2e} {:.2e}", values[0], values[1], values[2]));
    VERIFY_LT("relative difference at K = 1e13 Pa/m", "1", values.back(), 1e-4) << name;
    if (values.front() > 1e-6)
      VERIFY_NEAR("order of convergence in 1/K", "1", std::log10(values.front() / values.back()) / 2, 1, 0.15) << name;
  }
}

}  // namespace
}  // namespace uplift::verification::mesh_space_test
