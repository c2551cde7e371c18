#pragma once
#include <petscmat.h>

#include <memory>
#include <vector>

#include "uplift/distributed/rank_cells.h"

namespace uplift {

/// The sum of equal cells with unknowns in other units, S A S.
struct ScaledCells {
  std::shared_ptr<const RankCells> cells;  // null: there are none
  std::vector<Matrix> local;               // of each class
  std::vector<double> scale;               // diagonal of S in the rows of this rank
};

/// S A S + R of equal cells and a rest of entries, as a matrix of PETSc that knows its products and its diagonal alone.
class CellMatrix {
 public:
  explicit CellMatrix(ScaledCells cells) : cells_(std::move(cells)) {}
  ~CellMatrix();
  CellMatrix(const CellMatrix&) = delete;
  CellMatrix& operator=(const CellMatrix&) = delete;
  /// Before anything else, by all ranks together. `rest` stays the caller's and must live as long.
  PetscErrorCode make(Mat rest);
  Mat get() const { return matrix_; }
  /// Numbers that it keeps on this rank beside those of the rest.
  double bytes() const {
    return cells_.cells->bytes() + sizeof(double) * static_cast<double>(cells_.scale.size() + from_.size() + to_.size());
  }
  double operations() const { return cells_.cells->operations(); }
  /// What the cells add to S A S between chosen unknowns (ascending, of all ranks), by their numbers among these: upper triangle, rows of
  /// this rank, a summand of every cell.
  std::vector<Triplet> upper_among(const std::vector<PetscInt>& chosen) const;

 private:
  static PetscErrorCode product_of(Mat matrix, Vec x, Vec y);
  static PetscErrorCode diagonal_of(Mat matrix, Vec diagonal);
  PetscErrorCode multiply(Vec x, Vec y);

  ScaledCells cells_;
  Mat rest_ = nullptr, matrix_ = nullptr;
  Vec of_others_ = nullptr;  // on the places of other ranks in from_
  VecScatter from_others_ = nullptr;
  std::vector<double> from_, to_;  // on places
};

}  // namespace uplift
