#pragma once
#include "uplift/model/model.h"

namespace uplift {

/// What resists a motion: stiffness and closed interfaces; in a dynamic stage masses and dashpots as well; or these without the interfaces.
enum class Resistance { stiffness, dynamic, dynamic_open };

/// A motion of the free unknowns that nothing resists with all interfaces closed (bonded with their closed stiffness, cones held in the
/// normal direction, and in the tangential one when they have friction); empty when there is none.
///
/// A motion without strain energy moves every rigid part (model/rigid_parts.h) as a rigid body. Its unknowns are those of the parts and of
/// the other nodes. Every node of a part, every row of an interface and every row of the stiffness (mass, damping) of another element is
/// one linear equation, and Gauss-Jordan elimination finds the solutions. Only the geometry enters, and no stiffness: the answer depends
/// neither on the number of cells nor on how soft the structure is.
Vector unresisted_motion(const Model& model, Resistance resistance);
/// All motions, as columns, that neither stiffness nor these interface rows resist (of all interfaces one after another; 0: does not hold).
Matrix unresisted_motions(const Model& model, const std::vector<char>& holds);

}  // namespace uplift
