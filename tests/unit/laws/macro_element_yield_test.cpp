#include "tests/unit/laws/macro_element_support.h"

// Bearing capacity and sliding of the macro-element: code_aster's test SSNL201 (law FONDATION, associated flow), closed forms and an
// independent explicit integration of set P1 (tests/data/reference/macro_cyclic.csv).
namespace uplift::macro_element_yield_test {
namespace {

using namespace macro_test;

MacroParameters ssnl201() {  // kN, m
  MacroParameters p;
  p.elasticity = {.shape = 6, .length = {1, 1}, .vertical = 8e4, .horizontal = {7.5e4}, .rocking = {1.5e4}};
  p.strength = {.flow = MacroStrength::Flow::associated, .service = HUGE_VAL, .friction = HUGE_VAL};
  return p;
}

TEST(MacroYield, HardeningUnderVerticalLoad) {  // SSNL201 o, FZCPI1 to FZCPI3
  struct Row {
    double ultimate, reference, w, plastic;
  };
  for (const auto flow : {MacroStrength::Flow::associated, MacroStrength::Flow::settling})
    for (const Row& row : {Row{1600, 0.02, 0.035, 0.02}, Row{2000, 0.03, 0.030, 0.015}, Row{1300, 0.0075, 0.045, 0.03}}) {
      MacroParameters p = ssnl201();
      p.strength = {.flow = flow, .service = 800, .ultimate = row.ultimate, .reference = row.reference, .friction = 1};
      Footing footing(p, 3);
      footing.go({0, -row.w, 0});
      EXPECT_NEAR(-footing.force[1], 1200, 1e-8);
      EXPECT_NEAR(footing.state().settlement, row.plastic, 1e-11);
      EXPECT_NEAR(footing.state().accumulated, row.plastic, 1e-11);
      EXPECT_NEAR(footing.state().bearing, 1, 1e-10);
    }
}

TEST(MacroYield, AssociatedSlidingLiftsTheFooting) {  // SSNL201 d, G101 and G102, psi = phi
  MacroParameters p = ssnl201();
  p.strength.friction = std::tan(std::numbers::pi / 12);
  Footing footing(p, 3);
  footing.go({0, -6.25e-3, 0});
  footing.go({0.05, -6.25e-3, 0});
  EXPECT_NEAR(-footing.force[1], 1459.986315, 1e-6);
  EXPECT_NEAR(footing.memory[0], 0.044783971, 1e-9);
  footing.go({0, -6.25e-3, 0});
  EXPECT_NEAR(footing.force[0], -602.3033791, 1e-6);
  footing.go({0, 0, 0});
  EXPECT_NEAR(footing.state().settlement, -0.022292432, 1e-9);
  EXPECT_NEAR(footing.state().sliding, 1, 1e-9);

  p.strength.cohesion = 200;
  Footing cohesive(p, 3);
  cohesive.go({0, -6.25e-3, 0});
  cohesive.go({0.05, -6.25e-3, 0});
  EXPECT_NEAR(cohesive.state().settlement, -0.01133613, 1e-8);
  cohesive.go({0, -6.25e-3, 0});
  EXPECT_NEAR(-cohesive.force[1], 2096.092212, 1e-6);
  EXPECT_NEAR(cohesive.state().slip, 0.074458715, 1e-9);
  cohesive.go({0, 0, 0});
  EXPECT_NEAR(cohesive.force[0], -637.2019611, 1e-6);
}

constexpr double n_p1 = 20e6, theta0 = 20e6 * 10 / 6 / 5.714285714285714e10;  // N; N D/6/K_r

/// Ends of the legs of set P1.
std::vector<Leg> legs(const MacroParameters& p, int steps, double arm) {
  return macro_test::legs(p, n_p1, steps, arm, 8 * theta0);
}

/// Ends of the legs after the explicit integration.
std::vector<Leg> explicit_legs(const std::string& name) {
  std::vector<Leg> out;
  for (const auto& row : table("macro_cyclic.csv"))
    if (row.at("case") == name && row.at("route") == "explicit")
      out.push_back({std::stod(row.at("theta")), std::stod(row.at("M")), std::stod(row.at("w")), std::stod(row.at("H")),
                     std::stod(row.at("u")), std::stod(row.at("p")), std::stod(row.at("dissipated")), std::stod(row.at("dissipated"))});
  return out;
}

TEST(MacroYield, PerfectSettlingFlowInClosedForm) {
  const MacroParameters p = square();
  const double d = 10, v = p.strength.service, largest = n_p1 * d / 2 * (1 - n_p1 / v), m0 = n_p1 * d / 6, radius = v * d / 8;
  const double yield = std::pow(2 / (3 - largest / m0), 2), rate = n_p1 / (v * v) * radius * radius / largest;
  EXPECT_NEAR(rate, d / (32 * (1 - n_p1 / v)), 1e-12);
  for (const int steps : {20, 80}) {
    const std::vector<Leg> found = legs(p, steps, 0);
    double w = n_p1 / p.elasticity.vertical - 0.5 * d * theta0 * std::pow(std::sqrt(yield) - 1, 2) + rate * (8 - yield) * theta0;
    double lost = (largest + n_p1 * rate) * (8 - yield) * theta0;
    EXPECT_NEAR(w, 5.623891844e-3, 1e-12);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(found[i].m, i == 1 ? -largest : largest, 1e-9 * largest) << i;
      EXPECT_NEAR(found[i].w, w, 1e-9 * w) << i;
      EXPECT_NEAR(found[i].dissipated, lost, 1e-9 * lost) << i;
      w += rate * (16 - 2 * yield) * theta0;  // from yield to yield
      lost += (largest + n_p1 * rate) * (16 - 2 * yield) * theta0;
    }
  }
}

TEST(MacroYield, HardeningConvergesWithTheStep) {
  MacroParameters p = square();
  p.strength.ultimate = 120e6, p.strength.reference = 0.05;
  const std::vector<Leg> exact = explicit_legs("settling hardening"), fine = legs(p, 80, 0), coarse = legs(p, 40, 0);
  ASSERT_EQ(exact.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(fine[i].m, exact[i].m, 1e-3 * std::abs(exact[i].m)) << i;
    EXPECT_NEAR(fine[i].w, exact[i].w, 1e-3 * exact[i].w) << i;
    EXPECT_NEAR(fine[i].dissipated, exact[i].dissipated, 1e-3 * exact[i].dissipated) << i;
    // first order: half the step, half the distance
    EXPECT_NEAR((coarse[i].m - exact[i].m) / (fine[i].m - exact[i].m), 2, 0.1) << i;
    EXPECT_NEAR((coarse[i].w - exact[i].w) / (fine[i].w - exact[i].w), 2, 0.1) << i;
  }
}

TEST(MacroYield, MomentWithShear) {
  MacroParameters p = square();
  p.strength.ultimate = 120e6, p.strength.reference = 0.05;
  const std::vector<Leg> exact = explicit_legs("settling hardening arm 15 m"), found = legs(p, 80, 15);
  ASSERT_EQ(exact.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found[i].m, exact[i].m, 1e-3 * std::abs(exact[i].m)) << i;
    EXPECT_NEAR(found[i].w, exact[i].w, 1e-3 * exact[i].w) << i;
    EXPECT_NEAR(found[i].h, exact[i].h, 1e-3 * std::abs(exact[i].h)) << i;
    EXPECT_NEAR(found[i].dissipated, exact[i].dissipated, 1e-2 * exact[i].dissipated) << i;
  }
  // the explicit integration converges slowly in u; the later legs carry its error of the first on
  EXPECT_NEAR(found[0].u, exact[0].u, 1e-2 * exact[0].u);
}

