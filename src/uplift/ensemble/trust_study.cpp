#include "uplift/ensemble/trust_study.h"

#include <algorithm>
#include <filesystem>

#include "uplift/base/file.h"
#include "uplift/case/decided.h"
#include "uplift/ensemble/pool_coordinator.h"

namespace uplift {
namespace {

class TrustCoordinator : public PoolCoordinator {
 public:
  TrustCoordinator(const TrustSamples& samples, const std::string& folder, StudyStore& store, const TrustStudyControl& control)
      : PoolCoordinator(folder), samples_(samples.samples), folder_(folder), store_(store), control_(control) {
    std::filesystem::create_directories(folder + "/parts");
    for (std::size_t i = 0; i < samples_.size(); ++i)
      if (result_of(i) == nullptr) add({.id = samples_[i].id, .sample = i, .attempt = store.attempts(samples_[i].id) + 1});
  }

  TrustResults go() {
    if (!waiting().empty() && !(control_.stopped && control_.stopped()))
      compute_all({.workers = control_.workers, .stopped = control_.stopped});
    tell();
    TrustResults results(samples_.size());
    for (std::size_t i = 0; i < samples_.size(); ++i)
      if (const StudyResult* found = store_.find(samples_[i].id)) results[i] = *found;
    return results;
  }

 private:
  /// What a machine is to blame for counts as not computed.
  const StudyResult* result_of(std::size_t sample) const {
    const StudyResult* found = store_.find(samples_[sample].id);
    const bool of_machine = found != nullptr && (found->outcome == StudyOutcome::memory || found->outcome == StudyOutcome::crashed);
    return of_machine ? nullptr : found;
  }

  void compute(const std::vector<RunRequest>& batch, const std::function<void(const StudyResult&)>& done, const WatchRuns&) override {
    for (const RunRequest& request : batch) {
      StudyResult result;
      try {
        std::string problem;
        result = compute_sample(samples_[request.sample], {}, problem);
        if (!problem.empty()) {
          std::filesystem::create_directories(run_folder(folder_, request.id));
          write_file_atomically(run_folder(folder_, request.id) + "/problem.json", problem);
        }
      } catch (const std::bad_alloc&) {
        result = without_run(request, StudyOutcome::memory, "it needed more memory than there is");
      } catch (const std::exception& error) {
        result = without_run(request, StudyOutcome::failed, error.what());
      }
      result.attempt = request.attempt;
      done(result);
    }
  }

  void note(const StudyResult& result) override {
    store_.add(result);
    if (says_something(result.outcome)) return;
    const auto sample = std::ranges::find(samples_, result.id, &TrustSample::id);
    std::filesystem::create_directories(run_folder(folder_, result.id));
    write_file_atomically(run_folder(folder_, result.id) + "/case.resolved.toml",
                          to_toml(sample->read.values, decided_texts(sample->read)));
  }

  StudyResult without_run(const RunRequest& request, StudyOutcome outcome, const std::string& reason) const override {
    StudyResult made;
    made.id = request.id;
    made.outcome = outcome;
    made.reason = reason;
    made.attempt = request.attempt;
    return made;
  }

  void tell() override {
    sync();
    if (!control_.follow) return;
    const auto done = std::ranges::count_if(samples_, [&](const TrustSample& each) { return store_.find(each.id) != nullptr; });
    control_.follow(static_cast<std::size_t>(done), samples_.size());
  }

  const std::vector<TrustSample>& samples_;
  const std::string& folder_;
  StudyStore& store_;
  const TrustStudyControl& control_;
};

}  // namespace

TrustResults compute_trust_study(const TrustSamples& samples, const std::string& folder, StudyStore& store,
                                 const TrustStudyControl& control) {
  return TrustCoordinator(samples, folder, store, control).go();
}

}  // namespace uplift
