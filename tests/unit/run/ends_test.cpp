#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ran_support.h"
#include "uplift/io/text/toml.h"
#include "uplift/verdict/verdict.h"

// How runs end that do not simply march to their last step: a body that leaves the ground, static stages alone.
namespace uplift::ends_test {
namespace {

using support::Ran;
using support::run_text;

// a rigid body of 1 t on 2 m of springs without tension, thrown upwards with 1 m/s
constexpr const char* thrown = R"(
title = "thrown"
[nodes]
body = [0, 1]
[[rigid]]
name = "block"
node = "body"
mass = 1000
inertia = 1000
[[support]]
node = "body"
fixed = ["ux"]
[[interface]]
name = "soil"
[interface.footing]
body = "body"
width = 2
points = 5
[interface.law]
type = "springs"
K_n = 1e8
tangential = "none"
[[initial]]
node = "body"
velocity = [0, 1]
[[stage]]
type = "dynamic"
duration = 1
step = 1e-3
)";

// The energies of this run are finite; one of its columns is not.
TEST(RunEnds, AColumnThatIsNotFiniteIsAFailure) {
  const Case file = check_case(read_toml_text(thrown, "case.toml"), "case.toml");
  BuiltCase built = build(file, runs_of_case(file).front());
  const auto column = std::ranges::find(built.plan.requests, std::string("body.uy"), &Request::name);
  ASSERT_NE(column, built.plan.requests.end());
  EXPECT_NE(run(built.model, built.plan, built.behaviours).status, RunStatus::failed);
  column->factor = std::numeric_limits<double>::quiet_NaN();
  const RunResult result = run(built.model, built.plan, built.behaviours);
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_EQ(result.reason, "body.uy is not finite at t = 0 s");
}

TEST(RunEnds, ABodyThatLeavesTheGroundWithoutTurningIsSeparated) {
  const std::string text = thrown;
  // nothing pulls: the gap is v t. The limit is that of the toe of a base of 2 m that turns by 0.15 rad: 0.3 m
  const Ran free = run_text(text);
  EXPECT_EQ(free.result.status, RunStatus::separated);
  EXPECT_NEAR(free.result.end_time, 0.3, 1.5e-3);
  EXPECT_NE(free.result.reason.find("'soil' is open everywhere by more than 0.3 m"), std::string::npos) << free.result.reason;
  const Verdict verdict = judge(free.built, free.result, nullptr);
  EXPECT_EQ(verdict.level, Verdict::Level::separated);
  EXPECT_NE(verdict.headline.find("Full loss of contact: at 0.300 s the base is open everywhere by more than 0.300 m"), std::string::npos)
      << verdict.headline;

  EXPECT_NEAR(run_text(text + "[limits]\nrotation = 0.3\n").result.end_time, 0.6, 1.5e-3);
  EXPECT_NEAR(run_text(text + "[limits]\nseparation = \"10 cm\"\n").result.end_time, 0.1, 1.5e-3);
  // thrown 51 mm high it comes down again
  EXPECT_EQ(run_text(text + "[gravity]\nacceleration = [0, -9.81]\n").result.status, RunStatus::completed);
}

TEST(RunEnds, AnIsolatedPointIsHeldAgainstTheModel) {
  std::string text = thrown;
  text.replace(text.find("[interface.footing]"), text.find("[interface.law]") - text.find("[interface.footing]"),
               "[interface.pairs]\nupper = [\"body\"]\narea = 1\nnormal = [0, 1]\n");
  text.replace(text.find("fixed = [\"ux\"]"), 14, "fixed = [\"ux\", \"rz\"]");
  text.replace(text.find("body = [0, 1]"), 13, "body = [0, 1]\nmast = [0, 5]");
  text +=
      "[[beam]]\nname = \"mast\"\nnodes = [\"body\", \"mast\"]\nE = 1e9\nI = 1\ndensity = 1\nA = 1e-3\n[[support]]\nnode = \"mast\"\n"
      "fixed = [\"ux\", \"rz\"]\n";
  const Ran ran = run_text(text);  // nodes 4 m apart
  EXPECT_EQ(ran.result.status, RunStatus::separated) << ran.result.reason;
  EXPECT_NEAR(ran.built.plan.separation_limit, 0.15 * 4, 1e-12);
}

// a massless rigid strip, B = 4 m, 2 m out of the plane, on springs; W = 800 kN at e from the middle
std::string strip(double e, const std::string& rule, int points) {
  return R"(
title = "strip"
[nodes]
body = [0, 0]
[[rigid]]
name = "strip"
node = "body"
[[interface]]
name = "soil"
[interface.footing]
body = "body"
width = 4
thickness = 2
points = )" +
         std::to_string(points) + "\nrule = \"" + rule + R"("
[interface.law]
type = "springs"
K_n = 5e7
K_t = 1e7
tangential = "bonded"
[[load]]
name = "weight"
node = "body"
force = [0, -8e5]
moment = )" +
         std::to_string(-8e5 * e) + "\n[[stage]]\ntype = \"static\"\n";
}

