#include "uplift/statistics/clustered.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <vector>

#include "uplift/statistics/random.h"

namespace uplift::clustered_test {
namespace {

OrRefused<Fragility> fit_of(const std::vector<SharedRun>& runs) {
  std::map<double, Stripe> stripes;
  for (const SharedRun& run : runs) {
    Stripe& stripe = stripes[run.im];
    stripe.im = run.im;
    ++stripe.runs;
    stripe.exceeded += run.exceeded;
  }
  std::vector<Stripe> list;
  for (const auto& [im, stripe] : stripes) list.push_back(stripe);
  return fit_stripes(list);
}

OrRefused<CloudFit> cloud_of(const std::vector<SharedRun>& runs) {
  std::vector<CloudPoint> points;
  for (const SharedRun& run : runs) points.push_back({run.im, run.demand, run.censored});
  return fit_cloud(points, 1);
}

/// Capacities of motions and samples, exp(0.35 e_motion + 0.1 e_sample + 0.1 e_both), at six intensities; demands (im/capacity)^1.2.
std::vector<SharedRun> crossed(std::uint64_t study, long motions, long samples) {
  const CounterRandom draw(2024, static_cast<std::uint32_t>(study));
  std::vector<SharedRun> runs;
  for (long m = 0; m < motions; ++m)
    for (long s = 0; s < samples; ++s) {
      const auto at = [&](long number, std::uint32_t kind) { return draw.normal(static_cast<std::uint64_t>(number), kind); };
      const double capacity = std::exp(0.35 * at(m, 0) + 0.1 * at(s, 1) + 0.1 * at(m * samples + s, 2));
      for (const double im : {0.5, 0.7, 0.9, 1.1, 1.4, 1.8}) runs.push_back({im, im > capacity, std::pow(im / capacity, 1.2), false, m, s});
    }
  return runs;
}

// Runs that come again say nothing new: the fit stays, and so does its error, where that of independent runs falls with their number.
TEST(Clustered, RepeatedRunsSayNothingNew) {
  std::vector<SharedRun> once = crossed(1, 12, 1), four_times;
  for (const SharedRun& run : once) four_times.insert(four_times.end(), 4, run);
  const auto stripes = std::get<Fragility>(fit_of(once)), more = std::get<Fragility>(fit_of(four_times));
  const auto error = std::get<SharedError>(shared_error_of_stripes(stripes, once));
  EXPECT_NEAR(more.se_log_theta() / stripes.se_log_theta(), 0.5, 1e-9);
  EXPECT_NEAR(std::get<SharedError>(shared_error_of_stripes(more, four_times)).se_log_theta / error.se_log_theta, 1, 1e-9);
  EXPECT_EQ(error.freedom, 11);
  const auto cloud = std::get<CloudFit>(cloud_of(once)), larger = std::get<CloudFit>(cloud_of(four_times));
  const double beside = std::get<SharedError>(shared_error_of_cloud(cloud, 1, once)).se_log_theta;
  EXPECT_NEAR(std::get<SharedError>(shared_error_of_cloud(larger, 1, four_times)).se_log_theta / beside, 1, 1e-9);
}

// Every motion at the same intensities, on lines of the same slope: ln theta is the mean of the logarithms of the capacities, whatever the
// number of runs, and its error that of a mean.
TEST(Clustered, ACloudOfParallelLinesHasTheErrorOfAMean) {
  const std::vector<double> logs{-0.5, -0.2, 0.1, 0.15, 0.45};
  std::vector<SharedRun> runs;
  for (std::size_t m = 0; m < logs.size(); ++m)
    for (const double x : {-1.0, -0.25, 0.25, 1.0})
      runs.push_back({std::exp(x), false, std::exp(1.7 * (x - logs[m])), false, static_cast<long>(m), 0});
  const auto fit = std::get<CloudFit>(cloud_of(runs));
  EXPECT_NEAR(fit.fragility.theta(), 1, 1e-12);
  double squares = 0;
  for (const double each : logs) squares += each * each;
  const auto error = std::get<SharedError>(shared_error_of_cloud(fit, 1, runs));
  EXPECT_NEAR(error.se_log_theta, std::sqrt(squares / 4 / 5), 1e-12);
  EXPECT_EQ(error.freedom, 4);
  const ConfidenceInterval interval = error.theta_interval(1, 0.9);
  EXPECT_NEAR(std::log(*interval.upper), 2.131846786 * error.se_log_theta, 1e-8);  // Student's table, 4 degrees of freedom
  EXPECT_NEAR(*interval.lower * *interval.upper, 1, 1e-12);
}

// 90 % intervals of synthetic studies. Those of independent runs cover far too seldom.
TEST(Clustered, IntervalsOfSharedMotionsCoverTheMedian) {
  constexpr int studies = 400;
  int stripes = 0, cloud = 0, independent = 0;
  for (std::uint64_t study = 0; study < studies; ++study) {
    const std::vector<SharedRun> runs = crossed(study, 20, 4);
    const auto holds = [](const ConfidenceInterval& interval) { return *interval.lower <= 1 && 1 <= *interval.upper; };
    const auto fit = std::get<Fragility>(fit_of(runs));
    stripes += holds(std::get<SharedError>(shared_error_of_stripes(fit, runs)).theta_interval(fit.theta(), 0.9));
    independent += holds(fit.theta_interval(0.9));
    const auto line = std::get<CloudFit>(cloud_of(runs));
    cloud += holds(std::get<SharedError>(shared_error_of_cloud(line, 1, runs)).theta_interval(line.fragility.theta(), 0.9));
  }
  // the standard deviation of a share of 0.9 of 400 is 0.015
  EXPECT_NEAR(stripes / 400.0, 0.9, 0.045);
  EXPECT_NEAR(cloud / 400.0, 0.9, 0.045);
  EXPECT_LT(independent / 400.0, 0.6);
}

TEST(Clustered, WhatHasNoSharedMotionIsRefused) {
  std::vector<SharedRun> runs = crossed(3, 12, 1);
  const auto fit = std::get<Fragility>(fit_of(runs));
  for (std::size_t i = 0; i < runs.size(); ++i) runs[i].motion = static_cast<long>(i);
  EXPECT_NE(std::get<Refused>(shared_error_of_stripes(fit, runs)).reason.find("has several runs"), std::string::npos);
  for (SharedRun& run : runs) run.motion = 0;
  EXPECT_NE(std::get<Refused>(shared_error_of_stripes(fit, runs)).reason.find("two motions"), std::string::npos);
  EXPECT_TRUE(std::holds_alternative<Refused>(shared_error_of_stripes(fit, {})));
}

// An intensity far in the tail does not spoil the error.
TEST(Clustered, TailsStayFinite) {
  std::vector<SharedRun> runs = crossed(4, 12, 2);
  const auto fit = std::get<Fragility>(fit_of(runs));
  const double before = std::get<SharedError>(shared_error_of_stripes(fit, runs)).se_log_theta;
  for (long m = 0; m < 12; ++m) {
    runs.push_back({1e-30, false, 1e-9, false, m, 0});
    runs.push_back({1e30, true, 1e9, false, m, 0});
  }
  EXPECT_NEAR(std::get<SharedError>(shared_error_of_stripes(fit, runs)).se_log_theta / before, 1, 1e-9);
}

// Reciprocals of intensities and demands turn lower bounds into upper ones and ln theta into its negative: its error stays.
TEST(Clustered, UpperBoundsAreTheMirrorImageOfLowerOnes) {
  std::vector<SharedRun> lower = crossed(5, 12, 2), upper;
  for (std::size_t i = 0; i < lower.size(); i += 5) lower[i].censored = true;
  std::vector<CloudPoint> low, high;
  for (const SharedRun& run : lower) {
    low.push_back({run.im, run.demand, run.censored});
    high.push_back({1 / run.im, 1 / run.demand, false, run.censored});
    upper.push_back({1 / run.im, false, 1 / run.demand, false, run.motion, run.sample, run.censored});
  }
  const auto first = std::get<CloudFit>(fit_cloud(low, 1)), second = std::get<CloudFit>(fit_cloud(high, 1));
  EXPECT_NEAR(first.fragility.theta() * second.fragility.theta(), 1, 1e-9);
  const auto one = std::get<SharedError>(shared_error_of_cloud(first, 1, lower)),
             other = std::get<SharedError>(shared_error_of_cloud(second, 1, upper));
  EXPECT_NEAR(one.se_log_theta / other.se_log_theta, 1, 1e-9);
}

}  // namespace
}  // namespace uplift::clustered_test
