// Sums of forces over the whole model at single instants: by the laws of motion, and whether they are kept until the end or made at once.
#include "uplift/run/equilibrium.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "ran_support.h"
#include "simple_meshes.h"
#include "unit/model/model_support.h"
#include "uplift/elements/solid.h"
#include "uplift/model/builder.h"
#include "uplift/run/force_rows.h"

namespace uplift::equilibrium_test {
namespace {

using support::here;

constexpr double density = 1900, width = 1.2, height = 2.0, gravity = 9.81;  // kg/m3, m, m, m/s2

/// A block of solids under its weight, held at its foot, which a prescribed motion moves along x where `moved`.
Model block(bool moved) {
  ModelBuilder builder(Space{3});
  const Mesh mesh = box({0, 0.5, width}, {0, width}, {0, 0.7, height});
  SolidSection section;
  section.material = {30e6, 0.3, density};
  const auto shared = std::make_shared<const SolidSection>(section);
  const auto coordinates = std::make_shared<const std::vector<Vec3>>(mesh.nodes);
  std::vector<int> foot;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const int node = builder.add_node("n" + std::to_string(i), mesh.nodes[i], here);
    if (mesh.nodes[i].z() == 0) foot.push_back(node);
  }
  const CellBlock& cells = mesh.blocks.front();
  for (int i = 0; i < cells.count(); ++i) builder.add_element(std::make_unique<Solid>(cells.cell, cells[i], coordinates, shared), here);
  for (const Dof dof : {ux, uy, uz})
    if (dof != ux || !moved)
      for (const int node : foot) builder.fix(node, dof, here);
  if (moved) builder.prescribe(foot, ux, std::make_shared<const One>(), "push", here);
  builder.set_gravity({0, 0, -gravity}, here);
  builder.set_damping(rayleigh(1, 0.05, 8, 0.05));
  return builder.finish();
}

Equilibrium of_states(const Model& model, const std::vector<State>& states, int most) {
  const ForceStage stage{model};
  EquilibriumCheck check(stage, most);
  for (const State& state : states) check.note(StepBalance::of_state(state, state.acceleration));
  Equilibrium found;
  check.finish(found);
  return found;
}

std::vector<State> random_states(const Model& model, int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1e-3, 1e-3);
  std::vector<State> states(static_cast<std::size_t>(count));
  for (State& state : states) {
    state.time = uniform(random);
    for (Vector* motion : {&state.displacement, &state.velocity, &state.acceleration})
      *motion = Vector::NullaryExpr(model.free(), [&] { return uniform(random); });
  }
  return states;
}

TEST(EquilibriumOfInstants, TheLoadOfABlockAtRestIsItsWeight) {
  const Model model = block(false);
  State state;
  state.displacement = state.velocity = state.acceleration = Vector::Zero(model.free());
  const Equilibrium found = of_states(model, {state}, 0);
  ASSERT_EQ(found.instants.size(), 1U);
  const double weight = density * width * width * height * gravity;
  EXPECT_NEAR(found.instants[0].applied.force.z(), -weight, 1e-10 * weight);
  EXPECT_TRUE(found.instants[0].internal.force.isZero(0));
}

TEST(EquilibriumOfInstants, ABodyThatMovesWithItsFootIsNotStrained) {
  const Model model = block(true);
  State state;
  state.displacement = state.velocity = state.acceleration = Vector::Zero(model.free());
  for (int i = 0; i < model.free(); ++i)
    if (model.space.dof(model.space.index_of(model.kept[static_cast<std::size_t>(i)])) == ux) state.displacement[i] = 1;
  const Equilibrium found = of_states(model, {state}, 0);  // the foot moves by 1 m, too
  ASSERT_EQ(found.instants.size(), 1U);
  const double weight = density * width * width * height * gravity, of_round_off = 1e-9 * 30e6 * width;
  EXPECT_LT(found.instants[0].largest_reaction, weight);
  EXPECT_NEAR(found.instants[0].reactions.force.x(), 0, of_round_off);
}

/// Ground whose supports are released, and that nothing shakes: its weight cancels what they have borne, and nothing is left but round-off.
TEST(EquilibriumOfInstants, GroundAtRestOnReleasedSupportsIsInEquilibrium) {
  const support::Ran ran = support::run_text(R"(title = "ground at rest"
[mesh.soil_box.soil]
width = 6
size = 1
[[mesh.soil_box.soil.layers]]
thickness = 4
[[solid]]
group = "soil_1"
shear_wave_speed = 150
poisson = 0.3
density = 1900
[gravity]
[[support]]
group = "soil_bottom"
fixed = ["ux", "uy"]
stages = "static"
[[absorbing]]
group = "soil_bottom"
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 0.1
step = 0.001
)");
  ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
  ASSERT_FALSE(ran.result.equilibrium.instants.empty());
  EXPECT_LT(ran.result.equilibrium.residual, 1e-9);
  EXPECT_EQ(ran.result.equilibrium.warning(), "");
}

TEST(EquilibriumOfInstants, KeepsOrSumsUpTheSameNumbers) {
  for (const bool moved : {false, true}) {
    const Model model = block(moved);
    const std::vector<State> states = random_states(model, 3);
    const Equilibrium kept = of_states(model, states, model.full_unknowns()), at_once = of_states(model, states, 0);
    ASSERT_EQ(kept.instants.size(), 3U);
    ASSERT_EQ(at_once.instants.size(), 3U);
    EXPECT_EQ(kept.residual, at_once.residual);
    for (std::size_t i = 0; i < 3; ++i) {
      const Equilibrium::Instant &one = kept.instants[i], &other = at_once.instants[i];
      EXPECT_EQ(one.time, states[i].time);
      EXPECT_EQ(one.largest_reaction, other.largest_reaction);
      for (const auto sum : {&Equilibrium::Instant::inertia, &Equilibrium::Instant::damping, &Equilibrium::Instant::internal,
                             &Equilibrium::Instant::applied, &Equilibrium::Instant::reactions, &Equilibrium::Instant::residual}) {
        EXPECT_EQ((one.*sum).force, (other.*sum).force);
        EXPECT_EQ((one.*sum).moment, (other.*sum).moment);
      }
      EXPECT_GT(one.inertia.force.norm(), 0);
    }
  }
}

}  // namespace
}  // namespace uplift::equilibrium_test
