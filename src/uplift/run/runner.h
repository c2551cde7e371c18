#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "uplift/dynamics/statics.h"
#include "uplift/dynamics/step.h"
#include "uplift/run/interface_viewer.h"
#include "uplift/run/recorder.h"
#include "uplift/run/run.h"

namespace uplift {

/// One run: the state, what is watched, what is written. Used by run() alone: the stages are in run.cpp, a static one in statics.cpp,
/// the march through a dynamic one in march.cpp.
class Runner {
 public:
  Runner(const Model& model, const RunPlan& plan, const std::vector<const Values*>& behaviours, const Watch& watch, const Observe& observe);
  RunResult go();

 private:
  void execute();
  void run_stages();
  void remember_gaps();
  void note_rest();
  void stand();
  void add_initial_state();
  bool statics(const Stage& stage);
  bool solve(const Stage& stage, const Sparse* geometric, const std::vector<TimeLoad>* second_order,
             const std::function<bool(const StaticProgress&)>& after_step);
  Energies static_energies(const Model& resting, const Energies& before, const StaticProgress& progress) const;
  bool second_order();
  std::vector<TimeLoad> second_order_loads(const Model& model) const;
  State carried() const;
  void release();
  bool dynamics(const Stage& stage, const Bulk& bulk);
  ForceStage force_stage(const Stage& stage) const;
  void show(const Stage& stage, const Stepper* stepper, long step, bool last);
  void note_views();
  bool is_wall(std::size_t interface) const { return has_walls_ && plan_.is_wall[interface]; }
  void sum_up(double step);
  void note_impulses(const Stepper& stepper);
  bool check_limits(const Stepper& stepper);
  void find_farthest();
  std::string when() const;
  bool moves_little(const Model& model, const std::vector<int>& rotations);
  bool surfaces_turn_little();
  bool surfaces_stay_near();
  void finish_energy(const Stepper& stepper);
  void check_tables();
  void take_window_peaks();
  void fail(std::string why, const InterfaceProblem* problem);

  const Model& model_;
  const RunPlan& plan_;
  const std::vector<const Values*>& parameters_;
  const Watch& watch_;
  const Observe& observe_;
  const Sparse b_;
  const Vector gap_;
  InterfaceViewer viewer_;
  RunResult result_;
  RunResult load_steps_;  // table of the static stages
  LinearCounts linear_;
  std::unique_ptr<Behaviours> laws_;
  std::unique_ptr<Sparse> geometric_;
  SecondOrder second_order_;                  // the same before elimination
  std::vector<TimeLoad> second_order_loads_;  // what it makes of the prescribed motions
  const Model* rest_;                         // the static stages' model before the first dynamic stage; null: model_
  int static_stages_ = 0;                     // that are over
  std::optional<double> static_share_;        // of the present static stage that is reached
  Vector held_;                               // what released supports have borne, on the free unknowns [N, N m]
  State state_;                               // between stages
  const State* seen_ = &state_;               // the present one, wherever it lives
  std::vector<InterfaceView> views_;
  std::vector<int> rotations_;     // of the dynamic stages: rotations_on_interfaces
  bool has_walls_ = false;         // some interface is no base
  double farthest_ = 0;            // m: largest of the bases' least openings, now
  std::size_t summed_up_ = 0;      // instants of the record that peaks and durations know
  double initial_scale_ = 0;       // J
  Energies static_energies_;       // at the end of the static stages before the first dynamic one
  double unloaded_energy_ = 0;     // J: Energies::sum of the unloaded structure
  std::optional<Ledger> ledger_;   // of the dynamic stage before
  std::optional<Stage> march_;     // that stage, as long as nothing came in between
  double round_off_energy_ = 0;    // J: less than this is nothing
  double planned_ = 0, tail_ = 0;  // s: of the dynamic stages; at their end the base's pose is kept for this long
  double shown_ = 0;               // s: taken by the observer
};

/// Free unknowns that are rotations of bodies on an interface; `b` is that of the model's interfaces.
std::vector<int> rotations_on_interfaces(const Model& model, const Sparse& b);

}  // namespace uplift
