#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "uplift/base/file.h"
#include "uplift/base/format.h"
#include "uplift/cli/console.h"
#include "uplift/cli/load.h"
#include "uplift/session/checkpoint.h"

namespace uplift::cli {
namespace {

/// With the columns: what, value, how far the step still moves it, when and beside what.
void say_facts(const std::vector<Verdict::Fact>& facts) {
  const bool checked = std::ranges::any_of(facts, [](const Verdict::Fact& fact) { return !fact.step_change.empty(); });
  if (checked) say(fmt::format("  {:<34} {:<14} {}", "quantity", "value", "twice the step"));
  for (const Verdict::Fact& fact : facts)
    say(checked ? fmt::format("  {:<34} {:<14} {:<14} {}", fact.label, fact.value, fact.step_change, fact.detail)
                : fmt::format("  {:<34} {:<14} {}", fact.label, fact.value, fact.detail));
}

/// The value of a criterion, rounded as in the facts above it: a residual has no more decimals than its remaining variation.
std::string value_text(const VerdictNumbers& numbers, const CriterionResult& result) {
  if (!result.value) return result.state == CriterionResult::State::met ? "none" : "not computed";
  const VerdictQuantity& quantity = *result.criterion.quantity;
  for (const InterfaceVerdict& each : numbers.interfaces)
    if (each.name == result.interface)
      if (const VerdictNumber* number = find_number(each.numbers, quantity); number && number->value == *result.value)
        return text_of(*number);
  return format_value(quantity, *result.value);
}

/// "criterion not met: max_opening of soil 13.7 mm, limit 10.0 mm (client)".
void say_criteria(const VerdictNumbers& numbers) {
  for (const CriterionResult& result : numbers.criteria) {
    const VerdictQuantity& quantity = *result.criterion.quantity;
    const std::string of = result.interface.empty() ? "" : " of " + result.interface;
    say(fmt::format(
        "criterion {}: {}{} {}, at {} {} ({}){}", to_string(result.state), quantity.brief, of, value_text(numbers, result),
        quantity.at_least ? "least" : "most", format_value(quantity, result.criterion.limit), result.criterion.source,
        result.within_step_change ? "; not certain: doubling the step changes the value by at least its distance from the limit" : ""));
  }
}

/// "1 step", "2 steps".
std::string counted(long count, const char* one, const char* several) {
  return fmt::format("{} {}", count, count == 1 ? one : several);
}

/// `from`: folder of earlier checkpoints; empty: the runs begin at the beginning.
int run_from(const Options& options, const std::string& from) {
  const LoadedCase loaded = load(options);
  OutputFolder folder(options, result_path(options, loaded.read));
  Control control = control_of(options, &folder);
  std::optional<Checkpoints> checkpoints;
  keep_checkpoints(loaded, "run", folder, from, checkpoints, control);
  Results results = run_case(loaded, control);
  finish_checkpoints(checkpoints, results.warnings);
  const RunResult& main = results.runs.front();
  finish_results(options, loaded, results, folder);

  if (options.json) {
    print_text(read_file(folder.path() + "/summary.json"));
  } else if (!options.quiet) {
    for (const std::string& warning : results.warnings) complain("warning: " + warning);
    say(results.verdict.headline);
    if (!results.verdict.consequence.empty()) say(results.verdict.consequence);
    if (!statics_alone(results.built.front().plan)) say(results.verdict.step_check.sentence());
    say_facts(results.verdict.facts);
    say_criteria(results.verdict.numbers);
    const std::string per_step =
        main.counts.steps > 0 ? fmt::format(" ({} per step)", step_time_text(main.wall / static_cast<double>(main.counts.steps))) : "";
    if (statics_alone(results.built.front().plan))
      say(fmt::format("{}: static stages in {}, {}, {}", status_text(main), format_quantity(main.wall, "s"),
                      counted(main.counts.load_steps, "load step", "load steps"), counted(main.counts.retries, "retry", "retries")));
    else
      say(fmt::format("{}: {} in {}{}, {}", status_text(main), counted(main.counts.steps, "step", "steps"), format_quantity(main.wall, "s"),
                      per_step, counted(main.counts.retries, "retry", "retries")));
    if (!main.solver.empty()) say("solver: " + main.solver);
    say(fmt::format("results: {}/report.html", folder.path()));
    for (const std::string& list : results.field_lists) say(fmt::format("fields: {}/{} (for ParaView)", folder.path(), list));
  }
  if (main.status == RunStatus::interrupted) {
    if (!options.quiet) complain(fmt::format("{} at t = {:g} s: the files hold everything up to there", interrupt_text(), main.end_time));
    if (checkpoints && !options.quiet) complain(fmt::format("uplift resume {} goes on from there", folder.path()));
    return interrupt_exit_code();
  }
  if (interrupt_asked()) {
    if (!options.quiet)
      complain(interrupt_text() + ": the bonded run or the run with twice the step is not complete; what is compared with it is missing");
    if (checkpoints && !options.quiet) complain(fmt::format("uplift resume {} goes on from there", folder.path()));
    return interrupt_exit_code();
  }
  if (main.status == RunStatus::failed) {
    complain("failed: " + main.reason);
    if (!main.problem.empty())
      complain(fmt::format("the interface problem of the failed step: {}/problem_{}.json (see `uplift replay --help`)", folder.path(),
                           main.name));
    return Exit::numerical_failure;
  }
  return Exit::done;
}

}  // namespace

int run(const Options& options) {
  return run_from(options, "");
}

int resume(const Options& given) {
  Options options = given;
  const std::string from = checkpoints_at(given.file);
  const CheckpointOrigin origin = origin_of_checkpoints(from);
  options.file = case_file_of(origin);
  options.no_step_check = !origin.step_check;
  if (options.out.empty()) options.out = given.file;
  return origin.verb == "compare" ? compare_from(options, from) : run_from(options, from);
}

}  // namespace uplift::cli
