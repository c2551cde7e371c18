#include "uplift/distributed/cell_matrix.h"

#include <algorithm>

namespace uplift {

CellMatrix::~CellMatrix() {
  MatDestroy(&matrix_);
  VecScatterDestroy(&from_others_);
  VecDestroy(&of_others_);
}

PetscErrorCode CellMatrix::make(Mat rest) {
  PetscFunctionBeginUser;
  rest_ = rest;
  const RankCells& cells = *cells_.cells;
  from_.assign(cells.places(), 0.0), to_.assign(cells.places(), 0.0);
  MPI_Comm ranks = MPI_COMM_NULL;
  PetscInt own = 0, rows = 0;
  PetscCall(PetscObjectGetComm(reinterpret_cast<PetscObject>(rest), &ranks));
  PetscCall(MatGetLocalSize(rest, &own, nullptr));
  PetscCall(MatGetSize(rest, &rows, nullptr));
  const auto others = static_cast<PetscInt>(cells.others().size());
  Vec all = nullptr;
  IS wanted = nullptr;
  PetscCall(VecCreateMPIWithArray(ranks, 1, own, rows, nullptr, &all));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, others, from_.data() + own, &of_others_));
  PetscCall(ISCreateGeneral(PETSC_COMM_SELF, others, cells.others().data(), PETSC_COPY_VALUES, &wanted));
  PetscCall(VecScatterCreate(all, wanted, of_others_, nullptr, &from_others_));
  PetscCall(ISDestroy(&wanted));
  // the scale of other ranks' rows, once
  PetscCall(VecPlaceArray(all, cells_.scale.data()));
  PetscCall(VecScatterBegin(from_others_, all, of_others_, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(from_others_, all, of_others_, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecResetArray(all));
  PetscCall(VecDestroy(&all));
  cells_.scale.insert(cells_.scale.end(), from_.begin() + own, from_.end());
  PetscCall(MatCreateShell(ranks, own, own, rows, rows, this, &matrix_));
  PetscCall(MatShellSetOperation(matrix_, MATOP_MULT, reinterpret_cast<void (*)()>(product_of)));
  PetscCall(MatShellSetOperation(matrix_, MATOP_GET_DIAGONAL, reinterpret_cast<void (*)()>(diagonal_of)));
  PetscFunctionReturn(0);
}

PetscErrorCode CellMatrix::product_of(Mat matrix, Vec x, Vec y) {
  PetscFunctionBeginUser;
  CellMatrix* self = nullptr;
  PetscCall(MatShellGetContext(matrix, &self));
  PetscCall(self->multiply(x, y));
  PetscFunctionReturn(0);
}

PetscErrorCode CellMatrix::multiply(Vec x, Vec y) {
  PetscFunctionBeginUser;
  const auto own = static_cast<std::size_t>(cells_.cells->own());
  const double *given = nullptr, *scale = cells_.scale.data();
  double* product = nullptr;
  PetscCall(VecScatterBegin(from_others_, x, of_others_, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(MatMult(rest_, x, y));
  PetscCall(VecGetArrayRead(x, &given));
  for (std::size_t i = 0; i < own; ++i) from_[i] = scale[i] * given[i];
  PetscCall(VecRestoreArrayRead(x, &given));
  PetscCall(VecScatterEnd(from_others_, x, of_others_, INSERT_VALUES, SCATTER_FORWARD));
  for (std::size_t i = own; i < from_.size(); ++i) from_[i] *= scale[i];
  std::ranges::fill(to_, 0.0);
  cells_.cells->add_product(cells_.local, from_.data(), to_.data());
  PetscCall(VecGetArray(y, &product));
  for (std::size_t i = 0; i < own; ++i) product[i] += scale[i] * to_[i];
  PetscCall(VecRestoreArray(y, &product));
  PetscFunctionReturn(0);
}

std::vector<Triplet> CellMatrix::upper_among(const std::vector<PetscInt>& chosen) const {
  const RankCells& cells = *cells_.cells;
  std::vector<int> number(cells.places(), -1);
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const PetscInt own = chosen[k] - cells.first();
    if (own >= 0 && own < cells.own()) {
      number[static_cast<std::size_t>(own)] = static_cast<int>(k);
      continue;
    }
    const auto other = std::ranges::lower_bound(cells.others(), chosen[k]);
    if (other != cells.others().end() && *other == chosen[k])
      number[static_cast<std::size_t>(cells.own() + (other - cells.others().begin()))] = static_cast<int>(k);
  }
  return cells.upper_among(cells_.local, cells_.scale, number);
}

PetscErrorCode CellMatrix::diagonal_of(Mat matrix, Vec diagonal) {
  PetscFunctionBeginUser;
  CellMatrix* self = nullptr;
  PetscCall(MatShellGetContext(matrix, &self));
  PetscCall(MatGetDiagonal(self->rest_, diagonal));
  const Vector of_cells = self->cells_.cells->diagonal(self->cells_.local);
  double* numbers = nullptr;
  PetscCall(VecGetArray(diagonal, &numbers));
  for (Index i = 0; i < of_cells.size(); ++i) {
    const double scale = self->cells_.scale[static_cast<std::size_t>(i)];
    numbers[i] += scale * of_cells[i] * scale;
  }
  PetscCall(VecRestoreArray(diagonal, &numbers));
  PetscFunctionReturn(0);
}

}  // namespace uplift
