#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "ran_support.h"
#include "text_support.h"
#include "uplift/verdict/verdict.h"

// Several bases: the time in which the whole structure is in the air, and that of each base.
namespace uplift::bases_test {
namespace {

using support::Ran;
using support::run_text;

constexpr double g = 9.81, mass = 1000, stiffness = 2e8;  // m/s2, kg, N/m: 1e8 Pa/m under 2 m x 1 m
constexpr double speed[] = {1, 1.5};                      // m/s, upwards at t = 0, from springs without a force

std::string block(const std::string& name, double v) {
  return "[[rigid]]\nname = \"" + name + "\"\nnode = \"" + name + "\"\nmass = 1000\ninertia = 1000\n[[support]]\nnode = \"" + name +
         "\"\nfixed = [\"ux\", \"rz\"]\n[[interface]]\nname = \"under " + name + "\"\nfooting = { body = \"" + name +
         "\", width = 2, points = 5 }\nlaw = { type = \"springs\", K_n = 1e8, tangential = \"none\" }\n[[initial]]\nnode = \"" + name +
         "\"\nvelocity = [0, " + std::to_string(v) + "]\n";
}

/// Free flight of 2 v/g; then the springs hold the block for what is left of a period of m and k about the equilibrium m g/k:
/// x'' = -g - (k/m) x from x = 0 with -v back to x = 0 takes (pi + 2 atan(g/(omega v)))/omega.
double flight(double v) {
  return 2 * v / g;
}
double contact(double v) {
  const double omega = std::sqrt(stiffness / mass);
  return (std::numbers::pi + 2 * std::atan(g / (omega * v))) / omega;
}

// The slow block lands at 0.204 s while the fast one flies, that at 0.306 s while the slow one flies for the second time.
TEST(SeveralBases, TheTimeInTheAirIsThatOfAllAtOnce) {
  constexpr double end = 0.4, step = 1e-5;
  const Ran ran = run_text("title = \"two blocks\"\n[nodes]\nslow = [0, 0]\nfast = [5, 0]\n[gravity]\nacceleration = [0, -9.81]\n" +
                           block("slow", speed[0]) + block("fast", speed[1]) +
                           "[[stage]]\ntype = \"dynamic\"\nduration = 0.4\nstep = 1e-5\n[output]\nevery = 100\nframes = 0\n");
  ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
  const Verdict verdict = judge(ran.built, ran.result, nullptr);
  const double landings[] = {flight(speed[0]), flight(speed[1])};
  const Interval expected[] = {{0, landings[0]}, {landings[0] + contact(speed[0]), landings[1]}, {landings[1] + contact(speed[1]), end}};
  const std::vector<Interval>& found = verdict.numbers.full_loss;
  ASSERT_EQ(found.size(), 3U);
  double total = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found[i].from, expected[i].from, 2 * step) << i;
    EXPECT_NEAR(found[i].to, expected[i].to, 2 * step) << i;
    total += expected[i].to - expected[i].from;
  }
  const VerdictNumber* lost = find_number(verdict.numbers.whole, "full_loss_of_contact");
  ASSERT_NE(lost, nullptr);
  EXPECT_NEAR(lost->value, total, 6 * step);
  for (std::size_t k = 0; k < 2; ++k) {
    const VerdictNumber* alone = find_number(verdict.numbers.interfaces[k].numbers, "full_loss_time");
    ASSERT_NE(alone, nullptr);
    EXPECT_NEAR(alone->value, end - contact(speed[k]), 2 * step) << k;
  }
  // 0.4 s less two contacts of 7.1 ms; the highest gap is v^2/(2 g) = 0.1147 m
  EXPECT_TRUE(
      verdict.headline.starts_with("Full loss of contact: all bases at once have no contact for 0.386 s in total, the gap reaches 0.115 m"))
      << verdict.headline;
  const auto fact = [&](const std::string& label) {
    const auto at = std::ranges::find(verdict.facts, label, &Verdict::Fact::label);
    return at == verdict.facts.end() ? std::string("none") : at->value;
  };
  EXPECT_EQ(fact("No contact of all bases at once"), "0.386 s");
  EXPECT_EQ(fact("No contact of under slow"), "0.393 s");
  EXPECT_EQ(fact("No contact of under fast"), "0.393 s");
}

