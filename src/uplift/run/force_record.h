#pragma once
#include <memory>
#include <vector>

#include "uplift/dynamics/step.h"
#include "uplift/run/force_rows.h"
#include "uplift/run/result.h"

namespace uplift {

/// Whether a run records forces inside the structure or of its constraints.
bool asks_for_forces(const RunPlan& plan);

/// Evaluates the forces that a plan asks for at every step of a stage.
class ForceRecorder {
 public:
  /// `stepper` is null for a state at rest. `state` and the stage's parts must stay alive.
  ForceRecorder(const ForceStage& stage, const RunPlan& plan, const Stepper* stepper, const State& state, Recorded& result);
  /// Where the value of a request with kind `force` is found after record().
  const double* value(const Request& request) const;
  /// Evaluates the last step.
  void record();

 private:
  const RunPlan& plan_;
  const Stepper* stepper_;
  const State& state_;
  Recorded& result_;
  std::vector<const ForceQuantity*> quantities_;  // of the columns, then of the envelopes
  std::size_t first_of_envelopes_ = 0;
  std::unique_ptr<const ForceMeter> meter_;
  std::vector<double> values_;
  Vector start_;  // accelerations before the first step
};

}  // namespace uplift
