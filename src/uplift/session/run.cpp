#include <future>

#include "uplift/linear/memory.h"
#include "uplift/session/steps.h"
#include "uplift/verdict/edge_warnings.h"
#include "uplift/verdict/result_warnings.h"
#include "uplift/verdict/second_order.h"

namespace uplift {
namespace {

/// The runs with twice the step: of a small case at the same time as the others, of a large one each behind its run, with the same model
/// where no more than the steps differ; what is left after all others.
class CompanionRuns {
 public:
  CompanionRuns(const LoadedCase& loaded, const Control& control) : loaded_(loaded), control_(control) {
    if (control.step_check) specs_ = companions_of_case(loaded.read);
  }
  /// Begins to compute a case that is small.
  void begin(const BuiltCase& base) {
    if (!specs_.empty() && base.model.free() <= small_model && runs_side_by_side(2) == 2)
      at_the_same_time_ = std::async(std::launch::async | std::launch::deferred, [this] { compute(true); });
  }
  /// After a run, which stays as it is: its companion, with its model.
  void follow(const RunSpec& spec, BuiltCase& built) {
    const std::size_t number = runs_.size();
    if (at_the_same_time_.valid() || control_.is_stopped() || number >= specs_.size() || built.model.free() <= small_model) return;
    const RunSpec& own = specs_[number];
    if (own.bonded != spec.bonded || loaded_.from.reduced != nullptr || !change_steps(loaded_.read, own, built)) return;
    add(built, own, control_);
    change_steps(loaded_.read, spec, built);
  }
  /// What the verdict is compared with; null when nothing was computed.
  const Companion* finish() {
    if (at_the_same_time_.valid())
      at_the_same_time_.get();
    else if (!control_.is_stopped())
      compute(false);
    if (runs_.empty()) return nullptr;
    companion_ = {of_runs_.front(), step_, &runs_.front(), runs_.size() > 1 ? &runs_[1] : nullptr};
    return &companion_;
  }

 private:
  void compute(bool silent) {
    Control control = control_;
    if (silent) control.watch = {};
    while (runs_.size() < specs_.size()) {
      const RunSpec& spec = specs_[runs_.size()];
      append_run(loaded_, spec, built_);
      add(built_.back(), spec, control);
      free_matrices(built_.back());
    }
  }
  void add(BuiltCase& built, const RunSpec& spec, const Control& control) {
    if (runs_.empty()) step_ = longest_step(built.plan);
    runs_.push_back(run_built(loaded_, built, spec.label, control, false, nullptr));
    of_runs_.push_back(&built);
  }

  static constexpr int small_model = 3000;  // free unknowns

  const LoadedCase& loaded_;
  const Control& control_;
  std::vector<RunSpec> specs_;
  std::deque<BuiltCase> built_;
  std::deque<RunResult> runs_;
  std::vector<const BuiltCase*> of_runs_;
  double step_ = 0;  // s: of the first one
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
    if (results.runs.front().status != RunStatus::failed) companions.follow(spec, results.built.back());
    free_matrices(results.built.back());
  }
  const RunResult& main = results.runs.front();
  results.floors = floor_answers(results.built.front().plan, results.runs, results.specs);
  const Companion* companion = main.status == RunStatus::failed ? nullptr : companions.finish();
  results.verdict =
      judge(results.built.front(), main, results.runs.size() > 1 ? &results.runs[1] : nullptr, &results.floors.runs.front(), companion);
  for (std::string& warning : result_warnings(main, results.verdict.numbers)) results.warnings.push_back(std::move(warning));
  for (std::string& warning : edge_warnings(results.built.front(), results.verdict.numbers)) results.warnings.push_back(std::move(warning));
  const CaseDamping* damping = results.specs.front().damping;
  const double beta = damping != nullptr ? damping->made.beta : loaded.read.input->damping ? loaded.read.input->damping->made.beta : 0;
  if (std::string warning = damped_impacts(results.built.front(), results.verdict.numbers, beta); !warning.empty())
    results.warnings.push_back(std::move(warning));
  if (const auto effects = second_order_of(results.built.front(), main, results.verdict.numbers); effects && effects->counts())
    results.warnings.push_back(effects->warning());
  return results;
}

}  // namespace uplift
