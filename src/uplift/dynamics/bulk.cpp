#include "uplift/dynamics/bulk.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "uplift/dynamics/split_response.h"
#include "uplift/linear/large.h"
#include "uplift/math/columns.h"
#include "uplift/math/upper_sum.h"
#include "uplift/model/matrix_sum.h"
#include "uplift/model/reduced.h"

namespace uplift {

namespace {

/// Of a model reduced to its modes; among few unknowns a full product is as fast.
bool is_diagonal(const Sparse& matrix) {
  if (matrix.rows() <= small_bulk || matrix.nonZeros() > matrix.rows()) return false;
  for (Index column = 0; column < matrix.outerSize(); ++column)
    for (Sparse::InnerIterator entry(matrix, column); entry; ++entry)
      if (entry.row() != entry.col()) return false;
  return true;
}

/// With rows of zeros that fill whole registers, where it is not small.
Matrix full_of(const Matrix& matrix) {
  if (matrix.rows() <= small_bulk) return matrix;
  Matrix full = Matrix::Zero(whole_registers(matrix.rows()), matrix.cols());
  full.topRows(matrix.rows()) = matrix;
  return full;
}

/// A symmetric matrix of a reduced model does not fit into the first cache.
small::Product product_of_full(const Matrix& a) {
  return a.rows() > small_bulk ? small::multiply_symmetric : small::product_of(a);
}

}  // namespace

BulkMatrix::BulkMatrix(const Sparse& matrix, bool dense)
    : zero_(matrix.nonZeros() == 0), sparse_(dense && !is_diagonal(matrix) ? nullptr : &matrix) {
  if (zero_ || sparse_ != nullptr) return;
  full_ = full_of(matrix);
  product_ = product_of_full(full_);
}

BulkMatrix::BulkMatrix(std::vector<DistributedTerm> terms, const Sparse* here)
    : zero_(terms.empty() && here == nullptr), sparse_(here), terms_(std::move(terms)) {}

void BulkMatrix::multiply_large(const Vector& x, Vector& y) const {
  if (!terms_.empty()) {
    terms_.front().matrix->multiply(terms_, x, y);
    if (sparse_ != nullptr) y.noalias() += sparse_->transpose() * x;
  } else if (zero_)
    y.setZero();
  else
    y.noalias() = sparse_->transpose() * x;  // symmetric: by rows, which gathers instead of scattering
}

namespace {

static_assert(small_bulk <= most_undistributed);

/// Stiffness with the geometric one; empty without, and where the stiffness is distributed.
Sparse second_order(const Model& model, const Sparse* geometric) {
  Sparse sum;
  if (geometric != nullptr && model.distributed == nullptr) sum = model.stiffness + *geometric;
  return sum;
}

}  // namespace

Bulk::Bulk(const Model& model, const Sparse* axial)
    : second_order_(second_order(model, axial)),
      unknowns(model.free()),
      small(model.free() <= small_bulk || is_reduced(model)),
      stiffness_matrix(axial != nullptr ? second_order_ : model.stiffness),
      mass_matrix(model.mass),
      damping_matrix(model.damping),
      geometric(axial),
      stiffness(model.distributed ? BulkMatrix(distributed_terms(model, 1, 0, 0), axial) : BulkMatrix(stiffness_matrix, small)),
      mass(model.distributed ? BulkMatrix(distributed_terms(model, 0, 0, 1), nullptr) : BulkMatrix(mass_matrix, small)),
      damping(model.distributed ? BulkMatrix(distributed_terms(model, 0, 1, 0), nullptr) : BulkMatrix(damping_matrix, small)),
      model_(model) {
  massless.assign(static_cast<std::size_t>(unknowns), 1);
  if (distributed()) {
    const Vector diagonal = mass_diagonal();
    for (int i = 0; i < unknowns; ++i) massless[static_cast<std::size_t>(i)] = diagonal[i] == 0;
    return;
  }
  for (int column = 0; column < mass_matrix.outerSize(); ++column)
    for (Sparse::InnerIterator entry(mass_matrix, column); entry; ++entry)
      if (entry.value() != 0) massless[static_cast<std::size_t>(column)] = 0;
}

Vector Bulk::damping_diagonal() const {
  return distributed() ? SymmetricSum(upper(0, 1, 0)).diagonal() : Vector(damping_matrix.diagonal());
}

Vector Bulk::stiffness_diagonal() const {
  if (!distributed()) return stiffness_matrix.diagonal();
  Vector diagonal = diagonal_of(model_, &Model::stiffness);
  if (geometric != nullptr) diagonal += Vector(geometric->diagonal());
  return diagonal;
}

OwnedSum Bulk::upper(double k, double c, double m) const {
  if (!distributed()) return {upper_sum_of(stiffness_matrix, damping_matrix, mass_matrix, k, c, m), {}};
  OwnedSum sum = matrix_sum(model_, k, c, m);
  if (geometric != nullptr) sum.here = k * geometric->triangularView<upper_triangle>();
  return sum;
}

/// K between chosen unknowns.
Sparse Bulk::stiffness_among(const std::vector<int>& chosen) const {
  std::vector<Triplet> one_each;
  for (const int unknown : chosen) one_each.emplace_back(unknown, static_cast<int>(one_each.size()), 1.0);
  Sparse choice(unknowns, std::ssize(chosen));
  choice.setFromTriplets(one_each.begin(), one_each.end());
  Sparse block = chosen_block(model_, &Model::stiffness, choice);
  if (geometric != nullptr) block += Sparse(choice.transpose() * *geometric * choice);
  return block;
}

namespace {

/// "diagonal entries reach from 1.2e+03 at top.ux to 4.1e+19 at base.uy"
std::string diagonal_range(const Vector& diagonal, const Model& model) {
  Index least = 0, most = 0;
  diagonal.minCoeff(&least);
  diagonal.maxCoeff(&most);
  return fmt::format("diagonal entries reach from {:.1e} at {} to {:.1e} at {}", diagonal[least], model.unknown_name(least), diagonal[most],
                     model.unknown_name(most));
}

/// Hands the inverse of a small matrix out as a factor, for spread_through.
class InverseFactor final : public Factor {
 public:
  explicit InverseFactor(const Matrix& inverse) : inverse_(inverse) {}
  void solve(const Matrix& b, Matrix& x) const override { x = (inverse_.topRows(inverse_.cols()) * b).eval(); }
  double nonzeros() const override { return static_cast<double>(inverse_.size()); }

