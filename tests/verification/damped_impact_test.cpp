// A mass m on a spring k and a dashpot c falls with its foot at the speed v, without gravity, and the foot lands
// on a rigid plane at t = 0. Without restitution the foot stops, and the mass goes on,
//   m y'' + c y' + k y = 0,   y(0) = 0, y'(0) = -v:    y = -v/w_d exp(-zeta w t) sin(w_d t),
// while k y + c y' < 0 presses the foot on the plane. Right after the impact the foot carries c v, at once.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "manual.h"
#include "support.h"

namespace uplift::verification::damped_impact_test {
namespace {

constexpr double m = 1000, foot = 300, frequency = 10, ratio = 0.2, v = 0.5, landing = 0.01;

double y(double t) {
  const double w = 2 * std::numbers::pi * frequency, damped = w * std::sqrt(1 - ratio * ratio);
  return -v / damped * std::exp(-ratio * w * t) * std::sin(damped * t);
}

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

struct Oscillator {
  double frequency = damped_impact_test::frequency, ratio = damped_impact_test::ratio;  // Hz, 1
};

/// The gap closes `early` steps before the end of a step.
/// Until the landing the step may be another one (`before` > 0), in a stage of its own.
std::string dropped(double step, const std::string& method, double early = 1e-6, const Oscillator& of = {}, double before = 0,
                    const std::string& scheme = "") {
  const double stiffness = m * std::pow(2 * std::numbers::pi * of.frequency, 2), gap = v * (landing - early * (before > 0 ? before : step));
  return "title = \"Damped impact\"\nmethod = \"" + method +
         "\"\n[nodes]\nhead = [0, 1]\nbase = [0, 0]\n[[beam]]\nname = \"spring\"\nnodes = [\"base\", \"head\"]\nE = " + number(stiffness) +
         "\nA = 1\nI = 1\n[[mass]]\nname = \"head\"\nnode = \"head\"\nmass = " + number(m) +
         "\n[[rigid]]\nname = \"foot\"\nnode = \"base\"\nmass = " + number(foot) + "\ninertia = " + number(foot) +
         "\n[[interface]]\nname = \"ground\"\nfooting = { body = \"base\", width = 2, points = 5 }\nlaw = \"unilateral\"\n"
         "[[support]]\nnode = \"base\"\nfixed = [\"ux\"]\n"
         "[[initial]]\nnode = \"base\"\ndisplacement = [0, " +
         number(gap) + "]\nvelocity = [0, " + number(-v) + "]\n[[initial]]\nnode = \"head\"\ndisplacement = [0, " + number(gap) +
         "]\nvelocity = [0, " + number(-v) +
         "]\n[[dashpot]]\nname = \"dashpot\"\nnodes = [\"base\", \"head\"]\ndirection = [0, 1]\ndamping = " +
         number(2 * of.ratio * m * 2 * std::numbers::pi * of.frequency) +
         (before > 0 ? "\n[[stage]]\ntype = \"dynamic\"\nduration = " + number(landing) + "\nstep = " + number(before) : "") +
         "\n[[stage]]\ntype = \"dynamic\"\nduration = " + number(before > 0 ? 0.03 : landing + 0.03) + "\nstep = " + number(step) + scheme +
         "\n[energy]\ncreated_limit = 1e9\n[output]\nframes = 0\n"
         "history = [{ name = \"y\", node = \"head\", quantity = \"uy\" }, { name = \"a\", node = \"head\", quantity = \"ay\" }, { name = "
         "\"force\", interface = \"ground\", quantity = "
         "\"axial\" }]\n";
}

}  // namespace

// Claim: the motion after the impact is of second order in the step, and so is the energy that the impact takes. The force on the foot
// right after it contains the damping.
TEST(DampedImpact, MassOnASpringThatLands) {
  VERIFIES({"Impact", "Impact of a damped oscillator", "closed form of the damped oscillator, no restitution"});
  for (const std::string method : {"lagrange", "augmented_lagrangian"}) {
    std::vector<double> error, taken, carried;
    for (const double step : {1e-3, 5e-4, 2.5e-4}) {
      const History run = run_text(dropped(step, method));
      ASSERT_EQ(run.status, "completed") << run.reason;
      double worst = 0, landed = 0;
      for (std::size_t i = 0; i < run.rows(); ++i)
        if (const double t = run.time()[i] - landing; t > -1e-9) {
          worst = std::max(worst, std::abs(run["y"][i] - y(t)));
          if (t < 1e-9) landed = run["force"][i];
        }
      error.push_back(worst / (v / (2 * std::numbers::pi * frequency)));
      carried.push_back(-landed / (2 * ratio * m * 2 * std::numbers::pi * frequency * v));
      taken.push_back(std::abs(run["energy.impact"].back() / (0.5 * foot * v * v) - 1));
      EXPECT_LE(run.peak("energy.residual"), 1e-10 * 0.5 * (m + foot) * v * v);
    }
    VERIFY_NEAR("order of the motion after the impact", "1", std::log2(error[1] / error[2]), 2, 0.1);
    VERIFY_NEAR("order of the energy that the impact takes, against that of the foot", "1", std::log2(taken[1] / taken[2]), 2, 0.1);
    VERIFY_LE("its error at a quarter of a millisecond", "1", taken[2], 2e-3);
    VERIFY_NEAR("force on the foot right after the impact over c v, at a quarter of a millisecond", "1", carried[2], 1, 0.02);
    VERIFY_NEAR("order of that force", "1", std::log2((1 - carried[1]) / (1 - carried[2])), 1, 0.1);
    VERIFY_LE("largest error at a quarter of a millisecond over v/omega", "1", error[2], 1e-4);
  }
}

// Claim: the step in which the foot lands balances to round-off, wherever in it the gap closes: damping works with the velocity of the
// displacement solve, and the change of velocity is the impact's. So does the undamped step before.
TEST(DampedImpact, BalanceOfTheStepThatLands) {
  VERIFIES({"Impact", "Energy balance of the step of a damped impact", "balance of energy, to round-off"});
  for (const double early : {0.1, 0.5, 0.9})
    for (const double step : {1e-3, 2.5e-4}) {
      const History run = run_text(dropped(step, "lagrange", early));
      ASSERT_EQ(run.status, "completed") << run.reason;
      double worst = 0, lost = 0;
      for (std::size_t i = 0; i < run.rows() && run.time()[i] < landing + 1e-9; ++i)
        worst = std::max(worst, std::abs(run["energy.residual"][i])), lost = run["energy.impact"][i];
      const double before = 0.5 * (m + foot) * v * v;
      VERIFY_LE("residual up to the landing over the energy before it", "1", worst / before, 1e-12);
      EXPECT_GT(lost, 0.1 * before);
    }
}

// Claim: a mass that damping ties to its foot more firmly than the step resolves, zeta omega dt = z >> 1, stops with it wherever in a step
// the gap closes: m y'' + c y' + k y = 0 with y' = -v exp(-c t/m) at first. It keeps no velocity but a share of order 1/z that the step
// leaves, no energy is created, and the foot is not torn off. It is so with a soft spring and with one that the step does not resolve.
TEST(DampedImpact, OverdampedMassStopsWithItsFoot) {
  VERIFIES({"Impact", "Impact of an overdamped oscillator", "limit of the damped oscillator for strong damping, no restitution"});
  for (const Oscillator& of : {Oscillator{10, 1600}, Oscillator{1800, 5.4}})
    for (const double step : {1e-3, 2.5e-4})
      for (const double early : {0.1, 0.5, 0.9}) {
        const double z = of.ratio * 2 * std::numbers::pi * of.frequency * step, before = 0.5 * (m + foot) * v * v;
        const History run = run_text(dropped(step, "lagrange", early, of));
        ASSERT_EQ(run.status, "completed") << run.reason;
        double kinetic = 0;
        for (std::size_t i = 0; i < run.rows(); ++i)
          if (run.time()[i] > landing + 0.5 * step) kinetic = std::max(kinetic, run["energy.kinetic"][i]);
        VERIFY_LE("velocity after the landing, times z, over that before", "1", std::sqrt(kinetic / before) * z, 2);
        VERIFY_LE("energy created over that before the landing", "1", run.peak("energy.residual") / before, 1e-10);
        VERIFY_NEAR("energy that impact and damping take over that before", "1",
                    (run["energy.impact"].back() + run["energy.damping"].back()) / before, 1, 4 / (z * z) + 1e-3);
      }
}

// Claim: second order too with HHT, and where the step changes right after the impact: what the step after an impact takes back belongs to
// the step of the impact.
TEST(DampedImpact, OtherSchemesAndOtherSteps) {
  VERIFIES({"Impact", "Impact of a damped oscillator: HHT, and a step that changes at the impact",
            "closed form of the damped oscillator, no restitution"});
  const auto order = [](double shorter, const std::string& scheme) {
    std::vector<double> error;
    for (const double step : {5e-4, 2.5e-4}) {
      const History run = run_text(dropped(step, "lagrange", 1e-6, {}, shorter > 0 ? step / shorter : 0, scheme));
      EXPECT_EQ(run.status, "completed") << run.reason;
      error.push_back(0);
      for (std::size_t i = 0; i < run.rows(); ++i)
        if (const double t = run.time()[i] - landing; t > -1e-9) error.back() = std::max(error.back(), std::abs(run["y"][i] - y(t)));
    }
    return std::log2(error[0] / error[1]);
  };
  VERIFY_NEAR("order with HHT", "1", order(0, "\nscheme = { type = \"hht\", alpha = -0.1 }"), 2, 0.15);
  VERIFY_NEAR("order where the step is four times longer after the impact", "1", order(4, ""), 2, 0.1);
  VERIFY_NEAR("order where it is sixteen times longer", "1", order(16, ""), 2, 0.1);
}

// Claim: the force on the foot, which rests on the plane, is the mass times the acceleration of the head at every instant, that of the
// landing too: the state that is reported is in equilibrium, whatever part of the damping force the step resolves.
TEST(DampedImpact, ReportedStatesAreInEquilibrium) {
  VERIFIES({"Impact", "Equilibrium of the states after a damped impact", "Newton's second law"});
  for (const Oscillator& of : {Oscillator{}, Oscillator{10, 1600}, Oscillator{1800, 5.4}})
    for (const std::string law : {"unilateral", "coulomb"})
      for (const double early : {1e-6, 0.5}) {
        std::string text = dropped(1e-3, "lagrange", early, of);
        if (law == "coulomb") text.replace(text.find("law = \"unilateral\""), 18, "law = { type = \"coulomb\", friction = 0.5 }");
        const History run = run_text(text);
        ASSERT_EQ(run.status, "completed") << run.reason;
        double worst = 0, peak = 0;
        for (std::size_t i = 0; i < run.rows(); ++i)
          if (run["force"][i] < 0)  // the foot rests
            worst = std::max(worst, std::abs(run["force"][i] + m * run["a"][i])), peak = std::max(peak, -run["force"][i]);
        VERIFY_LE("difference of force and mass times acceleration over the largest force", "1", worst / peak, 1e-9);
      }
}

}  // namespace uplift::verification::damped_impact_test
