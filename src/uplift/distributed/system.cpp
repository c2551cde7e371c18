// MUMPS with symmetric storage (SYM = 2) and no pivoting beyond the order of elimination (CNTL(1) = 0), which a positive definite matrix
// does not need: its INFOG(12) and INFOG(28) then count the negative and the vanishing pivots of A (Sylvester's law of inertia), with the
// root of the elimination tree on one rank (ICNTL(13) = 1), without which pivots of the root are not counted.
#include "uplift/distributed/system.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "uplift/distributed/petsc.h"
#include "uplift/linear/solver.h"

namespace uplift {

SolverOptions::SolverOptions(const std::string& words) {
  PetscOptionsCreate(&options_);
  PetscOptionsInsertString(options_, words.c_str());
}

SolverOptions::~SolverOptions() {
  PetscOptionsDestroy(&options_);
}

bool SolverOptions::has(const char* name) const {
  PetscBool found = PETSC_FALSE;
  PetscOptionsHasName(options_, nullptr, name, &found);
  return found == PETSC_TRUE;
}

bool SolverOptions::need_no_entries() const {
  const auto is = [&](const char* name, std::initializer_list<std::string_view> values) {
    char value[32] = "";
    PetscBool found = PETSC_FALSE;
    PetscOptionsGetString(options_, nullptr, name, value, sizeof value, &found);
    return found == PETSC_FALSE || std::ranges::find(values, value) != values.end();
  };
  return (has("-ksp_type") || has("-pc_type")) && is("-ksp_type", {"cg"}) && is("-pc_type", {"jacobi", "none"}) &&
         is("-pc_jacobi_type", {"diagonal"});
}

std::vector<std::string> SolverOptions::left() const {
  PetscInt count = 0;
  char **names = nullptr, **values = nullptr;
  PetscOptionsLeftGet(options_, &count, &names, &values);
  std::vector<std::string> list;
  for (PetscInt i = 0; i < count; ++i) list.push_back("-" + std::string(names[i]));
  PetscOptionsLeftRestore(options_, &count, &names, &values);
  return list;
}

System::~System() {
  KSPDestroy(&solver_);
  cells_.reset();
  VecDestroy(&given_);
  VecDestroy(&solved_);
  MatDestroy(&matrix_);
}

SystemOutcome System::agree(PetscErrorCode error, SystemOutcome mine) const {
  const std::string said = take_petsc_error();
  if (error != 0 && mine.ok()) mine.why = said.empty() ? fmt::format("PETSc failed (error {})", static_cast<int>(error)) : "PETSc: " + said;
  int rank = 0, ranks = 1;
  MPI_Comm_rank(ranks_, &rank);
  MPI_Comm_size(ranks_, &ranks);
  int teller = mine.ok() ? ranks : rank;
  MPI_Allreduce(MPI_IN_PLACE, &teller, 1, MPI_INT, MPI_MIN, ranks_);
  if (teller == ranks) return {};
  int facts[2] = {static_cast<int>(mine.why.size()), mine.too_large ? 1 : 0};
  MPI_Bcast(facts, 2, MPI_INT, teller, ranks_);
  mine.why.resize(static_cast<std::size_t>(facts[0]));
  MPI_Bcast(mine.why.data(), facts[0], MPI_CHAR, teller, ranks_);
  mine.too_large = facts[1] != 0;
  return mine;
}

SystemOutcome System::set(LocalRows local, PetscInt rows, const std::vector<int>& node, ScaledCells cells) {
  return agree(assemble(std::move(local), rows, node, std::move(cells)), {});
}

namespace {

/// Leaves of complete rows the entries between them, whose columns are counted from `first` on, and returns all others.
LocalRows take_others(LocalRows& rows, PetscInt first) {
  LocalRows others;
  const auto count = static_cast<PetscInt>(rows.start.size()) - 1;
  PetscInt kept = 0, next = 0;
  others.start.push_back(0);
  for (PetscInt row = 0; row < count; ++row) {
    for (const PetscInt end = rows.start[row + 1]; next < end; ++next) {
      const PetscInt column = rows.column[next] - first;
      if (column >= 0 && column < count) {
        rows.column[kept] = column, rows.value[kept++] = rows.value[next];
      } else {
        others.column.push_back(rows.column[next]);
        others.value.push_back(rows.value[next]);
      }
    }
    rows.start[row + 1] = kept;
    others.start.push_back(static_cast<PetscInt>(others.column.size()));
  }
  rows.column.resize(kept), rows.value.resize(kept);
  return others;
}

}  // namespace

PetscErrorCode System::assemble(LocalRows local, PetscInt rows, const std::vector<int>& node, ScaledCells cells) {
  PetscFunctionBeginUser;
  rows_ = rows, local_ = static_cast<PetscInt>(local.start.size()) - 1;
  int in_nodes = node.empty() ? 0 : 1;  // a rank without rows has no node
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &in_nodes, 1, MPI_INT, MPI_MAX, ranks_));
  if (in_nodes != 0) blocks_ = NodeBlocks(ranks_, node);
  if (blocks_.any()) local = blocks_.fill(std::move(local));
  const PetscInt stored = blocks_.any() ? blocks_.local() : local_, all = blocks_.any() ? blocks_.all() : rows;
  PetscInt end = 0;
  PetscCallMPI(MPI_Scan(&stored, &end, 1, MPIU_INT, MPI_SUM, ranks_));
  among_ = std::move(local);
  beyond_ = take_others(among_, end - stored);
  PetscCall(MatCreateMPIAIJWithSplitArrays(ranks_, stored, stored, all, all, among_.start.data(), among_.column.data(), among_.value.data(),
                                           beyond_.start.data(), beyond_.column.data(), beyond_.value.data(), &matrix_));
  PetscCall(MatSetOption(matrix_, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(MatSetOption(matrix_, MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
  if (blocks_.any()) {
    PetscCall(MatSetBlockSize(matrix_, blocks_.size()));
    PetscCall(MatCreateVecs(matrix_, &solved_, &given_));
  } else {
    for (Vec* vector : {&given_, &solved_}) PetscCall(VecCreateMPIWithArray(ranks_, 1, local_, rows, nullptr, vector));
  }
  if (cells.cells != nullptr) {
    cells_ = std::make_unique<CellMatrix>(std::move(cells));
    PetscCall(cells_->make(matrix_));
  }
  MatInfo info;
  PetscCall(MatGetInfo(matrix_, MAT_GLOBAL_SUM, &info));
  nonzeros_ = info.nz_used;
  PetscFunctionReturn(0);
}

SystemOutcome System::set_motions(const std::vector<double>& motions, PetscInt columns) {
  return agree(keep_motions(motions, columns), {});
}

/// Orthonormal, as MatNullSpaceCreate wants them; what depends on those before is left out.
PetscErrorCode System::keep_motions(const std::vector<double>& motions, PetscInt columns) {
  PetscFunctionBeginUser;
  std::vector<Vec> kept;
  for (PetscInt c = 0; c < columns; ++c) {
    Vec motion = nullptr;
    PetscCall(MatCreateVecs(matrix_, &motion, nullptr));
    double* values = nullptr;
    PetscCall(VecGetArray(motion, &values));
    const double* own = motions.data() + static_cast<std::ptrdiff_t>(c) * local_;
    if (blocks_.any())
      blocks_.put(own, values);
    else
      std::copy_n(own, local_, values);
    PetscCall(VecRestoreArray(motion, &values));
    PetscReal size = 0, left = 0;
    PetscCall(VecNormalize(motion, &size));
    for (int twice = 0; twice < 2; ++twice)
      for (const Vec before : kept) {
        PetscScalar share = 0;
        PetscCall(VecDot(motion, before, &share));
        PetscCall(VecAXPY(motion, -share, before));
      }
    PetscCall(VecNormalize(motion, &left));
    if (size > 0 && left > 1e-8)
      kept.push_back(motion);
    else
      PetscCall(VecDestroy(&motion));
  }
  MatNullSpace space = nullptr;
  PetscCall(MatNullSpaceCreate(ranks_, PETSC_FALSE, static_cast<PetscInt>(kept.size()), kept.data(), &space));
  PetscCall(MatSetNearNullSpace(matrix_, space));
  PetscCall(MatNullSpaceDestroy(&space));
  for (Vec& vector : kept) PetscCall(VecDestroy(&vector));
  PetscFunctionReturn(0);
}

/// While it lives PETSc reads these options, and no others.
class OptionsInUse {
 public:
  explicit OptionsInUse(const SolverOptions& options) { PetscOptionsPush(options.get()); }
  ~OptionsInUse() { PetscOptionsPop(); }
  OptionsInUse(const OptionsInUse&) = delete;
  OptionsInUse& operator=(const OptionsInUse&) = delete;
};

SystemOutcome System::prepare(const SolverOptions& options) {
  const OptionsInUse in_use(options);
  SystemOutcome outcome;
  PetscErrorCode error = choose(options, outcome);
  outcome = agree(error, std::move(outcome));
  if (!outcome.ok()) return outcome;
  error = set_up(outcome);
  return agree(error, std::move(outcome));
}

SystemOutcome System::foretell(const SolverOptions& options, SystemCost& cost) {
  const OptionsInUse in_use(options);
  SystemOutcome outcome;
  PetscErrorCode error = choose(options, outcome);
  outcome = agree(error, std::move(outcome));
  if (!outcome.ok()) return outcome;
  error = analyse(cost);
  return agree(error, std::move(outcome));
}

PetscErrorCode System::analyse(SystemCost& cost) {
  PetscFunctionBeginUser;
  constexpr int vectors = 8;  // of conjugate gradients: load, solution, residual, direction, their products and the scale
  MatInfo own;
  PetscCall(MatGetInfo(matrix_, MAT_LOCAL, &own));
  cost.bytes = own.nz_used * (sizeof(PetscScalar) + sizeof(PetscInt)) + vectors * sizeof(PetscScalar) * static_cast<double>(local_);
  if (cells_ != nullptr) cost.bytes += cells_->bytes();
  PC pc = nullptr;
  PetscBool multigrid = PETSC_FALSE;
  PetscCall(KSPGetPC(solver_, &pc));
  PetscCall(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(pc), PCGAMG, &multigrid));
  // while its levels are made: prolongations and products of them, measured with smoothed aggregates in blocks of soil in space
  if (multigrid == PETSC_TRUE) cost.bytes += 3 * own.nz_used * (sizeof(PetscScalar) + sizeof(PetscInt));
  if (stiff_block_ != nullptr) {
    const FactorCost block = stiff_block_->predict();
    cost.bytes += block.bytes + block.working_bytes;
  }
  if (factor_ == nullptr) PetscFunctionReturn(0);
  cost.bytes += (own.nz_used + local_) / 2 * (sizeof(PetscScalar) + 2 * sizeof(PetscInt));  // what MUMPS is given
  MatFactorInfo info;
  PetscInt megabytes = 0, entries = 0;
  PetscCall(MatFactorInfoInitialize(&info));
  PetscCall(MatMumpsSetIcntl(factor_, 14, 20));  // MUMPS' own reserve; what is beyond it is not touched, as a rule
  PetscCall(MatCholeskyFactorSymbolic(factor_, matrix_, nullptr, &info));
  PetscCall(MatMumpsGetInfo(factor_, 15, &megabytes));
  PetscCall(MatMumpsGetInfog(factor_, 20, &entries));
  PetscCall(MatMumpsGetRinfog(factor_, 1, &cost.operations));
  cost.entries = entries < 0 ? -1e6 * static_cast<double>(entries) : static_cast<double>(entries);
  cost.bytes += 1e6 * static_cast<double>(megabytes);
  PetscFunctionReturn(0);
}

PetscErrorCode System::choose(const SolverOptions& options, SystemOutcome& outcome) {
  PetscFunctionBeginUser;
  constexpr int most_iterations = 20000;
  PetscReal weak_coupling = 0.04;  // of nodes, beside the geometric mean of both with themselves: left out of the graph of multigrid
  const bool method = options.has("-ksp_type"), conditioner = options.has("-pc_type");
  PetscCall(KSPCreate(ranks_, &solver_));
  PetscCall(KSPSetOperators(solver_, matrix(), matrix()));
  PetscCall(KSPSetTolerances(solver_, 1e-12, PETSC_DEFAULT, PETSC_DEFAULT, most_iterations));
  PC pc = nullptr;
  PetscCall(KSPGetPC(solver_, &pc));
  PetscCall(KSPSetType(solver_, method || conditioner ? KSPCG : KSPPREONLY));
  PetscCall(PCSetType(pc, method || conditioner ? PCJACOBI : PCCHOLESKY));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  if (blocks_.any()) {
    PetscCall(PCSetType(pc, PCGAMG));
    PetscCall(PCGAMGSetThreshold(pc, &weak_coupling, 1));
  }
  PetscCall(KSPSetFromOptions(solver_));
  PetscCall(KSPGetTolerances(solver_, &tolerance_, nullptr, nullptr, nullptr));
  PetscBool cholesky = PETSC_FALSE, cg = PETSC_FALSE, alone = PETSC_FALSE;
  PetscCall(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(pc), PCCHOLESKY, &cholesky));
  if (cholesky == PETSC_TRUE && !method) PetscCall(KSPSetType(solver_, KSPPREONLY));
  PetscCall(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(solver_), KSPCG, &cg));
  PetscCall(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(solver_), KSPPREONLY, &alone));
  if (cg == PETSC_TRUE && !options.has("-ksp_norm_type")) PetscCall(KSPSetNormType(solver_, KSP_NORM_UNPRECONDITIONED));
  if (cholesky == PETSC_TRUE)
    PetscCall(use_mumps(options));
  else
    PetscCall(MatSetOption(matrix(), MAT_SPD, PETSC_TRUE));
  PetscBool diagonal = PETSC_FALSE;
  PetscCall(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(pc), PCJACOBI, &diagonal));
  if (!stiff_.empty() && diagonal == PETSC_TRUE && options.need_no_entries()) {
    stiff_block_ = std::make_unique<StiffBlock>(std::move(stiff_));
    PetscCall(stiff_block_->collect(matrix_, cells_.get()));
  }
  block_ = alone == PETSC_TRUE;
  if (factor_ == nullptr && (cholesky == PETSC_TRUE || cg == PETSC_FALSE))
    outcome.why =
        "they would not notice a matrix that is not positive definite, as conjugate gradients (-ksp_type cg) and the factorisation by "
        "MUMPS "
        "(-pc_type cholesky) do";
  PetscFunctionReturn(0);
}

