// Motion of the top and full loss of contact.
#include "uplift/verdict/motion.h"

#include <fmt/format.h>

#include <cmath>

#include "text_support.h"
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

/// A column of 6 m with its mass along it, on a rocking footing that has mass, pushed at its tip in the plane.
std::string chimney(const std::string& more = "", const std::string& verdict = "") {
  return R"(title = "chimney"
bonded = false
[nodes]
base = [0, 0]
tip = [0, 6]
beside = [1, 6.5]
[[beam]]
name = "shaft"
nodes = ["base", "tip"]
E = "30 GPa"
A = 1
I = 0.1
mass = "consistent"
density = 2500
elements = 6
[[rigid]]
node = "base"
mass = 1e4
inertia = 1e4
[[interface]]
name = "soil"
footing = { body = "base", width = 4, points = 3 }
law = { type = "elastic", K_n = 2e8, K_t = 1e8 }
[[load]]
node = "tip"
force = [-3e4, 0]
[[stage]]
type = "static"
)" + more +
         verdict;
}
constexpr double chimney_bends = 3e4 * 216 / (3 * 30e9 * 0.1), chimney_turns = 3e4 * 36 / (2e8 * 8), chimney_slides = 3e4 / (1e8 * 4);

const char* const unused = "[[support]]\nnode = \"beside\"\nfixed = [\"ux\", \"uy\", \"rz\"]\n";

void expect_motion_of_tip(const std::string& text) {
  const BuiltCase built = built_of(text);
  EXPECT_EQ(built.name_of_top(), "node tip");
  const RunResult run = run_of(built);
  ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
  EXPECT_NEAR(top_motion(built, run)->value, -(chimney_slides + chimney_turns + chimney_bends), 1e-12);
  EXPECT_NEAR(largest_drift(built, run, Drift::with_rotation)->value, -(chimney_turns + chimney_bends), 1e-12);
  EXPECT_NEAR(largest_drift(built, run, Drift::without_rotation)->value, -chimney_bends, 1e-12);
}

TEST(VerdictTop, IsTheHighestNodeWhereverTheMassesAre) {
  expect_motion_of_tip(chimney(unused));  // of distributed mass; a node that is held is none of the structure
  expect_motion_of_tip(chimney(std::string(unused) + "[[mass]]\nnode = \"shaft.2\"\nmass = 1000\n"));
}

/// Equipment of 100 kg beside 25 t; a heavy part on the same spring is one of the structure.
TEST(VerdictTop, IsNoEquipmentOnASpring) {
  const auto hung = [](const char* mass) {
    return "[[mass]]\nnode = \"beside\"\nmass = " + std::string(mass) +
           "\n[[spring]]\nnodes = [\"tip\", \"beside\"]\ndirection = [1, 0]\nstiffness = 1e6\n"
           "[[spring]]\nnodes = [\"tip\", \"beside\"]\ndirection = [0, 1]\nstiffness = 1e6\n"
           "[[support]]\nnode = \"beside\"\nfixed = [\"rz\"]\n";
  };
  expect_motion_of_tip(chimney(hung("100")));
  EXPECT_EQ(built_of(chimney(hung("1e4"))).name_of_top(), "node beside");
}

/// A light top storey: of a frame whose storeys are springs it is the only thing there.
TEST(VerdictTop, OfStoreysOnSpringsIsTheLastOne) {
  std::string text = "title = \"shear building\"\nbonded = false\n[nodes]\nn0 = [0, 0]\n", parts;
  for (int i = 1; i <= 12; ++i) {
    text += fmt::format("n{} = [0, {}]\n", i, 3 * i);
    parts += fmt::format(
        "[[mass]]\nnode = \"n{0}\"\nmass = {2}\n[[spring]]\nnodes = [\"n{1}\", \"n{0}\"]\ndirection = [1, 0]\nstiffness = 1e8\n"
        "[[spring]]\nnodes = [\"n{1}\", \"n{0}\"]\ndirection = [0, 1]\nstiffness = 1e9\n[[support]]\nnode = \"n{0}\"\nfixed = [\"rz\"]\n",
        i, i - 1, i < 12 ? 10000 : 500);
  }
  text += parts + R"([[rigid]]
node = "n0"
mass = 1e4
inertia = 1e4
[[interface]]
name = "soil"
footing = { body = "n0", width = 4, points = 3 }
law = { type = "elastic", K_n = 2e8, K_t = 1e8 }
[[stage]]
type = "static"
)";
  EXPECT_EQ(built_of(text).name_of_top(), "node n12");
}

