#include "uplift/statistics/nuclear.h"

#include <gtest/gtest.h>

#include <cmath>

#include "uplift/math/quadrature.h"
#include "uplift/statistics/distributions.h"
#include "uplift/statistics/random.h"

namespace uplift::nuclear_test {
namespace {

std::string reason_of(const auto& result) {
  const auto* refused = std::get_if<Refused>(&result);
  return refused ? refused->reason : "";
}

/// The table of the design of the studies, and what the definition of HCLPF says.
TEST(Nuclear, HighConfidenceOfLowProbability) {
  const SeismicCapacity capacity{1, 0.24, 0.32};
  EXPECT_NEAR(capacity.beta_c(), 0.4, 1e-15);
  EXPECT_NEAR(capacity.hclpf(), 0.39692815, 5e-9);
  EXPECT_NEAR(capacity.hclpf_composite(), 0.39439592, 5e-9);
  EXPECT_NEAR(capacity.probability(0.39807373, 0.95), 0.05, 5e-9);  // with 1.644854 instead of 1.65
  EXPECT_NEAR(normal_cdf(std::log(0.39434104) / capacity.beta_c()), 0.01, 1e-9);
  EXPECT_NEAR(capacity.probability(1, 0.5), 0.5, 1e-15);
  EXPECT_EQ((SeismicCapacity{1, 0, 0}).probability(0.99, 0.95), 0);
  EXPECT_EQ((SeismicCapacity{1, 0, 0}).probability(1.01, 0.95), 1);
}

/// The mean of the curves over their confidence is the composite curve.
TEST(Nuclear, MeanOverTheConfidence) {
  const SeismicCapacity capacity{0.7, 0.24, 0.32};
  const Quadrature rule = gauss_legendre(200);
  double mean = 0;
  for (Index i = 0; i < rule.point.size(); ++i) mean += rule.weight[i] / 2 * capacity.probability(0.5, (1 + rule.point[i]) / 2);
  EXPECT_NEAR(mean, normal_cdf(std::log(0.5 / 0.7) / 0.4), 1e-9);
}

TEST(Nuclear, SeparationOfVariables) {
  const std::vector<SafetyFactor> factors{{"strength", 2, 0.1, 0.2}, {"ductility", 1.5, 0.2, 0.1}, {"spectrum", 0.9, 0.2, 0.2}};
  const auto capacity = std::get<SeismicCapacity>(separation_of_variables(0.3, factors));
  EXPECT_NEAR(capacity.median, 0.3 * 2 * 1.5 * 0.9, 1e-15);
  EXPECT_NEAR(capacity.beta_r, 0.3, 1e-15);
  EXPECT_NEAR(capacity.beta_u, 0.3, 1e-15);
  EXPECT_NEAR(std::get<SeismicCapacity>(separation_of_variables(0.3, {})).median, 0.3, 1e-16);
  EXPECT_NE(reason_of(separation_of_variables(0.3, std::vector<SafetyFactor>{{"mass", 0}})).find("\"mass\""), std::string::npos);
  EXPECT_NE(reason_of(separation_of_variables(0.3, std::vector<SafetyFactor>{{"mass", 1, -0.1}})).find("\"mass\""), std::string::npos);
  EXPECT_NE(reason_of(separation_of_variables(0, factors)), "");
}

/// Tables made of known parts: rows, columns and an interaction that is orthogonal to both.
TEST(Nuclear, TwoWayLayoutFindsThePartsOfATable) {
  Matrix table(3, 2);
  const double row[] = {-0.3, 0.1, 0.2}, column[] = {-0.2, 0.2};  // sums of squares 0.14, 0.08
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 2; ++j) table(i, j) = 0.8 * std::exp(row[i] + column[j]);
  auto layout = std::get<TwoWayLayout>(two_way_layout(table));
  EXPECT_NEAR(layout.median, 0.8, 1e-14);
  EXPECT_NEAR(layout.beta_r, std::sqrt(0.14 / 2), 1e-14);
  EXPECT_NEAR(layout.beta_u, std::sqrt(0.08 / 1), 1e-14);
  EXPECT_NEAR(layout.beta_interaction, 0, 1e-7);
  const double interaction[] = {0.05, 0.05, -0.1};  // times -1, 1: mean square 2 (0.0025 + 0.0025 + 0.01)/2 = 0.015
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 2; ++j) table(i, j) *= std::exp(interaction[i] * (2 * j - 1));
  layout = std::get<TwoWayLayout>(two_way_layout(table));
  EXPECT_NEAR(layout.beta_interaction, std::sqrt(0.015), 1e-14);
  EXPECT_NEAR(layout.beta_r, std::sqrt((2 * 0.14 / 2 - 0.015) / 2), 1e-14);
  EXPECT_NEAR(layout.beta_u, std::sqrt((3 * 0.08 - 0.015) / 3), 1e-14);
  EXPECT_NEAR(layout.capacity().beta_r, std::sqrt((0.14 - 0.015) / 2 + 0.015), 1e-14);
  EXPECT_NEAR(std::get<TwoWayLayout>(two_way_layout(Matrix::Constant(2, 2, 3))).capacity().beta_c(), 0, 1e-7);
}

