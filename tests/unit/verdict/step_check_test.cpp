#include "uplift/verdict/step_check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "uplift/base/format.h"

namespace uplift::step_check_test {
namespace {

VerdictNumber number(QuantityName name, double value) {
  return {name, value};
}

/// One base of 4 m width.
VerdictNumbers numbers_with(std::vector<VerdictNumber> of_base, std::vector<VerdictNumber> whole = {}) {
  VerdictNumbers numbers;
  numbers.whole = std::move(whole);
  InterfaceVerdict& base = numbers.interfaces.emplace_back();
  base.name = "soil";
  base.width = {4, 0};
  base.numbers = std::move(of_base);
  return numbers;
}

StepCheck compared(VerdictNumbers& numbers, const VerdictNumbers& coarse) {
  StepCheck check;
  check.step = 1e-3, check.coarse_step = 2e-3;
  compare_steps(numbers, coarse, check);
  return check;
}

/// The change of one number of the base.
double change_of_one(QuantityName name, double value, double coarse) {
  VerdictNumbers numbers = numbers_with({number(name, value)});
  const StepCheck check = compared(numbers, numbers_with({number(name, coarse)}));
  EXPECT_EQ(numbers.interfaces.front().numbers.front().coarse, coarse);
  EXPECT_DOUBLE_EQ(numbers.interfaces.front().numbers.front().step_change.value(), check.largest);
  return check.largest;
}

TEST(StepCheck, ForcesAreRelativeToTheLargerValue) {
  EXPECT_DOUBLE_EQ(change_of_one("max_moment", 1.0e6, 1.1e6), 0.1 / 1.1);
  EXPECT_DOUBLE_EQ(change_of_one("max_moment", 1.1e6, 1.0e6), 0.1 / 1.1);
  EXPECT_DOUBLE_EQ(change_of_one("max_toe_pressure", 2e5, 2e5), 0);
}

TEST(StepCheck, SmallSharesDoNotCount) {
  EXPECT_NEAR(change_of_one("max_uplifted_ratio", 0.30, 0.33), 0.03 / 0.33, 1e-15);
  EXPECT_NEAR(change_of_one("max_uplifted_ratio", 0.001, 0.003), 0.002 / 0.1, 1e-15) << "relative to a tenth of the area";
  EXPECT_NEAR(change_of_one("max_eccentricity", 0.001, 0.002), 0.001 / 0.01, 1e-15);
}

TEST(StepCheck, DurationsAreStatedAndDecideNothing) {
  VerdictNumbers numbers = numbers_with({number("uplifted_time", 1), number("first_uplift", 0.5), number("max_penetration", 1e-4)});
  const VerdictNumbers coarse = numbers_with({number("uplifted_time", 2), number("first_uplift", 0.6), number("max_penetration", 3e-4)});
  EXPECT_EQ(compared(numbers, coarse).state, StepCheck::State::converged);
  EXPECT_EQ(numbers.interfaces.front().numbers.front().coarse, 2);
  EXPECT_FALSE(numbers.interfaces.front().numbers.front().step_change);
  EXPECT_EQ(format_step_change(numbers.interfaces.front().numbers.front()), "\u00b150 %");
  EXPECT_EQ(format_step_change(numbers.interfaces.front().numbers[1]), "\u00b10.10 s");
}

/// 89.3 % beside a limit of 90 %: a change by one point is more than the 0.7 points that are left, one by half a point is not.
TEST(StepCheck, CriteriaNearTheirLimitAreMarked) {
  const auto marked = [](double coarse) {
    VerdictNumbers numbers = numbers_with({number("max_uplifted_ratio", 0.893)});
    CriterionResult& result = numbers.criteria.emplace_back();
    result.criterion.quantity = find_verdict_quantity("max_uplifted_ratio");
    result.criterion.limit = 0.9;
    result.interface = "soil";
    result.value = 0.893;
    result.state = CriterionResult::State::met;
    compared(numbers, numbers_with({number("max_uplifted_ratio", coarse)}));
    return numbers.criteria.front().within_step_change;
  };
  EXPECT_TRUE(marked(0.903));
  EXPECT_TRUE(marked(0.883));
  EXPECT_FALSE(marked(0.898));
  EXPECT_FALSE(marked(0.893));
}

/// A number that one of the runs lacks has no change: what the other run decides counts.
TEST(StepCheck, CriteriaThatTheRunsDecideDifferentlyAreMarked) {
  using State = CriterionResult::State;
  const auto with = [](std::vector<VerdictNumber> of_base, State state) {
    VerdictNumbers numbers = numbers_with(std::move(of_base));
    CriterionResult& result = numbers.criteria.emplace_back();
    result.criterion.quantity = find_verdict_quantity("longest_full_loss");
    result.criterion.limit = 0.1;
    result.interface = "soil";
    result.state = state;
    if (const VerdictNumber* found = find_number(numbers.interfaces.front().numbers, "longest_full_loss")) result.value = found->value;
    return numbers;
  };
  const auto marked = [](VerdictNumbers numbers, const VerdictNumbers& coarse) {
    compared(numbers, coarse);
    return numbers.criteria.front().within_step_change;
  };
  const auto lost = [](double duration) { return std::vector{number("longest_full_loss", duration)}; };
  EXPECT_TRUE(marked(with({}, State::met), with(lost(0.2), State::not_met)));
  EXPECT_TRUE(marked(with(lost(0.2), State::not_met), with({}, State::met)));
  EXPECT_FALSE(marked(with({}, State::met), with(lost(0.05), State::met)));
  EXPECT_FALSE(marked(with({}, State::met), with({}, State::met)));
  EXPECT_FALSE(marked(with({}, State::undetermined), with(lost(0.2), State::not_met)));
}

TEST(StepCheck, SafetiesByTheirInverse) {
  EXPECT_NEAR(change_of_one("min_overturning_safety", 1.25, 1.0), 0.2, 1e-15);
  EXPECT_NEAR(change_of_one("min_sliding_safety", 40, 20), 0.025 / 0.1, 1e-15) << "both are far from sliding";
  EXPECT_NEAR(change_of_one("min_sliding_safety", 400, 200), 0.0025 / 0.1, 1e-15);
}

TEST(StepCheck, ChangesBesideTheBondedRunByTheirRatio) {
  EXPECT_NEAR(change_of_one("change_of_moment", -0.5, -0.48), 0.02 / 0.52, 1e-15);
  EXPECT_NEAR(change_of_one("change_of_moment", 0, 0.02), 0.02 / 1.02, 1e-15);
}

TEST(StepCheck, LeastCompressionBesideTheLargest) {
  VerdictNumbers numbers = numbers_with({number("max_compression", 2e6), number("min_compression", 1e3)});
  const StepCheck check = compared(numbers, numbers_with({number("max_compression", 2e6), number("min_compression", 3e3)}));
  EXPECT_DOUBLE_EQ(check.largest, 2e3 / 2e6);
  EXPECT_EQ(check.state, StepCheck::State::converged);
}

/// 8 cm of gap over 4 m: 20 mrad. A residual rotation counts beside a twentieth of it, 1 mrad, and beside its remaining variation.
TEST(StepCheck, ResidualsBesideTheMotion) {
  VerdictNumber left = number("residual_rotation", 1e-4);
  left.swing = 1e-5;
  VerdictNumbers numbers = numbers_with({number("max_opening", 0.08), left});
  const VerdictNumbers coarse = numbers_with({number("max_opening", 0.08), number("residual_rotation", 3e-4)});
  EXPECT_NEAR(compared(numbers, coarse).largest, 2e-4 / 1e-3, 1e-15);
  numbers.interfaces.front().numbers.back().swing = 0.01;
  EXPECT_NEAR(compared(numbers, coarse).largest, 2e-4 / 0.01, 1e-15);
  EXPECT_EQ(format_step_change(numbers.interfaces.front().numbers.back()), "\u00b10.20 mrad");
}

TEST(StepCheck, NamesTheNumberThatChangesMostAndTheStep) {
  VerdictNumbers numbers = numbers_with({number("max_moment", 1e6), number("max_compression", 2e6)},
                                        {number("max_top_motion", 0.05), number("max_drift", 0.05)});
  const VerdictNumbers coarse =
      numbers_with({number("max_moment", 1.02e6), number("max_compression", 2.5e6)}, {number("max_top_motion", 0.0501)});
  const StepCheck check = compared(numbers, coarse);
  EXPECT_EQ(check.state, StepCheck::State::not_converged);
  EXPECT_DOUBLE_EQ(check.largest, 0.2);
  EXPECT_EQ(check.quantity->name, "max_compression");
  EXPECT_EQ(check.of, "soil");
  EXPECT_DOUBLE_EQ(check.decisive.excess(), 0.2 / 0.03);
  EXPECT_DOUBLE_EQ(check.sufficient_step, 1e-4) << "3 of 20 % of 1 ms, rounded down";
  EXPECT_EQ(check.sentence(),
            "Not converged: with twice the step (2.00 ms instead of 1.00 ms) largest compression of soil changes by 20 %; "
            "a step of 0.100 ms is expected to be sufficient. The changes beside the numbers are no bounds of their errors.");
  EXPECT_FALSE(numbers.whole.back().coarse) << "the companion has no drift";
  EXPECT_EQ(format_step_change(numbers.whole.back()), "");
  EXPECT_EQ(format_step_change(numbers.whole.front()), "\u00b10.2 %");
}

TEST(StepCheck, NothingThatStaysNothingDoesNotChange) {
  EXPECT_EQ(change_of_one("max_shear", 0, 0), 0);
  EXPECT_EQ(change_of_one("change_of_moment", -1, -1), 0) << "no moment at all, with both steps";
  EXPECT_NEAR(change_of_one("change_of_moment", -1, -0.99), 0.01 / 0.1, 1e-12);
  EXPECT_EQ(change_of_one("min_overturning_safety", 0, 0), 0);
}

/// Two peaks of compression [N], each of 0.1 s, in a run of 10 s whose parts last 0.5 s.
StepRecord two_peaks(double step, double first_at, double first, double second_at, double second) {
  StepRecord steps;
  steps.extremes.resize(1);
  for (double time = 0; time < 10 + step / 2; time += step) {
    const auto peak = [&](double at, double size) { return size * std::max(0.0, 1 - std::abs(time - at) / 0.05); };
    steps.time.push_back(time);
    StepRecord::Instant& now = steps.instants.emplace_back();
    now.axial = -peak(first_at, first) - peak(second_at, second);
  }
  return steps;
}

StepCheck parts_compared(const StepRecord& fine, const StepRecord& coarse) {
  VerdictNumbers numbers = numbers_with({number("max_compression", 2e6)});
  const VerdictNumbers other = numbers_with({number("max_compression", 2e6)});
  StepCheck check = compared(numbers, other);
  EXPECT_EQ(check.state, StepCheck::State::converged);
  compare_parts(fine, coarse, numbers, check);
  return check;
}

/// A scheme that damps what it does not resolve gives two steps the same wrong peak.
TEST(StepCheck, LostEnergyIsNotConverged) {
  StepCheck check;
  check.step = 1e-3, check.coarse_step = 2e-3, check.lost = 0.08;
  VerdictNumbers numbers = numbers_with({number("max_moment", 1e6)});
  compare_steps(numbers, numbers_with({number("max_moment", 1e6)}), check);
  EXPECT_EQ(check.state, StepCheck::State::not_converged);
  EXPECT_EQ(check.sentence(),
            "Not converged: the time scheme lost 8.0 % of the energy that was put in, because a step of 1.00 ms does not resolve the "
            "motion. The changes beside the numbers are no bounds of their errors.");
  check.lost = 0.04;
  compare_steps(numbers, numbers_with({number("max_moment", 1e6)}), check);
  EXPECT_EQ(check.state, StepCheck::State::converged);
}

/// Both runs reach 2 MN, at different impacts: of the impact at 7.2 s one has 1.5 MN, the other 2 MN.
TEST(StepCheck, PeaksThatAgreeByChanceAreNotConverged) {
  const StepCheck check = parts_compared(two_peaks(1e-3, 3.2, 2e6, 7.2, 1.5e6), two_peaks(2e-3, 3.2, 1.9e6, 7.2, 2e6));
  EXPECT_EQ(check.state, StepCheck::State::not_converged);
  EXPECT_NEAR(check.part.change, 0.25, 1e-6);
  EXPECT_EQ(check.part.quantity->name, "max_compression");
  EXPECT_NEAR(check.part.from, 7, 1e-9);
  EXPECT_NEAR(check.part.to, 7.5, 1e-9);
  EXPECT_EQ(check.sufficient_step, 0) << "the change is not proportional to the step";
  EXPECT_EQ(check.sentence(),
            "Not converged: with twice the step (2.00 ms instead of 1.00 ms) the largest compression of soil from 7.00 s to 7.50 s "
            "changes by 25 % of that of the whole time. The changes beside the numbers are no bounds of their errors.");
}

/// Forces are asked for within 3 %; the other numbers may change by 5 %.
TEST(StepCheck, ForcesMayChangeByThreePerCent) {
  const auto state = [](double other) {
    return parts_compared(two_peaks(1e-3, 3.2, 2e6, 7.2, 1.5e6), two_peaks(2e-3, 3.2, 2e6, 7.2, other));
  };
  EXPECT_EQ(state(1.55e6).state, StepCheck::State::converged) << "0.05 MN of 2 MN";
  EXPECT_EQ(state(1.57e6).state, StepCheck::State::not_converged) << "0.07 MN of 2 MN";
}

/// A change of 4 % is too much for a force, and names the step, while a larger one of another number is accepted.
TEST(StepCheck, TheDecisiveNumberIsTheOneBesideWhatIsAccepted) {
  VerdictNumbers numbers = numbers_with({number("max_shear", 1e6)}, {number("max_top_motion", 0.1)});
  const StepCheck check = compared(numbers, numbers_with({number("max_shear", 0.96e6)}, {number("max_top_motion", 0.0955)}));
  EXPECT_EQ(check.state, StepCheck::State::not_converged);
  EXPECT_EQ(check.quantity->name, "max_top_motion");
  EXPECT_EQ(check.decisive.quantity->name, "max_shear");
  EXPECT_NEAR(check.decisive.change, 0.04, 1e-12);
  EXPECT_DOUBLE_EQ(check.sufficient_step, 5e-4) << "3 of 4 % of 1 ms, rounded down";
}

/// A peak just before the end of a part in one run, just after it in the other: 0.04 s apart, less than a tenth of a part.
TEST(StepCheck, PeaksBesideTheBorderOfAPartCount) {
  const StepCheck near = parts_compared(two_peaks(1e-3, 3.2, 2e6, 6.98, 1.5e6), two_peaks(2e-3, 3.2, 2e6, 7.02, 1.5e6));
  EXPECT_EQ(near.state, StepCheck::State::converged);
  EXPECT_LT(near.part.change, 1e-6);
  const StepCheck apart = parts_compared(two_peaks(1e-3, 3.2, 2e6, 6.9, 1.5e6), two_peaks(2e-3, 3.2, 2e6, 7.1, 1.5e6));
  EXPECT_NEAR(apart.part.change, 0.75, 1e-6);
}

/// Twenty steps of 2 ms a period: up to 25 Hz. The value at 10 Hz counts beside a tenth of the peak, 1 m/s2.
TEST(StepCheck, FloorSpectra) {
  FloorSpectra fine, coarse;
  fine.name = "roof";
  fine.raw = {{Spectrum::Kind::psa, 0.05, {5, 10, 30}, {10, 0.5, 4}}};
  coarse.raw = {{Spectrum::Kind::psa, 0.05, {5, 10, 30}, {10.2, 0.7, 8}}};
  StepCheck check;
  check.step = 1e-3, check.coarse_step = 2e-3;
  compare_floors({fine}, {coarse}, check);
  EXPECT_DOUBLE_EQ(check.floors, 0.2);
  EXPECT_DOUBLE_EQ(check.floors_to, 10) << "the last frequency below 25 Hz";
  EXPECT_EQ(check.state, StepCheck::State::not_converged);
  EXPECT_EQ(check.sentence(),
            "Not converged: with twice the step (2.00 ms instead of 1.00 ms) floor spectrum of roof changes by 20 %; a step "
            "of 0.200 ms is expected to be sufficient. The changes beside the numbers are no bounds of their errors.");
}

/// A floor without excitation, 1e-14 m/s2 beside one of 5 m/s2, and one alone beside ground of 4 m/s2: round-off changes by anything.
TEST(StepCheck, NoiseDecidesNothing) {
  const auto floor = [](double value) {
    FloorSpectra made;
    made.name = "floor";
    made.zero_period.value = value;
    made.raw = {{Spectrum::Kind::psa, 0.05, {5, 10}, {value, 2 * value}}};
    return made;
  };
  StepCheck check;
  check.step = 1e-3, check.coarse_step = 2e-3;
  compare_floors({floor(5), floor(1e-14)}, {floor(5), floor(2e-14)}, check);
  compare_floors({floor(1e-3)}, {floor(2e-3)}, check, 4e-3);
  EXPECT_EQ(check.floors, 0);
  EXPECT_EQ(check.state, StepCheck::State::converged);
  VerdictNumbers numbers = numbers_with({number("max_shear", 3), number("max_moment", 1e6)});
  numbers.interfaces.front().numbers.front().least = 10;
  compare_steps(numbers, numbers_with({number("max_shear", 1), number("max_moment", 1.01e6)}), check);
  EXPECT_NEAR(check.largest, 0.01 / 1.01, 1e-12) << "both shears are noise";
  EXPECT_FALSE(numbers.interfaces.front().numbers.front().step_change);
  EXPECT_EQ(format_step_change(numbers.interfaces.front().numbers.front()), "");
}

TEST(StepCheck, NobodyLooked) {
  EXPECT_EQ(StepCheck().sentence(), "Error of the time step: not examined.");
  EXPECT_EQ(to_string(StepCheck().state), "not made");
}

TEST(StepCheck, ACompanionThatEndsDifferentlyShowsThatTheStepDecides) {
  BuiltCase built, coarse_built;
  built.plan.stages.emplace_back().step = 1e-3;
  coarse_built.plan.stages.emplace_back().step = 2e-3;
  RunResult run, coarse;
  coarse.status = RunStatus::overturned;
  VerdictNumbers numbers = numbers_with({number("max_moment", 1e6)});
  const StepCheck check = check_step(built, run, nullptr, {&coarse_built, longest_step(coarse_built.plan), &coarse}, numbers);
  EXPECT_EQ(check.state, StepCheck::State::not_converged);
  EXPECT_EQ(check.sentence(),
            "Not converged: with twice the step the run ends early (overturned) (2.00 ms instead of 1.00 ms). The changes beside the "
            "numbers are no bounds of their errors.");
  coarse.status = RunStatus::interrupted;
  EXPECT_EQ(check_step(built, run, nullptr, {&coarse_built, longest_step(coarse_built.plan), &coarse}, numbers).state,
            StepCheck::State::not_made);
}

/// Hops within one impact do not count, however many there are.
TEST(StepCheck, AfterALossOfContactASmallerStepNeedNotDo) {
  BuiltCase built;
  built.plan.stages.emplace_back().step = 1e-3;
  const RunResult run;
  for (const double lost : {0.03, 0.4}) {
    VerdictNumbers numbers = numbers_with({number("max_moment", 1e6)});
    for (int hop = 0; hop < 9; ++hop) numbers.full_loss.push_back({0.5 * hop, 0.5 * hop + (hop == 4 ? lost : 0.02)});
    const StepCheck check = check_step(built, run, nullptr, {&built, 2e-3, &run}, numbers);
    EXPECT_NEAR(check.no_contact, lost, 1e-12);
  }
  StepCheck check;
  check.step = 1e-3, check.coarse_step = 2e-3, check.lost = 0.08, check.no_contact = 0.4;
  VerdictNumbers numbers = numbers_with({number("max_moment", 1e6)});
  compare_steps(numbers, numbers_with({number("max_moment", 1e6)}), check);
  const std::string said =
      "There is no contact for 0.400 s: every impact depends on the one before, so that a smaller step need not settle the run.";
  EXPECT_NE(check.sentence().find(said), std::string::npos) << check.sentence();
  check.no_contact = 0.03;
  EXPECT_EQ(check.sentence().find("no contact"), std::string::npos);
}

TEST(Wording, RoundsDownToOneTwoOrFive) {
  EXPECT_DOUBLE_EQ(rounded_down(0.0047), 0.002);
  EXPECT_DOUBLE_EQ(rounded_down(0.005), 0.005);
  EXPECT_DOUBLE_EQ(rounded_down(0.0099), 0.005);
  EXPECT_DOUBLE_EQ(rounded_down(1), 1);
  EXPECT_DOUBLE_EQ(rounded_down(1.9e-4), 1e-4);
}

}  // namespace
}  // namespace uplift::step_check_test
