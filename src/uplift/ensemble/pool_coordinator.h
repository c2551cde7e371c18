#pragma once
#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "uplift/ensemble/part_file.h"
#include "uplift/ensemble/workers.h"

namespace uplift {

/// Runs that wait for a worker, by their sample: those of one sample share its case.
class Waiting {
 public:
  void add(RunRequest request) { by_sample_[request.sample].push_back(std::move(request)), ++size_; }
  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  const RunRequest& first() const { return by_sample_.begin()->second.front(); }
  /// The next runs of one sample, of `preferred` where it has any; else of the first sample that no other worker is busy with.
  std::vector<RunRequest> take(std::size_t most, std::optional<std::size_t> preferred, const std::vector<std::size_t>& busy);

 private:
  std::map<std::size_t, std::deque<RunRequest>> by_sample_;
  std::size_t size_ = 0;
};

/// Gives runs to forked workers and appends their results to a part: what a study and the repetitions of `uplift trust` have in common.
class PoolCoordinator {
 public:
  explicit PoolCoordinator(const std::string& folder) : parts_(folder + "/parts") {}
  PoolCoordinator(const PoolCoordinator&) = delete;
  PoolCoordinator& operator=(const PoolCoordinator&) = delete;
  virtual ~PoolCoordinator() = default;

 protected:
  struct Plan {
    int workers = 1;
    WorkerLimits limits{};
    int attempts = 3;                 // of a run whose worker dies
    std::size_t together = 1;         // runs of a sample that are best computed at once
    std::function<bool()> stopped{};  // asked now and then: the computation ends in order
  };
  void add(RunRequest request) { waiting_.add(std::move(request)); }
  const Waiting& waiting() const { return waiting_; }
  /// Until nothing waits, or it is stopped. Throws OutputError.
  void compute_all(const Plan& plan);
  /// Everything that was told is on the disk from here on.
  void sync() { parts_.sync(), synced_ = Clock::now(); }
  std::size_t computed() const { return computed_; }
  /// Runs that workers compute now, and how much of these is done, in runs.
  std::size_t in_progress() const { return in_progress_; }
  double marched() const { return marched_; }
  /// s since the beginning.
  double seconds() const { return std::chrono::duration<double>(Clock::now() - started_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  /// Called in the workers.
  virtual void compute(const std::vector<RunRequest>& batch, const std::function<void(const StudyResult&)>& done,
                       const WatchRuns& watch) = 0;
  /// A result has come. It is not written yet.
  virtual void note(const StudyResult& result) = 0;
  /// Results are written: further runs may be added.
  virtual void follow() {}
  virtual StudyResult without_run(const RunRequest& request, StudyOutcome outcome, const std::string& reason) const = 0;
  /// Ten times a second. Calls sync().
  virtual void tell() = 0;

  std::size_t batch_size(const WorkerPool& pool) const;
  void feed(WorkerPool& pool);
  void look_at(const WorkerPool& pool);
  void take(const WorkerPool::Events& events);
  void take(const WorkerPool::Death& death);
  void keep(const StudyResult& result);

  Plan plan_;
  PartFile parts_;
  Waiting waiting_;
  std::unordered_map<std::string, int> tries_;
  std::vector<std::optional<std::size_t>> last_sample_;
  std::string lines_;  // not written yet
  std::size_t computed_ = 0, in_progress_ = 0;
  double marched_ = 0;
  double wall_ = 0;  // s of all computed runs
  Clock::time_point started_ = Clock::now(), synced_ = started_;
};

}  // namespace uplift
