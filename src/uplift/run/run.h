#pragma once
#include <functional>
#include <string>
#include <vector>

#include "uplift/run/plan.h"
#include "uplift/run/result.h"

namespace uplift {

class Stepper;
struct ForceStage;
struct Keeping;

/// Told now and then; returning false stops the run after the present step (its results are complete up to there).
struct Progress {
  double fraction = 0, time = 0, step = 0, open_fraction = 0, energy_error = 0;
};
using Watch = std::function<bool(const Progress&)>;

/// A state that a run has reached. Everything ends with the call.
struct Snapshot {
  const State& state;
  const Stepper* stepper;    // of a dynamic stage, for accelerations; null at the end of a static stage or where it failed
  const RunResult& so_far;   // peaks and counts up to here
  std::size_t stage;         // of the plan
  long step;                 // of the stage, from 0
  bool last;                 // of the stage, also when the run ends here
  const ForceStage& forces;  // what the forces inside the structure depend on beside the state
};
/// Sees the end of every static stage, the state at the beginning of the first dynamic one, and every step.
using Observe = std::function<void(const Snapshot&)>;

/// Runs all stages. `behaviours` are the checked parameters of the interfaces' laws (for problem files). Never throws for numerical
/// reasons; what the observer throws ends it. `keeping` (run_state.h): states of the run that another run can go on from; null: none.
RunResult run(const Model& model, const RunPlan& plan, const std::vector<const Values*>& behaviours, const Watch& watch = {},
              const Observe& observe = {}, const Keeping* keeping = nullptr);

/// What `uplift check` says of an interface: stiffness of a closed joint times compliance at the dynamic step.
struct StiffnessRatio {
  std::string interface;
  double least = 0, most = 0;  // k F_ii over the points
  double compliance = 0;       // largest normal F_ii [m/N]
};
std::vector<StiffnessRatio> stiffness_ratios(const Model& model, const Stage& dynamic_stage, const LinearSolver& solver);

}  // namespace uplift
