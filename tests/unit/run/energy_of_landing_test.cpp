// A mass that lands while it moves sideways: how its loss is shared between impact and friction. Closed form.
#include <fmt/format.h>

#include <cmath>
#include <string>

#include "unit/verdict/verdict_support.h"

namespace uplift::energy_of_landing_test {
namespace {

using namespace support;

/// It arrives with v_n = sqrt(2 g h) and v_t. The impact takes m v_n^2/2; friction takes its impulse mu m v_n times the mean of the slip
/// before and after, and then mu m g on the way that is left, wherever in a step the gap closes.
TEST(Landing, FrictionAndImpactShareTheLossAsTheirImpulsesDo) {
  constexpr double mass = 1000, g = 9.81, height = 0.05, sideways = 4, friction = 0.4, duration = 0.12;
  const double normal = std::sqrt(2 * g * height), left = sideways - friction * normal, time = duration - normal / g;
  const double impact = 0.5 * mass * normal * normal;
  const double rubbed =
      friction * mass * normal * 0.5 * (sideways + left) + friction * mass * g * (left * time - 0.5 * friction * g * time * time);
  for (const bool turned : {false, true})
    for (const double step : {1e-4, 1.03e-4, 1.07e-4, 1.11e-4, 1.17e-4}) {
      const double sign = turned ? -1 : 1;
      const RunResult run = run_of(built_of(fmt::format(R"(title = "landing"
bonded = false
method = "lagrange"
[nodes]
b = [0, 0]
[[rigid]]
node = "b"
mass = 1000
inertia = 300
[[support]]
node = "b"
fixed = ["rz"]
[[initial]]
node = "b"
velocity = [{}, 0]
[gravity]
[[interface]]
name = "f"
gap = 0.05
pairs = {{ upper = ["b"], area = 1 }}
law = {{ type = "coulomb", friction = 0.4 }}
[limits]
separation = 100
[[stage]]
type = "dynamic"
duration = {}
step = {}
)",
                                                        sign * sideways, step * std::round(duration / step), step)));
      ASSERT_EQ(run.status, RunStatus::completed) << step << run.reason;
      EXPECT_NEAR(run.final_energy.impact, impact, 0.02 * impact) << step;
      EXPECT_NEAR(run.final_energy.interface_dissipated, rubbed, 0.01 * rubbed) << step;
      EXPECT_LT(run.energy_created, 1e-3 * impact) << step;
    }
}

}  // namespace
}  // namespace uplift::energy_of_landing_test
