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
    y.noalias() = sparse_.transpose() * x;  // symmetric: by rows, which gathers instead of scattering
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
  if (!small) pair_ = SymmetricPair(stiffness_matrix, mass_matrix);
  massless.assign(static_cast<std::size_t>(unknowns), 1);
  for (int column = 0; column < mass_matrix.outerSize(); ++column)
    for (Sparse::InnerIterator entry(mass_matrix, column); entry; ++entry)
      if (entry.value() != 0) massless[static_cast<std::size_t>(column)] = 0;
}

void Bulk::products(const Vector& u, const Vector& v, Vector& ku, Vector& mv) const {
  if (!small) {
    pair_.multiply(u, v, ku, mv);
    return;
  }
  stiffness.multiply(u, ku);
  mass.multiply(v, mv);
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

/// A factor in two halves as a whole one.
class WholeOfSplit final : public Factor {
 public:
  explicit WholeOfSplit(const SplitFactor& split) : split_(split) {}
  void solve(const Matrix& b, Matrix& x) const override {
    Matrix result(b.rows(), b.cols());
    Vector column, half, solved;
    for (Index k = 0; k < b.cols(); ++k) {
      column = b.col(k);
      split_.forward(column, half);
      split_.backward(half, solved);
      result.col(k) = solved;
    }
    x = std::move(result);
  }
  double nonzeros() const override { return split_.nonzeros(); }

 private:
  const SplitFactor& split_;
};

}  // namespace

BulkFactor::BulkFactor(const Sparse& matrix, const Sparse* b, bool small, const LinearSolver& solver, const Model& model,
                       LinearCounts& counts)
    : small_(small), counts_(&counts) {
  ++counts.factorisations;
  if (!small && b != nullptr) {
    for (int column = 0; column < b->outerSize(); ++column)
      if (Sparse::InnerIterator(*b, column)) last_.push_back(column);
    if (!last_.empty()) {
      SplitFactorisation result = solver.factorise_split(matrix, last_);
      if (!result.why.empty()) {
        fail(model, result.failed_unknown, result.why);
        return;
      }
      split_ = std::move(result.factor);
    }
    if (split_ != nullptr) return;
  }
  Factorisation result = solver.factorise(matrix);
  if (result.factor == nullptr) {
    fail(model, result.failed_unknown, result.why);
    return;
  }
  factor_ = std::move(result.factor);
  if (small_) {
    factor_->solve(Matrix::Identity(matrix.rows(), matrix.cols()), inverse_);
    inverse_ = (0.5 * (inverse_ + inverse_.transpose())).eval();
  }
}

void BulkFactor::fail(const Model& model, int unknown, const std::string& why) {
  const bool named = unknown >= 0 && unknown < static_cast<int>(model.unknown_names.size());
  why_ = named ? fmt::format("the matrix is not positive definite at {}", model.unknown_names[static_cast<std::size_t>(unknown)]) : why;
}

void BulkFactor::solve(const Vector& b, Vector& x) const {
  if (small_) {
    small::multiply(inverse_, b.data(), x.data());
    return;
  }
  count_back_solve();
  if (split_ != nullptr) {
    split_->forward(b, half_);
    split_->backward(half_, x);
    return;
  }
  given_.resize(b.size(), 1);
  given_.col(0) = b;
  factor_->solve(given_, solved_);
  x = solved_.col(0);
}

Spread BulkFactor::spread(const Sparse& b) const {
  if (small_) return spread_through(InverseFactor(inverse_), b);
  if (split_ != nullptr) return spread_through(WholeOfSplit(*split_), b);
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
  mass_ = std::make_unique<BulkFactor>(bulk.mass_matrix + unit, nullptr, bulk.small, solver, model, counts);
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
  condensed_ = std::make_unique<BulkFactor>(stiffness, nullptr, count <= small_bulk, solver, model, counts);
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
