#pragma once
#include <petscsys.h>

#include <string>

namespace uplift {

/// PETSc and MPI from here to the end of the object. Errors of PETSc are kept, not printed.
class Petsc {
 public:
  Petsc();
  ~Petsc();
  Petsc(const Petsc&) = delete;
  Petsc& operator=(const Petsc&) = delete;
  int rank() const { return rank_; }
  int ranks() const { return ranks_; }

 private:
  int rank_ = 0, ranks_ = 1;
};

/// What PETSc said of its last error on this rank, and nothing from now on.
std::string take_petsc_error();

}  // namespace uplift
