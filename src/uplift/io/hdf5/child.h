#pragma once
#include <cstdint>
#include <functional>
#include <string>

// A damaged file can make the HDF5 library read memory that it has freed, or never come back (libhdf5 1.10.8 does both). What reads such
// files does so in a process of its own.
namespace uplift {

struct ChildLimits {
  std::int64_t memory = 0;  // bytes, beyond what this process has taken; also the longest answer
  int seconds = 0;          // of computing
};

struct ChildAnswer {
  std::string bytes;
  std::string failure;  // "a crash (Segmentation fault)", "no end after 30 s of computing"; empty when the work was done
};

/// What `work` returns, done in a child of this process: a copy of it as it is now (fork without exec), of which nothing but the answer
/// comes back. It prints nothing, dies with this thread, and whatever happens to it happens to it alone. `work` must not wait for other
/// threads or for locks that they may hold, since they do not exist in the child; allocating memory is fine (glibc).
ChildAnswer answer_of_child(const std::function<std::string()>& work, const ChildLimits& limits);

}  // namespace uplift
