#include "uplift/session/replay.h"

#include <fmt/format.h>

#include <algorithm>

#include "uplift/base/file.h"
#include "uplift/cli/console.h"
#include "uplift/cli/load.h"

namespace uplift::cli {
namespace {

void print_points(const InterfaceProblem& problem, const InterfaceSolution& solution) {
  std::vector<std::vector<std::string>> rows{{"interface", "point", "opening [m]", "pressure [Pa]"}};
  for (const Block& block : problem.model->blocks)
    for (int i = 0; i < block.batch.points; ++i) {
      const int row = block.normal_row() + i;
      rows.push_back({block.name, fmt::format("{}", i + 1), fmt::format("{:.6e}", solution.opening[row]),
                      fmt::format("{:.6e}", -solution.force[row] / (problem.model->scale * block.area[static_cast<std::size_t>(i)]))});
    }
  print_table(rows);
}

}  // namespace

int replay(const Options& options, const std::string& method, bool all) {
  const StoredProblem stored = load_problem(read_file(options.file), options.file);
  const std::vector<Replay> answers = replay_problem(stored.problem, all ? std::string() : method, {"uplift replay --method", 0});
  const bool failed = std::none_of(answers.begin(), answers.end(), [](const Replay& answer) { return answer.outcome.converged; });
  if (options.json) {
    say(replay_json(stored.reason, answers));
    return failed ? Exit::numerical_failure : Exit::done;
  }
  if (!stored.reason.empty()) say("stored because: " + stored.reason);
  say(fmt::format("{} rows, {} coordinates", stored.problem.rows(), stored.problem.model->factor.cols()));
  std::vector<std::vector<std::string>> rows{{"method", "result", "iterations", "cycles", "contact residual"}};
  for (const Replay& answer : answers)
    rows.push_back({answer.method,
                    answer.outcome.converged ? "converged"
                    : answer.suits           ? "failed"
                                             : "does not apply",
                    fmt::format("{}", answer.outcome.iterations), fmt::format("{}", answer.outcome.cycles),
                    fmt::format("{:.2e}", answer.residual)});
  print_table(rows);
  for (const Replay& answer : answers)
    if (!answer.outcome.why.empty()) say(answer.method + ": " + answer.outcome.why);
  if (answers.size() == 1 && answers.front().outcome.converged) print_points(stored.problem, answers.front().solution);
  return failed ? Exit::numerical_failure : Exit::done;
}

}  // namespace uplift::cli
