// [[foundation]]: the ground under a whole footing as one point with rotations, in whole runs.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "ran_support.h"
#include "text_support.h"
#include "uplift/case/case.h"
#include "uplift/io/text/toml.h"
#include "uplift/run/run_state.h"
#include "uplift/verdict/verdict.h"

namespace uplift::foundation_test {
namespace {

using support::Ran;
using support::refusal_of;
using support::replaced;

constexpr const char* plane_text = R"(
title = "foundation"
[nodes]
base = [0, 0]
top = [0, 10]
[[mass]]
node = "top"
mass = 100e3
[[beam]]
name = "column"
nodes = ["base", "top"]
E = 3e10
A = 1
I = 0.2
[[rigid]]
name = "footing"
node = "base"
mass = 30e3
inertia = 60e3
# ground
[gravity]
[damping]
rayleigh = [{ frequency = 1, ratio = 0.02 }, { frequency = 10, ratio = 0.02 }]
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
duration = 2
step = 2e-3
[output]
frames = 0
automatic = false
[[output.history]]
node = "top"
quantity = "ux"
[[output.history]]
node = "base"
quantity = "ux"
[[output.history]]
node = "base"
quantity = "uy"
[[output.history]]
node = "base"
quantity = "rz"
)";

constexpr const char* space_text = R"(
title = "foundation"
[nodes]
base = [0, 0, 0]
top = [0, 0, 10]
[[mass]]
node = "top"
mass = 100e3
inertia = 1e5
[[beam]]
name = "column"
nodes = ["base", "top"]
E = 3e10
A = 1
I_y = 0.2
I_z = 0.2
J = 0.3
[[rigid]]
name = "footing"
node = "base"
mass = 30e3
inertias = [60e3, 60e3, 100e3]
# ground
[gravity]
[damping]
rayleigh = [{ frequency = 1, ratio = 0.02 }, { frequency = 10, ratio = 0.02 }]
[[function]]
name = "pulse"
shape = { type = "half_sine", duration = 0.4 }
[[ground_acceleration]]
direction = [0.8, 0.6, 0]
function = "pulse"
amplitude = 4
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 1
step = 2e-3
[output]
frames = 0
automatic = false
[[output.history]]
node = "top"
quantity = "ux"
[[output.history]]
node = "top"
quantity = "uy"
[[output.history]]
node = "base"
quantity = "rx"
[[output.history]]
node = "base"
quantity = "ry"
[[output.history]]
node = "base"
quantity = "uz"
)";

std::string with_ground(const std::string& text, const std::string& ground) {
  return replaced(text, "# ground", ground);
}

Ran run_text(const std::string& text, std::size_t which = 0) {
  Ran made = support::run_text(text, which);
  EXPECT_NE(made.result.status, RunStatus::failed) << made.result.reason;
  return made;
}

std::size_t column(const RunResult& result, const std::string& name) {
  for (std::size_t k = 0; k < result.columns.size(); ++k)
    if (result.columns[k].name == name) return k;
  ADD_FAILURE() << "no column " << name;
  return 0;
}

void expect_same_motion(const RunResult& one, const RunResult& other, const std::string& name, double tolerance) {
  const std::size_t a = column(one, name), b = column(other, name);
  ASSERT_EQ(one.table[a + 1].size(), other.table[b + 1].size());
  EXPECT_GT(std::abs(other.peaks[b].value), 1e-5) << name;
  for (std::size_t i = 0; i < one.table[a + 1].size(); ++i)
    ASSERT_NEAR(one.table[a + 1][i], other.table[b + 1][i], tolerance * std::abs(other.peaks[b].value)) << name << " in row " << i;
}

/// Stiffness-proportional damping acts in springs, not in foundations.
std::string damped_by_mass(const std::string& text) {
  return replaced(text, "rayleigh = [{ frequency = 1, ratio = 0.02 }, { frequency = 10, ratio = 0.02 }]", "alpha = 0.3");
}

