// Runs that begin in contact without a static stage, reflect, or pull at a joint that holds: closed forms.
#include <cmath>
#include <string>

#include "unit/verdict/verdict_support.h"

namespace uplift::beginnings_test {
namespace {

using namespace support;

constexpr double mass = 1000, g = 9.81;

std::string block(const std::string& interface, const std::string& stages, const std::string& more = "",
                  const std::string& place = "[0, 0]", const std::string& inertia = "300", const std::string& gravity = "9.81") {
  return "title = \"block\"\nbonded = false\n[nodes]\nb = " + place + "\n[[rigid]]\nnode = \"b\"\nmass = 1000\ninertia = " + inertia +
         "\n[gravity]\nacceleration = [0, -" + gravity + "]\n[[interface]]\nname = \"f\"\n" + interface + more + stages;
}

const std::vector<double>& column(const RunResult& run, const std::string& name) {
  for (std::size_t k = 0; k < run.columns.size(); ++k)
    if (run.columns[k].name == name) return run.table[k + 1];
  ADD_FAILURE() << "no column " << name;
  return run.table.front();
}

/// A block on a slope of angle a slides with g (sin a - mu cos a); its pressure is m g cos a from the first instant on.
TEST(Beginning, ABlockOnASlopePressesFromTheFirstInstantOn) {
  const double angle = 20 * M_PI / 180, friction = 0.3;
  for (const char* method : {"lagrange", "augmented_lagrangian"}) {
    const std::string text =
        "method = \"" + std::string(method) + "\"\n" +
        block(
            R"(footing = { body = "b", width = 4, points = 11, normal = [-0.3420201433256687, 0.9396926207859084], offset = [0.17101007166283436, -0.4698463103929542] }
law = { type = "coulomb", friction = 0.3 }
)",
            "[[stage]]\ntype = \"dynamic\"\nduration = 0.2\nstep = 0.002\n");
    const RunResult run = run_of(built_of(text));
    ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
    const std::vector<double>&axial = column(run, "f.axial"), &shear = column(run, "f.shear"), &ux = column(run, "b.ux"),
          &uy = column(run, "b.uy"), &time = run.table.front();
    const double weight = mass * g * std::cos(angle), acceleration = g * (std::sin(angle) - friction * std::cos(angle));
    for (std::size_t i = 0; i < axial.size(); ++i) {
      EXPECT_NEAR(axial[i], -weight, 1e-6 * weight) << method << " " << i;
      EXPECT_NEAR(std::abs(shear[i]), friction * weight, 1e-6 * weight) << method << " " << i;
      EXPECT_NEAR(std::hypot(ux[i], uy[i]), 0.5 * acceleration * time[i] * time[i], 1e-9) << method << " " << i;
    }
  }
}

/// On less of a slope it rests: no displacement at all, and friction takes m g sin a.
TEST(Beginning, ABlockThatSticksRests) {
  const double angle = std::atan2(0.1, 1);
  const std::string text =
      "method = \"lagrange\"\n" +
      block(R"(footing = { body = "b", width = 4, points = 5, normal = [-0.09950371902099893, 0.9950371902099893], offset = [0.05, -0.5] }
law = { type = "coulomb", friction = 0.3 }
)",
            "[[stage]]\ntype = \"dynamic\"\nduration = 0.05\nstep = 0.001\n");
  const RunResult run = run_of(built_of(text));
  ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
  for (std::size_t i = 0; i < run.table.front().size(); ++i) {
    EXPECT_NEAR(column(run, "f.axial")[i], -mass * g * std::cos(angle), 1e-6 * mass * g);
    EXPECT_NEAR(std::abs(column(run, "f.shear")[i]), mass * g * std::sin(angle), 1e-6 * mass * g);
    EXPECT_NEAR(column(run, "b.ux")[i], 0, 1e-12);
  }
}

