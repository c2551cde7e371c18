// A bar on a rigid wall: E = 900, rho = 1, A = 1, L = 10, v0 = -10, gap 1, two-node elements
// with lumped mass, trapezoidal rule, dt = h/c, Lagrange. Exact (d'Alembert): the wall presses with rho c v0 A = 300 for 2L/c = 2/3 s, the
// bar leaves with the velocity 10 and its energy of 500.
#include <gtest/gtest.h>

#include <cmath>

#include "support.h"

namespace uplift::verification {
namespace {

struct Figures {
  double mean = 0, deviation = 0;                  // of the force over the plateau, 0.1 to 0.5 s after first contact
  double pushing_mean = 0, pushing_deviation = 0;  // the same over the instants where it pushes
  double energy = 0, contact = 0, impulse = 0;
  int switches = 0;
};

Bar falling_bar(int elements, const std::string& rule) {
  Bar bar;
  bar.elements = elements;
  bar.velocity = -10;
  bar.impact = "\"" + rule + "\"";
  bar.duration = 3 * elements * bar.time_step();
  return bar;
}

Figures figures(const Bar& bar, const History& run) {
  const std::vector<double>&traction = run["foot.1.traction"], &opening = run["foot.1.opening"], &time = run.time();
  Figures f;
  double first = -1, last = -1, sums[2][3] = {};
  bool was = false;
  for (std::size_t i = 0; i < run.rows(); ++i) {
    const bool closed = opening[i] < 1e-9;
    f.switches += closed != was;
    was = closed;
    if (closed && first < 0) first = time[i];
    if (closed) last = time[i];
    f.impulse -= traction[i] * bar.area * bar.time_step();
    if (first < 0 || time[i] < first + 0.1 - 1e-9 || time[i] > first + 0.5 + 1e-9) continue;
    for (int pushing = 0; pushing < 2; ++pushing)
      if (pushing == 0 || traction[i] < 0) {
        sums[pushing][0] += 1;
        sums[pushing][1] -= traction[i];
        sums[pushing][2] += traction[i] * traction[i];
      }
  }
  const auto mean = [&](int k) { return sums[k][1] / sums[k][0]; };
  const auto deviation = [&](int k) { return std::sqrt(std::max(0.0, sums[k][2] / sums[k][0] - mean(k) * mean(k))); };
  f.mean = mean(0), f.deviation = deviation(0), f.pushing_mean = mean(1), f.pushing_deviation = deviation(1);
  f.energy = run.mechanical_energy(run.rows() - 1) / run.mechanical_energy(0);
  f.contact = last - first;
  return f;
}

Figures figures(const Bar& bar) {
  return figures(bar, run_text(bar.text()));
}

// Claim: energy after the impact, as tabulated by an independent program. The loss of project_hold is the kinetic energy of the lowest
// node, which carries half an element: (m/2n) v0^2/2, so the ratio is 1 - 1/(2n); tolerance 1e-4 (sharp). The others depend on where in a
// step the impact falls: 2 % of the table.
TEST(BarOnAWall, EnergyOfEveryImpactRule) {
  for (const int n : {100, 200, 400}) {
    const double ratio = figures(falling_bar(n, "project_hold")).energy;
    RecordProperty("project_hold_" + std::to_string(n), std::to_string(ratio));
    EXPECT_NEAR(ratio, 1 - 1.0 / (2 * n), 1e-4) << n;
  }
  EXPECT_NEAR(figures(falling_bar(100, "none")).energy, 22.9, 0.02 * 22.9);
  EXPECT_NEAR(figures(falling_bar(100, "project")).energy, 0.9952, 1e-3);
  EXPECT_NEAR(figures(falling_bar(100, "reflect")).energy, 1.0005, 1e-3);
  EXPECT_NEAR(figures(falling_bar(100, "propagate")).energy, 0.9971, 1e-3);
}

// Claim: without a correction each refinement makes it worse (the energy that is created grows with the number of elements); every
// correction converges to the exact energy with h^1 or better.
TEST(BarOnAWall, OnlyTheCorrectedImpactConverges) {
  EXPECT_GT(figures(falling_bar(400, "none")).energy, 1.5 * figures(falling_bar(100, "none")).energy);
  for (const char* rule : {"project", "project_hold", "propagate"}) {
    std::vector<double> size, error;
    for (const int n : {100, 200, 400}) {
      size.push_back(1.0 / n);
      error.push_back(1 - figures(falling_bar(n, rule)).energy);
    }
    RecordProperty(std::string("order_") + rule, std::to_string(order(size, error)));
    EXPECT_GT(order(size, error), std::string(rule) == "propagate" ? 0.6 : 0.9) << rule;
    EXPECT_LT(order(size, error), 1.3) << rule;
  }
  for (const int n : {100, 200, 400}) EXPECT_NEAR(figures(falling_bar(n, "reflect")).energy, 1, 2e-3) << n;
}

// Claim: force and contact as tabulated by an independent program; exact 300 and 2/3 s. `project_hold` gives directly usable forces (0.03
// %, deviation below 0.5), `project` the right mean with a deviation of a third. The uncorrected force, 1032 +- 458 where it pushes,
// depends on where in a step the impact falls: 4 % and 10 %.
TEST(BarOnAWall, ForceAndContactWhereTheForceIsTheMultiplier) {
  const Figures hold = figures(falling_bar(100, "project_hold"));
  EXPECT_NEAR(hold.mean, 300, 0.1);
  EXPECT_LT(hold.deviation, 0.5);
  EXPECT_EQ(hold.switches, 2);
  const double one_step = 1.0 / 300 + 5e-5;  // and half a unit of the last digit of that table
  EXPECT_NEAR(hold.contact, 2.0 / 3, one_step);
  const Figures project = figures(falling_bar(100, "project"));
  EXPECT_NEAR(project.mean, 301, 0.01 * 301);
  EXPECT_NEAR(project.deviation, 103, 0.01 * 103);
  EXPECT_EQ(project.switches, 4);
  EXPECT_NEAR(project.contact, 0.6633, one_step);
  const Figures none = figures(falling_bar(100, "none"));
  EXPECT_NEAR(none.pushing_mean, 1032, 0.04 * 1032);
  EXPECT_NEAR(none.pushing_deviation, 458, 0.1 * 458);
  EXPECT_EQ(none.switches, 102);
  EXPECT_NEAR(none.contact, 0.6633, one_step);
}

// Claim: with `reflect` and `propagate` the multiplier is not the contact force (597 and 722 in the table); what is reported includes the
// impulse of the correction, so it obeys the momentum balance: mean 300 (2 %: the force alternates between 0 and 600, deviation 300 +- 1 %,
// and the window holds an odd number of steps), total impulse m (v + v0) = 200 (1.5 %: discretisation of the exit).
TEST(BarOnAWall, ForceOfTheReflectionsObeysTheMomentumBalance) {
  for (const char* rule : {"reflect", "propagate"}) {
    const Bar bar = falling_bar(100, rule);
    const Figures f = figures(bar);
    EXPECT_NEAR(f.mean, 300, 0.02 * 300) << rule;
    EXPECT_NEAR(f.deviation, 300, 0.01 * 300) << rule;
    EXPECT_NEAR(f.impulse, 200, 0.015 * 200) << rule;
    EXPECT_EQ(f.switches, 2) << rule;
    EXPECT_NEAR(f.contact, 2.0 / 3, 0.0101) << rule;
  }
}

// Claim: a sound rule stays sound wherever in a step the impact falls: no energy is created, and no more is lost than the node that hits
// carries in two steps (the projection when it arrives, and again when the gap is closed): 2/(2n).
TEST(BarOnAWall, ImpactAnywhereInAStep) {
  for (const char* rule : {"project", "project_hold"})
    for (const double part : {0.1, 0.25, 0.5, 0.75, 0.9}) {
      Bar bar = falling_bar(100, rule);
      bar.gap = 1 - part * 10 * bar.time_step();
      const Figures f = figures(bar);
      EXPECT_LE(f.energy, 1 + 1e-12) << rule << " " << part;
      EXPECT_GE(f.energy, 1 - 2.0 / 200) << rule << " " << part;
      EXPECT_NEAR(f.mean, 300, 3) << rule << " " << part;
      EXPECT_NEAR(f.impulse, 200, 0.015 * 200) << rule << " " << part;
    }
}

// Claim: the path-averaged traction keeps the energy at every stiffness and step, without any velocity correction (docs/theory, eq (12)):
// 1e-10 of the initial energy. The momentum is turned round (200): 1.5 %, except for joints that are far stiffer than an element (k h/(E A)
// = 1e5), where the energy that is kept goes into vibrations of single elements in part: 10 %. k h/(E A) from 0.01 to 1e5.
TEST(BarOnAWall, PathAveragedJointsKeepTheEnergy) {
  for (const double stiffness : {1e2, 1e4, 1e6, 1e9})
    for (const double part : {1.0, 0.37}) {
      const std::string k = std::to_string(stiffness);
      const std::pair<std::string, std::string> joints[] = {
          {"{ type = \"springs\", K_n = " + k + ", tangential = \"none\" }", ""},
          {"{ type = \"sdm\", K_n = " + k + ", F_u = 0, G_f = 1, F_c = -0.001, tangential = \"none\" }", ""},
          {"\"unilateral\"", "{ type = \"penalty\", stiffness = " + k + " }"},
          {"\"unilateral\"", "\"penalty\""}};
      for (const auto& [law, method] : joints) {
        Bar bar = falling_bar(100, "none");
        bar.law = law;
        bar.method = method;
        bar.step = part * bar.time_step();
        bar.duration = 1.4;
        const History run = run_text(bar.text());
        double residual = 0, impulse = 0;
        for (const double e : run["energy.residual"]) residual = std::max(residual, std::abs(e));
        for (const double t : run["foot.1.mean_traction"]) impulse -= t * bar.step;
        EXPECT_LT(residual, 1e-10 * 500) << law << method << part;
        EXPECT_NEAR(run.mechanical_energy(run.rows() - 1), 500, 1e-10 * 500) << law << method << part;
        EXPECT_NEAR(impulse, 200, (stiffness < 1e9 ? 0.015 : 0.1) * 200) << law << method << part;
      }
    }
}

// Claim: the same stiff joint with the traction at the end of the step has the disease of the uncorrected constraint, and the velocity
// correction does not help a law (it belongs to constraints): energy is created (docs/theory, section 3).
TEST(BarOnAWall, EndOfStepTractionCreatesEnergy) {
  Bar bar = falling_bar(100, "none");
  bar.law = "{ type = \"springs\", K_n = 1e6, tangential = \"none\" }";
  bar.traction = "end";
  EXPECT_GT(figures(bar).energy, 2);
}

}  // namespace
}  // namespace uplift::verification
