#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "unit/laws/laws_support.h"

// Tangential parts beside the normal laws.
namespace uplift::tangential_test {
using namespace law_test;
namespace {

constexpr double K_n = 1e9, K_t = 4e8, mu = 0.6;

std::shared_ptr<const InterfaceLaw> springs(const std::string& tangential, double cohesion = 0) {
  std::vector<Parameter> p{{"K_n", K_n}, {"tangential", tangential}};
  if (tangential != "none") p.emplace_back("K_t", K_t);
  if (tangential == "coulomb") p.emplace_back("friction", mu);
  if (cohesion > 0) p.emplace_back("cohesion", cohesion);
  return make_law("springs", p);
}

// ---- which parameters belong to which part ----

void expect_refusal(const std::string& law, const std::vector<Parameter>& parameters, const std::string& message) {
  try {
    make_law(law, parameters);
    FAIL() << "wanted: " << message;
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), message);
  }
}

TEST(Tangential, ParametersThatWouldDoNothingAreRefused) {
  expect_refusal("springs", {{"K_n", 1e9}, {"K_t", 1e9}, {"tangential", "none"}},
                 "case.toml:7: law.K_t: expected no K_t here: it belongs to tangential = \"bonded\", \"open_free\" or \"coulomb\", found "
                 "tangential = \"none\"");
  expect_refusal(
      "elastic", {{"K_n", 1e9}, {"friction", 0.5}, {"tangential", "bonded"}},
      "case.toml:7: law.friction: expected no friction here: it belongs to tangential = \"coulomb\", found tangential = \"bonded\"");
  expect_refusal(
      "springs", {{"K_n", 1e9}, {"tangential", "open_free"}, {"cohesion", 1e3}},
      "case.toml:7: law.cohesion: expected no cohesion here: it belongs to tangential = \"coulomb\", found tangential = \"open_free\"");
  expect_refusal(
      "springs", {{"K_n", 1e9}, {"tangential", "coulomb"}},
      "case.toml:7: law.friction: expected a number (1): tangential = \"coulomb\" needs its coefficient of friction, found nothing");
}

TEST(Tangential, FollowsWhatIsGiven) {
  // two points that slip apart by 1 mm under a pressure of K_n times 0.1 mm
  const auto end = [](const std::vector<Parameter>& parameters) {
    Probe one(make_law("springs", parameters), 2);
    one.mean({0, -1e-4}, {1e-3, -1e-4});
    return one.end[0];
  };
  EXPECT_EQ(end({{"K_n", K_n}}), 0);
  EXPECT_DOUBLE_EQ(end({{"K_n", K_n}, {"K_t", K_t}}), K_t * 1e-3);
  EXPECT_DOUBLE_EQ(end({{"K_n", K_n}, {"K_t", K_t}, {"friction", mu}}), mu * K_n * 1e-4);
  EXPECT_DOUBLE_EQ(end({{"K_n", K_n}, {"friction", mu}}), mu * K_n * 1e-4);
}

TEST(Tangential, NoneGivesNoShear) {
  Probe one(springs("none"), 3);
  one.mean({0, 0, 0}, {1e-3, 1e-3, -1e-3});
  EXPECT_EQ(one.traction[0], 0);
  EXPECT_EQ(one.end[1], 0);
  EXPECT_EQ(one.slope_at(0, 0), 0);
  EXPECT_EQ(one.slope_at(1, 2), 0);
  EXPECT_EQ(one.slope_at(2, 2), 0.5 * K_n);
}

// ---- open_free ----

TEST(OpenFree, SpringsTransferShearInContactOnly) {
  Probe one(springs("open_free"), 2);
  const double d = -1e-4;
  EXPECT_NEAR(one.mean({0, d}, {1e-5, d})[0], 0.5 * K_t * 1e-5, 1e-9);
  one.accept();
  EXPECT_NEAR(one.end[0], K_t * 1e-5, 1e-9);
  // opens half way: in the first half the shear goes on from e = 1e-5 to 1.5e-5, then it is gone; its energy is dissipated
  one.mean({1e-5, d}, {2e-5, -d});
  EXPECT_NEAR(one.traction[0], 0.5 * K_t * 1.25e-5, 1e-9);
  EXPECT_EQ(one.end[0], 0);
  one.accept();
  EXPECT_NEAR(one.dissipated({2e-5, -d}, one.memory), 0.5 * K_t * 1.5e-5 * 1.5e-5, 1e-15);
  // slides freely while open, and closes at its new place without shear
  one.mean({2e-5, -d}, {9e-4, 2e-4});
  EXPECT_EQ(one.traction[0], 0);
  one.accept();
  one.mean({9e-4, 2e-4}, {9.3e-4, d});  // closed for the last third
  EXPECT_NEAR(one.traction[0], K_t * 3e-5 / 18, 1e-9);
  EXPECT_NEAR(one.end[0], K_t * 1e-5, 1e-9);
}

