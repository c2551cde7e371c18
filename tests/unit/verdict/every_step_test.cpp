// The numbers of the verdict are those of every step, whatever rows the table keeps.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "ran_support.h"
#include "text_support.h"
#include "tower_case.h"
#include "uplift/run/run_state.h"
#include "uplift/verdict/motion.h"
#include "uplift/verdict/numbers.h"

namespace uplift::every_step_test {
namespace {

using support::Ran;
using support::replaced;
using support::run_text;

const std::string motion = R"([[interface]]
name = "soil"
[interface.footing]
body = "base"
width = 4
points = 5
[interface.law]
type = "springs"
K_n = 2e8
K_t = 1e8
tangential = "coulomb"
friction = 0.6
[[function]]
name = "pulse"
shape = { type = "ricker", frequency = 2, delay = 0.4 }
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 1
step = 1e-3
[output]
every = 50
)";

std::string in_the_plane() {
  const support::Tower tower{.nodes = "middle = [0, 2.5]",
                             .beam =
                                 "[[mass]]\nnode = \"middle\"\nmass = 1e4\n[[beam]]\nname = \"arm\"\nnodes = [\"base\", "
                                 "\"middle\"]\nE = 1e9\nI = 0.1",
                             .held = false};
  return "title = \"tower\"\nbonded = false\n" + tower.text() + support::weight + motion +
         "[[output.history]]\nlevel = 1\nquantity = \"storey_shear\"\n[[ground_acceleration]]\nfunction = \"pulse\"\namplitude = 6\n";
}

std::string in_space() {
  return R"(title = "tower"
bonded = false
[nodes]
base = [0, 0, 0]
top = [0.3, 0.2, 6]
[[beam]]
name = "column"
nodes = ["base", "top"]
E = 3e10
A = 0.5
I_y = 0.05
I_z = 0.03
J = 0.05
poisson = 0.2
[[mass]]
node = "top"
mass = 60e3
inertia = 1e5
[[rigid]]
name = "raft"
node = "base"
mass = 3e4
inertias = [4e4, 6e4, 1e5]
[gravity]
acceleration = [0, 0, -9.81]
[[ground_acceleration]]
name = "along"
direction = [1, 0, 0]
function = "pulse"
amplitude = 5
[[ground_acceleration]]
name = "across"
direction = [0, 1, 0]
function = "pulse"
amplitude = -4
)" + replaced(motion, "points = 5", "length = 3\npoints = 4\npoints_across = 3");
}

/// All numbers of the whole run and of its base, and their instants, bit for bit.
std::map<std::string, std::vector<std::uint64_t>> bits_of(const BuiltCase& built, const RunResult& run) {
  const VerdictNumbers numbers = numbers_of(built, run, nullptr);
  std::map<std::string, std::vector<std::uint64_t>> made;
  const auto note = [&](const std::vector<VerdictNumber>& list) {
    for (const VerdictNumber& number : list)
      made[std::string(number.quantity->name)] = {std::bit_cast<std::uint64_t>(number.value),
                                                  std::bit_cast<std::uint64_t>(number.time.value_or(-1)),
                                                  std::bit_cast<std::uint64_t>(number.least)};
  };
  note(numbers.whole);
  for (const InterfaceVerdict& said : numbers.interfaces) note(said.numbers);
  return made;
}

/// `drift` and `bending`: the largest ones, from the rows of the table, which has all steps when `every` is 1.
void expect_every_step(const std::string& text, double (*drift)(const Ran&, bool bending)) {
  const Ran all = run_text(replaced(text, "every = 50", "every = 1")), few = run_text(text);
  ASSERT_EQ(all.result.status, RunStatus::completed) << all.result.reason;
  ASSERT_EQ(few.rows(), 21u);
  ASSERT_EQ(all.rows(), 1001u);
  EXPECT_GT(all.result.max_uplifted_ratio.value, 0.05);
  for (const bool bending : {false, true}) {
    const double expected = drift(all, bending), rows = drift(few, bending);
    EXPECT_LT(rows, (1 - 1e-4) * expected);  // the rows miss it
    const std::optional<Peak> found = largest_drift(few.built, few.result, bending ? Drift::without_rotation : Drift::with_rotation);
    ASSERT_TRUE(found);
    EXPECT_NEAR(std::abs(found->value), expected, 1e-13);
  }
  const auto expected = bits_of(all.built, all.result);
  EXPECT_TRUE(expected.contains("max_drift_without_rotation") && expected.contains("max_top_motion"));
  EXPECT_EQ(expected.contains("max_storey_shear"), few.built.model.space.dimension == 2);
  EXPECT_TRUE(expected == bits_of(few.built, few.result));

  std::vector<RunState> states;
  Keeping keeping;  // a run that keeps states drops its first guesses there: all of them do it
  keeping.every = 111;
  keeping.keep = [&](const RunState& state) { states.push_back(state); };
  const RunResult kept = run(few.built.model, few.built.plan, few.built.behaviours, {}, {}, &keeping);
  ASSERT_EQ(states.size(), 9u);
  const auto straight = bits_of(few.built, kept);
  for (const RunState& state : states) {
    std::string why;
    const std::optional<RunState> read = read_run_state(write_run_state(state), why);
    ASSERT_TRUE(read) << why;
    Keeping from;
    from.every = 111;
    from.keep = [](const RunState&) {};
    from.from = &*read;
    EXPECT_TRUE(straight == bits_of(few.built, run(few.built.model, few.built.plan, few.built.behaviours, {}, {}, &from)));
  }
}

TEST(EveryStep, NumbersOfTheVerdictInThePlane) {
  expect_every_step(in_the_plane(), [](const Ran& ran, bool bending) {
    double most = 0;
    for (std::size_t i = 0; i < ran.rows(); ++i)
      most = std::max(most, std::abs(ran["top.ux"][i] - ran["base.ux"][i] + (bending ? 5 * ran["base.rz"][i] : 0)));
    return most;
  });
}

TEST(EveryStep, NumbersOfTheVerdictInSpace) {
  expect_every_step(in_space(), [](const Ran& ran, bool bending) {
    double most = 0;
    for (std::size_t i = 0; i < ran.rows(); ++i)
      most = std::max(most,
                      std::hypot(ran["top.ux"][i] - ran["base.ux"][i] - (bending ? 6 * ran["base.ry"][i] - 0.2 * ran["base.rz"][i] : 0),
                                 ran["top.uy"][i] - ran["base.uy"][i] + (bending ? 6 * ran["base.rx"][i] - 0.3 * ran["base.rz"][i] : 0)));
    return most;
  });
}

}  // namespace
}  // namespace uplift::every_step_test
