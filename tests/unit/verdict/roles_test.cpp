// Bases and walls of embedded foundations: forces by hand, division by normals, what is asked of a wall.
#include <cmath>
#include <optional>

#include "unit/verdict/strip_support.h"
#include "uplift/verdict/foundation.h"
#include "uplift/verdict/verdict.h"

namespace uplift::roles_test {
namespace {

using namespace support;

const InterfaceVerdict& interface_of(const VerdictNumbers& numbers, const std::string& name) {
  for (const InterfaceVerdict& each : numbers.interfaces)
    if (each.name == name) return each;
  ADD_FAILURE() << "no interface " << name;
  return numbers.interfaces.front();
}

double value(const std::vector<VerdictNumber>& numbers, QuantityName name) {
  const VerdictNumber* found = find_number(numbers, name);
  EXPECT_NE(found, nullptr) << (*name).name;
  return found ? found->value : NAN;
}

// ---- a rigid block on elastic springs below and beside it ----

constexpr double force = 3e5, height = 7;                    // N, m: where it pushes
constexpr double base_k = 2e8, base_kt = 1e8, wall_k = 5e7;  // Pa/m

/// Static: the walls come first in the file.
std::string block() {
  return R"(title = "embedded block"
bonded = false
[nodes]
base = [0, 0]
l1 = [-2, 1]
l2 = [-2, 3]
r1 = [2, 1]
r2 = [2, 3]
[[rigid]]
name = "block"
node = "base"
slaves = ["l1", "l2", "r1", "r2"]
mass = 1e4
inertia = 1e4
[[interface]]
name = "left"
pairs = { upper = ["l1", "l2"], normal = [1, 0], area = 2 }
law = { type = "elastic", K_n = 5e7, tangential = "none" }
[[interface]]
name = "underside"
footing = { body = "base", width = 4, points = 3 }
law = { type = "elastic", K_n = 2e8, K_t = 1e8 }
[[interface]]
name = "right"
pairs = { upper = ["r1", "r2"], normal = [-1, 0], area = 2 }
law = { type = "elastic", K_n = 5e7, tangential = "none" }
[[load]]
node = "base"
force = [3e5, 0]
moment = -2.1e6
[[stage]]
type = "static"
)";
}

/// Displacement and rotation of the block, and what each wall carries: two equations by hand.
struct ByHand {
  double u, theta, wall_force, wall_moment;  // m, rad, N and N m of one wall on the ground
};
ByHand by_hand() {
  // three points of the trapezoidal rule on 4 m: 1, 2, 1 m
  const double shear_k = base_kt * 4, rock_k = base_k * (1 + 1) * 4, pair_k = wall_k * 2;
  const double heights[] = {1, 3};
  double n = 0, s = 0, i = 0;  // sums over the pairs of both walls
  for (const double z : heights) n += 2 * pair_k, s += 2 * pair_k * z, i += 2 * pair_k * z * z;
  // (shear_k + n) u - s theta = H;  -s u + (rock_k + i) theta = -H h
  const double a = shear_k + n, b = -s, d = rock_k + i, det = a * d - b * b;
  ByHand made{(force * d + b * force * height) / det, (-force * height * a - b * force) / det, 0, 0};
  for (const double z : heights) {
    const double pushes = pair_k * (made.u - made.theta * z);  // along x, on the ground
    made.wall_force += pushes;
    made.wall_moment -= z * pushes;
  }
  return made;
}

TEST(VerdictRoles, WallsCarryTheirShareOfForceAndMoment) {
  const BuiltCase built = built_of(block());
  ASSERT_EQ(built.facts.size(), 3u);
  EXPECT_EQ(built.facts[0].name, "underside");  // bases first
  EXPECT_EQ(built.bases(), 1u);
  const RunResult run = run_of(built);
  ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
  const VerdictNumbers numbers = numbers_of(built, run, nullptr);
  const ByHand hand = by_hand();
  EXPECT_NEAR(value(numbers.whole, "max_total_shear"), force, 1e-9 * force);
  EXPECT_NEAR(value(numbers.whole, "max_total_moment"), force * height, 1e-9 * force * height);
  double share = 0;
  for (const char* wall : {"left", "right"}) {
    const InterfaceVerdict& said = interface_of(numbers, wall);
    EXPECT_EQ(said.role, Role::wall);
    EXPECT_NEAR(value(said.numbers, "share_of_horizontal_force"), hand.wall_force / force, 1e-9) << wall;
    EXPECT_NEAR(value(said.numbers, "share_of_base_moment"), -hand.wall_moment / (force * height), 1e-9) << wall;
    EXPECT_EQ(find_number(said.numbers, "max_eccentricity"), nullptr);
    EXPECT_EQ(find_number(said.numbers, "min_overturning_safety"), nullptr);
    share += value(said.numbers, "share_of_horizontal_force");
  }
  EXPECT_NEAR(value(interface_of(numbers, "underside").numbers, "max_shear"), std::abs(1 - share) * force,
              1e-9 * force);  // it may turn back
  EXPECT_NEAR(value(interface_of(numbers, "underside").numbers, "max_moment"), std::abs(base_k * 8 * hand.theta), 1e-3);
  EXPECT_EQ(value(interface_of(numbers, "left").numbers, "max_opening"), 0);  // the block pulls at this wall, which holds it
  EXPECT_NEAR(value(interface_of(numbers, "right").numbers, "max_toe_pressure"), wall_k * (hand.u - 3 * hand.theta), 1e-3);
}

TEST(VerdictRoles, WhatIsSaidOfTheRunIsSaidOfTheBases) {
  const BuiltCase built = built_of(block());
  const RunResult run = run_of(built);
  EXPECT_NEAR(run.max_base_moment.value, base_k * 8 * by_hand().theta, 1e-3);
}

/// A block that is too heavy to lift off leaves one of its walls.
TEST(VerdictRoles, TheGapOfAWallIsNotThatOfTheBase) {
  std::string text = block();
  for (std::size_t at; (at = text.find("\"elastic\"")) != text.npos;) text.replace(at, 9, "\"springs\"");
  text.replace(text.find("force = [3e5, 0]\nmoment = -2.1e6"), 32, "force = [3e5, -2e7]\n");
  text.replace(text.find("K_t = 1e8"), 9, "tangential = \"none\"");
  const BuiltCase built = built_of(text);
  const RunResult run = run_of(built);
  ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
  // the other wall and the base hold it: n u - s theta = H, -s u + d theta = 0
  const double pair_k = wall_k * 2, n = 2 * pair_k, s = 4 * pair_k, d = 10 * pair_k + base_k * 8;
  const double det = n * d - s * s, u = force * d / det, theta = force * s / det;
  EXPECT_EQ(run.max_opening.value, 0);
  EXPECT_EQ(run.max_uplifted_ratio.value, 0);
  EXPECT_NEAR(value(interface_of(numbers_of(built, run, nullptr), "left").numbers, "max_opening"), u - theta, 1e-9 * u);
}

/// Walls that rub: in space their forces have three parts and their moment one about the normal.
TEST(VerdictRoles, SharesInSpace) {
  const BuiltCase built = built_of(R"(title = "embedded box"
bonded = false
[nodes]
base = [0, 0, 0]
west = [-2, 0, 1]
east = [2, 0, 1]
[[rigid]]
name = "box"
node = "base"
slaves = ["west", "east"]
mass = 1e4
inertia = 1e4
[[interface]]
name = "underside"
footing = { body = "base", width = 4, length = 4, points = 3, points_across = 3 }
law = { type = "elastic", K_n = 2e8, K_t = 1e8 }
[[interface]]
name = "west wall"
pairs = { upper = ["west"], normal = [1, 0, 0], area = 8 }
law = { type = "elastic", K_n = 5e7, K_t = 3e7 }
[[interface]]
name = "east wall"
pairs = { upper = ["east"], normal = [-1, 0, 0], area = 8 }
law = { type = "elastic", K_n = 5e7, K_t = 3e7 }
[[load]]
node = "base"
force = [0, 3e5, 0]
moments = [-2.1e6, 0, 0]
[[stage]]
type = "static"
)");
  const RunResult run = run_of(built);
  ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
  const VerdictNumbers numbers = numbers_of(built, run, nullptr);
  // a push along y at 7 m: v of the box, rotation about x; the walls stick at z = 1 and x = -2, 2, where a rotation about x moves them by
  // v - z theta along y and not along z (y = 0)
  const double shear_k = 1e8 * 16, rock_k = 2e8 * 4 * (1 + 1) * 4, wall = 3e7 * 8;  // trapezoid across: 1, 2, 1 m
  const double a = shear_k + 2 * wall, b = -2 * wall, d = rock_k + 2 * wall, det = a * d - b * b, push = 3e5, turn = -2.1e6;
  const double v = (push * d - b * turn) / det, theta = (turn * a - b * push) / det;
  const double carried = wall * (v - theta);
  for (const char* name : {"west wall", "east wall"}) {
    EXPECT_NEAR(value(interface_of(numbers, name).numbers, "share_of_horizontal_force"), carried / push, 1e-9);
    EXPECT_NEAR(value(interface_of(numbers, name).numbers, "share_of_base_moment"), carried / 2.1e6, 1e-9);
    EXPECT_NEAR(value(interface_of(numbers, name).numbers, "max_slip"), v - theta, 1e-12);
  }
  EXPECT_NEAR(value(numbers.whole, "max_total_moment"), 2.1e6, 1e-3);
}

// ---- division by normals ----

/// A block of 4 m in a pit of 2 m: one line around it, which is walked with the structure on the left.
std::string pit(const std::string& more, const std::string& interface_more = "") {
  return R"(title = "pit"
bonded = false
[nodes]
base = [0, 0]
a = [-2, 2]
b = [-2, 0]
c = [2, 0]
d = [2, 2]
[[rigid]]
name = "block"
node = "base"
slaves = ["a", "b", "c", "d"]
mass = 2e4
inertia = 1e5
[[interface]]
name = "soil"
line = { upper = ["a", "b", "c", "d"] }
law = { type = "springs", K_n = 1e8, K_t = 5e7, tangential = "coulomb", friction = 0.5 }
)" + interface_more +
         R"([gravity]
acceleration = [0, -10]
[[load]]
name = "push"
node = "base"
force = [2e5, 0]
[[stage]]
type = "static"
)" + more;
}

