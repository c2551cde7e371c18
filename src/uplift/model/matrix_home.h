#pragma once
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "uplift/math/symmetric_sum.h"

namespace uplift {

/// What is divided among processes: vertices, each of some unknowns that stay together, and the sets of vertices that elements couple.
struct CoupledVertices {
  std::vector<int> unknowns;  // of each vertex
  using TakeSet = std::function<void(std::span<const int> vertices)>;
  std::function<void(const TakeSet& take)> each_set;
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
  /// `firsts`: see DistributedMatrix.
  virtual std::shared_ptr<const DistributedCells> keep_cells(const std::vector<int>& firsts,
                                                             const std::vector<EqualCells>& classes) const = 0;
  /// The matrix whose columns `make(first, count)` returns, complete and rows x count, but for what cells add to it. `make` is called once
  /// for each process, and what it has returned goes there before it is called again.
  using MakeColumns = std::function<Sparse(Index first, Index count)>;
  virtual std::shared_ptr<const DistributedMatrix> keep(const std::vector<int>& firsts, const MakeColumns& make,
                                                        const EqualCellPart& part) const = 0;
};

}  // namespace uplift
