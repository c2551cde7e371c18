#pragma once
#include "uplift/contact/newton/newton.h"

namespace uplift {

/// Newton's direction -H^-1 G for many coordinates, from the slopes and the gradient in the work space; false when H is singular.
bool direction_of_many(const InterfaceProblem&, NewtonWork&, InterfaceSolution&);

}  // namespace uplift
