// What a step of a case costs, as with a reduced model: processor time from one step to the next, with all that is recorded, of the first
// run of the case, or of its last one, the bonded run; the first step, which makes the factors, is left out.
// Usage: bench_steps_of_case [--bonded] CASE.toml ...
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <string_view>
#include <vector>

#include "uplift/session/steps.h"

namespace uplift {
namespace {

double now() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void measure(const char* file, bool bonded) {
  const LoadedCase loaded = load_case(file, "bench_steps_of_case");
  const auto runs = runs_of_case(loaded.read);
  BuiltCase built = build_run(loaded, bonded ? runs.back() : runs.front());
  std::vector<double> times;
  double before = 0;
  Control control;
  control.observe = [&](const Snapshot& at) {
    if (at.stepper != nullptr && at.step > 1) times.push_back(1e3 * (now() - before));
    before = now();
  };
  const RunResult result = run_built(loaded, built, "run", control, true, nullptr);
  double sum = 0;
  for (const double time : times) sum += time;
  if (times.empty()) return;
  std::ranges::sort(times);
  const auto at = [&times](double share) { return times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))]; };
  const double steps = static_cast<double>(times.size());
  fmt::print(
      "{}: {}, {} steps, a step: mean {:.3f}, least {:.3f}, median {:.3f}, 95 % {:.3f}, most {:.3f} ms | a step: {:.2f} iterations, "
      "{:.2f} systems with a new factor, {:.2f} without | largest opening {:.9e} m\n",
      file, to_string(result.status), times.size(), sum / steps, at(0), at(0.5), at(0.95), at(1),
      static_cast<double>(result.counts.iterations) / steps, static_cast<double>(result.counts.systems.factored) / steps,
      static_cast<double>(result.counts.systems.iterated) / steps, result.max_opening.value);
}

}  // namespace
}  // namespace uplift

int main(int count, char** words) {
  const bool bonded = count > 1 && words[1] == std::string_view("--bonded");
  for (int k = bonded ? 2 : 1; k < count; ++k) uplift::measure(words[k], bonded);
}
