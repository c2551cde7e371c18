// Criteria of the verdict: met or not on a rigid strip on Winkler springs, and what is refused.
#include "uplift/verdict/criteria.h"

#include "unit/verdict/strip_support.h"

namespace uplift::criteria_test {
namespace {

using namespace support;
using namespace winkler_strip;

std::string with_criterion(const std::string& lines) {
  return strip("[[verdict.criterion]]\n" + lines);
}
std::string refusal_of(const std::string& lines) {
  try {
    built_of(with_criterion(lines));
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(VerdictCriteria, MetOrNot) {
  const auto state = [](const std::string& quantity, const std::string& limit, RunStatus status = RunStatus::completed) {
    const BuiltCase built = built_of(with_criterion("quantity = \"" + quantity + "\"\nlimit = " + limit + "\nsource = \"client\"\n"));
    RunResult run = run_of({turned(built, 0), turned(built, 2)}, 0.1);
    run.status = status;
    const VerdictNumbers numbers = numbers_of(built, run, nullptr);
    EXPECT_EQ(numbers.criteria.size(), 1);
    EXPECT_EQ(numbers.criteria.at(0).criterion.source, "client");
    return numbers.criteria.at(0).state;
  };
  using Result = CriterionResult::State;
  // uplifted share 0.293; gap 2 b theta 0.293 = 1.95 mm; W b/M = 3/(3 - sqrt 2) = 1.89
  EXPECT_EQ(state("max_uplifted_ratio", "0.3"), Result::met);
  EXPECT_EQ(state("max_uplifted_ratio", "\"25 %\""), Result::not_met);
  EXPECT_EQ(state("max_opening", "\"2 mm\""), Result::met);
  EXPECT_EQ(state("max_opening", "0.0019"), Result::not_met);
  EXPECT_EQ(state("min_overturning_safety", "1.5"), Result::met);
  EXPECT_EQ(state("min_overturning_safety", "2"), Result::not_met);
  EXPECT_EQ(state("min_sliding_safety", "1.1"), Result::undetermined);  // nothing pushes
  EXPECT_EQ(state("longest_full_loss", "\"0.1 s\""), Result::met);
  EXPECT_EQ(state("max_impulse", "\"1 N s\""), Result::met);     // springs have no impacts of constraints
  EXPECT_EQ(state("first_uplift", "\"0.05 s\""), Result::met);   // it opens at the second instant, at 0.1 s: later than asked
  EXPECT_EQ(state("first_uplift", "\"2 s\""), Result::not_met);  // earlier than asked
  EXPECT_EQ(state("max_opening", "\"2 mm\"", RunStatus::interrupted), Result::undetermined);
  EXPECT_EQ(state("max_opening", "\"1 mm\"", RunStatus::interrupted), Result::not_met);
}

/// A base that never opens keeps any limit on when it may open, unless the run did not get to its end.
TEST(VerdictCriteria, FirstUpliftWithoutUplift) {
  const BuiltCase built = built_of(with_criterion("quantity = \"first_uplift\"\nlimit = \"2 s\"\nsource = \"client\"\n"));
  RunResult run = run_of({turned(built, 0), turned(built, 0.5)}, 0.1);
  run.status = RunStatus::completed;
  EXPECT_EQ(numbers_of(built, run, nullptr).criteria.at(0).state, CriterionResult::State::met);
  run.status = RunStatus::interrupted;
  EXPECT_EQ(numbers_of(built, run, nullptr).criteria.at(0).state, CriterionResult::State::undetermined);
}

/// In the direction of what is worse for a structure: safeties, the least compression and the time until it opens must not be small.
TEST(VerdictCriteria, SideOfTheLimit) {
  std::vector<std::string> at_least;
  for (const VerdictQuantity& quantity : verdict_quantities)
    if (quantity.at_least) at_least.emplace_back(quantity.name);
  EXPECT_EQ(at_least, (std::vector<std::string>{"first_uplift", "min_overturning_safety", "min_sliding_safety", "min_compression"}));
}

TEST(VerdictCriteria, WhatIsRefused) {
  EXPECT_NE(refusal_of("quantity = \"max_uplift_ratio\"\nlimit = 0.3\nsource = \"a\"\n").find("did you mean \"max_uplifted_ratio\"?"),
            std::string::npos);
  EXPECT_NE(
      refusal_of("quantity = \"max_opening\"\nlimit = \"3 kN\"\nsource = \"a\"\n").find("limit: expected a length [m], found \"3 kN\""),
      std::string::npos);
  EXPECT_NE(refusal_of("quantity = \"max_opening\"\nlimit = 0.3\n").find("source"), std::string::npos);
  EXPECT_NE(refusal_of("quantity = \"max_opening\"\nlimit = 0.3\nsource = \" \"\n").find("where the limit comes from"), std::string::npos);
  EXPECT_NE(refusal_of("quantity = \"max_opening\"\nlimit = true\nsource = \"a\"\n").find("a number, or a text with a number and its unit"),
            std::string::npos);
  EXPECT_NE(refusal_of("quantity = \"max_opening\"\nlimit = 1\nsource = \"a\"\ninterface = \"soli\"\n").find("did you mean \"soil\"?"),
            std::string::npos);
  EXPECT_NE(refusal_of("quantity = \"max_top_motion\"\nlimit = 1\nsource = \"a\"\ninterface = \"soil\"\n").find("the whole run"),
            std::string::npos);
}

TEST(VerdictCriteria, EveryQuantityIsFoundByItsName) {
  for (const VerdictQuantity& quantity : verdict_quantities) {
    EXPECT_EQ(find_verdict_quantity(quantity.name), &quantity);
    EXPECT_NE(refusal_of("quantity = \"" + std::string(quantity.name) + "\"\nlimit = \"1 furlong2\"\nsource = \"a\"\n"), "");
    EXPECT_EQ(refusal_of("quantity = \"" + std::string(quantity.name) + "\"\nlimit = 1\nsource = \"a\"\n") == "",
              !quantity.of_beam());  // beams need an envelope
  }
}

}  // namespace
}  // namespace uplift::criteria_test
