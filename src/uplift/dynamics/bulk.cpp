#include "uplift/dynamics/bulk.h"

#include <fmt/format.h>

#include "uplift/math/small.h"

namespace uplift {

BulkMatrix::BulkMatrix(const Sparse& matrix, bool dense) : zero_(matrix.nonZeros() == 0), dense_(dense) {
  if (dense)
    full_ = Matrix(matrix);
  else
    sparse_ = matrix;
}

void BulkMatrix::multiply(const Vector& x, Vector& y) const {
  if (zero_)
    y.setZero();
  else if (dense_)
    small::multiply(full_, x.data(), y.data());
  else
    y.noalias() = sparse_ * x;
}

Bulk::Bulk(const Model& model, const Sparse* geometric)
    : unknowns(model.free()),
      small(model.free() <= small_bulk),
      stiffness_matrix(model.stiffness),
      mass_matrix(model.mass),
      damping_matrix(model.damping) {
  if (geometric != nullptr) stiffness_matrix += *geometric;
  stiffness = BulkMatrix(stiffness_matrix, small);
  mass = BulkMatrix(mass_matrix, small);
  damping = BulkMatrix(damping_matrix, small);
  massless.assign(static_cast<std::size_t>(unknowns), 1);
  for (int column = 0; column < mass_matrix.outerSize(); ++column)
    for (Sparse::InnerIterator entry(mass_matrix, column); entry; ++entry)
      if (entry.value() != 0) massless[static_cast<std::size_t>(column)] = 0;
}

namespace {

/// Hands the inverse of a small matrix out as a factor, for spread_through.
class InverseFactor final : public Factor {
 public:
  explicit InverseFactor(const Matrix& inverse) : inverse_(inverse) {}
  void solve(const Matrix& b, Matrix& x) const override { x = (inverse_ * b).eval(); }
  double nonzeros() const override { return static_cast<double>(inverse_.size()); }

 private:
  const Matrix& inverse_;
};

}  // namespace

BulkFactor::BulkFactor(const Sparse& matrix, bool small, const LinearSolver& solver, const Model& model, LinearCounts& counts)
    : small_(small), counts_(&counts) {
  Factorisation result = solver.factorise(matrix);
  ++counts.factorisations;
  if (result.factor == nullptr) {
    const bool named = result.failed_unknown >= 0 && result.failed_unknown < static_cast<int>(model.unknown_names.size());
    why_ = named ? fmt::format("the matrix is not positive definite at {}",
                               model.unknown_names[static_cast<std::size_t>(result.failed_unknown)])
                 : "the matrix is not positive definite";
    return;
  }
  factor_ = std::move(result.factor);
  if (small_) {
    factor_->solve(Matrix::Identity(matrix.rows(), matrix.cols()), inverse_);
    inverse_ = (0.5 * (inverse_ + inverse_.transpose())).eval();
  }
}

void BulkFactor::solve(const Vector& b, Vector& x) const {
  if (small_) {
    small::multiply(inverse_, b.data(), x.data());
    return;
  }
  ++counts_->back_solves;
  given_.resize(b.size(), 1);
  given_.col(0) = b;
  factor_->solve(given_, solved_);
  x = solved_.col(0);
}

Spread BulkFactor::spread(const Sparse& b) const {
  if (small_) return spread_through(InverseFactor(inverse_), b);
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

Accelerator::Accelerator(const Model& model, const Bulk& bulk, const LinearSolver& solver, LinearCounts& counts) : bulk_(bulk) {
  std::vector<Triplet> diagonal;
  for (int i = 0; i < bulk.unknowns; ++i)
    if (bulk.massless[static_cast<std::size_t>(i)] != 0) {
      massless_.push_back(i);
      diagonal.emplace_back(i, i, 1.0);
    }
  Sparse unit(bulk.unknowns, bulk.unknowns);
  unit.setFromTriplets(diagonal.begin(), diagonal.end());
  mass_ = std::make_unique<BulkFactor>(bulk.mass_matrix + unit, bulk.small, solver, model, counts);
  if (massless_.empty()) return;
  const Eigen::Index count = static_cast<Eigen::Index>(massless_.size());
  std::vector<int> place(static_cast<std::size_t>(bulk.unknowns), -1);
  for (Eigen::Index i = 0; i < count; ++i) place[static_cast<std::size_t>(massless_[static_cast<std::size_t>(i)])] = static_cast<int>(i);
  std::vector<Triplet> block;
  for (int column = 0; column < bulk.stiffness_matrix.outerSize(); ++column)
    for (Sparse::InnerIterator entry(bulk.stiffness_matrix, column); entry; ++entry) {
      const int row = place[static_cast<std::size_t>(entry.row())], col = place[static_cast<std::size_t>(entry.col())];
      if (row >= 0 && col >= 0) block.emplace_back(row, col, entry.value());
    }
  Sparse stiffness(count, count);
  stiffness.setFromTriplets(block.begin(), block.end());
  condensed_ = std::make_unique<BulkFactor>(stiffness, count <= small_bulk, solver, model, counts);
  if (!condensed_->ok()) condensed_.reset();
}

void Accelerator::solve(const Vector& force, Vector& acceleration) const {
  mass_->solve(force, acceleration);
  for (int i : massless_) acceleration[i] = 0;
  if (condensed_ == nullptr) return;
  pull_.resize(bulk_.unknowns);
  bulk_.stiffness.multiply(acceleration, pull_);
  const Eigen::Index count = static_cast<Eigen::Index>(massless_.size());
  right_.resize(count);
  solution_.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) right_[i] = -pull_[massless_[static_cast<std::size_t>(i)]];
  condensed_->solve(right_, solution_);
  for (Eigen::Index i = 0; i < count; ++i) acceleration[massless_[static_cast<std::size_t>(i)]] = solution_[i];
}

}  // namespace uplift
