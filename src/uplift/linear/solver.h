#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "uplift/base/catalog.h"
#include "uplift/linear/split.h"
#include "uplift/math/linalg.h"

namespace uplift {

/// A factorised matrix. Thread-safe; many columns at once.
class Factor {
 public:
  virtual ~Factor() = default;
  /// x = A^-1 b; b and x have the same shape and may be the same object.
  virtual void solve(const Matrix& b, Matrix& x) const = 0;
  virtual double nonzeros() const = 0;  // of the factor, for the physical limit
};

/// Result of a factorisation: a factor, or the reason and the unknown at which it broke down.
struct Factorisation {
  std::unique_ptr<const Factor> factor;
  int failed_unknown = -1;
  std::string why;
};

/// Factorises symmetric positive definite matrices (both triangles stored). A pivot that is only round-off (smaller than `least_pivot`
/// times the diagonal entry it came from) is a failure: the matrix is singular to working precision.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  virtual Factorisation factorise(const Sparse& a) const = 0;
  /// The same with chosen unknowns eliminated last. No factor and an empty reason: this solver cannot.
  virtual SplitFactorisation factorise_split(const Sparse& a, const std::vector<int>& last) const;
  static constexpr double least_pivot = 1e-14;
};

std::span<const Entry<LinearSolver>* const> solver_catalog();  // "cholmod" (default), "eigen", "dense"
std::span<const PartInfo* const> linear_solvers();

/// The failure message of every solver.
Factorisation singular_at(int unknown);

/// One natural mode.
struct Mode {
  double frequency = 0;  // Hz
  Vector shape;          // free unknowns, mass-normalised
};
/// The lowest `count` modes of K x = (2 pi f)^2 M x; massless unknowns are allowed (condensed exactly). Fewer are returned when there are
/// fewer. Rigid-body modes come out with frequency 0. Dense up to about 500 massive unknowns, beyond that Lanczos (Spectra) on the
/// flexibility seen by the masses, with our CHOLMOD. Empty when a massless unknown has no stiffness either.
std::vector<Mode> modes(const Sparse& stiffness, const Sparse& mass, int count);

}  // namespace uplift
