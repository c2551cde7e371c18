#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fragility_data.h"
#include "uplift/math/dense.h"

namespace uplift::fragility_cloud_test {
namespace {

TEST(FragilityCloud, FitOfKnownData) {
  const CloudFit fit = std::get<CloudFit>(fit_cloud(ten_demands(), 0.01));
  EXPECT_NEAR(fit.a, -3.70715721, 1e-8);
  EXPECT_NEAR(fit.b, 1.08939577, 1e-8);
  EXPECT_NEAR(fit.sigma, 0.09284597, 1e-8);
  EXPECT_NEAR(fit.fragility.theta(), 0.43853219, 1e-8);
  EXPECT_NEAR(fit.fragility.beta(), 0.08522703, 1e-8);
}

/// Median and beta of MASTODON's test in closed form: demand 0.0023599995 im with beta 1.4904, capacity 0.01 with beta 1.3.
TEST(FragilityCloud, ClosedFormOfDemandAndCapacity) {
  const double theta = 0.01 / 0.0023599995, beta = std::hypot(1.4904453117463, 1.3);
  EXPECT_NEAR(theta / 4.23728895, 1, 1e-7);
  EXPECT_NEAR(beta, 1.97773285, 1e-8);
  for (const auto& [im, p] : {std::pair{0.3, 0.09030903}, {0.5, 0.13994511}, {0.7, 0.18129639}, {0.9, 0.21670677}})
    EXPECT_NEAR(cdf(Lognormal{theta, beta}, im), p, 1e-7 * p);
}

/// Fieller's interval: the thresholds t with (ln d - a - b t)^2 <= t_8^2 Var(a + b t), a quadratic equation.
TEST(FragilityCloud, IntervalOfTheMedianIsFiellers) {
  const CloudFit fit = std::get<CloudFit>(fit_cloud(ten_demands(), 0.01));
  double mean = 0, spread = 0;
  for (const CloudPoint& p : ten_demands()) mean += std::log(p.im) / 10;
  for (const CloudPoint& p : ten_demands()) spread += std::pow(std::log(p.im) - mean, 2);
  const double c = std::pow(1.859548038 * fit.sigma, 2), r = std::log(0.01) - fit.a - fit.b * mean;  // t of 8 degrees of freedom, 90 %
  const double qa = fit.b * fit.b - c / spread, qb = -2 * r * fit.b, qc = r * r - c / 10, root = std::sqrt(qb * qb - 4 * qa * qc);
  const ConfidenceInterval theta = fit.fragility.theta_interval(0.9);
  EXPECT_NEAR(*theta.lower, std::exp(mean + (-qb - root) / (2 * qa)), 1e-8);
  EXPECT_NEAR(*theta.upper, std::exp(mean + (-qb + root) / (2 * qa)), 1e-8);
}

/// ln L with lower bounds, written anew in a, b, sigma: stationary at the fit; its second derivatives give the standard errors.
TEST(FragilityCloud, CensoredDemands) {
  const auto data = ten_demands(0.0128);
  const CloudFit fit = std::get<CloudFit>(fit_cloud(data, 0.01));
  const auto log_likelihood = [&](double log_theta, double beta, double sigma) {
    const double b = sigma / beta, a = std::log(0.01) - b * log_theta;
    double sum = 0;
    for (const CloudPoint& p : data) {
      const double z = (std::log(p.demand) - a - b * std::log(p.im)) / sigma;
      sum += p.at_least ? std::log(std::erfc(z / std::numbers::sqrt2) / 2) : -z * z / 2 - std::log(sigma * std::sqrt(2 * std::numbers::pi));
    }
    return sum;
  };
  const double x[3] = {std::log(fit.fragility.theta()), fit.fragility.beta(), fit.sigma}, h = 2e-5;
  const auto f = [&](int i, double di, int j, double dj) {
    double y[3] = {x[0], x[1], x[2]};
    y[i] += di * h;
    y[j] += dj * h;
    return log_likelihood(y[0], y[1], y[2]);
  };
  EXPECT_NEAR(fit.fragility.log_likelihood(), log_likelihood(x[0], x[1], x[2]), 1e-11);
  Matrix information(3, 3);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR((f(i, 0.05, i, 0) - f(i, -0.05, i, 0)) / (0.1 * h), 0, 1e-5);
    for (int j = 0; j < 3; ++j) information(i, j) = -(f(i, 1, j, 1) - f(i, 1, j, -1) - f(i, -1, j, 1) + f(i, -1, j, -1)) / (4 * h * h);
  }
  const Matrix covariance = inverse(information);
  EXPECT_NEAR(fit.fragility.se_log_theta() / std::sqrt(covariance(0, 0)), 1, 1e-4);
  EXPECT_NEAR(fit.fragility.se_beta() / std::sqrt(covariance(1, 1)), 1, 1e-4);
  EXPECT_NEAR(fit.fragility.correlation(), covariance(0, 1) / std::sqrt(covariance(0, 0) * covariance(1, 1)), 1e-4);
  // bounds that say nothing new change little: far below what the line expects they carry no information
  auto more = ten_demands();
  more.push_back({0.5, 1e-6, true});
  const CloudFit same = std::get<CloudFit>(fit_cloud(more, 0.01));
  EXPECT_NEAR(same.a, -3.70715721, 1e-7);
  EXPECT_NEAR(same.sigma, 0.09284597 * std::sqrt(0.8), 1e-7);  // maximum of the likelihood: n instead of n - 2
}

/// Without bounds the standard errors are those of the regression, carried over to theta and beta.
TEST(FragilityCloud, StandardErrorsOfTheRegression) {
  const CloudFit fit = std::get<CloudFit>(fit_cloud(ten_demands(), 0.01));
  double mean = 0, spread = 0;
  for (const CloudPoint& p : ten_demands()) mean += std::log(p.im) / 10;
  for (const CloudPoint& p : ten_demands()) spread += std::pow(std::log(p.im) - mean, 2);
  const double t = std::log(fit.fragility.theta()) - mean, s = fit.sigma, b = fit.b;
  const double variance = s * s / (b * b) * (0.1 + t * t / spread), scatter = s * s / (b * b) * (s * s / (b * b * spread) + 1.0 / 16);
  EXPECT_NEAR(fit.fragility.se_log_theta(), std::sqrt(variance), 1e-12);
  EXPECT_NEAR(fit.fragility.se_beta(), std::sqrt(scatter), 1e-12);
  EXPECT_NEAR(fit.fragility.correlation(), s * s * s / (b * b * b) * t / spread / std::sqrt(variance * scatter), 1e-12);
}

TEST(FragilityCloud, RefusesWhatIsNotIdentifiable) {
  const auto reason = [](const std::vector<CloudPoint>& data, double threshold = 1) { return reason_of(fit_cloud(data, threshold)); };
  const auto says = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  EXPECT_PRED2(says, reason({}), "fewer than three");
  EXPECT_PRED2(says, reason({{1, 1}, {2, 2}}), "fewer than three");
  EXPECT_PRED2(says, reason({{1, 1}, {2, 2}, {3, 3, true}}), "fewer than three");
  EXPECT_PRED2(says, reason({{1, 1}, {1, 2}, {1, 3}}), "one intensity");
  EXPECT_PRED2(says, reason({{1, 1}, {2, 2}, {4, 4}}), "no scatter");
  EXPECT_PRED2(says, reason({{1, 3}, {2, 2}, {4, 1.1}}), "does not grow");
  EXPECT_PRED2(says, reason({{1, 1}, {2, 1}, {4, 1}}), "no scatter");
  EXPECT_PRED2(says, reason({{1, 1}, {2, 0}, {4, 1}}), "run 2: the demand 0");
  EXPECT_PRED2(says, reason({{1, 1}, {-2, 1}, {4, 1}}), "run 2: the intensity");
  EXPECT_PRED2(says, reason({{1, 1}, {2, 2.1}, {4, 4}}, 0), "limit 0");
}

}  // namespace
}  // namespace uplift::fragility_cloud_test
