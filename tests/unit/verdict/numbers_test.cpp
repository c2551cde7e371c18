// The verdict's numbers against closed forms: a rigid strip on Winkler springs, rafts in space, sliding, flights.
#include "uplift/verdict/numbers.h"

#include <fmt/format.h>

#include <cmath>
#include <regex>

#include "tower_case.h"
#include "unit/verdict/strip_support.h"
#include "uplift/verdict/base_over_time.h"
#include "uplift/verdict/edge_warnings.h"

namespace uplift::numbers_test {
namespace {

using namespace support;
using namespace winkler_strip;

// ---- the linear tension ratio ----

TEST(TensionRatio, EqualEnergyOnAWinklerStrip) {
  // the prediction of eq (31) of docs/theory, by hand
  for (const auto& [t, percent] : {std::pair{0.10, 10.66}, {0.20, 23.37}, {0.30, 39.75}, {0.35, 50.17}})
    EXPECT_NEAR(100 * uplift_of_tension(t).value(), percent, 0.005) << t;
  for (double t = 0.01; t < 0.495; t += 0.02) {
    // 1/2 y^2 = 3 x - 4 sqrt(x) + 1.5 with the uplift 1 - 1/sqrt(x)
    const double y = 1 / (1 - 2 * t), root = 1 / (1 - uplift_of_tension(t).value());
    EXPECT_NEAR(3 * root * root - 4 * root + 1.5, y * y / 2, 1e-12 * y * y) << t;
  }
}

TEST(TensionRatio, NothingWithoutTensionAndNoAnswerFromOneHalfOn) {
  EXPECT_EQ(uplift_of_tension(0), 0);
  EXPECT_FALSE(uplift_of_tension(0.5));
  EXPECT_FALSE(uplift_of_tension(0.8));
}

// ---- a rigid strip on Winkler springs ----

TEST(VerdictNumbersTest, WinklerStripUpTo30Percent) {
  const BuiltCase built = built_of(strip("[verdict]\nuplifted_ratio_thresholds = [0.1, 0.25, 0.5]\n"));
  std::vector<InterfaceView> views;
  const double most = 1 / (0.7 * 0.7);  // 2.040816
  for (const double ratio : {0.0, 0.5, 1.2, 1.5, most, 1.8, 1.1, 0.2}) views.push_back(turned(built, ratio));
  const VerdictNumbers numbers = numbers_of(built, run_of(views, 0.1), nullptr);
  const InterfaceVerdict& said = numbers.interfaces.at(0);
  EXPECT_NEAR(said.weight, dead_load, 1e-6 * dead_load);
  EXPECT_NEAR(said.mean_pressure, dead_load / width, 1e-6 * dead_load);
  EXPECT_NEAR(number(numbers, "max_uplifted_ratio"), 0.3, 1e-3);
  EXPECT_NEAR(*find_number(said.numbers, "max_uplifted_ratio")->time, 0.4, 1e-12);
  EXPECT_NEAR(number(numbers, "max_opening"), width * most * theta_u * 0.3, 1e-9);  // 2 b theta (1 - sqrt(theta_u/theta))
  EXPECT_NEAR(number(numbers, "toe_pressure_ratio"), 2.857143, 1e-5);
  EXPECT_NEAR(number(numbers, "max_moment"), 1.6 * dead_load * width / 6, 1e-5 * dead_load);
  EXPECT_NEAR(number(numbers, "max_eccentricity"), 1.6 / 6, 1e-5);
  EXPECT_NEAR(number(numbers, "min_overturning_safety"), 3 / 1.6, 1e-4);
  EXPECT_NEAR(number(numbers, "first_uplift"), 0.2, 1e-12);
  EXPECT_NEAR(number(numbers, "uplifted_time"), 0.5, 1e-12);
  EXPECT_EQ(number(numbers, "full_loss_time"), 0);
  // uplifted shares 1 - 1/sqrt(theta/theta_u): 0.087, 0.184, 0.3, 0.255, 0.047
  EXPECT_NEAR(said.above.at(0).duration, 0.3, 1e-12);
  EXPECT_NEAR(said.above.at(1).duration, 0.2, 1e-12);
  EXPECT_EQ(said.above.at(2).duration, 0);
}

TEST(VerdictNumbersTest, HistoriesOfTheStrip) {
  const BuiltCase built = built_of(strip());
  const std::vector<InterfaceView> views{turned(built, 0), turned(built, 0.5), turned(built, 4)};
  const RunResult run = run_of(views, 0.1);
  const auto history = [&](BaseHistory which) { return base_history(built, run, 0, which); };
  // M/M_u = theta/theta_u up to 1, then 3 - 2 sqrt(theta_u/theta); M_u = W b/3; the pressure moves to the side that goes down
  EXPECT_NEAR(history(BaseHistory::eccentricity_1)[1], -0.5 / 6, 1e-6);
  EXPECT_NEAR(history(BaseHistory::eccentricity_1)[2], -2.0 / 6, 1e-6);
  EXPECT_NEAR(history(BaseHistory::overturning_safety)[2], 1.5, 1e-5);
  EXPECT_NEAR(history(BaseHistory::uplifted_ratio)[2], 0.5, 1e-3);
  EXPECT_TRUE(std::isnan(history(BaseHistory::sliding_safety)[2]));  // no shear
}

TEST(VerdictNumbersTest, BesideTheBondedStrip) {
  const BuiltCase built = built_of(strip());
  const RunResult run = run_of({turned(built, 0), turned(built, 2)}, 0.1);
  // bonded, M = 2.5 M_u: pressure W/B (1 + 2.5 x/b), so the share (1 - 1/2.5)/2 pulls
  std::vector<InterfaceView> views{turned(built, 0), turned(built, 0)};
  views[1].resultant.moment = 2.5 * dead_load * width / 6;
  views[1].tension_area = 0.3;
  const RunResult bonded = run_of(views, 0.1);
  const VerdictNumbers numbers = numbers_of(built, run, &bonded);
  EXPECT_NEAR(number(numbers, "change_of_moment"), (3 - std::sqrt(2.0)) / 2.5 - 1, 1e-5);
  EXPECT_NEAR(number(numbers, "change_of_compression"), 0, 1e-6);
  EXPECT_NEAR(number(numbers, "linear_tension_ratio"), 0.3, 1e-12);
  EXPECT_NEAR(number(numbers, "predicted_uplifted_ratio"), 0.3975, 5e-5);
  const VerdictNumber* eccentricity = find_number(numbers.interfaces[0].numbers, "max_eccentricity");
  EXPECT_NEAR(eccentricity->bonded.value(), 2.5 / 6, 1e-6);  // the thrust of a bonded base may leave it
}

// ---- safeties ----

TEST(VerdictNumbersTest, SlidingSafety) {
  const BuiltCase built = built_of(strip());
  const double area = width;
  std::vector<InterfaceView> views{view_of({.axial = -dead_load})};
  views.push_back(view_of({.axial = -dead_load, .shear = 3e5}));
  views.push_back(view_of({.axial = -0.5 * dead_load, .shear = -2.5e5}, 0.4));
  views.push_back(view_of({.axial = -1e-4 * dead_load, .shear = 1e5}, 0.9));  // carries nothing: no place of the thrust, no safety
  const RunResult run = run_of(views, 0.1);
  const std::vector<double> history = base_history(built, run, 0, BaseHistory::sliding_safety);
  EXPECT_NEAR(history[1], (0.6 * dead_load + 2e4 * area) / 3e5, 1e-12);
  EXPECT_NEAR(history[2], (0.3 * dead_load + 2e4 * area * 0.6) / 2.5e5, 1e-12);
  EXPECT_TRUE(std::isnan(history[3]));
  const VerdictNumbers numbers = numbers_of(built, run, nullptr);
  EXPECT_NEAR(number(numbers, "min_sliding_safety"), history[2], 1e-15);
  EXPECT_EQ(number(numbers, "max_shear"), 3e5);
  EXPECT_NEAR(number(numbers, "min_compression"), 1e-4 * dead_load, 1e-9);
}

TEST(VerdictNumbersTest, WeightThatIsTakenAwayDrivesToo) {
  const BuiltCase built = built_of(strip());
  // stabilising W b about either toe; driving (W - N) b + |M|
  const RunResult run = run_of({view_of({.axial = -dead_load}), view_of({.axial = -0.8 * dead_load, .moment = -0.3 * dead_load})}, 0.1);
  EXPECT_NEAR(number(numbers_of(built, run, nullptr), "min_overturning_safety"), 1.5 / (0.2 * 1.5 + 0.3), 1e-12);
}

TEST(VerdictNumbersTest, AnEccentricWeightStandsNearerToOneToe) {
  const BuiltCase built = built_of(strip());
  // at rest the thrust stands 0.5 m to the right; 0.25 m further needs (1.5 - 0.5)/0.25
  const auto right = [](double e) { return view_of({.axial = -dead_load, .moment = -e * dead_load}); };
  EXPECT_NEAR(number(numbers_of(built, run_of({right(0.5), right(0.75)}, 0.1), nullptr), "min_overturning_safety"), 4, 1e-12);
  EXPECT_NEAR(number(numbers_of(built, run_of({right(0.5), right(0.25)}, 0.1), nullptr), "min_overturning_safety"), 8, 1e-12);
}

BuiltCase raft(double azimuth = 0.3,
               const std::string& law = "{ type = \"springs\", K_n = 5e7, K_t = 2e7, tangential = \"coulomb\", friction = 0.7 }") {
  return built_of(R"(title = "raft"
[nodes]
base = [0, 0, 0]
[[rigid]]
name = "raft"
node = "base"
mass = 2e4
inertias = [5e4, 8e4, 1.2e5]
[[interface]]
name = "soil"
footing = { body = "base", width = 6, length = 4, points = 7, points_across = 5, azimuth = )" +
                  fmt::format("{}", azimuth) + " }\nlaw = " + law + R"(
[gravity]
acceleration = [0, 0, -9.81]
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 0.1
step = 0.01
)");
}

TEST(VerdictNumbersTest, OverturningAboutTheEdgesOfATurnedRaft) {
  const BuiltCase built = raft();
  const auto thrust_at = [](double e, double angle) {  // a force P at r pushes down: r x (0, 0, -P) = P (-y, x, 0); on the ground -n P
    const double x = e * std::cos(angle), y = e * std::sin(angle);
    return view_of({.axial = -1, .moment = e, .moment_1 = -y, .moment_2 = x});
  };
  const auto safety = [&](double e, double angle) {
    return number(numbers_of(built, run_of({thrust_at(0, 0), thrust_at(e, angle)}, 0.1), nullptr), "min_overturning_safety");
  };
  EXPECT_NEAR(safety(0.5, 0.3), 3 / 0.5, 1e-9);
  EXPECT_NEAR(safety(0.5, 0.3 + M_PI), 3 / 0.5, 1e-9);
  EXPECT_NEAR(safety(0.5, 0.3 + M_PI / 2), 2 / 0.5, 1e-9);
  EXPECT_NEAR(safety(0.5, 0), 3 / (0.5 * std::cos(0.3)), 1e-9);
  EXPECT_NEAR(safety(0.5, 1.0), std::min(3 / (0.5 * std::cos(0.7)), 2 / (0.5 * std::sin(0.7))), 1e-9);
}

TEST(VerdictNumbersTest, TwoEccentricitiesInSpace) {
  const BuiltCase built = raft();
  // a thrust at (0.6, -0.9): the resultant of the forces themselves
  const Interface& interface = built.model.interfaces.front();
  const int n = interface.batch.points;
  State state;
  state.displacement = Vector::Zero(built.model.free());
  state.opening = state.force = Vector::Zero(interface.rows());
  double sum = 0, first_x = 0, first_y = 0;
  for (int i = 0; i < n; ++i) {
    const Place& at = interface.position[static_cast<std::size_t>(i)];
    const double pressure = 10 + at.x() - 2 * at.y();
    state.force[2 * n + i] = -pressure * interface.area[i];
    sum += pressure * interface.area[i];
    first_x += pressure * interface.area[i] * at.x();
    first_y += pressure * interface.area[i] * at.y();
  }
  state.mean_force = state.force;
  std::vector<InterfaceView> views;
  InterfaceViewer(built.model, 1e-9, {}).look(state, views);
  const RunResult run = run_of({views.front()}, 0.1);
  // along the sides of the raft, which is turned by 0.3: at the edge of the middle third e/B is 1/6 in its own axes alone
  const double c = std::cos(0.3), s = std::sin(0.3);
  EXPECT_NEAR(base_history(built, run, 0, BaseHistory::eccentricity_1)[0], (c * first_x + s * first_y) / sum / 6, 1e-12);
  EXPECT_NEAR(base_history(built, run, 0, BaseHistory::eccentricity_2)[0], (c * first_y - s * first_x) / sum / 4, 1e-12);
}

/// The first side is the one within 45 degrees of the x axis, whichever the file calls the width.
TEST(VerdictNumbersTest, SidesOfTurnedRafts) {
  for (const double azimuth : {-0.6, 0.0, 0.3, M_PI / 4, 1.2, M_PI / 2, 3.0}) {
    const BuiltCase built = raft(azimuth);
    const double first = std::remainder(azimuth - 1e-9, M_PI / 2) + 1e-9;  // -45 to 45 degrees, the end included
    const bool is_width = std::abs(std::sin(first - azimuth)) < 0.5;
    const double one = is_width ? 6 : 4, two = is_width ? 4 : 6, e = 0.4;
    const auto at = [&](double angle) {  // a unit thrust at the distance e from the middle, in this direction
      return run_of({view_of({.axial = -1, .moment = e, .moment_1 = -e * std::sin(angle), .moment_2 = e * std::cos(angle)})}, 0.1);
    };
    EXPECT_NEAR(base_history(built, at(first), 0, BaseHistory::eccentricity_1)[0], e / one, 1e-12) << azimuth;
    EXPECT_NEAR(base_history(built, at(first), 0, BaseHistory::eccentricity_2)[0], 0, 1e-12) << azimuth;
    EXPECT_NEAR(base_history(built, at(first + M_PI / 2), 0, BaseHistory::eccentricity_2)[0], e / two, 1e-12) << azimuth;
  }
}

/// On a disc e/D is that of the thrust in every direction, on a rectangle the larger one along its sides.
TEST(VerdictNumbersTest, EccentricityOfADiscAndOfARectangle) {
  const auto thrust_at = [](double x, double y) {
    return run_of({view_of({.axial = -1, .moment = std::hypot(x, y), .moment_1 = -y, .moment_2 = x})}, 0.1);
  };
  const BuiltCase disc = built_of(R"(title = "disc"
[nodes]
base = [0, 0, 0]
[[rigid]]
node = "base"
mass = 1
inertia = 1
[[foundation]]
name = "ground"
body = "base"
shape = "disc"
width = 6
model = { type = "elastic", K_v = 1e9, K_h = 1e9, K_r = 1e10, K_t = 1e10 }
[gravity]
[[stage]]
type = "static"
)");
  for (const double angle : {0.0, 0.4, M_PI / 4, 2.0}) {
    const VerdictNumbers numbers = numbers_of(disc, thrust_at(1.8 * std::cos(angle), 1.8 * std::sin(angle)), nullptr);
    EXPECT_NEAR(number(numbers, "max_eccentricity"), 0.3, 1e-12) << angle;
    EXPECT_EQ(find_number(numbers.interfaces[0].numbers, "max_eccentricity_sum"), nullptr);
    EXPECT_EQ(words_of_eccentricity(numbers.interfaces[0]), "largest of M/N over the diameter");
    EXPECT_EQ(label_of_eccentricity(numbers.interfaces[0]), "Eccentricity e/D");
  }
  const BuiltCase rectangle = raft(0);  // 6 m by 4 m
  const VerdictNumbers both = numbers_of(rectangle, thrust_at(2.25, 0.8), nullptr),
                       one = numbers_of(rectangle, thrust_at(2.25, 0.01), nullptr);
  EXPECT_NEAR(number(both, "max_eccentricity"), 0.375, 1e-12);
  EXPECT_NEAR(number(both, "max_eccentricity_sum"), 0.575, 1e-12);
  EXPECT_EQ(words_of_eccentricity(both.interfaces[0]),
            "e1/B1 + e2/B2 up to 0.575 (full contact: up to 1/6); largest of M/N over the width");
  EXPECT_EQ(words_of_eccentricity(one.interfaces[0]), "largest of M/N over the width");
  EXPECT_EQ(label_of_eccentricity(one.interfaces[0]), "Eccentricity e/B");
  const BuiltCase on_constraints = raft(0, "{ type = \"coulomb\", friction = 0.7 }");  // open on one side under any moment
  EXPECT_EQ(words_of_eccentricity(numbers_of(on_constraints, thrust_at(2.25, 0.8), nullptr).interfaces[0]),
            "e1/B1 + e2/B2 up to 0.575; largest of M/N over the width");
}

/// A base that still goes round on an ellipse: how far it moves does not depend on the axes.
TEST(VerdictNumbersTest, RemainingVariationOfAVector) {
  const BuiltCase built = raft();
  constexpr int instants = 400;
  constexpr double longer = 3e-4, shorter = 1e-4;
  for (const double turned : {0.0, 0.3, 0.9, M_PI / 4, 2.0}) {
    RunResult run = run_of({view_of({.axial = -1})}, 0.1);
    run.steps.rest_poses.assign(1, BasePose());
    run.steps.tail.assign(1, {});
    for (int i = 0; i < instants; ++i) {
      const double phase = 2 * M_PI * i / instants, a = longer * std::cos(phase), b = shorter * std::sin(phase);
      BasePose pose;
      pose.tilt_1 = 5e-4 + std::cos(turned) * a - std::sin(turned) * b;
      pose.tilt_2 = std::sin(turned) * a + std::cos(turned) * b;
      run.steps.tail[0].push_back(pose);
    }
    const VerdictNumbers numbers = numbers_of(built, run, nullptr);
    const VerdictNumber* rotation = find_number(numbers.interfaces.at(0).numbers, "residual_rotation");
    ASSERT_NE(rotation, nullptr);
    EXPECT_NEAR(rotation->value, 5e-4, 1e-12);
    EXPECT_NEAR(rotation->swing.value_or(0), longer, 1e-12) << turned;
  }
}

// ---- whole runs ----

/// A block whose mass is at the level of its base.
std::string block(const std::string& law, const std::string& initial, double duration, double step) {
  return R"(title = "block"
bonded = false
[nodes]
base = [0, 0]
[[rigid]]
name = "block"
node = "base"
mass = 2000
inertia = 1500
[[interface]]
name = "floor"
footing = { body = "base", width = 2, points = 5 }
law = )" +
         law + (law.find("coulomb") == law.npos ? "\n[[support]]\nnode = \"base\"\nfixed = [\"ux\"]" : "") +
         "\n[gravity]\nacceleration = [0, -9.81]\n[[initial]]\nnode = \"base\"\n" + initial +
         "\n[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\nduration = " + std::to_string(duration) +
         "\nstep = " + std::to_string(step) + "\n";
}

TEST(VerdictNumbersTest, FlightsOfABouncingBlock) {
  // springs of 50 Hz with the block: it leaves them with v'^2 = v^2 - (g/omega)^2 and flies for 2 v'/g, again and again
  const double omega = 2 * M_PI * 50, stiffness = 2000 * omega * omega / 2, step = 2e-4;
  const BuiltCase built = built_of(
      block("{ type = \"springs\", K_n = " + std::to_string(stiffness) + ", tangential = \"none\" }", "velocity = [0, 1]", 0.8, step));
  const RunResult run = run_of(built);
  ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
  const VerdictNumbers numbers = numbers_of(built, run, nullptr);
  const std::vector<Interval>& flights = numbers.interfaces.at(0).full_loss;
  const double leaves = std::sqrt(1 - std::pow(9.81 / omega, 2)), flight = 2 * leaves / 9.81;
  ASSERT_EQ(flights.size(), 4);
  EXPECT_NEAR(flights[0].from, std::asin(9.81 / omega / 1.0) / omega, 5e-6);  // x = v sin(omega t)/omega reaches g/omega^2
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(flights[k].to - flights[k].from, flight, 1e-5) << k;
  EXPECT_NEAR(number(numbers, "longest_full_loss"), flight, 1e-5);
  EXPECT_NEAR(flights[3].to, 0.8, 1e-12);  // still in the air at the end
  EXPECT_NEAR(number(numbers, "max_opening"), leaves * leaves / (2 * 9.81), 1e-6);
}

TEST(VerdictNumbersTest, ABlockThatSlidesUntilItStops) {
  // a constraint decides at the end of a step: half a step of the first velocity more
  const double step = 5e-4;
  for (const auto& [law, off] : {std::pair{"{ type = \"coulomb\", friction = 0.5 }", step / 2},
                                 {"{ type = \"springs\", K_n = 1e9, K_t = 1e9, tangential = \"coulomb\", friction = 0.5 }", 0.0}}) {
    const BuiltCase built = built_of(block(law, "velocity = [1, 0]", 0.5, step));
    const RunResult run = run_of(built);
    ASSERT_EQ(run.status, RunStatus::completed) << run.reason;
    const VerdictNumbers numbers = numbers_of(built, run, nullptr);
    EXPECT_NEAR(number(numbers, "residual_slip"), 1 / (2 * 0.5 * 9.81), off + 1e-4 / 9.81) << law;  // v^2/(2 mu g)
    EXPECT_NEAR(number(numbers, "min_sliding_safety"), 1, 1e-6) << law;
    EXPECT_NEAR(number(numbers, "max_shear"), 0.5 * 2000 * 9.81, 1e-6 * 2000) << law;
    EXPECT_NEAR(number(numbers, "residual_settlement"), 0, 1e-9) << law;
  }
}

TEST(BaseMotionTest, SettlementAndTiltOfTwoNodes) {
  const BuiltCase built = built_of(R"(title = "two nodes"
bonded = false
[nodes]
a = [-1, 0]
b = [3, 0]
[[mass]]
node = "a"
mass = 10
inertia = 1
[[mass]]
node = "b"
mass = 10
inertia = 1
[[support]]
node = "a"
fixed = ["ux", "rz"]
[[support]]
node = "b"
fixed = ["ux", "rz"]
[[interface]]
name = "pads"
pairs = { upper = ["a", "b"], area = 2 }
law = { type = "springs", K_n = 1e6, tangential = "none" }
[gravity]
acceleration = [0, -10]
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 0.1
step = 0.01
)");
  State state;
  state.displacement = free_values(built.model, {{built.model.at(0, uy), -0.01}, {built.model.at(1, uy), -0.03}}, {});
  state.opening = state.force = Vector::Zero(2);
  const BasePose pose = InterfaceViewer(built.model, 1e-9, built.plan.bases).pose(state, 0, {});
  EXPECT_NEAR(pose.settlement, 0.02, 1e-15);
  EXPECT_NEAR(pose.tilt_1, -0.02 / 4, 1e-15);  // clockwise: the right side goes down
}

/// Codes: the moment of the weight about the toe over that of all that turns about it, constant loads included. W = 34 t x g = 333.54 kN
/// on 3 m; at 5 m 40 kN push all the time and up to 10 kN more: 500.31/(200 + 50) = 2.001. The same with a mast that a spring holds as
/// well: the base does not bear the loads alone, and the push counts as at rest, with a warning.
TEST(VerdictNumbers, ConstantPushOverturns) {
  const auto text = [](const std::string& more) {
    return "title = \"tower\"\n" + Tower().text() + weight +
           "[[interface]]\nname = \"soil\"\nfooting = { body = \"base\", width = 3, points = 41 }\n"
           "law = { type = \"springs\", K_n = 1e9, K_t = 1e8 }\n[[function]]\nname = \"slow\"\nshape = { type = \"ramp\", duration = 9 }\n"
           "[[load]]\nnode = \"top\"\nforce = [4e4, 0]\n[[load]]\nnode = \"top\"\nforce = [1e4, 0]\nfunction = \"slow\"\n"
           "[damping]\nalpha = 2\n[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\nduration = 10\nstep = 0.01\n" +
           more;
  };
  const BuiltCase built = built_of(text(""));
  const RunResult run = run_of(built);
  ASSERT_EQ(to_string(run.status), "completed") << run.reason;
  const VerdictNumbers numbers = numbers_of(built, run, nullptr);
  EXPECT_NEAR(number(numbers, "min_overturning_safety"), 34e3 * 9.81 * 1.5 / 250e3, 0.02);
  EXPECT_EQ(numbers.interfaces.front().counted_as_weight, 0);
  // without a static stage one base bears them, too: 500.31 kN m hold, and only what the ramp adds to nothing pushes at first
  BuiltCase at_once = built_of(std::regex_replace(text(""), std::regex(R"(\[\[stage\]\]\ntype = "static"\n)"), ""));
  const RunResult struck = run_of(at_once);
  const BaseOverTime base(at_once, struck, 0);
  EXPECT_TRUE(struck.steps.rest.empty());
  EXPECT_NEAR(base.stabilises.force, 34e3 * 9.81, 1e-6);
  EXPECT_NEAR(base.stabilises.first[0], 0, 1e-6);
  EXPECT_EQ(base.counted_as_weight, 0);
  const BuiltCase held = built_of(text("[[spring]]\nname = \"stay\"\nnodes = [\"top\"]\ndirection = [1, 0]\nstiffness = 1e7\n"));
  const VerdictNumbers shared = numbers_of(held, run_of(held), nullptr);
  EXPECT_NEAR(shared.interfaces.front().counted_as_weight, 200e3, 1);
  const std::vector<std::string> said = edge_warnings(held, shared);
  EXPECT_TRUE(std::ranges::any_of(said, [](const std::string& each) {
    return each.find("counts the moment of constant loads other than the weight, 200 kN m") != each.npos;
  }));
}

/// Loads that act downwards stabilise with their arm, 1000 kN in the middle and 200 kN at 0.5 m, less the water's 3 x 100 kN in the joint;
/// their horizontal part at 1 m, 50 kN m, and moments do not.
TEST(VerdictNumbers, WhatStabilises) {
  const BuiltCase built = built_of(
      "title = \"wet\"\n[nodes]\nbase = [0, 0]\nside = [0.5, 1]\n[[rigid]]\nname = \"footing\"\nnode = \"base\"\nslaves = [\"side\"]\nmass "
      "= 1e4\n"
      "inertia = 7500\n[[interface]]\nname = \"soil\"\nfooting = { body = \"base\", width = 3, points = 41 }\nwater = { head = 10, "
      "unit_weight = 1e4 }\n"
      "law = { type = \"springs\", K_n = 2e8, K_t = 1e8 }\n[[load]]\nnode = \"base\"\nforce = [2e5, -1e6]\nmoment = -3e5\n"
      "[[load]]\nnode = \"side\"\nforce = [5e4, -2e5]\n"
      "[[stage]]\ntype = \"static\"\n");
  ASSERT_EQ(built.constant_loads.size(), 1u);
  const ConstantLoads& loads = built.constant_loads.front();
  EXPECT_NEAR(loads.weight.force, 1.2e6 - 3e5, 1e-6);
  EXPECT_NEAR(loads.weight.first[0], 2e5 * 0.5, 1e-6);
  EXPECT_NEAR(loads.all.first[0], 2e5 * 0.5 + 5e4 * 1 + 3e5, 1e-6);
  EXPECT_NEAR(loads.lateral(), 3.5e5, 1e-6);
}

}  // namespace
}  // namespace uplift::numbers_test
#include <regex>
