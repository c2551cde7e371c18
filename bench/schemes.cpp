// What a step of a case costs with filtered energy decay beside the trapezoidal rule: the dynamic stages of a case file with each of the
// two schemes in turns, in one process. The time of a step includes records, energies and checks. Runs are the same each time: the least
// time of every piece between two reports of progress counts, so that what other jobs of the machine take drops out. One dynamic stage.
// Usage: bench_schemes CASE.toml [ROUNDS]
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <string>
#include <vector>

#include "bench/block_on_soil.h"
#include "uplift/case/case.h"
#include "uplift/io/text/toml.h"
#include "uplift/linear/memory.h"

namespace uplift {
namespace {

/// Least times of the pieces of all rounds [s].
struct Pieces {
  std::vector<double> least;
  long steps = 0;         // of all pieces
  double iterations = 0;  // of the interface, a step
  double seconds_per_step() const { return std::accumulate(least.begin(), least.end(), 0.0) / static_cast<double>(steps); }
};

void take_turn(BuiltCase& built, const std::string& scheme, Pieces& pieces) {
  for (Stage& stage : built.plan.stages) stage.scheme = *make_part(scheme_catalog(), part(schemes(), scheme, {}));
  std::vector<double> times;
  double first = -1;  // s, of the motion
  const RunResult result = run(built.model, built.plan, built.behaviours, [&](const Progress& progress) {
    times.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count());
    if (first < 0) first = progress.time;
    pieces.steps = std::lround((progress.time - first) / progress.step);
    return true;
  });
  pieces.least.resize(times.size() - 1, 1e300);
  for (std::size_t k = 0; k + 1 < times.size(); ++k) pieces.least[k] = std::min(pieces.least[k], times[k + 1] - times[k]);
  pieces.iterations = static_cast<double>(result.counts.iterations) / static_cast<double>(result.counts.steps);
  if (!result.reason.empty()) fmt::print("{}\n", result.reason);
}

void measure(const std::string& file, int rounds) {
  const Case read = check_case(read_toml_file(file), file);
  BuiltCase built = build(read, runs_of_case(read).front());
  Pieces plain, filtered;
  for (int round = 0; round < rounds; ++round) {
    take_turn(built, "average_acceleration", plain);
    take_turn(built, "energy_decay", filtered);
  }
  fmt::print("{}: average_acceleration {:.4g} us a step ({:.2f} iterations), energy_decay {:.4g} us ({:.2f} iterations), {:.3f} times\n",
             file, 1e6 * plain.seconds_per_step(), plain.iterations, 1e6 * filtered.seconds_per_step(), filtered.iterations,
             filtered.seconds_per_step() / plain.seconds_per_step());
}

}  // namespace
}  // namespace uplift

int main(int count, char** words) {
  if (count < 2) {
    fmt::print("usage: bench_schemes CASE.toml [ROUNDS]\n");
    return 2;
  }
  uplift::prepare_heap();
  uplift::measure(words[1], count > 2 ? std::atoi(words[2]) : 15);
  return 0;
}
