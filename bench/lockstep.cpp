// Runs of a block on soil (block_on_soil.h) side by side: what a step of one of them costs beside a single run, and how much memory all of
// them take. The runs differ in their initial velocity. Processor time, which other jobs on the machine disturb least, and elapsed time.
// Usage: bench_lockstep plane|space SIZE STEPS THREADS RUNS ...   element size in m; RUNS 0: run() alone; solve: back-solves
#include "uplift/run/lockstep.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>

#include "bench/block_on_soil.h"
#include "uplift/dynamics/bulk.h"
#include "uplift/linear/memory.h"
#include "uplift/linear/rates.h"

namespace uplift {
namespace {

double processor_time() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double elapsed() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Memory of this process now [bytes].
double resident() {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("VmRSS:")) return 1024 * std::atof(line.c_str() + 6);
  return 0;
}

/// Least times of a step over pieces of some steps.
struct Pieces {
  static constexpr long length = 5;  // steps
  double processor = 1e300, wall = 1e300, from_processor = 0, from_wall = 0, memory = 0;
  void see(const Snapshot& now) {
    if (now.stepper == nullptr || now.step < 2 || (now.step - 2) % length != 0) return;
    const double cpu = processor_time(), clock = elapsed();
    if (now.step > 2) {
      processor = std::min(processor, (cpu - from_processor) / length);
      wall = std::min(wall, (clock - from_wall) / length);
    }
    memory = std::max(memory, resident());
    from_processor = cpu, from_wall = clock;
  }
};

RunPlan plan_of(const Model& model, int steps, std::size_t number) {
  RunPlan plan;
  plan.method = make_part(method_catalog(), part(contact_methods(), "newton", {}));
  plan.impact = make_part(impact_catalog(), part(impact_rules(), "none", {}));
  plan.solver = make_part(solver_catalog(), part(linear_solvers(), "cholmod", {}));
  Stage rest, motion;
  rest.type = Stage::Type::statics;
  motion.step = 2e-3;
  motion.duration = steps * motion.step;
  motion.scheme = *make_part(scheme_catalog(), part(schemes(), "average_acceleration", {}));
  plan.stages = {rest, motion};
  plan.initial_velocity = Vector::Zero(model.free());
  for (Index i = 0; i < model.free(); ++i)
    if (model.kept[static_cast<std::size_t>(i)] % model.space.unknowns() == 0)
      plan.initial_velocity[i] = 1e-3 * static_cast<double>(number);  // m/s, of all
  return plan;
}

/// One back-solve of a step's matrix, and those of several columns at once, by one thread.
void measure_solves(const Model& model) {
  const Sparse b = stack_interfaces(model), matrix = model.stiffness + 4 / (2e-3 * 2e-3) * model.mass;
  const SplitFactorisation made =
      make_part(solver_catalog(), part(linear_solvers(), "cholmod", {}))->factorise_split(matrix, touched_unknowns(b));
  const Vector load = Vector::Ones(model.free());
  Vector half, x;
  const auto least = [](const auto& work) {
    double seconds = 1e300;
    for (int k = 0; k < 5; ++k) {
      const double start = processor_time();
      work();
      seconds = std::min(seconds, processor_time() - start);
    }
    return seconds;
  };
  const double one = least([&] { made.factor->forward(load, half), made.factor->backward(half, x); });
  const double entries = made.factor->nonzeros();
  fmt::print("{:7} unknowns, factor of {:.0f} MB | a back-solve: alone {:.2f} ms, {:.1f} GB/s", model.free(), 8e-6 * entries, 1e3 * one,
             16e-9 * entries / one);
  for (const std::size_t count : {8, 16, 32}) {
    std::vector<Vector> y(count), solution(count);
    const std::vector<const Vector*> from(count, &load);
    std::vector<Vector*> to, last;
    std::vector<const Vector*> halves;
    for (std::size_t k = 0; k < count; ++k) to.push_back(&y[k]), halves.push_back(&y[k]), last.push_back(&solution[k]);
    const double all = least([&] { made.factor->forward_all(from, to), made.factor->backward_all(halves, last); });
    fmt::print("; {} columns {:.2f} ms each, {:.1f} Gflop/s", count, 1e3 * all / static_cast<double>(count),
               4e-9 * entries * static_cast<double>(count) / all);
  }
  const Rates rates = measure_rates(8 * entries);
  fmt::print(" | dense product {:.1f} Gflop/s, stream {:.1f} GB/s\n", 1e-9 * rates.operations_per_second, 1e-9 * rates.bytes_per_second);
  std::fflush(stdout);
}

void measure(const Model& model, int steps, int threads, std::size_t count) {
  std::vector<RunPlan> plans;
  for (std::size_t k = 0; k < std::max<std::size_t>(1, count); ++k) plans.push_back(plan_of(model, steps, k));
  const std::vector<const Values*> behaviours(model.interfaces.size(), nullptr);
  Pieces pieces;
  const Observe observe = [&](const Snapshot& now) { pieces.see(now); };
  std::vector<LockstepRun> runs;
  for (std::size_t k = 0; k < plans.size(); ++k) {
    runs.push_back({.model = &model, .plan = &plans[k], .behaviours = &behaviours});
    if (k == 0) runs.back().observe = observe;
  }
  LockstepCounts counts;
  std::vector<RunResult> results;
  if (count == 0)
    results.push_back(run(model, plans[0], behaviours, {}, observe));
  else
    results = run_in_lockstep(runs, {.threads = threads, .counts = &counts});
  for (const RunResult& result : results)
    if (result.status != RunStatus::completed) fmt::print("{}: {}\n", to_string(result.status), result.reason);
  const double n = static_cast<double>(runs.size());
  fmt::print(
      "{:7} unknowns {:4} rows, {:2} runs {:8}| a step of one run: {:7.2f} ms of processor, {:7.2f} ms elapsed | {:5.0f} MB | "
      "{} factors, {} solves of {} columns, open {:.0f} %\n",
      model.free(), model.rows(), runs.size(), count == 0 ? "alone " : "together ", 1e3 * pieces.processor / n, 1e3 * pieces.wall / n,
      1e-6 * pieces.memory, count == 0 ? results[0].counts.factorisations : counts.factorisations, counts.solves, counts.columns,
      100 * results.back().max_uplifted_ratio.value);
  std::fflush(stdout);
}

}  // namespace
}  // namespace uplift

int main(int count, char** words) {
  using namespace uplift;
  if (count < 6) {
    fmt::print("usage: bench_lockstep plane|space SIZE STEPS THREADS RUNS ...\n");
    return 2;
  }
  prepare_heap();
  const Model model = block_on_soil(std::atof(words[2]), {{std::string_view(words[1]) == "space" ? 3 : 2}, false});
  for (int k = 5; k < count; ++k) {
    if (std::string_view(words[k]) == "solve")
      measure_solves(model);
    else
      measure(model, std::atoi(words[3]), std::atoi(words[4]), static_cast<std::size_t>(std::atoi(words[k])));
  }
  return 0;
}
