#pragma once
#include "uplift/model/model.h"

namespace uplift {

/// m: the largest distance between points of the interfaces (of nodes, where there is one point or none), up to a tenth less where points
/// lie without symmetry; 0 without points and nodes. What counts as no gap is measured by it, so that the unit of length does not matter.
double base_size(const Model& model);

/// Share of base_size() up to which an opening is no gap: points are told open from closed by it.
inline constexpr double closed_share = 1e-10;

}  // namespace uplift