/// A drop of 0.1 m under a rule that reflects: the kinetic energy is the work of the weight at every instant, and nothing is lost.
TEST(Beginning, AReflectedBlockKeepsItsEnergy) {
  for (const char* rule : {"reflect", "propagate"}) {
    const std::string text = "method = \"lagrange\"\nimpact = \"" + std::string(rule) + "\"\n" +
                             block("gap = 0.1\nfooting = { body = \"b\", width = 2, points = 3 }\nlaw = { type = \"unilateral\" }\n",
                                   "[limits]\nseparation = 100\n[[stage]]\ntype = \"dynamic\"\nduration = 0.6\nstep = 1e-4\n",
                                   "[[support]]\nnode = \"b\"\nfixed = [\"ux\", \"rz\"]\n");
    const RunResult run = run_of(built_of(text));
    ASSERT_EQ(run.status, RunStatus::completed) << rule << ": " << run.reason;
    const double energy = mass * g * 0.1;
    EXPECT_LT(run.energy_lost, 1e-9 * energy) << rule;
    EXPECT_LT(run.energy_created, 1e-9 * energy) << rule;
    EXPECT_NEAR(run.final_energy.impact, 0, 1e-9 * energy) << rule;
    EXPECT_NEAR(run.final_energy.kinetic, run.final_energy.external, 1e-9 * energy) << rule;
  }
}

/// A block that turns about one corner from the beginning: the static force of the other corner does no work.
TEST(Beginning, ACornerThatPartsAtOncePressesNoLonger) {
  const std::string text =
      "method = \"lagrange\"\n" +
      block("footing = { body = \"b\", width = 2, points = 2, offset = [0, -3] }\nlaw = { type = \"coulomb\", friction = 5 }\n",
            "[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\nduration = 0.05\nstep = 1e-3\n",
            "[[initial]]\nnode = \"b\"\nvelocity = [0.15, 0.05]\nangular_velocity = -0.05\n", "[0, 3]", "3333.3333333333335", "10");
  const RunResult run = run_of(built_of(text));
  ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
  const double kinetic = 0.5 * (1000 * (0.15 * 0.15 + 0.05 * 0.05) + 3333.3333333333335 * 0.05 * 0.05);
  EXPECT_LT(run.energy_created, 1e-3 * kinetic);
  // angular acceleration m g/(I + m r^2) about the corner, at 1 m beside the centre and at r = sqrt(10) m from it
  EXPECT_NEAR(column(run, "f.axial").back(), -1000 * (10 - 1e4 / (3333.3333333333335 + 1e4)), 1);
}

/// Tension below the strength stretches a joint by t/K_n and opens nothing; springs under the same load lift off.
TEST(Gap, AJointThatHoldsTensionDoesNotUplift) {
  const auto pulled = [](const std::string& law) {
    return run_of(built_of(block("footing = { body = \"b\", width = 4, points = 41 }\nlaw = " + law + "\n",
                                 "[[load]]\nnode = \"b\"\nmoment = 8e3\n[[stage]]\ntype = \"static\"\n",
                                 "[[support]]\nnode = \"b\"\nfixed = [\"ux\"]\n")));
  };
  // mean pressure 2452.5 Pa, edge stress of the moment 6 M/b^2 = 3000 Pa: tension up to 548 Pa
  for (const char* law : {"{ type = \"sdm\", K_n = 1e9, F_u = 2e4, G_f = 10, F_c = -10, tangential = \"none\" }",
                          "{ type = \"bilinear\", K_n = 1e9, F_u = 2e4, G_f = 10, tangential = \"none\" }",
                          "{ type = \"exponential\", K_n = 1e9, F_u = 2e4, G_f = 10, tangential = \"none\" }",
                          "{ type = \"elastic\", K_n = 1e9, tangential = \"none\" }"}) {
    const RunResult run = pulled(law);
    ASSERT_EQ(run.status, RunStatus::completed) << law << run.reason;
    EXPECT_EQ(run.max_opening.value, 0) << law;
    EXPECT_EQ(run.max_uplifted_ratio.value, 0) << law;
  }
  // b' = 3 (b/2 - M/N): what a rectangle keeps in contact
  const RunResult springs = pulled("{ type = \"springs\", K_n = 1e9, tangential = \"none\" }");
  ASSERT_EQ(springs.status, RunStatus::completed) << springs.reason;
  EXPECT_NEAR(springs.max_uplifted_ratio.value, 1 - 3 * (2 - 8e3 / (mass * g)) / 4, 2e-3);
}

}  // namespace
}  // namespace uplift::beginnings_test
