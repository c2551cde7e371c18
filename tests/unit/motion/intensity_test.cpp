#include "uplift/motion/intensity.h"

#include <gtest/gtest.h>

#include "unit/motion/motion_support.h"
#include "uplift/motion/formats/convert.h"
#include "uplift/motion/oscillator.h"

namespace uplift::intensity_test {
namespace {

using std::numbers::pi;
constexpr double arias_factor = pi / (2 * 9.80665);

Motion motion_with(std::vector<double> values, double step) {
  Motion motion;
  motion.step = step;
  motion.values = std::move(values);
  return motion;
}

// ---- integrals and conversions ----

TEST(Integrals, OfStraightPiecesAreExact) {
  // a = 3 t - 1 on two unequal halves of the same line: v = 1.5 t^2 - t, u = 0.5 t^3 - 0.5 t^2
  const Motion motion = motion_of(6, 0.2, [](double t) { return 3 * t - 1; });
  const Integrals path = integrals_of(motion.values, motion.step);
  for (std::size_t i = 0; i < 6; ++i) {
    const double t = 0.2 * static_cast<double>(i);
    EXPECT_NEAR(path.velocity[i], 1.5 * t * t - t, 1e-15);
    EXPECT_NEAR(path.displacement[i], 0.5 * t * t * t - 0.5 * t * t, 1e-15);
  }
}

TEST(Converted, TheAccelerationOfADisplacementGivesItBack) {
  Motion motion = motion_with(noise(60), 0.01);
  motion.values[0] = 0;
  motion.kind = MotionKind::displacement;
  const Motion acceleration = converted(motion, MotionKind::acceleration);
  EXPECT_EQ(acceleration.kind, MotionKind::acceleration);
  EXPECT_EQ(acceleration.processing.size(), 1U);
  const Motion back = converted(acceleration, MotionKind::displacement);
  for (std::size_t i = 0; i < 60; ++i) EXPECT_NEAR(back.values[i], motion.values[i], 1e-11);
  // ... and its velocity is the slope of the same spline
  const Motion velocity = converted(motion, MotionKind::velocity), integral = converted(acceleration, MotionKind::velocity);
  for (std::size_t i = 0; i < 60; ++i) EXPECT_NEAR(integral.values[i], velocity.values[i], 1e-9);
}

TEST(Converted, DerivativesOfSmoothMotions) {
  const double omega = 2 * pi * 1.5;
  Motion velocity = motion_of(401, 0.005, [&](double t) { return std::sin(omega * t); });
  velocity.kind = MotionKind::velocity;
  const Motion acceleration = converted(velocity, MotionKind::acceleration);
  const Motion displacement = converted(velocity, MotionKind::displacement);
  for (std::size_t i = 10; i + 10 < 401; ++i) {
    const double t = 0.005 * static_cast<double>(i);
    EXPECT_NEAR(acceleration.values[i], omega * std::cos(omega * t), omega * 1e-6) << t;
    EXPECT_NEAR(displacement.values[i], (1 - std::cos(omega * t)) / omega, 1e-6 / omega) << t;
  }
  // a parabola is met to round-off, ends included; so are two points
  Motion parabola = motion_of(5, 0.1, [](double t) { return t * t - t; });
  parabola.kind = MotionKind::velocity;
  const Motion line = converted(parabola, MotionKind::acceleration);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(line.values[i], 0.2 * static_cast<double>(i) - 1, 1e-13);
  Motion two = motion_with({1, 3}, 0.5);
  two.kind = MotionKind::velocity;
  EXPECT_EQ(converted(two, MotionKind::acceleration).values, (std::vector<double>{4, 4}));
}

TEST(Converted, TheSameKindIsLeftAlone) {
  const Motion motion = motion_with({1, 2, 3}, 0.1);
  const Motion same = converted(motion, MotionKind::acceleration);
  EXPECT_EQ(same.values, motion.values);
  EXPECT_TRUE(same.processing.empty());
}

// ---- intensities ----

TEST(Intensity, HarmonicOfWholeCycles) {
  const double amplitude = 2.5, frequency = 2, duration = 10, omega = 2 * pi * frequency;
  const Motion motion = motion_of(100001, 1e-4, [&](double t) { return amplitude * std::cos(omega * t); });
  const Intensity intensity = intensity_of(motion);
  EXPECT_NEAR(intensity.pga, amplitude, 1e-12);
  EXPECT_NEAR(intensity.arias, arias_factor * amplitude * amplitude * duration / 2, 1e-6 * intensity.arias);
  EXPECT_NEAR(intensity.cav, 2 / pi * amplitude * duration, 1e-6 * intensity.cav);
  EXPECT_NEAR(intensity.pgv, amplitude / omega, 1e-6 * intensity.pgv);                // v = A/w sin
  EXPECT_NEAR(intensity.pgd, 2 * amplitude / (omega * omega), 1e-5 * intensity.pgd);  // u = A/w2 (1 - cos)
  EXPECT_NEAR(intensity.d5, 0.05 * duration, 1 / (2 * omega) + 1e-9);  // t + sin(2 w t)/(2 w) grows by shares of the duration
  EXPECT_NEAR(intensity.significant_duration(), 0.9 * duration, 1e-4);
}

TEST(Intensity, RectangleInClosedForm) {
  // a = 2 for 3 s: everything in closed form, whatever the step
  const Motion motion = motion_of(31, 0.1, [](double) { return 2.0; });
  const Intensity intensity = intensity_of(motion);
  EXPECT_NEAR(intensity.arias, arias_factor * 4 * 3, 1e-12);
  EXPECT_NEAR(intensity.cav, 6, 1e-12);
  EXPECT_NEAR(intensity.pgv, 6, 1e-12);
  EXPECT_NEAR(intensity.pgd, 9, 1e-12);
  EXPECT_NEAR(intensity.d5, 0.15, 1e-12);  // within a step
  EXPECT_NEAR(intensity.d95, 2.85, 1e-12);
  // pseudo-velocity 2 A (overshoot) T/(2 pi): integral of T from 0.1 to 2.5
  const double overshoot = 1 + std::exp(-pi * 0.05 / std::sqrt(1 - 0.05 * 0.05));
  EXPECT_NEAR(intensity.housner, 2 * overshoot * (2.5 * 2.5 - 0.1 * 0.1) / (4 * pi), 0.013 * intensity.housner);
  EXPECT_LE(intensity.housner, 2 * overshoot * (2.5 * 2.5 - 0.1 * 0.1) / (4 * pi));
}

TEST(Intensity, PeaksBetweenThePoints) {
  // a = 1 - 3 t: v = t - 1.5 t2, 1/6 at t = 1/3, -1/2 at the end
  EXPECT_NEAR(intensity_of(motion_with({1, -2}, 1)).pgv, 0.5, 1e-15);
  // a = 1 - 2 t: v = t (1 - t), 1/4 at the middle and 0 at the end
  EXPECT_NEAR(intensity_of(motion_with({1, -1}, 1)).pgv, 0.25, 1e-15);
  // then a = -1: u falls from 1/6 by 1/2
  EXPECT_NEAR(intensity_of(motion_with({1, -1, -1}, 1)).pgd, 1.0 / 3, 1e-15);
  // a = t, then 1 - 6 s: v = 1/2 + s - 3 s2 is zero at s = (1 + sqrt(7))/6, where u is largest
  const double s = (1 + std::sqrt(7.0)) / 6;
  EXPECT_NEAR(intensity_of(motion_with({0, 1, -5}, 1)).pgd, 1.0 / 6 + s / 2 + s * s / 2 - s * s * s, 1e-14);
  // |a| of a piece that changes its sign: two triangles
  EXPECT_NEAR(intensity_of(motion_with({1, -2}, 1)).cav, (1.0 + 4.0) / 6, 1e-15);
  EXPECT_NEAR(intensity_of(motion_with({1, -2}, 1)).arias, arias_factor * (1 - 2 + 4) / 3, 1e-15);
}

TEST(Intensity, ScalesAsItShould) {
  const Motion motion = motion_with(noise(500), 0.01);
  Motion scaled = motion;
  for (double& value : scaled.values) value *= -3;
  const Intensity a = intensity_of(motion), b = intensity_of(scaled);
  EXPECT_NEAR(b.pga, 3 * a.pga, 1e-12);
  EXPECT_NEAR(b.pgv, 3 * a.pgv, 1e-12);
  EXPECT_NEAR(b.pgd, 3 * a.pgd, 1e-12);
  EXPECT_NEAR(b.arias, 9 * a.arias, 1e-12 * b.arias);
  EXPECT_NEAR(b.cav, 3 * a.cav, 1e-11);
  EXPECT_NEAR(b.housner, 3 * a.housner, 1e-12);
  EXPECT_NEAR(b.d5, a.d5, 1e-9);
  EXPECT_NEAR(b.d95, a.d95, 1e-9);
}

TEST(Intensity, HusidGrowsToTheAriasIntensity) {
  const Motion motion = motion_with(noise(200), 0.01);
  const std::vector<double> sum = husid(motion);
  for (std::size_t i = 1; i < sum.size(); ++i) EXPECT_GE(sum[i], sum[i - 1]);
  EXPECT_EQ(sum.front(), 0);
  EXPECT_EQ(sum.back(), intensity_of(motion).arias);
  for (const std::size_t i : {20UL, 77UL, 150UL}) EXPECT_NEAR(arias_time(motion, sum[i] / sum.back()), 0.01 * static_cast<double>(i), 1e-9);
}

TEST(Intensity, OfZeros) {
  const Intensity intensity = intensity_of(motion_with({0, 0, 0}, 0.01));
  for (const double value :
       {intensity.pga, intensity.pgv, intensity.pgd, intensity.arias, intensity.cav, intensity.d5, intensity.d95, intensity.housner})
    EXPECT_EQ(value, 0);
}

}  // namespace
}  // namespace uplift::intensity_test
