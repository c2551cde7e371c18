#include "uplift/statistics/fragility.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fragility_data.h"

namespace uplift::fragility_test {
namespace {

constexpr double chi_square_90 = 2.705543454095404;  // 90 % of one degree of freedom

/// ln of the binomial likelihood, written anew with the complementary error function.
double log_likelihood(const std::vector<Stripe>& stripes, double theta, double beta) {
  double sum = 0;
  for (const Stripe& s : stripes) {
    const double z = std::log(s.im / theta) / beta / std::numbers::sqrt2, n = static_cast<double>(s.runs),
                 k = static_cast<double>(s.exceeded);
    sum += std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1);
    if (k > 0) sum += k * std::log(std::erfc(-z) / 2);
    if (k < n) sum += (n - k) * std::log(std::erfc(z) / 2);
  }
  return sum;
}
/// The same of capacities, with censoring; densities of the logarithm.
double log_likelihood(const std::vector<RecordCapacity>& capacities, double theta, double beta) {
  double sum = 0;
  for (const RecordCapacity& c : capacities) {
    const double z = std::log(c.im / theta) / beta;
    if (c.known == Known::exact) sum += -z * z / 2 - std::log(beta * std::sqrt(2 * std::numbers::pi));
    if (c.known == Known::at_least) sum += std::log(std::erfc(z / std::numbers::sqrt2) / 2);
    if (c.known == Known::at_most) sum += std::log(std::erfc(-z / std::numbers::sqrt2) / 2);
  }
  return sum;
}

/// The largest value of f between low and high, by golden section.
template <class Function>
double largest(const Function& f, double low, double high) {
  const double part = (std::sqrt(5.0) - 1) / 2;
  for (int i = 0; i < 100; ++i) {
    const double a = high - part * (high - low), b = low + part * (high - low);
    (f(a) < f(b) ? low : high) = f(a) < f(b) ? a : b;
  }
  return f((low + high) / 2);
}

/// Twice the loss of the profile likelihood at theta, at beta, at the probability p of im.
template <class Data>
struct Deviance {
  Data data;
  double best;
  double theta(double theta) const {
    return 2 * (best - largest([&](double log_beta) { return log_likelihood(data, theta, std::exp(log_beta)); }, -5, 5));
  }
  double beta(double beta) const {
    return 2 * (best - largest([&](double log_theta) { return log_likelihood(data, std::exp(log_theta), beta); }, -3, 3));
  }
  double probability(double im, double eta) const {
    return 2 * (best - largest(
                           [&](double log_beta) {
                             const double beta = std::exp(log_beta);
                             return log_likelihood(data, im * std::exp(-beta * eta), beta);
                           },
                           -5, 2));
  }
};

void expect_fit(const OrRefused<Fragility>& result, double theta, double beta, double log_likelihood) {
  ASSERT_EQ(reason_of(result), "");
  EXPECT_NEAR(fit_of(result).theta(), theta, 1e-7 * theta);
  EXPECT_NEAR(fit_of(result).beta(), beta, 1e-7 * beta);
  EXPECT_NEAR(fit_of(result).log_likelihood(), log_likelihood, 1e-7);
}

TEST(FragilityStripes, FitsOfKnownData) {
  expect_fit(fit_stripes(baker()), 1.07611579, 0.42923720, -10.79770466);
  expect_fit(fit_stripes(py_fragility()), 1.21944747, 0.31006604, -12.87044444);
  expect_fit(fit_stripes(three_stripes()), 1.46292622, 0.18840793, -5.31239935);
  const Fragility fit = fit_of(fit_stripes(baker()));
  EXPECT_NEAR(fit.se_log_theta(), 0.070974, 5e-7);
  EXPECT_NEAR(fit.se_beta(), 0.082104, 5e-7);
  EXPECT_NEAR(fit.correlation(), 0.8057, 5e-5);
  EXPECT_NEAR(fit_of(fit_stripes(py_fragility())).se_log_theta(), 0.029259, 5e-7);
  EXPECT_NEAR(fit_of(fit_stripes(py_fragility())).se_beta(), 0.025319, 5e-7);
  EXPECT_NEAR(fit.probability(fit.theta()), 0.5, 1e-15);
  EXPECT_NEAR(fit.log_likelihood(), log_likelihood(baker(), fit.theta(), fit.beta()), 1e-10);
}

TEST(FragilityStripes, RunsWithoutOutcomeBothWays) {
  const std::vector<long> failed{0, 0, 0, 1, 1, 2, 2, 3};
  const BothWays ways = fit_stripes_both_ways(baker(failed), 0.9);
  expect_fit(ways.survived, 1.07611579, 0.42923720, fit_of(ways.survived).log_likelihood());
  EXPECT_NEAR(fit_of(ways.middle).theta(), 1.042069, 5e-7);
  EXPECT_NEAR(fit_of(ways.middle).beta(), 0.409325, 5e-7);
  EXPECT_NEAR(fit_of(ways.exceeded).theta(), 0.999340, 5e-7);
  EXPECT_NEAR(fit_of(ways.exceeded).beta(), 0.404834, 5e-7);
  // so many failures that the two ends are farther apart than the interval is wide
  const BothWays apart = fit_stripes_both_ways(baker({0, 0, 10, 20, 20, 20, 20, 20}), 0.9);
  EXPECT_NE(reason_of(apart.middle).find("90 % confidence interval"), std::string::npos);
  EXPECT_EQ(reason_of(apart.survived) + reason_of(apart.exceeded), "");
  // one end without a fit
  const BothWays one = fit_stripes_both_ways(stripes({1, 2}, {3}, {1, 2}, {2, 1}), 0.9);
  EXPECT_NE(reason_of(one.exceeded).find("every run"), std::string::npos);
  EXPECT_NE(reason_of(one.middle), "");
}

/// The ends of the intervals are where an independent profile likelihood reaches the quantile of chi square.
TEST(FragilityStripes, ProfileIntervals) {
  EXPECT_NEAR(*fit_of(fit_stripes(baker())).theta_interval(0.9).lower, 0.9782, 5e-5);
  EXPECT_NEAR(*fit_of(fit_stripes(baker())).theta_interval(0.9).upper, 1.2552, 5e-5);
  for (const auto& data : {baker(), py_fragility(), three_stripes()}) {
    const Fragility fit = fit_of(fit_stripes(data));
    const Deviance<std::vector<Stripe>> deviance{data, fit.log_likelihood()};
    const ConfidenceInterval theta = fit.theta_interval(0.9), beta = fit.beta_interval(0.9), p = fit.probability_interval(0.9, 0.9);
    EXPECT_NEAR(deviance.theta(*theta.lower), chi_square_90, 1e-7);
    EXPECT_NEAR(deviance.theta(*theta.upper), chi_square_90, 1e-7);
    EXPECT_NEAR(deviance.beta(*beta.lower), chi_square_90, 1e-7);
    EXPECT_NEAR(deviance.beta(*beta.upper), chi_square_90, 1e-7);
    EXPECT_NEAR(deviance.probability(0.9, normal_quantile(*p.lower)), chi_square_90, 1e-7);
    EXPECT_NEAR(deviance.probability(0.9, normal_quantile(*p.upper)), chi_square_90, 1e-7);
    EXPECT_LT(*theta.lower, fit.theta());
    EXPECT_GT(*theta.upper, fit.theta());
    EXPECT_LT(*p.lower, fit.probability(0.9));
    EXPECT_GT(*p.upper, fit.probability(0.9));
  }
}

/// A band over all intensities: around the curve, growing with the intensity.
TEST(FragilityStripes, IntervalsOfTheWholeCurve) {
  const OrRefused<Fragility> fits[] = {fit_stripes(baker()), fit_stripes(stripes({1, 2}, {10}, {3, 4})),
                                       fit_capacities(sixteen_capacities(1.0)), fit_capacities(sixteen_capacities())};
  for (const auto& result : fits) {
    const Fragility fit = fit_of(result);
    EXPECT_EQ(fit.probability(0), 0);
    EXPECT_EQ(fit.probability_interval(0, 0.9).upper, 0);
    ConfidenceInterval before{0, 0};
    for (double im = 1e-9; im < 1e9; im *= 1.7) {
      const ConfidenceInterval band = fit.probability_interval(im, 0.9);
      EXPECT_LE(*band.lower, fit.probability(im)) << im;
      EXPECT_GE(*band.upper, fit.probability(im)) << im;
      EXPECT_GE(*band.lower, *before.lower * (1 - 1e-9)) << im;
      EXPECT_GE(*band.upper, *before.upper * (1 - 1e-9)) << im;
      before = band;
    }
  }
}

/// Where a constant fraction is as good at the confidence level, the median and beta are not bounded.
TEST(FragilityStripes, FlatDataHaveOpenIntervals) {
  const Fragility fit = fit_of(fit_stripes(stripes({1, 2}, {10}, {3, 4})));
  EXPECT_FALSE(fit.theta_interval(0.9).upper);
  EXPECT_FALSE(fit.beta_interval(0.9).upper);
  EXPECT_TRUE(fit.beta_interval(0.9).lower);
  EXPECT_TRUE(fit.theta_interval(0.05).upper);
  const ConfidenceInterval p = fit.probability_interval(1.5, 0.9);
  EXPECT_GT(*p.lower, 0.15);
  EXPECT_LT(*p.upper, 0.60);
}

TEST(FragilityStripes, RefusesWhatIsNotIdentifiable) {
  const auto reason = [](const std::vector<double>& im, const std::vector<long>& runs, const std::vector<long>& exceeded) {
    return reason_of(fit_stripes(stripes(im, runs, exceeded)));
  };
  const auto says = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  EXPECT_PRED2(says, reason({}, {1}, {}), "no runs with an outcome");
  EXPECT_PRED2(says, reason({1, 2}, {0}, {0, 0}), "no runs with an outcome");
  EXPECT_PRED2(says, reason({1, 2}, {10}, {0, 0}), "no run exceeds");
  EXPECT_PRED2(says, reason({1, 2}, {10}, {10, 10}), "every run exceeds");
  EXPECT_PRED2(says, reason({1}, {10}, {4}), "one intensity");
  EXPECT_PRED2(says, reason({2, 2}, {10}, {4, 5}), "one intensity");
  EXPECT_PRED2(says, reason({1, 2}, {10}, {0, 10}), "separates");
  EXPECT_PRED2(says, reason({1, 2, 3}, {10}, {0, 4, 10}), "separates");
  EXPECT_PRED2(says, reason({1, 2}, {10}, {10, 0}), "at lower intensities");
  EXPECT_PRED2(says, reason({1, 2}, {10}, {5, 4}), "does not grow");
  EXPECT_PRED2(says, reason({1, 2}, {10}, {4, 4}), "does not grow");
  EXPECT_PRED2(says, reason({1, 0}, {10}, {4, 4}), "stripe 2: the intensity 0");
  EXPECT_PRED2(says, reason({1, std::nan("")}, {10}, {4, 4}), "stripe 2");
  EXPECT_PRED2(says, reason({1, 2}, {10}, {4, 11}), "stripe 2: 11");
  EXPECT_PRED2(says, reason({1, 2}, {-1}, {0, 0}), "stripe 1");
  EXPECT_PRED2(says, reason_of(fit_stripes(stripes({1, 2}, {10}, {4, 6}, {0, 5}))), "stripe 2");
  // one survival above one exceedance makes it identifiable
  EXPECT_EQ(reason({1, 2, 3}, {10}, {0, 4, 9}), "");
}

TEST(FragilityCapacities, FitsOfKnownData) {
  const Fragility moments = fit_of(fit_capacities(sixteen_capacities()));
  EXPECT_NEAR(moments.theta(), 0.84241034, 1e-8);
  EXPECT_NEAR(moments.beta(), 0.46345891, 1e-8);
  EXPECT_NEAR(moments.se_log_theta(), moments.beta() / 4, 1e-15);
  EXPECT_NEAR(moments.se_beta(), moments.beta() / std::sqrt(30), 1e-15);
  const auto truncated = sixteen_capacities(1.0);
  const Fragility fit = fit_of(fit_capacities(truncated));
  EXPECT_NEAR(fit.theta(), 0.84854979, 1e-8);
  EXPECT_NEAR(fit.beta(), 0.46441052, 1e-8);
  EXPECT_NEAR(fit.log_likelihood(), log_likelihood(truncated, fit.theta(), fit.beta()), 1e-12);
}

/// Exact capacities: Student's interval of the mean. Censored ones: independent profile likelihood.
TEST(FragilityCapacities, Intervals) {
  const Fragility moments = fit_of(fit_capacities(sixteen_capacities()));
  const double half = 1.753050356 * moments.beta() / 4;  // t of 15 degrees of freedom
  EXPECT_NEAR(*moments.theta_interval(0.9).lower, moments.theta() * std::exp(-half), 1e-8);
  EXPECT_NEAR(*moments.theta_interval(0.9).upper, moments.theta() * std::exp(half), 1e-8);
  auto data = sixteen_capacities(1.0);
  data[0].known = Known::at_most;
  const Fragility fit = fit_of(fit_capacities(data));
  const Deviance<std::vector<RecordCapacity>> deviance{data, fit.log_likelihood()};
  for (const auto& end : {fit.theta_interval(0.9).lower, fit.theta_interval(0.9).upper})
    EXPECT_NEAR(deviance.theta(*end), chi_square_90, 1e-7);
  for (const auto& end : {fit.beta_interval(0.9).lower, fit.beta_interval(0.9).upper})
    EXPECT_NEAR(deviance.beta(*end), chi_square_90, 1e-7);
  for (const auto& end : {fit.probability_interval(0.5, 0.9).lower, fit.probability_interval(0.5, 0.9).upper})
    EXPECT_NEAR(deviance.probability(0.5, normal_quantile(*end)), chi_square_90, 1e-7);
}

/// The observed information is the second derivative of the likelihood: by finite differences of an independent one.
TEST(FragilityCapacities, StandardErrorsOfCensoredData) {
  const auto data = sixteen_capacities(1.0);
  const Fragility fit = fit_of(fit_capacities(data));
  const double h = 1e-4;
  const auto f = [&](double i, double j) { return log_likelihood(data, fit.theta() * std::exp(i * h), fit.beta() + j * h); };
  const double tt = -(f(1, 0) - 2 * f(0, 0) + f(-1, 0)) / (h * h), bb = -(f(0, 1) - 2 * f(0, 0) + f(0, -1)) / (h * h);
  const double tb = -(f(1, 1) - f(1, -1) - f(-1, 1) + f(-1, -1)) / (4 * h * h), determinant = tt * bb - tb * tb;
  EXPECT_NEAR(fit.se_log_theta(), std::sqrt(bb / determinant), 1e-6);
  EXPECT_NEAR(fit.se_beta(), std::sqrt(tt / determinant), 1e-6);
  EXPECT_NEAR(fit.correlation(), -tb / std::sqrt(tt * bb), 1e-5);
}

/// In the mirror (1/im) lower and upper bounds change places; capacities with bounds only are stripes of one run each.
TEST(FragilityCapacities, BoundsOfBothKinds) {
  auto data = sixteen_capacities(1.0), mirrored = data;
  data[1].known = Known::at_most;
  for (std::size_t i = 0; i < data.size(); ++i)
    mirrored[i] = {1 / data[i].im, data[i].known == Known::exact      ? Known::exact
                                   : data[i].known == Known::at_least ? Known::at_most
                                                                      : Known::at_least};
  const Fragility fit = fit_of(fit_capacities(data)), mirror = fit_of(fit_capacities(mirrored));
  EXPECT_NEAR(fit.theta() * mirror.theta(), 1, 1e-10);
  EXPECT_NEAR(fit.beta(), mirror.beta(), 1e-10);
  std::vector<RecordCapacity> bounds;
  for (const Stripe& s : three_stripes())
    for (long i = 0; i < s.runs; ++i) bounds.push_back({s.im, i < s.exceeded ? Known::at_most : Known::at_least});
  EXPECT_NEAR(fit_of(fit_capacities(bounds)).theta(), 1.46292622, 1e-7);
  EXPECT_NEAR(fit_of(fit_capacities(bounds)).beta(), 0.18840793, 1e-7);
}

TEST(FragilityCapacities, RefusesWhatIsNotIdentifiable) {
  const auto reason = [](const std::vector<RecordCapacity>& data) { return reason_of(fit_capacities(data)); };
  EXPECT_NE(reason({}), "");
  EXPECT_NE(reason({{1}}), "");
  EXPECT_NE(reason({{1}, {1}, {1}}), "");
  EXPECT_NE(reason({{1, Known::at_least}, {2, Known::at_least}}).find("no run exceeds"), std::string::npos);
  EXPECT_NE(reason({{2}, {1, Known::at_least}}).find("separates"), std::string::npos);
  EXPECT_NE(reason({{2}, {2, Known::at_least}}), "");
  EXPECT_EQ(reason({{1}, {2, Known::at_least}}), "");
  EXPECT_NE(reason({{1}, {-2}}).find("record 2"), std::string::npos);
}

}  // namespace
}  // namespace uplift::fragility_test
