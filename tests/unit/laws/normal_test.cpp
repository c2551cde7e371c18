#include <gtest/gtest.h>

#include <cmath>

#include "unit/laws/laws_support.h"

// Springs, elastic and cohesive laws against closed forms.
namespace uplift::normal_test {
using namespace law_test;
namespace {

// ---- tensionless springs ----

TEST(Springs, PushInContactOnly) {
  Probe one(make_law("springs", {{"K_n", 2e8}}), 1);
  EXPECT_EQ(one.law().num_history(1), 0);
  EXPECT_EQ(one.respond({0}, {-1e-3})[0], -2e5);
  EXPECT_EQ(one.slope[0], 2e8);
  EXPECT_EQ(one.respond({0}, {1e-3})[0], 0);
  EXPECT_EQ(one.slope[0], 0);
  // average over a path that leaves contact half way: the triangle's area over the whole way
  EXPECT_NEAR(one.mean({-1e-3}, {1e-3})[0], -0.5 * 2e5 * 0.5, 1e-10);
  EXPECT_NEAR(one.mean({1e-3}, {-1e-3})[0], -0.5 * 2e5 * 0.5, 1e-10);
  EXPECT_NEAR(one.mean({3e-3}, {-1e-3})[0], -0.5 * 2e5 * 0.25, 1e-10);
  EXPECT_NEAR(one.stored({-1e-3}, {}), 100, 1e-12);
  EXPECT_EQ(one.stored({1e-3}, {}), 0);
}

TEST(Springs, SlopeOfTheAverageHasItsClosedForm) {
  // mean(d1) = K d1^2/(2 (d1 - d0)) for d1 < 0 < d0
  Probe one(make_law("springs", {{"K_n", 2e8}}), 1);
  const double d0 = 2e-3, d1 = -1e-3, way = d1 - d0;
  one.mean({d0}, {d1});
  EXPECT_NEAR(one.slope[0], 2e8 * (d1 / way - 0.5 * d1 * d1 / (way * way)), 1e-12 * 2e8);
  for (const double tiny : {1e-9, 1e-15, 1e-19, 1e-250}) {
    one.mean({-1e-3}, {-1e-3 - tiny});
    EXPECT_NEAR(one.traction[0], -2e5, 1e-3 + 2e8 * tiny);
    EXPECT_NEAR(one.slope[0], 1e8, 1e-4);
  }
}

TEST(Springs, SdmWithoutStrengthIsEquivalentUpToItsClosureStress) {
  const double k = 2e8;
  const auto springs = make_law("springs", {{"K_n", k}});
  const auto other = springs->equivalent();
  ASSERT_TRUE(other.has_value());
  std::vector<Parameter> parameters{{"K_n", k}};
  double closure = 0;
  for (const auto& [key, value] : other->parameters) {
    parameters.emplace_back(std::string(key), value);
    if (key == "F_c") closure = -value;
  }
  const auto sdm = make_law(std::string(other->name), parameters);
  Probe one(springs, 1), two(sdm, 1);
  double from = 0;
  for (const double to : {-1e-3, 2e-3, -5e-4, 1e-5, -1e-9, -1e-3, 4e-3, 3e-3, -2e-3}) {
    EXPECT_NEAR(one.respond({from}, {to})[0], two.respond({from}, {to})[0], closure * (1 + 1e-9)) << from << " to " << to;
    one.accept(), two.accept();
    from = to;
  }
  EXPECT_LE(closure, 1e-3 * k * 1e-3) << "small beside the pressures of this path";
  ASSERT_TRUE(sdm->equivalent().has_value());
  EXPECT_EQ(sdm->equivalent()->name, "springs");
  EXPECT_FALSE(make_law("springs", {{"K_n", k}, {"c", 1e5}})->equivalent()) << "no other law has its dashpot";
  EXPECT_FALSE(make_law("sdm", {{"K_n", k}, {"F_u", 1e3}, {"G_f", 0.1}, {"F_c", -20.0}})->equivalent()) << "springs have no strength";
}

TEST(Springs, DashpotActsInContactAndNeverPulls) {
  const double k = 2e8, c = 1e6, step = 1e-3;
  Probe one(make_law("springs", {{"K_n", k}, {"c", c}}), 1, 1, step);
  ASSERT_EQ(one.law().num_history(1), 1);
  // closing within contact: t = K d + c r
  const double r = -2e-5 / step;
  EXPECT_NEAR(one.respond({-1e-4}, {-1.2e-4})[0], k * -1.2e-4 + c * r, 1e-9);
  EXPECT_NEAR(one.slope[0], k + c / step, 1e-3);
  EXPECT_NEAR(one.mean({-1e-4}, {-1.2e-4})[0], k * -1.1e-4 + c * r, 1e-9);
  EXPECT_NEAR(one.slope[0], 0.5 * k + c / step, 1e-3);
  // parting fast: the force ends at d = -c r/K before the spring is free, and stays zero
  const double fast = 3e-4 / step, knee = -c * fast / k;
  ASSERT_LT(knee, -1e-4);
  EXPECT_EQ(one.respond({-1e-4}, {2e-4})[0], 0);
  EXPECT_EQ(one.mean({-1e-4}, {2e-4})[0], 0);
  EXPECT_NEAR(one.dissipated({2e-4}, one.now), 0.5 * k * 1e-8, 1e-12) << "all that the spring held goes to the dashpot";
  // parting more slowly: trapezium down to zero at the knee
  const double slow = 1e-5 / step, at = -c * slow / k, deep = -1e-3, to = deep + 1e-5;
  ASSERT_LT(to, at);
  EXPECT_NEAR(one.mean({deep}, {to})[0], k * 0.5 * (deep + to) + c * slow, 1e-9);
  // statics: no rate
  one.batch.step = 0;
  EXPECT_EQ(one.respond({0}, {-1e-3})[0], -2e5);
  EXPECT_EQ(one.mean({0}, {-1e-3})[0], -1e5);
}

TEST(Springs, DashpotOfADampedImpactTakesTheRightEnergy) {
  // In and out again at constant speed v: inwards c v d is lost beside the spring; outwards the spring gives back K (d - knee)^2/2 in
  // contact.
  const double k = 2e8, c = 1e4, v = 0.01, step = 1e-3, depth = 1e-4;
  Probe one(make_law("springs", {{"K_n", k}, {"c", c}}), 1, 1, step);
  double work = 0, from = 2e-5;
  const double move = v * step;
  for (int i = 0; i < 12; ++i) work += one.go({from}, {from - move}), from -= move;
  ASSERT_NEAR(from, -depth, 1e-15);
  EXPECT_NEAR(work, 0.5 * k * depth * depth + c * v * depth, 1e-12);
  for (int i = 0; i < 12; ++i) work += one.go({from}, {from + move}), from += move;
  const double knee = c * v / k, returned = 0.5 * k * (depth - knee) * (depth - knee);
  EXPECT_NEAR(work, 0.5 * k * depth * depth + c * v * depth - returned, 1e-12);
  EXPECT_NEAR(one.dissipated({from}, one.memory), work, 1e-12);
}

// ---- elastic ----

TEST(Elastic, HoldsTensionAndShear) {
  Probe one(make_law("elastic", {{"K_n", 1e9}, {"K_t", 3e8}}), 3);
  const auto& t = one.mean({0, 0, 0}, {1e-4, -2e-4, 5e-4});
  EXPECT_NEAR(t[0], 0.5 * 3e4, 1e-9);
  EXPECT_NEAR(t[1], -0.5 * 6e4, 1e-9);
  EXPECT_NEAR(t[2], 0.5 * 5e5, 1e-9);
  EXPECT_NEAR(one.end[2], 5e5, 1e-9);
  EXPECT_NEAR(one.stored({1e-4, -2e-4, 5e-4}, {}), 0.5 * (3e8 * 5e-8 + 1e9 * 25e-8), 1e-12);
}

TEST(Elastic, DashpotActsInTensionToo) {
  const double k = 2e8, c = 1e6, step = 1e-3;
  Probe one(make_law("elastic", {{"K_n", k}, {"c", c}}), 1, 1, step);
  ASSERT_EQ(one.law().num_history(1), 1);
  for (const double from : {-1e-4, 1e-4}) {
    const double to = from + 2e-5, r = 2e-5 / step;
    EXPECT_NEAR(one.respond({from}, {to})[0], k * to + c * r, 1e-9);
    EXPECT_NEAR(one.slope[0], k + c / step, 1e-3);
    EXPECT_NEAR(one.mean({from}, {to})[0], k * 0.5 * (from + to) + c * r, 1e-9);
    EXPECT_NEAR(one.slope[0], 0.5 * k + c / step, 1e-3);
    EXPECT_NEAR(one.dissipated({to}, one.now), c * r * 2e-5, 1e-12) << "force c r over the way";
  }
  one.batch.step = 0;
  EXPECT_EQ(one.respond({0}, {1e-3})[0], 2e5) << "statics: no rate";
}

// ---- cohesive laws ----

constexpr double K = 1e10, F = 1e5, G = 80;

TEST(Bilinear, EnvelopeUnloadingAndFractureEnergy) {
  Probe one(make_law("bilinear", {{"K_n", K}, {"F_u", F}, {"G_f", G}}), 1);
  const double onset = F / K, last = 2 * G / F;
  EXPECT_NEAR(one.respond({0}, {0.5 * onset})[0], 0.5 * F, 1e-9);
  const double d = 5e-4, t = F * (last - d) / (last - onset);
  EXPECT_NEAR(one.respond({0}, {d})[0], t, 1e-9);
  EXPECT_NEAR(one.slope[0], -F / (last - onset), 1e-3);
  one.accept();
  EXPECT_NEAR(one.respond({d}, {0.3 * d})[0], 0.3 * t, 1e-9) << "secant to the origin";
  EXPECT_NEAR(one.respond({d}, {-1e-6})[0], -K * 1e-6, 1e-9) << "compression stays stiff";
  EXPECT_NEAR(one.respond({d}, {2e-3})[0], 0, 1e-9);
  Probe other(make_law("bilinear", {{"K_n", K}, {"F_u", F}, {"G_f", G}}), 1);
  EXPECT_NEAR(other.go({-1e-5}, {1}), G - 0.5 * K * 1e-10, 1e-12 * G);
  EXPECT_NEAR(other.dissipated({1}, other.memory), G, 1e-13 * G);
}

TEST(Exponential, EnvelopeUnloadingAndFractureEnergy) {
  Probe one(make_law("exponential", {{"K_n", K}, {"F_u", F}, {"G_f", G}}), 1);
  const double onset = F / K, rate = F / (G - 0.5 * F * onset), d = 5e-4, t = F * std::exp(-rate * (d - onset));
  EXPECT_NEAR(one.respond({0}, {d})[0], t, 1e-9);
  EXPECT_NEAR(one.slope[0], -rate * t, 1e-3);
  one.accept();
  EXPECT_NEAR(one.respond({d}, {0.3 * d})[0], 0.3 * t, 1e-9);
  EXPECT_NEAR(one.respond({d}, {-1e-6})[0], -K * 1e-6, 1e-9);
  Probe other(make_law("exponential", {{"K_n", K}, {"F_u", F}, {"G_f", G}}), 1);
  EXPECT_NEAR(other.go({0}, {1}), G, 1e-12 * G);
  EXPECT_NEAR(other.dissipated({1}, other.memory), G, 1e-13 * G);
  // the energy of a partial opening: area under the envelope less the secant's triangle, by quadrature
  const auto envelope = [&](double x) { return x < onset ? K * x : F * std::exp(-rate * (x - onset)); };
  const double area = 0.5 * F * onset + integral(envelope, onset, d, 1e-14);
  EXPECT_NEAR(one.dissipated({d}, one.memory), area - 0.5 * t * d, 1e-11 * G);
}

TEST(Cohesive, TooLittleFractureEnergyIsRefused) {
  for (const char* name : {"bilinear", "exponential"}) {
    try {
      make_law(name, {{"K_n", 1e8}, {"F_u", 1e5}, {"G_f", 50.0}});
      FAIL() << "G_f = F_u^2/(2 K_n) must be refused";
    } catch (const InputError& error) {
      EXPECT_STREQ(
          error.what(),
          "case.toml:7: law.G_f: expected G_f > F_u^2/(2 K_n) = 50 J/m2, the energy stored when the strength is reached, found 50 J/m2");
    }
  }
}

TEST(Cohesive, AnInitialOpeningBeyondTheMemoryStartsOnTheEnvelope) {
  for (const char* name : {"bilinear", "exponential"}) {
    const auto law = make_law(name, {{"K_n", K}, {"F_u", F}, {"G_f", G}});
    Probe one(law, 1), opened(law, 1);
    opened.go({0}, {4e-4});
    for (const double to : {1e-4, -1e-5, 6e-4}) {
      EXPECT_NEAR(one.mean({4e-4}, {to})[0], opened.mean({4e-4}, {to})[0], 1e-12 * F);
      EXPECT_EQ(one.now[0], std::max(4e-4, to));
    }
  }
}

TEST(Cohesive, TinySofteningStepsLoseNoDigits) {
  for (const char* name : {"bilinear", "exponential"}) {
    for (double length = 1e-5; length > 1e-18; length /= 9) {
      Probe one(make_law(name, {{"K_n", K}, {"F_u", F}, {"G_f", G}}), 1);
      const double start = 4e-4, to = start + length;
      if (to == start) break;
      one.respond({0}, {start});
      const double t0 = one.traction[0], tangent = one.slope[0];
      one.accept();
      one.mean({start}, {to});
      EXPECT_NEAR(one.traction[0], t0 + 0.5 * tangent * (to - start), t0 * (1e-14 + 1e6 * length * length)) << name << " " << length;
      EXPECT_NEAR(one.slope[0], 0.5 * tangent, std::abs(tangent) * (1e3 * length + 1e-6)) << name << " " << length;
    }
  }
}

}  // namespace
}  // namespace uplift::normal_test
