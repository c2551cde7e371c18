#pragma once
#include <string>
#include <vector>

#include "uplift/case/build/records.h"

namespace uplift {

/// Generated records of a study, which are made once and kept as files: to generate a hundred takes a minute. What is kept belongs to the
/// whole list of generated records, because those of one seed are drawn together. Values are kept to the last bit.
class GeneratedRecords {
 public:
  /// `raw`: the case; `folder`: where the files are; empty: none are kept.
  GeneratedRecords(const Raw& raw, const std::string& folder);
  /// Whether there are any to be kept, and whether all of them are there.
  bool any() const { return !names_.empty(); }
  bool kept() const;
  /// Writes them. Throws std::filesystem::filesystem_error.
  void keep(const std::vector<CaseRecord>& records) const;
  /// The case with the files in place of what is generated, and of its processing.
  Raw from_files(const Raw& raw) const;

 private:
  std::string file_of(const std::string& name) const;
  std::string folder_, hash_;
  std::vector<std::string> names_;
};

}  // namespace uplift
