#pragma once
#include <memory>

#include "uplift/linear/solver.h"

namespace uplift {

/// The solver "petsc" from its checked values. There are two of this function: that of the program `uplift-mpi` (distributed/solver.cpp),
/// and that of the library (petsc_absent.cpp), which throws InputError. The linker takes the second one where the first one is not there.
std::unique_ptr<const LinearSolver> make_petsc(const Values& values);

}  // namespace uplift
