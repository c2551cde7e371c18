// A footing that lands on an edge where any contact, however small, is pressed beyond its bearing capacity (eqs M23, M24).
#include "macro_element_support.h"

namespace uplift::macro_test::macro_element_landing_test {
namespace {

constexpr double width = 6, vertical = 6e8, rocking = 1.8e9, capacity = 8e6;

MacroParameters ground(double shape) {
  MacroParameters p = lifting(shape, width, vertical, rocking);
  p.elasticity.horizontal[0] = p.elasticity.horizontal[1] = 3e8;
  p.strength.service = capacity;
  return p;
}

/// Goes to `to` with the path average; the work is that of the energies, and nothing is created.
void go_on(Footing& footing, const Numbers& to) {
  const Numbers force = footing.mean(to);
  double work = 0;
  for (std::size_t r = 0; r < to.size(); ++r) {
    ASSERT_TRUE(std::isfinite(force[r]));
    work += force[r] * (to[r] - footing.opening[r]);
  }
  const double stored = footing.stored(to, footing.now) - footing.stored(footing.opening, footing.memory);
  const double lost = footing.dissipated(footing.now) - footing.dissipated(footing.memory);
  EXPECT_GE(lost, 0);
  EXPECT_NEAR(work, stored + lost, 1e-10 * (std::abs(work) + std::abs(stored) + 1));
  footing.accept(to);
}

// Strip on the half-space (shape number 4): the share of the base in contact is N D/(2 alpha K_r theta), which bears V times as much. It
// carries nothing above theta = V D/(2 alpha K_r). Until then the ground gives way along (w, theta) ~ (D/32, 1), so that the edge touches.
TEST(MacroLanding, SinksInUntilTheEdgeBears) {
  constexpr double theta = 6e-3, least = capacity * width / (8 * rocking), bearing = (theta - least) * (width / 32 + width / 2);
  for (const double sign : {1.0, -1.0})
    for (const int steps : {7, 40}) {
      Footing footing(ground(4), 3);
      footing.accept({0, theta * width / 2 + 1e-4, sign * theta});
      double depth = 0;
      for (int i = 1; i <= steps; ++i) {
        depth = 1.5 * bearing * i / steps;
        go_on(footing, {0, theta * width / 2 - depth, sign * theta});
        if (depth < bearing) {
          EXPECT_EQ(footing.end[1], 0);
          EXPECT_EQ(footing.end[2], 0);
          EXPECT_NEAR(footing.memory[2], sign * depth / (width / 32 + width / 2), 1e-12 * theta);
          EXPECT_NEAR(-footing.memory[1], depth / 17, 1e-12 * theta * width);  // D/32 of D/32 + D/2
        } else {
          EXPECT_LT(footing.end[1], -1e3);
          EXPECT_NEAR(footing.state().bearing, 1, 1e-9);
        }
      }
      EXPECT_GT(depth, bearing);
    }
}

// Where the ground bears at the edge, it has a force at once: the wedge of springs k (depth)^2/(2 theta) of shape number 6.
TEST(MacroLanding, BearsAtOnceOnSprings) {
  constexpr double theta = 6e-3;
  Footing footing(ground(6), 3);
  footing.accept({0, theta * width / 2 + 1e-4, theta});
  go_on(footing, {0, theta * width / 2 - 1e-4, theta});
  const double wedge = vertical / width * 1e-8 / (2 * theta);
  EXPECT_NEAR(footing.end[1], -wedge, 1e-9 * wedge);
}

// A rectangle of shape number 4 sinks in on its corner along (w, theta_1, theta_2) ~ (D_1/32, 1, D_1/D_2) until its smaller rotation is
// gone; the edge goes on along (D_1/32, 1). How many steps it takes does not matter.
TEST(MacroLanding, ACornerBecomesAnEdge) {
  constexpr double one = 6e-3, two = 2e-4;
  for (const double sign : {1.0, -1.0})
    for (const int steps : {1, 3, 16}) {
      MacroParameters p = ground(4);
      p.elasticity.length[1] = 4, p.elasticity.rocking[1] = 0.8e9;
      Footing footing(p, 6);
      const double up = one * width / 2 + two * 2;
      const auto at = [&](double depth) { return Numbers{0, 0, up - depth, sign * two, one, 0}; };
      footing.accept(at(-1e-5));
      for (int i = 1; i <= steps; ++i) {
        const double depth = 8 * two * i / steps;
        go_on(footing, at(depth));
        const bool corner = depth < two * (2 + width / 32 * 4 / width + 2);  // (D_1/32 + D_1/2 + D_2/2 D_1/D_2) of theta_1 = two D_2/D_1
        const double turned = corner ? depth / (width / 32 + width) : (depth - 2 * two) / (width / 32 + width / 2);
        EXPECT_EQ(footing.end[2], 0);
        EXPECT_NEAR(footing.memory[4], turned, 1e-12 * one) << depth / two;
        EXPECT_NEAR(footing.memory[3], sign * (corner ? turned * width / 4 : two), 1e-12 * one) << depth / two;
        EXPECT_NEAR(-footing.memory[2], turned * width / 32, 1e-12 * one) << depth / two;
      }
    }
}

// Shear at next to no N takes more settlement than the footing is pressed in: without a sliding surface it flows by (27/256)^2 of the slip.
// It stays at the ground without load, and bears once it is pressed further.
TEST(MacroLanding, ShearTakesALightFootingOffTheGround) {
  constexpr double theta = 1e-3, slip = 1e-2, depth = 1e-4, needed = slip * (27.0 / 256) * (27.0 / 256) * 17;  // 17: D/32 of D/32 + D/2
  for (const double push : {1.0, -1.0}) {
    Footing footing(ground(6), 3);
    footing.accept({0, theta * width / 2 + 1e-5, theta});
    go_on(footing, {push * slip, theta * width / 2 - depth, theta});
    EXPECT_EQ(footing.end, Numbers(3, 0.0));
    EXPECT_EQ(footing.memory[0], push * slip);
    EXPECT_NEAR(footing.memory[2], depth / (width / 32 + width / 2), 1e-12 * theta);
    EXPECT_NEAR(-footing.memory[1], depth / 17, 1e-12 * theta * width);
    Footing pressed(ground(6), 3);
    pressed.accept({0, theta * width / 2 + 1e-5, theta});
    go_on(pressed, {push * slip, theta * width / 2 - 3 * needed, theta});
    EXPECT_LT(pressed.end[1], -10);
    EXPECT_NEAR(pressed.state().bearing, 1, 1e-6);
    EXPECT_GT(push * pressed.end[0], 0);
  }
}

// Edges, corners and rims of every plan; corners whose smaller rotation ends before the ground bears.
TEST(MacroLanding, EveryLandingHasAState) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(-1, 1);
  for (int k = 0; k < 240; ++k) {
    const double shapes[] = {4, 6, 8};
    MacroParameters p = ground(shapes[k % 3]);
    const bool space = k % 2 == 1;
    p.elasticity.disc = space && k % 4 == 1;
    if (!p.elasticity.disc) p.elasticity.length[1] = 4, p.elasticity.rocking[1] = 0.8e9;
    p.torsion = 1e9;
    if (k % 5 == 0) p.strength.friction = 0.7;
    Footing footing(p, space ? 6 : 3);
    const double one = 0.01 * share(random), two = space ? (k % 24 == 9 ? 0.001 : 0.01) * share(random) : 0,
                 step = 1e-4 * std::pow(10, share(random));
    const double up = p.elasticity.disc ? 3 * std::hypot(one, two) : 3 * std::abs(one) + 2 * std::abs(two);
    const auto at = [&](double depth) { return space ? Numbers{1e-5, 0, up - depth, two, one, 0} : Numbers{1e-5, up - depth, one}; };
    footing.mean(at(-0.5 * step));  // in the air: it forgets its shear
    footing.accept(at(-0.5 * step));
    for (int i = 1; i <= 12; ++i) ASSERT_NO_FATAL_FAILURE(go_on(footing, at(i * step))) << k << " " << i;
  }
}

}  // namespace
}  // namespace uplift::macro_test::macro_element_landing_test
