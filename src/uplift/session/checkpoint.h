#pragma once
#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "uplift/base/file.h"
#include "uplift/io/fields/run.h"
#include "uplift/io/files.h"
#include "uplift/run/run_state.h"
#include "uplift/session/load.h"

// Checkpoints: states of runs on disk, from which `uplift resume` goes on. A run that resumes takes the same steps to the last bit as one
// that was never interrupted (docs/guide/checkpoints.md).
namespace uplift {

/// What a checkpoint belongs to.
struct CheckpointOrigin {
  std::string verb;                                         // of the command: run, compare
  std::string case_file;                                    // as the command named it
  std::string from_folder;                                  // where the command was given
  std::string resolved;                                     // the case with all its values
  std::vector<std::pair<std::string, std::string>> inputs;  // files that the case names, with their SHA-256
  std::string program;                                      // its identity_of_program
  std::string processor;                                    // and libraries: results are the same to the last bit with these alone
  bool step_check = true;                                   // Control::step_check
};

/// Of a case that this program runs now.
CheckpointOrigin origin_of(const LoadedCase& loaded, const std::string& verb, bool step_check);

/// One state of one run as it is on disk.
struct Checkpoint {
  CheckpointOrigin origin;
  std::string label;        // of the run
  std::string state;        // write_run_state
  FieldRun::Memory fields;  // of its fields, whose frames are in a journal beside the checkpoint
};
/// The file's bytes, with a checksum over all of them.
std::string write_checkpoint(const Checkpoint& checkpoint);
/// Bytes that are cut off or changed are refused: then `why` says so.
std::optional<Checkpoint> read_checkpoint(std::string_view bytes, std::string& why);

/// The folder with the newest checkpoints of results at `path`: of the results there, or of a process that was killed (PATH.part-N) after
/// they were written. Throws InputError: none, or a process that still computes them.
std::string checkpoints_at(const std::string& path);
/// The case file of the checkpoints, as a command given here would name it.
std::string case_file_of(const CheckpointOrigin& origin);
/// What the checkpoints of a folder belong to. Throws InputError: all of them are damaged.
CheckpointOrigin origin_of_checkpoints(const std::string& folder);

/// The checkpoints of the runs of one command. May be used from several threads.
class Checkpoints {
 public:
  /// New ones go to the subfolder `checkpoint` of the results. `from`: a folder with earlier ones; empty: the runs begin at the beginning.
  /// Throws InputError where the case, its files or the program are not those of the earlier ones.
  Checkpoints(CheckpointOrigin origin, double seconds, const ResultFolder& folder, const std::string& from);
  Checkpoints(const Checkpoints&) = delete;
  Checkpoints& operator=(const Checkpoints&) = delete;
  ~Checkpoints();
  /// With what a run goes on.
  struct Begin {
    RunState state;
    FieldRun::Memory fields;
    std::string journal;  // the file of their frames, which is whole
  };
  /// Empty: the run begins at the beginning.
  std::optional<Begin> begin(const std::string& label);
  /// Where the frames of its fields are kept.
  std::string journal(const std::string& label) const;
  /// Writes the state of a run and of its fields, which may be null. Where that is not possible, notes() says so.
  void write(const std::string& label, const RunState& state, FieldRun* fields);
  double seconds() const { return seconds_; }
  /// Removes what was written: the results are complete.
  void remove();
  /// What the user should know: runs that could not go on bit for bit, files that could not be read or written.
  std::vector<std::string> notes() const;
  static constexpr const char* subfolder = "checkpoint";

 private:
  void note(std::string text);
  const CheckpointOrigin origin_;
  const double seconds_;
  const std::string folder_, from_;
  std::optional<FolderLock> lock_;  // as long as this process may write
  mutable std::mutex mutex_;
  std::vector<std::string> notes_;
};

/// Keeps one run: a state now and then, and one before the run ends because it was asked to.
class KeptRun {
 public:
  /// `checkpoints` may be null: nothing is kept. `unknowns`: of the model.
  KeptRun(Checkpoints* checkpoints, std::string label, Index unknowns);
  /// Adds what is kept to what the run does, and lets `watch` end the run at a step that is kept. `fields`: of the run, or null; they go on
  /// from the checkpoint too.
  void attach(Keeping& keeping, Watch& watch, FieldRun* fields);

 private:
  using Clock = std::chrono::steady_clock;
  Checkpoints* checkpoints_;
  const std::string label_;
  const long every_;
  std::optional<Checkpoints::Begin> from_;
  Clock::time_point last_ = Clock::now();
  bool stop_asked_ = false, stop_ = false;
};

}  // namespace uplift
