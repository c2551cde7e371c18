#include "uplift/statistics/ida_fractiles.h"

#include <gtest/gtest.h>

#include <cmath>

// Curves in closed form, whose fractiles are those of their capacities.
namespace uplift::ida_fractiles_test {
namespace {

TEST(IdaFractiles, PercentilesLieBetweenTheValues) {
  EXPECT_EQ(percentile(std::vector<double>{1, 2, 4}, 0.5), 2);
  EXPECT_EQ(percentile(std::vector<double>{1, 2, 4}, 0.75), 3);
  EXPECT_EQ(percentile(std::vector<double>{7}, 0.16), 7);
  const std::vector<double> open{1, 2, INFINITY, INFINITY, INFINITY};
  EXPECT_EQ(percentile(open, 0.25), 2);  // exactly at a value
  EXPECT_EQ(percentile(open, 0.3), INFINITY);
  EXPECT_EQ(percentile(open, 0.84), INFINITY);
  EXPECT_EQ(percentile(open, 1), INFINITY);
}

TEST(IdaFractiles, StraightCurvesHaveTheFractilesOfTheirSlopes) {
  // demand im/c reaches d at c d, for c = 1 ... 5 in another order
  std::vector<std::vector<IdaPoint>> curves;
  for (const double c : {4.0, 1.0, 5.0, 3.0, 2.0}) curves.push_back({{c, 1, false}, {3 * c, 3, false}, {8 * c, 8, false}});
  const IdaFractiles found = ida_fractiles(curves, {0.5, 2, 8});
  for (std::size_t i = 0; i < 3; ++i) {
    const double d = found.demands[i];
    EXPECT_NEAR(*found.p16[i], 1.64 * d, 1e-14 * d);  // 0.16 of the way from the first to the fifth
    EXPECT_NEAR(*found.p50[i], 3 * d, 1e-14 * d);
    EXPECT_NEAR(*found.p84[i], 4.36 * d, 1e-14 * d);
  }
  const IdaFractiles beyond = ida_fractiles(curves, {8.1});
  EXPECT_FALSE(beyond.p16[0] || beyond.p50[0] || beyond.p84[0]);
}

TEST(IdaFractiles, ACurveReachesADemandFirstWhereItRises) {
  // it weaves: 1 at 1, back to 0.5 at 2, up to 2 at 3
  const std::vector<IdaPoint> weaving{{1, 1, false}, {2, 0.5, false}, {3, 2, false}};
  EXPECT_EQ(intensity_at_demand(weaving, 1), 1);
  EXPECT_EQ(intensity_at_demand(weaving, 0.75), 0.75);
  EXPECT_NEAR(intensity_at_demand(weaving, 1.25), 2.5, 1e-15);
  EXPECT_EQ(intensity_at_demand(weaving, 3), INFINITY);
  // nothing opens up to 2
  const std::vector<IdaPoint> closed{{1, 0, false}, {2, 0, false}, {4, 1, false}};
  EXPECT_EQ(intensity_at_demand(closed, 0.5), 3);
  EXPECT_EQ(intensity_at_demand({}, 1), INFINITY);
}

TEST(IdaFractiles, WhatOverturnsReachesEveryDemand) {
  const std::vector<IdaPoint> curve{{1, 1, false}, {2, 1.5, true}};
  EXPECT_EQ(intensity_at_demand(curve, 1.25), 1.5);  // on its way
  EXPECT_EQ(intensity_at_demand(curve, 1.5), 2);
  EXPECT_EQ(intensity_at_demand(curve, 100), 2);
  const std::vector<IdaPoint> at_once{{0.7, 0, true}};
  EXPECT_EQ(intensity_at_demand(at_once, 1), 0.7);
}

TEST(IdaFractiles, CurvesThatNeverReachCountAsBeyond) {
  // three of five reach 1, at 1, 2 and 3: the median is the third, 84 % never do
  std::vector<std::vector<IdaPoint>> curves(5, {{10, 0.5, false}});
  for (std::size_t k = 0; k < 3; ++k) curves[k] = {{static_cast<double>(k + 1), 1, false}};
  const IdaFractiles found = ida_fractiles(curves, {1});
  EXPECT_NEAR(*found.p16[0], 1.64, 1e-15);
  EXPECT_EQ(*found.p50[0], 3);
  EXPECT_FALSE(found.p84[0]);
}

}  // namespace
}  // namespace uplift::ida_fractiles_test
