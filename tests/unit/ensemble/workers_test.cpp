#include "uplift/ensemble/workers.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <set>

#include "uplift/linear/solver.h"

// Workers: every run has one result or is lost with its worker, and a worker that has ended is replaced.
namespace uplift::workers_test {
namespace {

using Done = std::function<void(const StudyResult&)>;

/// "die": the worker is killed. "hang": it does not come back. "slow": it tells that it is at 0.3, and has a result after 0.5 s. All others
/// have a result at once.
void compute(const std::vector<RunRequest>& batch, const Done& done, const WatchRuns& watch) {
  for (const RunRequest& request : batch) {
    if (request.id == "die") ::kill(::getpid(), SIGKILL);
    if (request.id == "slow" && watch(0.3)) ::usleep(500'000);
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

/// Springs between the neighbours of a square grid and to ground: its factor has columns enough for parallel loops.
Sparse large_matrix() {
  constexpr int side = 70;
  std::vector<Triplet> entries;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const int here = side * i + j;
      entries.emplace_back(here, here, 4.1);
      for (const int there : {i > 0 ? here - side : here, j > 0 ? here - 1 : here})
        if (there != here) entries.emplace_back(here, there, -1.0), entries.emplace_back(there, here, -1.0);
    }
  Sparse matrix(side * side, side * side);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

TEST(WorkerPool, AWorkerFactorisesAfterItsParentHas) {
  const Sparse matrix = large_matrix();
  const auto solver = solver_catalog().front()->make(Values());
  const double nonzeros = solver->factorise(matrix).factor->nonzeros();  // its threads are not in the workers
  WorkerPool pool(2, {}, [&](const std::vector<RunRequest>& batch, const Done& done, const WatchRuns&) {
    for (const RunRequest& each : batch) {
      StudyResult result;
      result.id = each.id;
      result.numbers = {{"nonzeros", "", solver->factorise(matrix).factor->nonzeros()}};
      done(result);
    }
  });
  for (const std::size_t worker : {0U, 1U}) pool.send(worker, {request(std::to_string(worker))});
  std::vector<StudyResult> results;
  const auto begin = std::chrono::steady_clock::now();
  while (results.size() < 2 && std::chrono::steady_clock::now() - begin < std::chrono::minutes(2)) {
    const WorkerPool::Events events = pool.wait(std::chrono::milliseconds(50));
    results.insert(results.end(), events.results.begin(), events.results.end());
  }
  ASSERT_EQ(results.size(), 2U) << "the workers wait for threads";
  for (const StudyResult& result : results) EXPECT_EQ(result.numbers.at(0).value, nonzeros);
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

TEST(WorkerPool, TellsHowFarItsRunsAre) {
  WorkerPool pool(2, {}, compute);
  pool.send(1, {request("slow"), request("a")});
  const auto begin = std::chrono::steady_clock::now();
  while (pool.marched(1) == 0 && std::chrono::steady_clock::now() - begin < std::chrono::minutes(1))
    pool.wait(std::chrono::milliseconds(5));
  EXPECT_EQ(pool.marched(1), 0.3);
  EXPECT_EQ(pool.marched(0), 0);
  all_of(pool);
  EXPECT_EQ(pool.marched(1), 0);
}

// A worker that ends before its runs do leaves nothing behind that counts for the next one.
TEST(WorkerPool, ALostRunIsNotHalfDone) {
  WorkerPool pool(1, {.timeout = 0.1, .memory = std::nullopt}, compute);
  pool.send(0, {request("slow")});
  ASSERT_EQ(all_of(pool).deaths.size(), 1U);
  EXPECT_EQ(pool.marched(0), 0);
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
}  // namespace uplift::workers_test
