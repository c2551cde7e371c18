#include "uplift/ensemble/coordinator.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <unordered_map>
#include <utility>

#include "uplift/ensemble/pool_coordinator.h"

namespace uplift {
namespace {

class Coordinator : public PoolCoordinator {
 public:
  Coordinator(const Study& study, StudyStore& store, const StudyRunControl& control)
      : PoolCoordinator(study.folder), study_(study), store_(store), control_(control), curves_(study_curves(study.of)), computer_(study) {
    std::filesystem::create_directories(study.folder + "/parts");
    for (std::size_t i = 0; i < curves_.size(); ++i)
      if (control.shard.has(i)) ask(i);
  }

  StudyStatus go() {
    if (!waiting().empty()) {
      check_samples();
      compute_all();
    }
    tell();
    return status_;
  }

 private:
  /// Puts what a curve wants now into the queue.
  void ask(std::size_t number) {
    StudyCurve& curve = curves_[number];
    for (const StudyPoint& point : curve.wanted(store_.finder()))
      if (curve_of_.emplace(point.id, number).second)
        add({point.id, number, curve.sample(), curve.motion(), point.factor, point.intensity, store_.attempts(point.id) + 1});
  }

  /// Refuses samples that are no case before anything is computed; a mesh is not made for it.
  void check_samples() const {
    if (study_.of.edits_mesh || study_.of.samples.size() == 1) return;
    std::set<std::size_t> samples;
    for (std::size_t i = 0; i < curves_.size(); ++i)
      if (control_.shard.has(i) && !curves_[i].complete()) samples.insert(curves_[i].sample());
    for (const std::size_t sample : samples) case_of_sample(study_.of, sample);
  }

  void compute_all() {
    if (study_.of.samples.size() == 1) computer_.prepare(0);
    const StudyPlan& plan = study_.of.plan;
    WorkerLimits limits{std::nullopt, plan.memory};
    if (plan.timeout) limits.timeout = 2 * *plan.timeout + 10;
    const std::size_t together = computer_.best_together(waiting().first());
    PoolCoordinator::compute_all({control_.workers, limits, plan.attempts, together, control_.stopped});
  }

  void compute(const std::vector<RunRequest>& batch, const std::function<void(const StudyResult&)>& done, const WatchRuns& watch) override {
    computer_.compute(batch, done, watch);
  }

  void note(const StudyResult& result) override {
    store_.add(result);
    const std::size_t number = curve_of_.at(result.id);
    changed_.insert(number);
    if (!says_something(result.outcome))
      write_run_case(study_, result.id, curves_[number].sample(), curves_[number].motion(), result.factor);
  }

  void follow() override {
    for (const std::size_t curve : std::exchange(changed_, {})) ask(curve);
  }

  StudyResult without_run(const RunRequest& request, StudyOutcome outcome, const std::string& reason) const override {
    return result_without_run(study_, request, outcome, reason);
  }

  void tell() override {
    sync();
    status_ = status_of(curves_, control_.shard);
    status_.computed = computed();
    status_.in_progress = in_progress();
    status_.marched = marched();
    status_.seconds = seconds();
    if (control_.follow) control_.follow(status_);
  }

  const Study& study_;
  StudyStore& store_;
  const StudyRunControl& control_;
  std::vector<StudyCurve> curves_;
  StudyComputer computer_;
  std::unordered_map<std::string, std::size_t> curve_of_;  // of every run that was asked for
  std::set<std::size_t> changed_;                          // curves with new results
  StudyStatus status_;
};

}  // namespace

double StudyStatus::rate() const {
  const double done = static_cast<double>(computed) + marched;
  return seconds > 0 && done >= 0.01 * static_cast<double>(in_progress) ? done / seconds : 0;
}

std::optional<double> StudyStatus::left() const {
  if (rate() == 0 || expected < runs) return std::nullopt;
  return std::max(0.0, static_cast<double>(expected - runs) - marched) / rate();
}

StudyStatus status_of(const std::vector<StudyCurve>& curves, const Shard& shard) {
  StudyStatus status;
  std::size_t of_complete = 0;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (!shard.has(i)) continue;
    ++status.curves;
    if (curves[i].complete()) ++status.complete, of_complete += curves[i].runs().size();
    status.runs += curves[i].runs().size();
    status.expected += curves[i].expected();
    for (const auto& [intensity, run] : curves[i].runs()) ++status.outcomes[static_cast<std::size_t>(run.result->outcome)];
  }
  const bool searches = !curves.empty() && !curves.front().searches().empty();
  if (searches && status.complete > 0) status.expected = std::max(status.runs, of_complete * status.curves / status.complete);
  return status;
}

StudyStatus run_study(const Study& study, StudyStore& store, const StudyRunControl& control) {
  return Coordinator(study, store, control).go();
}

std::vector<StudyCurve> curves_with_results(const Study& study, const StudyStore& store) {
  std::vector<StudyCurve> curves = study_curves(study.of);
  for (StudyCurve& curve : curves) curve.wanted(store.finder());
  return curves;
}

}  // namespace uplift
