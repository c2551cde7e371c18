#include "uplift/statistics/latin_hypercube.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace uplift::latin_hypercube_test {
namespace {

void expect_every_stratum_once(const Matrix& probability) {
  const Index n = probability.rows();
  for (Index j = 0; j < probability.cols(); ++j) {
    std::vector<int> hits(static_cast<std::size_t>(n), 0);
    for (Index i = 0; i < n; ++i) {
      ASSERT_GT(probability(i, j), 0);
      ASSERT_LT(probability(i, j), 1);
      ++hits[static_cast<std::size_t>(probability(i, j) * static_cast<double>(n))];
    }
    for (const int count : hits) EXPECT_EQ(count, 1);
  }
}

Matrix equal_correlation(Index variables, double rho) {
  Matrix target = Matrix::Constant(variables, variables, rho);
  target.diagonal().setOnes();
  return target;
}

TEST(LatinHypercube, EveryStratumOnceWithTheTargetCorrelation) {
  Matrix mixed(4, 4);
  mixed << 1, 0.8, -0.5, 0, 0.8, 1, -0.3, 0.2, -0.5, -0.3, 1, 0.4, 0, 0.2, 0.4, 1;
  for (const Matrix& target : {equal_correlation(2, 0.95), equal_correlation(2, -0.7), equal_correlation(6, 0.5),
                               equal_correlation(20, 0.9), equal_correlation(12, 0), mixed})
    for (const Index samples : {50, 200})
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const auto made = latin_hypercube(samples, target, seed);
        const auto* sample = std::get_if<LatinHypercube>(&made);
        ASSERT_TRUE(sample);
        expect_every_stratum_once(sample->probability);
        EXPECT_LE((rank_correlation(sample->probability) - target).cwiseAbs().maxCoeff(), 0.05) << samples << " " << seed << "\n" << target;
        EXPECT_LE((sample->rank_correlation - rank_correlation(sample->probability)).cwiseAbs().maxCoeff(), 1e-12);
      }
}

TEST(LatinHypercube, IndependentVariables) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const LatinHypercube sample = latin_hypercube(50, Index{20}, seed);
    expect_every_stratum_once(sample.probability);
    EXPECT_LE((sample.rank_correlation - Matrix::Identity(20, 20)).cwiseAbs().maxCoeff(), 0.05);
  }
  expect_every_stratum_once(latin_hypercube(1, Index{3}, 1).probability);
  expect_every_stratum_once(latin_hypercube(4, Index{9}, 1).probability);  // too few samples to remove the random correlation
}

TEST(LatinHypercube, TheSeedDecides) {
  const Matrix target = equal_correlation(3, 0.4);
  const auto of_seed = [&](std::uint64_t seed) { return std::get<LatinHypercube>(latin_hypercube(30, target, seed)).probability; };
  EXPECT_EQ(of_seed(5), of_seed(5));
  EXPECT_NE(of_seed(5), of_seed(6));
}

/// Random places within the strata: their mean is that of a uniform number within four standard errors.
TEST(LatinHypercube, PlacesWithinTheStrataAreUniform) {
  const Matrix p = latin_hypercube(2000, Index{2}, 3).probability;
  double mean = 0;
  for (Index k = 0; k < p.size(); ++k) mean += (p.data()[k] * 2000 - std::floor(p.data()[k] * 2000)) / static_cast<double>(p.size());
  EXPECT_NEAR(mean, 0.5, 4 * std::sqrt(1 / 12. / 4000));
}

TEST(LatinHypercube, Refusals) {
  const auto reason = [](Index samples, const Matrix& target) {
    const auto made = latin_hypercube(samples, target, 1);
    const auto* refused = std::get_if<Refused>(&made);
    return refused ? refused->reason : "";
  };
  Matrix impossible = equal_correlation(3, 0.9);
  impossible(0, 1) = impossible(1, 0) = -0.9;
  EXPECT_NE(reason(50, impossible).find("not positive definite"), std::string::npos);
  EXPECT_NE(reason(50, equal_correlation(2, 1)).find("not positive definite"), std::string::npos);
  EXPECT_NE(reason(50, equal_correlation(3, -0.5)).find("not positive definite"), std::string::npos);  // singular
  EXPECT_NE(reason(3, equal_correlation(3, 0.5)).find("more samples"), std::string::npos);
  Matrix lopsided = equal_correlation(2, 0.5);
  lopsided(0, 1) = 0.4;
  EXPECT_NE(reason(50, lopsided).find("symmetric"), std::string::npos);
  EXPECT_NE(reason(50, 2 * Matrix::Identity(2, 2)).find("symmetric"), std::string::npos);
  EXPECT_NE(reason(50, equal_correlation(2, std::nan(""))).find("symmetric"), std::string::npos);
}

TEST(LatinHypercube, RankCorrelationOfKnownRanks) {
  Matrix columns(5, 3);
  columns << 1, 10, 7, 2, 100, 7, 3, 1000, 7, 4, 1e5, 7, 5, 1e4, 7;
  const Matrix rho = rank_correlation(columns);
  EXPECT_NEAR(rho(0, 1), 1 - 6 * 2.0 / (5 * 24), 1e-15);  // sum of squared differences of ranks: 2
  EXPECT_EQ(rho(0, 2), 0);
  EXPECT_EQ(rho(2, 2), 1);
  Matrix ties(4, 2);
  ties << 1, 1, 1, 2, 2, 3, 2, 4;
  EXPECT_NEAR(rank_correlation(ties)(0, 1), 2 / std::sqrt(5.0), 1e-15);  // ranks 0.5 0.5 2.5 2.5 and 0 1 2 3
}

}  // namespace
}  // namespace uplift::latin_hypercube_test
