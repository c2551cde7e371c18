#pragma once
#include <functional>
#include <string>

#include "uplift/base/error.h"
#include "uplift/model/mechanism.h"

namespace uplift {

/// Throws InputError when a dynamic run is impossible: a motion has neither stiffness nor mass nor damping even with all interfaces closed,
/// an unknown that a constraint touches has no mass (its acceleration after an impact would be undefined), or the mass matrix is singular
/// although not massless (a point mass off its node without inertia). Names node and direction. Massless unknowns are fine when they have
/// stiffness or a traction law holds them, and bodies that nothing holds are free to move. `file`: the place of the error in a model
/// without interfaces.
void check_dynamic(const Model& model, const Where& file = {});

/// Throws InputError when an impact rule cannot act: an unknown that an interface touches has no mass.
void check_impulses(const Model& model);

/// Throws InputError when the structure is loose although all interfaces are closed (see unresisted_motion): it has no static equilibrium.
/// Names the loose nodes and how they can move. `place_of`: of a node by its name, for a model without interfaces.
void check_static(const Model& model, const std::function<Where(const std::string& node)>& place_of = {});

/// A motion of the free unknowns in words ("\"top\", \"base\" can move along (1, 0)").
std::string describe_motion(const Model& model, const Vector& motion);

}  // namespace uplift
