#include <array>

#include "unit/laws/macro_element_support.h"
#include "uplift/laws/macro_power_law.h"

// Random paths of a single macro-element: every plan, flow and surface, N from none to twice the capacity, both axes, in the air and down
// again. The parameters are spread over decades; most steps are far longer than those of a computation.
namespace uplift::macro_test::macro_paths_test {
namespace {

enum class Surface { effective_width, associated, power_law, en_1998_5 };

class RandomFooting {
 public:
  explicit RandomFooting(unsigned seed) : random_(seed) {}

  MacroParameters parameters(Surface surface, int plan, bool space, double shape) {
    MacroParameters p;
    MacroElasticity& e = p.elasticity;
    e.disc = space && plan == 2;
    e.shape = shape;
    e.length[0] = between(1, 50), e.length[1] = plan == 1 ? e.length[0] * between(0.2, 5) : e.length[0];
    const double v = between(1e5, 1e9);
    settled_ = between(1e-4, 0.1);
    e.vertical = v / settled_;
    e.horizontal[0] = e.vertical * between(0.3, 2), e.horizontal[1] = e.disc ? e.horizontal[0] : e.horizontal[0] * between(0.5, 2);
    for (int i = 0; i < 2; ++i) e.rocking[i] = e.vertical * e.length[i] * e.length[i] / 12 * between(0.5, 4);
    if (e.disc) e.rocking[1] = e.rocking[0];
    p.torsion = e.rocking[0];
    MacroStrength& s = p.strength;
    s.service = s.ultimate = v;
    if (one_of(3) == 1) s.ultimate = v * between(1.01, 3), s.reference = settled_ * between(0.1, 10);
    const int sliding = one_of(3);
    s.friction = sliding == 0 ? HUGE_VAL : between(0.05, 2);
    if (sliding == 2) s.cohesion = v * between(1e-4, 0.3);
    if (sliding != 0 && one_of(4) == 0) s.dilation = 0.9 * s.friction * share();
    s.settlement_share = between(0.5, 2);
    if (surface == Surface::associated) s.flow = MacroStrength::Flow::associated;
    if (surface == Surface::power_law)
      s.power_law = MacroPowerLaw{{between(0.1, 0.6), between(0.2, 1.2), between(0.3, 1.2), 2},
                                  {between(0.1, 0.6), between(0.4, 1.2), between(0.4, 1.2), 2}};
    if (surface == Surface::en_1998_5)
      s.power_law = en_1998_5_surface(one_of(2) ? En1998Soil::cohesive : En1998Soil::cohesionless, 0.5 * share())->law;
    size_ = std::pow(10, both());
    return p;
  }

  /// About the plastic openings.
  Numbers next(const MacroParameters& p, const Numbers& plastic, bool space) {
    const MacroElasticity& e = p.elasticity;
    const double v = p.strength.service, n = one_of(8) == 0 ? 0 : 2.2 * v * share();
    double w = one_of(6) == 0 ? -settled_ * share() : n / e.vertical, turned[2], moved[2];
    for (int i = 0; i < 2; ++i) turned[i] = size_ * (std::min(n, v) + 0.02 * v) * e.length[i] / 6 / e.rocking[i] * both();
    for (double& each : moved) each = size_ * 0.3 * v / e.horizontal[0] * both();
    if (one_of(3) == 0) w -= 0.6 * share() * (e.length[0] * std::abs(turned[0]) + (space ? e.length[1] * std::abs(turned[1]) : 0));
    Numbers to = space ? Numbers{moved[0], moved[1], -w, turned[1], turned[0], turned[0] * both()} : Numbers{moved[0], -w, turned[0]};
    for (std::size_t r = 0; r < (space ? 5U : 3U); ++r) to[r] += plastic[r];
    return to;
  }
  /// J: of the capacity on elastic ground.
  double energy(const MacroParameters& p) const { return p.strength.service * settled_; }

 private:
  double share() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  double both() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  double between(double a, double b) { return a * std::pow(b / a, share()); }
  unsigned one_of(unsigned count) { return static_cast<unsigned>(random_()) % count; }
  std::mt19937 random_;
  double settled_ = 0, size_ = 0;
};

/// Six steps; false where one has no state. All others keep the energy balance, dissipate, and end within the surfaces.
bool goes(unsigned seed, Surface surface, int plan, bool space, double shape) {
  RandomFooting random(seed);
  const MacroParameters p = random.parameters(surface, plan, space, shape);
  Footing footing(p, space ? 6 : 3);
  for (int i = 0; i < 6; ++i) {
    const Numbers to = random.next(p, footing.memory, space);
    footing.mean(to);
    EXPECT_TRUE(finite(footing.now));  // also where there is no state
    if (!finite(footing.force)) return false;
    EXPECT_TRUE(finite(footing.slope) && finite(footing.end));
    double work = 0, size = 0;
    for (std::size_t r = 0; r < to.size(); ++r) {
      work += footing.force[r] * (to[r] - footing.opening[r]);
      size += std::abs(footing.force[r] * (to[r] - footing.opening[r]));
    }
    const double before = footing.stored(footing.opening, footing.memory), after = footing.stored(to, footing.now),
                 lost = footing.dissipated(footing.now) - footing.dissipated(footing.memory);
    EXPECT_GE(lost, 0) << seed;
    EXPECT_NEAR(work, after - before + lost,
                1e-10 * (size + before + after + lost) + 1e-16 * (random.energy(p) + 2 * footing.dissipated(footing.now)))
        << seed;  // the last: one rounding of the sum over all steps
    footing.accept(to);
    const MacroState state = footing.state();
    const bool rounded = surface == Surface::associated;  // its corners are (eq M10)
    if (!rounded && state.vertical > 1e-3 * p.strength.service) {
      EXPECT_LE(state.bearing, 1 + 1e-8) << seed;
      EXPECT_LE(state.sliding, 1 + 1e-8) << seed;
    }
  }
  return true;
}

TEST(MacroPaths, EveryPathHasStatesOrSaysThatItHasNone) {
  std::array<int, 4> none{};
  constexpr int each = 96;
  for (unsigned k = 0; k < 4 * each; ++k) {
    constexpr std::array shapes{4.0, 6.0, 8.0, 5.3};
    const auto surface = static_cast<Surface>(k % 4);
    if (!goes(k, surface, static_cast<int>(k / 4 % 3), k / 12 % 2 == 1, shapes[k / 24 % 4])) ++none[k % 4];
  }
  // the shares of many more paths: docs/theory/macro_element.md
  EXPECT_EQ(none[0], 0);
  EXPECT_LE(none[1], each / 16);
  EXPECT_LE(none[2], each / 32);
  EXPECT_LE(none[3], each / 96);
}

}  // namespace
}  // namespace uplift::macro_test::macro_paths_test