// Springs from the node to the ground are elements of the structure; the foundation is condensed like a joint.
TEST(Foundation, ElasticOneIsThreeSprings) {
  const std::string plane = damped_by_mass(plane_text);
  const Ran foundation = run_text(with_ground(plane, R"([[foundation]]
name = "soil"
body = "base"
width = 6
model = { type = "elastic", K_v = 4e8, K_h = 3e8, K_r = 2e9 })"));
  const Ran springs = run_text(with_ground(plane, R"([[spring]]
nodes = ["base"]
direction = [0, 1]
stiffness = 4e8
[[spring]]
nodes = ["base"]
direction = [1, 0]
stiffness = 3e8
[[spring]]
nodes = ["base"]
rotational_stiffness = 2e9)"));
  for (const char* name : {"top.ux", "base.ux", "base.uy", "base.rz"}) expect_same_motion(foundation.result, springs.result, name, 1e-8);
  EXPECT_NEAR(foundation.result.steps.rest.front().axial, -130e3 * 9.80665, 1e-3 * 130e3 * 9.81);
  // the moment that the ground bears is K theta, a mean over the window
  const double moment = 2e9 * std::abs(foundation.result.peaks[column(foundation.result, "base.rz")].value);
  EXPECT_NEAR(std::abs(foundation.result.max_base_moment.value), moment, 1e-2 * moment);
}

TEST(Foundation, ElasticOneInSpaceIsSixSprings) {
  const std::string space = damped_by_mass(space_text);
  std::string six;
  const auto spring = [&](const char* direction, const char* kind, const char* stiffness) {
    six += std::string("[[spring]]\nnodes = [\"base\"]\ndirection = ") + direction + "\n" + kind + " = " + stiffness + "\n";
  };
  spring("[1, 0, 0]", "stiffness", "3e8");
  spring("[0, 1, 0]", "stiffness", "2e8");
  spring("[0, 0, 1]", "stiffness", "4e8");
  spring("[1, 0, 0]", "rotational_stiffness", "1e9");
  spring("[0, 1, 0]", "rotational_stiffness", "2e9");
  spring("[0, 0, 1]", "rotational_stiffness", "3e9");
  const Ran springs = run_text(with_ground(space, six));
  const Ran foundation = run_text(with_ground(space, R"([[foundation]]
name = "soil"
body = "base"
width = 6
length = 5
model = { type = "elastic", K_v = 4e8, K_h = 3e8, K_h2 = 2e8, K_r = 2e9, K_r2 = 1e9, K_t = 3e9 })"));
  for (const char* name : {"top.ux", "top.uy", "base.uz", "base.rx", "base.ry"})
    expect_same_motion(foundation.result, springs.result, name, 1e-8);
}

const std::string macro = R"([[foundation]]
name = "soil"
body = "base"
width = 6
model = { type = "macro_element", shape_number = 6, K_v = 6e8, K_h = 3e8, K_r = 1.8e9 })";

// With shape number 6 and K_r = K_v D^2/12 the potential is the strip on tensionless springs (docs/theory/macro_element.md).
TEST(Foundation, MacroElementIsTheStripOnSpringsThatLiftsOff) {
  const Ran element = run_text(with_ground(plane_text, macro));
  const Ran joint = run_text(with_ground(plane_text, R"([[interface]]
name = "soil"
[interface.footing]
body = "base"
width = 6
points = 301
rule = "midpoint"
[interface.law]
type = "springs"
K_n = 1e8
K_t = 5e7
tangential = "bonded")"));
  EXPECT_GT(joint.result.max_uplifted_ratio.value, 0.2);
  for (const char* name : {"top.ux", "base.ux", "base.uy", "base.rz"}) expect_same_motion(element.result, joint.result, name, 2e-3);
  EXPECT_NEAR(element.result.max_uplifted_ratio.value, joint.result.max_uplifted_ratio.value, 5e-3);
  EXPECT_NEAR(element.result.max_base_moment.value, joint.result.max_base_moment.value,
              2e-3 * std::abs(joint.result.max_base_moment.value));
  EXPECT_NEAR(element.result.max_opening.value, joint.result.max_opening.value, 5e-3 * joint.result.max_opening.value);
  EXPECT_LT(std::abs(element.result.final_energy.residual), 1e-10 * element.result.energy_scale);
}

// Uplift, yielding and sliding: the ledger closes, the footing settles and stays settled, and the bonded run does none of it.
TEST(Foundation, YieldingMacroElementClosesTheLedger) {
  const std::string yielding =
      replaced(macro, "K_r = 1.8e9", "K_r = 1.8e9, V_s = 3e6, V_u = 5e6, w_ref = 0.02, friction_angle = \"30 deg\"");
  const std::string text = with_ground(plane_text, yielding);
  for (const char* step : {"2e-3", "10e-3"}) {
    const Ran ran = run_text(replaced(text, "step = 2e-3", std::string("step = ") + step));
    const RunResult& result = ran.result;
    EXPECT_LT(result.energy_created, 1e-10 * result.energy_scale) << step;
    EXPECT_LT(std::abs(result.final_energy.residual), 1e-10 * result.energy_scale) << step;
    EXPECT_GT(result.final_energy.interface_dissipated, 0.02 * result.energy_scale);
    EXPECT_LT(result.table[column(result, "base.uy") + 1].back(), 1.5 * result.table[column(result, "base.uy") + 1].front());  // settled
  }
  const RunResult bonded = run_text(text, 1).result;
  EXPECT_EQ(bonded.max_uplifted_ratio.value, 0);
  EXPECT_EQ(bonded.final_energy.interface_dissipated, 0);
}

TEST(Foundation, InSpaceMovesAsInThePlane) {
  const Ran flat = run_text(with_ground(plane_text, macro));
  std::string text = with_ground(replaced(space_text, "[0.8, 0.6, 0]", "[1, 0, 0]"), R"([[foundation]]
name = "soil"
body = "base"
width = 6
length = 5
model = { type = "macro_element", shape_number = 6, K_v = 6e8, K_h = 3e8, K_r = 1.8e9, K_t = 1e9 })");
  text = replaced(replaced(text, "inertia = 1e5\n", ""), "duration = 1\n", "duration = 2\n");
  const RunResult deep = run_text(text).result;
  const std::size_t a = column(deep, "base.ry"), b = column(flat.result, "base.rz");
  const double size = std::abs(flat.result.peaks[b].value);
  for (std::size_t i = 0; i < deep.table[a + 1].size(); ++i)
    ASSERT_NEAR(deep.table[a + 1][i], -flat.result.table[b + 1][i], 1e-6 * size) << i;
}

// A run that is kept in the middle goes on to the last bit, with what the ground remembers.
TEST(Foundation, ARunGoesOn) {
  const std::string text = with_ground(plane_text, replaced(macro, "K_r = 1.8e9", "K_r = 1.8e9, V_s = 3e6"));
  const Case read = check_case(read_toml_text(text, "case.toml"), "case.toml");
  const BuiltCase built = build(read, runs_of_case(read).front());
  std::vector<std::string> states;
  Keeping keeping;
  keeping.keep = [&](const RunState& state) { states.push_back(write_run_state(state)); };
  const RunResult straight = run(built.model, built.plan, built.behaviours, {}, {}, &keeping);
  std::string why;
  const std::optional<RunState> middle = read_run_state(states.at(1), why);
  ASSERT_TRUE(middle) << why;
  keeping.from = &*middle;
  const RunResult resumed = run(built.model, built.plan, built.behaviours, {}, {}, &keeping);
  EXPECT_EQ(resumed.table, straight.table);
}

TEST(Foundation, StandsBesideNoConstraint) {
  const auto refusal = [](const std::string& text) {
    return refusal_of([&] {
      const Case read = check_case(read_toml_text(text, "case.toml"), "case.toml");
      build(read, runs_of_case(read).front());
    });
  };
  for (const char* method : {"lagrange", "augmented_lagrangian", "penalty"}) {
    const std::string named = std::string("title = \"foundation\"\nmethod = \"") + method + "\"\n";
    const std::string found = refusal(with_ground(replaced(plane_text, "title = \"foundation\"\n", named), macro));
    EXPECT_NE(found.find("with a foundation"), std::string::npos) << found;
  }
  const std::string wall = macro + R"(
[[interface]]
name = "stop"
[interface.pairs]
upper = ["top"]
normal = [1, 0]
area = 1
[interface.law]
type = "unilateral")";
  EXPECT_NE(refusal(with_ground(plane_text, wall)).find("beside a foundation"), std::string::npos);
}

// A block that is dropped on its edge: N grows from nothing at a moment of N B/2 while the shear of the trial state exceeds N.
TEST(Foundation, ABlockLandsOnItsEdge) {
  constexpr const char* block = R"(
title = "drop"
[nodes]
base = [0, 0]
[[rigid]]
name = "block"
node = "base"
mass = 130e3
inertia = 1.5e6
centre = [0, 3]
[[foundation]]
name = "soil"
body = "base"
width = 6
length = 6
model = { type = "macro_element", K_v = 6e8, K_h = 3e8, K_r = 1.8e9, V_s = 8e6 }
[gravity]
[damping]
alpha = 0.2
[[initial]]
node = "base"
displacement = [0, 0.005]
rotation = 0.001
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 1
step = 1e-3
[output]
frames = 0
)";
  for (const char* step : {"1e-3", "2e-4"}) {
    const RunResult result = run_text(replaced(block, "step = 1e-3", std::string("step = ") + step)).result;
    EXPECT_EQ(result.status, RunStatus::completed) << result.reason;
    EXPECT_GT(result.full_loss, 0.1);
    EXPECT_LT(std::abs(result.final_energy.residual), 1e-10 * result.energy_scale);
  }
}

// Ground that has moved for good by more than it gives elastically: a further static stage moves nothing.
TEST(Foundation, AStaticStageAfterYieldingKeepsTheState) {
  const std::string text =
      replaced(with_ground(plane_text, replaced(macro, "K_r = 1.8e9", "K_r = 1.8e9, V_s = 1e6, V_u = 2e6, w_ref = 0.01")),
               "[[stage]]\ntype = \"dynamic\"\nduration = 2\nstep = 2e-3", "[[stage]]\ntype = \"static\"");
  const RunResult result = run_text(text).result;
  const std::vector<double>& settlement = result.table[column(result, "base.uy") + 1];
  // w = N/K_v + w_p, and N = V_s + (V_u - V_s) w_p/(w_p + w_ref): w_p = w_ref (N - V_s)/(V_u - N)
  const double weight = 130e3 * 9.81, plastic = 0.01 * (weight - 1e6) / (2e6 - weight);
  ASSERT_EQ(settlement.size(), 21u);
  EXPECT_GT(plastic, weight / 6e8);
  EXPECT_NEAR(settlement[10], -(weight / 6e8 + plastic), 2e-3 * plastic);
  for (std::size_t i = 11; i < settlement.size(); ++i) EXPECT_NEAR(settlement[i], settlement[10], 1e-9 * std::abs(settlement[10]));
}

// The dead load of 1.275 MN beside the vertical capacity: a warning within 5 % of it; beyond, a bearing failure and no overturning.
TEST(Foundation, DeadLoadAndCapacity) {
  const auto text = [](const char* capacity) {
    return with_ground(plane_text, replaced(macro, "K_r = 1.8e9", std::string("K_r = 1.8e9, V_s = ") + capacity));
  };
  const auto said = [&](const char* capacity) {
    const Case read = check_case(read_toml_text(text(capacity), "case.toml"), "case.toml");
    std::string all;
    for (const std::string& each : warnings(read, RunSpec{}, build(read, RunSpec{}))) all += each + "\n";
    return all;
  };
  EXPECT_EQ(said("1.35e6").find("dead load"), std::string::npos);
  EXPECT_NE(said("1.33e6").find("hardly any moment or horizontal force is left"), std::string::npos);
  EXPECT_NE(said("1.2e6").find("there is no equilibrium"), std::string::npos);
  const Case read = check_case(read_toml_text(text("1e6"), "case.toml"), "case.toml");
  BuiltCase built = build(read, RunSpec{});
  const RunResult failed = run(built.model, built.plan, built.behaviours);
  EXPECT_NE(failed.reason.find("the ground under 'soil' gives way: its bearing capacity is exhausted"), std::string::npos) << failed.reason;
}

// phi = 0 and cohesion alone under a moment: H = c A (1 - 2 M/(N B)) moves the footing, at a safety of 1.
TEST(Foundation, SafetyAgainstSlidingIsOneWhereItSlides) {
  std::string text = with_ground(plane_text, replaced(macro, "width = 6", "width = 6\nlength = 5"));
  text = replaced(text, "K_r = 1.8e9", "K_r = 1.8e9, friction_angle = 0.0, cohesion = 20e3");
  text = replaced(text, "rayleigh = [{ frequency = 1, ratio = 0.02 }, { frequency = 10, ratio = 0.02 }]", "alpha = 0.3");
  const Ran ran = run_text(text);
  const Verdict verdict = judge(ran.built, ran.result, nullptr);
  const VerdictNumber* safety = find_number(verdict.numbers.interfaces.front().numbers, "min_sliding_safety");
  ASSERT_NE(safety, nullptr);
  EXPECT_GT(ran.result.final_energy.interface_dissipated, 0.1 * ran.result.energy_scale);  // it slides
  EXPECT_NEAR(safety->value, 1, 0.1);  // means over the window, between the two instants of a step
}

TEST(Foundation, MistakesAreRefused) {
  const auto refusal = [](const std::string& ground) {
    return refusal_of([&] {
      const Case read = check_case(read_toml_text(with_ground(plane_text, ground), "case.toml"), "case.toml");
      build(read, runs_of_case(read).front());
    });
  };
  const std::string good =
      "[[foundation]]\nname = \"soil\"\nbody = \"base\"\nwidth = 6\nmodel = { type = \"elastic\", K_v = 4e8, K_h = 3e8, K_r = 2e9 }";
  EXPECT_EQ(refusal(good), "accepted");
  EXPECT_NE(refusal(replaced(good, "\"base\"", "\"bse\"")).find("did you mean \"base\""), std::string::npos);
  EXPECT_NE(refusal(replaced(good, "width = 6", "width = -6")).find("> 0"), std::string::npos);
  EXPECT_NE(refusal(replaced(good, "K_v = 4e8, ", "")).find("K_v"), std::string::npos);
  EXPECT_NE(refusal(replaced(good, "K_r = 2e9", "K_r = 2e9, K_t = 1e9")).find("in the plane"), std::string::npos);
  EXPECT_NE(refusal(replaced(macro, "K_r = 1.8e9", "K_r = 1.8e9, friction_angle = 0.2, dilatancy = 0.5")).find("up to friction_angle"),
            std::string::npos);
  EXPECT_NE(refusal(replaced(macro, "K_r = 1.8e9", "K_r = 1.8e9, dilatancy = 0.1")).find("up to friction_angle"), std::string::npos);
  EXPECT_NE(refusal(replaced(macro, "K_r = 1.8e9", "K_r = 1.8e9, V_s = 3e6, V_u = 2e6")).find("at least V_s"), std::string::npos);
  EXPECT_NE(refusal(replaced(macro, "width = 6", "width = \"5 um\"")).find("for a side of 5e-06 m"), std::string::npos);
  EXPECT_NE(refusal(replaced(macro, "K_r = 1.8e9", "K_r = 1.8e9, w_ref = 0.01")).find("V_s too"), std::string::npos);
  EXPECT_NE(refusal(replaced(macro, "K_r = 1.8e9", "K_r = 1.8e9, V_s = 2e7, w_ref = 0.01")).find("V_u too"), std::string::npos);
  EXPECT_NE(refusal(replaced(good, "\"elastic\"", "\"macro\"")).find("macro_element"), std::string::npos);

  const auto refused_with = [&](const std::string& keys) { return refusal(replaced(macro, "K_r = 1.8e9", "K_r = 1.8e9, " + keys)); };
  const auto says = [&](const std::string& keys, const std::string& words) {
    const std::string said = refused_with(keys);
    EXPECT_NE(said.find(words), std::string::npos) << keys << ": " << said;
  };
  const std::string power = "surface = \"power_law\", V_s = 3e6, a = 0.3, b = 0.4, c = 0.3, d = 0.5, e = 0.8";
  EXPECT_EQ(refused_with(power + ", f = 0.8"), "accepted");
  says(power, "f of the power law");
  says(power + ", f = 0", "0.1");
  says(replaced(power, "a = 0.3", "a = 0") + ", f = 0.8", "> 0");
  says(replaced(power, "V_s = 3e6, ", "") + ", f = 0.8", "V_s too");
  says(power + ", f = 0.8, flow = \"associated\"", "settling");
  says(power + ", f = 0.8, soil_inertia = 0.1", "surface = \"en_1998_5\"");
  says("V_s = 3e6, b = 0.4", "surface = \"power_law\"");
  says("V_s = 3e6, surface = \"en_1998_4\"", "en_1998_5");
  says("V_s = 3e6, surface = \"en_1998_5\"", "soil_type");
  const std::string standard = "V_s = 3e6, surface = \"en_1998_5\", soil_type = \"cohesionless\"";
  EXPECT_EQ(refused_with(standard + ", soil_inertia = 1, model_factor = 1.15"), "accepted");
  says(standard + ", soil_inertia = 1.05", "less than 1.042");  // 1/0.96
  says(standard + ", soil_inertia = -0.1", ">= 0");
  says(standard + ", model_factor = 0", "> 0");
}

}  // namespace
}  // namespace uplift::foundation_test
