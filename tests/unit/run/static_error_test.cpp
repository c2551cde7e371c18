// The error of the trapezoidal work of a static stage is no energy that the scheme of a dynamic stage creates.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "ran_support.h"

namespace uplift::static_error_test {
namespace {

/// A footing on a joint that softens, pushed in one load step; then it is shaken.
std::string pushed(const std::string& stages) {
  return "title = \"stages\"\nbonded = false\n[nodes]\ntop = [0, 4]\nbase = [0, 0]\n[[beam]]\nname = \"column\"\nnodes = [\"base\", "
         "\"top\"]\nE = 2e10\nI = 0.2\n[[mass]]\nname = \"head\"\nnode = \"top\"\nmass = 20000\n[[rigid]]\nname = \"footing\"\n"
         "node = \"base\"\nmass = 10000\ninertia = 7500\n[[interface]]\nname = \"soil\"\nfooting = { body = \"base\", width = 3, "
         "points = 11 }\nlaw = { type = \"sdm\", K_n = 2e8, F_u = 1e4, G_f = 1, F_c = -1e3, tangential = \"bonded\", K_t = 2e8 }\n"
         "[[load]]\nname = \"dead\"\nnode = \"top\"\nforce = [0, -1e6]\n[[load]]\nname = \"push\"\nnode = \"top\"\nforce = "
         "[1.9e5, 0]\n[[function]]\nname = \"f\"\nshape = { type = \"harmonic\", amplitude = 1, frequency = 3 }\n[[load]]\nname = "
         "\"shake\"\nnode = \"top\"\nforce = [3e4, 0]\nfunction = \"f\"\n" +
         stages;
}

TEST(StaticError, IsNotCreatedByTheSchemeOfTheDynamicStages) {
  const std::string rest = "[[stage]]\ntype = \"static\"\nsteps = 1\n",
                    shake = "[[stage]]\ntype = \"dynamic\"\nduration = 0.3\nstep = 1e-3\n";
  const support::Ran still = support::run_text(pushed(rest));
  ASSERT_EQ(still.result.status, RunStatus::completed) << still.result.reason;
  const double error = std::abs(still.result.final_energy.residual);
  for (const std::string& stages : {rest + shake, rest + shake + rest + shake}) {
    const support::Ran ran = support::run_text(pushed(stages));
    ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
    EXPECT_GT(error, 1e-4 * ran.result.energy_scale);
    EXPECT_LE(ran.result.energy_created, 1e-12 * ran.result.energy_scale);
    EXPECT_LE(ran.result.energy_lost, 1e-12 * ran.result.energy_scale);
  }
}

}  // namespace
}  // namespace uplift::static_error_test
