#pragma once
#include <array>
#include <utility>
#include <vector>

#include "uplift/dynamics/step.h"
#include "uplift/linear/memory.h"
#include "uplift/run/base_motion.h"
#include "uplift/run/floor_record.h"
#include "uplift/run/force_record.h"
#include "uplift/run/pictures.h"
#include "uplift/run/result.h"
#include "uplift/run/run_state.h"

namespace uplift {

/// Fills the columns of the output table and their peaks, and the records of the floors.
class Recorder {
 public:
  /// For so many steps [s] of a dynamic stage: room is made for all of them. `views` holds what the interfaces look like whenever record is
  /// called; it keeps its place, as the state and the energies do. `stepper` says what the accelerations are; null: at rest.
  Recorder(const Model& model, const RunPlan& plan, const State& state, const Energies& energies, const Stepper* stepper,
           const std::vector<InterfaceView>& views, const ForceStage& stage, long steps, double step, Recorded& result);
  /// Notes the numbers of every column; they become a row of the table when `row` is set. Peaks and rows are made for many steps at a time.
  void record(bool row) { record(row, state_.time); }
  /// The same in a static stage: `abscissa` takes the place of the time.
  void record(bool row, double abscissa);
  /// Peaks and rows of the last steps, and the frame of the largest uplift; nothing is recorded after it.
  void finish();
  /// Writes all rows so far and notes in the state what the recorder of a run that goes on from there has to know.
  void keep(RunState& run);
  /// Goes on from there.
  void resume(const RunState& run);
  /// Keeps a frame for the animation.
  void picture(const State& state);
  /// Keeps the state as a frame when a larger share of an interface is uplifted than ever before: `share`, the largest of those that are no
  /// walls. The frames at regular times miss a short peak, and the animation starts at the peak.
  void note_uplift(double share) {
    if (share > peak_uplift_) keep_peak(share);
  }

 private:
  static constexpr std::size_t many = 64;
  static constexpr std::size_t apart = many + 8;  // not 4096 bytes for every eighth column: the processor would take one for another
  /// Where the number of a column is found, known from the start: one of these.
  struct Source {
    double* to = nullptr;                   // the column in recent_
    const double* place = nullptr;          // it stays there: an energy, or a part of an interface's view
    const Vector State::*vector = nullptr;  // an entry of this vector of the state times a factor
    int entry = 0;
    double factor = 0;
    // both null: it is made from several numbers, a motion of the base (in_pose), or free unknowns (terms)
    const Request* request = nullptr;
    double BasePose::*in_pose = nullptr;
    std::vector<std::pair<int, double>> terms = {};
    bool moved = false;  // a prescribed motion takes part
  };
  Source source_of(const Request& request) const;
  double made(const Source& source) const;
  void make(std::size_t at);
  double ground(const Request& request, double time) const;
  Frame frame_of(const State& state) const;
  void keep_peak(double share);
  void complete_peak();
  void flush();
  /// The combined motions of the first `count` of the last steps.
  void combine(std::size_t count);

  const Model& model_;
  const State& state_;
  const Energies& energies_;
  const Stepper* stepper_;
  const std::vector<InterfaceView>& views_;
  Recorded& result_;
  FloorRecorder floors_;
  Pictures pictures_;
  std::unique_ptr<ForceRecorder> forces_;        // null where no forces are asked for
  std::vector<Source> placed_, entries_, made_;  // columns of each kind
  std::vector<BaseMotion> bases_;                // of every interface, when a column is about the motion of a base; else empty
  std::vector<double> recent_;                   // the last steps, `many` numbers per column, `apart` from one to the next
  std::array<double, many> time_;                // of the same [s]
  std::array<bool, many> is_row_;
  std::size_t count_ = 0;     // of them
  std::vector<double> most_;  // per column: size of its peak
  /// A column of a combined motion.
  struct Term {
    const double* numbers = nullptr;  // of the last steps
    double factor = 0;
  };
  std::vector<std::vector<std::vector<Term>>> combined_;  // of every combined motion, the terms of its components
  double before_ = 0;                                     // s: accelerations are the mean from here to the present time
  bool wants_acceleration_ = false;
  Vector acceleration_;
  Frame peak_frame_;         // at the largest uplift of this stage, when it is larger than in the frames of the earlier stages
  double peak_uplift_ = 0;   // largest share over all interfaces and steps
  Vector peak_coordinates_;  // of its displacements, which are made when they are asked for; empty: they are made
  double peak_load_factor_ = 0;
};

}  // namespace uplift
