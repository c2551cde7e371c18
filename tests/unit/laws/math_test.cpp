#include <gtest/gtest.h>

#include <cmath>

#include "uplift/math/exponential.h"
#include "uplift/math/lambert.h"

// The functions of the softening laws, against extended precision.
namespace uplift::math_test {
namespace {

constexpr double ulp = 2.220446049250313e-16;

TEST(Exponential, IsGoodToAboutOneUlpOverItsWholeRange) {
  for (int i = -20000; i <= 20000; ++i) {
    const double x = 708 * std::pow(i / 20000.0, 3);
    const long double value = std::exp(static_cast<long double>(x)), minus_one = std::expm1(static_cast<long double>(x));
    const Exponential found = exponential(x);
    EXPECT_LE(std::abs(static_cast<double>((found.value - value) / value)), 1.5 * ulp) << x;
    if (i != 0) {
      EXPECT_LE(std::abs(static_cast<double>((found.minus_one - minus_one) / minus_one)), 2 * ulp) << x;
    }
  }
}

TEST(Exponential, HoldsItsArgumentAndLetsNoNumberThrough) {
  EXPECT_EQ(exponential(-1e300).value, exponential(-708).value);
  EXPECT_EQ(exponential(-1e300).minus_one, -1);
  EXPECT_TRUE(std::isfinite(exponential(1e300).value));
  EXPECT_EQ(exponential(0).value, 1);
  EXPECT_EQ(exponential(0).minus_one, 0);
  EXPECT_TRUE(std::isnan(exponential(std::nan("")).value));
}

/// Relative residual of w exp(-w) = z, in extended precision.
double residual(double z) {
  const long double w = lambert_root(z);
  return static_cast<double>(std::abs(w * std::exp(-w) - z) / z);
}

TEST(LambertRoot, SatisfiesItsEquationFromTheBranchPointToUnderflow) {
  for (int i = 1; i <= 20000; ++i) EXPECT_LE(residual(std::exp(-1.0) * i / 20000), 2 * ulp) << i;
  for (double z = 0.3; z > 1e-307; z *= 0.93) EXPECT_LE(residual(z), 2 * ulp) << z;
  for (double gap = 0.1; gap > 1e-16; gap *= 0.7) EXPECT_LE(residual(std::exp(-1.0) * (1 - gap)), 2 * ulp) << gap;
}

TEST(LambertRoot, IsTheRootBelowOne) {
  // w known exactly, z = w exp(-w): the error of w is that of z times w'/w * z = 1/(1 - w)
  for (int i = 1; i < 1000; ++i) {
    const double w = i / 1000.0, z = static_cast<double>(w * std::exp(-static_cast<long double>(w)));
    EXPECT_NEAR(lambert_root(z), w, 2 * ulp * w / (1 - w)) << w;
  }
  EXPECT_EQ(lambert_root(0), 0);
  EXPECT_NEAR(lambert_root(std::exp(-1.0)), 1, 1e-7);
  EXPECT_NEAR(lambert_root(std::exp(-1.0) * (1 + 1e-15)), 1, 1e-7) << "beyond the branch point by rounding";
  EXPECT_NEAR(lambert_root(0.2), 0.2591711018190737, 1e-15);  // -W0(-0.2)
}

}  // namespace
}  // namespace uplift::math_test
