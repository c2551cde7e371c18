// Runs that march side by side, with one factor and common back-solves, are the runs one after another.
#include "uplift/run/lockstep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stdexcept>

#include "plastic_support.h"

namespace uplift::lockstep_test {
namespace {

using plastic_test::block_on_soil;
using plastic_test::Prepared;
using plastic_test::prepared;

constexpr const char* shaken = R"([[function]]
name = "pulse"
shape = { type = "half_sine", duration = 0.25 }
[[load]]
name = "push"
group = "block_top"
force = [%e3, 0]
function = "pulse"
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 0.6
step = 5e-3
[[output.history]]
interface = "base"
quantity = "max_opening"
[[output.history]]
interface = "base"
quantity = "moment"
)";

std::string shaken_by(int force) {
  std::string text = shaken;
  return text.replace(text.find('%'), 1, std::to_string(force));
}

/// Runs of the block under pushes of different sizes [kN], all else being equal.
std::vector<Prepared> pushed(const std::string& behaviour, const std::vector<int>& forces) {
  std::vector<Prepared> made;
  for (const int force : forces) made.push_back(prepared(block_on_soil("", behaviour, shaken_by(force))));
  return made;
}

std::vector<LockstepRun> side_by_side(const std::vector<Prepared>& cases) {
  std::vector<LockstepRun> runs;
  for (const Prepared& each : cases)
    runs.push_back({.model = &each.built.model, .plan = &each.built.plan, .behaviours = &each.built.behaviours});
  return runs;
}

RunResult alone(const LockstepRun& one) {
  return run(*one.model, *one.plan, *one.behaviours, one.watch, one.observe, one.keeping);
}

/// Largest difference of a history, over its peak; what the balance of energy lacks is round-off itself and is held against the energies.
double difference(const RunResult& one, const RunResult& other) {
  EXPECT_EQ(one.table.size(), other.table.size());
  EXPECT_EQ(one.table.front(), other.table.front());
  double most = 0;
  for (std::size_t k = 1; k < one.table.size() && k < other.table.size(); ++k) {
    double peak = one.columns[k - 1].name == "energy.residual" ? one.energy_scale : 0, apart = 0;
    for (std::size_t i = 0; i < one.table[k].size() && i < other.table[k].size(); ++i) {
      peak = std::max(peak, std::abs(one.table[k][i]));
      apart = std::max(apart, std::abs(one.table[k][i] - other.table[k][i]));
    }
    if (peak > 0) most = std::max(most, apart / peak);
  }
  return most;
}

void expect_same_counts(const RunResult& one, const RunResult& other) {
  EXPECT_EQ(one.status, other.status) << one.reason << other.reason;
  EXPECT_EQ(one.counts.steps, other.counts.steps);
  EXPECT_EQ(one.counts.retries, other.counts.retries);
  EXPECT_EQ(one.counts.factorisations, other.counts.factorisations);
  EXPECT_EQ(one.counts.back_solves, other.counts.back_solves);
}

/// The runs of a group against single ones; the group's counts.
LockstepCounts expect_single_runs(const std::vector<LockstepRun>& runs, int threads = 1) {
  LockstepCounts counts;
  const std::vector<RunResult> together = run_in_lockstep(runs, {.threads = threads, .counts = &counts});
  EXPECT_EQ(together.size(), runs.size());
  for (std::size_t k = 0; k < together.size(); ++k) {
    const RunResult single = alone(runs[k]);
    EXPECT_GT(single.max_opening.value, 0);
    EXPECT_LE(difference(together[k], single), 1e-9) << k;
    expect_same_counts(together[k], single);
  }
  return counts;
}

const std::string sdm = "law = { type = \"sdm\", K_n = 2e9, F_u = 20e3, G_f = 20, F_c = -1e5 }\n";
const std::string multipliers = "law = { type = \"coulomb\", friction = 0.5 }\n";

// Claim: springs with Coulomb friction, springs that soften, multipliers with impacts: every history is that of the single run, and the
// group makes the factors of one run.
TEST(Lockstep, HistoriesAreThoseOfSingleRuns) {
  const std::string all[] = {plastic_test::springs, sdm, multipliers};
  for (const std::string& behaviour : all) {
    const std::vector<Prepared> cases = pushed(behaviour, {30, 45, 60});
    const std::vector<LockstepRun> runs = side_by_side(cases);
    const LockstepCounts counts = expect_single_runs(runs);
    EXPECT_EQ(counts.factorisations, alone(runs[0]).counts.factorisations) << behaviour;
    EXPECT_GE(counts.columns, 2 * 120 * 3) << behaviour;  // two halves a step of every run
    EXPECT_LE(counts.solves, counts.columns / 2) << behaviour;
  }
}

// Claim: laws and friction may differ from run to run; what they share is the bulk.
TEST(Lockstep, RunsMayDifferInTheirLaws) {
  std::vector<Prepared> cases = pushed(plastic_test::springs, {30, 50});
  cases.push_back(prepared(block_on_soil("", sdm, shaken_by(40))));
  const LockstepCounts counts = expect_single_runs(side_by_side(cases), 2);
  EXPECT_LE(counts.factorisations, 3);  // two closed joints in the static stage, one step
}

// Claim: the bits of a run are the same whatever runs march beside it, in whatever order, with however many threads.
TEST(Lockstep, TheOthersDoNotMatter) {
  const std::vector<Prepared> cases = pushed(plastic_test::springs, {30, 34, 38, 42, 46, 50, 54, 58, 62, 66});
  const std::vector<LockstepRun> runs = side_by_side(cases);
  const std::vector<RunResult> expected = run_in_lockstep(runs);
  const std::vector<LockstepRun> turned(runs.rbegin(), runs.rend());
  const std::vector<RunResult> backwards = run_in_lockstep(turned, {.threads = 2});
  for (std::size_t k = 0; k < runs.size(); ++k) EXPECT_EQ(backwards[runs.size() - 1 - k].table, expected[k].table) << k;
  EXPECT_EQ(run_in_lockstep(std::span(runs).subspan(4, 1)).front().table, expected[4].table);
}

/// Newton's method that gives up every seventh step of the nominal size.
class GivesUp final : public ContactMethod {
 public:
  GivesUp(std::shared_ptr<const ContactMethod> method, double step) : method_(std::move(method)), step_(step) {}
  struct Work final : MethodWork {
    std::unique_ptr<MethodWork> inner;
    int count = 0;
  };
  std::unique_ptr<MethodWork> make_work() const override {
    auto work = std::make_unique<Work>();
    work->inner = method_->make_work();
    return work;
  }
  Outcome solve(const InterfaceProblem& problem, MethodWork& given, InterfaceSolution& solution) const override {
    auto& work = static_cast<Work&>(given);
    if (problem.model->step == step_ && ++work.count % 7 == 0) {
      Outcome outcome;
      outcome.why = "not today";
      return outcome;
    }
    return method_->solve(problem, *work.inner, solution);
  }
  bool constrains() const override { return method_->constrains(); }

