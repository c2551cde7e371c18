#include "uplift/session/replay.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "uplift/contact/unheld.h"
#include "uplift/io/text/json_writer.h"

namespace uplift {
namespace {

Replay solve(const InterfaceProblem& problem, const std::string& name, const Where& where) {
  Replay answer;
  answer.method = name;
  const bool cones =
      std::any_of(problem.model->blocks.begin(), problem.model->blocks.end(), [](const Block& block) { return block.cone != nullptr; });
  if (cones && name == "newton") {
    answer.suits = false;
    answer.outcome.why = "newton is for traction laws; this problem has a cone";
    return answer;
  }
  const Values values = check_part(Raw{name, where, ""}, contact_methods());
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

}  // namespace

std::vector<Replay> replay_problem(const InterfaceProblem& problem, const std::string& method, const Where& where) {
  if (!method.empty()) check_part(Raw{method, where, ""}, contact_methods());  // says which ones there are
  std::vector<Replay> answers;
  for (const PartInfo* part : contact_methods())
    if (method.empty() || part->name == method) answers.push_back(solve(problem, std::string(part->name), where));
  return answers;
}

std::string replay_json(const std::string& reason, const std::vector<Replay>& answers) {
  JsonWriter json(0, 2);
  json.begin_object().member("reason", reason).key("methods").begin_array();
  for (const Replay& answer : answers) {
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
  return json.take();
}

}  // namespace uplift
