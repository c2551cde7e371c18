#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fragility_data.h"
#include "uplift/statistics/random.h"

namespace uplift::fragility_random_test {
namespace {

/// Draws one after the other, from the seed and the number of the test case.
struct Draws {
  std::uint64_t index;
  CounterRandom random{15};
  std::uint32_t next = 0;
  double uniform() { return random.uniform(index, next++); }
  double normal() { return random.normal(index, next++); }
};

std::vector<Stripe> random_table(Draws draws) {
  const int levels = 1 + static_cast<int>(16 * draws.uniform());
  const double spread = std::exp(4 * draws.normal());
  const bool growing = draws.uniform() < 0.5;
  std::vector<Stripe> table;
  for (int i = 0; i < levels; ++i) {
    const auto runs = static_cast<long>(std::pow(10, 3 * draws.uniform()));
    double p = draws.uniform();
    if (draws.uniform() < 0.3) p = std::round(p);
    const double log_im = std::clamp(spread * (growing ? i + draws.uniform() : draws.normal()), -690.0, 690.0);
    if (growing) p = (i + p) / levels;
    table.push_back({std::exp(log_im), runs, std::lround(p * static_cast<double>(runs))});
  }
  return table;
}

bool regular(const std::optional<double>& value) {
  return !value || (std::isfinite(*value) && *value >= 0);
}

/// Whatever the counts: numbers with an interval that contains them, or a reason.
TEST(FragilityRandom, TablesGiveAFitOrAReason) {
  int fits = 0;
  for (std::uint64_t i = 0; i < 2500; ++i) {
    const auto result = fit_stripes(random_table({i}));
    if (!std::holds_alternative<Fragility>(result)) {
      const std::string reason = reason_of(result);
      EXPECT_TRUE(reason.starts_with("not identifiable") || reason.find(" grow") != std::string::npos) << i << ": " << reason;
      continue;
    }
    ++fits;
    const Fragility& fit = fit_of(result);
    EXPECT_TRUE(fit.theta() > 0 && fit.beta() > 0 && std::isfinite(fit.theta() + fit.beta() + fit.log_likelihood())) << i;
    EXPECT_TRUE(fit.se_log_theta() > 0 && fit.se_beta() > 0 && std::isfinite(fit.se_log_theta() + fit.se_beta())) << i;
    EXPECT_LE(std::abs(fit.correlation()), 1) << i;
    const ConfidenceInterval theta = fit.theta_interval(0.9), beta = fit.beta_interval(0.9), p = fit.probability_interval(1, 0.9);
    for (const ConfidenceInterval& interval : {theta, beta, p}) EXPECT_TRUE(regular(interval.lower) && regular(interval.upper)) << i;
    EXPECT_TRUE(!theta.lower || *theta.lower < fit.theta()) << i;
    EXPECT_TRUE(!theta.upper || *theta.upper > fit.theta()) << i;
    EXPECT_TRUE(*beta.lower < fit.beta() && (!beta.upper || *beta.upper > fit.beta())) << i;
    EXPECT_TRUE(*p.lower <= fit.probability(1) && *p.upper >= fit.probability(1)) << i;
  }
  EXPECT_GT(fits, 800);
}

struct Coverage {
  int theta = 0, beta = 0, probability = 0;
};

bool covers(const ConfidenceInterval& interval, double value) {
  return (!interval.lower || *interval.lower <= value) && (!interval.upper || *interval.upper >= value);
}

constexpr double median = 0.8, scatter = 0.4;

void count(Coverage& coverage, const Fragility& fit) {
  coverage.theta += covers(fit.theta_interval(0.9), median);
  coverage.beta += covers(fit.beta_interval(0.9), scatter);
  coverage.probability += covers(fit.probability_interval(0.5, 0.9), cdf(Lognormal{median, scatter}, 0.5));
}

/// 90 % intervals of 500 studies: 450 cover the truth, with a standard deviation of sqrt(500 0.9 0.1) = 6.7; four of them are 27.
void expect_ninety_percent(const Coverage& coverage) {
  EXPECT_NEAR(coverage.theta, 450, 27);
  EXPECT_NEAR(coverage.beta, 450, 27);
  EXPECT_NEAR(coverage.probability, 450, 27);
}

TEST(FragilityRandom, IntervalsOfStripesCoverTheTruth) {
  Coverage coverage;
  for (std::uint64_t study = 0; study < 500; ++study) {
    Draws draws{study};
    std::vector<Stripe> data;
    for (const double im : {0.2, 0.3, 0.4, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2})
      data.push_back({im, 40, binomial_quantile(40, cdf(Lognormal{median, scatter}, im), draws.uniform())});
    count(coverage, fit_of(fit_stripes(data)));
  }
  expect_ninety_percent(coverage);
}

TEST(FragilityRandom, IntervalsOfCapacitiesCoverTheTruth) {
  for (const double limit : {1e9, 0.9}) {
    Coverage coverage;
    for (std::uint64_t study = 0; study < 500; ++study) {
      Draws draws{study};
      std::vector<RecordCapacity> data;
      for (int i = 0; i < (limit < 1 ? 40 : 16); ++i) {
        const double im = median * std::exp(scatter * draws.normal());
        data.push_back({std::min(im, limit), im > limit ? Known::at_least : Known::exact});
      }
      count(coverage, fit_of(fit_capacities(data)));
    }
    expect_ninety_percent(coverage);
  }
}

TEST(FragilityRandom, IntervalsOfCloudsCoverTheTruth) {
  Coverage coverage;
  for (std::uint64_t study = 0; study < 500; ++study) {
    Draws draws{study};
    std::vector<CloudPoint> data;
    for (int i = 0; i < 30; ++i) {
      const double log_im = std::log(0.1) + 2.5 * draws.uniform();
      data.push_back({std::exp(log_im), 0.01 * std::exp(1.2 * (log_im - std::log(median) + scatter * draws.normal()))});
    }
    count(coverage, std::get<CloudFit>(fit_cloud(data, 0.01)).fragility);
  }
  expect_ninety_percent(coverage);
}

/// Baker's data. A program of its own (Fisher scoring, another generator) drew 3 times 2000 data sets: 0.9727 to 0.9743 and 1.2286
/// to 1.2347; the ends scatter by 0.002 and 0.005. Standard deviation of beta: 0.082 (not the 0.067 of resampled counts).
TEST(FragilityRandom, ParametricBootstrapOfStripes) {
  const Fragility fit = fit_of(fit_stripes(baker()));
  const auto bootstrap = std::get<Bootstrap>(fit.bootstrap(2025, 4000));
  EXPECT_EQ(bootstrap.draws() + bootstrap.refused(), 4000);
  EXPECT_NEAR(*bootstrap.theta(0.9).lower, 0.9735, 0.008);
  EXPECT_NEAR(*bootstrap.theta(0.9).upper, 1.2316, 0.018);
  EXPECT_NEAR(bootstrap.se_beta(), 0.082, 0.004);
  EXPECT_NEAR(bootstrap.se_log_theta(), 0.0718, 0.004);
  EXPECT_NEAR(bootstrap.correlation(), 0.8057, 0.03);
  EXPECT_LT(*bootstrap.probability(1, 0.9).lower, fit.probability(1));
  EXPECT_GT(*bootstrap.probability(1, 0.9).upper, fit.probability(1));
  const auto of_seed = [&](std::uint64_t seed) { return std::get<Bootstrap>(fit.bootstrap(seed, 50)).se_beta(); };
  EXPECT_EQ(of_seed(1), of_seed(1));
  EXPECT_NE(of_seed(1), of_seed(2));
}

/// Of exact capacities and of a regression the standard errors are known: four standard deviations of 2000 draws are 6 %.
TEST(FragilityRandom, ParametricBootstrapOfCapacitiesAndClouds) {
  const Fragility moments = fit_of(fit_capacities(sixteen_capacities())), truncated = fit_of(fit_capacities(sixteen_capacities(1.0)));
  const auto of_moments = std::get<Bootstrap>(moments.bootstrap(1, 2000)), of_truncated = std::get<Bootstrap>(truncated.bootstrap(1, 2000));
  EXPECT_NEAR(of_moments.se_log_theta() / moments.se_log_theta(), 1, 0.07);
  EXPECT_NEAR(of_moments.se_beta() / moments.se_beta(), 1, 0.07);
  EXPECT_NEAR(of_moments.correlation(), 0, 0.09);
  EXPECT_NEAR(of_truncated.se_log_theta() / truncated.se_log_theta(), 1, 0.15);  // the information is that of large samples
  EXPECT_NEAR(of_truncated.se_beta() / truncated.se_beta(), 1, 0.15);
  const Fragility cloud = std::get<CloudFit>(fit_cloud(ten_demands(), 0.01)).fragility;
  const auto of_cloud = std::get<Bootstrap>(cloud.bootstrap(1, 2000));
  EXPECT_NEAR(of_cloud.se_log_theta() / cloud.se_log_theta(), 1, 0.07);
  EXPECT_NEAR(of_cloud.se_beta() / cloud.se_beta(), 1, 0.08);
}

TEST(FragilityRandom, BootstrapThatFindsNoFitsIsRefused) {
  const auto fit = fit_stripes(stripes({1, 2, 3}, {2}, {0, 1, 1}));
  ASSERT_EQ(reason_of(fit), "");
  EXPECT_NE(reason_of(fit_of(fit).bootstrap(1, 200)).find("of 200"), std::string::npos);
}

/// Other units of the intensity or of the demand change theta by their factor, and nothing else; so do units that nobody uses.
TEST(FragilityRandom, UnitsDoNotMatter) {
  for (const double unit : {9.81, 1e-12, 1e12, 1e-280, 1e280}) {
    auto table = baker();
    auto capacities = sixteen_capacities(1.0);
    auto cloud = ten_demands(0.0128);
    for (Stripe& s : table) s.im *= unit;
    for (RecordCapacity& c : capacities) c.im *= unit;
    for (CloudPoint& p : cloud) p.im *= unit, p.demand /= unit;
    const Fragility before[] = {fit_of(fit_stripes(baker())), fit_of(fit_capacities(sixteen_capacities(1.0))),
                                std::get<CloudFit>(fit_cloud(ten_demands(0.0128), 0.01)).fragility};
    const Fragility after[] = {fit_of(fit_stripes(table)), fit_of(fit_capacities(capacities)),
                               std::get<CloudFit>(fit_cloud(cloud, 0.01 / unit)).fragility};
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(after[i].theta() / unit / before[i].theta(), 1, 1e-9) << unit << " " << i;
      EXPECT_NEAR(after[i].beta() / before[i].beta(), 1, 1e-9) << unit << " " << i;
      EXPECT_NEAR(after[i].se_log_theta() / before[i].se_log_theta(), 1, 1e-8);
      EXPECT_NEAR(*after[i].theta_interval(0.9).upper / unit / *before[i].theta_interval(0.9).upper, 1, 1e-8);
      EXPECT_NEAR(*after[i].beta_interval(0.9).upper / *before[i].beta_interval(0.9).upper, 1, 1e-7);
    }
  }
}

}  // namespace
}  // namespace uplift::fragility_random_test
