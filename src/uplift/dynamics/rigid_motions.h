#pragma once
#include "uplift/linear/large.h"
#include "uplift/model/model.h"

namespace uplift {

/// Three motions of a rigid body in the plane, six in space, on the free unknowns: translations, then rotations about the middle of the
/// nodes. Supports are not asked: where they hold the structure these are no motions that it could make.
RigidMotions rigid_motions(const Model& model);

}  // namespace uplift
