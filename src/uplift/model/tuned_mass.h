#pragma once
#include "uplift/model/model.h"

namespace uplift {

/// The point mass [kg] that gives the structure the wanted fixed-base frequency [Hz] as its first one (the paper tunes its oscillator to 10
/// Hz so). `model` is the structure without this mass; all bodies that an interface touches are held (also in the tangential direction and
/// in rotation).
///
/// A mass m on the node adds m times the sum of e e^T over the directions, so that det(I - w^2 m E^T (K - w^2 M)^-1 E) = 0:
///     m = 1/(w^2 largest eigenvalue of E^T (K - w^2 M)^-1 E)
/// and w is the first frequency if and only if K - w^2 M is positive definite (interlacing of eigenvalues under an added mass).
/// Throws InputError (at `where`) when the other masses alone already bring the structure below the frequency, or when the node cannot
/// move.
double tuned_mass(const Model& model, int node, double frequency, const Where& where);

/// Columns span the motions (free unknowns) in which every node that an interface touches stands still: the fixed-base model.
Sparse base_held(const Model& model);

}  // namespace uplift