TEST(VerdictRoles, OneGroupIsDividedByItsNormals) {
  const BuiltCase built = built_of(pit("[[output.history]]\ninterface = \"soil walls\"\nquantity = \"max_opening\"\n"));
  ASSERT_EQ(built.facts.size(), 2u);
  EXPECT_EQ(built.facts[0].name, "soil");
  EXPECT_EQ(built.facts[1].name, "soil walls");
  EXPECT_EQ(built.facts[1].role, Role::wall);
  EXPECT_NEAR(built.facts[0].area, 4, 1e-12);
  EXPECT_NEAR(built.facts[1].area, 4, 1e-12);
  EXPECT_NEAR(built.weight(), 2e5, 1e-6);
  const RunResult run = run_of(built);
  ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
  const VerdictNumbers numbers = numbers_of(built, run, nullptr);
  EXPECT_NEAR(value(interface_of(numbers, "soil").numbers, "max_compression"), 2e5, 2e5 * 0.5);  // the walls may rub
  EXPECT_NEAR(value(numbers.whole, "max_total_shear"), 2e5, 1e-4);
  const bool asked = std::ranges::any_of(run.columns, [](const Request& column) { return column.name == "soil walls.max_opening"; });
  EXPECT_TRUE(asked);
}

/// The last value of a column of the histories; none without it.
std::optional<double> last_of(const RunResult& run, const std::string& name) {
  for (std::size_t k = 0; k < run.columns.size(); ++k)
    if (run.columns[k].name == name) return run.table[k + 1].back();
  return {};
}