TEST(RunEnds, StaticStagesAloneShowHowItStands) {
  const double width = 4, area = 8, stiffness = 5e7, weight = 8e5, e = 0.5;
  const Ran ran = run_text(strip(e, "gauss", 4));  // exact for squares of the place
  ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
  ASSERT_EQ(ran.result.table.front().size(), 11u);  // the unloaded structure and ten load steps
  const double settlement = weight / (stiffness * area), rotation = weight * e / (stiffness * area * width * width / 12);
  const auto column = [&](Request::Kind kind, int of) { return find_column(ran.result, kind, of)->back(); };
  EXPECT_NEAR(column(Request::Kind::displacement, ran.built.base_lift()), -settlement, 1e-9 * settlement);
  EXPECT_NEAR(column(Request::Kind::rotation, 0), -rotation, 1e-9 * rotation);
  EXPECT_NEAR(column(Request::Kind::axial, 0), -weight, 1e-9 * weight);
  EXPECT_NEAR(ran.result.final_energy.stored, 0.5 * weight * (settlement + e * rotation), 1e-9 * weight * settlement);

  const Verdict verdict = judge(ran.built, ran.result, nullptr);
  const auto number = [&](QuantityName name) { return find_number(verdict.numbers.interfaces.at(0).numbers, name)->value; };
  EXPECT_NEAR(number("max_eccentricity"), e / width, 1e-9);
  EXPECT_NEAR(number("residual_settlement"), settlement, 1e-9 * settlement);
  EXPECT_NEAR(number("residual_rotation"), -rotation, 1e-9 * rotation);  // clockwise, as its history
  EXPECT_NEAR(number("max_toe_pressure"), weight / area * (1 + 6 * e / width),
              1e-6 * weight / area);  // at the edge, beyond the Gauss points
  EXPECT_EQ(verdict.level, Verdict::Level::none);
  EXPECT_EQ(ran.result.frames.size(), 1u);
}

TEST(RunEnds, StaticUpliftAndItsBondedBase) {
  const double width = 4, area = 8, stiffness = 5e7, weight = 8e5, e = 1;
  const Ran ran = run_text(strip(e, "midpoint", 400));
  ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
  // outside the kern the pressure is a triangle over 3 (B/2 - e)
  const double pressed = 3 * (width / 2 - e);
  EXPECT_NEAR(ran.result.max_uplifted_ratio.value, 1 - pressed / width, 1.0 / 400);
  EXPECT_NEAR(ran.result.max_pressure.value, 2 * weight / (pressed * 2), 0.01 * weight / area);
  EXPECT_EQ(judge(ran.built, ran.result, nullptr).level, Verdict::Level::uplift);
  // the bonded base pulls: all springs bear
  const Ran bonded = run_text(strip(e, "gauss", 4), 1);
  const double rotation = weight * e / (stiffness * area * width * width / 12);
  EXPECT_NEAR(find_column(bonded.result, Request::Kind::rotation, 0)->back(), -rotation, 1e-9 * rotation);
}

}  // namespace
}  // namespace uplift::ends_test
