#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "uplift/base/catalog.h"
#include "uplift/linear/split.h"
#include "uplift/math/linalg.h"
#include "uplift/math/symmetric_pair.h"

namespace uplift {

struct Factorisation;
struct Model;

/// A factorised matrix. Thread-safe; many columns at once.
class Factor {
 public:
  virtual ~Factor() = default;
  /// x = A^-1 b; b and x have the same shape and may be the same object.
  virtual void solve(const Matrix& b, Matrix& x) const = 0;
  virtual double nonzeros() const = 0;  // of the factor, for the physical limit
  /// The factor of another matrix by the symbolic analysis of this one. No factor and an empty reason: the matrix has entries for which
  /// this factor has no place, or the solver cannot.
  virtual Factorisation refactorise(const Sparse& a) const;
};

/// What a factorisation takes, known from its symbolic analysis before it is done.
struct FactorCost {
  double unknowns = 0;
  double entries = 0;        // of the factor as it is stored and streamed; 0: the solver cannot say
  double operations = 0;     // additions and multiplications of the factorisation
  double bytes = 0;          // of the factor
  double working_bytes = 0;  // beside it while it is made
  // of a job of several processes, of which this one takes the bytes above
  double most_elsewhere = 0;  // bytes of the other process that takes most
  double beside = 0;          // bytes of all other processes on this machine together
  std::string why;            // why it cannot be made at all
};

/// Result of a factorisation: a factor, or the reason and the unknown at which it broke down.
struct Factorisation {
  std::unique_ptr<const Factor> factor;
  int failed_unknown = -1;
  std::string why;
  bool too_large = false;  // for the memory that is left
  std::string remark{};    // how the solver chose to solve with it; empty as a rule
};

/// Factorises symmetric positive definite matrices; the upper triangle is read, the other one may be missing. A pivot that is only
/// round-off (smaller than `least_pivot` times the diagonal entry it came from) is a failure: the matrix is singular to working precision.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  virtual Factorisation factorise(const Sparse& a) const = 0;
  /// The same with chosen unknowns eliminated last. No factor and an empty reason: this solver cannot.
  virtual SplitFactorisation factorise_split(const Sparse& a, const std::vector<int>& last) const;
  /// What either would take; `last` empty: in any order. A factor that does not fit into the memory that is left is refused by them, too.
  virtual FactorCost predict(const Sparse& a, const std::vector<int>& last) const;
  /// Two symmetric matrices for common products; null: they are to be multiplied by themselves. They must stay as they are as long as the
  /// pair exists.
  virtual std::shared_ptr<const SymmetricPair> pair(const Sparse& a, const Sparse& b) const;
  /// Whether its factors are spread over several processes: then none is made here for a mere warning.
  virtual bool distributed() const { return false; }
  /// To be called before a matrix is assembled that will be factorised: the solver of one of several runs waits here (Lockstep).
  virtual void wait_for_room() const {}
  /// The model whose stiffness, mass and damping are those of this one: itself, or that of another run that has the same ones.
  virtual const Model& matrices_of(const Model& model) const { return model; }
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
/// fewer. Up to 500 massive unknowns by a dense flexibility, beyond that by shift-invert Lanczos (Spectra) with our CHOLMOD; repeated
/// frequencies are found by searching again beside the modes found. A frequency is exactly 0, a rigid motion, where the strain energy is
/// round-off of the products it is summed of, |x^T K x| <= 1e-14 |x|^T |K| |x|, or w^2 <= 1e-7 of the first elastic one; components of a
/// shape below 1e-14 of its largest are 0. Empty when a massless unknown has no stiffness either.
std::vector<Mode> modes(const Sparse& stiffness, const Sparse& mass, int count);

}  // namespace uplift
