#pragma once
#include <memory>
#include <string>

#include "uplift/contact/compliance.h"
#include "uplift/dynamics/scheme.h"
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
};

/// A factored matrix of the bulk: the inverse itself when small.
class BulkFactor {
 public:
  /// `why` is set (and ok() false) when the matrix is not positive definite; `unknown` names where.
  BulkFactor(const Sparse& matrix, bool small, const LinearSolver& solver, const Model& model, LinearCounts& counts);
  bool ok() const { return why_.empty(); }
  const std::string& why() const { return why_; }
  /// x = A^-1 b
  void solve(const Vector& b, Vector& x) const;
  Spread spread(const Sparse& b) const;
  bool inverse_kept() const { return small_; }

 private:
  bool small_ = false;
  std::string why_;
  Matrix inverse_;
  std::unique_ptr<const Factor> factor_;
  LinearCounts* counts_;
  mutable Matrix given_, solved_;  // one column each, kept: a factor belongs to one run
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
