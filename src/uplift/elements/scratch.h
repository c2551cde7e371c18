#pragma once
#include <vector>

#include "uplift/elements/solid_rules.h"

namespace uplift {

/// Room for one element at a time during an update. Updates allocate nothing once it has served the largest element.
struct ElementScratch {
  double duration = 0;  // of the step that is updated [s]; 0 in a static stage
  // of the integration points
  std::vector<PointGradient> gradient;
  std::vector<Strain> strain;
  std::vector<Stress> stress;
  std::vector<Mat6> tangent;
  std::vector<double> trial;  // stresses if no memory changes, component after component
  // of the incompatible modes
  Vector mode_force;  // N: zero when the modes are in balance
  Matrix mode_stiffness;
};

}  // namespace uplift
