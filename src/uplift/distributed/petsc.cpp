#include "uplift/distributed/petsc.h"

#include <csignal>
#include <cstdlib>
#include <utility>

#include "uplift/cli/console.h"
#include "uplift/linear/blas.h"

namespace uplift {

namespace {

/// The message of the innermost of the errors since the last one that was taken. PETSc's handler can reach nothing else.
std::string& kept_error() {
  static std::string text;
  return text;
}

/// Memory that one rank alone lacks would leave the others waiting for it: then the job ends.
PetscErrorCode keep_error(MPI_Comm, int, const char*, const char*, PetscErrorCode number, PetscErrorType type, const char* message, void*) {
  if (number == PETSC_ERR_MEM) {
    cli::complain("error: not enough memory on one of the ranks: use more of them, on more machines, or coarsen the mesh");
    MPI_Abort(PETSC_COMM_WORLD, 3);
  }
  if (type == PETSC_ERROR_INITIAL && message != nullptr) kept_error() = message;
  return number;
}

}  // namespace

Petsc::Petsc() {
  prepare_blas();
  setenv("SCOTCH_PTHREAD_NUMBER", "1", 1);  // with several threads PTScotch finds another partition each time
  // -skip_petscrc: results depend on the case file alone; signals are those of the program
  char name[] = "uplift-mpi", plain[] = "-skip_petscrc", own_signals[] = "-no_signal_handler";
  char* words[] = {name, plain, own_signals, nullptr};
  char** list = words;
  int count = 3;
  PETSC_MPI_THREAD_REQUIRED = MPI_THREAD_SERIALIZED;  // runs in lockstep are threads, of which one at a time calls PETSc
  PetscInitialize(&count, &list, nullptr, nullptr);
  PetscPushErrorHandler(keep_error, nullptr);
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank_);
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks_);
}

Petsc::~Petsc() {
  PetscPopErrorHandler();
  PetscFinalize();
}

std::string take_petsc_error() {
  return std::exchange(kept_error(), {});
}

}  // namespace uplift
