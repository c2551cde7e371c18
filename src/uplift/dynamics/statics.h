#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "uplift/dynamics/plastic_newton.h"
#include "uplift/dynamics/stage_model.h"

namespace uplift {

/// What a static stage has reached.
struct StaticProgress {
  double share = 0;  // of the stage
  // J: trapezoidal sums over its load steps, exact where all forces are proportional to the displacements
  double work = 0;        // of the dead loads and, as in the ledger (docs/theory, eq 20), of the moving supports
  double dissipated = 0;  // by yielding solids
  double friction = 0;    // under constraints
};

/// How a static stage proceeds.
struct StaticOptions {
  int steps = 1;     // equal load steps
  int halvings = 8;  // a load step that fails is halved at most so often
  const std::vector<TimeLoad>* second_order =
      nullptr;  // what prescribed motions do through the geometric stiffness of P-Delta; null: nothing
  PlasticOptions plastic = {};
  // Called after every load step that converged, halved ones too; false ends the stage there.
  std::function<bool(const StaticProgress&)> after_step = {};
};

struct StaticOutcome {
  bool converged = false;  // all load steps
  double reached = 0;      // share of the stage up to which there is equilibrium
  int steps = 0, retries = 0, iterations = 0;
  std::string why;                         // empty where after_step has ended the stage
  std::string not_unique;                  // why the last equilibrium is one of several; empty where it is the only one
  std::optional<InterfaceProblem> failed;  // the interface problem of the load step that failed
  std::vector<double> newton;  // residuals of the outer Newton in the last load step, of the forces' size; empty without yielding solids
};

/// Equilibrium under the dead loads and the prescribed motions at the state's time: K u + B^T p(B u + gap) = f. The right-hand side goes in
/// equal steps from the internal force of `state` to f, so that a second static stage does not unload the structure. With the load factor
/// of `state` below 1 the motions, in the yielding solids and the openings too, rise in proportion with it.
///
/// K alone is singular for a structure that rests on contact: the factored matrix is K + B^T D B with the closed joint's stiffness D, taken
/// back in the interface problem (docs/theory, section 4). Solids that can yield are iterated on around that (dynamics/plastic_newton.h). A
/// load step that fails is halved; when the smallest one fails too, `state` is the last equilibrium. Velocity and acceleration of the state
/// become zero.
StaticOutcome solve_statics(const StageModel& stage, const ContactChoice& contact, const LinearSolver& solver, const StaticOptions& options,
                            State& state, LinearCounts& counts);

}  // namespace uplift