/// Smooth walls push sideways with their pressure alone, a level base does not.
TEST(VerdictRoles, SmoothWallsBearTheHorizontalForce) {
  std::string text = pit("");
  const std::string rough = ", K_t = 5e7, tangential = \"coulomb\", friction = 0.5";
  text.erase(text.find(rough), rough.size());
  const BuiltCase built = built_of(text);
  const RunResult run = run_of(built);
  ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
  ASSERT_TRUE(last_of(run, "soil walls.shear"));
  EXPECT_NEAR(*last_of(run, "soil walls.shear"), 2e5, 1e-3);
  EXPECT_FALSE(last_of(run, "soil.shear"));
  EXPECT_EQ(find_number(interface_of(numbers_of(built, run, nullptr), "soil").numbers, "max_shear"), nullptr);
}

/// A wedge of 30 degrees in a smooth groove: both sides are bases, and their pressures bear the weight and the push in full.
TEST(VerdictRoles, AWedgeBearsItsWholeWeightAndThePush) {
  const BuiltCase built = built_of(R"(title = "wedge"
bonded = false
[nodes]
tip = [0, 0]
left = [-2, 1.1547005383792515]
right = [2, 1.1547005383792515]
[[rigid]]
name = "wedge"
node = "tip"
slaves = ["left", "right"]
mass = 2e4
inertia = 1e5
[[interface]]
name = "groove"
line = { upper = ["left", "tip", "right"] }
law = { type = "springs", K_n = 1e8 }
[gravity]
acceleration = [0, -10]
[[load]]
node = "tip"
force = [3e4, 0]
[[stage]]
type = "static"
)");
  ASSERT_EQ(built.facts.size(), 1u);
  EXPECT_EQ(built.facts[0].role, Role::base);
  EXPECT_NEAR(built.weight(), 2e5, 1e-6);  // not its part along the normal of one side, 1.73e5
  const RunResult run = run_of(built);
  ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
  const VerdictNumbers numbers = numbers_of(built, run, nullptr);
  const InterfaceVerdict& said = numbers.interfaces.front();
  EXPECT_NEAR(value(said.numbers, "max_compression"), 2e5, 1e-3);
  EXPECT_NEAR(value(said.numbers, "max_shear"), 3e4, 1e-3);
  ASSERT_TRUE(last_of(run, "groove.shear"));
  EXPECT_NEAR(*last_of(run, "groove.shear"), 3e4, 1e-3);
}

