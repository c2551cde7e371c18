// Memory: what the system leaves, what a factor will take, and the refusal of one that does not fit.
#include "uplift/linear/memory.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <barrier>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>
#include <vector>

#include "two_boxes.h"
#include "uplift/base/declare.h"
#include "uplift/dynamics/bulk.h"
#include "uplift/linear/rates.h"

namespace uplift::memory_test {
namespace {

/// Files of a system that is not this one.
class Machine {
 public:
  Machine() {
    std::string pattern = (std::filesystem::temp_directory_path() / "uplift-XXXXXX").string();
    root_ = mkdtemp(pattern.data());
  }
  ~Machine() { std::filesystem::remove_all(root_); }
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;
  void write(const std::string& path, const std::string& text) const {
    const std::filesystem::path file = root_ + "/" + path;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }
  double available() const { return available_memory(root_); }

 private:
  std::string root_;
};

TEST(Memory, LeastOfSystemAndControlGroups) {
  const Machine machine;
  EXPECT_EQ(machine.available(), std::numeric_limits<double>::infinity());  // nothing known
  machine.write("proc/meminfo", "MemTotal:  9000000 kB\nMemFree:  10 kB\nMemAvailable:    8000000 kB\n");
  EXPECT_EQ(machine.available(), 8192e6);
  machine.write("proc/self/cgroup", "0::/user/job\n");
  machine.write("sys/fs/cgroup/user/job/memory.max", "max\n");
  EXPECT_EQ(machine.available(), 8192e6);
  machine.write("sys/fs/cgroup/user/job/memory.max", "5000000000\n");
  machine.write("sys/fs/cgroup/user/job/memory.current", "2000000000\n");
  machine.write("sys/fs/cgroup/user/job/memory.stat", "anon 5\nfile 7\ninactive_file 500000000\n");
  EXPECT_EQ(machine.available(), 3.5e9);
  machine.write("sys/fs/cgroup/user/memory.max", "1000000000\n");  // the group above is tighter
  EXPECT_EQ(machine.available(), 1e9);
  machine.write("sys/fs/cgroup/user/memory.current", "1500000000\n");
  EXPECT_EQ(machine.available(), 0);
}

TEST(Memory, FirstVersionOfControlGroups) {
  const Machine machine;
  machine.write("proc/meminfo", "MemAvailable: 8000000 kB\n");
  machine.write("proc/self/cgroup", "3:cpuset:/\n2:cpu,memory:/box\n0::/\n");
  machine.write("sys/fs/cgroup/memory/box/memory.limit_in_bytes", "6000000000\n");
  machine.write("sys/fs/cgroup/memory/box/memory.usage_in_bytes", "4000000000\n");
  machine.write("sys/fs/cgroup/memory/box/memory.stat", "inactive_file 1\ntotal_inactive_file 1000000000\n");
  EXPECT_EQ(machine.available(), 3e9);
  machine.write("proc/self/cgroup", "2:memory:/elsewhere\n");  // seen from inside a container: only the mount itself is there
  machine.write("sys/fs/cgroup/memory/memory.limit_in_bytes", "2000000000\n");
  EXPECT_EQ(machine.available(), 2e9);
}

TEST(Memory, RefusalSaysBothNumbers) {
  EXPECT_EQ(memory_refusal(20.1e9, 20.1e9), "");
  EXPECT_EQ(memory_refusal(31.2e9, 20.1e9).substr(0, 45), "the factor needs 31.2 GB, 20.1 GB are free: c");
}

TEST(Memory, PredictionIsWhatTheFactorHas) {
  TwoBoxesPlan plan;
  plan.dimension = 3;
  const TwoBoxes boxes = two_boxes(plan);
  const auto solver = solver_catalog()[0]->make(Values());
  const Sparse matrix = boxes.stiffness + 1e6 * boxes.mass;
  const std::vector<int> touched = touched_unknowns(boxes.b);
  const FactorCost whole = solver->predict(matrix, {}), split = solver->predict(matrix, touched);
  EXPECT_EQ(whole.entries, solver->factorise(matrix).factor->nonzeros());
  EXPECT_EQ(split.entries, solver->factorise_split(matrix, touched).factor->nonzeros());
  EXPECT_GE(whole.bytes, 8 * whole.entries);
  EXPECT_LE(whole.bytes, 9 * whole.entries);
  // a Cholesky factor of n unknowns cannot need less than its own entries once each, nor more than the dense one
  EXPECT_GT(whole.operations, whole.entries);
  EXPECT_LT(whole.operations, std::pow(whole.unknowns, 3) / 3);
}

// Times follow from the rates alone; these are stated, since what a loaded machine measures is anything.
TEST(Memory, TimesFollowFromTheRates) {
  FactorCost cost;
  cost.entries = 1e8;
  cost.operations = 1e12;
  const Rates rates{1e10, 2e10};                       // 10 GB/s, 20 GFlop/s
  EXPECT_DOUBLE_EQ(solve_seconds(cost, rates), 0.16);  // two passes over 8 bytes an entry
  EXPECT_GT(factor_seconds(cost, rates), 50);          // not less than the operations at full rate
  EXPECT_LT(factor_seconds(cost, rates), 150);
  const Rates twice{2e10, 4e10};
  EXPECT_DOUBLE_EQ(solve_seconds(cost, twice), 0.08);
  EXPECT_LT(factor_seconds(cost, twice), 0.6 * factor_seconds(cost, rates));
  const Rates measured = measure_rates(1e6);
  EXPECT_GT(measured.bytes_per_second, 0);
  EXPECT_GT(measured.operations_per_second, 0);
}

#if defined(__SANITIZE_ADDRESS__)
constexpr bool address_space_is_used_up = true;  // by the sanitizer's shadow memory
#else
constexpr bool address_space_is_used_up = false;
#endif

/// Both factorisations refuse; exit code 0 when they do.
void refuse(const TwoBoxes& boxes) {
  std::ifstream file("/proc/self/statm");
  double pages = 0;
  file >> pages;
  const auto limit = static_cast<rlim_t>(pages * 4096 + 40e6);
  const rlimit address_space{limit, limit};
  if (setrlimit(RLIMIT_AS, &address_space) != 0) std::exit(2);
  const auto solver = solver_catalog()[0]->make(Values());
  const Factorisation whole = solver->factorise(boxes.stiffness);
  const SplitFactorisation split = solver->factorise_split(boxes.stiffness, touched_unknowns(boxes.b));
  const auto refused = [](const auto& result) { return !result.factor && result.too_large && result.why.starts_with("the factor needs "); };
  if (!refused(whole) || !refused(split)) {
    std::fprintf(stderr, "%s\n%s\n", whole.why.c_str(), split.why.c_str());
    std::exit(1);
  }
  LinearCounts counts;
  const BulkFactor factor(boxes.stiffness, &boxes.b, false, *solver, Model(), counts);
  std::exit(!factor.ok() && factor.too_large() && factor.why() == split.why ? 0 : 3);
}

TEST(MemoryDeathTest, FactorThatDoesNotFitIsRefused) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // a BLAS has threads of its own
  if (address_space_is_used_up) GTEST_SKIP() << "no limit on the address space under the address sanitizer";
  TwoBoxesPlan plan;
  plan.dimension = 3;
  plan.soil = {20, 20, 14};  // 18 500 unknowns, a factor of 80 MB
  plan.block_height = 1;
  TwoBoxes boxes = two_boxes(plan);
  Sparse unit(boxes.stiffness.rows(), boxes.stiffness.cols());
  unit.setIdentity();
  boxes.stiffness += 1e9 * unit;
  EXPECT_EXIT(refuse(boxes), testing::ExitedWithCode(0), "");
}

/// Threads that give memory back at the same moment; exit code 0 when all have returned.
void give_back_at_once() {
  constexpr int count = 8;
  std::barrier together(count);
  {
    std::vector<std::jthread> threads;
    for (int each = 0; each < count; ++each) {
      threads.emplace_back([&together] {
        together.arrive_and_wait();
        give_back_free_memory();
      });
    }
  }
  std::exit(0);
}

// Under the address sanitizer no one has initialised the heap of glibc before. The process is a new one for each of the five.
TEST(MemoryDeathTest, ThreadsGiveBackMemoryAtOnce) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  for (int each = 0; each < 5; ++each) EXPECT_EXIT(give_back_at_once(), testing::ExitedWithCode(0), "");
}

