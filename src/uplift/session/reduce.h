#pragma once
#include <cstdint>
#include <memory>
#include <optional>

#include "uplift/reduction/reduced_model.h"
#include "uplift/run/run_state.h"
#include "uplift/session/session.h"

// Reduced models of a case (docs/theory/reduced_models.md): made by `uplift reduce`, used by runs of a case that names one.
namespace uplift {

struct ReduceOptions {
  double frequency = 25;                       // Hz, see TrainingOptions
  int size = 0;                                // coordinates; 0: by the target
  double target = 2e-4;                        // of the transfer error
  int controls = 0;                            // runs that state the error
  double least_scale = 0.5, most_scale = 1.5;  // of the motions of the control runs
  std::uint64_t seed = 1;
};

/// The reduced model of a case. Empty when it was stopped. Throws InputError: the case has what reduced models do not represent, or its
/// structure has unknowns without mass and stiffness.
std::optional<ReducedModel> reduce_case(const LoadedCase& loaded, const ReduceOptions& options, const Control& control);

/// Reads the reduced model that a case names. Throws InputError.
std::shared_ptr<const ReducedModel> read_reduced_model_of(const Values& root);

/// Throws InputError where the reduced model belongs to another structure, or does not represent what the case has.
void refuse_reduced(const ReducedModel& reduced, const Where& where, const BuiltCase& built);

/// Computes the static stages of a built case and puts its model into the coordinates of the reduced model, with the state at which its
/// first dynamic stage begins as further coordinates. `result`: of the static stages where they fail or are stopped: nothing is returned
/// then. Throws as refuse_reduced().
std::optional<RunState> begin_reduced(const ReducedModel& reduced, const Where& where, BuiltCase& built, const Watch& watch,
                                      RunResult& result);

}  // namespace uplift