TEST(VerdictRoles, TheRoleCanBeStated) {
  const BuiltCase built = built_of(pit("", "role = \"base\"\n"));
  ASSERT_EQ(built.facts.size(), 1u);
  EXPECT_EQ(built.facts[0].role, Role::base);
  EXPECT_NEAR(built.facts[0].area, 8, 1e-12);
}

TEST(VerdictRoles, AVariantNamesTheWalls) {
  static const std::vector<RunSpec> specs = [] {
    static const Case file =
        check_case(read_toml_text(pit("[[variant]]\nname = \"smooth\"\ninterface = \"soil walls\"\nlaw = { type = \"springs\", K_n = 1e8, "
                                      "tangential = \"none\" }\n"),
                                  "case.toml"),
                   "case.toml");
    return comparison_of_case(file).runs;
  }();
  const BuiltCase built = built_of(pit(""), specs.front());
  EXPECT_EQ(built.model.interfaces[0].batch.components, 2);
  EXPECT_EQ(built.model.interfaces[1].batch.components, 1);
}

TEST(VerdictRoles, SlopesUpTo45DegreesAreBases) {
  for (const double degrees : {0.0, 30.0, 44.9, 45.1, 80.0}) {
    const double angle = degrees * M_PI / 180;
    const BuiltCase built = built_of(
        "title = \"t\"\nbonded = false\n[nodes]\nbase = [0, 0]\n[[mass]]\nnode = \"base\"\nmass = 1\ninertia = 1\n"
        "[[support]]\nnode = \"base\"\nfixed = [\"rz\"]\n[[interface]]\nname = \"soil\"\npairs = { upper = [\"base\"], area "
        "= 1, normal = [" +
        std::to_string(std::sin(angle)) + ", " + std::to_string(std::cos(angle)) +
        "] }\nlaw = { type = \"elastic\", K_n = 1e6, K_t = 1e6 }\n[[stage]]\ntype = \"static\"\n");
    EXPECT_EQ(built.facts.front().role, degrees < 45 ? Role::base : Role::wall) << degrees;
  }
}

