#include "tests/unit/laws/macro_element_support.h"
#include "uplift/math/small.h"

// A rigid block on the macro-element, path-averaged: M (v_1 - v_0)/dt = f - mean, q_1 - q_0 = dt (v_0 + v_1)/2. The energy is then kept to
// round-off at any step, whatever the foundation does.
namespace uplift::macro_element_rocking_test {
namespace {

using namespace macro_test;

struct Block {
  double mass, inertia, height, gravity;  // kg, kg m2, of the centre above the base [m], m/s2
};

struct Motion {
  double residual = 0, rotation = 0;  // largest error of the balance over the kinetic energy at the start; largest |theta|
  bool ended = true, uplifted = false;
  double dissipated = 0, settlement = 0;
};

Motion rock(const MacroParameters& p, const Block& block, double rate, double step, double duration) {
  Footing footing(p, 3);
  const double m = block.mass, h = block.height;
  // small rotations, rows (u, u_n, theta) of the base: the centre moves by u + h theta
  const double mass[3][3] = {{m, 0, m * h}, {0, m, 0}, {m * h, 0, block.inertia + m * h * h}};
  footing.go({0, -m * block.gravity / p.elasticity.vertical, 0});
  double velocity[3] = {0, 0, rate};
  const auto energy = [&] {
    double kinetic = 0;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) kinetic += 0.5 * velocity[r] * mass[r][c] * velocity[c];
    return kinetic + footing.stored(footing.opening, footing.memory) + footing.dissipated(footing.memory) +
           m * block.gravity * footing.opening[1];
  };
  const double begin = energy(), kinetic = 0.5 * mass[2][2] * rate * rate;
  Motion motion;
  for (int i = 0; i * step < duration; ++i) {
    Numbers to = footing.opening;
    for (std::size_t r = 0; r < 3; ++r) to[r] += step * velocity[r];
    double residual[3], a[9];
    const auto look = [&](const Numbers& at) {
      footing.mean(at);
      double size = 0;
      for (int r = 0; r < 3; ++r) {
        const auto row = static_cast<std::size_t>(r);
        residual[r] = footing.force[row] + (r == 1 ? m * block.gravity : 0);
        for (int c = 0; c < 3; ++c) {
          const auto column = static_cast<std::size_t>(c);
          residual[r] += 2 / (step * step) * mass[r][c] * (at[column] - footing.opening[column] - step * velocity[c]);
          a[c * 3 + r] = footing.slope_at(r, c) + 2 / (step * step) * mass[r][c];
        }
        size += residual[r] * residual[r];
      }
      return std::sqrt(size);
    };
    double size = look(to);
    for (int iteration = 0; iteration < 50 && size > 1e-12 * m * block.gravity; ++iteration) {
      double d[3] = {-residual[0], -residual[1], -residual[2]};
      EXPECT_TRUE(small::gauss_solve<3>(3, a, d));
      double alpha = 1, found = 0;
      Numbers next;
      for (int trial = 0; trial < 8; ++trial, alpha *= 0.5) {
        next = to;
        for (std::size_t r = 0; r < 3; ++r) next[r] += alpha * d[r];
        found = look(next);
        if (found < size) break;
      }
      if (!(found < size)) break;  // round-off
      to = next, size = found;
    }
    size = look(to);
    if (!(size < 1e-8 * m * block.gravity)) {
      motion.ended = false;
      return motion;
    }
    for (std::size_t r = 0; r < 3; ++r) velocity[r] = 2 * (to[r] - footing.opening[r]) / step - velocity[r];
    footing.accept(to);
    motion.residual = std::max(motion.residual, std::abs(energy() - begin) / kinetic);
    motion.rotation = std::max(motion.rotation, std::abs(to[2]));
    motion.uplifted = motion.uplifted || footing.state().uplifted_share > 0.5;
  }
  motion.dissipated = footing.state().dissipated, motion.settlement = footing.state().settlement;
  return motion;
}

TEST(MacroRocking, ElasticBlockKeepsItsEnergy) {
  const MacroParameters p = lifting(4, 10, 5e9, 4e10);
  for (const double step : {2e-3, 1e-2}) {
    const Motion motion = rock(p, {1e6, 1.5e7, 0, 9.81}, 0.15, step, 4);
    ASSERT_TRUE(motion.ended) << step;
    EXPECT_TRUE(motion.uplifted);
    EXPECT_LT(motion.residual, 1e-11) << step;
    EXPECT_EQ(motion.dissipated, 0);
  }
}

TEST(MacroRocking, YieldingBlockLosesWhatTheGroundDissipates) {
  MacroParameters p = square();
  p.strength.ultimate = 120e6, p.strength.reference = 0.05;
  for (const auto flow : {MacroStrength::Flow::settling, MacroStrength::Flow::associated}) {
    p.strength.flow = flow;
    double lost[2] = {0, 0};
    int k = 0;
    for (const double step : {2e-3, 1e-2}) {
      const Motion motion = rock(p, {2e6, 1e8, 8, 9.81}, 0.2, step, 4);
      ASSERT_TRUE(motion.ended) << step;
      EXPECT_TRUE(motion.uplifted);
      EXPECT_LT(motion.residual, 1e-10) << step;
      lost[k++] = motion.dissipated;
      if (flow == MacroStrength::Flow::settling) {
        EXPECT_GT(motion.settlement, 0);
      }
    }
    EXPECT_GT(lost[0], 0.2 * 0.5 * (1e8 + 2e6 * 64) * 0.04);
    EXPECT_NEAR(lost[1], lost[0], 0.1 * lost[0]);
  }
}

TEST(MacroRocking, TheSameOnPowerLawGround) {
  for (const MacroPowerLaw& law :
       {MacroPowerLaw{{0.32, 0.25, 0.55, 2}, {0.37, 0.8, 0.8, 2}}, MacroPowerLaw{{0.5, 1, 1, 2}, {0.4, 1, 1, 2}},
        en_1998_5_surface(En1998Soil::cohesive, 0.5)->law, en_1998_5_surface(En1998Soil::cohesionless, 0.2)->law}) {
    MacroParameters p = square();
    p.strength.power_law = law;
    p.strength.ultimate = 120e6, p.strength.reference = 0.05;
    double lost[2] = {0, 0};
    int k = 0;
    for (const double step : {2e-3, 1e-2}) {
      const Motion motion = rock(p, {2e6, 1e8, 8, 9.81}, 0.2, step, 4);
      ASSERT_TRUE(motion.ended) << step;
      EXPECT_LT(motion.residual, 1e-10) << step;
      EXPECT_GT(motion.settlement, 0);
      lost[k++] = motion.dissipated;
    }
    EXPECT_GT(lost[0], 0.1 * 0.5 * (1e8 + 2e6 * 64) * 0.04);
    EXPECT_NEAR(lost[1], lost[0], 0.1 * lost[0]);
  }
}

}  // namespace
}  // namespace uplift::macro_element_rocking_test
