#pragma once
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "uplift/math/linalg.h"

// Symmetric matrices that are too large for one process: their rows are distributed over the processes of a job.
namespace uplift {

class DistributedMatrix;

/// A matrix whose rows are distributed, and what it is multiplied by.
struct DistributedTerm {
  double factor;
  std::shared_ptr<const DistributedMatrix> matrix;
  bool is_mass = false;  // the matrix is the mass of a model, not its stiffness or damping
};

/// A symmetric matrix of which every process of a job keeps some rows, as long as this object lives.
class DistributedMatrix {
 public:
  virtual ~DistributedMatrix() = default;
  /// y = sum of factor * A x. All terms are matrices of one job, of the same size, and this is one of them.
  virtual void multiply(std::span<const DistributedTerm> sum, const Vector& x, Vector& y) const = 0;
  virtual Vector diagonal() const = 0;
  /// Entries that each process keeps.
  virtual const std::vector<double>& entries() const = 0;
  /// The first row of each process, then the number of rows.
  virtual const std::vector<int>& firsts() const = 0;
};

/// Cells of one class: each of them adds the same small matrix to a sum, at rows of its own.
struct EqualCells {
  int unknowns = 0;       // of a cell
  std::vector<int> rows;  // unknowns of the first cell, of the second one ...; -1: held
};

/// Classes of cells whose places the processes of a job keep, for any number of matrices, as long as this object lives.
class DistributedCells {
 public:
  virtual ~DistributedCells() = default;
  /// That each process keeps.
  virtual const std::vector<double>& bytes() const = 0;
};

/// What cells add to a matrix.
struct EqualCellPart {
  std::shared_ptr<const DistributedCells> cells;  // null: nothing
  std::vector<Matrix> local;                      // of each class, unknowns x unknowns, symmetric; empty: zero
};

/// A symmetric matrix to be looked at: the upper triangle of what stands here, and terms whose rows are distributed; none as a rule.
struct SymmetricSum {
  SymmetricSum(const Sparse& upper, std::span<const DistributedTerm> terms = {})  // NOLINT(google-explicit-constructor)
      : here(upper), there(terms) {}
  const Sparse& here;
  std::span<const DistributedTerm> there;
  Index rows() const { return here.rows(); }
  Vector diagonal() const;
  Vector times(const Vector& x) const;
};

/// The same, kept.
struct OwnedSum {
  Sparse here;
  std::vector<DistributedTerm> there;
  operator SymmetricSum() const { return {here, there}; }  // NOLINT(google-explicit-constructor)
};

}  // namespace uplift
