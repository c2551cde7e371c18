#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "simple_meshes.h"
#include "text_support.h"
#include "uplift/case/case.h"
#include "uplift/io/text/toml.h"

// Water pressure in the joint under a base.
namespace uplift::water_test {
namespace {

constexpr double width = 10, weight = 3e6, unit_weight = 9810;  // m, N, N/m3

BuiltCase built_of(const std::string& text, const Mesh& mesh = {}) {
  static std::vector<std::unique_ptr<Case>> kept;  // a model points into its case
  kept.push_back(std::make_unique<Case>(check_case(read_toml_text(text, "case.toml"), "case.toml",
                                                   [&](const std::string&, const Where&, const std::string&) { return mesh; })));
  return build(*kept.back(), RunSpec{});
}

RunResult run_of(const BuiltCase& built) {
  RunResult result = run(built.model, built.plan, built.behaviours);
  EXPECT_EQ(result.status, RunStatus::completed) << result.reason;
  return result;
}

double last(const RunResult& result, const std::string& name) {
  for (std::size_t k = 0; k < result.columns.size(); ++k)
    if (result.columns[k].name == name) return result.table[k + 1].back();
  ADD_FAILURE() << name;
  return 0;
}

/// A rigid block of 3 MN on a strip of 10 m x 1 m under a moment and with water in the joint.
std::string block(const std::string& water, double moment,
                  const std::string& law = "{ type = \"springs\", K_n = 1e8, tangential = \"none\" }",
                  const std::string& stages = "[[stage]]\ntype = \"static\"\nsteps = 1\n") {
  return "title = \"block\"\n[nodes]\nbody = [0, 4]\n[[mass]]\nnode = \"body\"\nmass = 3e5\ninertia = 3e6\n"
         "[[support]]\nnode = \"body\"\nfixed = [\"ux\"]\n"
         "[gravity]\nacceleration = [0, -10]\n[[interface]]\nname = \"base\"\n"
         "footing = { body = \"body\", width = 10, points = 401, offset = [0, -4] }\nlaw = " +
         law + "\n" + water + fmt::format("[[load]]\nnode = \"body\"\nmoment = {}\n", moment) + stages;
}

const std::string head = "water = { head = \"20 m\" }\n";  // 196.2 kPa, 1.962 MN
constexpr double effective = weight - 20 * unit_weight * width;

TEST(WaterUnderABase, CarriesItsShareOfTheWeight) {
  const BuiltCase built = built_of(block(head, 0));
  EXPECT_NEAR(built.weight(), effective, 1e-9 * weight);
  const RunResult result = run_of(built);
  EXPECT_NEAR(last(result, "base.axial"), -effective, 1e-9 * weight);
  EXPECT_NEAR(result.max_pressure.value, effective / width, 1e-9 * weight / width);
  EXPECT_EQ(result.max_uplifted_ratio.value, 0);
}

TEST(WaterUnderABase, BringsTheUpliftForward) {
  // The edge opens when M = (W - u A) B/6; without water it would be W B/6.
  const double onset = effective * width / 6;
  EXPECT_EQ(run_of(built_of(block(head, 0.999 * onset))).max_uplifted_ratio.value, 0);
  EXPECT_GT(run_of(built_of(block(head, 1.01 * onset))).max_uplifted_ratio.value, 0);
  // Beyond it the pressures are a triangle: M = N (B/2 - x/3) over the contact length x.
  const double length = 6, moment = effective * (width / 2 - length / 3);
  EXPECT_NEAR(run_of(built_of(block(head, moment))).max_uplifted_ratio.value, 1 - length / width, 2e-4);
  EXPECT_NEAR(run_of(built_of(block(head, moment))).max_pressure.value, 2 * effective / length, 1e-3 * effective);
}

TEST(WaterUnderABase, WithConstraintsToo) {
  const double length = 6, moment = effective * (width / 2 - length / 3);
  const RunResult result = run_of(built_of(block(head, moment, "\"unilateral\"")));
  EXPECT_NEAR(last(result, "base.axial"), -effective, 1e-9 * weight);
  EXPECT_NEAR(result.max_pressure.value, 2 * effective / length, 2e-2 * effective / length);
}

TEST(WaterUnderABase, ClosesTheBalanceOfARockingBlock) {
  // The pressure does not change when the joint opens: it is a constant force at every point, whose work is external.
  const std::string rocks =
      "[[initial]]\nnode = \"body\"\nangular_velocity = 0.05\n[limits]\nrotation = 0.5\n[[stage]]\ntype = \"static\"\n"
      "[[stage]]\ntype = \"dynamic\"\nduration = 2\nstep = 5e-4\n";
  const BuiltCase built = built_of(block(head, 0, "{ type = \"springs\", K_n = 1e8, tangential = \"none\" }", rocks));
  const RunResult result = run_of(built);
  EXPECT_GT(result.max_uplifted_ratio.value, 0.3);
  EXPECT_LT(result.energy_created, 1e-9 * result.energy_scale);
  EXPECT_LT(result.energy_lost, 1e-9 * result.energy_scale);
  EXPECT_LT(result.equilibrium.residual, 1e-9);
}

/// Soil from -4 m to 0 and a block of 2 m on all of it, with the base at an angle when `slope` is given.
Mesh column(double slope) {
  Grid lines{uniform_lines(0, 6, 6), uniform_lines(-4, 2, 6), {}};
  Mesh mesh = grid(
      lines, [](int, int j, int) { return j < 4 ? 0 : 1; }, {"soil", "block"},
      [](int part, Direction direction, int other) -> std::string {
        if (part == 0 && other == 1) return "base";
        return other < 0 ? (part == 0 ? "soil_" : "block_") + std::string(name_of(direction)) : "";
      });
  for (Vec3& x : mesh.nodes)
    if (x.y() == 0) x.y() += slope * x.x();
  return mesh;
}

std::string column_text(const std::string& water) {
  return "title = \"column\"\n[mesh]\nfile = \"mesh.msh\"\n[[solid]]\ngroup = \"soil\"\nE = 5e7\npoisson = 0.3\ndensity = 1900\n"
         "[[solid]]\ngroup = \"block\"\nE = 2e9\npoisson = 0.3\ndensity = 2400\n[gravity]\nacceleration = [0, -10]\n"
         "[[support]]\ngroup = \"soil_bottom\"\nfixed = [\"ux\", \"uy\"]\n[[support]]\ngroup = \"block_left\"\nfixed = [\"ux\"]\n"
         "[[interface]]\nname = \"base\"\nsurface = { group = \"base\", lower = [\"soil\"] }\nlaw = { type = \"elastic\", K_n = 1e9, K_t = "
         "1e9 }\n" +
         water +
         "[[output.history]]\nname = \"reaction\"\ngroup = \"soil_bottom\"\nquantity = \"reaction_y\"\n[[stage]]\ntype = \"static\"\n"
         "[[stage]]\ntype = \"dynamic\"\nduration = 1e-3\nstep = 1e-3\n";
}

TEST(WaterUnderABase, LeavesTheForceOnTheSoilAsItIs) {
  const double block_weight = 2400 * 10.0 * 6 * 2, soil_weight = 1900 * 10.0 * 6 * 4, water = 3 * unit_weight * 6;
  const RunResult result = run_of(built_of(column_text("water = { level = \"3 m\" }\n"), column(0)));
  EXPECT_NEAR(last(result, "base.axial"), water - block_weight, 1e-9 * block_weight);
  EXPECT_NEAR(last(result, "reaction"), block_weight + soil_weight, 1e-8 * block_weight);
}

TEST(WaterUnderABase, ByALevelThatTheBaseCrosses) {
  // Base y = x/10 from x = 0 to 6 m, level 0.3 m: on the lower half of it the pressure falls from 0.3 m of water to zero. The nodal rule
  // has points at x = 0, 1, 2, 3: the trapezoidal rule is exact for the triangle.
  const double slope = 0.1, length = 3 * std::sqrt(1 + slope * slope), force = unit_weight * 0.3 * length / 2;
  const BuiltCase built = built_of(column_text("water = { level = 0.3, unit_weight = \"9.81 kN/m3\" }\n"), column(slope));
  const auto time_load = std::ranges::find(built.model.time_loads, "water pressure in base", &TimeLoad::name);
  ASSERT_NE(time_load, built.model.time_loads.end());
  EXPECT_TRUE(time_load->dead);
  const Vector load = built.model.assembly.loads[static_cast<std::size_t>(time_load - built.model.time_loads.begin())];
  Vec3 block_side = Vec3::Zero(), both = Vec3::Zero();
  for (int node = 0; node < static_cast<int>(built.model.nodes.size()); ++node) {
    const Vec3 here(load[3 * node], load[3 * node + 1], 0);
    both += here;
    if (here.y() > 0) block_side += here;
  }
  EXPECT_NEAR(block_side.y(), force / std::sqrt(1 + slope * slope), 1e-9 * force);
  EXPECT_NEAR(block_side.x(), -slope * force / std::sqrt(1 + slope * slope), 1e-9 * force);
  EXPECT_LT(both.norm(), 1e-9 * force);
}

TEST(WaterUnderABase, ThatMakesNoSenseIsRefused) {
  const auto refusal = [](const std::string& water) { return support::refusal_of([&] { built_of(block(water, 0)); }); };
  EXPECT_NE(refusal("water = { }\n").find("either level or head"), std::string::npos);
  EXPECT_NE(refusal("water = { level = 3, head = 2 }\n").find("either level or head"), std::string::npos);
  EXPECT_NE(refusal("water = { head = -2 }\n").find("head"), std::string::npos);
}

/// A sampled water table may lie below the base: there is no water then, and a note.
TEST(WaterUnderABase, BelowTheBaseHasNoPressure) {
  const BuiltCase built = built_of(block("water = { level = -1 }\n", 0));
  EXPECT_EQ(std::ranges::find(built.model.time_loads, "water pressure in base", &TimeLoad::name), built.model.time_loads.end());
  ASSERT_EQ(built.notes.size(), 1);
  EXPECT_EQ(built.notes.front(), "the water stands below the joint \"base\": it has no pressure there");
  EXPECT_TRUE(built_of(block("", 0)).notes.empty());
}

TEST(WaterUnderABase, WithPDeltaNeedsItsBodyAtTheUnderside) {
  // A rigid block of 4 m above its base: P-delta takes away W h of the rocking stiffness K_n B^3/12, with and without water.
  const auto text = [](const std::string& water) {
    return support::replaced(
        support::replaced(
            support::replaced(block(water, 1e5, "{ type = \"elastic\", K_n = 1e8, tangential = \"none\" }",
                                    "[[stage]]\ntype = \"static\"\nsteps = 1\n[[stage]]\ntype = \"dynamic\"\nduration = 1e-4\nstep = "
                                    "1e-4\np_delta = true\n[[output.history]]\nnode = \"foot\"\nquantity = \"rz\"\n"),
                              "body = \"body\"", "body = \"foot\""),
            ", offset = [0, -4]", ""),
        "body = [0, 4]\n", "body = [0, 4]\nfoot = [0, 0]\n[[rigid]]\nnode = \"foot\"\nslaves = [\"body\"]\n");
  };
  const auto rotation = [&](const std::string& water) {
    return last(run_of(built_of(support::replaced(text(water), "[[support]]\nnode = \"body\"", "[[support]]\nnode = \"foot\""))),
                "foot.rz");
  };
  double inertia = 0;  // of the trapezoidal rule with 401 points
  for (int i = 0; i <= 400; ++i) inertia += (i % 400 == 0 ? 0.5 : 1) * 0.025 * std::pow(-5 + 0.025 * i, 2);
  const double exact = 1e5 / (1e8 * inertia - weight * 4);
  EXPECT_NEAR(rotation(""), exact, 1e-6 * exact);
  EXPECT_NEAR(rotation(head), exact, 1e-6 * exact);
  const std::string found = support::refusal_of([&] { built_of(block(head, 0) + "p_delta = true\n"); });
  EXPECT_NE(found.find("no offset of the footing with water"), std::string::npos) << found;
}

TEST(WaterUnderABase, ThatLiftsTheStructureIsReported) {
  const BuiltCase built = built_of(block("water = { head = 31 }\n", 0));
  const RunResult result = run(built.model, built.plan, built.behaviours);
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_NE(result.reason.find("nothing holds"), std::string::npos) << result.reason;
}

}  // namespace
}  // namespace uplift::water_test
