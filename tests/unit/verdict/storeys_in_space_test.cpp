// Storeys in space: the largest along both axes and the largest length of the vector, which coincide only where the axes peak together. A
// column with a guided head and a mass there, of equal stiffness along both axes, swings freely: in a circle (the axes 90 degrees out
// of phase) the length never changes and both axes reach it; at 45 degrees, in phase, it is sqrt(2) times that of the axes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "ran_support.h"
#include "uplift/verdict/verdict.h"

namespace uplift::storeys_in_space_test {
namespace {

using support::Ran;
using support::run_text;

constexpr double height = 6, mass = 2e4, young = 3e10, second_moment = 1e-3;           // m, kg, Pa, m4
constexpr double stiffness = 12 * young * second_moment / (height * height * height);  // of the head [N/m]
constexpr double amplitude = 0.01;                                                     // m
const double frequency = std::sqrt(stiffness / mass);                                  // rad/s

/// `displacement` and `velocity` of the top along x and y.
std::string stick(double ux, double uy, double vx, double vy, const std::string& output) {
  const double step = 2 * std::numbers::pi / frequency / 200;
  return fmt::format(
      "title = \"stick\"\nbonded = false\n[nodes]\nfoot = [0, 0, 0]\ntop = [0, 0, {}]\n"
      "[[beam]]\nname = \"column\"\nnodes = [\"foot\", \"top\"]\nE = {}\nA = 1\nI_y = {}\nI_z = {}\nJ = 1e-3\npoisson = 0.2\n"
      "[[mass]]\nnode = \"top\"\nmass = {}\n"
      "[[support]]\nnode = \"foot\"\nfixed = [\"ux\", \"uy\", \"uz\", \"rx\", \"ry\", \"rz\"]\n"
      "[[support]]\nnode = \"top\"\nfixed = [\"rx\", \"ry\", \"rz\"]\n"
      "[[initial]]\nnode = \"top\"\ndisplacement = [{}, {}, 0]\nvelocity = [{}, {}, 0]\n"
      "[[stage]]\ntype = \"dynamic\"\nduration = {}\nstep = {}\n[output]\nevery = 50\n{}",
      height, young, second_moment, second_moment, mass, ux, uy, vx, vy, 400 * step, step, output);
}

std::string shears(const std::string& axes) {
  std::string text;
  for (const int level : {1, 4})
    for (const char axis : axes) text += fmt::format("[[output.history]]\nlevel = {}\nquantity = \"storey_shear_{}\"\n", level, axis);
  return text;
}

std::string drifts() {
  std::string text;
  for (const char axis : {'x', 'y'})
    text += fmt::format("[[output.history]]\nnode = \"top\"\nbelow = \"foot\"\nquantity = \"drift_ratio_{}\"\n", axis);
  return text;
}

double number(const std::vector<VerdictNumber>& numbers, QuantityName name) {
  const VerdictNumber* found = find_number(numbers, name);
  return found == nullptr ? std::nan("") : found->value;
}

/// Both levels carry the force of the one mass.
void expect_numbers(const Ran& ran, double axis, double length) {
  ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
  const VerdictNumbers numbers = numbers_of(ran.built, ran.result, nullptr);
  ASSERT_EQ(numbers.storeys.size(), 3u);
  EXPECT_EQ(numbers.storeys[0].name, "level 1 m");
  EXPECT_EQ(numbers.storeys[1].name, "level 4 m");
  EXPECT_EQ(numbers.storeys[2].name, "top over foot");
  const double force = stiffness * amplitude, tolerance = 1e-3;
  for (const std::vector<VerdictNumber>* list : {&numbers.storeys[0].numbers, &numbers.storeys[1].numbers, &numbers.whole}) {
    EXPECT_NEAR(number(*list, "max_storey_shear_x") / force, axis, tolerance);
    EXPECT_NEAR(number(*list, "max_storey_shear_y") / force, axis, tolerance);
    EXPECT_NEAR(number(*list, "max_storey_shear") / force, length, tolerance);
  }
  const double ratio = amplitude / height;
  for (const std::vector<VerdictNumber>* list : {&numbers.storeys[2].numbers, &numbers.whole}) {
    EXPECT_NEAR(number(*list, "max_drift_ratio_x") / ratio, axis, tolerance);
    EXPECT_NEAR(number(*list, "max_drift_ratio_y") / ratio, axis, tolerance);
    EXPECT_NEAR(number(*list, "max_drift_ratio") / ratio, length, tolerance);
  }
}

TEST(StoreysInSpace, InACircleTheAxesReachTheLength) {
  expect_numbers(run_text(stick(amplitude, 0, 0, amplitude * frequency, shears("xy") + drifts())), 1, 1);
}

TEST(StoreysInSpace, InPhaseTheLengthIsLonger) {
  const Ran ran = run_text(stick(amplitude, amplitude, 0, 0, shears("xy") + drifts()));
  expect_numbers(ran, 1, std::numbers::sqrt2);
  const Verdict verdict = judge(ran.built, ran.result, nullptr);
  const auto told = [&](const char* label) {
    const auto found = std::ranges::find(verdict.facts, label, &Verdict::Fact::label);
    return found == verdict.facts.end() ? "" : found->value;
  };
  EXPECT_EQ(told("Storey shear"), "23.6 kN");  // sqrt(2) 12 E I/h^3 a = 23.57 kN
  EXPECT_EQ(told("Drift ratio"), "0.00236");   // sqrt(2) a/h = 0.002357
}

TEST(StoreysInSpace, RecordedTwiceIsListedOnce) {
  const std::string again = "[[output.history]]\nname = \"again\"\nlevel = 1\nquantity = \"storey_shear_x\"\n";
  const Ran ran = run_text(stick(amplitude, amplitude, 0, 0, shears("xy") + again));
  EXPECT_EQ(numbers_of(ran.built, ran.result, nullptr).storeys.size(), 2U);
}

TEST(StoreysInSpace, OneAxisAloneIsNoVector) {
  const Ran ran = run_text(stick(amplitude, amplitude, 0, 0, shears("x")));
  const VerdictNumbers numbers = numbers_of(ran.built, ran.result, nullptr);
  EXPECT_TRUE(numbers.storeys.empty());
  EXPECT_NEAR(number(numbers.whole, "max_storey_shear") / (stiffness * amplitude), 1, 1e-3);
  EXPECT_EQ(find_number(numbers.whole, "max_storey_shear_y"), nullptr);
}

}  // namespace
}  // namespace uplift::storeys_in_space_test
