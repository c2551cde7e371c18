// A run that begins where another one has been takes the same steps to the last bit.
#include "uplift/run/run_state.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "text_support.h"
#include "uplift/case/case.h"
#include "uplift/io/text/toml.h"

namespace uplift::run_state_test {
namespace {

using support::replaced;

constexpr long every = 37;

// A stick of two masses on a footing of 9 points that lifts off, with section forces, floors, pictures and a static stage before it.
constexpr const char* tower = R"(
title = "tower"
[nodes]
base = [0, 0]
middle = [0, 6]
top = [0, 12]
[[mass]]
node = "middle"
mass = 40e3
[[mass]]
node = "top"
mass = 60e3
[[beam]]
name = "lower"
nodes = ["base", "middle"]
E = 3e10
A = 1
I = 0.05
[[beam]]
name = "upper"
nodes = ["middle", "top"]
E = 3e10
A = 1
I = 0.05
[[rigid]]
name = "footing"
node = "base"
mass = 30e3
inertia = 60e3
[[interface]]
name = "soil"
[interface.footing]
body = "base"
width = 4
points = 9
[interface.law]
type = "springs"
K_n = 2e8
K_t = 2e8
[gravity]
[damping]
rayleigh = [{ frequency = 1, ratio = 0.02 }, { frequency = 10, ratio = 0.02 }]
[[function]]
name = "pulse"
shape = { type = "half_sine", duration = 0.4 }
[[ground_acceleration]]
function = "pulse"
amplitude = 6
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 1
step = 4e-3
[output]
every = 3
frames = 30
[[output.history]]
node = "top"
quantity = "ax"
[[output.history]]
beam = "lower"
position = 1
quantity = "moment"
[[output.beam_envelope]]
beam = "lower"
[[output.floor_spectrum]]
name = "roof"
node = "top"
direction = [1, 0]
)";

struct Kept {
  RunResult result;
  std::vector<std::string> states;
};

Kept run_kept(const BuiltCase& built, const RunState* from = nullptr) {
  Kept kept;
  Keeping keeping;
  keeping.every = every;
  keeping.from = from;
  keeping.keep = [&](const RunState& state) { kept.states.push_back(write_run_state(state)); };
  kept.result = run(built.model, built.plan, built.behaviours, {}, {}, &keeping);
  return kept;
}

/// All that a run has computed, without the time that it took.
std::string bytes_of(RunResult result) {
  RunState state;
  result.wall = result.step_seconds = 0;
  state.result = std::move(result);
  return write_run_state(state);
}

void expect_same_from_everywhere(const std::string& text) {
  const Case read = check_case(read_toml_text(text, "case.toml"), "case.toml");
  const BuiltCase built = build(read, runs_of_case(read).front());
  const Kept straight = run_kept(built);
  ASSERT_NE(straight.result.status, RunStatus::failed) << straight.result.reason;
  ASSERT_GE(straight.states.size(), 3u);
  EXPECT_GT(straight.result.max_uplifted_ratio.value, 0.05);
  const std::string expected = bytes_of(straight.result);
  for (std::size_t k = 0; k < straight.states.size(); ++k) {
    std::string why;
    const std::optional<RunState> state = read_run_state(straight.states[k], why);
    ASSERT_TRUE(state) << why;
    EXPECT_TRUE(write_run_state(*state) == straight.states[k]);
    const Kept resumed = run_kept(built, &*state);
    EXPECT_EQ(resumed.states.size(), straight.states.size() - k - 1);
    ASSERT_TRUE(bytes_of(resumed.result) == expected) << "from state " << k;
  }
}

TEST(RunState, TheRunGoesOnToTheLastBit) {
  expect_same_from_everywhere(tower);
}

const std::string springs = "type = \"springs\"\nK_n = 2e8\nK_t = 2e8";

TEST(RunState, WithEveryScheme) {
  for (const char* scheme :
       {"{ type = \"energy_decay\" }", "{ type = \"hht\", alpha = -0.1 }", "{ type = \"generalised_alpha\", rho = 0.8 }"}) {
    SCOPED_TRACE(scheme);
    expect_same_from_everywhere(replaced(tower, "step = 4e-3", std::string("step = 4e-3\nscheme = ") + scheme));
  }
}

TEST(RunState, WithEveryLaw) {
  for (const char* law : {"type = \"sdm\"\nF_u = 1e3\nG_f = 1\nF_c = -1e3\nK_n = 2e8", "type = \"bilinear\"\nF_u = 1e3\nG_f = 1\nK_n = 2e8",
                          "type = \"springs\"\nK_n = 2e8\nfriction = 0.4", "type = \"springs\"\nK_n = 2e8\nK_t = 2e8\nc = 1e5"}) {
    SCOPED_TRACE(law);
    expect_same_from_everywhere(replaced(tower, springs, law));
  }
}

TEST(RunState, WithEveryMethodAndImpact) {
  for (const char* method : {"lagrange", "augmented_lagrangian"})
    for (const char* law : {"type = \"unilateral\"", "type = \"coulomb\"\nfriction = 0.7"})
      for (const char* impact : {"project_hold", "none", "propagate"}) {
        SCOPED_TRACE(std::string(method) + ", " + law + ", " + impact);
        std::string text = replaced(tower, springs, law);
        if (std::string(law).find("unilateral") != text.npos)
          text = replaced(text, "[gravity]", "[[support]]\nnode = \"base\"\nfixed = [\"ux\"]\n[gravity]");
        text = replaced(text, "[nodes]",
                        std::string("method = \"") + method + "\"\nimpact = \"" + impact + "\"\nenergy = { created_limit = 10 }\n[nodes]");
        expect_same_from_everywhere(text);
      }
  std::string text = replaced(tower, springs, "type = \"coulomb\"\nfriction = 0.7");
  expect_same_from_everywhere(replaced(text, "[nodes]", "method = \"penalty\"\n[nodes]"));
}

TEST(RunState, WithSecondOrderStagesAndReleasedSupports) {
  expect_same_from_everywhere(replaced(tower, "step = 4e-3", "step = 4e-3\np_delta = true"));
  expect_same_from_everywhere(replaced(tower, "[output]", "[[stage]]\ntype = \"dynamic\"\nduration = 0.6\nstep = 4e-3\n[output]"));
  expect_same_from_everywhere(replaced(tower, "[output]", "[[stage]]\ntype = \"static\"\n[output]"));
  expect_same_from_everywhere(
      replaced(tower, "[gravity]", "[[support]]\nnode = \"top\"\nfixed = [\"ux\"]\nstages = \"static\"\n[gravity]"));
}

// A sparse factor, yielding soil under an SDM joint with friction.
constexpr const char* block = R"(
title = "block"
[mesh.soil_box.soil]
width = 16
size = 2
layers = [{ thickness = 6 }]
[mesh.soil_box.block]
width = 4
height = 8
size = 2
[[solid]]
group = "soil_1"
E = 5e7
poisson = 0.3
density = 1900
plasticity = { cohesion = 2e4, friction_angle = "25 deg" }
[[solid]]
group = "block"
E = 2e9
poisson = 0.2
density = 600
[[support]]
group = "soil_bottom"
fixed = ["ux", "uy"]
[[support]]
group = "soil_left"
fixed = ["ux"]
[[support]]
group = "soil_right"
fixed = ["ux"]
[[interface]]
name = "underside"
[interface.surface]
group = "interface"
lower = ["soil_1"]
[interface.law]
type = "springs"
K_n = 1e9
friction = 0.7
[gravity]
[damping]
rayleigh = [{ frequency = 3, ratio = 0.02 }]
[[function]]
name = "pulse"
shape = { type = "half_sine", duration = 0.4 }
[[ground_acceleration]]
function = "pulse"
amplitude = 4
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 1
step = 5e-3
[output]
frames = 10
)";

