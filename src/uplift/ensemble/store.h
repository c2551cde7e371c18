#pragma once
#include <string>
#include <unordered_map>

#include "uplift/study/study_curve.h"

namespace uplift {

/// Results of a study that are on disk.
class StudyStore {
 public:
  /// Reads all parts of a study folder.
  explicit StudyStore(const std::string& folder);
  const StudyResult* find(const std::string& id) const;
  FindResult finder() const {
    return [this](const std::string& id) { return find(id); };
  }
  /// Of two results of one run the later attempt counts; of two of the same attempt the one that says more. The order does not matter.
  void add(StudyResult result);
  /// Forgets results of runs that did not complete, which are then run again; how many.
  std::size_t forget_failed();
  std::size_t size() const { return results_.size(); }
  /// Lines whose checksum is wrong, without those that were cut off by the end of their process.
  std::size_t damaged() const { return damaged_; }
  /// Runs that stand in several lines.
  std::size_t repeated() const { return repeated_; }
  /// Highest attempt of a run so far; 0: none.
  long attempts(const std::string& id) const;

 private:
  void read(const std::string& path);
  std::unordered_map<std::string, StudyResult> results_;
  std::unordered_map<std::string, long> attempts_;  // of forgotten results
  std::size_t damaged_ = 0, repeated_ = 0;
};

}  // namespace uplift
