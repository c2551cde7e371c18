#include "uplift/ensemble/coordinator.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

#include "uplift/ensemble/part_file.h"
#include "uplift/ensemble/workers.h"
#include "uplift/io/files.h"

namespace uplift {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double most_of_batch = 16;
constexpr std::chrono::milliseconds between_syncs{100}, longest_wait{200};

/// Runs that wait for a worker, by their sample: those of one sample share its case.
class Waiting {
 public:
  void add(RunRequest request) { by_sample_[request.sample].push_back(std::move(request)), ++size_; }
  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  const RunRequest& first() const { return by_sample_.begin()->second.front(); }
  /// The next runs of one sample, of `preferred` where it has any; else of the first sample that no other worker is busy with.
  std::vector<RunRequest> take(std::size_t most, std::optional<std::size_t> preferred, const std::vector<std::size_t>& busy) {
    if (empty()) return {};
    auto found = preferred ? by_sample_.find(*preferred) : by_sample_.end();
    if (found == by_sample_.end())
      found = std::ranges::find_if(by_sample_, [&](const auto& each) { return std::ranges::find(busy, each.first) == busy.end(); });
    if (found == by_sample_.end()) found = by_sample_.begin();
    std::vector<RunRequest> batch;
    std::deque<RunRequest>& queue = found->second;
    while (batch.size() < most && !queue.empty()) {
      batch.push_back(std::move(queue.front()));
      queue.pop_front();
    }
    size_ -= batch.size();
    if (queue.empty()) by_sample_.erase(found);
    return batch;
  }

 private:
  std::map<std::size_t, std::deque<RunRequest>> by_sample_;
  std::size_t size_ = 0;
};

class Coordinator {
 public:
  Coordinator(const Study& study, StudyStore& store, const StudyRunControl& control)
      : study_(study),
        store_(store),
        control_(control),
        curves_(study_curves(study.of)),
        parts_(study.folder + "/parts"),
        computer_(study) {
    std::filesystem::create_directories(study.folder + "/parts");
    for (std::size_t i = 0; i < curves_.size(); ++i)
      if (control.shard.has(i)) ask(i);
  }