/// A mass on a column on a beam between two footings of different widths, under a sine of the ground.
std::string portal(bool other_order) {
  const auto foot = [](const std::string& name, double x, double width) {
    return "[[interface]]\nname = \"" + name + "\"\nfooting = { body = \"body\", width = " + std::to_string(width) +
           ", points = 11, offset = [" + std::to_string(x) +
           ", 0] }\nlaw = { type = \"springs\", K_n = 4e7, K_t = 2e7, tangential = \"bonded\" }\n";
  };
  const std::string left = foot("left", -4, 2), right = foot("right", 3, 3);
  return "title = \"portal\"\n[verdict]\nwindow = 0\n[nodes]\nbody = [0, 0]\ntop = [0, 8]\n[[beam]]\nname = \"column\"\nnodes = [\"body\", "
         "\"top\"]\nE = \"30 "
         "GPa\"\nA = 0.5\nI = "
         "0.05\n"
         "elements = 2\n[[mass]]\nnode = \"top\"\nmass = 6e4\ninertia = 1e4\n[[rigid]]\nname = \"raft\"\nnode = \"body\"\nmass = 4e4\n"
         "inertia = 3e5\n[gravity]\nacceleration = [0, -9.81]\n" +
         (other_order ? right + left : left + right) +
         "[[function]]\nname = \"sine\"\nshape = { type = \"harmonic\", frequency = \"1.5 Hz\" }\n[[ground_acceleration]]\n"
         "direction = [1, 0]\namplitude = 3\nfunction = \"sine\"\n[damping]\nrayleigh = [{ frequency = \"1 Hz\", ratio = 0.05 }, "
         "{ frequency = \"10 Hz\", ratio = 0.05 }]\n[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\nduration = 1.5\nstep = "
         "1e-3\n";
}

/// Sums over both bases from their histories, which are not averaged over the window of the verdict (0 here): the largest shear, and the
/// largest moment about the middle of the bases by area, x = (2 (-4) + 3 x 3)/5 = 0.2 m. A force N (tension > 0) at x has the moment -N x
/// here, like that of the structure on its own left side.
TEST(SeveralBases, ForcesOfTheWholeAreSums) {
  const Ran ran = run_text(portal(false)), swapped = run_text(portal(true));
  ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
  const Verdict verdict = judge(ran.built, ran.result, nullptr), other = judge(swapped.built, swapped.result, nullptr);
  double shear = 0, moment = 0;
  for (std::size_t i = 1; i < ran.rows(); ++i) {
    shear = std::max(shear, std::abs(ran["left.shear"][i] + ran["right.shear"][i]));
    moment = std::max(moment, std::abs(ran["left.moment"][i] + ran["right.moment"][i] + ran["left.axial"][i] * (-4 - 0.2) +
                                       ran["right.axial"][i] * (3 - 0.2)));
  }
  const auto whole = [](const Verdict& of, QuantityName name) { return find_number(of.numbers.whole, name); };
  EXPECT_NEAR(whole(verdict, "max_total_shear")->value, shear, 1e-9 * shear);
  EXPECT_NEAR(whole(verdict, "max_total_moment")->value, moment, 1e-9 * moment);
  for (const QuantityName name : {QuantityName("max_total_shear"), QuantityName("max_total_moment")})
    EXPECT_NEAR(whole(other, name)->value, whole(verdict, name)->value, 1e-9 * whole(verdict, name)->value);
  // each footing of a frame may turn by itself: no rotation of the base, and so no drift without it
  EXPECT_NE(whole(verdict, "max_drift"), nullptr);
  EXPECT_EQ(whole(verdict, "max_drift_without_rotation"), nullptr);
  const std::string refused = support::refusal_of([] {
    run_text(portal(false) + "[[verdict.criterion]]\nquantity = \"max_drift_without_rotation\"\nlimit = 0.07\nsource = \"test\"\n");
  });
  EXPECT_NE(refused.find("a structure on one base"), std::string::npos) << refused;
}

/// What the headline compares with the bonded model is the same in any order.
TEST(SeveralBases, TheHeadlineDoesNotDependOnTheirOrder) {
  const auto said = [](bool other_order) {
    const Ran ran = run_text(portal(other_order)), bonded = run_text(portal(other_order), 1);
    return judge(ran.built, ran.result, &bonded.result).consequence;
  };
  EXPECT_TRUE(said(false).starts_with("Compared with the bonded model: moment of all bases ")) << said(false);
  EXPECT_NE(said(false).find("shear of all bases"), std::string::npos) << said(false);
  EXPECT_EQ(said(false), said(true));
}

}  // namespace
}  // namespace uplift::bases_test