TEST(Nuclear, MedianOfALayoutWithoutSamplesIsThatOfItsRecords) {
  const std::vector<double> of_record{0.4, 0.55, 0.7, 0.9, 1.3};
  Matrix table(5, 3);
  double sum = 0, squares = 0;
  for (int i = 0; i < 5; ++i) {
    const double x = std::log(of_record[static_cast<std::size_t>(i)]);
    sum += x, squares += x * x;
    table.row(i).setConstant(of_record[static_cast<std::size_t>(i)]);
  }
  const double error = std::sqrt((squares - sum * sum / 5) / 4 / 5), t = 2.1318467863;  // Student, 4 degrees of freedom, 90 % two-sided
  const ConfidenceInterval interval = std::get<TwoWayLayout>(two_way_layout(table)).median_interval(0.9);
  EXPECT_NEAR(*interval.lower, std::exp(sum / 5 - t * error), 1e-9);
  EXPECT_NEAR(*interval.upper, std::exp(sum / 5 + t * error), 1e-9);
}

TEST(Nuclear, IntervalOfTheMedianOfCrossedCapacitiesCoversIt) {
  // 8 records, 6 samples, beta_r 0.3, beta_u 0.1, interaction 0.05: 1000 layouts; three standard deviations of the count are 2.8 %. Taking
  // all 48 capacities as independent covers the median in less than half of them.
  const CounterRandom random(20261125);
  int covered = 0;
  for (std::uint64_t draw = 0; draw < 1000; ++draw) {
    Matrix table(8, 6);
    for (int i = 0; i < 8; ++i)
      for (int j = 0; j < 6; ++j)
        table(i, j) = std::exp(0.3 * random.normal(draw, static_cast<std::uint32_t>(i)) +
                               0.1 * random.normal(draw, static_cast<std::uint32_t>(8 + j)) +
                               0.05 * random.normal(draw, static_cast<std::uint32_t>(14 + 6 * i + j)));
    const ConfidenceInterval interval = std::get<TwoWayLayout>(two_way_layout(table)).median_interval(0.9);
    covered += *interval.lower <= 1 && 1 <= *interval.upper;
  }
  EXPECT_NEAR(covered, 900, 28);
}

TEST(Nuclear, TwoWayLayoutRefusesWhatItCannotSeparate) {
  EXPECT_NE(reason_of(two_way_layout(Matrix::Ones(1, 5))), "");
  EXPECT_NE(reason_of(two_way_layout(Matrix::Ones(5, 1))), "");
  Matrix table = Matrix::Ones(3, 3);
  table(1, 2) = 0;
  EXPECT_NE(reason_of(two_way_layout(table)).find("record 2 with sample 3"), std::string::npos);
}

/// Integral of P |dH| over ln a by Gauss-Legendre rules on every segment, and all that is above the last point: independent of the closed
/// form.
double by_quadrature(const std::vector<HazardPoint>& hazard, double theta, double beta) {
  const Quadrature rule = gauss_legendre(60);
  double sum = hazard.back().rate;
  for (std::size_t i = 1; i < hazard.size(); ++i) {
    const double x0 = std::log(hazard[i - 1].im), x1 = std::log(hazard[i].im),
                 k = std::log(hazard[i - 1].rate / hazard[i].rate) / (x1 - x0);
    for (Index q = 0; q < rule.point.size(); ++q) {
      const double x = x0 + (x1 - x0) * (1 + rule.point[q]) / 2;
      sum += rule.weight[q] * (x1 - x0) / 2 * normal_cdf((x - std::log(theta)) / beta) * k * hazard[i - 1].rate * std::exp(-k * (x - x0));
    }
  }
  return sum;
}

