// A rigid block that rocks on its two corners: half width b = 0.5, half height h = 2, g = 9.81, R = sqrt(b^2 +
// h^2), alpha = atan(b/h), p = sqrt(3 g/4R). Small displacements with the P-Delta effect: I theta'' = m g (h theta - b) about a corner, I =
// 4/3 m R^2, so that the angle of repose is b/h and the rate sqrt(m g h/I) = p sqrt(cos alpha). Housner's own linearisation, p and alpha,
// takes both to first order in alpha.
#include <gtest/gtest.h>

#include <cmath>

#include "manual.h"
#include "support.h"

namespace uplift::verification::rocking_block_test {
namespace {

constexpr double b = 0.5, h = 2, g = 9.81, block_mass = 1000;
const double radius = std::sqrt(b * b + h * h), alpha = std::atan(b / h), p = std::sqrt(3 * g / (4 * radius));
const double repose = b / h, rate = p * std::sqrt(std::cos(alpha));  // rad, 1/s

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

/// The block; its node is the middle of its base, its corners are the two points of a footing.
struct Block {
  double rotation = 0;          // rad, counter-clockwise, about the corner on which it then stands
  double angular_velocity = 0;  // rad/s about the same corner
  bool slides = false;          // else the base is held horizontally (as by friction without limit)
  bool p_delta = true;          // with the static stage that it needs
  std::string impact = "project_hold";
  double step = 1e-3, duration = 1;

