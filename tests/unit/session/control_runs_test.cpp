// The errors that control runs state: those of runs made one by one, also where whole models march side by side; of any basis, good or bad.
#include "uplift/session/control_runs.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "unit/session/reduced_support.h"
#include "uplift/reduction/projection.h"
#include "uplift/run/lockstep.h"
#include "uplift/session/steps.h"

namespace uplift::control_runs_test {
namespace {

/// A block that rocks on soil under one sine wave of ground motion, with its mirror image: motions of both signs differ in signs alone.
LoadedCase block_on_soil(double size, double amplitude = 8) {
  return load_case_text(
      fmt::format("title = \"block\"\nbonded = false\n[mesh.soil_box.soil]\nwidth = 24\nsize = {0}\n"
                  "[[mesh.soil_box.soil.layers]]\nthickness = 6\nsize = {0}\n[mesh.soil_box.block]\nwidth = 4\nheight = 8\nsize = {0}\n"
                  "[[solid]]\ngroup = \"soil_1\"\nshear_wave_speed = 200\npoisson = 0.3\ndensity = 2000\n"
                  "[[solid]]\ngroup = \"block\"\nE = 2e9\npoisson = 0.2\ndensity = 400\n"
                  "[[support]]\ngroup = \"soil_bottom\"\nfixed = [\"ux\", \"uy\"]\n"
                  "[[interface]]\nname = \"base\"\nsurface = {{ group = \"interface\", lower = [\"soil_1\"] }}\n"
                  "law = {{ type = \"springs\", K_n = 2e8, tangential = \"bonded\" }}\n"
                  "[gravity]\nacceleration = [0, -9.81]\n[[function]]\nname = \"shake\"\nshape = {{ type = \"ricker\", frequency = 2 }}\n"
                  "[[ground_acceleration]]\ndirection = [1, 0]\nfunction = \"shake\"\namplitude = {1}\n"
                  "[damping]\nrayleigh = [{{ frequency = 1, ratio = 0.03 }}, {{ frequency = 8, ratio = 0.03 }}]\n"
                  "[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\nduration = 0.6\nstep = 5e-3\n",
                  size, amplitude),
      "case.toml", "test", MeshFiles::in_process);
}

BuiltCase built_of(const LoadedCase& read) {
  RunSpec spec = runs_of_case(read.read).front();
  spec.pictures = false;
  return build_run(read, spec);
}

constexpr double w = 60;  // rad/s

/// Displacements of runs under five multiples of the motion: other multiples move the reduced model as they do the whole one.
ReducedModel basis_of_runs(double size) {
  std::optional<ReducedModel> reduced;
  for (const double amplitude : {4, 6, 8, 10, 12}) {
    const LoadedCase loaded = block_on_soil(size, amplitude);
    const BuiltCase built = built_of(loaded);
    if (!reduced) reduced = support::without_basis(built.model, w);
    const EnergyProduct product(built.model.stiffness, built.model.mass, reduced->energy_frequency);
    run(built.model, built.plan, built.behaviours, {}, [&](const Snapshot& at) {
      if (at.step % 3 == 0) append(product, at.state.displacement, 1e-8, reduced->vectors);
    });
  }
  return *reduced;
}

struct Peaks {
  double opening, moment;
};

Peaks peaks(const RunResult& result) {
  EXPECT_EQ(result.status, RunStatus::completed) << result.reason;
  return {result.max_opening.value, std::abs(result.max_base_moment.value)};
}

Peaks whole_peaks(const LoadedCase& loaded) {
  const BuiltCase built = built_of(loaded);
  return peaks(run(built.model, built.plan, built.behaviours));
}

void expect_errors_of_single_runs(const LoadedCase& loaded, int controls) {
  const ReducedModel basis = support::random_basis(built_of(loaded).model, w, 20, 1);
  const Peaks whole = whole_peaks(loaded), reduced = peaks(support::run_reduced(built_of(loaded), basis));
  const double opening = std::abs(reduced.opening / whole.opening - 1), moment = std::abs(reduced.moment / whole.moment - 1);
  EXPECT_GT(opening, 0.01);
  const ControlErrors errors = control_errors(loaded, basis, {.controls = controls, .least_scale = 1, .most_scale = 1}, {});
  EXPECT_EQ(errors.runs, controls);
  EXPECT_EQ(errors.different, 0);
  EXPECT_NEAR(errors.opening, opening, 1e-6);
  EXPECT_NEAR(errors.moment, moment, 1e-6);
}

TEST(ControlRuns, StateTheErrorsOfSingleRuns) {
  const LoadedCase loaded = block_on_soil(1);
  ASSERT_LT(built_of(loaded).model.free(), large_model);
  expect_errors_of_single_runs(loaded, 3);
}

TEST(ControlRuns, StateTheErrorsOfSingleRunsWhereWholeModelsMarchSideBySide) {
  const LoadedCase loaded = block_on_soil(0.25);
  ASSERT_GE(built_of(loaded).model.free(), large_model);
  expect_errors_of_single_runs(loaded, 3);
}

// Runs of different motions would be apart by as much as the motions, which differ in sign and by a factor of up to three.
TEST(ControlRuns, SideBySideAreComparedWithTheirOwnReducedRuns) {
  const LoadedCase loaded = block_on_soil(0.25);
  const ControlErrors errors = control_errors(
      loaded, basis_of_runs(0.25), {.controls = static_cast<int>(most_in_lockstep) + 1, .least_scale = 0.5, .most_scale = 1.5}, {});
  EXPECT_EQ(errors.runs, 17);
  EXPECT_EQ(errors.different, 0);
  EXPECT_LT(errors.opening, 0.4);
  EXPECT_LT(errors.moment, 0.4);
  EXPECT_LT(errors.history, 0.4);
}

TEST(ControlRuns, ThatAreInterruptedSideBySideLeaveTheModel) {
  const LoadedCase loaded = block_on_soil(0.25);
  bool stopped = false;
  Control control;
  control.stopped = [&] { return stopped; };
  control.watch = [&](const std::string& label) -> Watch {
    if (label.starts_with("control runs 1 to 2 of 2")) stopped = true;
    return [&](const Progress&) { return !stopped; };
  };
  ReduceOptions options{.controls = 2};
  options.model = std::make_shared<const ReducedModel>(support::random_basis(built_of(loaded).model, w, 20, 1));
  const std::optional<ReducedModel> made = reduce_case(loaded, options, control);
  EXPECT_TRUE(stopped);
  ASSERT_TRUE(made);
  EXPECT_FALSE(made->controls);
}

TEST(ControlRuns, OfAGivenModelAreThoseMadeWithIt) {
  const LoadedCase loaded = block_on_soil(2);
  const ReduceOptions options{.size = 30, .controls = 2};
  const std::optional<ReducedModel> at_once = reduce_case(loaded, options, {});
  ReduceOptions later = options;
  later.controls = 0;
  later.model = std::make_shared<const ReducedModel>(*reduce_case(loaded, later, {}));
  EXPECT_FALSE(later.model->controls);
  later.controls = 2;
  const std::optional<ReducedModel> after = reduce_case(loaded, later, {});
  ASSERT_TRUE(at_once && at_once->controls && after && after->controls);
  EXPECT_EQ(write_reduced_model(*after), write_reduced_model(*at_once));
  EXPECT_THROW(reduce_case(block_on_soil(1), later, {}), InputError);  // of another structure
}

TEST(ControlRuns, ThatAreInterruptedLeaveTheModelAndTheErrorsOfTheRunsThatWereMade) {
  const LoadedCase loaded = block_on_soil(2);
  for (const int stop_in : {1, 3}) {
    bool stopped = false;
    Control control;
    control.stopped = [&] { return stopped; };
    control.watch = [&](const std::string& label) -> Watch {
      if (label.starts_with(fmt::format("control run {} of", stop_in))) stopped = true;
      return [&](const Progress&) { return !stopped; };
    };
    const std::optional<ReducedModel> made = reduce_case(loaded, {.size = 30, .controls = 5}, control);
    ASSERT_TRUE(made);
    EXPECT_EQ(made->vectors.cols(), 30);
    ASSERT_EQ(made->controls.has_value(), stop_in > 1);
    if (stop_in > 1) EXPECT_EQ(made->controls->runs, stop_in - 1);
    // what was stated before by more runs stays
    if (stop_in > 1) {
      stopped = false;
      ReduceOptions more{.controls = 59};
      more.model = std::make_shared<const ReducedModel>(*made);
      control.watch = [&](const std::string& label) -> Watch {
        if (label.starts_with("control run 2 of")) stopped = true;
        return [&](const Progress&) { return !stopped; };
      };
      EXPECT_EQ(reduce_case(loaded, more, control)->controls->runs, stop_in - 1);
    }
  }
}

}  // namespace
}  // namespace uplift::control_runs_test