TEST(RunState, WithYieldingSoil) {
  const Case read = check_case(read_toml_text(block, "case.toml"), "case.toml");
  const BuiltCase built = build(read, runs_of_case(read).front());
  EXPECT_GT(run(built.model, built.plan, built.behaviours).final_energy.plastic, 0);
  expect_same_from_everywhere(block);
  expect_same_from_everywhere(replaced(block, R"(plasticity = { cohesion = 2e4, friction_angle = "25 deg" })", ""));
}

// A run that is kept differs from one that is not by its first guesses alone.
TEST(RunState, KeepingChangesNoResult) {
  const Case read = check_case(read_toml_text(tower, "case.toml"), "case.toml");
  const BuiltCase built = build(read, runs_of_case(read).front());
  const RunResult plain = run(built.model, built.plan, built.behaviours);
  const RunResult kept = run_kept(built).result;
  ASSERT_EQ(plain.table.size(), kept.table.size());
  for (std::size_t k = 1; k < plain.table.size(); ++k) {
    const Request& column = plain.columns[k - 1];
    const double size = column.unit == "J" ? plain.energy_scale : std::abs(plain.peaks[k - 1].value);
    ASSERT_EQ(plain.table[k].size(), kept.table[k].size());
    for (std::size_t i = 0; i < plain.table[k].size(); ++i) EXPECT_NEAR(plain.table[k][i], kept.table[k][i], 1e-9 * size) << column.name;
  }
}

TEST(RunState, DamagedBytesAreRefused) {
  const Case read = check_case(read_toml_text(tower, "case.toml"), "case.toml");
  const BuiltCase built = build(read, runs_of_case(read).front());
  const std::string good = run_kept(built).states.front();
  std::string why;
  ASSERT_TRUE(read_run_state(good, why)) << why;
  std::mt19937_64 random(20261123);
  for (int k = 0; k < 500; ++k) {
    std::string bad = good;
    bad[random() % bad.size()] ^= static_cast<char>(1 << random() % 8);
    EXPECT_FALSE(read_run_state(bad, why));
    EXPECT_FALSE(why.empty());
  }
  for (int k = 0; k < 100; ++k) EXPECT_FALSE(read_run_state(good.substr(0, random() % good.size()), why));
  EXPECT_FALSE(read_run_state(good + "x", why));
  EXPECT_FALSE(read_run_state("", why));
}

TEST(RunState, OfAnotherModelIsRefused) {
  const Case read = check_case(read_toml_text(tower, "case.toml"), "case.toml");
  const BuiltCase built = build(read, runs_of_case(read).front());
  std::string why;
  const std::optional<RunState> state = read_run_state(run_kept(built).states.front(), why);
  const Case other = check_case(read_toml_text(replaced(tower, "points = 9", "points = 11"), "case.toml"), "case.toml");
  const BuiltCase other_built = build(other, runs_of_case(other).front());
  const Kept refused = run_kept(other_built, &*state);
  EXPECT_EQ(refused.result.status, RunStatus::failed);
  EXPECT_NE(refused.result.reason.find("another model"), std::string::npos);
}

}  // namespace
}  // namespace uplift::run_state_test
