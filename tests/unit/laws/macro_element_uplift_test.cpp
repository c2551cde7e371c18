#include <random>

#include "tests/unit/laws/macro_element_support.h"

// Uplift of the macro-element: closed forms, the tensionless Winkler strip, closed loops (docs/theory/macro_element.md).
namespace uplift::macro_element_uplift_test {
namespace {

using namespace macro_test;

/// Rigid strip of width d on tensionless springs k [Pa/m]: N and M from the part in contact, centre settlement w, rotation theta > 0.
std::pair<double, double> winkler(double k, double d, double w, double theta) {
  if (w - theta * d / 2 >= 0) return {k * d * w, k * d * d * d / 12 * theta};
  const double toe = w + theta * d / 2, length = toe / theta, n = k * toe * length / 2;
  return toe > 0 ? std::pair{n, n * (d / 2 - length / 3)} : std::pair{0.0, 0.0};
}

TEST(MacroUplift, TensionlessSpringsUnderAStrip) {
  // with the stiffness of springs k over the width D, alpha = 6 is that strip exactly, whatever N and M
  const double k = 2e8, d = 3;
  Footing footing(lifting(6, d, k * d, k * d * d * d / 12), 3);
  struct Row {
    double w, theta, n, m;
  };
  for (const Row& row : {Row{2e-3, 1e-3, 1.2e6, 4.5e5}, Row{2e-3, 2e-3, 1.25e6, 8.333333333e5}, Row{2e-3, 8e-3, 2.45e6, 2.2458333333e6},
                         Row{1e-4, 8e-3, 1.830125e6, 1.8224994792e6}, Row{-5e-3, 8e-3, 6.125e5, 7.4010416667e5},
                         Row{-1.1e-2, 8e-3, 1.25e4, 1.8229166667e4}}) {
    footing.respond({0, -row.w, row.theta});
    EXPECT_NEAR(-footing.force[1], row.n, 1e-9 * row.n);
    EXPECT_NEAR(footing.force[2], row.m, 2e-10 * row.m);
  }
  std::mt19937 random(1);
  std::uniform_real_distribution<double> settlement(-1e-2, 1e-2), rotation(1e-5, 2e-2);
  for (int i = 0; i < 1000; ++i) {
    const double w = settlement(random), theta = rotation(random);
    const auto [n, m] = winkler(k, d, w, theta);
    footing.respond({0, -w, theta});
    EXPECT_NEAR(-footing.force[1], n, 1e-10 * n + 1e-6) << "seed 1, " << i;
    EXPECT_NEAR(footing.force[2], m, 1e-10 * m + 1e-6) << "seed 1, " << i;
  }
}

// (M3) gives the displacements that belong to the forces of (M4): of one or two axes that lift, of any stiffness.
TEST(MacroUplift, DisplacementsOfTheForcesAreThoseGiven) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  constexpr double shapes[] = {4, 6, 8, 3, 12};
  int both = 0;
  for (int i = 0; i < 3000; ++i) {
    MacroElasticity e{.disc = i % 3 == 0,
                      .shape = i % 7 < 5 ? shapes[i % 7] : 4 + 4 * unit(random),
                      .length = {2 + 8 * unit(random), 2 + 8 * unit(random)}};
    e.vertical = 1e9, e.horizontal[0] = e.horizontal[1] = 1e9;
    for (int axis = 0; axis < 2; ++axis) e.rocking[axis] = e.vertical * std::pow(e.length[axis], 2) / 12 * (0.3 + 3 * unit(random));
    const MacroUplift uplift(e);
    MacroVector q(unit(random) * 2e-2 - 1e-2, 0, 0, (unit(random) - 0.5) * 2e-2, (unit(random) - 0.5) * 2e-2);
    const MacroElastic at = uplift.respond(q);
    if (!at.contact) continue;
    const MacroVector back = uplift.displacement(at.force);
    both += at.contact_share < 0.5;
    for (const int row : {macro_n, macro_m1, macro_m2})
      EXPECT_NEAR(back[row], q[row], 1e-9 * (std::abs(back[row]) + 1e-2)) << "seed 11, " << i;
  }
  EXPECT_GT(both, 500);
}

TEST(MacroUplift, MomentAndHeaveAtConstantForce) {
  // tests/data/reference/macro_uplift_constant_N.csv: closed form (M2, M3)
  for (const auto& row : table("macro_uplift_constant_N.csv")) {
    const double alpha = std::stod(row.at("alpha")), x = std::stod(row.at("theta_over_theta0")), d = 4, vertical = 3e8, rocking = 5e8,
                 n = 1e6;
    const double m0 = n * d / alpha, theta0 = m0 / rocking;
    Footing footing(lifting(alpha, d, vertical, rocking), 3);
    footing.hold(x * theta0, n, 0);
    EXPECT_NEAR(footing.force[2] / m0, std::stod(row.at("M_over_M0")), 1e-10) << alpha << " " << x;
    const double heave = std::stod(row.at("heave_over_D_theta0")) * d * theta0;
    EXPECT_NEAR(footing.state().heave, heave, 1e-9 * d * theta0) << alpha << " " << x;
    EXPECT_NEAR(footing.opening[1], heave - n / vertical, 1e-9 * d * theta0) << alpha << " " << x;
    EXPECT_NEAR(footing.state().uplifted_share, 1 - std::pow(x, -1 / (alpha / 2 - 1)), 1e-9);
  }
}

TEST(MacroUplift, ShapeBetweenTheTabulatedOnes) {
  // M/M_0 = beta - gamma x^(-1/gamma), continuous in alpha through the logarithm of alpha = 4
  for (const double alpha : {3.0, 3.999999999, 4.0, 4.000000001, 5.0, 7.3}) {
    const double d = 2, vertical = 1e8, rocking = 1e8, n = 1e5, m0 = n * d / alpha, x = 7, beta = alpha / 2, gamma = beta - 1;
    Footing footing(lifting(alpha, d, vertical, rocking), 3);
    footing.hold(x * m0 / rocking, n, 0);
    EXPECT_NEAR(footing.force[2] / m0, beta - gamma * std::pow(x, -1 / gamma), 1e-11) << alpha;
  }
}

TEST(MacroUplift, ClosedLoopReturnsNothing) {
  for (const double alpha : {4.0, 6.0, 8.0}) {
    Footing footing(lifting(alpha, 1, 1, 1), 3);
    footing.go({0, -1, 0});
    const double begin = footing.stored(footing.opening, footing.memory);
    EXPECT_NEAR(begin, 0.5, 1e-14);
    // (w, theta): (1, 0) -> (1, 1.2) -> (3, 1.2) -> (3, 0) -> (1, 0), in steps of any size
    for (const int steps : {1, 7}) {
      double work = 0;
      const auto side = [&](double w, double theta) {
        const Numbers from = footing.opening;
        for (int i = 1; i <= steps; ++i) {
          const Numbers to{0, from[1] + (-w - from[1]) * i / steps, from[2] + (theta - from[2]) * i / steps}, last = footing.opening;
          footing.mean(to);
          for (std::size_t r = 0; r < 3; ++r) work += footing.force[r] * (to[r] - last[r]);
          footing.accept(to);
        }
      };
      side(1, 1.2), side(3, 1.2), side(3, 0), side(1, 0);
      EXPECT_NEAR(work, 0, 1e-13) << alpha;
      EXPECT_NEAR(footing.end[1], -1, 1e-13);
      EXPECT_NEAR(footing.end[2], 0, 1e-13);
      EXPECT_EQ(footing.dissipated(footing.memory), 0);
    }
  }
}

TEST(MacroUplift, HomogeneousAndAPotential) {
  // energy of degree two, forces its gradient, in space with both axes lifted
  std::mt19937 random(2);
  std::uniform_real_distribution<double> any(-1, 1);
  for (const bool disc : {false, true}) {
    MacroParameters p = lifting(6, 3, 6e8, 4.5e8);
    p.elasticity.disc = disc;
    if (!disc) p.elasticity.length[1] = 2, p.elasticity.rocking[1] = 2e8;
    Footing footing(p, 6);
    for (int i = 0; i < 200; ++i) {
      Numbers to{1e-3 * any(random), 1e-3 * any(random), -3e-3 - 2e-3 * any(random), 4e-3 * any(random), 4e-3 * any(random), 1e-3};
      const Numbers force = footing.respond(to);
      const double energy = footing.stored(to, footing.now);
      double half = 0;
      for (std::size_t r = 0; r < 6; ++r) half += 0.5 * force[r] * to[r];
      EXPECT_NEAR(energy, half, 1e-12 * energy) << "seed 2, " << i;
      for (std::size_t r = 0; r < 6; ++r) {
        const double h = 1e-7, here = to[r];
        to[r] = here + h;
        const double up = footing.stored(to, footing.now);
        to[r] = here - h;
        const double down = footing.stored(to, footing.now);
        to[r] = here;
        EXPECT_NEAR((up - down) / (2 * h), force[r], 1e-6 * std::abs(force[2])) << "seed 2, " << i;
      }
    }
  }
}

}  // namespace
}  // namespace uplift::macro_element_uplift_test
