#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "uplift/dynamics/statics.h"
#include "uplift/dynamics/step.h"
#include "uplift/run/interface_viewer.h"
#include "uplift/run/radiation.h"
#include "uplift/run/recorder.h"
#include "uplift/run/run.h"
#include "uplift/run/run_state.h"

namespace uplift {

/// One run: what it remembers (RunState) and what it works with. Used by run() alone: the stages are in run.cpp, a static one in
/// statics.cpp, the march through a dynamic one in march.cpp.
class Runner {
 public:
  Runner(const Model& model, const RunPlan& plan, const std::vector<const Values*>& behaviours, const Watch& watch, const Observe& observe,
         const Keeping& keeping);
  RunResult go();

 private:
  void execute();
  void begin();
  bool resume();
  void run_stages();
  void keep(Stepper& stepper, Recorder& recorder, EquilibriumCheck& equilibrium, long step);
  void remember_gaps();
  void note_rest();
  void stand();
  void add_initial_state();
  bool statics(const Stage& stage);
  bool solve(const Stage& stage, const Sparse* geometric, const std::vector<TimeLoad>* second_order,
             const std::function<bool(const StaticProgress&)>& after_step);
  Energies static_energies(const Model& resting, const Energies& before, const StaticProgress& progress) const;
  bool second_order(const std::function<bool(const StaticProgress&)>& after_step = {});
  bool solve_second_order(const Stage& stage, const std::function<bool(const StaticProgress&)>& after_step);
  bool stand_in_second_order(const Stage& stage, const Energies& before, Energies& energies);
  const SecondOrder* second_order_of(const Stage& stage) const {
    return stage.p_delta && run_.second_order ? &*run_.second_order : nullptr;
  }
  void use_second_order();
  std::vector<TimeLoad> second_order_loads(const Model& model) const;
  State carried() const;
  void release();
  StepOptions step_options(const Stage& stage) const;
  void start(const Stage& stage, const LinearCounts& counts, Stepper& stepper);
  void begin_scales(const Stepper& stepper, const Bulk& bulk);
  bool dynamics(const Stage& stage, const Bulk& bulk);
  ForceStage force_stage(const Stage& stage) const;
  void show(const Stage& stage, const Stepper* stepper, long step, bool last);
  void note_views();
  void note_poses();
  bool is_wall(std::size_t interface) const { return has_walls_ && plan_.is_wall[interface]; }
  void sum_up(double step);
  void note_impulses(const Stepper& stepper);
  bool check_limits(const Stepper& stepper);
  void look_over_bases();
  std::string when() const;
  bool moves_little(const Model& model, const std::vector<int>& rotations);
  void overturn(const Model& model, int unknown);
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
  const Keeping& keeping_;
  const Sparse b_;
  const Vector gap_;
  InterfaceViewer viewer_;
  RadiationForces radiation_;
  RunState run_;
  std::unique_ptr<Behaviours> laws_;
  std::unique_ptr<Sparse> geometric_;
  std::vector<TimeLoad> second_order_loads_;  // what it makes of the prescribed motions
  const Model* rest_;                         // the static stages' model before the first dynamic stage; null: model_
  std::optional<double> static_share_;        // of the present static stage that is reached
  const State* seen_ = &run_.state;           // the present one, wherever it lives
  std::vector<InterfaceView> views_;
  std::vector<int> rotations_;     // of the dynamic stages: rotations_on_interfaces
  std::size_t summed_up_ = 0;      // instants of the record that peaks and durations know
  bool has_walls_ = false;         // some interface is no base
  bool has_strength_ = false;      // the ground under some foundation yields or lets it slide
  double farthest_ = 0;            // m: largest of the bases' least openings, now
  double uplifted_ = 0;            // largest of their open shares, now
  double planned_ = 0, tail_ = 0;  // s: of the dynamic stages; at their end the base's pose is kept for this long
  double shown_ = 0;               // s: taken by the observer
};

/// Free unknowns that are rotations of bodies on an interface; `b` is that of the model's interfaces.
std::vector<int> rotations_on_interfaces(const Model& model, const Sparse& b);

}  // namespace uplift
