#pragma once
#include <optional>
#include <string>

#include "uplift/dynamics/condensed.h"
#include "uplift/dynamics/plastic_newton.h"

namespace uplift {

struct StaticOutcome {
  bool converged = false;
  int steps = 0, retries = 0, iterations = 0;
  std::string why;
  std::optional<InterfaceProblem> failed;  // the interface problem of the load step that failed
  std::vector<double> newton;  // residuals of the outer Newton in the last load step, of the forces' size; empty without yielding solids
};

/// Equilibrium under the dead loads, applied in equal steps from `state` on: K u + B^T p(B u) = f. K alone is singular for a structure that
/// rests on contact: the factored matrix is K + B^T D B with the closed joint's stiffness D, taken back in the interface problem (THEORY
/// section 6). Solids that can yield are iterated on around that (dynamics/plastic_newton.h). A load step that fails is halved. Velocity
/// and acceleration of the state become zero.
StaticOutcome solve_statics(const Model& model, const Bulk& bulk, const Sparse& b, const Vector& gap, const Behaviours& behaviours,
                            const ContactMethod& method, const LinearSolver& solver, int steps, State& state, LinearCounts& counts,
                            const PlasticOptions& plastic = {});

/// Stiffness D of the closed joints [N/m per row]: area * closed stiffness of a law, at most 1000 times the largest diagonal of K; for a
/// cone the largest diagonal of K. Any positive value is exact.
Vector closed_joint(const Model& model, const Behaviours& behaviours);

}  // namespace uplift
