#pragma once
#include "uplift/contact/newton/newton.h"

namespace uplift {

/// Newton's direction -H^-1 G for many coordinates, from the slopes and the gradient in the scratch; false when H is singular.
bool direction_of_many(const InterfaceProblem&, InterfaceSolution&);

}  // namespace uplift
