#include <future>

#include "uplift/linear/memory.h"
#include "uplift/session/steps.h"
#include "uplift/verdict/edge_warnings.h"
#include "uplift/verdict/result_warnings.h"
#include "uplift/verdict/second_order.h"

namespace uplift {
namespace {

/// The runs with twice the step: at the same time as the others where they are small, after them where memory counts.
class CompanionRuns {
 public:
  CompanionRuns(const LoadedCase& loaded, const Control& control) : loaded_(loaded), control_(control) {
    if (control.step_check) specs_ = companions_of_case(loaded.read);
  }
  /// Begins to compute a case that is small.
  void begin(const BuiltCase& base) {
    constexpr int small_model = 3000;  // free unknowns
    if (!specs_.empty() && base.model.free() <= small_model && runs_side_by_side(2) == 2)
      at_the_same_time_ = std::async(std::launch::async | std::launch::deferred, [this] { compute(true); });
  }
  /// What the verdict is compared with; null when nothing was computed.
  const Companion* finish() {
    if (at_the_same_time_.valid())
      at_the_same_time_.get();
    else if (!control_.is_stopped())
      compute(false);
    if (runs_.empty()) return nullptr;
    companion_ = {&built_.front(), &runs_.front(), runs_.size() > 1 ? &runs_[1] : nullptr};
    return &companion_;
  }

 private:
  void compute(bool silent) {
    Control control = control_;
    if (silent) control.watch = {};
    for (const RunSpec& spec : specs_) {
      append_run(loaded_, spec, built_);
      runs_.push_back(run_built(loaded_, built_.back(), spec.label, control, false, nullptr));
      free_matrices(built_.back());
    }
  }

  const LoadedCase& loaded_;
  const Control& control_;
  std::vector<RunSpec> specs_;
  std::deque<BuiltCase> built_;
  std::vector<RunResult> runs_;
  std::future<void> at_the_same_time_;
  Companion companion_;
};

}  // namespace

Results run_case(const LoadedCase& loaded, const Control& control) {
  Results results;
  CompanionRuns companions(loaded, control);
  for (const RunSpec& spec : runs_of_case(loaded.read)) {
    if (control.is_stopped() && !results.runs.empty()) break;
    const bool first = results.runs.empty();
    results.specs.push_back(spec);
    append_run(loaded, spec, results.built);
    if (first) companions.begin(results.built.front());
    if (first) results.warnings = warnings(loaded.read, spec, results.built.front());
    if (first) add_statement(loaded, results.warnings);
    results.runs.push_back(
        run_built(loaded, results.built.back(), spec.label, control, first, &results.field_lists, first ? "histories.csv" : ""));
    free_matrices(results.built.back());
  }
  const RunResult& main = results.runs.front();
  results.floors = floor_answers(results.built.front().plan, results.runs, results.specs);
  const Companion* companion = main.status == RunStatus::failed ? nullptr : companions.finish();
  results.verdict =
      judge(results.built.front(), main, results.runs.size() > 1 ? &results.runs[1] : nullptr, &results.floors.runs.front(), companion);
  for (std::string& warning : result_warnings(main, results.verdict.numbers)) results.warnings.push_back(std::move(warning));
  for (std::string& warning : edge_warnings(results.built.front(), results.verdict.numbers)) results.warnings.push_back(std::move(warning));
  if (const auto effects = second_order_of(results.built.front(), main, results.verdict.numbers); effects && effects->counts())
    results.warnings.push_back(effects->warning());
  return results;
}

}  // namespace uplift
