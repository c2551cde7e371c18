#include "uplift/run/lockstep.h"

#include <algorithm>
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

bool are_equal(const Sparse& a, const Sparse& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols() || a.nonZeros() != b.nonZeros() || !a.isCompressed() || !b.isCompressed()) return false;
  return std::equal(a.outerIndexPtr(), a.outerIndexPtr() + a.outerSize() + 1, b.outerIndexPtr()) &&
         std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr()) &&
         std::equal(a.valuePtr(), a.valuePtr() + a.nonZeros(), b.valuePtr());
}

/// One call of run_in_lockstep.
class RunsInLockstep {
 public:
  RunsInLockstep(std::span<const LockstepRun> runs, const LockstepOptions& options)
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
      if (together) plan.solver = together_.seat(k, plan.solver, one.model, one.matrices);
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

bool share_matrices(Model& model, const Model& with) {
  constexpr Sparse Model::*all[] = {&Model::stiffness, &Model::mass, &Model::damping};
  for (const auto matrix : all)
    if (!are_equal(model.*matrix, with.*matrix)) return false;
  for (const auto matrix : all) Sparse().swap(model.*matrix);  // an assignment would keep the memory
  return true;
}

std::vector<RunResult> run_in_lockstep(std::span<const LockstepRun> runs, const LockstepOptions& options) {
  return RunsInLockstep(runs, options).go();
}

}  // namespace uplift
