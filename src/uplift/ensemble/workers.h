#pragma once
#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "uplift/ensemble/compute.h"

namespace uplift {

/// What a worker may use.
struct WorkerLimits {
  std::optional<double> timeout;  // s: of one run, far beyond what the run itself keeps to
  std::optional<double> memory;   // MB of address space beyond what it shares at its beginning
};

/// Processes that are forked from this one and share its memory until they write to it. This process starts no thread before.
class WorkerPool {
 public:
  /// `compute` is called in the workers: with a batch, with what is to be called with each result, and with what is told how far they are.
  using Compute =
      std::function<void(const std::vector<RunRequest>&, const std::function<void(const StudyResult&)>& done, const WatchRuns& watch)>;
  WorkerPool(int count, const WorkerLimits& limits, Compute compute);
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;
  /// Ends all workers at once; what they compute is lost.
  ~WorkerPool();

  std::size_t size() const { return workers_.size(); }
  /// Runs that a worker was given and has not told the results of.
  const std::deque<RunRequest>& outstanding(std::size_t worker) const { return workers_[worker].outstanding; }
  /// How much of these is done, in runs.
  double marched(std::size_t worker) const;
  /// Gives a worker a batch.
  void send(std::size_t worker, const std::vector<RunRequest>& batch);

  /// How a worker ended, and with which runs. It is replaced by a new one.
  struct Death {
    std::deque<RunRequest> lost;  // the first one was computed
    bool too_long = false;        // it was ended because of its time
    bool killed = false;          // from outside: by the user, or by the system for want of memory
    std::string how;              // "signal 11 (Segmentation fault)"
  };
  struct Events {
    std::vector<StudyResult> results;
    std::vector<Death> deaths;
  };
  /// Waits for events, at most so long.
  Events wait(std::chrono::milliseconds most);

 private:
  using Clock = std::chrono::steady_clock;
  struct Worker {
    pid_t process = -1;
    int channel = -1;
    std::deque<RunRequest> outstanding;
    Clock::time_point since;  // the first of them is computed
    std::string received;     // bytes of a message that is not complete
    bool too_long = false;
  };
  void start(Worker& worker);
  std::atomic<double>& marched_of(const Worker& worker) const;
  [[noreturn]] void work(int channel, std::atomic<double>& marched) const;
  bool receive(Worker& worker, Events& events) const;
  Death bury(Worker& worker);
  const WorkerLimits limits_;
  const Compute compute_;
  std::vector<Worker> workers_;
  std::shared_ptr<std::atomic<double>[]> marched_;  // of every worker, in memory that all processes share
};

}  // namespace uplift
