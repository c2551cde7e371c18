#include "uplift/cli/study_trials.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "uplift/cli/console.h"
#include "uplift/cli/study.h"
#include "uplift/ensemble/workers.h"

namespace uplift::cli {
namespace {

/// Processor time [s] of this process: unlike the elapsed time it does not depend on what else the machine does. getrusage() counts it in
/// ticks of some milliseconds.
double processor_time() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Ends trial runs that take long, and says by their pace what the rest of them would have taken.
class Pace {
 public:
  /// `runs`: that are marched side by side.
  explicit Pace(std::size_t runs) : runs_(static_cast<double>(runs)) {}
  /// `marched`: in runs. False where enough is known.
  bool operator()(double marched) {
    constexpr double enough = 15;  // s
    if (!first_) first_ = {processor_time(), marched};
    const double taken = processor_time() - first_->time;
    if (taken < enough || marched <= first_->marched) return true;
    rest_ = taken / (marched - first_->marched) * (runs_ - marched);
    return false;
  }
  /// Processor time of the rest [s], told once.
  double take_rest() { return std::exchange(rest_, 0); }

 private:
  struct Instant {
    double time = 0, marched = 0;
  };
  double runs_, rest_ = 0;
  std::optional<Instant> first_;
};

/// Most memory that a worker has held so far [bytes].
double largest_memory() {
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

double mean_time(std::span<const StudyResult> results) {
  return std::accumulate(results.begin(), results.end(), 0.0, [](double sum, const StudyResult& run) { return sum + run.wall; }) /
         static_cast<double>(results.size());
}

class TrialRuns {
 public:
  TrialRuns(const Study& study, StudyComputer& computer, const RunRequest& trial, bool quiet)
      : study_(study), computer_(computer), trial_(trial), most_together_(computer.best_together(trial)), line_(quiet) {}

  Trials go(const StudyStatus& status) {
    Trials found;
    found.together = group_size(status);
    if (study_.reduced) {
      of_reduced(found);
    } else {
      found.first = compute({trial_}).front();
      found.seconds = seconds_of(found.first.wall);
    }
    found.memory = largest_memory();
    if (found.together > 1) of_group(found);
    return found;
  }

 private:
  /// A reduced model is begun once for all motions of a sample: the second run tells what the others take.
  void of_reduced(Trials& found) {
    const std::vector<StudyResult> runs = compute(group(2));
    found.first = runs.front();
    found.seconds = runs.back().wall;
    if (runs.size() == 2) found.before = std::max(0.0, found.first.wall - found.seconds);
  }

  /// Time of a run on one core [s], from that of the first one of a worker. Where that is short, most of it is code and memory that are
  /// touched for the first time: then it is what further runs take.
  double seconds_of(double alone) {
    constexpr double short_run = 0.1;  // s
    constexpr std::size_t further = 10;
    if (alone > short_run) return alone;
    const std::vector<StudyResult> runs = compute(group(further + 1));
    return runs.size() > further ? mean_time(std::span(runs).subspan(1)) : alone;  // the process may have died
  }

  /// A worker's time and memory with a group of runs in lockstep. The second run costs more memory than those behind it: until it shares
  /// the matrices of the first one, it has its own, and what it gives back serves the next ones. So a run more is what four take more than
  /// two.
  void of_group(Trials& found) {
    constexpr std::size_t few = 2, more = 4;
    double with_few = 0;
    if (found.together > more) compute(group(few)), with_few = largest_memory();
    const std::vector<StudyResult> runs = compute(group(std::min(found.together, more)));
    if (std::ranges::all_of(runs, [](const StudyResult& run) { return says_something(run.outcome); })) found.seconds = mean_time(runs);
    found.memory = largest_memory();
    if (found.together > more) found.memory += static_cast<double>(found.together - more) * (found.memory - with_few) / (more - few);
  }

  /// Runs of a worker's group: as many as it would be given.
  std::size_t group_size(const StudyStatus& status) const {
    const auto workers = static_cast<std::size_t>(study_.of.plan.workers > 0 ? study_.of.plan.workers : cores());
    const std::size_t runs = std::max(study_.of.plan.method.searches() ? status.curves : status.expected, std::size_t{1});
    const std::size_t of_sample = (runs + study_.of.samples.size() - 1) / study_.of.samples.size();
    return std::min({most_together_, (runs + workers - 1) / workers, of_sample});
  }

  std::vector<RunRequest> group(std::size_t runs) const {
    std::vector<RunRequest> made(runs, trial_);
    for (std::size_t i = 0; i < runs; ++i) {
      made[i].id = fmt::format("trial {}", i);
      made[i].motion = i % study_.of.motions.size();
    }
    return made;
  }

  /// Runs as a worker of the study computes them, in a process of its own; the results of those before it ended. Their times are what each
  /// takes of the processor; of those that march in lockstep, the first one has the time of all.
  std::vector<StudyResult> compute(const std::vector<RunRequest>& runs) {
    WorkerPool pool(1, {std::nullopt, study_.of.plan.memory},
                    [this](const std::vector<RunRequest>& batch, const auto& done, const WatchRuns& watch) { work(batch, done, watch); });
    pool.send(0, runs);
    std::vector<StudyResult> results;
    while (results.size() < runs.size()) {
      const WorkerPool::Events events = pool.wait(std::chrono::milliseconds(200));
      line_(fmt::format("trial of {} run{}: {:.1f} % done", runs.size(), runs.size() > 1 ? "s" : "",
                        100 * (static_cast<double>(results.size()) + pool.marched(0)) / static_cast<double>(runs.size())));
      results.insert(results.end(), events.results.begin(), events.results.end());
      for (const WorkerPool::Death& death : events.deaths) {
        results.push_back(result_without_run(study_, death.lost.front(), StudyOutcome::crashed, "its process ended with " + death.how));
        return results;
      }
    }
    return results;
  }

  /// In the worker.
  void work(const std::vector<RunRequest>& batch, const std::function<void(const StudyResult&)>& done, const WatchRuns& watch) {
    const bool side_by_side = most_together_ > 1;
    const Pace start(side_by_side ? batch.size() : 1);
    Pace pace = start;
    double last = processor_time(), told = 0;
    const auto tell = [&](StudyResult result) {
      const double now = processor_time();
      result.wall = now - std::exchange(last, now) + pace.take_rest();
      if (const std::optional<double>& most = study_.of.plan.timeout; most && result.wall > *most) {
        result.outcome = StudyOutcome::timeout;
        result.reason = fmt::format("it takes longer than {:g} s", *most);
        result.wall = *most;
      }
      if (side_by_side)
        ++told;
      else
        pace = start;
      done(result);
    };
    computer_.compute(batch, tell, [&](double marched) { return watch(marched) && pace(told + marched); });
  }

  const Study& study_;
  StudyComputer& computer_;
  const RunRequest& trial_;
  std::size_t most_together_;
  StatusLine line_;
};

}  // namespace

Trials run_trials(const Study& study, StudyComputer& computer, const RunRequest& trial, const StudyStatus& status, bool quiet) {
  return TrialRuns(study, computer, trial, quiet).go(status);
}

}  // namespace uplift::cli
