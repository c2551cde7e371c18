#include "uplift/statistics/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace uplift::random_test {
namespace {

using Words = std::array<std::uint32_t, 4>;

/// The known answers that Random123 publishes for philox4x32 with 10 rounds: zeros, ones, digits of pi.
TEST(Random, PhiloxGivesThePublishedAnswers) {
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  const std::uint32_t ones = 0xffffffff;
  EXPECT_EQ(philox({ones, ones, ones, ones}, {ones, ones}), (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

/// A number depends on its own seed, stream, sample and variable, and on nothing else.
TEST(Random, NumbersOfDifferentCountersDiffer) {
  std::set<std::uint64_t> seen;
  for (const std::uint64_t seed : {0ULL, 1ULL, 1ULL << 32})
    for (const std::uint32_t stream : {0U, 1U})
      for (const std::uint64_t sample : {0ULL, 1ULL, 1ULL << 32, 1ULL << 63})
        for (const std::uint32_t variable : {0U, 1U, 0xffffffffU}) seen.insert(CounterRandom(seed, stream).bits(sample, variable));
  EXPECT_EQ(seen.size(), 3 * 2 * 4 * 3);
}

/// Means of 20 000 numbers lie within four standard errors of those of the distribution.
TEST(Random, MomentsAreThoseOfTheDistribution) {
  const CounterRandom random(20250301);
  const int n = 20000;
  double mean = 0, square = 0, normal = 0, normal_square = 0, product = 0;
  for (int i = 0; i < n; ++i) {
    const double u = random.uniform(i, 0) - 0.5, x = random.normal(i, 1);
    EXPECT_LT(std::abs(u), 0.5);
    mean += u / n, square += u * u / n, normal += x / n, normal_square += x * x / n;
    product += u * (random.uniform(i + 1, 0) - 0.5) / n;
  }
  const double root = std::sqrt(n);
  EXPECT_NEAR(mean, 0, 4 * std::sqrt(1 / 12.) / root);
  EXPECT_NEAR(square, 1 / 12., 4 * std::sqrt(1 / 180.) / root);
  EXPECT_NEAR(product, 0, 4 / 12. / root);
  EXPECT_NEAR(normal, 0, 4 / root);
  EXPECT_NEAR(normal_square, 1, 4 * std::sqrt(2.) / root);
}

}  // namespace
}  // namespace uplift::random_test
