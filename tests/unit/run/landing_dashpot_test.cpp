// A mass that bounces off springs with a dashpot, cut off where they would pull: coefficient of restitution in closed form.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "ran_support.h"

namespace uplift::landing_dashpot_test {
namespace {

constexpr double mass = 1000, stiffness = 1e7, dashpot = 2e4, arrives = 0.3;  // kg, N/m, N s/m, m/s

/// Schwager & Pöschel (Granular Matter 9 (2007) 465-469), for beta < omega_0/sqrt(2): the contact ends where the force vanishes.
double restitution() {
  const double beta = 0.5 * dashpot / mass, omega = std::sqrt(stiffness / mass - beta * beta);
  return std::exp(-beta / omega * (std::numbers::pi - std::atan(2 * beta * omega / (omega * omega - beta * beta))));
}

double rebound(const std::string& scheme, double step) {
  const support::Ran ran = support::run_text(fmt::format(R"(title = "drop"
bonded = false
[nodes]
m = [0, 0]
[[mass]]
node = "m"
mass = 1000
[[support]]
node = "m"
fixed = ["ux", "rz"]
[[initial]]
node = "m"
velocity = [0, -0.3]
[[interface]]
name = "stop"
gap = 0.002
pairs = {{ upper = ["m"], area = 0.5 }}
law = {{ type = "springs", K_n = 2e7, c = 4e4 }}
[limits]
separation = 10
[[stage]]
type = "dynamic"
duration = 0.1
step = {}
scheme = "{}"
[[output.history]]
name = "v"
node = "m"
quantity = "vy"
)",
                                                         step, scheme));
  EXPECT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
  return ran["v"].back() / arrives;
}

TEST(LandingOnADashpot, ReboundsAsInClosedForm) {
  const double exact = restitution();
  EXPECT_NEAR(exact, 0.75, 0.02);  // the dashpot counts
  EXPECT_NEAR(rebound("average_acceleration", 2.5e-4), exact, 1e-4 * exact);
  // the landing lasts one step, in which the dashpot acts from the contact on: with its force at the end for the whole step the error would
  // be 0.4 %
  EXPECT_NEAR(rebound("energy_decay", 2.5e-4), exact, 1e-3 * exact);
  EXPECT_NEAR(rebound("energy_decay", 5e-4), exact, 3e-3 * exact);
}

}  // namespace
}  // namespace uplift::landing_dashpot_test
