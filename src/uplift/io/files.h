#pragma once
#include <string>
#include <string_view>

namespace uplift {

/// A folder of results that appears complete or not at all: files are collected beside it, then it is moved into place. What stood there
/// before is moved to NAME.1, NAME.2, ...: results are never overwritten or mixed, and nothing else than results is moved.
class ResultFolder {
 public:
  /// Makes the working folder beside `path`. Throws InputError when that is impossible, and when `path` is a file or a folder with
  /// something else than results (without a summary.json).
  explicit ResultFolder(std::string path);
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;
  /// Removes the working folder when finish() was not reached.
  ~ResultFolder();

  /// Writes a file, `name` may hold a subfolder. Throws InputError when the disk refuses.
  void write(const std::string& name, std::string_view text);
  /// Where a file is until finish(), for those who write it bit by bit; its subfolder is there.
  std::string place(const std::string& name) const;
  /// Moves everything into place. Returns where earlier results went; empty when there were none.
  std::string finish();
  const std::string& path() const { return path_; }

 private:
  std::string path_, work_;
  bool finished_ = false;
};

}  // namespace uplift