/// The settings of MUMPS, where the options name no other package; the options may change them.
PetscErrorCode System::use_mumps(const SolverOptions& options) {
  PetscFunctionBeginUser;
  PC pc = nullptr;
  MatSolverType package = nullptr;
  PetscCall(KSPGetPC(solver_, &pc));
  if (!options.has("-pc_factor_mat_solver_type")) PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(PCFactorGetMatSolverType(pc, &package));
  if (package == nullptr || std::string_view(package) != MATSOLVERMUMPS) PetscFunctionReturn(0);
  PetscCall(PCFactorSetUpMatSolverType(pc));
  PetscCall(PCFactorGetMatrix(pc, &factor_));
  PetscCall(MatMumpsSetIcntl(factor_, 8, 0));                          // no scaling: the diagonal is one
  PetscCall(MatMumpsSetIcntl(factor_, 14, 100));                       // % of work space beyond its forecast, which is too low on 4 ranks
  PetscCall(MatMumpsSetIcntl(factor_, 13, 1));                         // the root on one rank
  PetscCall(MatMumpsSetIcntl(factor_, 24, 1));                         // vanishing pivots are counted
  PetscCall(MatMumpsSetCntl(factor_, 1, 0.0));                         // no pivoting
  PetscCall(MatMumpsSetCntl(factor_, 3, -LinearSolver::least_pivot));  // negative: absolute
  PetscFunctionReturn(0);
}

