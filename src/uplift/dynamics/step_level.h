#pragma once
#include <memory>
#include <string>

#include "uplift/dynamics/step.h"

namespace uplift {

/// Everything that depends on the size of the step.
struct Stepper::Level {
  double step = 0;
  StepWeights weights;
  std::unique_ptr<StepSolver> solver;
  std::shared_ptr<const BulkFactor> tangent;  // the last one of yielding solids, whose analysis serves the next one
  ImpactFactors impacts;
  // with all forces of the beginning, while a solution without some of them is sought (impact_friction.cpp)
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
