#pragma once
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "uplift/math/symmetric_sum.h"
#include "uplift/model/model.h"

namespace uplift {

/// What is divided among processes: vertices, each of some unknowns that stay together, and the sets of vertices that elements couple.
struct CoupledVertices {
  std::vector<int> unknowns;  // of each vertex
  using TakeSet = std::function<void(std::span<const int> vertices)>;
  std::function<void(const TakeSet& take)> each_set;
};

/// What the elements of a model are summed up from.
struct ElementsOfModel {
  Space space;
  const std::vector<Node>& nodes;
  const std::vector<std::unique_ptr<const Element>>& elements;
  const std::vector<char>& left_out;  // see ElementSum
  const Sparse& expansion;            // T^T
};

/// One matrix of them, and what equal cells add to it, which are left out of the elements.
struct MatrixOfElements {
  Matrix* Local::*wanted;
  EqualCellPart cells;
};

/// The processes of a job as a place for matrices.
class MatrixHome {
 public:
  virtual ~MatrixHome() = default;
  virtual int processes() const = 0;
  /// The process of each vertex: all have about as many unknowns, and few vertices are coupled with those of other processes.
  virtual std::vector<int> divide(const CoupledVertices& graph) const = 0;
  /// Whether a matrix may be kept as the sum of equal cells and a rest.
  virtual bool takes_cells() const = 0;
  /// `firsts`: see DistributedMatrix::firsts.
  virtual std::shared_ptr<const DistributedCells> keep_cells(const std::vector<int>& firsts,
                                                             const std::vector<EqualCells>& classes) const = 0;
  /// Each process gets the elements that reach its rows and makes these rows from them.
  virtual std::vector<std::shared_ptr<const DistributedMatrix>> keep(const std::vector<int>& firsts, const ElementsOfModel& elements,
                                                                     const std::vector<MatrixOfElements>& matrices) const = 0;
};

}  // namespace uplift