PetscErrorCode System::set_up(SystemOutcome& outcome) {
  PetscFunctionBeginUser;
  PC pc = nullptr;
  PCFailedReason failed = PC_NOERROR;
  if (stiff_block_ != nullptr) PetscCall(use_stiff_block());
  PetscCall(KSPSetUp(solver_));
  PetscCall(KSPGetPC(solver_, &pc));
  PetscCall(PCGetFailedReason(pc, &failed));
  if (failed == PC_FACTOR_OUTMEMORY) {
    outcome = {
        "the factor does not fit into the memory of the ranks: use more of them, on more machines, or coarsen the mesh; or the work space "
        "of "
        "MUMPS is too small (-mat_mumps_icntl_14 200)",
        true};
    PetscFunctionReturn(0);
  }
  if (failed != PC_NOERROR) {
    outcome.why = fmt::format("the matrix cannot be factorised ({})", PCFailedReasons[failed]);
    PetscFunctionReturn(0);
  }
  if (factor_ != nullptr) PetscCall(check_pivots(outcome));
  if (outcome.ok() && !block_) PetscCall(try_out(outcome));
  if (stiff_block_ != nullptr)
    remark_ = fmt::format(
        "{} unknowns of stiff parts are factorised as one block of the preconditioner ({:.2g} million entries); conjugate "
        "gradients take {} iterations for a trial load",
        stiff_block_->unknowns(), 1e-6 * stiff_block_->nonzeros(), iterations_);
  PetscFunctionReturn(0);
}

