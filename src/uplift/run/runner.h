#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "uplift/dynamics/statics.h"
#include "uplift/dynamics/step.h"
#include "uplift/run/base_watch.h"
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
  Runner(const Runner&) = delete;  // its parts refer to it
  Runner& operator=(const Runner&) = delete;
  RunResult go();

 private:
  class March;  // through a dynamic stage
  void execute();
  void begin();
  bool resume();
  void run_stages();
  void remember_gaps();
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
  bool dynamics(const Stage& stage, const Bulk& bulk);
  ForceStage force_stage(const Stage& stage) const;
  void show(const Stage& stage, const Stepper* stepper, long step, bool last);
  void check_tables();
  void fail(std::string why, const InterfaceProblem* problem);

  const Model& model_;
  const RunPlan& plan_;
  const std::vector<const Values*>& parameters_;
  const Watch& watch_;
  const Observe& observe_;
  const Keeping& keeping_;
  const Sparse b_;
  const Vector gap_;
  const std::vector<int> rotations_;  // of the dynamic stages: rotations_on_interfaces
  RunState run_;
  BaseWatch bases_;
  std::unique_ptr<Behaviours> laws_;
  std::unique_ptr<Sparse> geometric_;
  std::vector<TimeLoad> second_order_loads_;  // what it makes of the prescribed motions
  const Model* rest_;                         // the static stages' model before the first dynamic stage; null: model_
  const State* seen_ = &run_.state;           // the present one, wherever it lives
  double shown_ = 0;                          // s: taken by the observer
};

/// Free unknowns that are rotations of bodies on an interface; `b` is that of the model's interfaces.
std::vector<int> rotations_on_interfaces(const Model& model, const Sparse& b);

}  // namespace uplift
