#pragma once
#include <optional>
#include <string>
#include <vector>

#include "uplift/dynamics/step.h"
#include "uplift/run/interface_viewer.h"
#include "uplift/run/radiation.h"
#include "uplift/run/result.h"

namespace uplift {

/// Watches the bases of a structure in a run: what their interfaces look like, the record of it, its peaks, and whether the structure has
/// moved beyond the small-displacement model.
class BaseWatch {
 public:
  /// `b`: rows of all interfaces. What is seen is noted in `result`, which keeps its place.
  BaseWatch(const Model& model, const RunPlan& plan, const Sparse& b, RunResult& result);
  /// Makes room in the record for this many steps of length `step` [s].
  void reserve(long steps, double step);
  /// Looks at a state; `radiation`: forces of the dashpots beside foundations, null: there are none.
  void look(const State& state, const Vector* radiation = nullptr);
  /// Looks at a state and notes it in the record.
  void note(const State& state, const Vector* radiation = nullptr);
  /// The same of the state that a step has led to.
  void note(const Stepper& stepper);
  /// Notes the state at the end of the static stages, which the verdict holds the rest of the run against.
  void note_rest(const State& state);
  /// Peaks and durations of what was noted since this was last called, in a stage with this step [s].
  void sum_up(double step);
  /// Goes on after what the result has noted and summed up.
  void resume() { summed_up_ = result_.steps.size(); }
  /// After the run: replaces forces by their means over the window, which the verdict shows.
  void finish();
  /// False when a body, one of whose rotations these free unknowns are, or a surface has moved beyond the small-displacement model: then
  /// the status says so. In a static stage `share` of the load is reached.
  bool moves_little(const State& state, const Model& model, const std::vector<int>& rotations, std::optional<double> share = {});
  /// As last looked at.
  const std::vector<InterfaceView>& views() const { return views_; }
  /// Largest open share of a base now.
  double uplifted() const { return uplifted_; }

 private:
  bool is_wall(std::size_t interface) const { return has_walls_ && plan_.is_wall[interface]; }
  void note_poses(const State& state);
  void note_impulses(const Stepper& stepper);
  void end(RunStatus status, const std::string& what, const State& state, std::optional<double> share);
  bool surfaces_turn_little(const State& state, std::optional<double> share);
  bool surfaces_stay_near(const State& state, std::optional<double> share);

  const Model& model_;
  const RunPlan& plan_;
  RunResult& result_;
  InterfaceViewer viewer_;
  RadiationForces radiation_;
  std::vector<InterfaceView> views_;
  std::size_t summed_up_ = 0;         // instants of the record that peaks and durations know
  bool has_walls_ = false;            // some interface is no base
  bool has_strength_ = false;         // the ground under some foundation yields or lets it slide
  double farthest_ = 0;               // m: largest of the bases' least openings, now
  double uplifted_ = 0;               // largest of their open shares, now
  double tail_ = 0, tail_begin_ = 0;  // s: at the end of the dynamic stages the bases' poses are kept for this long, from then on
};

}  // namespace uplift