TEST(VerdictRoles, ACriterionOfAWallIsAboutAWall) {
  const auto refusal = [](const std::string& quantity, const std::string& interface) -> std::string {
    try {
      built_of(pit("[[verdict.criterion]]\nquantity = \"" + quantity + "\"\nlimit = 1\nsource = \"client\"\ninterface = \"" + interface +
                   "\"\n"));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal("max_eccentricity", "soil walls").find("a number of a wall"), std::string::npos);
  EXPECT_NE(refusal("max_slip", "soil").find("a number of a base"), std::string::npos);
  EXPECT_EQ(refusal("max_slip", "soil walls"), "");
  EXPECT_EQ(refusal("max_opening", "soil walls"), "");
  const BuiltCase built = built_of(pit("[[verdict.criterion]]\nquantity = \"max_opening\"\nlimit = 1\nsource = \"client\"\n"));
  const VerdictNumbers numbers = numbers_of(built, run_of(built), nullptr);
  ASSERT_EQ(numbers.criteria.size(), 1u);  // of the base alone
  EXPECT_EQ(numbers.criteria.front().interface, "soil");
}

// ---- noise ----

TEST(VerdictNoise, AChangeNeedsSomethingThatChanges) {
  EXPECT_NEAR(change_of(3, 2, 0.1).value(), 0.5, 1e-15);
  EXPECT_FALSE(change_of(1e-14, 3e-15, 0.1));                // both are noise
  EXPECT_NEAR(change_of(5, 1e-12, 0.1).value(), 49, 1e-12);  // at most that of the threshold
  EXPECT_NEAR(change_of(1e-12, 5, 0.1).value(), -1, 1e-12);
  EXPECT_FALSE(change_of(0, 0, 0));
  EXPECT_FALSE(change_of(-1, 2, 0));
  EXPECT_NEAR(change_beside(3, 2, 0.1).value(), 0.5, 1e-15);
  EXPECT_NEAR(change_beside(1e-12, 5, 0.1).value(), -1, 1e-12);
  EXPECT_FALSE(change_beside(5, 1e-12, 0.1));  // nothing was there that could change
}

/// Vertical motion alone: a shear of round-off is neither compared nor a safety against sliding.
TEST(VerdictNoise, AShearOfRoundOffIsNotCompared) {
  const BuiltCase built = built_of(winkler_strip::strip("", "5", ""));
  const auto moved = [](double shear) {
    return run_of({view_of({.axial = -1e6}), view_of({.axial = -1.3e6, .shear = shear, .moment = shear})}, 0.1);
  };
  const auto numbers = [&](double shear, double bonded_shear) {
    const RunResult bonded = moved(bonded_shear);
    return numbers_of(built, moved(shear), &bonded);
  };
  const VerdictNumbers noise = numbers(1e-8, 3e-10), real = numbers(2e5, 4e5);
  EXPECT_EQ(find_number(noise.interfaces[0].numbers, "change_of_shear"), nullptr);
  EXPECT_EQ(find_number(noise.interfaces[0].numbers, "change_of_moment"), nullptr);
  EXPECT_EQ(find_number(noise.interfaces[0].numbers, "min_sliding_safety"), nullptr);
  EXPECT_NEAR(value(real.interfaces[0].numbers, "change_of_shear"), -0.5, 1e-15);
  EXPECT_NEAR(value(real.interfaces[0].numbers, "min_sliding_safety"), 0.6 * 1.3e6 / 2e5, 1e-12);
  EXPECT_NEAR(value(noise.interfaces[0].numbers, "change_of_compression"), 0, 1e-15);
}

}  // namespace
}  // namespace uplift::roles_test