 private:
  std::shared_ptr<const ContactMethod> method_;
  double step_;
};

// Claim: a run that halves steps, one that overturns, one that fails, one that is interrupted and one whose observer throws leave the
// others as they are, and have the results of single runs; an exception arrives when all others have ended.
TEST(Lockstep, EveryRunEndsInItsOwnWay) {
  std::vector<Prepared> cases = pushed(plastic_test::springs, {30, 40, 60, 50, 55, 45});
  const auto gives_up = [&](std::size_t k, int halvings) {
    RunPlan& plan = cases[k].built.plan;
    plan.method = std::make_shared<const GivesUp>(plan.method, plan.stages[1].step);
    plan.stages[1].halvings = halvings;
  };
  gives_up(1, 3);
  cases[2].built.plan.rotation_limit = 1e-4;
  gives_up(3, 0);
  std::vector<LockstepRun> runs = side_by_side(cases);
  runs[4].watch = [](const Progress& progress) { return progress.time < 0.3; };
  for (const int threads : {1, 2}) {
    std::vector<RunStatus> ended(runs.size());
    LockstepCounts counts;
    const std::vector<RunResult> results = run_in_lockstep(
        runs, {.threads = threads, .ended = [&](std::size_t k, const RunResult& result) { ended[k] = result.status; }, .counts = &counts});
    using enum RunStatus;
    EXPECT_EQ(ended, (std::vector{completed, completed, overturned, failed, interrupted, completed}));
    EXPECT_GT(results[1].counts.retries, 10);
    for (std::size_t k = 0; k < runs.size(); ++k) {
      const RunResult single = alone(runs[k]);
      EXPECT_LE(difference(results[k], single), 1e-9) << k;
      expect_same_counts(results[k], single);
    }
    EXPECT_EQ(counts.factorisations, 3);  // at rest, the step, half of it
  }
  runs[0].observe = [](const Snapshot& now) {
    if (now.state.time > 0.2) throw std::runtime_error("enough");
  };
  int ended = 0;
  EXPECT_THROW(run_in_lockstep(runs, {.ended = [&](std::size_t, RunResult&) { ++ended; }}), std::runtime_error);
  EXPECT_EQ(ended, 5);
}

// Claim: runs of other matrices and runs of yielding soil come after one another, with the results of single runs.
TEST(Lockstep, OtherMatricesAndYieldingSoil) {
  std::vector<Prepared> cases = pushed(plastic_test::springs, {30, 45});
  std::string stiff = block_on_soil("", plastic_test::springs, shaken_by(40));
  stiff.replace(stiff.find("E = 5e7"), 7, "E = 6e7");
  cases.push_back(prepared(stiff));
  cases.push_back(prepared(block_on_soil("law = { type = \"drucker_prager\", cohesion = 20e3, friction_angle = \"25 deg\" }",
                                         plastic_test::springs, shaken_by(35))));
  const LockstepCounts counts = expect_single_runs(side_by_side(cases));
  EXPECT_EQ(counts.factorisations, 4);  // of two models, at rest and for the step
}

// Claim: runs whose models have given their matrices away to the first one, with released supports, P-Delta and other laws among them, are
// the single runs of whole models.
TEST(Lockstep, MatricesOfOneModelServeAll) {
  const std::string released = "[[support]]\ngroup = \"block_top\"\nfixed = [\"ux\"]\nstages = \"static\"\n";
  for (const std::string& rest : {std::string(), released}) {
    for (const std::string& behaviour : {plastic_test::springs, multipliers}) {
      std::vector<Prepared> cases, whole;
      for (const int force : {30, 45, 55}) {
        const std::string other = force == 55 && behaviour == plastic_test::springs ? sdm : behaviour;
        for (std::vector<Prepared>* list : {&cases, &whole})
          list->push_back(
              prepared(block_on_soil("", other, rest + support::replaced(shaken_by(force), "step = 5e-3", "step = 5e-3\np_delta = true"))));
      }
      std::vector<LockstepRun> runs = side_by_side(cases);
      for (std::size_t k = 1; k < runs.size(); ++k) {
        ASSERT_TRUE(share_matrices(cases[k].built.model, cases[0].built.model));
        EXPECT_EQ(cases[k].built.model.stiffness.nonZeros(), 0);
        runs[k].matrices = &cases[0].built.model;
      }
      const std::vector<RunResult> results = run_in_lockstep(runs);
      const std::vector<LockstepRun> singles = side_by_side(whole);
      for (std::size_t k = 0; k < runs.size(); ++k) {
        const RunResult single = alone(singles[k]);
        EXPECT_EQ(single.status, RunStatus::completed) << single.reason;
        EXPECT_LE(difference(results[k], single), 1e-9) << k;
        expect_same_counts(results[k], single);
      }
    }
  }
  std::vector<Prepared> others = pushed(plastic_test::springs, {30});
  std::string stiff = block_on_soil("", plastic_test::springs, shaken_by(30));
  stiff.replace(stiff.find("E = 5e7"), 7, "E = 6e7");
  others.push_back(prepared(stiff));
  EXPECT_FALSE(share_matrices(others[1].built.model, others[0].built.model));
  EXPECT_GT(others[1].built.model.stiffness.nonZeros(), 0);
}

TEST(Lockstep, NoRuns) {
  EXPECT_TRUE(run_in_lockstep({}).empty());
}

}  // namespace
}  // namespace uplift::lockstep_test
