#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "uplift/contact/compliance.h"
#include "uplift/contact/problem.h"
#include "uplift/dynamics/scheme.h"
#include "uplift/math/small_product.h"
#include "uplift/math/symmetric_sum.h"
#include "uplift/model/matrix_sum.h"
#include "uplift/model/model.h"

// The linear bulk (soil and structure without the interfaces) during one stage: products with K, C and M, and the matrix of a step.
namespace uplift {

/// Counted by whoever owns a bulk; nothing global.
struct LinearCounts {
  long factorisations = 0, analyses = 0, back_solves = 0;  // analyses: symbolic ones, of sparse matrices
  double residual = 0;                                     // the largest of all factors, see BulkFactor
  std::string notice;                                      // what it is and where it may come from; empty up to 1e-9
  std::string remark;                                      // of the last solver that had one (Factorisation)
  InterfaceSystems systems;
};

/// Below this number of free unknowns matrices are dense and the inverse is kept: a step then needs no back-solve at all.
inline constexpr int small_bulk = 48;

/// A symmetric matrix of the bulk: a dense copy when it is small and not a diagonal, else a view; or the sum of distributed terms, and of a
/// part that stands here.
class BulkMatrix {
 public:
  BulkMatrix(const Sparse& matrix, bool dense);
  BulkMatrix(std::vector<DistributedTerm> terms, const Sparse* here);
  /// y = A x; y must have the right size.
  void multiply(const Vector& x, Vector& y) const {
    if (product_ != nullptr)
      product_(full_, x.data(), y.data());
    else
      multiply_large(x, y);
  }
  bool zero() const { return zero_; }

 private:
  void multiply_large(const Vector& x, Vector& y) const;
  bool zero_ = true;
  Matrix full_;
  small::Product product_ = nullptr;  // of the dense copy
  const Sparse* sparse_ = nullptr;    // null: dense
  std::vector<DistributedTerm> terms_;
};

/// Refers to the model's matrices, which are large: the model must stay alive.
class Bulk {
  Sparse second_order_;  // stiffness with the geometric one, when there is one

 public:
  Bulk(const Model& model, const Sparse* geometric);
  Bulk(const Bulk&) = delete;
  Bulk& operator=(const Bulk&) = delete;
  int unknowns = 0;
  bool small = false;
  const Sparse &stiffness_matrix, &mass_matrix, &damping_matrix;  // of distributed matrices nothing
  const Sparse* geometric;  // part of stiffness_matrix that the axial forces make; null: none. It must stay alive
  BulkMatrix stiffness, mass, damping;
  std::vector<char> massless;  // per free unknown
  /// Of distributed matrices the processes are asked for them.
  Vector stiffness_diagonal() const;
  Vector damping_diagonal() const;
  Vector mass_diagonal() const { return diagonal_of(model_, &Model::mass); }
  /// The upper triangle of k K + c C + m M; a factor of 0 leaves a matrix out.
  OwnedSum upper(double k, double c, double m) const;
  Sparse stiffness_among(const std::vector<int>& unknowns) const;
  bool distributed() const { return model_.distributed != nullptr; }

