#pragma once
#include <petscsys.h>

#include <vector>

namespace uplift {

struct LocalRows;

/// The rows of a matrix in blocks of one size, one for every node: multigrid gathers nodes, and takes a third of the rows of its graph.
/// Nodes with fewer unknowns, because of supports or where a rank begins, have rows of the identity beside their own; those with more
/// have several blocks.
class NodeBlocks {
 public:
  /// Every row is one of its own.
  NodeBlocks() = default;
  /// `node`: of each row of this rank. All ranks together.
  NodeBlocks(MPI_Comm ranks, const std::vector<int>& node);
  PetscInt size() const { return size_; }  // of a block
  /// Rows of this rank with those of the identity, and of all ranks.
  PetscInt local() const { return local_; }
  PetscInt all() const { return all_; }
  bool any() const { return size_ > 1; }
  /// Adds the rows of the identity; columns are counted with those of all ranks then. All ranks together.
  LocalRows fill(LocalRows rows) const;
  /// Numbers of the rank's rows to their places, and back; the places between them stay as they are.
  void put(const double* rows, double* places) const;
  void take(const double* places, double* rows) const;

 private:
  MPI_Comm ranks_ = MPI_COMM_NULL;
  PetscInt size_ = 1, local_ = 0, first_ = 0, all_ = 0;
  std::vector<PetscInt> place_;  // of each row of this rank, counted from its first one
};

}  // namespace uplift
