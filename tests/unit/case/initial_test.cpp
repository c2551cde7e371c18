#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "simple_meshes.h"
#include "text_support.h"
#include "uplift/case/case.h"
#include "uplift/io/text/toml.h"

// Initial velocities and displacements of groups of the mesh.
namespace uplift::initial_test {
namespace {

constexpr double width = 2, height = 3, density = 2000, mass = density * width * height;  // m, kg/m3, kg per metre

const std::string block =
    "title = \"block\"\n[mesh]\nfile = \"mesh.msh\"\n[[solid]]\ngroup = \"volume\"\nE = 3e7\npoisson = 0.3\ndensity = 2000\n";

std::string dynamics(double duration, double step) {
  return fmt::format("[[stage]]\ntype = \"dynamic\"\nduration = {}\nstep = {}\n", duration, step);
}

Mesh mesh_of(Cell cell = Cell::quad4) {
  return rectangle(uniform_lines(0, width, 3), uniform_lines(0, height, 4), cell);
}

BuiltCase built_of(const std::string& text, const Mesh& mesh) {
  static std::vector<std::unique_ptr<Case>> kept;  // a model points into its case
  kept.push_back(std::make_unique<Case>(check_case(read_toml_text(text, "case.toml"), "case.toml",
                                                   [&](const std::string&, const Where&, const std::string&) { return mesh; })));
  return build(*kept.back(), RunSpec{});
}

std::string refusal(const std::string& text) {
  return support::refusal_of([&] { built_of(text, mesh_of()); });
}

TEST(InitialVelocity, FreeBlockFliesAndTurns) {
  // Without forces: v = v0 + omega x (x - centre) for ever, kinetic energy m v^2/2 + I omega^2/2, nothing is strained (small rotations).
  const std::string motion = "[[initial]]\ngroup = \"volume\"\nvelocity = [0.3, -0.2]\nangular_velocity = 0.1\n";
  constexpr double energy = mass * (0.3 * 0.3 + 0.2 * 0.2) / 2 + mass * (width * width + height * height) / 12 * 0.1 * 0.1 / 2;
  for (const Cell cell : {Cell::quad4, Cell::quad8, Cell::tri6}) {
    const Mesh mesh = mesh_of(cell);
    const BuiltCase built = built_of(block + motion + dynamics(0.2, 0.01), mesh);
    Vector full;
    std::vector<double> kinetic;
    const RunResult result = run(built.model, built.plan, built.behaviours, {}, [&](const Snapshot& snapshot) {
      full = built.model.full(snapshot.state.displacement, 0, 0);
      kinetic.push_back(0.5 * snapshot.state.velocity.dot(built.model.mass * snapshot.state.velocity));
    });
    ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
    ASSERT_EQ(kinetic.size(), 21);
    for (const double each : kinetic) EXPECT_NEAR(each, energy, 1e-10 * energy) << info(cell).name;
    EXPECT_LT(result.energy_created, 1e-10 * energy);
    EXPECT_LT(result.energy_lost, 1e-10 * energy);
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      const Vec3 arm = mesh.nodes[i] - Vec3(width / 2, height / 2, 0);
      EXPECT_NEAR(full[3 * static_cast<Index>(i)], 0.2 * (0.3 - 0.1 * arm.y()), 1e-11);
      EXPECT_NEAR(full[3 * static_cast<Index>(i) + 1], 0.2 * (-0.2 + 0.1 * arm.x()), 1e-11);
    }
  }
}

TEST(InitialVelocity, BlockThatTurnsAboutItsToe) {
  // About the corner: I = m (b^2 + h^2)/3.
  const std::string motion = "[[initial]]\ngroup = \"volume\"\nangular_velocity = \"0.1 rad/s\"\ncentre = [2, 0]\n";
  const BuiltCase built =
      built_of(block + "[[support]]\nnode = \"mesh.4\"\nfixed = [\"ux\", \"uy\"]\n" + motion + dynamics(0.01, 0.01), mesh_of());
  const Vector& v = built.plan.initial_velocity;
  const double energy = mass * (width * width + height * height) / 3 * 0.01 / 2;
  EXPECT_NEAR(0.5 * v.dot(built.model.mass * v), energy, 1e-12 * energy);
}

TEST(InitialVelocity, OfARigidBodyIsThatOfItsMaster) {
  const std::string body = "[nodes]\nmaster = [1, 0]\n[[rigid]]\nname = \"body\"\nnode = \"master\"\ngroup = \"volume\"\n";
  const BuiltCase whole =
      built_of(block + body + "[[initial]]\ngroup = \"volume\"\nvelocity = [0.5, 0]\nangular_velocity = 0.2\ncentre = [1, 0]\n" +
                   dynamics(0.01, 0.01),
               mesh_of());
  ASSERT_EQ(whole.model.free(), 3);
  EXPECT_NEAR(whole.plan.initial_velocity[0], 0.5, 1e-13);
  EXPECT_NEAR(whole.plan.initial_velocity[1], 0, 1e-13);
  EXPECT_NEAR(whole.plan.initial_velocity[2], 0.2, 1e-13);
  // a part of a body that moves otherwise than the body can
  const std::string bent =
      refusal(block + body + "[[initial]]\nnode = \"mesh.1\"\nvelocity = [0.5, 0]\n[[initial]]\ngroup = \"top\"\nvelocity = [0.5, 0.1]\n" +
              "[[initial]]\nnode = \"mesh.2\"\nvelocity = [0, 0]\n" + dynamics(0.01, 0.01));
  EXPECT_NE(bent.find("values that supports, prescribed motions, rigid bodies and inextensible beams allow"), std::string::npos) << bent;
}

TEST(InitialVelocity, AgainstASupportIsRefusedAtItsTable) {
  const std::string held = "[[support]]\ngroup = \"bottom\"\nfixed = [\"ux\", \"uy\"]\n";
  const std::string text =
      block + held + "[[initial]]\ngroup = \"top\"\nvelocity = [0.5, 0]\n[[initial]]\ngroup = \"left\"\nvelocity = [0.5, 0]\n";
  const std::string found = refusal(text + dynamics(0.01, 0.01));
  EXPECT_NE(found.find("case.toml:15: initial"), std::string::npos) << found;
  EXPECT_NE(found.find("value = 0.5 at mesh.1.ux, where only 0 is possible"), std::string::npos) << found;
}

TEST(InitialVelocity, IntoAClosedJointIsAnImpact) {
  // A rigid body on rigid ground loses m v^2/2 = 20 J at once, and stays.
  const BuiltCase built = built_of(
      "title = \"impact\"\n[nodes]\nbody = [0, 0]\n[[mass]]\nnode = \"body\"\nmass = 1e3\ninertia = 1e3\n"
      "[[support]]\nnode = \"body\"\nfixed = [\"ux\"]\n[gravity]\nacceleration = [0, -10]\n"
      "[[interface]]\nname = \"base\"\nfooting = { body = \"body\", width = 2, points = 5 }\nlaw = \"unilateral\"\n"
      "[[initial]]\nnode = \"body\"\nvelocity = [0, -0.2]\n[[stage]]\ntype = \"static\"\n" +
          dynamics(0.1, 1e-3),
      {});
  const RunResult result = run(built.model, built.plan, built.behaviours);
  ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
  EXPECT_NEAR(result.final_energy.impact, 20, 1e-10);
  EXPECT_NEAR(result.final_energy.kinetic, 0, 1e-12);
  EXPECT_LT(result.energy_created, 1e-10);
  EXPECT_TRUE(result.notes.empty()) << result.notes.front();  // in equilibrium
}

TEST(InitialVelocity, WhatMakesNoSenseIsRefused) {
  EXPECT_NE(refusal(block + "[[initial]]\nvelocity = [0.5, 0]\n" + dynamics(0.01, 0.01)).find("either node or group"), std::string::npos);
  EXPECT_NE(refusal(block + "[[initial]]\ngroup = \"tpo\"\nvelocity = [0.5, 0]\n" + dynamics(0.01, 0.01)).find("\"top\""),
            std::string::npos);
  EXPECT_NE(refusal(block + "[[initial]]\ngroup = \"top\"\nvelocity = [0.5, 0]\ncentre = [0, 0]\n" + dynamics(0.01, 0.01))
                .find("centre with a group that rotates"),
            std::string::npos);
}

TEST(InitialVelocity, OfManyNodesOfARigidBodyAndTheSoilTakesNoTime) {
  // 60 x 60 cells: a dense system of all values would have 2.7e7 entries.
  const Mesh mesh = rectangle(uniform_lines(0, 1, 60), uniform_lines(0, 1, 60));
  const BuiltCase built = built_of(
      block + "[[rigid]]\nname = \"cap\"\ngroup = \"top\"\n[[initial]]\ngroup = \"volume\"\nvelocity = [1, 2]\n" + dynamics(0.01, 0.01),
      mesh);
  const Vector& v = built.plan.initial_velocity;
  EXPECT_NEAR(0.5 * v.dot(built.model.mass * v), 2000 * 5 / 2.0, 1e-8);
}

}  // namespace
}  // namespace uplift::initial_test
