// Static stages: equilibrium where interface forces balance each other, motions that nothing determines, and the energy of load steps and
// of a static stage that stops a moving structure.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "unit/verdict/verdict_support.h"
#include "uplift/verdict/result_warnings.h"
#include "uplift/verdict/verdict.h"

namespace uplift::static_balance_test {
namespace {

constexpr double modulus = 2e8, width = 3, depth = 2;  // Pa/m, m

/// A rigid footing that is free to turn on tensionless springs, moved vertically by this much [m].
std::string moved_footing(double motion, const std::string& points, const std::string& more) {
  return "title = \"footing\"\n[nodes]\nbase = [0, 0]\n[[rigid]]\nname = \"footing\"\nnode = \"base\"\nmass = 1e4\ninertia = 7500\n"
         "[[support]]\nnode = \"base\"\nfixed = [\"ux\"]\n[[interface]]\nname = \"soil\"\n"
         "footing = { body = \"base\", width = 3, thickness = 2, " +
         points + " }\nlaw = { type = \"springs\", K_n = 2e8, tangential = \"none\" }\n" +
         "[[motion]]\nnode = \"base\"\ndirection = \"uy\"\n" + "amplitude = " + std::to_string(motion) + "\n" + more;
}

const std::vector<double>& column(const RunResult& run, const std::string& name) {
  const auto& table = run.load_steps.empty() ? run.table : run.load_steps;
  for (std::size_t k = 0; k < run.columns.size(); ++k)
    if (run.columns[k].name == name) return table.at(k + 1);
  ADD_FAILURE() << "no column " << name;
  return table.at(0);
}

// ---- equilibrium ----

TEST(StaticBalance, ASettlementThatPressesAFootingDown) {
  // no load and no unbalanced moment: axial force = -K_n d A, and its work K_n A d^2/2 grows with the square of the load factor
  const double settlement = 2e-3, force = modulus * settlement * width * depth;
  for (const char* points : {"points = 8, rule = \"gauss\"", "points = 40, rule = \"midpoint\"", "points = 21"}) {
    const RunResult run =
        support::run_of(support::built_of(moved_footing(-settlement, points, "[[stage]]\ntype = \"static\"\nsteps = 4\n")));
    ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
    const auto &axial = column(run, "soil.axial"), &turn = column(run, "base.rz"), &work = column(run, "energy.external");
    ASSERT_EQ(axial.size(), 5u);
    for (std::size_t i = 0; i < axial.size(); ++i) {
      const double factor = 0.25 * static_cast<double>(i);
      EXPECT_NEAR(axial[i], -factor * force, 1e-12 * force);
      EXPECT_NEAR(turn[i], 0, 1e-12);
      EXPECT_NEAR(work[i], 0.5 * factor * factor * force * settlement, 1e-12 * force * settlement);
      EXPECT_NEAR(column(run, "energy.residual")[i], 0, 1e-12 * force * settlement);
    }
    EXPECT_EQ(run.not_unique, "");
    EXPECT_EQ(run.max_base_moment.value, 0);  // not 1e-13 of the force times the width
  }
}

TEST(StaticBalance, AStructureThatNothingHoldsStillFails) {
  // a moment that nothing bears once the footing is lifted
  const RunResult run = support::run_of(support::built_of(
      moved_footing(2e-3, "points = 21", "[[load]]\nnode = \"base\"\nmoment = 10\n[[stage]]\ntype = \"static\"\nsteps = 4\n")));
  EXPECT_EQ(run.status, RunStatus::failed);
}

// ---- motions that nothing determines ----

TEST(StaticBalance, ALiftedFootingKeepsItsRotation) {
  // lifted by 5 mm from a level bed: any small rotation is in equilibrium, and the one that it had is kept: none
  for (const char* points : {"points = 8, rule = \"gauss\"", "points = 40, rule = \"midpoint\"", "points = 21"})
    for (const char* load : {"", "[[load]]\nnode = \"base\"\nforce = [0, -1e6]\n"}) {
      const BuiltCase built =
          support::built_of(moved_footing(5e-3, points, std::string(load) + "[[stage]]\ntype = \"static\"\nsteps = 4\n"));
      const RunResult run = support::run_of(built);
      ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
      for (const double turned : column(run, "base.rz")) EXPECT_NEAR(turned, 0, 1e-15);
      EXPECT_NEAR(run.max_opening.value, 5e-3, 1e-14);
      EXPECT_NE(run.not_unique.find("\"soil\" has no contact, and \"base\" can turn about the point (0, 0) m without resistance"),
                std::string::npos)
          << run.not_unique;
      const std::vector<std::string> said = result_warnings(run, judge(built, run, nullptr).numbers);
      ASSERT_FALSE(said.empty());
      EXPECT_EQ(said.front(), run.not_unique);
    }
}

TEST(StaticBalance, ARaftInSpaceKeepsBothRotations) {
  const RunResult run = support::run_of(support::built_of(
      "title = \"raft\"\n[nodes]\nbase = [0, 0, 0]\n[[rigid]]\nname = \"raft\"\nnode = \"base\"\nmass = 1e4\n"
      "inertias = [7500, 7500, 7500]\n[[support]]\nnode = \"base\"\nfixed = [\"ux\", \"uy\", \"rz\"]\n[[interface]]\nname = \"soil\"\n"
      "footing = { body = \"base\", width = 4, length = 3, points = 9, points_across = 7 }\n"
      "law = { type = \"springs\", K_n = 2e8, tangential = \"none\" }\n"
      "[[motion]]\nnode = \"base\"\ndirection = \"uz\"\namplitude = 5e-3\n[[stage]]\ntype = \"static\"\nsteps = 4\n"));
  ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
  for (const char* rotation : {"base.rx", "base.ry"})
    for (const double turned : column(run, rotation)) EXPECT_NEAR(turned, 0, 1e-15) << rotation;
  EXPECT_NEAR(run.max_opening.value, 5e-3, 1e-14);
  EXPECT_NE(run.not_unique, "");
}

TEST(StaticBalance, AnElasticSupportDeterminesTheRotation) {
  // once lifted, the beam alone bears the moment: M = 3 E I/L theta at the pinned base of a cantilever whose far end may slide along
  const double moment = 5e3, rigidity = 3e10 * 0.01, length = 6;
  const RunResult run = support::run_of(support::built_of(
      "title = \"footing\"\n[nodes]\nbase = [0, 0]\nfar = [6, 0]\n[[rigid]]\nname = \"footing\"\nnode = \"base\"\nmass = 1e4\ninertia = "
      "7500\n[[beam]]\nname = \"tie\"\nnodes = [\"base\", \"far\"]\nE = 3e10\nI = 0.01\nA = 0.1\n"
      "[[support]]\nnode = \"base\"\nfixed = [\"ux\"]\n[[support]]\nnode = \"far\"\nfixed = [\"ux\", \"rz\"]\n[[interface]]\nname = "
      "\"soil\"\n"
      "footing = { body = \"base\", width = 3, thickness = 2, points = 21 }\nlaw = { type = \"springs\", K_n = 2e8, tangential = \"none\" "
      "}\n[[motion]]\nnode = \"base\"\ndirection = \"uy\"\namplitude = 5e-3\n[[motion]]\nnode = \"far\"\ndirection = \"uy\"\n"
      "amplitude = 5e-3\n[[load]]\nnode = \"base\"\nmoment = 5e3\n[[stage]]\ntype = \"static\"\nsteps = 4\n"));
  ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
  const double rotation = moment * length / (4 * rigidity);  // far end clamped: M = 4 E I/L theta
  EXPECT_NEAR(column(run, "base.rz").back(), rotation, 1e-9 * rotation);
  EXPECT_EQ(run.not_unique, "");
}

// ---- work of load steps ----

/// The footing, free to settle and to turn, under P = 800 kN at the eccentricity e.
std::string loaded_footing(double e, int steps) {
  return "title = \"footing\"\n[nodes]\nbase = [0, 0]\n[[rigid]]\nname = \"footing\"\nnode = \"base\"\nmass = 1e4\ninertia = 7500\n"
         "[[support]]\nnode = \"base\"\nfixed = [\"ux\"]\n[[interface]]\nname = \"soil\"\nfooting = { body = \"base\", width = 3, "
         "thickness = 2, points = 4, rule = \"gauss\" }\nlaw = { type = \"springs\", K_n = 2e8, tangential = \"none\" }\n"
         "[[load]]\nnode = \"base\"\nforce = [0, -8e5]\nmoment = " +
         std::to_string(-8e5 * e) + "\n[[stage]]\ntype = \"static\"\nsteps = " + std::to_string(steps) + "\n";
}

TEST(StaticBalance, WorkOfALoadOnALinearBed) {
  // inside the kern: u = P/(K A), theta = P e/(K I); work (P u + P e theta)/2
  const double load = 8e5, e = 0.4, area = width * depth;
  const double work = 0.5 * (load * load / (modulus * area) + load * e * load * e / (modulus * area * width * width / 12));
  for (const int steps : {1, 3, 10}) {
    const RunResult run = support::run_of(support::built_of(loaded_footing(e, steps)));
    ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
    EXPECT_NEAR(column(run, "energy.external").back(), work, 1e-9 * work) << steps;
    EXPECT_NEAR(run.final_energy.external, work, 1e-9 * work);
    EXPECT_NEAR(run.final_energy.stored, work, 1e-9 * work);
    EXPECT_NEAR(run.final_energy.residual, 0, 1e-9 * work);
  }
}

TEST(StaticBalance, ASecondStageAddsNoWork) {
  const RunResult run = support::run_of(support::built_of(loaded_footing(0.4, 2) + "[[stage]]\ntype = \"static\"\nsteps = 3\n"));
  const std::vector<double>& work = column(run, "energy.external");
  ASSERT_EQ(work.size(), 6u);
  for (std::size_t i = 3; i < work.size(); ++i) EXPECT_NEAR(work[i], work[2], 1e-9 * work[2]);
}

TEST(StaticBalance, WorkThatIsNotLinearConverges) {
  // a spring K1 up to the gap g, then K1 + K2: work = P u - (area above the curve), the trapezoidal sum has an error of order 2
  const double first = 1e8, second = 5e8, gap = 4e-3, load = 1e6;
  const double end = (load + second * gap) / (first + second);
  const double exact = 0.5 * first * end * end + 0.5 * second * (end - gap) * (end - gap);
  std::vector<double> error;
  for (const int steps : {7, 70}) {
    const RunResult run = support::run_of(support::built_of(
        "title = \"gap\"\n[nodes]\nmass = [0, 0]\n[[mass]]\nnode = \"mass\"\nmass = 1\n[[support]]\nnode = \"mass\"\nfixed = [\"ux\"]\n"
        "[[spring]]\nnodes = [\"mass\"]\nstiffness = 1e8\ndirection = [0, 1]\n[[interface]]\nname = \"stop\"\n"
        "pairs = { upper = [\"mass\"], area = 1, normal = [0, 1] }\ngap = 4e-3\nlaw = { type = \"springs\", K_n = 5e8, tangential = "
        "\"none\" }\n[[load]]\nnode = \"mass\"\nforce = [0, -1e6]\n[[stage]]\ntype = \"static\"\nsteps = " +
        std::to_string(steps) + "\n"));
    ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
    EXPECT_NEAR(run.final_energy.strain + run.final_energy.stored, exact, 1e-9 * exact);
    error.push_back(std::abs(run.final_energy.external - exact) / exact);
    EXPECT_NEAR(run.final_energy.residual, exact - run.final_energy.external, 1e-9 * exact);
  }
  EXPECT_LT(error[0], 0.01);
  EXPECT_LT(error[1], 0.02 * error[0] + 1e-9);  // a hundredth, and where in its step the gap closes
}

// ---- a static stage that stops the structure ----

TEST(StaticBalance, WhatAStopTakesIsBooked) {
  // An undamped mast that swings about its equilibrium: k u0^2/2 = 1440 J with k = 12 E I/L^3 (its top is moved without a rotation),
  // whatever load bends it. The static stage takes all of it; the dynamic stages before and after close their balance, and nothing moves
  // after it.
  const double energy = 0.5 * 12 * 3e10 * 0.01 / 125 * 0.01 * 0.01;
  const std::string dynamics = "[[stage]]\ntype = \"dynamic\"\nduration = 0.1\nstep = 1e-3\n", statics = "[[stage]]\ntype = \"static\"\n";
  for (const char* load : {"", "[[load]]\nnode = \"top\"\nforce = [2e4, -1e4]\n"}) {
    const RunResult run = support::run_of(
        support::built_of("title = \"mast\"\n[nodes]\nfoot = [0, 0]\ntop = [0, 5]\n[[beam]]\nname = \"mast\"\nnodes = [\"foot\", "
                          "\"top\"]\nE = 3e10\nI = 0.01\n"
                          "A = 0.1\n[[mass]]\nnode = \"top\"\nmass = 1000\n[[support]]\nnode = \"foot\"\nfixed = [\"ux\", \"uy\", \"rz\"]\n"
                          "[[initial]]\nnode = \"top\"\ndisplacement = [0.01, 0]\n" +
                          std::string(load) + statics + dynamics + statics + "steps = 5\n" + dynamics));
    ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
    const Energies& end = run.final_energy;
    EXPECT_NEAR(end.stop, energy, 1e-6 * energy) << load;
    EXPECT_NEAR(end.kinetic, 0, 1e-9 * energy);
    EXPECT_NEAR(end.residual, 0, 1e-9 * energy);
    EXPECT_NEAR(column(run, "energy.stop").back(), energy, 1e-6 * energy);
  }
}

TEST(StaticBalance, TheVerdictTellsWhatAStopTakes) {
  const BuiltCase built = support::built_of(
      "title = \"mast\"\n[nodes]\nfoot = [0, 0]\ntop = [0, 5]\n[[beam]]\nname = \"mast\"\nnodes = [\"foot\", \"top\"]\nE = 3e10\nI = 0.01\n"
      "A = 0.1\n[[mass]]\nnode = \"top\"\nmass = 1000\n[[support]]\nnode = \"foot\"\nfixed = [\"ux\", \"uy\", \"rz\"]\n"
      "[[initial]]\nnode = \"top\"\ndisplacement = [0.01, 0]\n[[stage]]\ntype = \"dynamic\"\nduration = 0.1\nstep = 1e-3\n"
      "[[stage]]\ntype = \"static\"\n");
  const Verdict verdict = judge(built, support::run_of(built), nullptr);
  const auto fact = std::ranges::find(verdict.facts, "Energy taken by static stages", &Verdict::Fact::label);
  ASSERT_NE(fact, verdict.facts.end());
  EXPECT_EQ(fact->value, "1.44 kJ");
  EXPECT_NE(fact->detail.find("100 %"), std::string::npos) << fact->detail;
}

}  // namespace
}  // namespace uplift::static_balance_test
