#include <gtest/gtest.h>

#include <cmath>

#include "unit/laws/laws_support.h"

// The SDM law where law_sdm_test.cpp of the verification has no case: no strength, no jump-back, initial openings, messages.
namespace uplift::sdm_test {
using namespace law_test;
namespace {

TEST(Sdm, SnapBackIsRefusedWithTheInequalityAndBothNumbers) {
  try {
    make_law("sdm", {{"K_n", 1e8}, {"F_u", 1e5}, {"G_f", 100.0}, {"F_c", -1e4}});
    FAIL() << "K_n = F_u^2/G_f must be refused";
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "case.toml:7: law.K_n: expected K_n > F_u^2/G_f = 1e+08 Pa/m, else the law snaps back (a softer joint releases more energy "
        "than G_f takes), "
        "found 1e+08 Pa/m");
  }
  EXPECT_NO_THROW(make_law("sdm", {{"K_n", 1.0001e8}, {"F_u", 1e5}, {"G_f", 100.0}, {"F_c", -1e4}}));
}

TEST(Sdm, JustAboveSnapBackStillHasOneRoot) {
  // F_u^2/(K G_f) = 1 - 1e-9: the traction falls almost vertically at onset
  Probe one(make_law("sdm", {{"K_n", 1e8 / (1 - 1e-9)}, {"F_u", 1e5}, {"G_f", 100.0}, {"F_c", -1e4}}), 1);
  const double onset = 1e5 / 1e8 * (1 - 1e-9);
  for (double d = onset * (1 + 1e-6); d < 1; d *= 1.3) {
    const double t = one.respond({0}, {d})[0], j = one.now[0];
    EXPECT_NEAR(t, 1e5 * std::exp(-1e3 * j), 1e-7 * 1e5) << d;
    EXPECT_LT(t, 1e5);
    EXPECT_LT(one.slope[0], 0);
  }
}

TEST(Sdm, WithoutStrengthTheJumpFollowsTheOpening) {
  Probe one(make_law("sdm", {{"K_n", 1e9}, {"F_u", 0.0}, {"G_f", 100.0}, {"F_c", -2e4}}), 1);
  EXPECT_EQ(one.respond({0}, {1e-3})[0], 0);
  EXPECT_EQ(one.slope[0], 0);
  EXPECT_EQ(one.now[0], 1e-3);
  EXPECT_EQ(one.go({0}, {1e-3}), 0);
  EXPECT_EQ(one.dissipated({1e-3}, one.memory), 0);
  // closing gives the closure branch of that jump, t = K (d - j)/(1 + K j/|F_c|)
  EXPECT_NEAR(one.mean({1e-3}, {4e-4})[0], 0.5 * 1e9 * (4e-4 - 1e-3) / (1 + 1e9 * 1e-3 / 2e4), 1e-12 * 2e4);
  EXPECT_EQ(one.now[0], 1e-3);
  // from compression to beyond the jump: the compressed part and the closure count, the opening beyond does not
  const double compressed = -0.5 * 1e9 * (4e-8 - 4e-10), closing = -0.5 * 2e4 * (1e-3 + 2e-5);
  EXPECT_NEAR(one.go({-2e-4}, {3e-3}), compressed + closing, 1e-12 * 20);
}

TEST(Sdm, TheLimitOfTheUnilateralGap) {
  // |F_c| -> 0: t = 0 for 0 <= d <= j, K d below
  Probe one(make_law("sdm", {{"K_n", 1e9}, {"F_u", 1e5}, {"G_f", 100.0}, {"F_c", -1e-6}}), 1);
  one.memory = {1e-3};
  for (const double d : {1e-5, 5e-4, 9.99e-4}) EXPECT_NEAR(one.respond({0}, {d})[0], 0, 1e-6);
  EXPECT_NEAR(one.respond({0}, {-1e-4})[0], -1e5, 1e-6);
  EXPECT_NEAR(one.mean({9e-4}, {-1e-4})[0] * -1e-3, 0.5 * 1e9 * 1e-8, 1e-8);
}

TEST(Sdm, AnInitialOpeningBeyondTheThresholdStartsWithItsJump) {
  // An initial gap of 1 mm: nothing pulls it shut
  Probe one(make_law("sdm", {{"K_n", 1e9}, {"F_u", 1e5}, {"G_f", 100.0}, {"F_c", -2e4}}), 1),
      opened(make_law("sdm", {{"K_n", 1e9}, {"F_u", 1e5}, {"G_f", 100.0}, {"F_c", -2e4}}), 1);
  opened.go({0}, {1e-3});
  for (const double to : {9e-4, -1e-4, 1.2e-3}) {
    EXPECT_NEAR(one.mean({1e-3}, {to})[0], opened.mean({1e-3}, {to})[0], 1e-12 * 1e5) << to;
    EXPECT_NEAR(one.end[0], opened.end[0], 1e-12 * 1e5);
    EXPECT_NEAR(one.respond({1e-3}, {to})[0], opened.respond({1e-3}, {to})[0], 1e-12 * 1e5);
    EXPECT_NEAR(one.now[0], opened.now[0], 1e-15);
  }
}

TEST(Sdm, BondedShearIsThePapersCaseAndTheStandard) {
  Probe one(make_law("sdm", {{"K_n", 1e9}, {"F_u", 1e5}, {"G_f", 100.0}, {"F_c", -2e4}}), 2);
  EXPECT_EQ(one.respond({0, 0}, {1e-4, 5e-3})[0], 1e5);  // elastic although wide open, with K_t = K_n
  EXPECT_EQ(one.slope_at(0, 0), 1e9);
  EXPECT_EQ(one.slope_at(0, 1), 0);
}

TEST(Catalog, HoldsEveryPartOnceAndWithoutTwins) {
  EXPECT_EQ(law_catalog().size() + cone_catalog().size(), interface_behaviours().size());
  for (std::size_t i = 0; i < interface_behaviours().size(); ++i) {
    const PartInfo& info = *interface_behaviours()[i];
    EXPECT_FALSE(info.summary.empty());
    EXPECT_FALSE(info.equations.empty());
    EXPECT_FALSE(info.source.empty());
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(info.name, interface_behaviours()[j]->name);
  }
}

}  // namespace
}  // namespace uplift::sdm_test
