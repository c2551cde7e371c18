#pragma once
#include <vector>

#include "uplift/case/case.h"

namespace uplift {

struct WeightAtHeight {
  double weight = 0;  // N, downwards
  double height = 0;  // m, against gravity
};
/// Constant loads on the chosen nodes. A mass whose centre is beside its node is moved there: taken off at the node, added at the centre.
std::vector<WeightAtHeight> weights_at_heights(const Model& model, const std::vector<char>& chosen);

/// Solids have no geometric stiffness. Share of the second-order moment of a structure that leans as a whole, sum of W_i h_i over the dead
/// loads above the first base, that arises within the heights of deformable solids; solids that are rigid bodies are none. 0: no second
/// order of solids is missing with p_delta.
double second_order_of_solids(const BuiltCase& built);
/// Less is nothing to speak of: EN 1998-1, 4.4.2.2, neglects second-order effects up to a tenth.
inline constexpr double least_of_solids = 0.1;

}  // namespace uplift
