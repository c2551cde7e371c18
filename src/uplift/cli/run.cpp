#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <future>

#include "uplift/base/file.h"
#include "uplift/base/format.h"
#include "uplift/cli/console.h"
#include "uplift/cli/load.h"
#include "uplift/linear/memory.h"
#include "uplift/verdict/result_warnings.h"

namespace uplift::cli {
namespace {

/// With the columns: what, value, how far the step still moves it, when and beside what.
void say_facts(const std::vector<Verdict::Fact>& facts) {
  const bool checked = std::ranges::any_of(facts, [](const Verdict::Fact& fact) { return !fact.step_change.empty(); });
  for (const Verdict::Fact& fact : facts)
    say(checked ? fmt::format("  {:<34} {:<14} {:<10} {}", fact.label, fact.value, fact.step_change, fact.detail)
                : fmt::format("  {:<34} {:<14} {}", fact.label, fact.value, fact.detail));
}

/// "criterion not met: max_opening of soil 13.7 mm, limit 10.0 mm (client)".
void say_criteria(const std::vector<CriterionResult>& results) {
  for (const CriterionResult& result : results) {
    const VerdictQuantity& quantity = *result.criterion.quantity;
    const std::string of = result.interface.empty() ? "" : " of " + result.interface;
    say(fmt::format("criterion {}: {}{} {}, at {} {} ({})", to_string(result.state), quantity.brief, of,
                    result.value ? format_value(quantity, *result.value) : "not computed", quantity.at_least ? "least" : "most",
                    format_value(quantity, result.criterion.limit), result.criterion.source));
  }
}

/// "1 step", "2 steps".
std::string counted(long count, const char* one, const char* several) {
  return fmt::format("{} {}", count, count == 1 ? one : several);
}

/// The runs with twice the step: beside the others where they are small, after them where memory counts.
class CompanionRuns {
 public:
  CompanionRuns(const Loaded& loaded, const Options& options) : loaded_(loaded), options_(options) {
    if (!options.no_step_check) specs_ = companions_of_case(loaded.read);
  }
  /// Begins to compute a case that is small.
  void begin(const BuiltCase& base) {
    constexpr int small_model = 3000;  // free unknowns
    if (!specs_.empty() && base.model.free() <= small_model && runs_side_by_side(2) == 2)
      beside_ = std::async(std::launch::async | std::launch::deferred, [this] { compute(true); });
  }
  /// What the verdict is compared with; null when nothing was computed.
  const Companion* finish() {
    if (beside_.valid())
      beside_.get();
    else if (!interrupt_asked())
      compute(false);
    if (runs_.empty()) return nullptr;
    companion_ = {&built_.front(), &runs_.front(), runs_.size() > 1 ? &runs_[1] : nullptr};
    return &companion_;
  }

 private:
  void compute(bool silent) {
    for (const RunSpec& spec : specs_) {
      built_.push_back(build(loaded_.read, spec));
      const BuiltCase& built = built_.back();
      runs_.push_back(silent ? uplift::run(built.model, built.plan, built.behaviours, [](const Progress&) { return !interrupt_asked(); })
                             : run_one(built, spec.label, options_));
      forget_matrices(built_.back());
    }
  }

  const Loaded& loaded_;
  const Options& options_;
  std::vector<RunSpec> specs_;
  std::deque<BuiltCase> built_;
  std::vector<RunResult> runs_;
  std::future<void> beside_;
  Companion companion_;
};

}  // namespace

int run(const Options& options) {
  const Loaded loaded = load(options);
  Results results;
  OutputFolder folder(options, result_path(options, loaded.read));
  std::vector<std::string> fields;
  CompanionRuns companions(loaded, options);
  for (const RunSpec& spec : runs_of_case(loaded.read)) {
    if (interrupt_asked() && !results.runs.empty()) break;
    results.specs.push_back(spec);
    results.built.push_back(build(loaded.read, spec));
    if (results.runs.empty()) companions.begin(results.built.front());
    if (results.runs.empty()) results.warnings = warnings(loaded.read, spec, results.built.front());
    results.runs.push_back(run_with_fields(loaded, results.built.back(), spec.label, options, folder, fields));
    forget_matrices(results.built.back());
  }
  results.floors = floor_answers(results.built.front().plan, results.runs, results.specs);
  const RunResult& main = results.runs.front();
  const Companion* companion = main.status == RunStatus::failed ? nullptr : companions.finish();
  results.verdict =
      judge(results.built.front(), main, results.runs.size() > 1 ? &results.runs[1] : nullptr, &results.floors.runs.front(), companion);
  for (std::string& warning : result_warnings(main, results.verdict.numbers)) results.warnings.push_back(std::move(warning));
  write_results(options, loaded, results, nullptr, folder);

  if (options.json) {
    print_text(read_file(folder.path() + "/summary.json"));
  } else if (!options.quiet) {
    for (const std::string& warning : results.warnings) complain("warning: " + warning);
    say(results.verdict.headline);
    if (!results.verdict.consequence.empty()) say(results.verdict.consequence);
    if (!statics_alone(results.built.front().plan)) say(results.verdict.step_check.sentence());
    say_facts(results.verdict.facts);
    say_criteria(results.verdict.numbers.criteria);
    const double per_step = main.counts.steps > 0 ? 1e6 * main.wall / static_cast<double>(main.counts.steps) : 0;
    if (statics_alone(results.built.front().plan))
      say(fmt::format("{}: static stages in {}, {}, {}", status_text(main), format_quantity(main.wall, "s"),
                      counted(main.counts.load_steps, "load step", "load steps"), counted(main.counts.retries, "retry", "retries")));
    else
      say(fmt::format("{}: {} in {} ({:.2f} microseconds a step), {}", status_text(main), counted(main.counts.steps, "step", "steps"),
                      format_quantity(main.wall, "s"), per_step, counted(main.counts.retries, "retry", "retries")));
    say(fmt::format("results: {}/report.html", folder.path()));
    for (const std::string& list : fields) say(fmt::format("fields: {}/{} (for ParaView)", folder.path(), list));
  }
  if (main.status == RunStatus::interrupted) {
    if (!options.quiet) complain(fmt::format("{} at t = {:g} s: the files hold everything up to there", interrupt_text(), main.end_time));
    return interrupt_exit_code();
  }
  if (interrupt_asked()) {
    if (!options.quiet)
      complain(interrupt_text() + ": the bonded run or the run with twice the step is not complete; what is compared with it is missing");
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

}  // namespace uplift::cli
