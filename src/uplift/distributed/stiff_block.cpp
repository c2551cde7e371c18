#include "uplift/distributed/stiff_block.h"

#include <algorithm>
#include <cmath>

namespace uplift {

namespace {

const LinearSolver& solver_of_block() {
  static const std::unique_ptr<const LinearSolver> solver = [] {
    const auto catalog = solver_catalog();
    return (*std::ranges::find(catalog, "cholmod", [](const auto* entry) { return entry->name; }))->make(Values());
  }();
  return *solver;
}

/// Times of an iteration, in entries that are streamed: the product with a matrix of `unknowns` in space, shared by two ranks, and both
/// halves of a back-solve with the factor of a block, of which a frame or walls have 10 k^(4/3) entries, a solid block twice as many.
double product_entries(double unknowns) {
  return 40 * unknowns;
}
double block_entries(double unknowns) {
  return 20 * std::pow(unknowns, 4.0 / 3);
}

/// Of the block, so that even the factor of a solid one stays small: 26 MB, or 80 bytes for each of all unknowns.
std::size_t largest_block(double unknowns) {
  return static_cast<std::size_t>(std::min(unknowns / 2, std::max(8000.0, std::pow(unknowns / 2, 0.75))));
}

}  // namespace

/// The share M_ii / A_ii of the mass is small where the wave of a step crosses many cells. With the k smallest in the block the iterations
/// are about proportional to 1 / sqrt(share) of the next one, and their time is known: the k of the least product.
std::vector<int> stiff_unknowns(const Vector& scale, const Vector& mass) {
  constexpr double no_mass = 1e-8, worth = 0.7;  // the least share that counts; the largest share of the time that is left
  const auto share = [&](int i) { return std::max(mass[i] * scale[i] * scale[i], no_mass); };
  const auto unknowns = static_cast<double>(scale.size());
  const std::size_t most = largest_block(unknowns);
  if (most == 0) return {};
  std::vector<std::pair<double, int>> smallest(static_cast<std::size_t>(scale.size()));
  for (int i = 0; i < scale.size(); ++i) smallest[static_cast<std::size_t>(i)] = {share(i), i};
  std::ranges::partial_sort(smallest, smallest.begin() + static_cast<std::ptrdiff_t>(most) + 1);
  const auto time = [&](std::size_t k) {
    return (product_entries(unknowns) + block_entries(static_cast<double>(k))) / std::sqrt(smallest[k].first);
  };
  std::size_t best = 0;
  for (std::size_t k = 1; k <= most; ++k)
    if (time(k) < time(best)) best = k;
  if (time(best) > worth * time(0)) return {};
  std::vector<int> chosen;
  for (std::size_t k = 0; k < best; ++k) chosen.push_back(smallest[k].second);
  std::ranges::sort(chosen);
  return chosen;
}

StiffBlock::~StiffBlock() {
  VecScatterDestroy(&choice_);
  VecDestroy(&of_block_);
}

namespace {

/// The numbers of all ranks one after another; on rank 0.
template <class Value>
std::vector<Value> gathered(const std::vector<Value>& mine, MPI_Datatype type, MPI_Comm ranks) {
  int rank = 0, count = 1;
  MPI_Comm_rank(ranks, &rank);
  MPI_Comm_size(ranks, &count);
  const int size = static_cast<int>(mine.size());
  std::vector<int> sizes(static_cast<std::size_t>(count)), firsts(sizes.size());
  MPI_Gather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, 0, ranks);
  for (std::size_t r = 1; r < sizes.size(); ++r) firsts[r] = firsts[r - 1] + sizes[r - 1];
  std::vector<Value> all(rank == 0 ? static_cast<std::size_t>(firsts.back() + sizes.back()) : 0);
  MPI_Gatherv(mine.data(), size, type, all.data(), sizes.data(), firsts.data(), type, 0, ranks);
  return all;
}

}  // namespace

