#pragma once
#include "uplift/linear/solver.h"
#include "uplift/math/symmetric_sum.h"
#include "uplift/model/matrix_home.h"

// What a solver for models whose factor is too large may offer beside what every solver does.
namespace uplift {

/// A factor whose solves are dear. The flexibility of interfaces is made of its entries between rows up to the reach apart and corrected in
/// every step (SolvedResponse); with a reach of 0 it is made of all entries, as with any other factor.
class FactorWithReach : public Factor {
 public:
  virtual double reach() const = 0;  // m
  /// `solve` with a residual that may be that share of the load; not more exactly than `solve`.
  virtual void solve_to(const Matrix& b, Matrix& x, double residual) const = 0;
};

/// 0 for a factor without.
inline double reach_of(const Factor& factor) {
  const auto* with = dynamic_cast<const FactorWithReach*>(&factor);
  return with != nullptr ? with->reach() : 0;
}

/// The motions of a rigid body. They deform nothing, and iterations without mass are slowest to find them.
struct RigidMotions {
  Matrix motions;         // unknowns x motions; may have none
  std::vector<int> node;  // of each unknown
};

/// As FactorWithReach::solve_to; exactly with a factor without.
inline void solve_to(const Factor& factor, const Matrix& b, Matrix& x, double residual) {
  if (const auto* with = dynamic_cast<const FactorWithReach*>(&factor); with != nullptr)
    with->solve_to(b, x, residual);
  else
    factor.solve(b, x);
}

/// A solver that treats matrices without mass by another method than those of a time step.
class SolverOfStatics : public LinearSolver {
 public:
  /// That for the matrices of static stages; null: this one.
  virtual std::unique_ptr<const LinearSolver> for_statics(const RigidMotions& motions) const = 0;
};

/// A solver of matrices whose rows are distributed over the processes of a job.
class DistributedSolver : public SolverOfStatics {
 public:
  /// Where a model leaves its matrices for this solver.
  virtual std::shared_ptr<const MatrixHome> home() const = 0;
  /// As those of LinearSolver.
  virtual Factorisation factorise_sum(const SymmetricSum& a) const = 0;
  virtual SplitFactorisation factorise_split_sum(const SymmetricSum& a, const std::vector<int>& last) const = 0;
  virtual FactorCost predict_sum(const SymmetricSum& a) const = 0;
};

/// Null: the solver takes whole matrices.
inline std::shared_ptr<const MatrixHome> home_of(const LinearSolver& solver) {
  const auto* distributed = dynamic_cast<const DistributedSolver*>(&solver);
  return distributed != nullptr ? distributed->home() : nullptr;
}

/// Of a sum that has distributed terms the solver is a DistributedSolver.
inline Factorisation factorise(const LinearSolver& solver, const SymmetricSum& a) {
  return a.there.empty() ? solver.factorise(a.here) : dynamic_cast<const DistributedSolver&>(solver).factorise_sum(a);
}
inline SplitFactorisation factorise_split(const LinearSolver& solver, const SymmetricSum& a, const std::vector<int>& last) {
  return a.there.empty() ? solver.factorise_split(a.here, last)
                         : dynamic_cast<const DistributedSolver&>(solver).factorise_split_sum(a, last);
}
inline FactorCost predict(const LinearSolver& solver, const SymmetricSum& a, const std::vector<int>& last) {
  return a.there.empty() ? solver.predict(a.here, last) : dynamic_cast<const DistributedSolver&>(solver).predict_sum(a);
}

/// Null: the same solver.
inline std::unique_ptr<const LinearSolver> solver_for_statics(const LinearSolver& solver, const RigidMotions& motions) {
  const auto* other = dynamic_cast<const SolverOfStatics*>(&solver);
  return other != nullptr ? other->for_statics(motions) : nullptr;
}

}  // namespace uplift
