// The motions or the steps of another run in a run that was built: those of a run that is built anew, or nothing at all.
#include <gtest/gtest.h>

#include <string>

#include "uplift/case/schema/case_input.h"
#include "uplift/session/steps.h"

namespace uplift::change_motion_test {
namespace {

/// A mass on a footing with the support motion or load that `drives` describes; a comparison puts the function "other" in the place of
/// "shake".
std::string footing(const std::string& drives) {
  return "title = \"footing\"\nbonded = false\n[nodes]\nn0 = [0, 0]\nn1 = [0, 5]\n"
         "[[beam]]\nname = \"b\"\nnodes = [\"n0\", \"n1\"]\nE = 2e10\nI = 0.2\nA = 1\n[[mass]]\nnode = \"n1\"\nmass = 5000\n"
         "[[rigid]]\nname = \"footing\"\nnode = \"n0\"\nmass = 1e4\ninertia = 2e4\n"
         "[[interface]]\nname = \"soil\"\nfooting = { body = \"n0\", width = 4, thickness = 2, points = 4, rule = \"midpoint\" }\n"
         "law = { type = \"springs\", K_n = 1e8, K_t = 5e7, tangential = \"coulomb\", friction = 0.6 }\n"
         "[gravity]\nacceleration = [0, -9.81]\n"
         "[[function]]\nname = \"shake\"\nshape = { type = \"ricker\", frequency = 1.5 }\n"
         "[[function]]\nname = \"other\"\nshape = { type = \"ricker\", frequency = 4 }\n" +
         drives +
         "[damping]\nrayleigh = [{ frequency = 1, ratio = 0.02 }, { frequency = 10, ratio = 0.02 }]\n"
         "[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\nduration = 1\nstep = 5e-3\n"
         "[[compare.motion]]\nname = \"another\"\nreplace = [\"shake\"]\nby = [\"other\"]\n";
}

constexpr const char* ground = "[[ground_acceleration]]\ndirection = [1, 0]\nfunction = \"shake\"\namplitude = 6\n";
constexpr const char* push = "[[load]]\nname = \"push\"\nnode = \"n1\"\nforce = [1e3, 0]\nfunction = \"shake\"\n";

struct Runs {
  explicit Runs(const std::string& drives) : read(load_case_text(footing(drives), "case.toml", "test", MeshFiles::in_process)) {
    other = own = runs_of_case(read.read).front();
    own.motion = nullptr;
    other.motion = &read.read.input->compare->motions.front();
    other.motion_factor = -2.5;
  }
  LoadedCase read;
  RunSpec own, other;
};

void expect_same(const Model& changed, const Model& anew) {
  ASSERT_EQ(changed.time_loads.size(), anew.time_loads.size());
  for (const double time : {0.0, 0.31, 0.8, 1.07}) {
    for (std::size_t k = 0; k < anew.time_loads.size(); ++k)
      EXPECT_EQ(changed.time_loads[k].factor(time), anew.time_loads[k].factor(time)) << anew.time_loads[k].name << " at " << time;
    EXPECT_EQ(changed.ground_acceleration(Vec3::UnitX(), time), anew.ground_acceleration(Vec3::UnitX(), time)) << time;
  }
}

TEST(ChangeMotion, GivesTheFunctionsOfARunThatIsBuiltAnewThereAndBack) {
  const Runs runs(std::string(ground) + push);
  BuiltCase built = build_run(runs.read, runs.own);
  const BuiltCase own = build_run(runs.read, runs.own), other = build_run(runs.read, runs.other);
  ASSERT_NE(own.model.ground_acceleration(Vec3::UnitX(), 0.8), other.model.ground_acceleration(Vec3::UnitX(), 0.8));
  ASSERT_TRUE(change_motion(runs.read.read, runs.other, built));
  expect_same(built.model, other.model);
  ASSERT_TRUE(change_motion(runs.read.read, runs.own, built));
  expect_same(built.model, own.model);
}

// What a prescribed motion does to the structure has three functions, and it moves openings.
TEST(ChangeMotion, LeavesARunWithPrescribedMotionsAlone) {
  const Runs runs("[[motion]]\nnode = \"n1\"\ndirection = \"ux\"\nfunction = \"shake\"\namplitude = 1e-3\n");
  BuiltCase built = build_run(runs.read, runs.own);
  const BuiltCase own = build_run(runs.read, runs.own);
  EXPECT_FALSE(change_motion(runs.read.read, runs.other, built));
  expect_same(built.model, own.model);
}

/// The case's own run with twice the step.
RunSpec with_twice_the_step(const RunSpec& own) {
  RunSpec coarse = own;
  coarse.name = "coarse", coarse.step_factor = 2, coarse.pictures = false;
  return coarse;
}

TEST(ChangeSteps, GivesTheRunThatIsBuiltAnewThereAndBack) {
  const Runs runs(std::string(ground) + push);
  const RunSpec coarse = with_twice_the_step(runs.own);
  BuiltCase built = build_run(runs.read, runs.own);
  const BuiltCase own = build_run(runs.read, runs.own), anew = build_run(runs.read, coarse);
  const auto expect_same_run = [](const BuiltCase& one, const BuiltCase& other) {
    EXPECT_EQ(one.plan.name, other.plan.name);
    EXPECT_EQ(one.plan.frames, other.plan.frames);
    expect_same(one.model, other.model);
    const RunResult first = run(one.model, one.plan, one.behaviours), second = run(other.model, other.plan, other.behaviours);
    ASSERT_EQ(first.status, RunStatus::completed) << first.reason;
    EXPECT_EQ(first.counts.steps, second.counts.steps);
    EXPECT_EQ(first.table, second.table);
  };
  ASSERT_TRUE(change_steps(runs.read.read, coarse, built));
  expect_same_run(built, anew);
  EXPECT_EQ(dynamic_stage(built.plan)->step, 2 * dynamic_stage(own.plan)->step);
  ASSERT_TRUE(change_steps(runs.read.read, runs.own, built));
  expect_same_run(built, own);
}

TEST(ChangeSteps, LeavesARunWithPrescribedMotionsAlone) {
  const Runs runs("[[motion]]\nnode = \"n1\"\ndirection = \"ux\"\nfunction = \"shake\"\namplitude = 1e-3\n");
  BuiltCase built = build_run(runs.read, runs.own);
  const double step = dynamic_stage(built.plan)->step;
  EXPECT_FALSE(change_steps(runs.read.read, with_twice_the_step(runs.own), built));
  EXPECT_EQ(dynamic_stage(built.plan)->step, step);
  EXPECT_EQ(built.plan.name, runs.own.name);
}

// Joints that stand for constraints of the bonded run are as stiff as the model is flexible in a step.
TEST(ChangeSteps, LeavesBondedConstraintsAlone) {
  std::string text = footing(push);
  const std::string law = "springs\", K_n = 1e8, K_t = 5e7, tangential = \"coulomb\", friction = 0.6";
  text.replace(text.find(law), law.size(), "coulomb\", friction = 0.6");
  const LoadedCase read = load_case_text(text, "case.toml", "test", MeshFiles::in_process);
  RunSpec own = runs_of_case(read.read).front();
  own.bonded = true;
  BuiltCase built = build_run(read, own);
  EXPECT_FALSE(change_steps(read.read, with_twice_the_step(own), built));
  own.bonded = false;
  built = build_run(read, own);
  EXPECT_TRUE(change_steps(read.read, with_twice_the_step(own), built));
}

}  // namespace
}  // namespace uplift::change_motion_test
