#include "uplift/run/lockstep.h"

#include <exception>
#include <system_error>
#include <thread>

#include "uplift/dynamics/plastic_bulk.h"

namespace uplift {

namespace {

/// Whether the matrices of a run change from step to step.
bool changes(const LockstepRun& one) {
  return one.plan->monolithic || PlasticBulk(*one.model).any();
}

/// One call of run_in_lockstep.
class Group {
 public:
  Group(std::span<const LockstepRun> runs, const LockstepOptions& options)
      : runs_(runs), options_(options), together_(runs.size(), options.threads), results_(runs.size()), thrown_(runs.size()) {}

  std::vector<RunResult> go() {
    std::vector<std::size_t> alone;
    std::vector<std::thread> threads;
    threads.reserve(runs_.size());
    for (std::size_t k = 0; k < runs_.size(); ++k)
      if (changes(runs_[k]) || !start(k, threads)) {
        together_.end(k);
        alone.push_back(k);
      }
    together_.serve();
    for (std::thread& thread : threads) thread.join();
    for (const std::size_t k : alone) execute(k, false);
    if (options_.counts != nullptr) *options_.counts = together_.counts();
    for (const std::exception_ptr& thrown : thrown_)
      if (thrown != nullptr) std::rethrow_exception(thrown);
    return std::move(results_);
  }

 private:
  /// False where the system has no further thread.
  bool start(std::size_t k, std::vector<std::thread>& threads) {
    try {
      threads.emplace_back([this, k] {
        together_.begin(k);
        execute(k, true);
        together_.end(k);
      });
    } catch (const std::system_error&) {
      return false;
    }
    return true;
  }

  void execute(std::size_t k, bool together) {
    const LockstepRun& one = runs_[k];
    try {
      RunPlan plan = *one.plan;
      if (together) plan.solver = together_.seat(k, plan.solver);
      results_[k] = run(*one.model, plan, *one.behaviours, one.watch, one.observe, one.keeping);
      if (options_.ended) options_.ended(k, results_[k]);
    } catch (...) {
      thrown_[k] = std::current_exception();
    }
  }

  std::span<const LockstepRun> runs_;
  const LockstepOptions& options_;
  Lockstep together_;
  std::vector<RunResult> results_;
  std::vector<std::exception_ptr> thrown_;
};

}  // namespace

std::vector<RunResult> run_in_lockstep(std::span<const LockstepRun> runs, const LockstepOptions& options) {
  return Group(runs, options).go();
}

}  // namespace uplift
