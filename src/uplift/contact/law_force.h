#pragma once
#include "uplift/contact/problem.h"

namespace uplift {

/// Force of a law block [N] and its slope [N/m], scale * area times those of the law for the way from problem.from to `opening` (all rows;
/// path-averaged where the problem says so). `response` points to the block's own rows, as in InterfaceLaw; `end` stays a traction.
void law_force(const InterfaceProblem&, const Block&, const double* opening, const LawResponse& response);

}  // namespace uplift
