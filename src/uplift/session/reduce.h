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
  std::shared_ptr<const ReducedModel> model = nullptr;  // of the same structure: gets control runs, and no basis is made; null: a new one
};

/// The reduced model of a case. Empty when it was stopped before the basis was complete; later, it states the errors of the control runs
/// that were made. Throws InputError: the case has what reduced models do not represent, its structure has unknowns without mass and
/// stiffness, or the given model is that of another structure.
std::optional<ReducedModel> reduce_case(const LoadedCase& loaded, const ReduceOptions& options, const Control& control);

/// Reads a file of `uplift reduce`, which `name` at `where` names. Throws InputError.
ReducedModel read_reduced_model_file(const std::string& path, const Where& where, const std::string& name);

/// Reads the reduced model that a case names. Throws InputError.
std::shared_ptr<const ReducedModel> read_reduced_model_of(const Values& root);

/// Throws InputError where the reduced model, which `name` at `where` names, belongs to another structure, or does not represent what the
/// case has.
void refuse_reduced(const ReducedModel& reduced, const Where& where, const BuiltCase& built, const std::string& name = "reduced_model");

/// What runs of a case with a reduced model share that differ by their motions alone: the state in which the static stages end, and the
/// projected matrices.
struct ReducedStart {
  RunState state;                              // in the coordinates of the basis
  Matrix basis;                                // free unknowns x coordinates, those of the state among them
  Vector dead_force;                           // of the static stages, free unknowns of the whole model [N, N m]
  Vector velocity, displacement;               // initial ones of the plan
  Sparse expansion, stiffness, mass, damping;  // of the model; given to the run that goes on from here
  std::vector<Sparse> rows;                    // of its interfaces
  /// Exchanges the matrices with those of a model: given to a run, and back from it.
  void swap_matrices(Model& model);
};

/// Computes the static stages of a built case and puts its model into the coordinates of the reduced model, with the state at which its
/// first dynamic stage begins as further coordinates. `result`: of the static stages where they fail or are stopped: nothing is returned
/// then. Throws as refuse_reduced(). `shared`: what an earlier run of the same case under other motions has left there is taken instead,
/// where its static stages are the same; else it is made. The matrices are then the model's until swap_matrices() takes them back.
std::optional<RunState> begin_reduced(const ReducedModel& reduced, const Where& where, BuiltCase& built, const Watch& watch,
                                      RunResult& result, std::optional<ReducedStart>* shared = nullptr);

}  // namespace uplift