 private:
  const Matrix& inverse_;
};

}  // namespace

BulkFactor::BulkFactor(const SymmetricSum& matrix, const Sparse* b, bool small, const LinearSolver& solver, const Model& model,
                       LinearCounts& counts, const BulkFactor* like)
    : small_(small) {
  ++counts.factorisations;
  factorise(matrix, b, solver, model, counts, like);
  if (ok()) try_out(matrix, model, counts);
}

void BulkFactor::factorise(const SymmetricSum& matrix, const Sparse* b, const LinearSolver& solver, const Model& model,
                           LinearCounts& counts, const BulkFactor* like) {
  if (matrix.rows() == 0) {  // every unknown is prescribed
    small_ = true;
    product_ = small::product_of(inverse_);
    return;
  }
  if (!small_ && b != nullptr) last_ = touched_unknowns(*b);
  if (!last_.empty()) factorise_split(matrix, solver, model, counts, like);
  if (split_ != nullptr || !ok()) return;
  Factorisation result;
  if (like != nullptr && like->factor_ != nullptr && !small_ && matrix.there.empty()) result = like->factor_->refactorise(matrix.here);
  if (result.factor == nullptr && result.why.empty()) {
    result = uplift::factorise(solver, matrix);
    if (!small_) ++counts.analyses;
  }
  if (!result.remark.empty()) counts.remark = result.remark;
  if (result.factor == nullptr) {
    too_large_ = result.too_large;
    fail(model, matrix, result.failed_unknown, result.why);
    return;
  }
  factor_ = std::move(result.factor);
  if (small_) {
    factor_->solve(Matrix::Identity(matrix.rows(), matrix.rows()), inverse_);
    inverse_ = full_of(0.5 * (inverse_ + inverse_.transpose()));
    if (matrix.there.empty() && is_diagonal(matrix.here))
      inverse_diagonal_ = inverse_.diagonal();
    else
      product_ = product_of_full(inverse_);
  }
}

/// Leaves no factor and no reason where the solver cannot.
void BulkFactor::factorise_split(const SymmetricSum& matrix, const LinearSolver& solver, const Model& model, LinearCounts& counts,
                                 const BulkFactor* like) {
  SplitFactorisation result;
  if (like != nullptr && like->split_ != nullptr && like->last_ == last_ && matrix.there.empty())
    result = like->split_->refactorise(matrix.here);
  if (result.factor == nullptr && result.why.empty()) {
    result = uplift::factorise_split(solver, matrix, last_);
    if (result.factor != nullptr || !result.why.empty()) ++counts.analyses;
  }
  if (!result.remark.empty()) counts.remark = result.remark;
  too_large_ = result.too_large;
  if (!result.why.empty()) return fail(model, matrix, result.failed_unknown, result.why);
  split_ = std::move(result.factor);
}

void BulkFactor::try_out(const SymmetricSum& matrix, const Model& model, LinearCounts& counts) {
  const Index n = matrix.rows();
  if (n == 0) return;
  const Vector diagonal = matrix.diagonal(), weight = diagonal.cwiseSqrt();
  Vector load(n), x(n);
  for (Index i = 0; i < n; ++i) load[i] = std::sin(1.618 * static_cast<double>(i + 1) * static_cast<double>(i + 1)) * weight[i];
  LinearCounts trial;  // not one of the run's
  BulkWork work(trial);
  solve(load, x, work);
  const double size = load.cwiseQuotient(weight).norm(),
               round_off = 64 * std::numeric_limits<double>::epsilon() * weight.cwiseProduct(x).norm();
  const double rest = (load - matrix.times(x)).cwiseQuotient(weight).norm(), residual = rest / size;
  if (!(rest <= 1e-6 * size + round_off)) {
    why_ = fmt::format("back-solves meet their equations to {:.1e} of the load only", residual);
    return;
  }
  if (residual <= counts.residual) return;
  counts.residual = residual;
  if (residual <= 1e-9) return;
  counts.notice = fmt::format("back-solves meet their equations to {:.1e} of the load only, so many digits are lost: {}", residual,
                              diagonal_range(diagonal, model));
}

/// A mechanism is refused before a run begins. What is left is a structure whose soft motions are lost in the round-off of its stiff parts.
void BulkFactor::fail(const Model& model, const SymmetricSum& matrix, int unknown, const std::string& why) {
  const bool named = unknown >= 0 && unknown < static_cast<int>(model.kept.size());
  why_ = why;
  if (!named) return;
  why_ = fmt::format("the matrix is not positive definite at {}: {}; {}", model.unknown_name(unknown),
                     diagonal_range(matrix.diagonal(), model), too_much_contrast);
}

void BulkFactor::solve_large(const Vector& b, Vector& x, BulkWork& work) const {
  if (inverse_diagonal_.size() > 0) {
    x = inverse_diagonal_.cwiseProduct(b);
    return;
  }
  ++work.counts->back_solves;
  if (split_ != nullptr) {
    split_->forward(b, work.half);
    split_->backward(work.half, x);
    return;
  }
  work.given.resize(b.size(), 1);
  work.given.col(0) = b;
  factor_->solve(work.given, work.given);
  x = work.given.col(0);
}

void BulkFactor::solve(const Matrix& b, Matrix& x, double residual, LinearCounts& counts) const {
  counts.back_solves += b.cols();
  solve_to(*factor_, b, x, residual);
}

double BulkFactor::reach() const {
  return small_ || factor_ == nullptr ? 0 : reach_of(*factor_);
}

Spread BulkFactor::spread(const Sparse& b, LinearCounts& counts) const {
  if (small_) return spread_through(InverseFactor(inverse_), b);
  if (split_ != nullptr) return split_spread(*this, b, counts);
  return spread_through(*factor_, b);
}

Sparse stack_interfaces(const Model& model) {
  std::vector<Triplet> entries;
  int first = 0;
  for (const Interface& interface : model.interfaces) {
    for (int column = 0; column < interface.b.outerSize(); ++column)
      for (Sparse::InnerIterator entry(interface.b, column); entry; ++entry)
        entries.emplace_back(first + static_cast<int>(entry.row()), static_cast<int>(entry.col()), entry.value());
    first += interface.rows();
  }
  Sparse b(first, model.free());
  b.setFromTriplets(entries.begin(), entries.end());
  return b;
}

std::vector<int> touched_unknowns(const Sparse& b) {
  std::vector<int> touched;
  for (int column = 0; column < b.outerSize(); ++column)
    if (Sparse::InnerIterator(b, column)) touched.push_back(column);
  return touched;
}

Accelerator::Accelerator(const Model& model, const Bulk& bulk, const Sparse* b, const LinearSolver& solver, LinearCounts& counts)
    : bulk_(bulk), work_(counts) {
  // A unit mass makes the factor regular and is taken out of every acceleration. Impulses would move it: a dynamic case whose interfaces
  // touch a massless unknown is refused (check_dynamic), since its velocity after an impact is not defined.
  std::vector<Triplet> diagonal;
  for (int i = 0; i < bulk.unknowns; ++i)
    if (bulk.massless[static_cast<std::size_t>(i)] != 0) {
      massless_.push_back(i);
      diagonal.emplace_back(i, i, 1.0);
    }
  Sparse unit(bulk.unknowns, bulk.unknowns);
  unit.setFromTriplets(diagonal.begin(), diagonal.end());
  OwnedSum with_unit;
  if (bulk.distributed()) {
    with_unit = bulk.upper(0, 0, 1);
    with_unit.here.swap(unit);
  } else {
    const Term terms[] = {{1, bulk.mass_matrix}, {1, unit}};
    upper_sum(terms).swap(with_unit.here);
  }
  mass_ = std::make_unique<BulkFactor>(with_unit, b, bulk.small, solver, model, counts);
  if (massless_.empty()) return;
  const Eigen::Index count = static_cast<Eigen::Index>(massless_.size());
  const Sparse stiffness = bulk.stiffness_among(massless_);
  condensed_ = std::make_unique<BulkFactor>(stiffness, nullptr, count <= small_bulk, solver, model, counts);
  if (!condensed_->ok()) condensed_.reset();
}

void Accelerator::solve(const Vector& force, Vector& acceleration) const {
  if (!mass_->ok()) {
    acceleration.setZero();
    return;
  }
  mass_->solve(force, acceleration, work_);
  for (int i : massless_) acceleration[i] = 0;
  if (condensed_ == nullptr) return;
  pull_.resize(bulk_.unknowns);
  bulk_.stiffness.multiply(acceleration, pull_);
  const Eigen::Index count = static_cast<Eigen::Index>(massless_.size());
  right_.resize(count);
  solution_.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) right_[i] = -pull_[massless_[static_cast<std::size_t>(i)]];
  condensed_->solve(right_, solution_, work_);
  for (Eigen::Index i = 0; i < count; ++i) acceleration[massless_[static_cast<std::size_t>(i)]] = solution_[i];
}

}  // namespace uplift
