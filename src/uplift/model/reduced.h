#pragma once
#include "uplift/model/model.h"

namespace uplift {

/// The free unknowns are coordinates of a basis (reduction/projection.h): the matrices are full or diagonal, and no free unknown is one of
/// a node.
inline bool is_reduced(const Model& model) {
  return model.kept.empty() && model.free() > 0;
}

}  // namespace uplift
