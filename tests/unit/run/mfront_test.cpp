// Solids of a shared library with the generic interface of MFront (tests/mfront_behaviours.c), in whole runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simple_meshes.h"
#include "unit/run/plastic_support.h"

namespace uplift::mfront_test {
using namespace plastic_test;
namespace {

std::string library_law(const std::string& behaviour, const std::string& rest = {}) {
  return "law = { type = \"mfront\", library = \"" UPLIFT_MFRONT_LIBRARY "\", behaviour = \"" + behaviour + "\"" + rest + " }\n";
}

const std::string cone_of_library = library_law("DruckerPrager",
                                                ", properties = { Cohesion = \"20 kPa\", FrictionAngle = 0.4, DilatancyAngle = 0.1, "
                                                "HardeningSlope = \"1 MPa\" }");
const std::string cone_of_program =
    "law = { type = \"drucker_prager\", cohesion = \"20 kPa\", friction_angle = 0.4, dilatancy_angle = 0.1, hardening = \"1 MPa\" }\n";

RunResult result_of(const std::string& text, const Mesh* mesh = nullptr) {
  const Prepared made = prepared(text, mesh);
  return run(made.built.model, made.built.plan, made.built.behaviours);
}

TEST(MfrontRun, DruckerPragerOfTheLibraryGivesTheRunOfTheProgram) {
  for (const std::string& loads : {static_push, shaken(180e3, 0.2)}) {
    const RunResult theirs = result_of(block_on_soil(cone_of_library, springs, loads)),
                    ours = result_of(block_on_soil(cone_of_program, springs, loads));
    ASSERT_EQ(ours.status, RunStatus::completed) << ours.reason;
    ASSERT_EQ(theirs.status, RunStatus::completed) << theirs.reason;
    ASSERT_EQ(theirs.table.size(), ours.table.size());
    for (std::size_t k = 0; k < ours.columns.size(); ++k) {
      const std::vector<double>&a = theirs.table[k + 1], &b = ours.table[k + 1];
      ASSERT_EQ(a.size(), b.size());
      if (ours.columns[k].name == "energy.residual") continue;  // round-off
      double peak = 0;
      for (const double value : b) peak = std::max(peak, std::abs(value));
      for (std::size_t i = 0; i < b.size(); ++i) ASSERT_NEAR(a[i], b[i], 1e-10 * peak) << ours.columns[k].name << ' ' << i;
    }
    EXPECT_GT(ours.final_energy.plastic, 0.01 * ours.energy_scale);
    EXPECT_LE(std::max(theirs.energy_created, theirs.energy_lost), 1e-9 * theirs.energy_scale);
  }
}

TEST(MfrontRun, EnergyThatTheLibraryStoresIsPartOfTheLedger) {
  // With the same strength and without hardening more is dissipated: Prager's hardening locks energy up.
  const auto pushed = [](const std::string& slope) {
    return result_of(block_on_soil(library_law("Prager", ", properties = { YieldStrength = \"60 kPa\", HardeningSlope = " + slope + " }"),
                                   springs, shaken(150e3, 0.2)));
  };
  const RunResult result = pushed("2e7");
  ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
  EXPECT_GT(result.final_energy.plastic, 0.001 * result.energy_scale);
  EXPECT_LE(std::max(result.energy_created, result.energy_lost), 1e-9 * result.energy_scale);
}

/// A column 2 m high of 1 x 1 m that can move along x alone, sheared from above; without mass.
std::string sheared_column(const std::string& law, double shear) {
  return R"(title = "sheared column"
[mesh]
file = "column.msh"
[[solid]]
group = "soil"
E = 5e7
poisson = 0.25
density = 1e-6
)" + law +
         R"([[support]]
group = "soil"
fixed = ["uy", "uz"]
[[support]]
group = "soil_bottom"
fixed = ["ux"]
[[load]]
name = "shear"
group = "soil_top"
traction = [)" +
         std::to_string(shear) + R"(, 0, 0]
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
step = 0.01
duration = 0.5
[[output.history]]
name = "top"
at = [1, 1, 2]
quantity = "ux"
)";
}

TEST(MfrontRun, CreepAdvancesWithTheTimeOfTheRun) {
  // Maxwell's fluid under a constant shear stress t: strain t/G after the static stage, which has no time, then the rate t/viscosity.
  Grid lines{uniform_lines(0, 1, 1), uniform_lines(0, 1, 1), uniform_lines(0, 2, 2)};
  const Mesh column_mesh = grid(
      lines, [](int, int, int) { return 0; }, {"soil"},
      [](int, Direction direction, int) { return "soil_" + std::string(name_of(direction)); });
  const double shear = 1e3, viscosity = 1e6, modulus = 5e7 / 2.5, height = 2;
  const RunResult result = result_of(sheared_column(library_law("Maxwell", ", properties = { Viscosity = 1e6 }"), shear), &column_mesh);
  ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
  const std::vector<double>&time = result.table[0], &top = column(result, "top");
  ASSERT_GT(time.size(), 40u);
  for (std::size_t i = 0; i < time.size(); ++i) {
    const double expected = height * shear * (1 / modulus + time[i] / viscosity);
    EXPECT_NEAR(top[i], expected, 1e-6 * expected) << time[i];
  }
}

TEST(MfrontRun, ARefusedStepIsShortenedOrFailsWithTheReason) {
  const RunResult refused =
      result_of(block_on_soil(library_law("Brittle", ", properties = { StrainLimit = 4e-3 }"), springs, shaken(400e3, 0.2)));
  EXPECT_EQ(refused.status, RunStatus::failed);
  EXPECT_NE(refused.reason.find("behaviour \"Brittle\" of MFront: the strain is beyond StrainLimit"), std::string::npos) << refused.reason;
  EXPECT_GT(refused.table[0].size(), 2u);  // what was computed before is kept

  // one that takes steps of up to 1.5 ms: the steps of 2 ms are taken in halves
  const RunResult halves = result_of(block_on_soil(library_law("Impatient"), springs, shaken(100e3, 0.1))),
                  linear = result_of(block_on_soil("", springs, shaken(100e3, 0.1, 1e-3)));
  ASSERT_EQ(halves.status, RunStatus::completed) << halves.reason;
  ASSERT_EQ(linear.status, RunStatus::completed) << linear.reason;
  const double peak = *std::ranges::max_element(column(linear, "top.ux"));
  EXPECT_NEAR(column(halves, "top.ux").back(), column(linear, "top.ux").back(), 1e-9 * peak);
}

TEST(MfrontRun, CasesRefuseAndRememberTheLibrary) {
  const std::string found = refusal(block_on_soil(library_law("Linnear"), springs, static_push));
  EXPECT_NE(found.find("case.toml:17: solid[0].law.behaviour"), std::string::npos) << found;
  EXPECT_NE(found.find("did you mean \"Linear\""), std::string::npos) << found;
  EXPECT_NE(refusal(block_on_soil("plane = \"stress\"\n" + library_law("Linear"), springs, static_push)).find("plane = \"strain\""),
            std::string::npos);
  // the library is among the input files, whose hashes the results state
  const Prepared made = prepared(block_on_soil(cone_of_library, springs, static_push));
  EXPECT_EQ(input_files(*made.read), std::vector<std::string>{UPLIFT_MFRONT_LIBRARY});
  // the case as it was computed gives the same case again
  const std::string resolved = to_toml(made.read->values);
  EXPECT_EQ(to_toml(prepared(resolved).read->values), resolved);
}

}  // namespace
}  // namespace uplift::mfront_test
