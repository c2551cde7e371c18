#pragma once
#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <span>

#include "uplift/ensemble/study.h"
#include "uplift/session/reduce.h"
#include "uplift/study/study_run.h"

namespace uplift {

/// One run to be computed.
struct RunRequest {
  std::string id;
  std::size_t curve = 0, sample = 0, motion = 0;
  double factor = 1, intensity = 1;
  long attempt = 1;
};

template <class Archive, SameAs<RunRequest> T>
void list_parts(Archive& archive, T& request) {
  archive(request.id, request.curve, request.sample, request.motion, request.factor, request.intensity, request.attempt);
}

/// Asked now and then while runs are computed; false ends those that are, as if their motions were that short. `marched`: how much of the
/// runs of which no result was told is done, in runs.
using WatchRuns = std::function<bool(double marched)>;

/// Computes runs of a study. What does not depend on the run is kept: the checked cases of the last samples.
class StudyComputer {
 public:
  explicit StudyComputer(const Study& study) : study_(study) {}
  /// Makes what the runs of a sample share, so that processes forked from this one have it.
  void prepare(std::size_t sample) { case_of(sample); }
  /// Throws InputError where the reduced model of the study is not that of every sample: said before any run.
  void check_reduced();
  /// How many runs of one sample are best computed together: several where the model is so large that they march in lockstep.
  std::size_t best_together(const RunRequest& one);
  /// Runs of one sample, a group: they are told one by one as they end. Never throws for one of them: what went wrong is its outcome.
  void compute(std::span<const RunRequest> group, const std::function<void(const StudyResult&)>& done, const WatchRuns& watch = {});
  /// One run; throws what goes wrong.
  StudyResult compute(const RunRequest& request);

 private:
  const Case& case_of(std::size_t sample);
  bool marches_in_lockstep(const BuiltCase& built) const;
  StudyResult finish(const RunRequest& request, const BuiltCase& built, RunResult run) const;
  StudyResult compute(const RunRequest& request, BuiltCase& built);
  bool goes_on(double marched);
  Watch watch_of_run();
  RunSpec spec_of(const RunRequest& request, const Case& read) const;
  std::optional<StudyResult> compute_again(const RunRequest& request);
  RunResult run_reduced(BuiltCase& built, const Watch& watch, std::optional<ReducedStart>& shared) const;
  void compute_in_lockstep(std::span<const RunRequest> group, BuiltCase first, const std::function<void(const StudyResult&)>& done);
  BuiltCase build_run(const RunRequest& request);

  const Study& study_;
  WatchRuns watch_;                                                       // of the group that is computed
  bool ended_ = false;                                                    // by it, the run or those in lockstep
  std::list<std::pair<std::size_t, std::unique_ptr<const Case>>> cases_;  // the last used one first
  std::optional<ReducedStart> start_;                                     // of the last run with a reduced model
  std::size_t start_sample_ = 0;                                          // that it belongs to
  std::optional<BuiltCase> ran_;                                          // that run, without its matrices
};

/// The result of a run that gave none.
StudyResult result_without_run(const Study& study, const RunRequest& request, StudyOutcome outcome, const std::string& reason);

/// Folder of a run whose files were written: of one that failed, or was chosen. `folder`: of the study.
std::string run_folder(const std::string& folder, const std::string& id);
/// Writes the case of a run there, as `uplift run` takes it.
void write_run_case(const Study& study, const std::string& id, std::size_t sample, std::size_t motion, double factor);

}  // namespace uplift
