#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "uplift/case/case.h"
#include "uplift/io/text/toml.h"

// `interface_solver` of a case: by which way the linear problems of an interface are solved must not show in the results.
namespace uplift::interface_solver_test {
namespace {

/// A raft on soil, in the plane or in space, that a pulse rocks, lifts and shoves.
std::string raft_on_soil(bool space, const std::string& solver, const std::string& joint, double friction = 0.4) {
  const std::string length = space ? "length = 12\n" : "", across = space ? ", \"uz\"" : "", third = space ? ", 0" : "";
  std::string text = "title = \"raft\"\nbonded = false\ninterface_solver = \"" + solver + "\"\n" + joint +
                     fmt::format(", friction = {} }}", friction) + R"(
[mesh.soil_box]
cell = ")" + (space ? "hex8" : "quad4") +
                     R"("
[mesh.soil_box.soil]
)" + length + R"(width = 12
size = 3
layers = [{ thickness = 6, size = 3 }]
[mesh.soil_box.raft]
width = 6
height = 2
size = )" + (space ? "1.5" : "0.5") +
                     R"(
[[solid]]
group = "soil_1"
E = 5e7
poisson = 0.3
density = 1900
[[solid]]
group = "raft"
E = 2e10
poisson = 0.2
density = 2500
[[support]]
group = "soil_bottom"
fixed = ["ux", "uy")" +
                     across + R"(]
[gravity]
acceleration = [0)" + third +
                     R"(, -10]
[[function]]
name = "pulse"
shape = { type = "half_sine", duration = 0.1 }
[[load]]
name = "pulse"
group = "raft_top"
function = "pulse"
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 0.15
step = 0.005
)";
  const std::string force = space ? "force = [4e6, 1.5e6, 0]\n" : "force = [4.5e5, 0]\n";
  return text.insert(text.find("function = \"pulse\""), force);
}

RunResult solved(const std::string& text) {
  const Case read = check_case(read_toml_text(text, "case.toml"), "case.toml", {});
  const BuiltCase built = build(read, runs_of_case(read).front());
  RunResult result = run(built.model, built.plan, built.behaviours);
  EXPECT_EQ(to_string(result.status), "completed") << result.reason;
  return result;
}

const std::string constrained = R"([[interface]]
name = "joint"
surface = { group = "interface", lower = ["soil_1"] }
law = { type = "coulomb")";
const std::string sprung = R"([[interface]]
name = "joint"
surface = { group = "interface", lower = ["soil_1"] }
law = { type = "springs", K_n = 1e9, K_t = 1e9, tangential = "coulomb")";

// Claim: a factor at every linear problem, none at all, and the automatic choice give the same run to 1e-9 of every peak, in the plane and
// in space, with constraints and with springs, where the raft lifts off and slides; and each way is the one that was asked for, but for
// the few problems that the iteration leaves to a factor.
TEST(InterfaceSolver, DoesNotShowInTheResults) {
  for (const bool space : {false, true})
    for (const std::string& joint : {constrained, sprung}) {
      SCOPED_TRACE((space ? "space " : "plane ") + joint);
      const RunResult direct = solved(raft_on_soil(space, "direct", joint));
      EXPECT_GT(direct.max_uplifted_ratio.value, 0.2);
      EXPECT_GT(solved(raft_on_soil(space, "direct", joint, 5)).max_base_shear.value, 1.2 * direct.max_base_shear.value);  // it slides
      EXPECT_GT(direct.counts.systems.factored, 30);
      EXPECT_EQ(direct.counts.systems.iterated, 0);
      for (const char* way : {"krylov", "automatic"}) {
        SCOPED_TRACE(way);
        const RunResult other = solved(raft_on_soil(space, way, joint));
        EXPECT_GT(other.counts.systems.iterated, 30);
        if (way == std::string("krylov"))
          EXPECT_LT(other.counts.systems.factored, 0.05 * static_cast<double>(other.counts.systems.iterated));
        const std::pair<const Peak*, const Peak*> peaks[] = {{&direct.max_opening, &other.max_opening},
                                                             {&direct.max_base_moment, &other.max_base_moment},
                                                             {&direct.max_base_shear, &other.max_base_shear},
                                                             {&direct.max_pressure, &other.max_pressure}};
        for (const auto& [a, b] : peaks) EXPECT_NEAR(b->value, a->value, 1e-9 * std::abs(a->value)) << a->name;
        EXPECT_NEAR(other.final_energy.strain, direct.final_energy.strain, 1e-9 * direct.energy_scale);
      }
    }
}

}  // namespace
}  // namespace uplift::interface_solver_test
