// Blocks of many plans and meshes that rest on soil by contact and friction alone: statics carry the weight, whatever the method.
#include <gtest/gtest.h>

#include "manual.h"
#include "mesh_support.h"
#include "uplift/mesh/soil_box.h"

namespace uplift::verification::mesh_statics_test {
namespace {

struct Plan {
  double width, length, soil_length, size;  // m
};

class MeshStatics : public testing::TestWithParam<Plan> {};
INSTANTIATE_TEST_SUITE_P(Plans, MeshStatics,
                         testing::Values(Plan{4, 1, 1, 2}, Plan{4, 1, 1, 1}, Plan{4, 1, 3, 2}, Plan{4, 2, 6, 2}, Plan{4, 4, 4, 2},
                                         Plan{4, 4, 12, 2}, Plan{4, 4, 12, 4}, Plan{4, 6, 12, 2}));

// Claim: a block 10 m high under its weight: the joint carries rho g V (1e-6), and the block settles by millimetres. Soil 16 x 6 m, E = 200
// MPa: p H/M alone is 5 mm.
TEST_P(MeshStatics, ABlockOnSoilStandsByContactAndFriction) {
  VERIFIES({"Static equilibrium", "A block stands on soil by contact and friction", "Weight ρgV"});
  const Plan plan = GetParam();
  SoilBox box;
  box.dimension = 3;
  box.cell = Cell::hex8;
  box.soil.width = {16, plan.soil_length};
  box.soil.layers = {{6, 2}};
  box.soil.size = 2;
  box.block.width = {plan.width, plan.length};
  box.block.height = 10;
  box.block.size = plan.size;
  const double weight = 2500 * 9.81 * plan.width * plan.length * 10;
  for (const char* law :
       {"{ type = \"springs\", K_n = 2e10, tangential = \"coulomb\", friction = 0.4 }", "{ type = \"coulomb\", friction = 0.4 }"}) {
    SCOPED_TRACE(law);
    const std::string text = fmt::format(
        "title = \"block\"\n[mesh]\nfile = \"block.msh\"\n[[solid]]\ngroup = \"soil_1\"\nE = 200e6\npoisson = 0.3\ndensity = 2000\n"
        "[[solid]]\ngroup = \"block\"\nE = 20e9\npoisson = 0.2\ndensity = 2500\n[[support]]\ngroup = \"soil_bottom\"\nfixed = "
        "[\"ux\", \"uy\", \"uz\"]\n[[interface]]\nname = \"base\"\nsurface = {{ group = \"interface\", lower = [\"soil_1\"] }}\nlaw = {}\n"
        "[gravity]\nacceleration = [0, 0, -9.81]\n[[stage]]\ntype = \"static\"\nsteps = 4\n[[stage]]\ntype = \"dynamic\"\nduration = 1e-6\n"
        "step = 1e-6\n[energy]\ncreated_limit = 1e9\n[output]\nframes = 0\n",
        law);
    const MeshRun run = run_mesh(text, soil_box(box, {}));
    EXPECT_TRUE(run.completed()) << run.result.reason;
    VERIFY_NEAR("vertical force of the joint", "N", run["base.axial"][0], -weight, 1e-6 * weight);
    VERIFY_LT("settlement", "m", std::abs(run["top.uz"][0]), 0.02);
    VERIFY_EQ("uplifted share", "1", run["base.uplifted_ratio"][0], 0);
  }
}

}  // namespace
}  // namespace uplift::verification::mesh_statics_test
