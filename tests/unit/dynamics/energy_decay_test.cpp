#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "uplift/dynamics/scheme.h"

// The filtered scheme on a linear oscillator, written out for one unknown: M = 1, K = omega^2. Reference values: the closed forms for small
// omega h and the double root -rho at infinite frequency.
namespace uplift::energy_decay_test {
namespace {

struct Motion {
  double u = 0, v = 0, d_u = 0, d_v = 0;
};

Motion advanced(const Motion& m, double omega, double h, double a, double b) {
  const double gamma = 0.5 + b, k = omega * omega, u_hat = m.u - b * m.d_u, v_hat = m.v - b * m.d_v;
  const double du = (-k * u_hat + v_hat / (gamma * h)) / (gamma * (k + 1 / (gamma * gamma * h * h)));
  const double dv = (du / h - v_hat) / gamma;
  return {m.u + du, m.v + dv, a * m.d_u + (1 - a) * du, a * m.d_v + (1 - a) * dv};
}

/// Decay of the energy per step, |lambda|^2, after the filters have settled.
double decay_per_step(double omega, double h, double a, double b, int settling, int steps) {
  Motion m{1, 0, 0, 0};
  const auto energy = [&] { return 0.5 * (m.v * m.v + omega * omega * m.u * m.u); };
  for (int i = 0; i < settling; ++i) m = advanced(m, omega, h, a, b);
  const double before = energy();
  for (int i = 0; i < steps; ++i) m = advanced(m, omega, h, a, b);
  return std::pow(energy() / before, 1.0 / steps);
}

Scheme made(double rho) {
  auto table = std::make_shared<RawTable>();
  table->entries.emplace_back("type", Raw{std::string("energy_decay"), {}, "type"});
  table->entries.emplace_back("rho", Raw{rho, {}, "rho"});
  return *make_part(scheme_catalog(), check_part(Raw{table, {}, "scheme"}, schemes()));
}

TEST(SchemeEnergyDecay, DampsSmallFrequenciesByTheClosedForm) {
  for (const double rho : {0.0, 0.5, 0.8}) {
    const Scheme scheme = made(rho);
    const double theta = 2 * std::numbers::pi / 100;
    const double ratio = -std::log(decay_per_step(1, theta, scheme.pole, scheme.gain, 400, 5000)) / (2 * theta);
    const double expected = std::pow((1 - rho) / (1 + rho), 3) * theta * theta * theta / 4;
    EXPECT_NEAR(ratio / expected, 1, 0.03) << rho;
  }
}

TEST(SchemeEnergyDecay, HardlyDampsFiftyStepsAPeriod) {
  const Scheme scheme = made(0.5);
  const double theta = 2 * std::numbers::pi / 50;
  const double ratio = -std::log(decay_per_step(1, theta, scheme.pole, scheme.gain, 400, 5000)) / (2 * theta);
  EXPECT_LT(ratio, 1e-4) << "0.01 % of critical";
  EXPECT_GT(ratio, 0);
}

TEST(SchemeEnergyDecay, HasItsSpectralRadiusAtInfiniteFrequency) {
  for (const double rho : {0.5, 0.8}) {
    const Scheme scheme = made(rho);
    // z^2 (1/2 + b) + z ((1 - a)/2 - 2 b) + (b - a/2) = 0 has the double root -rho
    const double a = scheme.pole, b = scheme.gain;
    const double z = -rho;
    EXPECT_NEAR(z * z * (0.5 + b) + z * ((1 - a) / 2 - 2 * b) + (b - a / 2), 0, 1e-15);
    EXPECT_NEAR(2 * z * (0.5 + b) + ((1 - a) / 2 - 2 * b), 0, 1e-15);
  }
}

TEST(SchemeEnergyDecay, IsTheTrapezoidalRuleForOne) {
  EXPECT_FALSE(made(1).filtered());
  EXPECT_EQ(made(1).stretch(), 1);
}

}  // namespace
}  // namespace uplift::energy_decay_test
