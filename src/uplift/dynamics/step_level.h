#pragma once
#include <memory>
#include <string>

#include "uplift/dynamics/step.h"

namespace uplift {

/// Everything that depends on the size of the step. The right-hand side of the displacement increment is
///   R = f1 + f0 af/w - K u0/w - B^T p0 af/w + M (mass_velocity v0 + mass_acceleration a0) - C (damping_velocity v0 + damping_acceleration
///   a0)
/// with w = 1 - af, and for the path average, in the midpoint form with the filters of the scheme (b: gain, h_e = (1 + 2 b) dt),
///   R = (f0 + f1 - 2 K (u0 - b d_u) + (4/h_e) M (v0 - b d_v))/(1 + 2 b)
struct Stepper::Level {
  double step = 0;
  double mass = 0, damping = 0;  // K_eff = K + damping C + mass M
  double share = 1;              // 1/(1 + 2 b)
  double mass_velocity = 0, mass_acceleration = 0, damping_velocity = 0, damping_acceleration = 0;
  std::unique_ptr<StepSolver> solver;
  std::shared_ptr<const BulkFactor> tangent;  // the last one of yielding solids, whose analysis serves the next one
  std::unique_ptr<BulkFactor> impact_factor;  // of the matrix behind one of the following; of K_eff, where damp_impact() has no other
  std::unique_ptr<Spread> dynamic;            // of K + 4M/dt^2, for `propagate`
  std::unique_ptr<Spread> impact;             // of M + w D, for `project_hold` with damping D and the trapezoidal rule
  std::unique_ptr<CoulombRates> coulomb;      // by which impulses with friction spread there
  // with all forces of the beginning, while a solution without some of them is sought (step_friction.cpp)
  Vector increment;
  PlasticState plastic;
  InterfaceSolution solution;
  std::string why;        // when the matrix could not be factorised
  bool hopeless = false;  // nor would that of a smaller step be
};

/// Made when it is needed for the first time.
inline Stepper::Level& Stepper::level(int halving) {
  const std::unique_ptr<Level>& made = levels_[static_cast<std::size_t>(halving)];
  return made != nullptr ? *made : make_level(halving);
}

}  // namespace uplift
