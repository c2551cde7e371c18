#include "uplift/linear/petsc.h"

namespace uplift {

std::unique_ptr<const LinearSolver> make_petsc(const Values& values) {
  fail(values, "", "\"cholmod\", \"eigen\" or \"dense\" (\"petsc\" needs the program uplift-mpi: make mpi; mpirun -n 4 uplift-mpi ...)",
       "\"petsc\"");
}

}  // namespace uplift
