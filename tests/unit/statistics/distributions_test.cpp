#include "uplift/statistics/distributions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace uplift::distributions_test {
namespace {

/// P(X > x) with 60 digits (continued fraction of Mills' ratio).
TEST(Distributions, NormalTailsToFourteenDigits) {
  for (const auto& [x, tail] : {std::pair{1.3, 9.68004845856103302015e-02},
                                {5.0, 2.86651571879193911854e-07},
                                {10.1, 2.76210947176451694871e-24},
                                {20.7, 1.73185187901973783341e-95},
                                {37.3, 8.20549484493077341247e-305}}) {
    EXPECT_NEAR(normal_cdf(-x) / tail, 1, 1e-14) << x;
    EXPECT_NEAR(normal_cdf(x), 1 - tail, 1e-15);
    EXPECT_NEAR(normal_tail(x).log_probability / std::log(tail), 1, 1e-14);
    EXPECT_NEAR(normal_tail(x).hazard * tail / normal_density(x), 1, 1e-13);
    EXPECT_NEAR(normal_tail(x).excess / (normal_density(x) / tail - x), 1, 1e-9);
  }
  // first terms of the asymptotic series, where the probability itself underflows
  EXPECT_NEAR(normal_tail(1e6).excess * 1e6, 1 - 2e-12, 1e-15);
  EXPECT_NEAR(normal_tail(1e6).log_probability, -5e11 - std::log(std::sqrt(2 * std::numbers::pi) * 1e6), 1e-4);
  EXPECT_EQ(normal_tail(-1e6).log_probability, 0);
  EXPECT_NEAR(normal_density(30) / std::exp(-450) * std::sqrt(2 * std::numbers::pi), 1, 1e-14);
  EXPECT_EQ(normal_density(1e200), 0);
}

TEST(Distributions, NormalQuantilesToFourteenDigits) {
  for (const auto& [p, x] :
       {std::pair{0.05, 1.6448536269514726}, {1e-3, 3.0902323061678136}, {1e-20, 9.262340089798407}, {1e-300, 37.0470962993612}})
    EXPECT_NEAR(normal_quantile(p), -x, 1e-14 * x) << p;
  EXPECT_NEAR(normal_quantile(0.5), 0, 1e-16);
  EXPECT_NEAR(normal_quantile(0.95), 1.6448536269514726, 1e-14);
  EXPECT_TRUE(std::isinf(normal_quantile(0)) && std::isinf(normal_quantile(1)));
  for (double p = 1e-12; p < 1; p += 0.01) EXPECT_NEAR(normal_cdf(normal_quantile(p)) / p, 1, 1e-14);
}

/// Closed forms: I_x(1, b), I_x(a, 1), I_x(1/2, 1/2), and the binomial sum.
TEST(Distributions, IncompleteBeta) {
  for (const double x : {1e-9, 0.1, 0.5, 0.77, 1 - 1e-9}) {
    EXPECT_NEAR(incomplete_beta(1, 7.5, x), -std::expm1(7.5 * std::log1p(-x)), 1e-14);
    EXPECT_NEAR(incomplete_beta(7.5, 1, x), std::pow(x, 7.5), 1e-14);
    const double arc = 2 / std::numbers::pi * std::asin(std::sqrt(std::min(x, 1 - x)));
    EXPECT_NEAR(incomplete_beta(0.5, 0.5, x), x < 0.5 ? arc : 1 - arc, 1e-14);
  }
  for (const double x : {1e-6, 0.03, 0.2, 0.4}) EXPECT_NEAR(incomplete_beta_inverse(3.5, 20, incomplete_beta(3.5, 20, x)), x, 1e-11 * x);
  double sum = 0;
  for (int k = 0; k < 30; ++k) {
    sum += std::exp(std::lgamma(41) - std::lgamma(k + 1) - std::lgamma(41 - k) + k * std::log(0.3) + (40 - k) * std::log(0.7));
    EXPECT_NEAR(incomplete_beta(40 - k, k + 1, 0.7), sum, 1e-13);
    EXPECT_EQ(binomial_quantile(40, 0.3, sum - 1e-12 * sum), k);
  }
  EXPECT_EQ(binomial_quantile(40, 0, 0.5), 0);
  EXPECT_EQ(binomial_quantile(40, 1, 0.5), 40);
  EXPECT_NEAR(static_cast<double>(binomial_quantile(1000000000, 0.25, 0.5)), 2.5e8, 2);
}

/// Student's distribution with 1 and 2 degrees of freedom in closed form, printed tables for the others.
TEST(Distributions, Student) {
  EXPECT_NEAR(student_two_sided(0.9, 1), std::tan(0.45 * std::numbers::pi), 1e-11);
  EXPECT_NEAR(student_two_sided(0.9, 2), 0.9 * std::sqrt(2 / (1 - 0.81)), 1e-12);
  EXPECT_NEAR(student_two_sided(0.9, 15), 1.753050356, 1e-8);
  EXPECT_NEAR(student_two_sided(0.95, 10), 2.228138852, 1e-8);
  EXPECT_NEAR(student_two_sided(0.9, 1e8), 1.6448536269514726, 1e-7);
}

/// Clopper & Pearson's interval of a probability from k of n trials: each end has the error probability (1 - level)/2 at most.
ConfidenceInterval clopper_pearson(double k, double n, double level) {
  const double each = (1 - level) / 2;
  return {k > 0 ? incomplete_beta_inverse(k, n - k + 1, each) : 0, k < n ? 1 - incomplete_beta_inverse(n - k, k + 1, each) : 1};
}

TEST(Distributions, ClopperPearson) {
  EXPECT_EQ(clopper_pearson(0, 20, 0.95).lower, 0);
  EXPECT_NEAR(*clopper_pearson(0, 20, 0.95).upper, 1 - std::pow(0.025, 0.05), 1e-12);
  EXPECT_NEAR(*clopper_pearson(0, 20, 0.95).upper, 0.168433, 5e-7);
  EXPECT_NEAR(*clopper_pearson(3, 40, 0.95).lower, 0.015742, 5e-7);
  EXPECT_NEAR(*clopper_pearson(3, 40, 0.95).upper, 0.203865, 5e-7);
  EXPECT_EQ(clopper_pearson(7, 7, 0.9).upper, 1);
  EXPECT_NEAR(*clopper_pearson(999999, 1000000, 0.9).upper, 1 - 5.1293e-8, 1e-11);  // -ln(0.95) in a million
}

TEST(Distributions, QuantilesAndProbabilitiesAreInverse) {
  for (const Distribution& d : {Distribution(Normal{-3, 2}), Distribution(Lognormal{0.8, 0.4}), Distribution(Uniform{-1, 4})})
    for (const double p : {1e-6, 0.3, 0.5, 0.999}) EXPECT_NEAR(cdf(d, quantile(d, p)), p, 1e-12);
  EXPECT_NEAR(quantile(Lognormal{0.8, 0.4}, 0.5), 0.8, 1e-15);
  EXPECT_NEAR(quantile(Normal{-3, 2}, 0.95), -3 + 2 * 1.6448536269514726, 1e-13);
  EXPECT_EQ(cdf(Lognormal{0.8, 0.4}, -1), 0);
  EXPECT_EQ(cdf(Uniform{0, 1}, 2), 1);
}

}  // namespace
}  // namespace uplift::distributions_test
