#include <fmt/format.h>

#include <algorithm>

#include "uplift/base/file.h"
#include "uplift/cli/console.h"
#include "uplift/cli/load.h"
#include "uplift/contact/method.h"
#include "uplift/contact/unheld.h"
#include "uplift/io/text/json_writer.h"

namespace uplift::cli {
namespace {

struct Answer {
  std::string method;
  bool suits = true;
  Outcome outcome;
  InterfaceSolution solution;
  double residual = 0;  // the contact residual
};

Answer solve(const InterfaceProblem& problem, const std::string& name) {
  Answer answer;
  answer.method = name;
  const bool cones =
      std::any_of(problem.model->blocks.begin(), problem.model->blocks.end(), [](const Block& block) { return block.cone != nullptr; });
  if (cones && name == "newton") {
    answer.suits = false;
    answer.outcome.why = "newton is for traction laws; this problem has a cone";
    return answer;
  }
  const Values values = check_part(Raw{name, {"uplift replay --method", 0}, ""}, contact_methods());
  answer.outcome = make_part(method_catalog(), values)->solve(problem, answer.solution);
  answer.residual = answer.solution.opening.size() == problem.rows() && answer.solution.force.size() == problem.rows()
                        ? contact_residual(problem, answer.solution)
                        : INFINITY;
  if (answer.outcome.converged && !(answer.solution.opening.allFinite() && answer.solution.force.allFinite())) {
    answer.outcome.converged = false;
    answer.outcome.why = "the solution is not finite";
  }
  if (answer.outcome.converged &&
      problem.model->shift.size() > 0)  // of a static step: what has run away is no equilibrium of the structure
    if (std::string why = unheld_motion(problem, answer.solution, runaway_ratio); !why.empty()) {
      answer.outcome.converged = false;
      answer.outcome.why = std::move(why);
    }
  return answer;
}

void print_points(const InterfaceProblem& problem, const InterfaceSolution& solution) {
  std::vector<std::vector<std::string>> rows{{"interface", "point", "opening [m]", "pressure [Pa]"}};
  for (const Block& block : problem.model->blocks)
    for (int i = 0; i < block.batch.points; ++i) {
      const int row = block.first + block.batch.normal() + i;
      rows.push_back({block.name, fmt::format("{}", i + 1), fmt::format("{:.6e}", solution.opening[row]),
                      fmt::format("{:.6e}", -solution.force[row] / (problem.model->scale * block.area[static_cast<std::size_t>(i)]))});
    }
  print_table(rows);
}

void write_answers(const std::string& reason, const std::vector<Answer>& answers) {
  JsonWriter json(0, 2);
  json.begin_object().member("reason", reason).key("methods").begin_array();
  for (const Answer& answer : answers) {
    json.begin_object()
        .member("method", answer.method)
        .member("converged", answer.outcome.converged)
        .member("iterations", answer.outcome.iterations);
    json.member("cycles", answer.outcome.cycles).member("residual", answer.residual).member("why", answer.outcome.why);
    json.key("opening").numbers(
        std::span<const double>(answer.solution.opening.data(), static_cast<std::size_t>(answer.solution.opening.size())));
    json.key("force")
        .numbers(std::span<const double>(answer.solution.force.data(), static_cast<std::size_t>(answer.solution.force.size())))
        .end_object();
  }
  json.end_array().end_object();
  say(json.take());
}

}  // namespace

int replay(const Options& options, const std::string& method, bool all) {
  const StoredProblem stored = load_problem(read_file(options.file), options.file);
  std::vector<std::string> names;
  for (const PartInfo* part : contact_methods())
    if (all || part->name == method) names.emplace_back(part->name);
  if (names.empty()) check_part(Raw{method, {"uplift replay --method", 0}, ""}, contact_methods());  // says which ones there are
  std::vector<Answer> answers;
  for (const std::string& name : names) answers.push_back(solve(stored.problem, name));
  const bool failed = std::none_of(answers.begin(), answers.end(), [](const Answer& answer) { return answer.outcome.converged; });
  if (options.json) {
    write_answers(stored.reason, answers);
    return failed ? Exit::numerical_failure : Exit::done;
  }
  if (!stored.reason.empty()) say("stored because: " + stored.reason);
  say(fmt::format("{} rows, {} coordinates", stored.problem.rows(), stored.problem.model->factor.cols()));
  std::vector<std::vector<std::string>> rows{{"method", "result", "iterations", "cycles", "contact residual"}};
  for (const Answer& answer : answers)
    rows.push_back({answer.method,
                    answer.outcome.converged ? "converged"
                    : answer.suits           ? "failed"
                                             : "does not apply",
                    fmt::format("{}", answer.outcome.iterations), fmt::format("{}", answer.outcome.cycles),
                    fmt::format("{:.2e}", answer.residual)});
  print_table(rows);
  for (const Answer& answer : answers)
    if (!answer.outcome.why.empty()) say(answer.method + ": " + answer.outcome.why);
  if (answers.size() == 1 && answers.front().outcome.converged) print_points(stored.problem, answers.front().solution);
  return failed ? Exit::numerical_failure : Exit::done;
}

}  // namespace uplift::cli
