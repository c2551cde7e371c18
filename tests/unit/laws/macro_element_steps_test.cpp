#include <algorithm>

#include "tests/unit/laws/macro_element_support.h"

// Steps of the macro-element: energy balance, dissipation, slopes, units, symmetry, and inputs at the ends of its range.
namespace uplift::macro_element_steps_test {
namespace {

using namespace macro_test;

MacroParameters variant(int number) {
  MacroParameters p = square();
  p.elasticity.shape = number % 3 == 0 ? 6 : number % 3 == 1 ? 4 : 8;
  p.elasticity.disc = number % 2 == 1;
  p.strength.ultimate = number % 3 == 0 ? 120e6 : 60e6;
  p.strength.reference = 0.05;
  p.strength.cohesion = number % 4 == 3 ? 2e6 : 0;
  if (number >= 6) p.strength.flow = MacroStrength::Flow::associated;
  if (!p.elasticity.disc) p.elasticity.length[1] = 8, p.elasticity.rocking[1] = 4e10, p.elasticity.horizontal[1] = 2.3e9;
  return p;
}

TEST(MacroSteps, EnergyBalanceAndDissipationOfAnyStep) {
  int done = 0, failed = 0;
  for (int number = 0; number < 12; ++number)
    for (const int components : {3, 6})
      for (const double size : {0.3, 1.0, 4.0}) {
        Footing footing(variant(number), components);
        RandomPath path(components, size, 5);
        for (int i = 0; i < 30; ++i) {
          const Numbers to = path.next(footing.memory), from = footing.opening;
          const double stored = footing.stored(from, footing.memory), lost = footing.dissipated(footing.memory);
          ++done;
          if (!finite(footing.mean(to))) {  // the step would be cut
            ++failed;
            continue;
          }
          double work = 0, sum = stored;
          for (std::size_t r = 0; r < to.size(); ++r) {
            work += footing.force[r] * (to[r] - from[r]);
            sum += std::abs(footing.force[r] * (to[r] - from[r]));
          }
          const double now_stored = footing.stored(to, footing.now), now_lost = footing.dissipated(footing.now);
          EXPECT_NEAR(work, now_stored - stored + now_lost - lost, 1e-12 * (sum + now_stored))
              << number << " " << components << " seed 5 " << i;
          EXPECT_GE(now_lost, lost) << number << " " << components << " seed 5 " << i;
          footing.accept(to);
          // associated flow rounds the corners of the surface over 1e-6 V
          EXPECT_LE(footing.state().bearing, number < 6 ? 1 + 1e-9 : 1 + 1e-4 * std::max(1.0, 60e6 / footing.state().vertical));
          EXPECT_LE(footing.state().sliding, 1 + 1e-6);
        }
      }
  EXPECT_LT(failed, done / 20);
}

TEST(MacroSteps, SlopeIsTheDerivative) {
  for (int number = 0; number < 12; ++number)
    for (const int components : {3, 6}) {
      Footing footing(variant(number), components);
      RandomPath path(components, 1.0, 9);
      const Numbers errors = slope_errors(footing, path);
      EXPECT_LT(errors[errors.size() * 95 / 100], 1e-6) << number << " " << components << " seed 9";  // the rest crosses a kink
    }
}

TEST(MacroSteps, UnitsScale) {
  // forces in kN instead of N: the same openings, forces and slopes smaller by 1000
  MacroParameters p = square(), q = p;
  p.strength.ultimate = 120e6, p.strength.cohesion = 1e6;
  q = p;
  for (double* value : {&q.elasticity.vertical, &q.elasticity.horizontal[0], &q.elasticity.horizontal[1], &q.elasticity.rocking[0],
                        &q.elasticity.rocking[1], &q.strength.service, &q.strength.ultimate, &q.strength.cohesion, &q.torsion})
    *value /= 1000;
  Footing a(p, 6), b(q, 6);
  RandomPath path(6, 1, 3);
  for (int i = 0; i < 50; ++i) {
    const Numbers to = path.next(a.memory);
    if (!finite(a.mean(to)) || !finite(b.mean(to))) continue;
    for (std::size_t r = 0; r < 6; ++r) EXPECT_NEAR(b.force[r] * 1000, a.force[r], 1e-7 * 60e6) << "seed 3, " << i;
    a.accept(to), b.accept(to);
  }
}

TEST(MacroSteps, EvenInShearAndMoment) {
  // opposite shear, or opposite rotation: the same N, opposite shear or moment
  for (const std::size_t mirrored : {std::size_t{0}, std::size_t{2}}) {
    Footing a(square(), 3), b(square(), 3);
    RandomPath path(3, 1, 4);
    for (int i = 0; i < 50; ++i) {
      Numbers to = path.next(a.memory);
      if (!finite(a.mean(to))) continue;
      a.accept(to);
      to[mirrored] *= -1;
      b.mean(to);
      b.accept(to);
      for (std::size_t r = 0; r < 3; ++r) EXPECT_NEAR(b.force[r] * (r == mirrored ? -1 : 1), a.force[r], 1e-8 * 60e6) << "seed 4, " << i;
    }
  }
}

TEST(MacroSteps, DiscHasNoDirection) {
  MacroParameters p = square();
  p.elasticity.disc = true;
  p.strength.ultimate = 120e6;
  Footing a(p, 6), b(p, 6);
  RandomPath path(6, 0.8, 6);
  const double c = std::cos(0.7), s = std::sin(0.7);
  const auto turned = [&](const Numbers& v) {
    return Numbers{c * v[0] - s * v[1], s * v[0] + c * v[1], v[2], c * v[3] - s * v[4], s * v[3] + c * v[4], v[5]};
  };
  for (int i = 0; i < 50; ++i) {
    const Numbers to = path.next(a.memory), other = turned(to);
    if (!finite(a.mean(to)) || !finite(b.mean(other))) continue;
    const Numbers expected = turned(a.force);
    for (std::size_t r = 0; r < 6; ++r) EXPECT_NEAR(b.force[r], expected[r], 1e-7 * 60e6) << "seed 6, " << i;
    a.accept(to), b.accept(other);
  }
}

TEST(MacroSteps, PlaneIsSpaceWithoutTheSecondAxis) {
  Footing plane(square(), 3), space(square(), 6);
  RandomPath path(3, 1, 8);
  for (int i = 0; i < 50; ++i) {
    const Numbers to = path.next(plane.memory), wide{to[0], 0, to[1], 0, to[2], 1e-3 * i};
    if (!finite(plane.mean(to))) continue;
    space.mean(wide);
    EXPECT_EQ(space.force[0], plane.force[0]);
    EXPECT_EQ(space.force[2], plane.force[1]);
    EXPECT_EQ(space.force[4], plane.force[2]);
    EXPECT_EQ(space.force[1], 0);
    EXPECT_EQ(space.force[3], 0);
    EXPECT_NEAR(space.force[5], square().torsion * 0.5 * (space.opening[5] + wide[5]), 1e-6);
    plane.accept(to), space.accept(wide);
  }
}

TEST(MacroSteps, SmallLoadsAreElastic) {
  Footing footing(square(), 6);
  Numbers stiffness(6);
  footing.law.closed_stiffness(6, stiffness.data());
  footing.mean({0, 0, 0, 0, 0, 0});  // at rest without load: the stiffness of the closed base
  for (int r = 0; r < 5; ++r) EXPECT_NEAR(footing.slope_at(r, r), 0.5 * stiffness[static_cast<std::size_t>(r)], 1e-3);
  footing.go({0, 0, -1e-3, 0, 0, 0});
  footing.go({1e-5, 2e-5, -1e-3, 1e-6, 2e-6, 3e-6});
  const Numbers opening = footing.opening;
  for (std::size_t r = 0; r < 6; ++r) EXPECT_NEAR(footing.force[r], stiffness[r] * opening[r], 1e-6 * std::abs(footing.force[r]));
  EXPECT_EQ(footing.state().dissipated, 0);
  EXPECT_EQ(footing.state().uplifted_share, 0);
}

TEST(MacroSteps, SeparationForgetsTheShear) {
  Footing footing(square(), 3);
  footing.go({0, -5e-3, 0});
  footing.go({1e-3, -5e-3, 1e-4});
  const double shear = footing.force[0], stored = 0.5 * shear * 1e-3;
  EXPECT_GT(shear, 0);
  const double before = footing.stored(footing.opening, footing.memory);
  footing.mean({1e-3, 2e-3, 1e-4});
  EXPECT_EQ(footing.end[0], 0);
  EXPECT_EQ(footing.end[1], 0);
  EXPECT_EQ(footing.end[2], 0);
  EXPECT_EQ(footing.stored({1e-3, 2e-3, 1e-4}, footing.now), 0);
  EXPECT_NEAR(footing.dissipated(footing.now), stored, 1e-9 * before);  // what the shear had stored
  footing.accept({1e-3, 2e-3, 1e-4});
  footing.mean({0.3, 2e-3, 0});  // in the air it moves freely
  EXPECT_EQ(footing.force, Numbers(3, 0.0));
  footing.accept({0.3, 2e-3, 0});
  footing.go({0.3, -5e-3, 0});  // and lands without shear
  EXPECT_NEAR(footing.force[0], 0, 1e-6);
  EXPECT_NEAR(-footing.force[1], 5e-3 * square().elasticity.vertical, 1e-3);
  EXPECT_EQ(footing.state().settlement, 0);
}

TEST(MacroSteps, EndsOfTheRange) {
  const double w = 20e6 / square().elasticity.vertical, theta = 15 * 20e6 * 10 / 6 / square().elasticity.rocking[0];
  for (const auto flow : {MacroStrength::Flow::settling, MacroStrength::Flow::associated}) {
    MacroParameters p = square();
    p.strength.flow = flow;
    {  // rotation reversed by 15 theta_0 in one step
      Footing footing(p, 3);
      footing.go({0, -w, 0});
      for (const double sign : {1.0, -1.0, 1.0, -1.0}) {
        footing.mean({0, -w, sign * theta});
        ASSERT_TRUE(finite(footing.force));
        footing.accept({0, -w, sign * theta});
        EXPECT_NEAR(footing.state().bearing, 1, 2e-5);
        EXPECT_GT(footing.force[2] * sign, -20e6 * 5);
      }
    }
    for (const double above : {1e-9, 1e-3, 3.0}) {  // centric load about V, with a little moment
      Footing footing(p, 3);
      footing.go({0, -60e6 * (1 + above) / p.elasticity.vertical, 1e-7});
      ASSERT_TRUE(finite(footing.force));
      EXPECT_LE(-footing.force[1], 60e6 * (1 + 1e-5));
      EXPECT_GE(-footing.force[1], 59e6);
    }
    for (const double n : {1e-3, 1.0, 1e3}) {  // hardly any load
      Footing footing(p, 3);
      footing.go({0, -n / p.elasticity.vertical, 0});
      footing.mean({n / p.elasticity.horizontal[0], -n / p.elasticity.vertical, 0});
      ASSERT_TRUE(finite(footing.force));
      EXPECT_LE(std::abs(footing.end[0]), 1.5 * n);
    }
  }
  Footing footing(square(), 3);  // no load at all
  EXPECT_EQ(footing.mean({0, 0, 0}), Numbers(3, 0.0));
  EXPECT_EQ(footing.mean({1e-3, 0, 0}), Numbers(3, 0.0));
}

}  // namespace
}  // namespace uplift::macro_element_steps_test