TEST(OpenFree, SdmLosesShearWithDamageTimesOpening) {
  const double F_u = 1e5, G_f = 100, F_c = -2e4;
  Probe one(make_law("sdm", {{"K_n", K_n}, {"F_u", F_u}, {"G_f", G_f}, {"F_c", F_c}, {"tangential", "open_free"}, {"K_t", K_t}}), 2);
  one.go({0, 0}, {0, 5e-4});
  const double j = one.memory[0], damage = 1 - std::exp(-F_u * j / G_f);
  one.go({0, 5e-4}, {1e-5, 5e-4});
  EXPECT_NEAR(one.end[0], (1 - damage) * K_t * 1e-5, 1e-9 * K_t * 1e-5);
  // closed again: full stiffness, but what was given up stays given up (the traction is continuous)
  one.go({1e-5, 5e-4}, {1e-5, -1e-3});
  EXPECT_NEAR(one.end[0], (1 - damage) * K_t * 1e-5, 1e-9 * K_t * 1e-5);
  one.respond({1e-5, -1e-3}, {2e-5, -1e-3});
  EXPECT_NEAR(one.slope_at(0, 0), K_t, 1e-6);
}

// ---- Coulomb ----

TEST(CoulombShear, AStepIntoSlipHasItsExactAverage) {
  Probe one(springs("coulomb"), 2);
  const double pressure = 1e5, d = -pressure / K_n, bound = mu * pressure, elastic = bound / K_t;
  one.go({0, 0}, {0, d});
  for (const double way : {0.5 * elastic, 3 * elastic, 40 * elastic}) {
    const double exact = way < elastic ? 0.5 * K_t * way : (0.5 * bound * elastic + bound * (way - elastic)) / way;
    EXPECT_NEAR(one.mean({0, d}, {way, d})[0], exact, 1e-12 * bound);
    EXPECT_NEAR(one.end[0], std::min(bound, K_t * way), 1e-12 * bound);
    EXPECT_NEAR(one.respond({0, d}, {way, d})[0], std::min(bound, K_t * way), 1e-12 * bound);
  }
  // back and forth: each half cycle of amplitude a slips 2a - 2 elastic, elastic parts cost nothing
  const double a = 5 * elastic;
  one.go({0, d}, {a, d});
  double work = 0;
  for (int cycle = 0; cycle < 3; ++cycle) work += one.go({a, d}, {-a, d}) + one.go({-a, d}, {a, d});
  EXPECT_NEAR(work, 3 * 2 * bound * (2 * a - 2 * elastic), 1e-11 * work);
}

TEST(CoulombShear, SlipAtTheEndOfAStepDissipatesForceTimesSlip) {
  Probe one(springs("coulomb"), 2);
  const double d = -1e-4, bound = mu * 1e5, elastic = bound / K_t;
  one.respond({0, 0}, {0, d}), one.accept();
  one.respond({0, d}, {elastic + 3e-4, d}), one.accept();
  EXPECT_NEAR(one.dissipated({elastic + 3e-4, d}, one.memory), bound * 3e-4, 1e-12 * bound);
  EXPECT_NEAR(one.stored({elastic + 3e-4, d}, one.memory), 0.5 * bound * elastic + 0.5 * K_n * d * d, 1e-12);
}

TEST(CoulombShear, SubstepsAgreeUnderConstantPressure) {
  const double d = -1e-4;
  Probe whole(springs("coulomb"), 2), parts(springs("coulomb"), 2);
  whole.go({0, 0}, {0, d}), parts.go({0, 0}, {0, d});
  std::vector<double> from{0, d};
  for (const double to : {1e-3, -2e-4, 3e-5, 4e-4}) {
    const double once = whole.go(from, {to, d});
    double sum = 0;
    for (int i = 0; i < 100; ++i)
      sum += parts.go({from[0] + (to - from[0]) * i / 100, d}, {i == 99 ? to : from[0] + (to - from[0]) * (i + 1) / 100, d});
    EXPECT_NEAR(sum, once, 1e-11 * std::abs(once));
    from[0] = to;
  }
}

