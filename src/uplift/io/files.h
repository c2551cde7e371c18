#pragma once
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace uplift {

/// Output that could not be written: a full disk, a folder that cannot be moved, a closed terminal.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A folder of results that appears complete or not at all: files are collected in NAME.part-PID beside it, then that folder is moved into
/// place. What stood there before is moved to NAME.1, NAME.2, ...: results are never overwritten or mixed, and nothing else than results is
/// moved. Files that were written are never deleted: when the results cannot be completed, they stay in NAME.part-PID.
class ResultFolder {
 public:
  /// Makes the working folder. The target of a symbolic link takes the results. Throws InputError when the results could not be put into
  /// place later: `path` is a file, a folder with something else than results (without a summary.json), a link to nothing, or a mount
  /// point.
  explicit ResultFolder(const std::string& path);
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;
  /// Removes the working folder when it has no files.
  ~ResultFolder();

  /// Writes a file, `name` may hold a subfolder. When the system refuses, what stood there before stays, others can still be written, and
  /// finish() throws. May be called from several threads.
  void write(const std::string& name, std::string_view text);
  /// For those who write a file bit by bit: it could not be written.
  void note_failure(const std::string& name, const std::string& reason);
  /// Where a file is until finish(), for those who write it bit by bit; its subfolder is there.
  std::string place(const std::string& name) const;
  /// Moves everything into place. Returns where earlier results went; empty when there were none. Throws OutputError when a file could not
  /// be written or the folder cannot be moved.
  std::string finish();
  const std::string& path() const { return path_; }
  const std::string& working_path() const { return work_; }
  bool finished() const { return finished_; }
  /// True when a file has been written.
  bool has_files() const;
  /// Working folders of processes that ended before they finished their results. Empty ones are removed instead.
  const std::vector<std::string>& abandoned() const { return abandoned_; }

 private:
  void find_abandoned();
  std::string path_, work_;
  std::vector<std::string> abandoned_;
  std::mutex mutex_;
  std::string failure_;  // of the first file that could not be written
  bool finished_ = false;
};

}  // namespace uplift
