#pragma once
#include <petscmat.h>

#include <vector>

namespace uplift {

/// A graph whose vertices are weighted with their unknowns. Two are neighbours where a set holds both.
class PartitionGraph {
 public:
  /// `start`, `member`: the sets one after another.
  PartitionGraph(std::vector<PetscInt> unknowns, std::vector<std::size_t> start, std::vector<PetscInt> member);
  ~PartitionGraph();
  PartitionGraph(const PartitionGraph&) = delete;
  PartitionGraph& operator=(const PartitionGraph&) = delete;
  /// The part of each vertex: of PTScotch's partition, or of ranges of numbers where that has the smaller halo or PTScotch fails.
  std::vector<PetscInt> divide(PetscInt parts) const;
  /// Parts of about as many unknowns, of vertices one after another.
  std::vector<PetscInt> ranges(PetscInt parts) const;
  /// Those of PTScotch; empty: it fails. The same graph has the same partition.
  std::vector<PetscInt> partition(PetscInt parts) const;
  /// The unknowns of other parts that each part is coupled with, all parts together.
  double halo(const std::vector<PetscInt>& part) const;
  /// Unknowns of the largest part, in shares of their mean.
  double imbalance(const std::vector<PetscInt>& part, PetscInt parts) const;

 private:
  PetscErrorCode ask_ptscotch(PetscInt parts, std::vector<PetscInt>& part) const;
  std::vector<PetscInt> unknowns_;
  Mat graph_ = nullptr;                               // null: more neighbours than PETSc counts. It owns the lists:
  PetscInt *first_ = nullptr, *neighbour_ = nullptr;  // neighbours of each vertex, ascending
};

}  // namespace uplift
