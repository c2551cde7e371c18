#include <fmt/format.h>

#include "uplift/analysis/wording.h"
#include "uplift/base/file.h"
#include "uplift/cli/console.h"
#include "uplift/cli/load.h"

namespace uplift::cli {
namespace {

/// "criterion not met: max_opening of soil 13.7 mm, limit 10.0 mm (client)".
void say_criteria(const std::vector<CriterionResult>& results) {
  for (const CriterionResult& result : results) {
    const VerdictQuantity& quantity = *result.criterion.quantity;
    const std::string of = result.interface.empty() ? "" : " of " + result.interface;
    say(fmt::format("criterion {}: {}{} {}, at {} {} ({})", to_string(result.state), quantity.brief, of,
                    result.value ? said(quantity, *result.value) : "not computed", quantity.at_least ? "least" : "most",
                    said(quantity, result.criterion.limit), result.criterion.source));
  }
}

}  // namespace

int run(const Options& options) {
  const Loaded loaded = load(options);
  Results results;
  ResultFolder folder(result_path(options, loaded.read));
  std::vector<std::string> fields;
  catch_interrupts();
  for (const RunSpec& spec : runs_of_case(loaded.read)) {
    if (interrupt_asked() && !results.runs.empty()) break;
    results.specs.push_back(spec);
    results.built.push_back(build(loaded.read, spec));
    if (results.runs.empty()) results.warnings = warnings(loaded.read, spec, results.built.front());
    results.runs.push_back(run_with_fields(loaded, results.built.back(), spec.label, options, folder, fields));
    forget_matrices(results.built.back());
  }
  results.floors = floor_answers(results.built.front().plan, results.runs, results.specs);
  const RunResult& main = results.runs.front();
  results.verdict = judge(results.built.front(), main, results.runs.size() > 1 ? &results.runs[1] : nullptr, &results.floors.runs.front());
  if (std::string text = main.equilibrium.warning(); !text.empty()) results.warnings.push_back(std::move(text));
  write_results(options, loaded, results, nullptr, folder);

  if (options.json) {
    fmt::print("{}", read_file(folder.path() + "/summary.json"));
  } else if (!options.quiet) {
    for (const std::string& warning : results.warnings) complain("warning: " + warning);
    say(results.verdict.headline);
    if (!results.verdict.consequence.empty()) say(results.verdict.consequence);
    for (const Verdict::Fact& fact : results.verdict.facts) say(fmt::format("  {:<34} {:<14} {}", fact.label, fact.value, fact.detail));
    say_criteria(results.verdict.numbers.criteria);
    const double per_step = main.counts.steps > 0 ? 1e6 * main.wall / static_cast<double>(main.counts.steps) : 0;
    if (statics_alone(results.built.front().plan))
      say(fmt::format("{}: static stages in {}, {} load steps, {} retries", status_text(main), spoken(main.wall, "s"),
                      main.counts.load_steps, main.counts.retries));
    else
      say(fmt::format("{}: {} steps in {} ({:.2f} microseconds a step), {} retries", status_text(main), main.counts.steps,
                      spoken(main.wall, "s"), per_step, main.counts.retries));
    say(fmt::format("results: {}/report.html", folder.path()));
    for (const std::string& list : fields) say(fmt::format("fields: {}/{} (for ParaView)", folder.path(), list));
  }
  if (main.status == RunStatus::interrupted) {
    if (!options.quiet) complain(fmt::format("interrupted at t = {:g} s: the files hold everything up to there", main.end_time));
    return Exit::interrupted;
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

}  // namespace uplift::cli
