#pragma once
#include <string>

#include "uplift/contact/problem.h"
#include "uplift/dynamics/bulk.h"
#include "uplift/run/run.h"

namespace uplift {

/// The interface problem of a dynamic step with its compliance alone, for automatic stiffnesses and for `check`. `b`: rows of all
/// interfaces. Where the factorisation fails `why` says so, and there is no compliance.
ContactModel probe(const Model& model, const Bulk& bulk, const Sparse& b, const Stage& stage, const LinearSolver& solver,
                   LinearCounts& counts, std::string& why);
/// The same of the static stages, with the closed joint in the factored matrix, where no dynamic stage follows.
ContactModel static_probe(const Model& model, const LinearSolver& solver, LinearCounts& counts, std::string& why);

}  // namespace uplift
