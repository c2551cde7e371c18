// Filtered energy decay takes a short way for registers of points that go on as they are. Eight points of one interface fill registers; the
// same points in interfaces of three, three and two never do, and go the general way.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "unit/case/cut_support.h"

namespace uplift::decay_registers_test {
namespace {

using namespace support;

std::string base(const std::string& name, double width, int points, double offset, const std::string& law) {
  return fmt::format(
      "[[interface]]\nname = \"{}\"\nlaw = {}\nfooting = {{ body = \"base\", width = {}, points = {}, rule = \"midpoint\", offset = [{}, "
      "0] }}\n",
      name, law, width, points, offset);
}

RunResult rocking(const std::string& interfaces) {
  return run_on(R"(title = "tower"
bonded = false
[nodes]
top = [0, 5]
base = [0, 0]
[[beam]]
name = "column"
nodes = ["base", "top"]
E = 2e10
I = 0.2
[[mass]]
node = "top"
mass = 24317.0841
[[rigid]]
name = "footing"
node = "base"
mass = 1e4
inertia = 7500
[[support]]
node = "base"
fixed = ["ux"]
[[function]]
name = "pulse"
shape = { type = "half_sine", duration = 0.1 }
[[load]]
node = "top"
force = [0, -1e6]
[[load]]
node = "top"
force = [5e5, 0]
function = "pulse"
[[output.history]]
name = "top"
node = "top"
quantity = "ux"
[[output.history]]
name = "heave"
node = "base"
quantity = "uy"
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 1
step = 1e-3
scheme = { type = "energy_decay", rho = 0.5 }
)" + interfaces,
                {});
}

TEST(DecayRegisters, PointsInFullRegistersMoveAsPointsOneByOne) {
  for (const std::string law : {R"({ type = "springs", K_n = 2e8 })", R"({ type = "springs", K_n = 2e8, c = 1e5 })",
                                R"({ type = "sdm", K_n = 2e8, F_u = 1e5, G_f = 100, F_c = -1e3 })", R"({ type = "elastic", K_n = 2e8 })",
                                R"({ type = "bilinear", K_n = 2e8, F_u = 1.2e5, G_f = 200 })"}) {
    const RunResult whole = rocking(base("all", 3, 8, 0, law)),
                    parts = rocking(base("left", 1.125, 3, -0.9375, law) + base("middle", 1.125, 3, 0.1875, law) +
                                    base("right", 0.75, 2, 1.125, law));
    const auto open = history(whole, "all.uplifted_ratio");
    if (law.find("elastic") == law.npos) EXPECT_GT(*std::ranges::max_element(open), 0.2) << law << ": the base lifts";
    for (const char* column : {"top", "heave"}) {
      const auto expected = history(parts, column), found = history(whole, column);
      ASSERT_EQ(found.size(), expected.size());
      double largest = 0, apart = 0;
      for (std::size_t i = 0; i < found.size(); ++i) {
        largest = std::max(largest, std::abs(expected[i]));
        apart = std::max(apart, std::abs(found[i] - expected[i]));
      }
      EXPECT_GT(largest, 1e-4);
      EXPECT_LT(apart, 1e-8 * largest) << law << ", " << column;
    }
  }
}

}  // namespace
}  // namespace uplift::decay_registers_test
