#include "uplift/ensemble/pool_coordinator.h"

#include <algorithm>

namespace uplift {
namespace {

constexpr double most_of_batch = 16;
constexpr std::chrono::milliseconds between_syncs{100}, longest_wait{200};

bool idle(const WorkerPool& pool) {
  for (std::size_t i = 0; i < pool.size(); ++i)
    if (!pool.outstanding(i).empty()) return false;
  return true;
}

}  // namespace

std::vector<RunRequest> Waiting::take(std::size_t most, std::optional<std::size_t> preferred, const std::vector<std::size_t>& busy) {
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

void PoolCoordinator::compute_all(const Plan& plan) {
  plan_ = plan;
  WorkerPool pool(plan.workers, plan.limits,
                  [this](const std::vector<RunRequest>& batch, const auto& done, const WatchRuns& watch) { compute(batch, done, watch); });
  last_sample_.resize(pool.size());
  while (!(plan.stopped && plan.stopped())) {
    feed(pool);
    if (waiting_.empty() && idle(pool)) break;
    take(pool.wait(longest_wait));
    look_at(pool);
    if (Clock::now() - synced_ > between_syncs) tell();
  }
  in_progress_ = 0, marched_ = 0;  // what was not ended is lost
}

void PoolCoordinator::look_at(const WorkerPool& pool) {
  in_progress_ = 0, marched_ = 0;
  for (std::size_t i = 0; i < pool.size(); ++i) in_progress_ += pool.outstanding(i).size(), marched_ += pool.marched(i);
}

/// How many runs a worker gets at once: so few that all end together, and short ones by the dozen.
std::size_t PoolCoordinator::batch_size(const WorkerPool& pool) const {
  const std::size_t together = plan_.together;
  if (together > 1) return std::clamp((waiting_.size() + pool.size() - 1) / pool.size(), std::size_t{1}, together);
  constexpr double long_batch = 0.05;  // s
  const double mean = computed_ > 0 ? wall_ / static_cast<double>(computed_) : long_batch;
  const auto most = static_cast<std::size_t>(std::clamp(long_batch / std::max(mean, 1e-6), 1.0, most_of_batch));
  return std::clamp(waiting_.size() / (4 * pool.size()), std::size_t{1}, most);
}

/// Every worker has a batch, and of short runs the next one too.
void PoolCoordinator::feed(WorkerPool& pool) {
  for (bool given = true; given && !waiting_.empty();) {
    given = false;
    const std::size_t batch = batch_size(pool);
    for (std::size_t i = 0; i < pool.size() && !waiting_.empty(); ++i) {
      if (pool.outstanding(i).size() > (batch > 1 && plan_.together == 1 ? batch / 2 : 0)) continue;
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
void PoolCoordinator::take(const WorkerPool::Events& events) {
  for (const StudyResult& result : events.results) keep(result);
  for (const WorkerPool::Death& death : events.deaths) take(death);
  parts_.append(lines_);
  lines_.clear();
  follow();
}

void PoolCoordinator::keep(const StudyResult& result) {
  lines_ += line_of(result);
  ++computed_;
  wall_ += result.wall;
  note(result);
}

/// A run whose worker dies is tried again a few times, more often where the run itself is not to blame. Runs behind it are given to
/// others.
void PoolCoordinator::take(const WorkerPool::Death& death) {
  constexpr int most_kills = 10;
  const int most = death.killed ? std::max(most_kills, plan_.attempts) : plan_.attempts;
  for (std::size_t i = 0; i < death.lost.size(); ++i) {
    const RunRequest& request = death.lost[i];
    if (i > 0 || (!death.too_long && ++tries_[request.id] < most)) {
      waiting_.add(request);
      continue;
    }
    const StudyOutcome outcome = death.too_long ? StudyOutcome::timeout : StudyOutcome::crashed;
    keep(without_run(request, outcome, death.too_long ? "its worker did not answer any more" : "its worker ended with " + death.how));
  }
}

}  // namespace uplift
