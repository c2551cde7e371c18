#include "uplift/distributed/node_blocks.h"

#include <algorithm>
#include <cstddef>

#include "uplift/distributed/system.h"

namespace uplift {

namespace {

constexpr PetscInt most_in_block = 3;  // displacements of a node in space; its rotations are another block

/// Number of rows from `first` on that are of one node and fit into a block.
PetscInt run_of(const std::vector<int>& node, std::size_t first, PetscInt most) {
  PetscInt count = 1;
  while (count < most && first + static_cast<std::size_t>(count) < node.size() &&
         node[first + static_cast<std::size_t>(count)] == node[first])
    ++count;
  return count;
}

}  // namespace

NodeBlocks::NodeBlocks(MPI_Comm ranks, const std::vector<int>& node) : ranks_(ranks) {
  for (std::size_t row = 0; row < node.size(); row += static_cast<std::size_t>(run_of(node, row, most_in_block)))
    size_ = std::max(size_, run_of(node, row, most_in_block));
  MPI_Allreduce(MPI_IN_PLACE, &size_, 1, MPIU_INT, MPI_MAX, ranks_);
  for (std::size_t row = 0; row < node.size(); local_ += size_) {
    const PetscInt count = run_of(node, row, size_);
    for (PetscInt k = 0; k < count; ++k) place_.push_back(local_ + k);
    row += static_cast<std::size_t>(count);
  }
  PetscInt end = 0;
  MPI_Scan(&local_, &end, 1, MPIU_INT, MPI_SUM, ranks_);
  MPI_Allreduce(&local_, &all_, 1, MPIU_INT, MPI_SUM, ranks_);
  first_ = end - local_;
}

LocalRows NodeBlocks::fill(LocalRows rows) const {
  int count = 0;
  MPI_Comm_size(ranks_, &count);
  const int mine = static_cast<int>(place_.size());
  std::vector<int> counts(static_cast<std::size_t>(count)), firsts(counts.size(), 0);
  MPI_Allgather(&mine, 1, MPI_INT, counts.data(), 1, MPI_INT, ranks_);
  for (std::size_t rank = 1; rank < firsts.size(); ++rank) firsts[rank] = firsts[rank - 1] + counts[rank - 1];
  std::vector<PetscInt> own(place_), places(static_cast<std::size_t>(firsts.back() + counts.back()));
  for (PetscInt& place : own) place += first_;
  MPI_Allgatherv(own.data(), mine, MPIU_INT, places.data(), counts.data(), firsts.data(), MPIU_INT, ranks_);
  for (PetscInt& column : rows.column) column = places[static_cast<std::size_t>(column)];
  const std::size_t more = static_cast<std::size_t>(local_) - place_.size();
  std::size_t next = rows.column.size();  // from the last row to the first, each to its place
  rows.column.resize(next + more), rows.value.resize(next + more);
  std::size_t end = rows.column.size(), row = place_.size();
  std::vector<PetscInt> start(static_cast<std::size_t>(local_) + 1);
  start.back() = static_cast<PetscInt>(end);
  for (PetscInt place = local_ - 1; place >= 0; --place) {
    if (row > 0 && place_[row - 1] == place) {
      for (--row; next > static_cast<std::size_t>(rows.start[row]);) {
        rows.column[--end] = rows.column[--next];
        rows.value[end] = rows.value[next];
      }
    } else {
      rows.column[--end] = first_ + place;
      rows.value[end] = 1;
    }
    start[static_cast<std::size_t>(place)] = static_cast<PetscInt>(end);
  }
  rows.start = std::move(start);
  return rows;
}

void NodeBlocks::put(const double* rows, double* places) const {
  for (const PetscInt place : place_) places[place] = *rows++;
}

void NodeBlocks::take(const double* places, double* rows) const {
  for (const PetscInt place : place_) *rows++ = places[place];
}

}  // namespace uplift
