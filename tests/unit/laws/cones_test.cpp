#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "unit/laws/laws_support.h"

// The projections behind penalty and augmented Lagrangian, tension-positive.
namespace uplift::cones_test {
using namespace law_test;
namespace {

std::unique_ptr<const Cone> unilateral() {
  return make_part(cone_catalog(), checked("unilateral", {}));
}
std::unique_ptr<const Cone> coulomb(double friction) {
  return make_part(cone_catalog(), checked("coulomb", {{"friction", friction}}));
}

TEST(Cones, UnilateralKeepsCompressionOnly) {
  const auto cone = unilateral();
  EXPECT_EQ(cone->friction(), 0);
  const std::vector<double> trial{5, -6, -3, 4};  // two points, (t, n)
  std::vector<double> force(4, 99), slope(8, 99);
  cone->project({2, 2, 0}, trial.data(), force.data(), slope.data());
  EXPECT_EQ(force, (std::vector<double>{0, 0, -3, 0}));
  EXPECT_EQ(slope, (std::vector<double>{0, 0, 0, 0, 0, 0, 1, 0}));
}

TEST(Cones, CoulombSticksSlipsAndOpens) {
  const auto cone = coulomb(0.5);
  EXPECT_EQ(cone->friction(), 0.5);
  // (t1, t2, n): sticks, slips along (3, 4)/5, open
  const std::vector<double> trial{1, 3, 7, 0, 4, 7, -4, -4, 1};
  std::vector<double> force(9), slope(27);
  cone->project({3, 3, 0}, trial.data(), force.data(), slope.data());
  const std::vector<double> expected{1, 1.2, 0, 0, 1.6, 0, -4, -4, 0};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(force[i], expected[i], 1e-15) << i;
}

TEST(Cones, ProjectionInPlaceIsTheSame) {
  const auto cone = coulomb(0.7);
  const std::vector<double> trial{1, -3, 7, 0, 4, 7, -4, -4, 1};
  std::vector<double> force(9), slope(27), in_place = trial, other(27);
  cone->project({3, 3, 0}, trial.data(), force.data(), slope.data());
  cone->project({3, 3, 0}, in_place.data(), in_place.data(), other.data());
  EXPECT_EQ(force, in_place);
  EXPECT_EQ(slope, other);
  cone->project({3, 3, 0}, trial.data(), in_place.data(), nullptr);
  EXPECT_EQ(force, in_place);
}

TEST(Cones, EveryProjectionIsIdempotentAndItsSlopeADerivative) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int components = 1; components <= 3; ++components)
    for (const auto& cone : {unilateral(), coulomb(0), coulomb(0.4), coulomb(1.3)})
      for (int trial = 0; trial < 300; ++trial) {
        const Batch batch{1, components, 0};
        const auto n = static_cast<std::size_t>(components);
        std::vector<double> q(n), p(n), again(n), slope(n * n);
        for (double& x : q) x = u(random);
        cone->project(batch, q.data(), p.data(), slope.data());
        EXPECT_LE(p[n - 1], 0);
        EXPECT_LE(std::hypot(p[0] * (n > 1), n > 2 ? p[1] : 0), -cone->friction() * p[n - 1] + 1e-15);
        cone->project(batch, p.data(), again.data(), nullptr);
        for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(again[i], p[i], 1e-15);
        // differences, away from the tip and from the edge between stick and slip
        const double size = n > 1 ? std::hypot(q[0], n > 2 ? q[1] : 0) : 1;
        if (std::abs(q[n - 1]) < 1e-3 || size < 1e-2 || (n > 1 && std::abs(size + cone->friction() * std::min(q[n - 1], 0.0)) < 1e-3))
          continue;
        const double h = 1e-6;
        for (std::size_t c = 0; c < n; ++c) {
          std::vector<double> right = q, left = q, p_right(n), p_left(n);
          right[c] += h, left[c] -= h;
          cone->project(batch, right.data(), p_right.data(), nullptr);
          cone->project(batch, left.data(), p_left.data(), nullptr);
          for (std::size_t r = 0; r < n; ++r)
            EXPECT_NEAR(slope[r * n + c], (p_right[r] - p_left[r]) / (2 * h), 1e-6) << components << r << c;
        }
      }
}

}  // namespace
}  // namespace uplift::cones_test
