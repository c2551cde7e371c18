#include "uplift/math/lanes.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

// Loops over registers of points must be right for every number of points and every width of the registers. The width is that of the
// processor for which the tests are compiled; for others: g++ -std=c++20 -Isrc -march=haswell (or x86-64) tests/unit/math_lanes_test.cpp
namespace uplift::lanes_test {
namespace {

std::vector<double> counted(std::ptrdiff_t n, double first) {
  std::vector<double> values(static_cast<std::size_t>(n));
  std::iota(values.begin(), values.end(), first);
  return values;
}

TEST(Lanes, FillOneRegister) {
#if defined(__AVX512F__)
  EXPECT_EQ(lanes, 8);
#elif defined(__AVX__)
  EXPECT_EQ(lanes, 4);
#elif defined(__SSE2__)
  EXPECT_EQ(lanes, 2);
#endif
  EXPECT_EQ(sizeof(Lanes), static_cast<std::size_t>(lanes) * sizeof(double));
}

// Every point is met once, what lies behind the last one is neither read into a sum nor written.
TEST(Lanes, EveryPointOnce) {
  for (std::ptrdiff_t n = 0; n <= 3 * lanes + 1; ++n) {
    std::vector<double> x = counted(n + 1, 1), y(x.size(), -7), met(x.size(), 0);
    x.back() = 1e300;
    Lanes total = 0, least = 1e9, most = -1e9;
    for_lanes(n, [&](const auto& at) {
      const Lanes here = at(x.data());
      total += here;
      least = smaller(least, at(x.data(), 1e9));
      most = larger(most, at(x.data(), -1e9));
      at.put(y.data(), choose(here > 2.0, 2.0 * here, absolute(-here)));
      at.put(met.data(), at(met.data()) + 1.0);
    });
    EXPECT_EQ(sum(total), 0.5 * static_cast<double>(n * (n + 1))) << n;
    if (n > 0) EXPECT_EQ(smallest(least), 1) << n;
    if (n > 0) EXPECT_EQ(largest(most), static_cast<double>(n)) << n;
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
      EXPECT_EQ(y[i], i < 2 ? x[i] : 2 * x[i]) << n << " " << i;
      EXPECT_EQ(met[i], 1) << n << " " << i;
    }
    EXPECT_EQ(y.back(), -7) << n;
  }
}

TEST(Lanes, AnyFindsEachOfThem) {
  for (std::ptrdiff_t marked = 0; marked < lanes; ++marked) {
    std::vector<double> x(static_cast<std::size_t>(lanes), 0);
    x[static_cast<std::size_t>(marked)] = 1;
    EXPECT_TRUE(any(WholeLanes{0}(x.data()) > 0.0)) << marked;
    EXPECT_FALSE(any(WholeLanes{0}(x.data()) > 1.0)) << marked;
  }
}

}  // namespace
}  // namespace uplift::lanes_test