PetscErrorCode StiffBlock::collect(Mat entries, const CellMatrix* cells) {
  PetscFunctionBeginUser;
  MPI_Comm ranks = MPI_COMM_NULL;
  int rank = 0;
  PetscInt first = 0, end = 0;
  PetscCall(PetscObjectGetComm(reinterpret_cast<PetscObject>(entries), &ranks));
  PetscCallMPI(MPI_Comm_rank(ranks, &rank));
  PetscCall(MatGetOwnershipRange(entries, &first, &end));
  std::vector<Triplet> mine = cells != nullptr ? cells->upper_among(unknowns_) : std::vector<Triplet>();
  const auto at = [&](PetscInt row) { return std::ranges::lower_bound(unknowns_, row) - unknowns_.begin(); };
  for (std::ptrdiff_t i = at(first), last = at(end); i < last; ++i) {
    const PetscInt row = unknowns_[static_cast<std::size_t>(i)], *columns = nullptr;
    PetscInt count = 0;
    const PetscScalar* values = nullptr;
    PetscCall(MatGetRow(entries, row, &count, &columns, &values));
    for (PetscInt k = 0; k < count; ++k)
      if (const std::ptrdiff_t j = at(columns[k]);
          j >= i && j < std::ssize(unknowns_) && unknowns_[static_cast<std::size_t>(j)] == columns[k])
        mine.emplace_back(static_cast<int>(i), static_cast<int>(j), values[k]);
    PetscCall(MatRestoreRow(entries, row, &count, &columns, &values));
  }
  std::vector<int> rows, columns;
  std::vector<double> values;
  for (const Triplet& entry : mine) {
    rows.push_back(entry.row());
    columns.push_back(entry.col());
    values.push_back(entry.value());
  }
  rows = gathered(rows, MPI_INT, ranks);
  columns = gathered(columns, MPI_INT, ranks);
  values = gathered(values, MPI_DOUBLE, ranks);
  const PetscInt here = rank == 0 ? unknowns() : 0;
  mine.clear();
  for (std::size_t k = 0; k < values.size(); ++k) mine.emplace_back(rows[k], columns[k], values[k]);
  upper_.resize(here, here);
  upper_.setFromTriplets(mine.begin(), mine.end());
  numbers_ = Matrix::Zero(here, 1);
  Vec all = nullptr;
  IS wanted = nullptr;
  PetscCall(MatCreateVecs(entries, &all, nullptr));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, here, numbers_.data(), &of_block_));
  PetscCall(ISCreateGeneral(PETSC_COMM_SELF, here, unknowns_.data(), PETSC_COPY_VALUES, &wanted));
  PetscCall(VecScatterCreate(all, wanted, of_block_, nullptr, &choice_));
  PetscCall(ISDestroy(&wanted));
  PetscCall(VecDestroy(&all));
  PetscFunctionReturn(0);
}

FactorCost StiffBlock::predict() const {
  return upper_.rows() > 0 ? solver_of_block().predict(upper_, {}) : FactorCost();
}

void StiffBlock::factorise(std::string& why) {
  if (upper_.rows() == 0) return;
  Factorisation made = solver_of_block().factorise(upper_);
  Sparse().swap(upper_);
  factor_ = std::move(made.factor);
  why = std::move(made.why);
}

PetscErrorCode StiffBlock::become(PC pc) {
  PetscFunctionBeginUser;
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetContext(pc, this));
  PetscCall(PCShellSetApply(pc, apply_to));
  PetscCall(PCShellSetName(pc, "diagonal, and a block for stiff parts"));
  PetscFunctionReturn(0);
}

PetscErrorCode StiffBlock::apply_to(PC pc, Vec x, Vec y) {
  PetscFunctionBeginUser;
  StiffBlock* self = nullptr;
  PetscCall(PCShellGetContext(pc, &self));
  PetscCall(self->apply(x, y));
  PetscFunctionReturn(0);
}

PetscErrorCode StiffBlock::apply(Vec x, Vec y) {
  PetscFunctionBeginUser;
  PetscCall(VecScatterBegin(choice_, x, of_block_, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecCopy(x, y));
  PetscCall(VecScatterEnd(choice_, x, of_block_, INSERT_VALUES, SCATTER_FORWARD));
  if (factor_ != nullptr) factor_->solve(numbers_, numbers_);
  PetscCall(VecScatterBegin(choice_, of_block_, y, INSERT_VALUES, SCATTER_REVERSE));
  PetscCall(VecScatterEnd(choice_, of_block_, y, INSERT_VALUES, SCATTER_REVERSE));
  PetscFunctionReturn(0);
}

}  // namespace uplift
