#pragma once
#include <petscksp.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "uplift/distributed/cell_matrix.h"
#include "uplift/distributed/node_blocks.h"
#include "uplift/distributed/stiff_block.h"

namespace uplift {

/// The rows of a symmetric matrix that one rank holds, complete (both triangles).
struct LocalRows {
  std::vector<PetscInt> start, column;  // of each row in `column` and `value`, one more than rows; column: of the whole matrix
  std::vector<double> value;
};

/// What all ranks came to: the same on each of them.
struct SystemOutcome {
  std::string why;         // empty: done
  bool too_large = false;  // for the memory that is left
  bool ok() const { return why.empty(); }
};

/// What a solver takes, known before it is prepared.
struct SystemCost {
  double entries = 0, operations = 0;  // of the factor and of making it, all ranks together; 0 where there is none
  double bytes = 0;                    // of this rank: its rows and its part of the factor with the work space to make it
};

/// How the rows of a matrix are shared: rank r holds first(r) ... first(r + 1) - 1.
class Shares {
 public:
  Shares() = default;
  /// Every rank has as many as the next one, or one more.
  Shares(PetscInt rows, int ranks) {
    for (int rank = 1; rank <= ranks; ++rank) firsts_.push_back(rows / ranks * rank + std::min<PetscInt>(rank, rows % ranks));
  }
  /// The first row of each rank, then the number of rows.
  explicit Shares(std::vector<PetscInt> firsts) : firsts_(std::move(firsts)) {}
  const std::vector<PetscInt>& firsts() const { return firsts_; }
  PetscInt first(int rank) const { return firsts_[static_cast<std::size_t>(rank)]; }
  PetscInt count(int rank) const { return first(rank + 1) - first(rank); }
  PetscInt rows() const { return firsts_.back(); }
  /// Of all ranks.
  std::vector<PetscInt> counts() const {
    std::vector<PetscInt> all(firsts_.begin() + 1, firsts_.end());
    for (std::size_t rank = 0; rank < all.size(); ++rank) all[rank] -= firsts_[rank];
    return all;
  }

 private:
  std::vector<PetscInt> firsts_{0};
};

/// PETSc's options of one solver. "" is a factorisation by MUMPS; else without -ksp_type conjugate gradients (with -pc_type cholesky: its
/// back-solve alone), without -pc_type Jacobi.
class SolverOptions {
 public:
  explicit SolverOptions(const std::string& words);
  ~SolverOptions();
  SolverOptions(const SolverOptions&) = delete;
  SolverOptions& operator=(const SolverOptions&) = delete;
  bool has(const char* name) const;
  /// Whether the method asks for products with the matrix and its diagonal alone: conjugate gradients with Jacobi's preconditioner or none.
  bool need_no_entries() const;
  /// Those that nobody has asked for.
  std::vector<std::string> left() const;
  PetscOptions get() const { return options_; }

 private:
  PetscOptions options_ = nullptr;
};

/// One matrix on the ranks of a communicator and what solves with it. All functions but the destructor and those that are const must be
/// called by all ranks together.
class System {
 public:
  explicit System(MPI_Comm ranks) : ranks_(ranks) {}
  ~System();
  System(const System&) = delete;
  System& operator=(const System&) = delete;
  /// The matrix; with a unit diagonal, so that a pivot or a residual has no unit. `rows`: of all ranks. `node`: of each row of this rank,
  /// for methods that treat the unknowns of a node together; empty: none does. Its numbers are not copied.
  /// `cells`: a part of the matrix that has no entries, for methods that need none (all ranks have it, or none).
  SystemOutcome set(LocalRows local, PetscInt rows, const std::vector<int>& node = {}, ScaledCells cells = {});
  /// The motions that deform it least, from which multigrid makes its coarse levels: the rank's rows, one column after another.
  SystemOutcome set_motions(const std::vector<double>& motions, PetscInt columns);
  /// The unknowns of stiff parts, ascending and the same on all ranks: a block of the preconditioner where that is the diagonal.
  void set_stiff(std::vector<PetscInt> unknowns) { stiff_ = std::move(unknowns); }
  /// Factorises it, or prepares the iterative method and tries it on one load. A matrix that is not positive definite is refused: by MUMPS
  /// from the signs of the pivots, where those below LinearSolver::least_pivot count as zero.
  SystemOutcome prepare(const SolverOptions& options);
  /// What `prepare` would take: from the symbolic analysis of MUMPS, with the reserve of work space that it has by default (a larger one is
  /// not touched as a rule); of an iterative method the rows and some vectors, not what its preconditioner makes of them. Nothing else
  /// follows.
  SystemOutcome foretell(const SolverOptions& options, SystemCost& cost);
  /// x = A^-1 b: the rank's rows of all columns, one column after another. An iterative method may stop where the residual is the share
  /// `residual` of the load, and does where its own tolerance is reached.
  SystemOutcome solve(const double* b, double* x, PetscInt columns, double residual = 0);
  Mat matrix() const { return cells_ != nullptr ? cells_->get() : matrix_; }
  PetscInt iterations() const { return iterations_; }  // of the last solve
  double nonzeros() const { return nonzeros_; }        // of the factor; of the matrix where there is none, without cells
  /// What is to be said of the preconditioner, on rank 0; empty: it is the one of the options.
  const std::string& remark() const { return remark_; }
  KSP solver() const { return solver_; }

 private:
  PetscErrorCode assemble(LocalRows local, PetscInt rows, const std::vector<int>& node, ScaledCells cells);
  PetscErrorCode keep_motions(const std::vector<double>& motions, PetscInt columns);
  PetscErrorCode choose(const SolverOptions& options, SystemOutcome& outcome);
  PetscErrorCode analyse(SystemCost& cost);
  PetscErrorCode set_up(SystemOutcome& outcome);
  PetscErrorCode use_stiff_block();
  PetscErrorCode use_mumps(const SolverOptions& options);
  PetscErrorCode check_pivots(SystemOutcome& outcome);
  PetscErrorCode try_out(SystemOutcome& outcome);
  PetscErrorCode solve_columns(const double* b, double* x, PetscInt columns, SystemOutcome& outcome);
  PetscErrorCode solve_column(const double* b, double* x);
  PetscErrorCode solve_block(const double* b, double* x, PetscInt columns);
  PetscErrorCode converged(SystemOutcome& outcome);
  /// The worst of all ranks.
  SystemOutcome agree(PetscErrorCode error, SystemOutcome mine) const;

  MPI_Comm ranks_;
  PetscInt rows_ = 0, local_ = 0, iterations_ = 0;
  NodeBlocks blocks_;         // of the matrix; local_ and rows_ are without the rows of the identity
  LocalRows among_, beyond_;  // entries between rows of this rank, columns from its first row on; all others. PETSc uses them
  Mat matrix_ = nullptr, factor_ = nullptr;  // matrix_: its entries. factor_: of MUMPS, PETSc's own; null without
  std::unique_ptr<CellMatrix> cells_;        // with the entries; null: they are all
  Vec given_ = nullptr, solved_ = nullptr;   // on the caller's numbers
  KSP solver_ = nullptr;
  std::vector<PetscInt> stiff_;
  std::unique_ptr<StiffBlock> stiff_block_;  // null: none
  std::string remark_;
  bool block_ = false;  // several columns at once
  double tolerance_ = 0;
  double nonzeros_ = 0;
};

}  // namespace uplift
