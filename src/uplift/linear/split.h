#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "uplift/math/linalg.h"

namespace uplift {

struct SplitFactorisation;

/// Cholesky factor in which chosen unknowns are eliminated last:  P A P^T = L L^T,  P = (the others, the chosen ones in their order).
/// Then the last rows of a forward solve are all that the chosen unknowns feel of a right-hand side, and with L_bb, the last block of L,
///   (A^-1)_bb = L_bb^-T L_bb^-1.
/// A condensed step needs no other product with A^-1 than the two halves of one back-solve. Thread-safe.
class SplitFactor {
 public:
  virtual ~SplitFactor() = default;
  /// y = L^-1 P b: the chosen unknowns' part stands at the end.
  virtual void forward(const Vector& b, Vector& y) const = 0;
  /// x = P^T L^-T y
  virtual void backward(const Vector& y, Vector& x) const = 0;
  /// The same for many right-hand sides at once. The numbers of each depend on it alone, to the last bit: neither on the others nor on how
  /// many there are. (They may differ in round-off from those of the functions above.)
  virtual void forward_all(std::span<const Vector* const> b, std::span<Vector* const> y) const;
  virtual void backward_all(std::span<const Vector* const> y, std::span<Vector* const> x) const;
  /// L_bb: lower triangle, as many rows as there are chosen unknowns; zero above.
  virtual Matrix last() const = 0;
  virtual double nonzeros() const = 0;  // of the factor, for the physical limit
  /// The factor of another matrix by the symbolic analysis of this one. No factor and an empty reason: the matrix has entries for which
  /// this factor has no place, or the solver cannot.
  virtual SplitFactorisation refactorise(const Sparse& a) const;
};

/// A factor, or the reason and the unknown at which the factorisation broke down.
struct SplitFactorisation {
  std::unique_ptr<const SplitFactor> factor;
  int failed_unknown = -1;
  std::string why;
  bool too_large = false;  // for the memory that is left
  std::string remark{};    // how the solver chose to solve with it; empty as a rule
};

}  // namespace uplift