#if defined(MADV_POPULATE_WRITE)
/// Whole pages of new memory that the system has provided, and how many there are. mincore() is the system's own answer.
std::pair<std::size_t, std::size_t> provided_pages(const double* begin, std::size_t bytes) {
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const auto address = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t first = (address + page - 1) / page * page, last = (address + bytes) / page * page;
  std::vector<unsigned char> there((last - first) / page);
  EXPECT_EQ(mincore(reinterpret_cast<void*>(first), last - first, there.data()), 0);
  return {static_cast<std::size_t>(std::ranges::count_if(there, [](unsigned char each) { return (each & 1) != 0; })), there.size()};
}

// What a vector has reserved is there before it is written to, up to the limit and no further; what it holds stays.
TEST(Memory, PagesOfAReservedVectorAreProvided) {
  constexpr std::size_t bytes = 64 << 20, most = 8 << 20;  // from the system, not from memory that was used before
  std::vector<double> values;
  values.reserve(bytes / sizeof(double));
  values.assign({1.5, -2.5, 3.5});
  const double* begin = values.data();
  const auto [before, all] = provided_pages(begin, bytes);
  ASSERT_LT(before, all / 8);
  const std::size_t page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  provide_pages(values, most);
  if (madvise(reinterpret_cast<void*>(reinterpret_cast<std::uintptr_t>(begin) / page * page), page, MADV_POPULATE_WRITE) != 0)
    return;  // a system that is older than its headers: nothing was asked for that it could refuse
  const auto [after, whole] = provided_pages(begin, most);
  EXPECT_GE(after + 1, whole);
  EXPECT_LT(provided_pages(begin, bytes).first, all / 2);
  EXPECT_EQ(values, (std::vector<double>{1.5, -2.5, 3.5}));
  EXPECT_EQ(values.data(), begin);
}
#endif

}  // namespace
}  // namespace uplift::memory_test