TEST(Nuclear, RiskOfAPowerLaw) {
  const double k0 = 1e-4 * std::pow(0.5, 2.5);
  EXPECT_NEAR(k0 * std::exp(2.5 * 2.5 * 0.4 * 0.4 / 2) / 2.9145549770e-5, 1, 1e-10);  // k0 theta^-k exp(k^2 beta^2/2): Cornell (1996)
  for (const int points : {2, 3, 40}) {
    std::vector<HazardPoint> hazard;
    for (int i = 0; i < points; ++i) {
      const double a = 0.5 * std::pow(4.0, i / (points - 1.0));
      hazard.push_back({a, k0 * std::pow(a, -2.5)});
    }
    const auto risk = std::get<AnnualRisk>(risk_of_curve(hazard, 1, 0.4));
    EXPECT_NEAR(risk.rate / 2.9145549770e-5, 1, 1e-10) << points;
    EXPECT_GT(risk.share_below, 0);
    EXPECT_LT(risk.share_below + risk.share_above, 1);
  }
}

TEST(Nuclear, RiskOfATabulatedCurveIsItsIntegral) {
  const std::vector<HazardPoint> hazard{{0.001, 5},  {0.01, 0.3}, {0.05, 3e-2}, {0.1, 8e-3}, {0.2, 1.5e-3},
                                        {0.5, 1e-4}, {1, 1e-5},   {2, 5e-7},    {20, 1e-13}};
  for (const double theta : {0.3, 0.6, 1.2})
    for (const double beta : {0.2, 0.5}) {
      const auto risk = std::get<AnnualRisk>(risk_of_curve(hazard, theta, beta));
      EXPECT_NEAR(risk.rate / by_quadrature(hazard, theta, beta), 1, 1e-8) << theta << " " << beta;
      EXPECT_LT(risk.share_below + risk.share_above, 1e-8);
    }
  // a step: the rate of exceeding theta itself
  EXPECT_NEAR(std::get<AnnualRisk>(risk_of_curve(hazard, 0.5, 0)).rate, 1e-4, 1e-16);
  EXPECT_NEAR(std::get<AnnualRisk>(risk_of_curve(hazard, std::sqrt(0.5), 0)).rate, std::sqrt(1e-9), 1e-14);
  EXPECT_NEAR(std::get<AnnualRisk>(risk_of_curve(hazard, 0.5, 1e-6)).rate, 1e-4, 1e-9);
  // far beyond both ends
  EXPECT_NEAR(std::get<AnnualRisk>(risk_of_curve(hazard, 1e3, 0.3)).share_above, 1, 1e-12);
  EXPECT_NEAR(std::get<AnnualRisk>(risk_of_curve(hazard, 1e-6, 0.3)).share_below, 1, 1e-12);
}

TEST(Nuclear, RiskRefusesWhatIsNoHazardCurve) {
  const auto reason = [](std::vector<HazardPoint> points) { return reason_of(risk_of_curve(points, 1, 0.4)); };
  EXPECT_NE(reason({}), "");
  EXPECT_NE(reason({{1, 1}}), "");
  EXPECT_NE(reason({{1, 1e-3}, {0.5, 1e-4}}).find("point 2"), std::string::npos);
  EXPECT_NE(reason({{1, 1e-3}, {2, 1e-3}}).find("point 2"), std::string::npos);
  EXPECT_NE(reason({{0, 1e-3}, {2, 1e-4}}).find("point 1"), std::string::npos);
  EXPECT_NE(reason({{1, 1e-3}, {2, 0}}).find("point 2"), std::string::npos);
  EXPECT_NE(reason({{1, 1}, {1 + 1e-12, 1e-300}}).find("steep"), std::string::npos);
}

TEST(Nuclear, PerformancePair) {
  for (const auto& [beta, probability] : {std::pair{0.3, 0.16483036}, {0.4, 0.09464454}, {0.5, 0.06483333}}) {
    const double theta = 0.3 * std::exp(-normal_quantile(0.01) * beta);  // 1 % at a design motion of 0.3
    const PerformancePair pair = performance_pair(0.3, theta, beta);
    EXPECT_NEAR(pair.at_design, 0.01, 1e-14);
    EXPECT_NEAR(pair.at_one_and_a_half, probability, 5e-9);
    EXPECT_EQ(performance_pair(0.3, 1.0001 * theta, beta).met(), beta > 0.35);
    EXPECT_FALSE(performance_pair(0.3, 0.9999 * theta, beta).met());
  }
}

}  // namespace
}  // namespace uplift::nuclear_test