TEST(CoulombShear, StaysInsideItsConeWhateverHappens) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  Probe one(springs("coulomb"), 3);
  std::vector<double> from{0, 0, 0};
  int slips = 0, opens = 0;
  for (int step = 0; step < 2000; ++step) {
    const std::vector<double> to{from[0] + 3e-4 * u(random), from[1] + 3e-4 * u(random), 1e-4 * (u(random) - 0.7)};
    const double before = one.dissipated(from, one.memory);
    one.mean(from, to);
    const double mean_bound = -mu * std::min(one.traction[2], 0.0), bound = -mu * std::min(one.end[2], 0.0);
    EXPECT_LE(std::hypot(one.traction[0], one.traction[1]), mean_bound * (1 + 1e-12) + 1e-9);
    EXPECT_LE(std::hypot(one.end[0], one.end[1]), bound * (1 + 1e-12) + 1e-9);
    one.respond(from, to);
    EXPECT_LE(std::hypot(one.traction[0], one.traction[1]), -mu * std::min(one.traction[2], 0.0) * (1 + 1e-12) + 1e-9);
    one.go(from, to);
    slips += one.dissipated(to, one.memory) > before;
    opens += to[2] > 0;
    from = to;
  }
  EXPECT_GT(slips, 1000);
  EXPECT_GT(opens, 100);
}

TEST(CoulombShear, SlidesAlongACurvedPathAsFineSteppingDoes) {
  // In 3D the average over a bent slip is that of its ends: error of second order in the angle turned per step.
  const double d = -1e-4, bound = mu * 1e5;
  std::vector<double> errors;
  const auto turn = [&](int steps) {
    Probe one(springs("coulomb"), 3);
    one.go({0, 0, 0}, {0, 0, d});
    one.go({0, 0, d}, {1e-2, 0, d});  // slides along x
    double work = 0;
    std::vector<double> from{1e-2, 0, d};
    for (int i = 1; i <= steps; ++i) {
      const double angle = 1.5 * i / steps;
      const std::vector<double> to{1e-2 * std::cos(angle), 1e-2 * std::sin(angle), d};
      work += one.go(from, to);
      from = to;
    }
    return work;
  };
  const double exact = turn(20000);
  EXPECT_NEAR(exact, bound * 1.5e-2, 0.02 * exact) << "force bound times path length, but for the first turn of the elastic part";
  EXPECT_NEAR(turn(500), exact, 2e-3 * exact);
}

TEST(CoulombShear, CohesionIsLostWithDamage) {
  const double F_u = 1e5, G_f = 100, cohesion = 5e4;
  Probe one(make_law("sdm", {{"K_n", K_n},
                             {"F_u", F_u},
                             {"G_f", G_f},
                             {"F_c", -2e4},
                             {"tangential", "coulomb"},
                             {"K_t", K_t},
                             {"friction", mu},
                             {"cohesion", cohesion}}),
            2);
  EXPECT_NEAR(one.respond({0, 0}, {1, 0})[0], cohesion, 1e-9) << "whole";
  one.go({0, 0}, {0, 5e-4});
  const double damage = 1 - std::exp(-F_u * one.memory[0] / G_f);
  EXPECT_NEAR(one.respond({0, 5e-4}, {1, 5e-4})[0], cohesion * (1 - damage), 1e-9 * cohesion) << "cracked and open";
  one.go({0, 5e-4}, {0, -1e-3});
  EXPECT_NEAR(one.respond({0, -1e-3}, {1, -1e-3})[0], cohesion * (1 - damage) + mu * K_n * 1e-3, 1e-9 * mu * K_n * 1e-3)
      << "closed: the bond does not heal";
  // springs never had a bond: cohesion acts in contact
  Probe base(springs("coulomb", cohesion), 2);
  EXPECT_EQ(base.respond({0, 0}, {1, 1e-6})[0], 0);
  EXPECT_NEAR(base.respond({0, 0}, {1, -1e-4})[0], cohesion + mu * 1e5, 1e-9 * cohesion);
}

}  // namespace
}  // namespace uplift::tangential_test