/// Without a factor of it the preconditioner stays the diagonal.
PetscErrorCode System::use_stiff_block() {
  PetscFunctionBeginUser;
  std::string why;
  stiff_block_->factorise(why);
  int fails = why.empty() ? 0 : 1;
  PetscCallMPI(MPI_Bcast(&fails, 1, MPI_INT, 0, ranks_));
  if (fails == 0) {
    PC pc = nullptr;
    PetscCall(KSPGetPC(solver_, &pc));
    PetscCall(stiff_block_->become(pc));
    PetscFunctionReturn(0);
  }
  remark_ =
      fmt::format("{} unknowns of stiff parts are not factorised as a block of the preconditioner: {}", stiff_block_->unknowns(), why);
  stiff_block_.reset();
  PetscFunctionReturn(0);
}

PetscErrorCode System::check_pivots(SystemOutcome& outcome) {
  PetscFunctionBeginUser;
  PetscInt negative = 0, vanishing = 0, entries = 0;
  PetscCall(MatMumpsGetInfog(factor_, 12, &negative));
  PetscCall(MatMumpsGetInfog(factor_, 28, &vanishing));
  PetscCall(MatMumpsGetInfog(factor_, 29, &entries));
  nonzeros_ = entries < 0 ? -1e6 * static_cast<double>(entries) : static_cast<double>(entries);
  if (negative + vanishing > 0)
    outcome.why =
        fmt::format("the matrix is not positive definite: of its pivots {} are negative and {} are round-off", negative, vanishing);
  PetscFunctionReturn(0);
}

}  // namespace uplift
