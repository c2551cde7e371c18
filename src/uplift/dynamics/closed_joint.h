#pragma once
#include "uplift/dynamics/condensed.h"

// A structure that rests on contact alone has a singular stiffness: the closed joint is factored with it and taken back in the interface
// problem (docs/theory, section 4).
namespace uplift {

/// Stiffness D of the closed joints [N/m per row]: area * closed stiffness of a law, at most a million times the largest diagonal of K; for
/// a cone the largest diagonal of K, at most a thousand times the parts that it joins, which would be lost in the round-off of the sum. Any
/// positive value is exact.
Vector closed_joint(const Model& model, const Vector& stiffness_diagonal, const Sparse& b, const Behaviours& behaviours);

/// B^T D B: what the closed joint adds to the stiffness.
Sparse joint_stiffness(const Sparse& b, const Vector& d);

/// What both sides of each row resist by the diagonal of K, 1/sum(b^2/K_ii) [N/m]; infinite where that is zero. A diagonal that is the
/// round-off of terms that cancel, as those of solids inside a rigid body, is zero: a joint a thousand times as stiff as that lets the body
/// go by 1e5 m in the free response, whose round-off (1e-11 m) is then left in the openings of closed points.
Vector stiffness_of_parts(const Model& model, const Vector& stiffness_diagonal, const Sparse& b);

}  // namespace uplift
