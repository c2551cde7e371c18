#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "unit/motion/target_support.h"

namespace uplift::target_test {
namespace {

using std::numbers::pi;

constexpr double g = 9.80665, inch = 0.0254;

std::unique_ptr<const TargetSpectrum> guide(double pga, const char* direction, double damping) {
  return target_of("rg_1_60", {{"pga", target_raw(pga)}, {"direction", target_raw(direction)}, {"damping", target_raw(damping)}});
}

std::unique_ptr<const TargetSpectrum> code(double a_g, const char* ground, int type, double damping = 0.05,
                                           const char* direction = "horizontal") {
  return target_of("eurocode_8", {{"a_g", target_raw(a_g)},
                                  {"ground", target_raw(ground)},
                                  {"spectrum", target_raw(std::int64_t{type})},
                                  {"damping", target_raw(damping)},
                                  {"direction", target_raw(direction)}});
}

std::unique_ptr<const TargetSpectrum> points(const std::vector<double>& frequencies, const std::vector<double>& values,
                                             const char* interpolation = "logarithmic") {
  return target_of(
      "table",
      {{"frequencies", target_raw(frequencies)}, {"accelerations", target_raw(values)}, {"interpolation", target_raw(interpolation)}});
}

TEST(TargetGuide, ControlPointsAsPublished) {
  // Table I at 2 %: 3.54, 4.25 times the acceleration; 2.50 times 36 in for 1 g
  const auto target = guide(0.2 * g, "horizontal", 0.02);
  EXPECT_NEAR(target->at(33), 0.2 * g, 1e-12);
  EXPECT_NEAR(target->at(60), 0.2 * g, 1e-12);
  EXPECT_NEAR(target->at(9), 3.54 * 0.2 * g, 1e-12);
  EXPECT_NEAR(target->at(2.5), 4.25 * 0.2 * g, 1e-12);
  EXPECT_NEAR(target->at(0.25), std::pow(pi / 2, 2) * 2.50 * 36 * inch * 0.2, 1e-12);
  EXPECT_EQ(target->peak_ground_acceleration(), 0.2 * g);
  EXPECT_EQ(target->damping(), 0.02);
}

TEST(TargetGuide, StraightInLogarithmsBetweenThemAndConstantDisplacementBelow) {
  const auto target = guide(3, "horizontal", 0.05);
  EXPECT_NEAR(target->at(std::sqrt(9.0 * 33)), std::sqrt(target->at(9) * target->at(33)), 1e-12);
  EXPECT_NEAR(target->at(std::sqrt(2.5 * 9)), std::sqrt(target->at(2.5) * target->at(9)), 1e-12);
  EXPECT_NEAR(target->at(std::sqrt(0.25 * 2.5)), std::sqrt(target->at(0.25) * target->at(2.5)), 1e-12);
  EXPECT_NEAR(target->at(0.1), target->at(0.25) * std::pow(0.1 / 0.25, 2), 1e-12);
}

// The guide says of its own two tables: the vertical spectrum is two thirds of the horizontal one below 0.25 Hz and equal to it from 3.5 Hz
// on. The tables have three digits.
TEST(TargetGuide, VerticalAgainstHorizontal) {
  for (const double damping : {0.005, 0.02, 0.05, 0.07, 0.10}) {
    const auto horizontal = guide(1, "horizontal", damping), vertical = guide(1, "vertical", damping);
    for (const double f : {0.1, 0.2, 0.25}) EXPECT_NEAR(vertical->at(f) / horizontal->at(f), 2.0 / 3, 0.005) << damping << " " << f;
    for (const double f : {3.5, 5.0, 9.0, 20.0, 33.0}) EXPECT_NEAR(vertical->at(f) / horizontal->at(f), 1, 0.003) << damping << " " << f;
  }
}

TEST(TargetGuide, LinearInTheDamping) {
  const auto between = guide(1, "horizontal", 0.03), low = guide(1, "horizontal", 0.02), high = guide(1, "horizontal", 0.05);
  for (const double f : {0.25, 2.5, 9.0}) EXPECT_NEAR(between->at(f), (2 * low->at(f) + high->at(f)) / 3, 1e-12);
  EXPECT_THROW(guide(1, "horizontal", 0.2), InputError);
  EXPECT_THROW(guide(1, "horizontal", 0.001), InputError);
}

TEST(TargetCode, BranchesOfTypeOne) {
  // Ground C: S = 1.15, T_B = 0.2, T_C = 0.6, T_D = 2 s
  const auto target = code(2, "C", 1);
  EXPECT_NEAR(target->peak_ground_acceleration(), 2.3, 1e-12);
  EXPECT_NEAR(target->at(1 / 0.1), 2.3 * (1 + 0.5 * 1.5), 1e-12);
  EXPECT_NEAR(target->at(1 / 0.4), 2.3 * 2.5, 1e-12);
  EXPECT_NEAR(target->at(1), 2.3 * 2.5 * 0.6, 1e-12);
  EXPECT_NEAR(target->at(1 / 3.0), 2.3 * 2.5 * 0.6 * 2 / 9, 1e-12);
  EXPECT_NEAR(target->at(1e6), 2.3, 1e-4);
}

TEST(TargetCode, CornersOfEveryGround) {
  struct Row {
    const char* ground;
    int type;
    double s, t_b, t_c, t_d;
  };
  for (const Row& row : {Row{"A", 1, 1.0, 0.15, 0.4, 2.0}, Row{"B", 1, 1.2, 0.15, 0.5, 2.0}, Row{"D", 1, 1.35, 0.20, 0.8, 2.0},
                         Row{"E", 1, 1.4, 0.15, 0.5, 2.0}, Row{"A", 2, 1.0, 0.05, 0.25, 1.2}, Row{"B", 2, 1.35, 0.05, 0.25, 1.2},
                         Row{"C", 2, 1.5, 0.10, 0.25, 1.2}, Row{"D", 2, 1.8, 0.10, 0.30, 1.2}, Row{"E", 2, 1.6, 0.05, 0.25, 1.2}}) {
    const auto target = code(1, row.ground, row.type);
    const double plateau = 2.5 * row.s, off = 1e-3;
    EXPECT_NEAR(target->at(1 / (row.t_b * (1 + off))), plateau, 1e-12);
    EXPECT_LT(target->at(1 / (row.t_b * (1 - off))), plateau);
    EXPECT_NEAR(target->at(1 / (row.t_c * (1 - off))), plateau, 1e-12);
    EXPECT_NEAR(target->at(1 / (row.t_c * (1 + off))), plateau / (1 + off), 1e-12);
    EXPECT_NEAR(target->at(1 / (row.t_d * (1 + off))), plateau * row.t_c / row.t_d / (1 + off) / (1 + off), 1e-12);
    EXPECT_NEAR(target->at(1 / (row.t_d * (1 - off))), plateau * row.t_c / row.t_d / (1 - off), 1e-12);
  }
}

TEST(TargetCode, DampingAndVertical) {
  EXPECT_NEAR(code(1, "A", 1, 0.10)->at(4), 2.5 * std::sqrt(10.0 / 15), 1e-12);
  EXPECT_NEAR(code(1, "A", 1, 0.30)->at(4), 2.5 * 0.55, 1e-12);
  EXPECT_NEAR(code(1, "D", 1, 0.05, "vertical")->at(10), 0.9 * 3, 1e-12);
  EXPECT_NEAR(code(1, "D", 2, 0.05, "vertical")->at(10), 0.45 * 3, 1e-12);
  EXPECT_NEAR(code(1, "D", 1, 0.05, "vertical")->at(0.5), 0.9 * 3 * 0.15 * 1.0 / 4, 1e-12);
  EXPECT_NEAR(code(1, "D", 1, 0.05, "vertical")->peak_ground_acceleration(), 0.9, 1e-12);
}

TEST(TargetTable, InterpolatesAsTold) {
  const auto logarithmic = points({1, 4, 20}, {2, 8, 1}), linear = points({1, 4, 20}, {2, 8, 1}, "linear");
  EXPECT_NEAR(logarithmic->at(2), 4, 1e-12);
  EXPECT_NEAR(linear->at(2), 4, 1e-12);
  EXPECT_NEAR(linear->at(12), 4.5, 1e-12);
  EXPECT_NEAR(logarithmic->at(std::sqrt(80.0)), std::sqrt(8.0), 1e-12);
  EXPECT_EQ(linear->at(0.1), 2);
  EXPECT_EQ(logarithmic->at(100), 1);
  EXPECT_EQ(logarithmic->band().from, 1);
  EXPECT_EQ(logarithmic->band().to, 20);
}

TEST(TargetTable, EveryTargetSaysWhatItIs) {
  EXPECT_EQ(target_of("rg_1_60", {{"pga", target_raw(2.5)}, {"direction", target_raw("vertical")}})->told(),
            "Regulatory Guide 1.60, vertical, pga 2.5 m/s2");
  EXPECT_EQ(target_of("eurocode_8", {{"a_g", target_raw(2.0)}, {"ground", target_raw("C")}})->told(),
            "Eurocode 8, type 1, a_g 2 m/s2, ground C");
  EXPECT_EQ(target_of("table", {{"frequencies", target_raw({1.0, 10.0})}, {"accelerations", target_raw({2.0, 3.0})}})->told(),
            "a table of 2 points");
}

TEST(TargetTable, RefusesWhatIsNoSpectrum) {
  EXPECT_THROW(points({1}, {2}), InputError);
  EXPECT_THROW(points({1, 2}, {2}), InputError);
  EXPECT_THROW(points({0, 2}, {2, 2}), InputError);
  EXPECT_THROW(points({2, 1}, {2, 2}), InputError);
  EXPECT_THROW(points({1, 2}, {2, 0}), InputError);
  try {
    points({1, 3, 2}, {2, 2, 2});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "case.toml:3: target.frequencies: expected frequencies in ascending order, found 2 Hz after 3 Hz");
  }
}

}  // namespace
}  // namespace uplift::target_test
