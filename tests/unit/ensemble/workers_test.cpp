#include "uplift/ensemble/workers.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <set>

// Workers: every run has one result or is lost with its worker, and a worker that has ended is replaced.
namespace uplift {
namespace {

using Done = std::function<void(const StudyResult&)>;

/// "die": the worker is killed. "hang": it does not come back. All others have a result at once.
void compute(const std::vector<RunRequest>& batch, const Done& done) {
  for (const RunRequest& request : batch) {
    if (request.id == "die") ::kill(::getpid(), SIGKILL);
    if (request.id == "hang") ::sleep(100);
    StudyResult result;
    result.id = request.id;
    result.numbers = {{"max_opening", "soil", request.factor}};
    result.reason = std::to_string(::getpid());
    done(result);
  }
}

RunRequest request(const std::string& id) {
  RunRequest made;
  made.id = id;
  made.factor = 0.1;
  return made;
}

/// Waits until nothing is outstanding.
WorkerPool::Events all_of(WorkerPool& pool) {
  WorkerPool::Events all;
  const auto busy = [&] {
    for (std::size_t i = 0; i < pool.size(); ++i)
      if (!pool.outstanding(i).empty()) return true;
    return false;
  };
  while (busy()) {
    WorkerPool::Events some = pool.wait(std::chrono::milliseconds(50));
    all.results.insert(all.results.end(), some.results.begin(), some.results.end());
    all.deaths.insert(all.deaths.end(), some.deaths.begin(), some.deaths.end());
  }
  return all;
}

TEST(WorkerPool, EveryRunHasAResult) {
  WorkerPool pool(3, {}, compute);
  for (std::size_t i = 0; i < 30; ++i) pool.send(i % 3, {request(std::to_string(2 * i)), request(std::to_string(2 * i + 1))});
  const WorkerPool::Events events = all_of(pool);
  EXPECT_TRUE(events.deaths.empty());
  std::set<std::string> ids, processes;
  for (const StudyResult& result : events.results) {
    ids.insert(result.id);
    processes.insert(result.reason);
    EXPECT_EQ(result.numbers.at(0).value, 0.1);
  }
  EXPECT_EQ(ids.size(), 60U);
  EXPECT_EQ(processes.size(), 3U);
  EXPECT_FALSE(processes.contains(std::to_string(::getpid())));
}

TEST(WorkerPool, ADeadWorkerLosesItsBatchAndIsReplaced) {
  WorkerPool pool(2, {}, compute);
  pool.send(0, {request("a"), request("die"), request("b")});
  pool.send(1, {request("c")});
  const WorkerPool::Events events = all_of(pool);
  EXPECT_EQ(events.results.size(), 2U);
  ASSERT_EQ(events.deaths.size(), 1U);
  EXPECT_EQ(events.deaths[0].lost.size(), 2U);
  EXPECT_EQ(events.deaths[0].lost.front().id, "die");
  EXPECT_FALSE(events.deaths[0].too_long);
  EXPECT_TRUE(events.deaths[0].killed);
  EXPECT_TRUE(events.deaths[0].how.starts_with("signal 9")) << events.deaths[0].how;
  pool.send(0, {request("b")});
  EXPECT_EQ(all_of(pool).results.size(), 1U);
}

TEST(WorkerPool, AWorkerThatDoesNotComeBackIsEnded) {
  WorkerLimits limits;
  limits.timeout = 0.2;
  WorkerPool pool(1, limits, compute);
  pool.send(0, {request("hang"), request("a")});
  const WorkerPool::Events events = all_of(pool);
  ASSERT_EQ(events.deaths.size(), 1U);
  EXPECT_TRUE(events.deaths[0].too_long);
  EXPECT_EQ(events.deaths[0].lost.front().id, "hang");
}

}  // namespace
}  // namespace uplift
