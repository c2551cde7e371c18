#pragma once
#include <vector>

#include "uplift/model/model.h"

namespace uplift {

/// Modal damping C = M Phi diag(2 zeta w) Phi^T M [N s/m] with the first `count` modes (all massive ones when 0 < count is larger than
/// there are) of the model whose interfaces are bonded: traction laws with their closed stiffness, K + sum B^T diag(weight k) B; under a
/// cone the opening is held to zero, exactly, by elimination. Ratios: one per mode, the last one is repeated. `count` 0: as many modes as
/// ratios. (Chopra, Dynamics of Structures, section 11.4.2.) The matrix is full; InputError (at `where`) for models with more than 2000
/// unknowns.
Sparse modal_damping(const Model& model, const std::vector<double>& ratios, int count, const Where& where);

/// C = own + alpha M + beta K with stiffness, mass and Rayleigh damping of a model. `own` is used up.
void add_rayleigh(const Model& model, Sparse own, Sparse& damping);

/// The bonded stiffness of the traction laws, K + sum B^T diag(weight k_closed) B; cones add nothing.
Sparse bonded_stiffness(const Model& model);
/// The same with a stiffness without interfaces that stands elsewhere.
Sparse bonded_stiffness(const Model& model, const Sparse& without);
/// Columns span the motions in which no interface with a cone opens or slips; the identity without cones.
Sparse cones_held(const Model& model);

}  // namespace uplift
