#pragma once
#include <utility>

#include "uplift/model/model.h"

namespace uplift {

/// Stiffness, mass and damping of a model, to be taken out of it while it is moved and put back behind: Eigen copies a sparse matrix where
/// another value would be moved, and these three take most of the memory.
struct ModelMatrices {
  Sparse stiffness, mass, damping;
  void swap(Model& model) {
    stiffness.swap(model.stiffness);
    mass.swap(model.mass);
    damping.swap(model.damping);
  }
};

/// Moves a model without a copy of its matrices.
inline void move_model(Model&& from, Model& to) {
  ModelMatrices matrices;
  matrices.swap(from);
  to = std::move(from);
  matrices.swap(to);
}

}  // namespace uplift
