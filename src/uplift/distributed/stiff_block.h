#pragma once
#include <petscksp.h>

#include <memory>
#include <string>
#include <vector>

#include "uplift/distributed/cell_matrix.h"
#include "uplift/linear/solver.h"

// A block of the preconditioner for stiff parts of a model. Conjugate gradients with the diagonal alone need about sqrt(A_ii / M_ii) of the
// stiffest unknown as many iterations (M: the mass of the step's matrix), so that a building of concrete decides how long its soil takes.
// The preconditioner is block diagonal: the unknowns of stiff parts form one block, which rank 0 factorises, and every other unknown is a
// block of its own. It is symmetric and positive definite with the matrix.
namespace uplift {

/// The unknowns that are worth a block, ascending; none where the diagonal does about as well. `scale`: 1 / sqrt(A_ii), `mass`: M_ii, both
/// of all unknowns.
std::vector<int> stiff_unknowns(const Vector& scale, const Vector& mass);

/// All ranks call the functions together.
class StiffBlock {
 public:
  /// `unknowns`: ascending, the same on all ranks.
  explicit StiffBlock(std::vector<PetscInt> unknowns) : unknowns_(std::move(unknowns)) {}
  ~StiffBlock();
  StiffBlock(const StiffBlock&) = delete;
  StiffBlock& operator=(const StiffBlock&) = delete;
  /// Collects the block of a matrix, the sum of `entries` and of `cells` (null: none), on rank 0.
  PetscErrorCode collect(Mat entries, const CellMatrix* cells);
  /// On rank 0, after `collect`; elsewhere nothing.
  FactorCost predict() const;
  /// `why`: on rank 0, why there is no factor.
  void factorise(std::string& why);
  /// Becomes the preconditioner of a matrix with a unit diagonal, once rank 0 has the factor.
  PetscErrorCode become(PC pc);
  PetscInt unknowns() const { return static_cast<PetscInt>(unknowns_.size()); }
  double nonzeros() const { return factor_ != nullptr ? factor_->nonzeros() : 0; }  // on rank 0

 private:
  static PetscErrorCode apply_to(PC pc, Vec x, Vec y);
  PetscErrorCode apply(Vec x, Vec y);

  std::vector<PetscInt> unknowns_;
  Sparse upper_;  // on rank 0, until it is factorised
  std::unique_ptr<const Factor> factor_;
  Matrix numbers_;               // of the block, one column; on rank 0
  Vec of_block_ = nullptr;       // on numbers_
  VecScatter choice_ = nullptr;  // from a vector of all unknowns to of_block_
};

}  // namespace uplift
