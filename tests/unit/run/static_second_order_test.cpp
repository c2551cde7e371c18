// Static stages of second order (p_delta = true) against closed forms.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "ran_support.h"
#include "text_support.h"

namespace uplift::static_second_order_test {
namespace {

constexpr double height = 5, young = 3e10, inertia = 0.02;  // m, Pa, m4

std::string history(const std::string& of, const std::string& quantity, const std::string& name) {
  return "[[output.history]]\n" + of + "\nquantity = \"" + quantity + "\"\nname = \"" + name + "\"\n";
}

/// A cantilever under an axial load (compression > 0) and a load across its top.
std::string cantilever(double axial, double across, const std::string& stages) {
  return "title = \"cantilever\"\nbonded = false\n[nodes]\nbase = [0, 0]\ntop = [0, 5]\n"
         "[[beam]]\nname = \"column\"\nnodes = [\"base\", \"top\"]\nE = 3e10\nI = 0.02\nA = 0.5\ndensity = 2500\nmass = \"consistent\"\n"
         "elements = 8\n[[support]]\nnode = \"base\"\nfixed = [\"ux\", \"uy\", \"rz\"]\n" +
         fmt::format("[[load]]\nnode = \"top\"\nforce = [{}, {}]\n", across, -axial) + history("node = \"top\"", "ux", "ux") +
         history("beam = \"column\"\nposition = 0", "moment", "moment") + stages;
}

constexpr const char* second_order = "[[stage]]\ntype = \"static\"\nsteps = 2\np_delta = true\n";
constexpr const char* first_order = "[[stage]]\ntype = \"static\"\nsteps = 2\n";

TEST(StaticSecondOrder, ACantileverUnderAnAxialLoadDeflectsAsTheBeamColumn) {
  const double critical = std::pow(std::acos(-1) / (2 * height), 2) * young * inertia, across = 1e4;
  for (const double share : {0.1, 0.5, 0.9}) {
    const double axial = share * critical, k = std::sqrt(axial / (young * inertia));
    const double deflection = across * (std::tan(k * height) - k * height) / (k * axial), moment = across * std::tan(k * height) / k;
    const support::Ran ran = support::run_text(cantilever(axial, across, second_order));
    ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
    EXPECT_NEAR(ran["ux"].back(), deflection, 1e-4 * deflection) << share;  // eight elements with cubic shapes
    EXPECT_NEAR(std::abs(ran["moment"].back()), moment, 1e-4 * moment) << share;
    // the load steps before are of first order; one row more is of second order
    ASSERT_EQ(ran["ux"].size(), 4u);
    EXPECT_NEAR(ran["ux"][2], across * std::pow(height, 3) / (3 * young * inertia), 1e-9 * deflection);
    EXPECT_EQ(ran.result.table[0][2], 1);
    EXPECT_EQ(ran.result.table[0][3], 1);
    EXPECT_LE(std::abs(ran.result.final_energy.residual), 1e-9 * ran.result.final_energy.external);
  }
}

TEST(StaticSecondOrder, TensionStiffens) {
  const double axial = 3e6, across = 1e4, k = std::sqrt(axial / (young * inertia));
  const double deflection = across * (k * height - std::tanh(k * height)) / (k * axial);
  const support::Ran ran = support::run_text(cantilever(-axial, across, second_order));
  ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
  EXPECT_NEAR(ran["ux"].back(), deflection, 1e-4 * deflection);
}

TEST(StaticSecondOrder, BeyondTheCriticalLoadItBuckles) {
  const double critical = std::pow(std::acos(-1) / (2 * height), 2) * young * inertia;
  const support::Ran ran = support::run_text(cantilever(1.05 * critical, 1e4, second_order));
  EXPECT_EQ(ran.result.status, RunStatus::failed);
  EXPECT_NE(ran.result.reason.find("buckles under"), std::string::npos) << ran.result.reason;
}

/// A rigid block on springs, W at the height h above its base, pushed at the top: theta = H h/(K_n I - W h) while all points press.
std::string block(const std::string& stages) {
  return "title = \"block\"\nbonded = false\n[nodes]\nbase = [0, 0]\ntop = [0, 6]\n[[rigid]]\nname = \"block\"\nnode = \"base\"\nslaves = "
         "[\"top\"]\n"
         "[[mass]]\nnode = \"top\"\nmass = 1e5\ninertia = 1e5\n[[interface]]\nname = \"soil\"\n"
         "footing = { body = \"base\", width = 4, points = 400, rule = \"midpoint\" }\n"
         "law = { type = \"springs\", K_n = 2e7, K_t = 1e8, tangential = \"bonded\" }\n"
         "[gravity]\nacceleration = [0, -9.81]\n[[load]]\nnode = \"top\"\nforce = [3e4, 0]\n" +
         history("node = \"base\"", "rz", "rz") + history("interface = \"soil\"", "moment", "moment") + stages;
}

TEST(StaticSecondOrder, ARockingBodyOnSpringsLosesTheWeightTimesItsHeight) {
  const double n = 400, weight = 9.81e5, lever = 6, stiffness = 2e7 * 4 * 4 * 4 / 12.0 * (1 - 1 / (n * n)), push = 3e4;  // midpoint sum
  const support::Ran ran = support::run_text(block(second_order));
  ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
  const double turned = push * lever / (stiffness - weight * lever);
  EXPECT_NEAR(std::abs(ran["rz"].back()), turned, 1e-6 * turned);
  EXPECT_NEAR(std::abs(ran["rz"][2]), push * lever / stiffness, 1e-6 * turned);
  EXPECT_NEAR(std::abs(ran["moment"].back()), stiffness * turned, 1e-6 * stiffness * turned);
}

TEST(StaticSecondOrder, ADynamicStageGoesOnFromTheSameEquilibrium) {
  const std::string shaken = "[[stage]]\ntype = \"dynamic\"\nduration = 0.1\nstep = 0.01\np_delta = true\n";
  for (const std::string& text : {cantilever(1e7, 1e4, ""), block("")}) {
    const support::Ran stated = support::run_text(text + second_order + shaken), implied = support::run_text(text + first_order + shaken);
    ASSERT_EQ(stated.result.status, RunStatus::completed) << stated.result.reason;
    const std::string name = stated.result.columns.front().name;
    const double size = std::abs(stated[name].front());
    for (std::size_t i = 0; i < stated.rows(); ++i) {
      EXPECT_NEAR(stated[name][i], stated[name][0], 1e-9 * size);  // nothing moves when nothing shakes
      EXPECT_NEAR(stated[name][i], implied[name][i], 1e-9 * size);
    }
    EXPECT_NEAR(stated.result.load_steps[1].back(), stated[name][0], 1e-9 * size);
  }
}

TEST(StaticSecondOrder, ALaterStageOfFirstOrderIsRefused) {
  for (const char* later : {first_order, "[[stage]]\ntype = \"dynamic\"\nduration = 0.1\nstep = 0.01\n"}) {
    const std::string refusal = support::refusal_of([&] { support::run_text(cantilever(1e6, 1e4, std::string(second_order) + later)); });
    EXPECT_NE(refusal.find("p_delta = true, as in the static stage before it"), std::string::npos) << refusal;
    EXPECT_NE(refusal.find("case.toml:"), std::string::npos) << refusal;
  }
  const support::Ran twice = support::run_text(cantilever(1e7, 1e4, std::string(second_order) + second_order));
  ASSERT_EQ(twice.result.status, RunStatus::completed) << twice.result.reason;
  EXPECT_NEAR(twice["ux"].back(), twice["ux"][3], 1e-9 * std::abs(twice["ux"][3]));
}

}  // namespace
}  // namespace uplift::static_second_order_test
