// Motion of the top and full loss of contact.
#include "uplift/verdict/motion.h"

#include <cmath>

#include "tower_case.h"
#include "unit/verdict/verdict_support.h"
#include "uplift/verdict/verdict.h"

namespace uplift::motion_test {
namespace {

using namespace support;

TEST(VerdictMotion, ResultantAndDriftOfARigidTower) {
  // a rigid tower on a rocking footing, pushed at 45 degrees between x and y: the top moves by theta h, and without the rotation by nothing
  BuiltCase built = built_of(R"(title = "rigid tower"
bonded = false
[nodes]
base = [0, 0, 0]
top = [0, 0, 10]
[[rigid]]
name = "tower"
node = "base"
slaves = ["top"]
mass = 1e4
inertia = 1e4
[[mass]]
node = "top"
mass = 1
[[interface]]
name = "underside"
footing = { body = "base", width = 4, length = 4, points = 3, points_across = 3 }
law = { type = "elastic", K_n = 2e8, K_t = 1e8 }
[[load]]
node = "top"
force = [3e4, 4e4, 0]
[[stage]]
type = "static"
)");
  const RunResult run = run_of(built);
  ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
  const double theta = 5e4 * 10 / (2e8 * 4 * 8), sway = 5e4 / (1e8 * 16);
  ASSERT_TRUE(top_motion(built, run));
  EXPECT_NEAR(top_motion(built, run)->value, sway + 10 * theta, 1e-12);
  EXPECT_NEAR(largest_drift(built, run, Drift::with_rotation)->value, 10 * theta, 1e-12);
  EXPECT_NEAR(largest_drift(built, run, Drift::without_rotation)->value, 0, 1e-12);
  // of columns that are not recorded nothing is made
  std::erase_if(built.plan.requests,
                [&](const Request& each) { return each.kind == Request::Kind::displacement && each.unknown == built.top_sway(); });
  const RunResult less = run_of(built);
  EXPECT_FALSE(top_motion(built, less));
  EXPECT_FALSE(largest_drift(built, less, Drift::with_rotation));
}

TEST(VerdictMotion, DeformationOfAColumnOnARockingFooting) {
  // in the plane: P h3/(3 E I) is left without the rotation of the base, P h2/k_rock with it
  const support::Tower column{.height = "6",
                              .young = "\"30 GPa\"",
                              .inertia = "0.1",
                              .mass = "mass = 1000",
                              .footing = "mass = 1e4\ninertia = 1e4",
                              .beam = "A = 1",
                              .held = false};
  const BuiltCase built = built_of("title = \"column\"\nbonded = false" + column.text() + R"([[interface]]
name = "soil"
footing = { body = "base", width = 4, points = 3 }
law = { type = "elastic", K_n = 2e8, K_t = 1e8 }
[[load]]
node = "top"
force = [-3e4, 0]
[[stage]]
type = "static"
)");
  const RunResult run = run_of(built);
  ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
  const double bends = 3e4 * 216 / (3 * 30e9 * 0.1), turns = 3e4 * 36 / (2e8 * 8);
  EXPECT_NEAR(largest_drift(built, run, Drift::without_rotation)->value, -bends, 1e-12);
  EXPECT_NEAR(largest_drift(built, run, Drift::with_rotation)->value, -bends - turns, 1e-12);
  EXPECT_TRUE(built.is_strip());
}

TEST(VerdictFullLoss, OfTwoBasesIsWhatTheyLoseTogether) {
  StepRecord record;
  record.extremes.resize(3);
  record.extremes[0].full_loss = {{1, 2}, {3, 5}};
  record.extremes[1].full_loss = {{1.5, 3.5}, {4, 6}};
  const std::vector<Interval> all = record.full_loss({0, 0, 1});  // the third is a wall
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].from, 1.5);
  EXPECT_EQ(all[0].to, 2);
  EXPECT_EQ(all[1].to, 3.5);
  EXPECT_EQ(all[2].from, 4);
  EXPECT_TRUE(record.full_loss({0, 0, 0}).empty());
}

}  // namespace
}  // namespace uplift::motion_test
