// A block on soil, meshed with quads, both free to part and to slide: the condensed step through the split factor against Newton's method
// on all unknowns, every step from the same beginning.
#include <gtest/gtest.h>

#include <cmath>

#include "oracle_models.h"
#include "uplift/dynamics/bulk.h"
#include "uplift/elements/solid.h"
#include "uplift/interface/face_joint.h"
#include "uplift/mesh/soil_box.h"

namespace uplift::whole::oracle_soil_test {
namespace {

/// Soil 24 x 8 m with a block 4 x 10 m, elements of 2 m, a push on the block's top that lifts its heel.
Whole block_on_soil(const Part& behaviour, const Part& method, const Part& impact, Cell cell = Cell::quad4, double embedment = 0) {
  SoilBox box;
  box.cell = cell;
  box.soil.width = {24, 0};
  box.soil.layers = {{8, 2}};
  box.soil.size = box.block.size = 2;
  box.block.width = {4, 0};
  box.block.height = 10;
  box.embedment = embedment;
  Mesh mesh = soil_box(box, here);
  const std::vector<OpenedSurface> opened = split(mesh, {"interface"}, {"soil_1"}, here);
  const auto coordinates = std::make_shared<const std::vector<Vec3>>(mesh.nodes);

  Whole whole;
  ModelBuilder builder;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) builder.add_node("mesh." + std::to_string(i), mesh.nodes[i].head<2>(), here);
  const auto add_solids = [&](const char* group, const ElasticMaterial& material) {
    SolidSection section;
    section.material = material;
    for (const CellId id : mesh.groups.at(group).cells)
      builder.add_element(std::make_unique<Solid>(mesh.type(id), mesh.cell(id), coordinates, section), here);
  };
  add_solids("soil_1", {200e6, 0.3, 2000});
  add_solids("block", {20e9, 0.2, 2500});
  for (const int node : nodes_of(mesh, mesh.groups.at("soil_bottom")))
    for (const Dof dof : {ux, uy}) builder.fix(node, dof, here);
  const std::vector<int> top = nodes_of(mesh, mesh.groups.at("block_top"));
  std::vector<std::pair<int, double>> push;
  for (const int node : top) push.emplace_back(builder.space().at(node, ux), 1.2e6 / static_cast<double>(top.size()));
  builder.add_load("push", push, function({"half_sine", {{"duration", 0.2}}}), false, here);
  builder.set_gravity({0, -9.81}, here);
  BulkDamping damping;
  damping.beta = 1e-4;
  builder.set_damping(damping);
  InterfaceSpec base;
  base.name = "base";
  base.points = face_points(mesh, opened[0].faces, FaceQuadrature::nodal, 1, 0);
  behave(behaviour, base, whole);
  builder.add_interface(std::move(base), here);
  whole.model = builder.finish();
  EXPECT_GT(whole.model.free(), small_bulk);
  choose(whole, method, impact);
  whole.plan.stages = {settle(4), march(2e-3, 80)};
  whole.plan.created_limit = whole.plan.rotation_limit = 1e30;
  return whole;
}

void check_each_step(Whole whole, const std::string& name) {
  SCOPED_TRACE(name);
  whole.plan.oracle_tolerance = 1e-8;
  for (Stage& stage : whole.plan.stages) stage.halvings = 0;
  const RunResult result = whole.run();
  EXPECT_EQ(result.status, RunStatus::completed) << result.reason;
  EXPECT_GT(result.max_opening.value, 1e-5);
}

const Part springs{"springs", {{"K_n", 2e9}, {"tangential", "coulomb"}, {"K_t", 1e9}, {"friction", 0.4}}};
const Part sdm{"sdm",
               {{"K_n", 2e9}, {"F_u", 1e4}, {"G_f", 5.0}, {"F_c", -1e3}, {"tangential", "coulomb"}, {"K_t", 1e9}, {"friction", 0.4}}};

TEST(Oracle, BlockOnSoilOnTractionLaws) {
  check_each_step(block_on_soil(springs, {"newton"}, {"none"}), "springs with friction");
  check_each_step(block_on_soil(sdm, {"newton"}, {"none"}), "sdm with friction");
  check_each_step(block_on_soil(springs, {"newton"}, {"none"}, Cell::tri6), "second-order triangles");
  check_each_step(block_on_soil(springs, {"newton"}, {"none"}, Cell::quad4, 2), "an embedded block");
}

TEST(Oracle, BlockOnSoilWithConstraints) {
  check_each_step(block_on_soil({"coulomb", {{"friction", 0.4}}}, {"lagrange"}, {"project_hold"}), "lagrange with friction");
}

/// With a law that stores what it takes (no friction, no damage) the path-averaged step gains and loses nothing.
TEST(Oracle, BlockOnSoilKeepsItsEnergy) {
  Whole whole = block_on_soil({"springs", {{"K_n", 2e10}, {"tangential", "bonded"}, {"K_t", 2e10}}}, {"newton"}, {"none"});
  const RunResult result = whole.run();
  ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
  EXPECT_GT(result.max_uplifted_ratio.value, 0.2);
  EXPECT_LE(result.energy_created, 1e-10 * result.energy_scale);
}

}  // namespace
}  // namespace uplift::whole::oracle_soil_test
