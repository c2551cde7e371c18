#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "uplift/study/study_run.h"

// Parts of a study: files to which one process appends a line for every run that has ended. They are the truth of the study; everything
// else can be made from them again. Every line is a JSON object that ends with the CRC-32 of what stands before it:
//     {"id": ..., ..., "crc": "1a2b3c4d"}
namespace uplift {

/// One line, with its end of line.
std::string line_of(const StudyResult& result);
/// The result of a line without its end of line; nothing where it is damaged.
std::optional<StudyResult> read_line(std::string_view line);

/// The file of this process, opened when the first line is written.
class PartFile {
 public:
  /// `folder`: parts of the study.
  explicit PartFile(std::string folder) : folder_(std::move(folder)) {}
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;
  ~PartFile();
  /// Throws OutputError, also where the disk is full; what was written before is kept.
  void append(std::string_view lines);
  /// From here on what was appended outlives a power cut. Throws OutputError.
  void sync();

 private:
  void open();
  std::string folder_, path_;
  int descriptor_ = -1;
  bool dirty_ = false;
};

}  // namespace uplift
