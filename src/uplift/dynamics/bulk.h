#pragma once
#include <memory>
#include <string>

#include "uplift/contact/compliance.h"
#include "uplift/dynamics/scheme.h"
#include "uplift/math/symmetric_pair.h"
#include "uplift/model/model.h"

// The linear bulk (soil and structure without the interfaces) during one stage: products with K, C and M, and the matrix of a step.
namespace uplift {

/// Counted by whoever owns a bulk; nothing global.
struct LinearCounts {
  long factorisations = 0, back_solves = 0;
};

/// Below this number of free unknowns matrices are dense and the inverse is kept: a step then needs no back-solve at all.
inline constexpr int small_bulk = 48;

/// A symmetric matrix of the bulk, dense when it is small.
class BulkMatrix {
 public:
  BulkMatrix() = default;
  BulkMatrix(const Sparse& matrix, bool dense);
  /// y = A x; y must have the right size.
  void multiply(const Vector& x, Vector& y) const;
  bool zero() const { return zero_; }

 private:
  bool zero_ = true, dense_ = false;
  Matrix full_;
  Sparse sparse_;
};

struct Bulk {
  Bulk(const Model& model, const Sparse* geometric);
  int unknowns = 0;
  bool small = false;
  Sparse stiffness_matrix, mass_matrix, damping_matrix;
  BulkMatrix stiffness, mass, damping;
  std::vector<char> massless;  // per free unknown
  /// ku = K u and mv = M v, in one pass where the bulk is large.
  void products(const Vector& u, const Vector& v, Vector& ku, Vector& mv) const;

 private:
  SymmetricPair pair_;  // large bulks
};

/// A factored matrix of the bulk: the inverse itself when small; with the unknowns that the interfaces touch last when that is asked for
/// and the solver can.
class BulkFactor {
 public:
  /// `b`: interface rows x free unknowns, whose touched unknowns shall be last; null: in any order. `why` is set (and ok() false) when the
  /// matrix is not positive definite.
  BulkFactor(const Sparse& matrix, const Sparse* b, bool small, const LinearSolver& solver, const Model& model, LinearCounts& counts);
  bool ok() const { return why_.empty(); }
  const std::string& why() const { return why_; }
  /// x = A^-1 b
  void solve(const Vector& b, Vector& x) const;
  Spread spread(const Sparse& b) const;
  /// The factor in two halves, and its last unknowns in their order; null when there is none.
  const SplitFactor* split() const { return split_.get(); }
  const std::vector<int>& last() const { return last_; }
  void count_back_solve() const { ++counts_->back_solves; }

 private:
  void fail(const Model& model, int unknown, const std::string& why);

  bool small_ = false;
  std::string why_;
  Matrix inverse_;
  std::unique_ptr<const Factor> factor_;
  std::unique_ptr<const SplitFactor> split_;
  std::vector<int> last_;
  LinearCounts* counts_;
  mutable Matrix given_, solved_;  // one column each, kept: a factor belongs to one run
  mutable Vector half_;
};

/// B of all interfaces, one after another: rows x free.
Sparse stack_interfaces(const Model& model);

/// Accelerations from the balance: M a = force for massive unknowns; massless ones follow K_cc a_c = -K_cr a_r.
class Accelerator {
 public:
  Accelerator(const Model& model, const Bulk& bulk, const LinearSolver& solver, LinearCounts& counts);
  void solve(const Vector& force, Vector& acceleration) const;
  bool ok() const { return mass_ == nullptr || mass_->ok(); }
  /// Spread through the mass matrix, for impact rules.
  Spread spread(const Sparse& b) const { return mass_->spread(b); }

 private:
  const Bulk& bulk_;
  std::vector<int> massless_;
  std::unique_ptr<BulkFactor> mass_, condensed_;
  mutable Vector pull_, right_, solution_;  // work space
};

}  // namespace uplift
