#pragma once
#include <utility>
#include <vector>

#include "uplift/dynamics/step.h"

namespace uplift {

/// Forces of the radiation dashpots beside foundations, on the rows of the foundations' points: p = c dg/dt, with the velocity dg/dt of the
/// footing against the ground under it. They belong to the same time as the forces of the laws that are reported (State::mean_force): with
/// these they are in equilibrium with the structure.
class RadiationForces {
 public:
  /// `b`: of all interfaces (stack_interfaces).
  RadiationForces(const Model& model, const Sparse& b);
  /// One force per row of all interfaces [N, N m], tension > 0, of the last step: with the path average the mean over the step, else at its
  /// end. It stays until the next call; null without dashpots.
  const Vector* forces(const Stepper& stepper) { return rows_.empty() ? nullptr : &measure(stepper); }

 private:
  const Vector& measure(const Stepper& stepper);
  struct Row {
    int row;
    double damping;                                               // N s/m, N m s/rad
    std::vector<std::pair<int, double>> terms;                    // of the free unknowns
    std::vector<std::pair<const TimeFunction*, double>> motions;  // prescribed
  };
  std::vector<Row> rows_;
  Vector force_;
};

}  // namespace uplift