TEST(MacroYield, BothSurfacesYieldTogether) {
  MacroParameters p = square();
  p.strength.friction = 0.05;
  Footing footing(p, 3);
  const double w = n_p1 / p.elasticity.vertical;
  footing.go({0, -w, 0});
  for (int i = 1; i <= 20; ++i) footing.go({2e-3 * i, -w - 5e-4 * i, 2e-4 * i});
  EXPECT_NEAR(footing.state().sliding, 1, 1e-9);
  EXPECT_NEAR(footing.state().bearing, 1, 1e-9);
  EXPECT_GT(footing.state().slip, 0.02);
  EXPECT_GT(footing.state().settlement, 0);
}

TEST(MacroYield, AssociatedFlowLiftsTheRockingFooting) {
  MacroParameters p = square();
  p.strength.flow = MacroStrength::Flow::associated;
  const std::vector<Leg> exact = explicit_legs("associated perfect"), found = legs(p, 160, 0);
  ASSERT_EQ(exact.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found[i].m, exact[i].m, 1e-5 * std::abs(exact[i].m)) << i;
    EXPECT_NEAR(found[i].w, exact[i].w, 1e-5) << i;  // m, of 7.8e-3 per leg
    EXPECT_NEAR(found[i].dissipated, exact[i].dissipated, 2e-3 * exact[i].dissipated) << i;
  }
}

TEST(MacroYield, SlidingAtConstantForceIsCoulomb) {
  const double k = square().elasticity.horizontal[0], limit = n_p1 * square().strength.friction, w = n_p1 / square().elasticity.vertical;
  MacroParameters strong = square();
  strong.strength.service = HUGE_VAL;
  Footing coulomb(strong, 3);
  for (const double u : {0.5, 3.0, 1.5, -4.0, 0.0}) {
    const double before = coulomb.opening[0], trial = coulomb.force[0] + k * (u * limit / k - before);
    coulomb.go({u * limit / k, -w, 0});
    EXPECT_NEAR(coulomb.force[0], std::clamp(trial, -limit, limit), 1e-9 * limit);
    EXPECT_NEAR(coulomb.force[1], -n_p1, 1e-9 * n_p1);  // psi = 0: the footing does not lift
  }
}

}  // namespace
}  // namespace uplift::macro_element_yield_test
