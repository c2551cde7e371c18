#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "uplift/motion/formats/convert.h"

// What a velocity record loses where its slope is taken (docs/theory, eq 32a).
namespace uplift::velocity_test {
namespace {

/// Largest slope at the points in the middle of a sine of the amplitude 1 over its largest true slope.
double share_of_sine(double cycles) {
  const double h = 0.01, omega = 2 * std::numbers::pi * cycles / h;
  Motion motion;
  motion.kind = MotionKind::velocity;
  motion.step = h;
  for (int i = 0; i <= 400; ++i) motion.values.push_back(std::sin(omega * h * i));
  const std::vector<double> slope = converted(motion, MotionKind::acceleration).values;
  double share = 0;
  for (int i = 100; i <= 300; ++i) share = std::max(share, std::abs(slope[static_cast<std::size_t>(i)]) / omega);
  return share;
}

/// By hand at a quarter of a cycle per step: m[i-1] + 4 m[i] + m[i+1] = 3 (y[i+1] - y[i-1])/h with m = c cos(i pi/2) is 4 c = 6/h at even
/// points, 1.5/h instead of (pi/2)/h. At 0.4: 3 sin(0.8 pi)/(0.8 pi (2 + cos(0.8 pi))) = 1.763356/2.993286.
TEST(VelocityRecords, SlopeOfTheSplineThroughASine) {
  EXPECT_NEAR(share_of_sine(0.25), 3 / std::numbers::pi, 1e-12);
  EXPECT_NEAR(share_of_sine(0.4), 0.589107, 1e-6);
  EXPECT_NEAR(share_of_sine(0.01), 1, 1e-6);
  for (const double cycles : {0.01, 0.25, 0.4}) EXPECT_NEAR(spline_slope_share(cycles), share_of_sine(cycles), 1e-9) << cycles;
  EXPECT_NEAR(spline_slope_share(0.5), 0, 1e-15);
  EXPECT_EQ(spline_slope_share(0), 1);
}

}  // namespace
}  // namespace uplift::velocity_test
