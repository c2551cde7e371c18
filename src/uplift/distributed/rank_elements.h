#pragma once
#include <mpi.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "uplift/model/matrix_home.h"

namespace uplift {

/// The elements of a model that reach the rows of this rank.
class RankElements {
 public:
  /// From rank 0, which calls `send_elements` with this rank.
  RankElements(std::int64_t rows, MPI_Comm ranks);
  /// With numbers of its own for the nodes. Refers to this object, and has no nodes.
  ElementsOfModel model() const { return {space_, no_nodes_, elements_, none_left_out_, expansion_}; }

 private:
  Space space_;
  std::vector<Node> no_nodes_;
  std::vector<char> none_left_out_;
  std::vector<std::unique_ptr<const Element>> elements_;
  Sparse expansion_;
};

/// Rank 0 sends the elements that reach rows from `first` to below `end` to a rank, piece by piece: solids on whole cells as their nodes,
/// position and material; of all others the matrices.
void send_elements(const ElementsOfModel& model, Index first, Index end, int rank, MPI_Comm ranks);

}  // namespace uplift