TEST(VerdictTop, IsTheNodeThatTheCaseNames) {
  const BuiltCase built = built_of(chimney(unused, "[verdict]\ntop = \"shaft.3\"\n"));
  EXPECT_EQ(built.name_of_top(), "node shaft.3");
  const RunResult run = run_of(built);
  const double x = 3, bends = 3e4 * x * x * (3 * 6 - x) / (6 * 30e9 * 0.1), turns = 3e4 * 6 * x / (2e8 * 8);
  EXPECT_NEAR(largest_drift(built, run, Drift::with_rotation)->value, -(turns + bends), 1e-12);
  EXPECT_NEAR(largest_drift(built, run, Drift::without_rotation)->value, -bends, 1e-12);
  EXPECT_NE(support::refusal_of([] { built_of(chimney(unused, "[verdict]\ntop = \"tipp\"\n")); }).find("did you mean \"tip\"?"),
            std::string::npos);
}

/// A rigid body that is a mass at its master alone: 7 m above the base, and 1 m beside it.
TEST(VerdictTop, OfARigidBodyWithoutANodeIsItsCentreOfMass) {
  const auto body = [](const char* slaves) {
    return std::string("title = \"body\"\nbonded = false\n[nodes]\nfoot = [0, 0, 0]\nhigh = [0, 0, 9]\n[[rigid]]\nnode = \"foot\"\n") +
           slaves +
           R"(mass = 2e4
inertias = [1e5, 1e5, 1e5]
centre = [1, 0, 7]
[[interface]]
name = "soil"
footing = { body = "foot", width = 4, length = 4, points = 3, points_across = 3 }
law = { type = "elastic", K_n = 2e8, K_t = 1e8 }
[[load]]
node = "foot"
moments = [-3e5, 4e5, 0]
[gravity]
acceleration = [0, 0, -9.81]
[[stage]]
type = "static"
)";
  };
  // about both axes M/(k I), of y with the weight 1 m beside the middle; a twist has no cause
  const double rocking = 2e8 * 4 * 8, about_x = 3e5 / rocking, about_y = (4e5 + 2e4 * 9.81) / rocking;
  const BuiltCase alone = built_of(body("") + "[[support]]\nnode = \"high\"\nfixed = [\"ux\", \"uy\", \"uz\", \"rx\", \"ry\", \"rz\"]\n");
  EXPECT_EQ(alone.name_of_top(), "the centre of mass of foot");
  const RunResult run = run_of(alone);
  ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
  EXPECT_NEAR(top_motion(alone, run)->value, 7 * std::hypot(about_x, about_y), 1e-12);
  EXPECT_NEAR(largest_drift(alone, run, Drift::with_rotation)->value, 7 * std::hypot(about_x, about_y), 1e-12);
  EXPECT_NEAR(largest_drift(alone, run, Drift::without_rotation)->value, 0, 1e-12);
  EXPECT_EQ(built_of(body("slaves = [\"high\"]\n")).name_of_top(), "node high");
}

/// On a rigid base that tilts and twists, a top beside the base moves as theta x r: no deformation.
TEST(VerdictMotion, TheWholeRotationOfTheBaseIsTakenOff) {
  const BuiltCase built = built_of(R"(title = "mast beside its base"
bonded = false
[nodes]
base = [0, 0, 0]
top = [3, -2, 10]
[[rigid]]
node = "base"
slaves = ["top"]
mass = 1e4
inertia = 1e4
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
  // the moment r x F over the stiffness: the areas of 3 x 3 points times x2 are 32 m4 about both axes, twice that about the vertical
  const double x = -4e5 / (2e8 * 32), y = 3e5 / (2e8 * 32), z = 1.8e5 / (1e8 * 64);
  EXPECT_NEAR(largest_drift(built, run, Drift::with_rotation)->value, std::hypot(y * 10 + z * 2, z * 3 - x * 10), 1e-12);
  EXPECT_NEAR(largest_drift(built, run, Drift::without_rotation)->value, 0, 1e-12);
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
