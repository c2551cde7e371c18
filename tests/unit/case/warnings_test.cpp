#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "uplift/base/format.h"
#include "uplift/case/advice/content.h"
#include "uplift/case/advice/step_suggestion.h"
#include "uplift/io/text/toml.h"
#include "uplift/verdict/result_warnings.h"

namespace uplift::warnings_test {
namespace {

/// Sum of sines of 2 Hz and 8 Hz with these amplitudes, over whole periods.
class TwoSines final : public TimeFunction {
 public:
  TwoSines(double slow, double fast) : slow_(slow), fast_(fast) {}
  double value(double t) const override { return slow_ * std::sin(4 * std::numbers::pi * t) + fast_ * std::sin(16 * std::numbers::pi * t); }
  double rate(double) const override { return 0; }
  double acceleration(double) const override { return 0; }

 private:
  double slow_, fast_;
};

TEST(Content, EnergyOfASumOfSines) {
  EXPECT_NEAR(energy_above(TwoSines(1, 1), 0, 20, 4), 0.5, 0.01);
  EXPECT_NEAR(energy_above(TwoSines(3, 1), 0, 20, 4), 0.1, 0.01);
  EXPECT_NEAR(energy_above(TwoSines(1, 1), 0, 20, 1), 1, 0.01);
  EXPECT_NEAR(energy_above(TwoSines(1, 1), 0, 20, 12), 0, 0.01);
  EXPECT_EQ(energy_above(TwoSines(0, 0), 0, 20, 4), 0);
}

/// Straight lines differ from a sine by (w h)^2/8 of its value at most, and by w^2 h^2/12 on average: 0.01 at w h = 0.346.
// Square cells of 1 m with shear waves of 200 m/s carry 200 / (10 x 1 m) = 20 Hz.
TEST(Content, LoadsAndFloorSpectraAboveTheReachOfTheMesh) {
  const auto warned = [](const std::string& pulse, const std::string& frequencies) {
    const Case read = check_case(read_toml_text(R"(title = "soil"
[mesh.soil_box.soil]
width = 4
size = 1
[[mesh.soil_box.soil.layers]]
thickness = 2
size = 1
[[solid]]
group = "soil_1"
shear_wave_speed = 200
poisson = 0.3
density = 2000
[[support]]
group = "soil_bottom"
fixed = ["ux", "uy"]
[[function]]
name = "pulse"
shape = { type = "ricker", frequency = )" + pulse +
                                                    R"( }
[[ground_acceleration]]
name = "earthquake"
direction = [1, 0]
function = "pulse"
[[stage]]
type = "dynamic"
duration = 2
step = 1e-3
[[output.floor_spectrum]]
name = "surface"
at = [0, 0]
direction = [1, 0]
frequencies = )" + frequencies,
                                                "case.toml"),
                                 "case.toml");
    const RunSpec spec = runs_of_case(read).front();
    std::vector<std::string> said;
    warn_content(read, build(read, spec), said);
    return said;
  };
  EXPECT_TRUE(warned("3", "[5, 19]").empty());
  const std::vector<std::string> floors = warned("3", "[5, 25]");
  ASSERT_EQ(floors.size(), 1u);
  EXPECT_NE(floors.front().find("floor spectra go up to 25.0 Hz, but the cells of \"soil_1\" carry shear waves up to 20.0 Hz"),
            std::string::npos)
      << floors.front();
  const std::vector<std::string> load = warned("20", "[5, 19]");
  ASSERT_EQ(load.size(), 1u);
  EXPECT_NE(load.front().find("the cells of \"soil_1\" carry shear waves up to 20.0 Hz"), std::string::npos) << load.front();
}

TEST(StepSuggestion, LoadsAreResolvedToOneHundredth) {
  const double period = 0.125, exact = 0.3464 * period / (2 * std::numbers::pi);  // 6.9 ms
  EXPECT_GT(exact, 5e-3);
  EXPECT_LT(exact, 1e-2);
  EXPECT_DOUBLE_EQ(step_that_resolves(TwoSines(0, 1), 0, 10, 0.1), 5e-3);
  EXPECT_DOUBLE_EQ(step_that_resolves(TwoSines(0, 1), 0, 10, 2e-3), 2e-3);
  EXPECT_DOUBLE_EQ(step_that_resolves(TwoSines(1, 0), 0, 10, 0.1), 2e-2) << "four times as slow: 28 ms";
}

/// 1 between two instants, else 0.
class Pulse final : public TimeFunction {
 public:
  double value(double t) const override { return t > 0.041 && t < 0.059 ? 1 : 0; }
  double rate(double) const override { return 0; }
  double acceleration(double) const override { return 0; }
};

TEST(StepSuggestion, APulseBetweenTheStepsIsNotMissed) {
  EXPECT_NEAR(unresolved_share(Pulse(), 0, 10, 0.02), 1, 1e-12) << "zero at 40 and 60 ms";
  EXPECT_NEAR(unresolved_share(Pulse(), 0, 10, 0.1), 1, 1e-12);
  // a jump in the middle of a step: the line is off by a quarter of the step on average, for both jumps of 18 ms
  EXPECT_LT(unresolved_share(Pulse(), 0, 10, 1e-3), 2 * 0.5e-3 / 0.018 + 0.01);
  EXPECT_LT(step_that_resolves(Pulse(), 0, 10, 0.1), 1e-3);
}

/// A run of 10 s.
RunResult run_of_ten_seconds() {
  RunResult run;
  run.steps.time = {0, 5, 10};
  return run;
}

TEST(ResultWarnings, LatePeaks) {
  const RunResult run = run_of_ten_seconds();
  VerdictNumbers numbers;
  InterfaceVerdict& base = numbers.interfaces.emplace_back();
  base.name = "soil";
  base.numbers = {{QuantityName("max_moment"), 1e6, 8.9}, {QuantityName("max_opening"), 0.01, 8.0}};
  EXPECT_TRUE(result_warnings(run, numbers).empty());
  base.numbers.front().time = 9.5;
  ASSERT_EQ(result_warnings(run, numbers).size(), 1u);
  EXPECT_EQ(result_warnings(run, numbers).front(),
            "largest values are reached in the last tenth of the run (base moment of soil at 9.50 s): a longer run may exceed them");
  RunResult failed = run_of_ten_seconds();
  failed.status = RunStatus::failed;
  EXPECT_TRUE(result_warnings(failed, numbers).empty());
}

}  // namespace
}  // namespace uplift::warnings_test
