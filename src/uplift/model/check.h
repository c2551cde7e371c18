#pragma once
#include <string>

#include "uplift/model/model.h"

namespace uplift {

/// Throws InputError when a dynamic run is impossible: an unknown that an interface touches has no mass (its acceleration after an impact
/// would be undefined), or a mass matrix that is singular although not massless (a point mass off its node without inertia). Names node and
/// direction: "zero mass where mass is needed". Massless unknowns elsewhere are fine when they have stiffness.
void check_dynamic(const Model& model);

/// Throws InputError when the structure is loose although all interfaces are closed (bonded with their closed stiffness, cones held in
/// the normal direction, and in the tangential one when they have friction). Names the loose nodes and how they can move. `dashpots_hold`:
/// without static stages a motion that dashpots or absorbing faces resist is not loose.
void check_static(const Model& model, bool dashpots_hold = false);

/// How the model can move without any resistance with its interfaces closed, in words ("\"top\", \"base\" can move along (1, 0)"); empty
/// when it cannot.
std::string loose_part(const Model& model, bool dashpots_hold = false);

}  // namespace uplift
