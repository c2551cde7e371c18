// Static stages: every load step is recorded, prescribed motions rise with the loads, limits are observed, and a failure keeps what was
// reached.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "ran_support.h"
#include "text_support.h"
#include "uplift/io/results/histories.h"
#include "uplift/io/text/toml.h"
#include "uplift/verdict/verdict.h"

namespace uplift::static_stages_test {
namespace {

struct Ran : support::Ran {
  /// Column of the load steps of a case with static stages alone, or of those before dynamic ones.
  const std::vector<double>& load_steps(const std::string& name) const {
    const auto& table = result.load_steps.empty() ? result.table : result.load_steps;
    return table.at(name.empty() ? 0 : column(name));
  }

 private:
  std::size_t column(const std::string& name) const {
    for (std::size_t k = 0; k < built.plan.requests.size(); ++k)
      if (built.plan.requests[k].name == name) return k + 1;
    ADD_FAILURE() << "no column " << name;
    return 0;
  }
};

Ran run_text(const std::string& text) {
  return {support::run_text(text)};
}

constexpr const char* ten_steps = "[[stage]]\ntype = \"static\"\nsteps = 10\n";
constexpr const char* dynamics = "[[stage]]\ntype = \"dynamic\"\nduration = 0.1\nstep = 1e-3\n";

std::string history(const std::string& of, const std::string& quantity, const std::string& name) {
  return "[[output.history]]\n" + of + "\nquantity = \"" + quantity + "\"\nname = \"" + name + "\"\n";
}

void expect_shares(const std::vector<double>& found, const std::vector<double>& factors, double full, double tolerance = 1e-9) {
  ASSERT_EQ(found.size(), factors.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i], factors[i] * full, tolerance * std::abs(full) + 1e-15) << "at the load factor " << factors[i];
}

// ---- rows ----

// a rigid strip, B = 4 m, 2 m out of the plane, on springs; W = 800 kN at e from the middle
std::string strip(double e, const std::string& mass = "mass = 100\ninertia = 100\n") {
  return "title = \"strip\"\n[nodes]\nbody = [0, 0]\n[[rigid]]\nname = \"strip\"\nnode = \"body\"\n" + mass +
         "[[interface]]\nname = \"soil\"\nfooting = { body = \"body\", width = 4, thickness = 2, points = 400, rule = \"midpoint\" }\n"
         "law = { type = \"springs\", K_n = 5e7, K_t = 1e7, tangential = \"bonded\" }\n"
         "[[load]]\nnode = \"body\"\nforce = [0, -8e5]\nmoment = " +
         std::to_string(-8e5 * e) + "\n" + history("interface = \"soil\"", "rotation", "turn") +
         history("interface = \"soil\"", "axial", "axial") + history("node = \"body\"", "uy", "uy");
}

TEST(StaticStages, EveryLoadStepIsARow) {
  // W at e = 0.5 m, inside the kern of B/6: settlement W/(K A) and rotation W e/(K I); at e = 1 m the pressure is a triangle over
  // c = 3 (B/2 - e), the rotation 2 W/(K t c^2). All are proportional to the load.
  const double weight = 8e5, stiffness = 5e7, width = 4, depth = 2;
  for (const double e : {0.0, 0.5, 1.0}) {
    const Ran ran = run_text(strip(e) + ten_steps);
    ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
    const std::vector<double>& factors = ran.load_steps("");
    ASSERT_EQ(factors.size(), 11u);
    for (std::size_t i = 0; i < factors.size(); ++i) EXPECT_NEAR(factors[i], 0.1 * static_cast<double>(i), 1e-12);
    const double pressed = 3 * (width / 2 - e);
    const double rotation = e > width / 6 ? 2 * weight / (stiffness * depth * pressed * pressed)
                                          : 12 * weight * e / (stiffness * depth * width * width * width);
    expect_shares(ran.load_steps("turn"), factors, -rotation, 1e-3);  // 400 points for the triangle
    expect_shares(ran.load_steps("axial"), factors, -weight);
    if (e < width / 6) expect_shares(ran.load_steps("uy"), factors, -weight / (stiffness * width * depth));
    EXPECT_EQ(ran.result.counts.load_steps, 10);
    EXPECT_EQ(ran.result.equilibrium.warning(), "");
    EXPECT_TRUE(ran.result.load_steps.empty());
    EXPECT_TRUE(histories_csv(ran.result, load_factor_column).starts_with("load_factor [1],body.ux [m],"));
  }
}

TEST(StaticStages, BesideADynamicStageTheLoadStepsHaveATableOfTheirOwn) {
  const Ran ran = run_text(strip(0) + ten_steps + dynamics);
  ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
  EXPECT_EQ(ran.result.load_steps.front().size(), 11u);
  expect_shares(ran.load_steps("axial"), ran.load_steps(""), -8e5);
  ASSERT_EQ(ran["axial"].size(), 101u);  // from t = 0 on, as without load steps
  for (const double axial : ran["axial"]) EXPECT_NEAR(axial, -8e5, 1e-3);
  const std::string csv = load_steps_csv(ran.result, ran.built.plan.requests);
  EXPECT_EQ(std::ranges::count(csv, '\n'), 12);
}

TEST(StaticStages, AGapClosesOnTheWay) {
  // P = 1 MN on K1 = 1e8 N/m; after 4 mm a joint of K2 = 5e8 N/m helps: u = P/K1, then (P + K2 g)/(K1 + K2)
  const double first = 1e8, second = 5e8, gap = 4e-3, load = 1e6;
  const Ran ran = run_text(
      "title = \"gap\"\n[nodes]\nmass = [0, 0]\n[[mass]]\nnode = \"mass\"\nmass = 1\n[[support]]\nnode = \"mass\"\nfixed = [\"ux\"]\n"
      "[[spring]]\nnodes = [\"mass\"]\nstiffness = 1e8\ndirection = [0, 1]\n[[interface]]\nname = \"stop\"\n"
      "pairs = { upper = [\"mass\"], area = 1, normal = [0, 1] }\ngap = 4e-3\nlaw = { type = \"springs\", K_n = 5e8, tangential = \"none\" "
      "}\n[[load]]\nnode = \"mass\"\nforce = [0, -1e6]\n" +
      history("node = \"mass\"", "uy", "uy") + ten_steps);
  ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
  const std::vector<double>&factors = ran.load_steps(""), &moved = ran.load_steps("uy");
  for (std::size_t i = 0; i < factors.size(); ++i) {
    const double force = factors[i] * load, free = force / first;
    EXPECT_NEAR(moved[i], -(free < gap ? free : (force + second * gap) / (first + second)), 1e-12) << factors[i];
  }
}

TEST(StaticStages, ASecondStageDoesNotUnload) {
  const Ran ran = run_text(strip(1) + ten_steps + ten_steps);
  ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
  const std::vector<double>&factors = ran.load_steps(""), &turn = ran.load_steps("turn");
  ASSERT_EQ(factors.size(), 21u);
  EXPECT_DOUBLE_EQ(factors.back(), 2);
  for (std::size_t i = 10; i < turn.size(); ++i) EXPECT_NEAR(turn[i], turn[10], 1e-9 * std::abs(turn[10]));
}

// ---- prescribed motions ----

// a beam of 6 m, clamped at both ends, whose right end settles by 12 mm
const std::string settled_beam =
    "title = \"beam\"\n[nodes]\nleft = [0, 0]\nmiddle = [3, 0]\nright = [6, 0]\n"
    "[[beam]]\nname = \"first\"\nnodes = [\"left\", \"middle\"]\nE = 3e10\nI = 0.002\nA = 0.2\ndensity = 2500\n"
    "[[beam]]\nname = \"second\"\nnodes = [\"middle\", \"right\"]\nE = 3e10\nI = 0.002\nA = 0.2\ndensity = 2500\n"
    "[[support]]\nnode = \"left\"\nfixed = [\"ux\", \"uy\", \"rz\"]\n[[support]]\nnode = \"right\"\nfixed = [\"ux\", \"rz\"]\n"
    "[[motion]]\nnode = \"right\"\ndirection = \"uy\"\namplitude = -12e-3\n" +
    history("node = \"right\"", "uy", "settlement") + history("node = \"middle\"", "uy", "middle") +
    history("node = \"left\"", "reaction_y", "force") + history("node = \"left\"", "reaction_moment", "moment") +
    history("beam = \"second\"\nposition = 3", "moment", "end_moment");

TEST(StaticStages, ASupportSettlesWithTheLoadFactor) {
  // slope-deflection: V = 12 E I d/L^3, M = 6 E I d/L^2
  const double rigidity = 3e10 * 0.002, settlement = 12e-3, length = 6;
  const Ran ran = run_text(settled_beam + ten_steps + dynamics);
  ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
  const std::vector<double>& factors = ran.load_steps("");
  expect_shares(ran.load_steps("settlement"), factors, -settlement);
  expect_shares(ran.load_steps("middle"), factors, -settlement / 2);
  expect_shares(ran.load_steps("force"), factors, 12 * rigidity * settlement / std::pow(length, 3));
  expect_shares(ran.load_steps("moment"), factors, 6 * rigidity * settlement / std::pow(length, 2));
  expect_shares(ran.load_steps("end_moment"), factors, ran.load_steps("end_moment").back());
  EXPECT_NEAR(std::abs(ran.load_steps("end_moment").back()), 6 * rigidity * settlement / std::pow(length, 2), 1);
  // nothing moves afterwards: the settlement does not come as a shock
  for (const double moved : ran["middle"]) EXPECT_NEAR(moved, -settlement / 2, 1e-9 * settlement);
  EXPECT_LE(ran.result.final_energy.kinetic, 1e-12 * ran.result.final_energy.strain);
  EXPECT_EQ(ran.result.equilibrium.warning(), "");
}

TEST(StaticStages, WithPDeltaTheSettlementStays) {
  const std::string text = support::replaced(settled_beam + ten_steps + dynamics, "step = 1e-3\n", "step = 1e-3\np_delta = true\n") +
                           "[[load]]\nnode = \"middle\"\nforce = [2e6, 0]\n";
  const Ran ran = run_text(text);
  ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
  const std::vector<double>& middle = ran["middle"];
  for (const double moved : middle) EXPECT_NEAR(moved, middle.front(), 1e-9);
}

TEST(StaticStages, AMotionOpensOrPressesAJoint) {
  // the ground below a spring-held body heaves by 3 mm through a joint: both springs share it, F = d K1 K2/(K1 + K2)
  const double first = 2e8, second = 3e8, heave = 3e-3;
  const Ran ran = run_text(
      "title = \"heave\"\n[nodes]\nbody = [0, 1]\nground = [0, 0]\n[[mass]]\nnode = \"body\"\nmass = 10\n"
      "[[support]]\nnode = \"body\"\nfixed = [\"ux\"]\n[[support]]\nnode = \"ground\"\nfixed = [\"ux\"]\n"
      "[[spring]]\nnodes = [\"body\"]\nstiffness = 2e8\ndirection = [0, 1]\n"
      "[[interface]]\nname = \"joint\"\npairs = { upper = [\"body\"], lower = [\"ground\"], area = 1, normal = [0, 1] }\n"
      "law = { type = \"springs\", K_n = 3e8, tangential = \"none\" }\n"
      "[[motion]]\nnode = \"ground\"\ndirection = \"uy\"\namplitude = 3e-3\n" +
      history("node = \"body\"", "uy", "uy") + history("interface = \"joint\"", "axial", "axial") + ten_steps + dynamics);
  ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
  const double force = heave * first * second / (first + second);
  expect_shares(ran.load_steps("axial"), ran.load_steps(""), -force);
  expect_shares(ran.load_steps("uy"), ran.load_steps(""), force / first);
  for (const double moved : ran["uy"]) EXPECT_NEAR(moved, force / first, 1e-9 * heave);
}

TEST(StaticStages, AYieldingSpecimenIsPressedByItsSupports) {
  // Plane strain compression: elastic up to 0.6 of the strength; far beyond it the reaction is the strength of Mohr and Coulomb,
  // 2 c cos(phi)/(1 - sin(phi)), once the stress out of the plane has followed.
  const double phi = std::numbers::pi / 6, strength = 2 * 5e3 * std::cos(phi) / (1 - std::sin(phi));
  const double elastic = 5e7 / (1 - 0.3 * 0.3), settlement = 6 * strength / elastic;
  const Ran ran = run_text(
      "title = \"specimen\"\n[mesh.soil_box.soil]\nwidth = 1\nsize = 0.5\n[[mesh.soil_box.soil.layers]]\nthickness = 1\nsize = 0.5\n"
      "[[solid]]\ngroup = \"soil_1\"\nE = 5e7\npoisson = 0.3\ndensity = 1900\nplasticity = { type = \"drucker_prager\", "
      "cohesion = \"5 kPa\", friction_angle = \"30 deg\", dilatancy_angle = \"30 deg\", fit = \"plane_strain\" }\n"
      "[[support]]\ngroup = \"soil_bottom\"\nfixed = [\"uy\"]\n[[support]]\ngroup = \"soil_left\"\nfixed = [\"ux\"]\n"
      "[[motion]]\ngroup = \"soil_top\"\ndirection = \"uy\"\namplitude = " +
      fmt::format("{}", -settlement) + "\n" + history("group = \"soil_bottom\"", "reaction_y", "force") + ten_steps);
  ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
  const std::vector<double>& force = ran.load_steps("force");
  EXPECT_NEAR(force[1], 0.1 * settlement * elastic, 1e-9 * strength);
  for (std::size_t i = 2; i < force.size(); ++i) EXPECT_LE(force[i], (1 + 1e-9) * strength);
  EXPECT_NEAR(force.back(), strength, 1e-5 * strength);
}

TEST(StaticStages, AMotionWithoutAFunctionNeedsAStaticStage) {
  const std::string refusal = support::refusal_of([] { run_text(settled_beam + dynamics); });
  EXPECT_NE(refusal.find("a static stage first"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("case.toml:"), std::string::npos) << refusal;
}

// ---- limits and failures ----

TEST(StaticStages, TheLimitOfRotationEndsAStaticStage) {
  // the rotation is proportional to the load: 0.55 of its end is passed at 60 %
  const double rotation = 12 * 8e5 * 0.5 / (5e7 * 2 * 64);
  const std::string limit = "[limits]\nrotation = " + std::to_string(0.55 * rotation) + "\n";
  for (const char* stages : {ten_steps, "[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\nduration = 0.1\nstep = 1e-3\n"}) {
    const Ran ran = run_text(strip(0.5) + limit + stages);
    EXPECT_EQ(ran.result.status, RunStatus::overturned);
    EXPECT_NE(ran.result.reason.find("at 60 % of the static load"), std::string::npos) << ran.result.reason;
    EXPECT_NEAR(ran.load_steps("").back(), 0.6, 1e-12);
    EXPECT_EQ(ran.result.counts.steps, 0);
    const Verdict verdict = judge(ran.built, ran.result, nullptr);
    EXPECT_EQ(verdict.level, Verdict::Level::overturned);
    EXPECT_NE(verdict.headline.find("under the static loads"), std::string::npos) << verdict.headline;
  }
}

TEST(StaticStages, AFailedStageKeepsWhatItReached) {
  // the base slides where H = mu W + c A
  const double weight = 8e5, push = 6e5, friction = 0.4, cohesion = 2e4, area = 8;
  const double limit = cohesion * area / (push - friction * weight);
  const std::string block = support::replaced(support::replaced(strip(0), "force = [0, -8e5]", "force = [6e5, -8e5]"),
                                              "tangential = \"bonded\"", "tangential = \"coulomb\", friction = 0.4, cohesion = 2e4");
  for (const std::string& stages : {std::string(ten_steps), std::string(ten_steps) + dynamics}) {
    const Ran ran = run_text(block + history("node = \"body\"", "ux", "ux") + stages);
    EXPECT_EQ(ran.result.status, RunStatus::failed);
    EXPECT_NE(ran.result.reason.find("slides"), std::string::npos) << ran.result.reason;
    const std::size_t at = ran.result.reason.find("(equilibrium up to ");
    ASSERT_NE(at, std::string::npos) << ran.result.reason;
    const double reached = std::stod(ran.result.reason.substr(at + 19)) / 100;
    EXPECT_LE(reached, limit + 1e-4);
    EXPECT_GE(reached, limit - 0.1 / 256 - 1e-4);  // a step halved eight times
    const std::vector<double>&factors = ran.load_steps(""), &slip = ran.load_steps("ux");
    EXPECT_NEAR(factors.back(), reached, 1e-4);
    for (std::size_t i = 0; i < factors.size(); ++i) EXPECT_NEAR(slip[i], factors[i] * push / (1e7 * area), 1e-9) << factors[i];
    EXPECT_EQ(judge(ran.built, ran.result, nullptr).level, Verdict::Level::failed);
  }
}

TEST(StaticStages, TheObserverSeesTheLastEquilibrium) {
  const std::string text = support::replaced(support::replaced(strip(0), "force = [0, -8e5]", "force = [6e5, -8e5]"),
                                             "tangential = \"bonded\"", "tangential = \"coulomb\", friction = 0.4, cohesion = 2e4");
  const Case file = check_case(read_toml_text(text + ten_steps + dynamics, "case.toml"), "case.toml");
  const BuiltCase built = build(file, runs_of_case(file).front());
  double factor = 0, moved = 0;
  const Observe observe = [&](const Snapshot& snapshot) { factor = snapshot.state.load_factor, moved = snapshot.state.displacement[0]; };
  const RunResult result = run(built.model, built.plan, built.behaviours, {}, observe);
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_NEAR(factor, result.load_steps.front().back(), 1e-12);
  EXPECT_NEAR(moved, factor * 6e5 / (1e7 * 8), 1e-9);
}

// ---- nothing to bear ----

TEST(StaticStages, AStageWithoutLoadsIsInEquilibrium) {
  const std::string unloaded = support::replaced(strip(0), "[[load]]\nnode = \"body\"\nforce = [0, -8e5]\nmoment = -0.000000\n", "");
  const std::string springs = "law = { type = \"springs\", K_n = 5e7, K_t = 1e7, tangential = \"bonded\" }\n";
  for (const char* law : {"{ type = \"springs\", K_n = 5e7, tangential = \"coulomb\", friction = 0.3 }", "{ type = \"unilateral\" }",
                          "{ type = \"coulomb\", friction = 0.3 }", "{ type = \"elastic\", K_n = 5e7 }"})
    for (const char* method : {"newton", "lagrange", "augmented_lagrangian"}) {
      const bool cone = std::string(law).find("K_n") == std::string::npos;
      if (cone != (std::string(method) != "newton")) continue;
      SCOPED_TRACE(std::string(law) + ", " + method);
      std::string text = support::replaced(unloaded, springs, "law = " + std::string(law) + "\n");
      text = support::replaced(text, "[[interface]]", "[[support]]\nnode = \"body\"\nfixed = [\"ux\"]\n[[interface]]");
      text += "[[stage]]\ntype = \"static\"\n";
      const Ran ran = run_text(support::replaced(text, "[nodes]", "method = \"" + std::string(method) + "\"\n[nodes]"));
      ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
      for (const double moved : ran.load_steps("uy")) EXPECT_EQ(moved, 0);
    }
}

TEST(StaticStages, AfterAFreeVibrationNothingIsLeft) {
  // no load at any time: the static stage takes back what the initial displacement left
  const std::string text =
      "title = \"mast\"\n[nodes]\nfoot = [0, 0]\ntop = [0, 5]\n[[beam]]\nname = \"mast\"\nnodes = [\"foot\", \"top\"]\nE = 3e10\nI = 0.01\n"
      "A = 0.1\n[[mass]]\nnode = \"top\"\nmass = 1000\n[[support]]\nnode = \"foot\"\nfixed = [\"ux\", \"uy\", \"rz\"]\n"
      "[[initial]]\nnode = \"top\"\ndisplacement = [0.01, 0]\n" +
      history("node = \"top\"", "ux", "ux") + dynamics + ten_steps;
  const Ran ran = run_text(text);
  ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
  const std::vector<double>& moved = ran.load_steps("ux");
  const double left = ran["ux"].back();
  EXPECT_GT(std::abs(left), 1e-5);
  ASSERT_EQ(moved.size(), 10u);
  for (std::size_t i = 0; i < moved.size(); ++i) EXPECT_NEAR(moved[i], (1 - ran.load_steps("")[i]) * left, 1e-12);
}

}  // namespace
}  // namespace uplift::static_stages_test