  std::string text() const {
    const double side = rotation > 0 ? -b : b;  // x of the corner that stays
    std::string out =
        "title = \"Rocking block\"\nimpact = \"" + impact + "\"\n[nodes]\nbase = [0, 0]\n[[rigid]]\nname = \"block\"\nnode = \"base\"\n";
    out +=
        "centre = [0, " + number(h) + "]\nmass = " + number(block_mass) + "\ninertia = " + number(block_mass * radius * radius / 3) + "\n";
    if (slides)
      out += "[[spring]]\nnodes = [\"base\"]\ndirection = [1, 0]\nstiffness = 1e-3\n";  // nothing, but the structure is no mechanism
    if (!slides) out += "[[support]]\nnode = \"base\"\nfixed = [\"ux\"]\n";
    out += "[[interface]]\nname = \"ground\"\nfooting = { body = \"base\", width = " + number(2 * b) +
           ", points = 2 }\nlaw = \"unilateral\"\n";
    out += "[gravity]\nacceleration = [0, " + number(-g) + "]\n";
    if (p_delta) out += "[[stage]]\ntype = \"static\"\nsteps = 1\n";
    // a frictionless block turns about a corner with its centre at rest horizontally
    const double across = slides ? h : 0;
    out += "[[initial]]\nnode = \"base\"\ndisplacement = [" + number(across * rotation) + ", " + number(-side * rotation) +
           "]\nrotation = " + number(rotation);
    out += "\nvelocity = [" + number(across * angular_velocity) + ", " + number(-side * angular_velocity) +
           "]\nangular_velocity = " + number(angular_velocity);
    out += "\n[[stage]]\ntype = \"dynamic\"\nduration = " + number(duration) + "\nstep = " + number(step) +
           "\np_delta = " + (p_delta ? "true" : "false");
    out +=
        "\n[limits]\nrotation = 0.5\n[energy]\ncreated_limit = 1e9\n[output]\nframes = 0\nautomatic = false\n"
        "history = [{ name = \"turn\", node = \"base\", quantity = \"rz\" }, { name = \"turn.v\", node = \"base\", quantity = \"vrz\" }]\n";
    return out;
  }
};

/// Rows just before and some steps after the first upright passage, and its time by a straight line.
struct Passage {
  double time = 0, before = 0, after = 0;
};
Passage passage(const History& run) {
  const std::vector<double>&turn = run["turn"], &spin = run["turn.v"], &time = run.time();
  for (std::size_t i = 1; i + 3 < run.rows(); ++i)
    if (turn[i - 1] * turn[0] > 0 && turn[i] * turn[0] <= 1e-12) {
      const double part = turn[i - 1] / (turn[i - 1] - turn[i]);
      return {time[i - 1] + part * (time[i] - time[i - 1]), spin[i - 1], spin[i + 2]};
    }
  return {};
}

// Claim: released at theta0 = alpha/2 the block is upright after arcosh(1/(1 - theta0/repose))/rate, with the angular velocity of that
// solution (1e-3); the error falls with the step, first order, to 1e-4. Housner's quarter period (4 x = 2.78845718 s linearised) differs by
// the order of alpha^2: 0.3 %.
TEST(RockingBlock, QuarterPeriod) {
  VERIFIES({"Rocking block", "Quarter period of a rocking block", "Housner, BSSA 53 (1963) 403-417; arcosh(1/(1 − θ₀/θ_r))/rate"});
  const double exact = std::acosh(1 / (1 - alpha / 2 / repose)) / rate, housner = std::acosh(1 / (1 - 0.5)) / p;
  VERIFY_NEAR("Housner's period", "s", 4 * housner, 2.78845718, 1e-8);
  for (const double side : {1.0, -1.0}) {
    std::vector<double> step, error;
    for (const double dt : {4e-3, 2e-3, 1e-3, 5e-4}) {
      Block block;
      block.rotation = side * alpha / 2;
      block.step = dt;
      const History run = run_text(block.text());
      ASSERT_EQ(run.status, "completed") << run.reason;
      const Passage upright = passage(run);
      step.push_back(dt);
      error.push_back(std::abs(upright.time / exact - 1));
      VERIFY_NEAR("quarter period over Housner's", "1", upright.time / housner, 1, 3e-3);
      VERIFY_NEAR("angular velocity at the passage over the closed form", "1",
                  upright.before / (-side * rate * (repose - alpha / 2) * std::sinh(rate * exact)), 1, 2 * dt + 1e-3);
    }
    RecordProperty("error_5e-4", std::to_string(error.back()));
    VERIFY_LT("relative error of the quarter period, shortest step", "1", error.back(), 1e-4);
    verified_case.curve(side > 0 ? "quarter period, to the left" : "quarter period, to the right", step, error);
    VERIFY_GT("order of convergence", "1", order(step, error), 0.8);
  }
}

// Claim: Housner's restitution by the inequality projection: angular velocity x (1 - 1.5 sin^2 alpha), energy x 0.8313148789 per impact,
// with the base held horizontally; a frictionless block (h^2 - 2 b^2)/(h^2 + 4 b^2) = 0.7. 2e-3 (gravity acts for two steps of 1e-5 s
// besides). The block goes on: with the equality of eq 4 at both corners it would stop dead.
TEST(RockingBlock, RestitutionOfOneImpact) {
  VERIFIES({"Rocking block", "Restitution of one impact",
            "Housner, BSSA 53 (1963) 403-417: (1 − 1.5 sin²α); frictionless: (h² − 2b²)/(h² + 4b²)"});
  VERIFY_NEAR("share of the energy after an impact", "1", std::pow(1 - 1.5 * std::pow(std::sin(alpha), 2), 2), 0.8313148789, 1e-10);
  for (const char* rule : {"project", "project_hold"})
    for (const bool slides : {false, true})
      for (const double side : {1.0, -1.0}) {
        Block block;
        block.impact = rule;
        block.slides = slides;
        block.p_delta = false;
        block.rotation = side * 1e-4;
        block.angular_velocity = -side * 1;
        block.step = 1e-5;
        block.duration = 3e-4;
        const Passage upright = passage(run_text(block.text()));
        const double expected = slides ? (h * h - 2 * b * b) / (h * h + 4 * b * b) : 1 - 1.5 * std::pow(std::sin(alpha), 2);
        VERIFY_NEAR("angular velocity before the impact", "rad/s", upright.before, -side, 2e-3);
        VERIFY_NEAR("ratio of the angular velocities", "1", upright.after / upright.before, expected, 2e-3) << rule << slides << side;
      }
}

// Claim: the block loses the same share at every impact: after n impacts the largest rotation follows from the energy r^n, with
// 1 - (1 - theta_n/alpha)^2 = r^n (1 - (1 - theta_0/alpha)^2) (Housner 1963), alpha the angle of repose; 0.2 % of it.
TEST(RockingBlock, DecayOverManyImpacts) {
  VERIFIES({"Rocking block", "Decay over many impacts", "Housner, BSSA 53 (1963) 403-417"});
  Block block;
  block.rotation = repose / 2;
  block.step = 2e-4;
  block.duration = 8;
  const History run = run_text(block.text());
  const std::vector<double>& turn = run["turn"];
  double energy = 1 - 0.25;
  const double r = std::pow(1 - 1.5 * std::pow(std::sin(alpha), 2), 2);
  int impacts = 0;
  std::size_t i = 1;
  while (i < run.rows() && impacts < 5) {
    while (i < run.rows() && turn[i - 1] * turn[i] > 0) ++i;  // next upright passage
    double most = 0;
    for (++i; i < run.rows() && turn[i - 1] * turn[i] > 0; ++i) most = std::max(most, std::abs(turn[i]));
    if (i >= run.rows()) break;
    energy *= r;
    ++impacts;
    VERIFY_NEAR("largest rotation after an impact over the angle of repose", "1", most / repose, 1 - std::sqrt(1 - energy), 0.002)
        << impacts;
  }
  VERIFY_EQ("number of impacts", "1", impacts, 5);
}

}  // namespace
}  // namespace uplift::verification::rocking_block_test