  StudyStatus go() {
    if (!waiting_.empty()) {
      check_samples();
      compute();
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
        waiting_.add({point.id, number, curve.sample(), curve.motion(), point.factor, point.intensity, store_.attempts(point.id) + 1});
  }

  /// Refuses samples that are no case before anything is computed; a mesh is not made for it.
  void check_samples() const {
    if (study_.of.edits_mesh || study_.of.samples.size() == 1) return;
    std::set<std::size_t> samples;
    for (std::size_t i = 0; i < curves_.size(); ++i)
      if (control_.shard.has(i) && !curves_[i].complete()) samples.insert(curves_[i].sample());
    for (const std::size_t sample : samples) case_of_sample(study_.of, sample);
  }

  void compute() {
    if (study_.of.samples.size() == 1) computer_.prepare(0);
    together_ = computer_.best_together(waiting_.first());
    const StudyPlan& plan = study_.of.plan;
    WorkerLimits limits{std::nullopt, plan.memory};
    if (plan.timeout) limits.timeout = 2 * *plan.timeout + 10;
    WorkerPool pool(control_.workers, limits,
                    [this](const std::vector<RunRequest>& batch, const auto& done) { computer_.compute(batch, done); });
    last_sample_.resize(pool.size());
    while (!(control_.stopped && control_.stopped())) {
      feed(pool);
      if (waiting_.empty() && idle(pool)) break;
      take(pool.wait(longest_wait));
      if (Clock::now() - synced_ > between_syncs) tell();
    }
  }

  static bool idle(const WorkerPool& pool) {
    for (std::size_t i = 0; i < pool.size(); ++i)
      if (!pool.outstanding(i).empty()) return false;
    return true;
  }

  /// How many runs a worker gets at once: so few that all end together, and short ones by the dozen.
  std::size_t batch_size(const WorkerPool& pool) const {
    if (together_ > 1) return std::clamp((waiting_.size() + pool.size() - 1) / pool.size(), std::size_t{1}, together_);
    constexpr double long_batch = 0.05;  // s
    const double mean = computed_ > 0 ? wall_ / static_cast<double>(computed_) : long_batch;
    const auto most = static_cast<std::size_t>(std::clamp(long_batch / std::max(mean, 1e-6), 1.0, most_of_batch));
    return std::clamp(waiting_.size() / (4 * pool.size()), std::size_t{1}, most);
  }

  /// Every worker has a batch, and of short runs the next one too.
  void feed(WorkerPool& pool) {
    for (bool given = true; given && !waiting_.empty();) {
      given = false;
      const std::size_t batch = batch_size(pool);
      for (std::size_t i = 0; i < pool.size() && !waiting_.empty(); ++i) {
        if (pool.outstanding(i).size() > (batch > 1 && together_ == 1 ? batch / 2 : 0)) continue;
        std::vector<std::size_t> busy;
        for (std::size_t other = 0; other < pool.size(); ++other)
          if (other != i && last_sample_[other] && !pool.outstanding(other).empty()) busy.push_back(*last_sample_[other]);
        const std::vector<RunRequest> next = waiting_.take(batch, last_sample_[i], busy);
        last_sample_[i] = next.front().sample;
        pool.send(i, next);
        given = true;
      }
    }
  }

  /// What has come is written; on the disk it is at the next tell().
  void take(const WorkerPool::Events& events) {
    for (const StudyResult& result : events.results) note(result);
    for (const WorkerPool::Death& death : events.deaths) take(death);
    parts_.append(lines_);
    lines_.clear();
    for (const std::size_t curve : std::exchange(changed_, {})) ask(curve);
  }

  void note(const StudyResult& result) {
    lines_ += line_of(result);
    ++computed_;
    wall_ += result.wall;
    store_.add(result);
    const std::size_t number = curve_of_.at(result.id);
    changed_.insert(number);
    if (!says_something(result.outcome))
      write_run_case(study_, result.id, curves_[number].sample(), curves_[number].motion(), result.factor);
  }

  /// A run whose worker dies is tried again a few times, more often where the run itself is not to blame. Runs behind it are given to
  /// others.
  void take(const WorkerPool::Death& death) {
    constexpr int most_kills = 10;
    const int most = death.killed ? std::max(most_kills, study_.of.plan.attempts) : study_.of.plan.attempts;
    for (std::size_t i = 0; i < death.lost.size(); ++i) {
      const RunRequest& request = death.lost[i];
      if (i > 0 || (!death.too_long && ++tries_[request.id] < most)) {
        waiting_.add(request);
        continue;
      }
      const StudyOutcome outcome = death.too_long ? StudyOutcome::timeout : StudyOutcome::crashed;
      note(result_without_run(study_, request, outcome,
                              death.too_long ? "its worker did not answer any more" : "its worker ended with " + death.how));
    }
  }

  void tell() {
    parts_.sync();
    synced_ = Clock::now();
    status_ = status_of(curves_, control_.shard);
    status_.computed = computed_;
    status_.seconds = std::chrono::duration<double>(synced_ - started_).count();
    if (control_.follow) control_.follow(status_);
  }

  const Study& study_;
  StudyStore& store_;
  const StudyRunControl& control_;
  std::vector<StudyCurve> curves_;
  PartFile parts_;
  StudyComputer computer_;
  Waiting waiting_;
  std::size_t together_ = 1;                               // runs of a sample that are best computed at once
  std::unordered_map<std::string, std::size_t> curve_of_;  // of every run that was asked for
  std::unordered_map<std::string, int> tries_;
  std::vector<std::optional<std::size_t>> last_sample_;
  std::set<std::size_t> changed_;  // curves with new results
  std::string lines_;              // not written yet
  std::size_t computed_ = 0;
  double wall_ = 0;  // s of all computed runs
  Clock::time_point started_ = Clock::now(), synced_ = started_;
  StudyStatus status_;
};

}  // namespace

std::optional<double> StudyStatus::left() const {
  if (computed == 0 || expected < runs) return std::nullopt;
  return seconds / static_cast<double>(computed) * static_cast<double>(expected - runs);
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
