#include "uplift/verdict/verdict.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "unit/verdict/strip_support.h"
#include "uplift/base/format.h"
#include "uplift/model/builder.h"
#include "uplift/verdict/compare.h"

namespace uplift::verdict_test {
namespace {

TEST(Wording, SaysNumbersAsEngineersDo) {
  EXPECT_EQ(format_quantity(0.0358759, "m"), "35.9 mm");
  EXPECT_EQ(format_quantity(0.5, "s"), "0.500 s");
  EXPECT_EQ(format_quantity(1.368543e6, "N m"), "1.37 MN m");
  EXPECT_EQ(format_quantity(-2.5e3, "N"), "-2.50 kN");
  EXPECT_EQ(format_quantity(0, "m"), "0 m");
  EXPECT_EQ(format_quantity(999999.9, "N"), "1.00 MN");
  EXPECT_EQ(format_quantity(3.2e-5, "m"), "0.0320 mm");
  EXPECT_EQ(percent(0.686923), "69 %");
  EXPECT_EQ(percent(0.0123), "1.2 %");
  EXPECT_EQ(percent(1.5e-6), "0.00015 %");
  EXPECT_EQ(percent(46), "46 times");
  EXPECT_EQ(percent(0.625), "63 %");  // a half is rounded away from zero, everywhere
  EXPECT_EQ(percent(0.0996), "10 %");
  EXPECT_EQ(format_change(0.5), "+50 %");
  EXPECT_EQ(format_change(-0.37), "-37 %");
  EXPECT_EQ(format_change(1.4), "+140 %");
  EXPECT_EQ(format_change(11), "12.0 times as large");
  EXPECT_EQ(format_change(1e-5), "unchanged");
  EXPECT_EQ(format_quantity(9.81, "m/s2"), "9.81 m/s²");
  EXPECT_EQ(format_unit("kg/m3"), "kg/m³");
  EXPECT_EQ(format_unit("N m"), "N m");
}

Request request(Request::Kind kind, const char* name, const char* unit, int unknown = 0) {
  Request made;
  made.kind = kind;
  made.name = name;
  made.unit = unit;
  made.unknown = unknown;
  return made;
}

/// A footing of half width 1.5 m under 1 MN that carries up to `moment`.
RunResult result_with(double moment, double ratio) {
  RunResult run;
  run.columns = {request(Request::Kind::axial, "soil.axial", "N"), request(Request::Kind::moment, "soil.moment", "N m"),
                 request(Request::Kind::displacement, "top.ux", "m", 0)};
  run.table = {{0, 1}, {-1e6, -1e6}, {0, moment}, {0, 0.02}};
  run.peaks = {{"soil.axial", "N", -1e6, 0}, {"soil.moment", "N m", moment, 1}, {"top.ux", "m", 0.02, 1}};
  run.combined = {{.value = 0.02, .time = 1, .least = {0}, .most = {0.02}, .known = true}};
  run.max_base_moment = {"", "N m", moment, 1};
  run.max_uplifted_ratio = {"", "1", ratio, 0.7};
  run.max_opening = {"", "m", ratio > 0 ? 0.013 : 0, 0.7};
  run.energy_scale = 1e4;
  run.counts.steps = 1;
  run.end_time = 1;
  return run;
}

BuiltCase footing() {
  BuiltCase built;
  built.model.nodes = {{"top", Vec2(0, 5)}};
  built.top = 0;
  built.plan.combined = {{.name = "top", .components = {{}}}};
  InterfaceFacts& facts = built.facts.emplace_back();
  facts.name = "soil", facts.body = "base", facts.friction = 0.5, facts.area = 3;
  built.constant_loads = {{.all = {1e6, {}}, .weight = {1e6, {}}}};
  built.plan.stages.emplace_back().type = Stage::Type::dynamics;
  return built;
}

const Verdict::Fact* fact(const Verdict& verdict, const std::string& label) {
  for (const Verdict::Fact& each : verdict.facts)
    if (each.label == label) return &each;
  return nullptr;
}

TEST(VerdictTest, SaysWhetherItUplifts) {
  const BuiltCase built = footing();
  EXPECT_EQ(judge(built, result_with(3e5, 0), nullptr).level, Verdict::Level::none);
  const Verdict uplifts = judge(built, result_with(1.2e6, 0.6), nullptr);
  EXPECT_EQ(uplifts.level, Verdict::Level::uplift);
  EXPECT_EQ(uplifts.headline, "The base uplifts: up to 60 % of its area, by up to 13.0 mm");
}

BuiltCase strip() {
  return support::built_of(winkler_strip::strip("", "5", ""));
}

TEST(VerdictTest, SaysTheSafeties) {
  const BuiltCase built = strip();
  const RunResult run =
      support::run_of({support::view_of({.axial = -1e6}), support::view_of({.axial = -1e6, .shear = 2.4e5, .moment = 1.2e6}, 0.7)}, 0.5);
  const Verdict verdict = judge(built, run, nullptr);
  ASSERT_NE(fact(verdict, "Safety against overturning"), nullptr);
  EXPECT_EQ(fact(verdict, "Safety against overturning")->value, "1.25");
  EXPECT_EQ(fact(verdict, "Safety against sliding")->value, "2.50");
  EXPECT_EQ(fact(verdict, "Eccentricity e/B")->value, "0.400");
  EXPECT_EQ(fact(verdict, "Eccentricity e/B")->detail, "largest of M/N over the width, at 0.500 s");
}

TEST(VerdictTest, SaysWhatATensionRatioHides) {
  const BuiltCase built = strip();
  InterfaceView pulled = support::view_of({.axial = -1e6, .moment = 1.25e6});
  pulled.tension_area = 0.3;
  RunResult run = support::run_of({support::view_of({.axial = -1e6}), support::view_of({.axial = -1e6}, 0.4)}, 0.5),
            bonded = support::run_of({support::view_of({.axial = -1e6}), pulled}, 0.5);
  run.max_uplifted_ratio.value = 0.4;
  const Verdict verdict = judge(built, run, &bonded);
  const std::string said =
      "A linear analysis finds tension on 30 % of the base. By equal energy this corresponds to an uplift of 40 % (strip on Winkler "
      "springs); "
      "40 % "
      "was computed.";
  EXPECT_NE(std::ranges::find(verdict.paragraphs, said), verdict.paragraphs.end());
}

TEST(VerdictTest, TheHeadlineSaysWhatTheUpliftDoes) {
  const BuiltCase built = strip();
  const auto turned = [](double moment, double share) {
    RunResult run = support::run_of({support::view_of({.axial = -1e6}), support::view_of({.axial = -1e6, .moment = moment}, share)}, 0.5);
    run.max_uplifted_ratio.value = share;
    return run;
  };
  const RunResult bonded = turned(2e6, 0);
  const Verdict verdict = judge(built, turned(-1.2e6, 0.4), &bonded);
  EXPECT_TRUE(verdict.headline.starts_with("The base uplifts: up to 40 % of its area")) << verdict.headline;
  EXPECT_EQ(verdict.consequence, "Compared with the bonded model: base moment -40 %.");

  FloorRun floors;
  FloorChange change;
  change.bands = {{{0, 2}, -0.031, 1, 1}, {{2, {}}, 0.12, 1, 1}};
  floors.beside = {{change}};
  EXPECT_EQ(judge(built, turned(-1.2e6, 0.4), &bonded, &floors).consequence,
            "Compared with the bonded model: base moment -40 %, floor spectra -3.1 to +12 %.");
  EXPECT_TRUE(judge(built, turned(-1.2e6, 0.4), nullptr).consequence.empty());
}

TEST(VerdictTest, NumbersNoFinerThanTheyStillMove) {
  EXPECT_EQ(format_quantity_within(9.83e-7, 2.17e-5, "rad"), "0.001 mrad");
  EXPECT_EQ(format_quantity_within(2.17e-5, 2.17e-5, "rad"), "0.022 mrad");
  EXPECT_EQ(format_quantity_within(-4.5e-6, 1.16e-4, "m"), "0.00 mm");                // no "-0.00"
  EXPECT_EQ(format_quantity_within(5.326e-4, 1e-9, "m"), "0.533 mm");                 // three digits are enough
  EXPECT_EQ(format_quantity_within(0.12345, 0, "m"), format_quantity(0.12345, "m"));  // nothing moves
  EXPECT_EQ(format_quantity(9.83e-7, "rad"), "0.000983 mrad");
}

TEST(VerdictTest, NothingIsSaidAsZeroAndSharesInPercent) {
  const auto words = [](QuantityName name, double value) { return format_value(*name, value); };
  EXPECT_EQ(words("residual_rotation", 6.9e-20), "0 rad");
  EXPECT_EQ(words("max_uplifted_ratio", 0.236), "24 %");
  EXPECT_EQ(words("change_of_compression", 1.07e-4), "0.01 %");
  EXPECT_EQ(words("change_of_compression", -3e-6), "0 %");
  EXPECT_EQ(words("change_of_compression", 11.2), "1.12e+03 %");
  for (const VerdictQuantity& quantity : verdict_quantities) {
    EXPECT_FALSE(quantity.brief.empty()) << quantity.name;
    EXPECT_LE(quantity.brief.size(), 28u) << quantity.name;  // tables of a terminal
  }
}

TEST(VerdictTest, TheTopIsJudgedInBothDirectionsOfSpace) {
  const BuiltCase built = support::built_of(R"(
title = "t"
[nodes]
base = [0, 0, 0]
top = [0, 0, 3]
[[beam]]
name = "column"
nodes = ["base", "top"]
E = "30 GPa"
A = 1
I = 0.1
J = 0.2
[[mass]]
node = "top"
mass = 1000
[[support]]
node = "base"
fixed = ["ux", "uy", "uz", "rx", "ry", "rz"]
[[load]]
name = "along"
node = "top"
force = [3e3, -4e3, 1e6]
[[stage]]
type = "static"
)");
  const RunResult run = support::run_of(built);
  const std::optional<Peak> top = top_motion(built, run);
  ASSERT_TRUE(top);
  // clamped column: P l3/(3 E I) along the resultant of both pushes, whatever the larger vertical motion is
  EXPECT_NEAR(top->value, 5e3 * 27 / (3 * 30e9 * 0.1), 1e-12);
}

TEST(VerdictTest, ComparesWithTheBondedModel) {
  RunResult bonded = result_with(2.4e6, 0);
  bonded.combined[0].value = bonded.combined[0].most[0] = 0.01;
  const Verdict verdict = judge(footing(), result_with(1.2e6, 0.6), &bonded);
  std::string all;
  for (const std::string& paragraph : verdict.paragraphs) all += paragraph + "\n";
  EXPECT_NE(all.find("Compared with the bonded model, largest motion of node top: +100 % (20.0 mm instead of 10.0 mm)."), std::string::npos)
      << all;
}

TEST(VerdictTest, AFullLossOfContactStandsInTheHeadline) {
  const BuiltCase built = strip();
  RunResult run =
      support::run_of({support::view_of({.axial = -1e6}), support::view_of({}, 1), support::view_of({.axial = -1e6}, 0.2)}, 0.5);
  run.max_uplifted_ratio.value = 1;
  run.max_opening.value = 0.012;
  run.steps.extremes[0].full_loss = {{0.3, 0.625}};
  const Verdict verdict = judge(built, run, nullptr);
  EXPECT_EQ(verdict.headline, "Full loss of contact: the base has no contact for 0.325 s in total, the gap reaches 12.0 mm");
  ASSERT_NE(fact(verdict, "Full loss of contact"), nullptr);
  EXPECT_EQ(fact(verdict, "Full loss of contact")->value, "0.325 s");
  const bool explained = std::ranges::any_of(verdict.paragraphs, [](const std::string& text) { return text.find("impact") != text.npos; });
  EXPECT_TRUE(explained);
}

TEST(VerdictTest, AnOverturningExplainsItself) {
  const BuiltCase built = strip();
  RunResult run = support::run_of({support::view_of({.axial = -1e6}), support::view_of({.axial = -1e6}, 0.9)}, 0.5);
  run.status = RunStatus::overturned;
  run.reason = "base.rz passed 0.15 rad at t = 0.5 s, the limit of the small-displacement model";
  run.end_time = 0.5;
  const Verdict verdict = judge(built, run, nullptr);
  EXPECT_EQ(verdict.headline, "Overturning: the rotation exceeds 0.150 rad at 0.500 s");
  EXPECT_NE(verdict.paragraphs.front().find("limits.rotation"), std::string::npos);
}

TEST(VerdictTest, ARunThatCreatesEnergyIsNotToBeUsed) {
  RunResult run = result_with(1.2e6, 0.6);
  run.status = RunStatus::failed;
  run.reason = "energy was created";
  run.energy_created = 8e4;
  const Verdict verdict = judge(footing(), run, nullptr);
  EXPECT_EQ(verdict.level, Verdict::Level::failed);
  EXPECT_NE(verdict.paragraphs.back().find("not to be used"), std::string::npos);
}

TEST(AgreementTest, ComparesSoundRunsWithTheirMedian) {
  std::vector<RunResult> results;
  std::vector<RunSpec> specs;
  for (const double peak : {1.00, 1.01, 0.99, 1.10}) {
    RunResult run = result_with(1e6, 0.5);
    run.peaks[2].value = peak;
    results.push_back(run);
    specs.emplace_back();
  }
  results[0].peaks[2].value = -1.00;  // the sign does not matter
  const auto found = agreement(results, specs, std::deque<BuiltCase>(4), {"top.ux"}, 0.02);
  // median of 0.99, 1.00, 1.01, 1.10 is 1.005
  EXPECT_EQ(found[0].word, Agreement::Word::agrees);
  EXPECT_EQ(found[3].word, Agreement::Word::differs);
  EXPECT_NEAR(found[3].deviation, (1.10 - 1.005) / 1.005, 1e-12);
  EXPECT_EQ(found[3].column, "top.ux");
}

TEST(AgreementTest, FailedAndBondedRunsDoNotCount) {
  std::vector<RunResult> results(3, result_with(1e6, 0.5));
  std::vector<RunSpec> specs(3);
  results[1].status = RunStatus::failed;
  results[1].peaks[2].value = 1e9;
  specs[2].bonded = true;
  results[2].peaks[2].value = 5;
  std::deque<BuiltCase> built;
  for (int i = 0; i < 3; ++i) built.push_back(footing());
  const auto found = agreement(results, specs, built, {}, 0.02);
  EXPECT_EQ(found[0].word, Agreement::Word::agrees);
  EXPECT_EQ(found[0].deviation, 0);
  EXPECT_EQ(found[1].word, Agreement::Word::failed);
  EXPECT_EQ(found[2].word, Agreement::Word::not_counted);
}

/// Runs with the same motion of the top and other base moments do not agree: everything that the verdict shows is compared.
TEST(AgreementTest, ComparesEveryNumberOfTheVerdict) {
  std::deque<BuiltCase> built;
  std::vector<RunResult> results;
  for (const double moment : {1.00e6, 1.01e6, 1.30e6}) {
    built.push_back(strip());
    results.push_back(support::run_of({support::view_of({.axial = -1e6}), support::view_of({.axial = -1e6, .moment = moment}, 0.4)}, 0.5));
    results.back().end_time = 0.5;
  }
  const auto found = agreement(results, std::vector<RunSpec>(3), built, {}, 0.02);
  EXPECT_EQ(found[0].word, Agreement::Word::agrees) << found[0].column;
  EXPECT_EQ(found[2].word, Agreement::Word::differs);
  EXPECT_NEAR(found[2].deviation, (1.30 - 1.01) / 1.01, 1e-12);  // of the moment, and of e/B
}

}  // namespace
}  // namespace uplift::verdict_test
