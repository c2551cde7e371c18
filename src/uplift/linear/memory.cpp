#include "uplift/linear/memory.h"

#include <fmt/format.h>

#include <cstdlib>
#if defined(__GLIBC__)
#include <malloc.h>
#endif
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>

#include "uplift/base/text.h"

namespace uplift {

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// The first number of a file; `none` when there is none ("max").
double number_in(const std::string& path, double none) {
  std::ifstream file(path);
  double value = 0;
  return file >> value ? value : none;
}

/// The number after a word at the beginning of a line; 0 when there is none.
double number_after(const std::string& path, const std::string& word) {
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line))
    if (line.starts_with(word)) return std::strtod(line.c_str() + word.size(), nullptr);
  return 0;
}

/// What one control group leaves: its limit less what is used, where file cache out of use counts as free.
double left_in_group(const std::string& folder, bool second) {
  const double limit = number_in(folder + (second ? "/memory.max" : "/memory.limit_in_bytes"), unlimited);
  if (limit == unlimited) return unlimited;
  const double used = number_in(folder + (second ? "/memory.current" : "/memory.usage_in_bytes"), 0);
  return std::max(0.0, limit - used + number_after(folder + "/memory.stat", second ? "inactive_file " : "total_inactive_file "));
}

/// The least of the group at `path` and all above it; a group that this process cannot see (containers) is passed over.
double left_in_groups(const std::string& mount, std::string path, bool second) {
  double least = left_in_group(mount, second);
  while (path.size() > 1) {
    least = std::min(least, left_in_group(mount + path, second));
    path.resize(path.rfind('/'));
  }
  return least;
}

double left_in_groups(const std::string& root) {
  double least = unlimited;
  std::ifstream groups(root + "/proc/self/cgroup");
  std::string line;  // "0::/path" (version 2) or "4:memory:/path"
  while (std::getline(groups, line)) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",", path = line.substr(second + 1);
    if (controllers == ",,") least = std::min(least, left_in_groups(root + "/sys/fs/cgroup", path, true));
    if (controllers.find(",memory,") != std::string::npos)
      least = std::min(least, left_in_groups(root + "/sys/fs/cgroup/memory", path, false));
  }
  return least;
}

double left_of_address_space(const std::string& root) {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
  const double used = number_in(root + "/proc/self/statm", 0) * static_cast<double>(sysconf(_SC_PAGESIZE));
  return std::max(0.0, static_cast<double>(limit.rlim_cur) - used);
}

}  // namespace

double available_memory(const std::string& root) {
  const double system = 1024 * number_after(root + "/proc/meminfo", "MemAvailable:");
  return std::min({system > 0 ? system : unlimited, left_in_groups(root), left_of_address_space(root)});
}

int runs_side_by_side(int wanted) {
  constexpr double bytes_of_a_run = 500e6;
  return static_cast<int>(std::clamp(1 + std::floor(available_memory() / bytes_of_a_run), 1.0, static_cast<double>(std::max(wanted, 1))));
}

double resident_memory(const std::string& root) {
  return 1024 * number_after(root + "/proc/self/status", "VmRSS:");
}

void prepare_heap() {
#if defined(__GLIBC__)
  mallopt(M_TOP_PAD, 2 << 20);
  mallopt(M_MMAP_THRESHOLD, 4 << 20);
  mallopt(M_TRIM_THRESHOLD, 8 << 20);
#endif
}

void give_back_free_memory() {
#if defined(__GLIBC__)
  // Where another allocator stands in for malloc (a sanitizer, a preloaded library), the first call initialises the heap of glibc. Two
  // threads that did so at once would crash.
  [[maybe_unused]] static const int initialised = malloc_trim(0);
  malloc_trim(0);
#endif
}

void provide_pages([[maybe_unused]] const void* begin, [[maybe_unused]] std::size_t bytes) {
#if defined(MADV_POPULATE_WRITE)  // Linux 5.14 and later
  static const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  if (bytes < page) return;
  const auto first = reinterpret_cast<std::uintptr_t>(begin), from = first / page * page;
  madvise(reinterpret_cast<void*>(from), first + bytes - from, MADV_POPULATE_WRITE);  // a wish: nothing depends on the answer
#endif
}

std::string memory_refusal(double needed, double available) {
  if (needed <= available) return {};
  return fmt::format("the factor needs {}, {} are free: coarsen the mesh, make the model smaller, or run it on a machine with more memory",
                     format_bytes(needed), format_bytes(available));
}

}  // namespace uplift
