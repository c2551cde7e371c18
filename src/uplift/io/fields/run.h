#pragma once
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "uplift/case/case.h"
#include "uplift/dynamics/step.h"
#include "uplift/io/fields/fields.h"
#include "uplift/io/fields/journal.h"

// Field output of a run, as [output.fields] of a case asks for it.
namespace uplift {

class ForceMeter;
class RunFrames;  // io/field_run_frames.h

/// What the files of one run will take.
struct FieldForecast {
  FieldFormat format = FieldFormat::vtu;
  long frames = 0;  // with events: at most
  FieldSize size;
  std::int64_t bytes() const { return size.once + frames * size.per_frame; }
};
/// None when the case does not ask for fields. Throws InputError: no mesh, quantities and groups that are not there.
std::optional<FieldForecast> field_forecast(const Case& read, const BuiltCase& built);

/// Writes the frames of one run while it goes on: "fields/<run>.pvd" or "fields/<run>.xdmf" and what they name. Nothing of a frame is kept
/// but, with events, the states of the largest gap and of the largest pressure.
/// Times of the frames [s]: those of the states. Where several static stages come before the dynamic ones, the last of them ends at 0,
/// those before it at -1, -2, ...; the end of a static stage from which a dynamic one starts is that one's first frame. A static stage
/// between dynamic ones stands half a step after the end of the one before. Of a static stage that ended the run the last equilibrium is
/// kept.
class FieldRun {
 public:
  /// The folder must live as long. Throws InputError as field_forecast(), and where the disk has less room than the files will take.
  FieldRun(const Case& read, const BuiltCase& built, ResultFolder& folder);
  ~FieldRun();
  FieldRun(const FieldRun&) = delete;
  FieldRun& operator=(const FieldRun&) = delete;

  /// To be given to run() as its observer. When the disk refuses, the run goes on without fields, and the folder notes the failure.
  void see(const Snapshot& snapshot);
  /// Writes the events and the list. A frame that was left out because a number was not finite is noted in the result.
  void finish(RunResult& result);

  /// What the fields remember at a moment of the run.
  struct Memory {
    std::uint64_t frames = 0;  // bytes of the journal
    std::string rest;          // as bytes
  };
  /// From now on frames go to this file too (FrameJournal).
  void keep_frames(const std::string& journal) { journal_.emplace(journal); }
  /// The present one, whose journal is on the disk. Throws filesystem_error.
  Memory memory();
  /// Goes on from there: writes the frames of that journal, which has been found whole, again.
  void resume(const Memory& memory, const std::string& journal);

  const std::string& list() const { return list_; }  // "fields/run.pvd", in the folder of the results
  int frames() const { return static_cast<int>(times_.size()); }

 private:
  struct Kept {
    double largest = 0;  // of what the event is about
    State state;
    Vector acceleration;
    std::vector<double> section_forces;
    std::optional<FieldFrame> frame;  // instead of them, of a run that goes on
  };
  void see_static(const Snapshot& snapshot);
  void see_events(const Snapshot& snapshot);
  void keep(Kept& kept, double value, const Snapshot& snapshot);
  /// Section forces of the beams at this moment.
  std::vector<double> section_forces(const Snapshot& snapshot, const Vector* acceleration);
  void stop_writing();
  void write(const State& state, const Vector* acceleration, const std::vector<double>& section_forces, double time);
  void write(const FieldFrame& frame);
  FieldFrame frame_of(const Kept& kept) const;

  const RunPlan& plan_;
  ResultFolder& folder_;
  long every_ = 0;  // 0: events alone
  bool events_ = false, uplifted_ = false;
  std::string list_;
  std::unique_ptr<const RunFrames> frames_;
  std::optional<VtuWriter> vtu_;
  std::optional<XdmfWriter> xdmf_;
  std::optional<FrameJournal> journal_;
  std::set<double> times_;                   // s, of the frames that are written
  std::unique_ptr<const ForceMeter> meter_;  // of the section forces, for one stage
  std::size_t metered_ = 0;                  // that stage
  Kept gap_, pressure_;
  int left_out_ = 0;
  bool disk_refused_ = false;  // then nothing more is written; the folder knows why
  std::string trouble_;        // of the first frame that was left out
};

}  // namespace uplift
