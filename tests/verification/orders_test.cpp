// Orders of convergence by refinement that no other file shows: penalty -> Lagrange with (1/eps)^1, dynamics with
// impacts with dt^1. Elsewhere: smooth dynamics and uplift (oscillator_, integrators_), exit energy h^1 (impact_), nodal joints h^2
// (footing_), beams h^4 (beams_), the SDM exact for any sub-stepping (law_sdm_).
#include <gtest/gtest.h>

#include <cmath>

#include "manual.h"
#include "support.h"

namespace uplift::verification::orders_test {
namespace {

/// A spring k_s = 4e6 pressed by P = 2e5 against a wall 0.01 away: displacement towards the wall and contact force after a static stage.
struct Pressed {
  double displacement = 0, force = 0;
};
Pressed pressed(const std::string& method) {
  const History run = run_text(
      "title = \"Spring against a wall\"\nmethod = " + method +
      "\n[nodes]\na = [0, 0]\n[[mass]]\nnode = \"a\"\nmass = 100\n[[spring]]\nnodes = [\"a\"]\ndirection = [0, 1]\nstiffness = 4e6\n"
      "[[support]]\nnode = \"a\"\nfixed = [\"ux\", \"rz\"]\n[[interface]]\nname = \"wall\"\ngap = 0.01\npairs = { upper = [\"a\"], area = "
      "1 }\n"
      "law = \"unilateral\"\n[[load]]\nnode = \"a\"\nforce = [0, -2e5]\n[[stage]]\ntype = \"static\"\nsteps = 3\n"
      "[[stage]]\ntype = \"dynamic\"\nduration = 1e-6\nstep = 1e-6\n[energy]\ncreated_limit = 1e9\n[output]\nframes = 0\nautomatic = "
      "false\n"
      "history = [{ name = \"u\", node = \"a\", quantity = \"uy\" }, { interface = \"wall\", point = 1, quantity = \"traction\" }]\n");
  return {-run["u"][0], -run["wall.1.traction"][0]};
}

// Claim: penalty u = (P + eps g)/(k_s + eps), in particular 0.0101593625498 for eps = 1e9, 1e-12; its distance
// from the Lagrange solution u = g, force P - k_s g falls with (1/eps)^1; the augmented Lagrangian is exact.
TEST(Orders, PenaltyTowardsLagrange) {
  VERIFIES({"Contact methods", "The penalty method converges to the constraint", "u = (P + εg)/(k + ε); u = g, force P − kg"});
  const double k = 4e6, p = 2e5, gap = 0.01;
  for (const char* method : {"\"lagrange\"", "\"augmented_lagrangian\""}) {
    const Pressed exact = pressed(method);
    VERIFY_NEAR("displacement, Lagrange and augmented Lagrangian", "m", exact.displacement, gap, 1e-9 * gap) << method;
    VERIFY_NEAR("contact force, Lagrange and augmented Lagrangian", "N", exact.force, p - k * gap, 1e-6 * p) << method;
  }
  std::vector<double> step, error;
  for (const double eps : {1e8, 1e9, 1e10, 1e11}) {
    const Pressed soft = pressed("{ type = \"penalty\", stiffness = " + std::to_string(eps) + " }");
    VERIFY_NEAR("displacement, penalty", "m", soft.displacement, (p + eps * gap) / (k + eps), 1e-12) << eps;
    if (eps == 1e9) VERIFY_NEAR("displacement, ε = 1e9 N/m", "m", soft.displacement, 0.0101593625498, 1e-12);
    step.push_back(1 / eps);
    error.push_back(soft.displacement - gap);
  }
  RecordProperty("order", std::to_string(order(step, error)));
  verified_case.curve("displacement [m]", step, error);
  VERIFY_NEAR("order of convergence in 1/ε", "1", order(step, error), 1, 0.05);
}

// Claim: dynamics with impacts is of first order in dt. A rocking block (base held horizontally, with P-Delta, b = 0.5, h = 2) is released;
// its second upright passage, after one impact, is at q(theta0) + 2 q(theta1), q(theta) = arcosh(1/(1 - theta/repose))/rate, where the
// impact leaves (1 - 1.5 sin^2 alpha)^2 of the energy 1 - (1 - theta/repose)^2. Mean error over starting angles, since where in a step an
// impact falls is chance.
TEST(Orders, DynamicsWithImpacts) {
  VERIFIES({"Rocking block", "Order of dynamics with impacts", "Housner, BSSA 53 (1963) 403-417, without linearisation of the arms"});
  const double b = 0.5, h = 2, g = 9.81, square = b * b + h * h, alpha = std::atan(b / h), repose = b / h;
  const double rate = std::sqrt(g * h / (4.0 / 3 * square)), r = std::pow(1 - 1.5 * std::pow(std::sin(alpha), 2), 2);
  const auto quarter = [&](double x) { return std::acosh(1 / (1 - x)) / rate; };
  std::vector<double> step, error;
  for (const double dt : {8e-3, 4e-3, 2e-3, 1e-3, 5e-4}) {
    double sum = 0;
    const int starts = 12;
    for (int k = 0; k < starts; ++k) {
      const double x0 = 0.3 + 0.0317 * k, x1 = 1 - std::sqrt(1 - r * (1 - (1 - x0) * (1 - x0)));
      char text[2000];
      std::snprintf(text, sizeof text,
                    "title = \"Block\"\n[nodes]\nbase = [0, 0]\n[[rigid]]\nname = \"block\"\nnode = \"base\"\nmass = 1000\ninertia = "
                    "%.17g\ncentre = [0, 2]\n"
                    "[[support]]\nnode = \"base\"\nfixed = [\"ux\"]\n[[interface]]\nname = \"ground\"\nlaw = \"unilateral\"\n"
                    "footing = { body = \"base\", width = 1, points = 2 }\n[gravity]\nacceleration = [0, -9.81]\n[[stage]]\ntype = "
                    "\"static\"\nsteps = 1\n"
                    "[[initial]]\nnode = \"base\"\ndisplacement = [0, %.17g]\nrotation = %.17g\n[[stage]]\ntype = \"dynamic\"\nduration = "
                    "3\nstep = %.17g\n"
                    "p_delta = true\n[limits]\nrotation = 1\n[output]\nframes = 0\nautomatic = false\nenergies = false\n"
                    "history = [{ name = \"turn\", node = \"base\", quantity = \"rz\" }]\n",
                    1000 * square / 3, b * x0 * repose, x0 * repose, dt);
      const History run = run_text(text);
      ASSERT_EQ(run.status, "completed") << run.reason;
      const std::vector<double>& turn = run["turn"];
      std::vector<double> times;
      int side = 1;  // an impact may leave the block upright to round-off for a step: count it once
      for (std::size_t i = 1; i < run.rows() && times.size() < 2; ++i)
        if (side * turn[i] < -1e-9) {
          side = -side;
          std::size_t j = i;
          while (j > 1 && std::abs(turn[j - 1]) <= 1e-9) --j;
          times.push_back(j < i ? run.time()[j] : run.time()[i - 1] + turn[i - 1] / (turn[i - 1] - turn[i]) * dt);
        }
      ASSERT_EQ(times.size(), 2U) << dt << " " << x0;
      sum += std::abs(times[1] - quarter(x0) - 2 * quarter(x1)) / starts;
    }
    step.push_back(dt);
    error.push_back(sum);
  }
  RecordProperty("order", std::to_string(order(step, error)));
  verified_case.curve("second passage [s]", step, error);
  VERIFY_NEAR("order of convergence", "1", order(step, error), 1, 0.3);
  VERIFY_LT("mean error of the second passage, shortest step", "s", error.back(), 3 * step.back());
}

}  // namespace
}  // namespace uplift::verification::orders_test