 private:
  const Model& model_;
};

/// Counts and buffers of one run beside the factors that it uses.
struct BulkWork {
  explicit BulkWork(LinearCounts& of_run) : counts(&of_run) {}
  LinearCounts* counts;
  Matrix given;  // one column
  Vector half;
};

/// What to do where the stiffnesses of a model differ so much that its soft parts are lost in the round-off of its stiff ones.
inline constexpr std::string_view too_much_contrast =
    "the stiffest and the softest part of the model differ by more than double precision resolves; make the stiffest part rigid "
    "([[rigid]], "
    "or a beam without A) or less stiff, or divide its beams into fewer elements";

/// A factored matrix of the bulk: the inverse itself when small; with the unknowns that the interfaces touch last when that is asked for
/// and the solver can.
///
/// Every factor is tried on one load, of the size sqrt(A_ii) and changing signs in every unknown. The residual |b - A x| / |b| (both with
/// the weights 1/sqrt(A_ii), so that units play no part) is about the condition number times 1e-16: above 1e-9 it is noted in the counts,
/// because results lose digits; above 1e-6, beyond the round-off of A x, the factor is wrong and refused.
///
/// It does not change after it was made: runs and threads may share it, each with work of its own.
class BulkFactor {
 public:
  /// Of a matrix that stands here the upper triangle is read. `b`: interface rows x free unknowns, whose touched unknowns shall be last;
  /// null: in any order. `why` is set (and ok() false) when the matrix is not positive definite. `like`: a factor of the same B whose
  /// symbolic analysis is used again where it has a place for every entry of the matrix; null: none.
  BulkFactor(const SymmetricSum& matrix, const Sparse* b, bool small, const LinearSolver& solver, const Model& model, LinearCounts& counts,
             const BulkFactor* like = nullptr);
  bool ok() const { return why_.empty(); }
  const std::string& why() const { return why_; }
  /// It does not fit into memory: a smaller step would not help.
  bool too_large() const { return too_large_; }
  /// x = A^-1 b
  void solve(const Vector& b, Vector& x, BulkWork& work) const {
    if (product_ != nullptr)
      product_(inverse_, b.data(), x.data());
    else
      solve_large(b, x, work);
  }
  /// The same for many columns, where the residual may be a share of the load (FactorWithReach); only where the factor has a reach.
  void solve(const Matrix& b, Matrix& x, double residual, LinearCounts& counts) const;
  /// Of the factor (FactorWithReach) [m]; 0 where the inverse is kept.
  double reach() const;
  /// A^-1 itself, so that a solve is a product.
  bool keeps_inverse() const { return small_; }
  /// How forces on the rows of B spread; through a split factor (of the same B) as its backward half, see split_spread. This factor must
  /// stay alive, and where it is. `counts`, of the back-solves that the spread takes, must stay alive too.
  Spread spread(const Sparse& b, LinearCounts& counts) const;
  /// The factor in two halves, and its last unknowns in their order; null when there is none.
  const SplitFactor* split() const { return split_.get(); }
  const std::vector<int>& last() const { return last_; }

 private:
  void solve_large(const Vector& b, Vector& x, BulkWork& work) const;
  void factorise(const SymmetricSum& matrix, const Sparse* b, const LinearSolver& solver, const Model& model, LinearCounts& counts,
                 const BulkFactor* like);
  void factorise_split(const SymmetricSum& matrix, const LinearSolver& solver, const Model& model, LinearCounts& counts,
                       const BulkFactor* like);
  void try_out(const SymmetricSum& matrix, const Model& model, LinearCounts& counts);
  void fail(const Model& model, const SymmetricSum& matrix, int unknown, const std::string& why);

  bool small_ = false, too_large_ = false;
  std::string why_;
  Matrix inverse_;
  small::Product product_ = nullptr;  // by the inverse
  Vector inverse_diagonal_;           // where the inverse is a diagonal; else empty
  std::unique_ptr<const Factor> factor_;
  std::unique_ptr<const SplitFactor> split_;
  std::vector<int> last_;
};

/// B of all interfaces, one after another: rows x free.
Sparse stack_interfaces(const Model& model);

/// The unknowns that have an entry in B.
std::vector<int> touched_unknowns(const Sparse& b);

/// Accelerations from the balance: M a = force for massive unknowns; massless ones follow K_cc a_c = -K_cr a_r.
class Accelerator {
 public:
  /// `b`: interface rows x free unknowns when impulses on them will be spread; else null.
  Accelerator(const Model& model, const Bulk& bulk, const Sparse* b, const LinearSolver& solver, LinearCounts& counts);
  void solve(const Vector& force, Vector& acceleration) const;
  /// Why M cannot be factorised; empty when it can. Accelerations are zero otherwise, and nothing spreads.
  const std::string& why() const { return mass_->why(); }
  bool too_large() const { return mass_->too_large(); }
  /// Spread through the mass matrix, for impact rules.
  Spread spread(const Sparse& b) const { return mass_->spread(b, *work_.counts); }

 private:
  const Bulk& bulk_;
  std::vector<int> massless_;
  std::unique_ptr<BulkFactor> mass_, condensed_;
  mutable BulkWork work_;  // of one run
  mutable Vector pull_, right_, solution_;
};

}  // namespace uplift
