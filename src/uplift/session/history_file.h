#pragma once
#include <chrono>
#include <string>

#include "uplift/io/files.h"
#include "uplift/run/result.h"

namespace uplift {

/// The histories of a run while it goes on, about every second: what a process that is killed leaves behind. Runs that take less write
/// nothing. The complete file takes its place at the end.
class HistoryFile {
 public:
  HistoryFile(const ResultFolder& folder, std::string name) : folder_(folder), name_(std::move(name)) {}
  void follow(const RunResult& so_far);

 private:
  using Clock = std::chrono::steady_clock;
  const ResultFolder& folder_;
  const std::string name_;
  Clock::time_point last_ = Clock::now();
  std::size_t rows_ = 0;  // that are written
  bool begun_ = false, refused_ = false;
};

}  // namespace uplift
