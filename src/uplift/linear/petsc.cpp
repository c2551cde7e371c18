#include "uplift/linear/petsc.h"

namespace uplift {

const Entry<LinearSolver>& entry_solver_petsc() {
  static const Entry<LinearSolver> entry{
      {.name = "petsc",
       .summary = "PETSc on the processes of an MPI job, in the program uplift-mpi only: MUMPS, or iterative by its options",
       .equations = "D^-1/2 A D^-1/2 = P^T L D' L^T P by MUMPS, D: diagonal of A, where there are no options;\n"
                    "else a Krylov method: conjugate gradients until |r| <= 1e-12 |b|, weights 1/sqrt(A_ii), where they name none;\n"
                    "with Jacobi's preconditioner, in dynamic stages: diag(A_ss, D_rr), s: unknowns of stiff parts, r: all others",
       .source = "PETSc 3.18 (Balay et al., Users Manual ANL-21/39, 2022); MUMPS 5.5 (Amestoy, Duff, L'Excellent & Koster, SIAM J. Matrix "
                 "Anal. Appl. 23, 2001)",
       .params = {text("options", "options of PETSc, as \"-ksp_type cg -pc_type jacobi\"; empty: a factorisation by MUMPS").standard(""),
                  text("static_options", "the same for static stages; without it as `options`").optional(),
                  number("reach", "m",
                         "entries of the flexibility between interface rows farther apart are left out when it is made and "
                         "restored in every step by solves; 0: all are made, with one solve a row")
                      .nonnegative()
                      .standard(0.0),
                  flag("stiff_block",
                       "with \"-ksp_type cg -pc_type jacobi\" stiff parts (a building of concrete on soil) are factorised as one block of "
                       "the preconditioner of the steps, where that saves time; false: the diagonal alone")
                      .standard(true)}},
      make_petsc};
  return entry;
}

}  // namespace uplift
