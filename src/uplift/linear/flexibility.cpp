#include "uplift/linear/flexibility.h"

#include <Spectra/SymGEigsShiftSolver.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "uplift/math/dense.h"

namespace uplift {

namespace {

constexpr double precise = 1e-11, rough = 1e-4;  // residual of a Ritz pair; the error of mu is its square
constexpr int restarts = 300;

/// x = A^-1 M x once more: takes out what round-off has left of other shapes, and whatever a semidefinite M does not see. Then x^T M x = 1.
void purify(const Factor& a, const Sparse& mass, Matrix& shape) {
  Matrix momentum = mass * shape;
  a.solve(momentum, shape);
  for (Index i = 0; i < shape.cols(); ++i) {
    const double norm = std::sqrt(shape.col(i).dot(mass * shape.col(i)));
    Index largest = 0;
    shape.col(i).cwiseAbs().maxCoeff(&largest);
    shape.col(i) /= shape(largest, i) < 0 ? -norm : norm;
  }
}

/// y -> scale A^-1 y, without what lies along the shapes already found (Y = M X): their mu becomes zero.
class Flexibility {
 public:
  using Scalar = double;
  Flexibility(const Factor& a, const Matrix& x, const Matrix& y) : a_(a), x_(x), y_(y) {}
  double scale = 1;
  Index rows() const { return x_.rows(); }
  Index cols() const { return x_.rows(); }
  void set_shift(double) {}  // A has it
  void perform_op(const double* right, double* result) const {
    given_ = scale * ConstMap(right, rows());
    a_.solve(given_, answer_);
    if (x_.cols() > 0) answer_ -= (x_ * (y_.transpose() * answer_)).eval();
    Map(result, rows()) = answer_.col(0);
  }

 private:
  const Factor& a_;
  const Matrix &x_, &y_;
  mutable Matrix given_, answer_;  // one column
};

class Mass {
 public:
  using Scalar = double;
  explicit Mass(const Sparse& mass) : mass_(mass) {}
  Index rows() const { return mass_.rows(); }
  Index cols() const { return mass_.cols(); }
  void perform_op(const double* x, double* y) const { Map(y, rows()).noalias() = mass_.transpose() * ConstMap(x, rows()); }

 private:
  const Sparse& mass_;
};

/// One search beside the shapes found. `mass` is scaled to entries of the size of one, as the library's thresholds want it.
Flexible search(const Factor& a, const Sparse& mass, const Matrix& found, Index count, double tolerance) {
  const Index n = mass.rows(), wanted = std::min<Index>(count, n - 1);
  const Matrix momentum = mass * found;
  Flexibility flexibility(a, found, momentum);
  Mass product(mass);
  // the largest mu, roughly, becomes the unit
  Vector start = Vector::Ones(n);
  for (Index i = 0; i < n; ++i) start[i] += 0.5 * std::sin(1.618 * static_cast<double>(i + 1));  // along no symmetry
  Vector x = start, inertia(n);
  double size = 0;
  for (int k = 0; k < 4; ++k) {
    product.perform_op(x.data(), inertia.data());
    const double norm = std::sqrt(x.dot(inertia));
    if (!(norm > 0)) return {};
    inertia /= norm;
    flexibility.perform_op(inertia.data(), x.data());
    size = std::sqrt(x.dot(mass * x));
  }
  if (!(size > 0)) return {};
  flexibility.scale = 1 / size;
  const Index basis = std::min<Index>(n, std::max<Index>(2 * wanted + 10, 20));
  Spectra::SymGEigsShiftSolver<Flexibility, Mass, Spectra::GEigsMode::ShiftInvert> solver(flexibility, product, wanted, basis, 0);
  solver.init(start.data());
  const Index converged = solver.compute(Spectra::SortRule::LargestMagn, restarts, tolerance, Spectra::SortRule::SmallestAlge);
  Flexible result;
  result.mu = size * solver.eigenvalues().cwiseInverse();  // the library gives 1/mu
  result.shape = solver.eigenvectors(converged);
  return result;
}

/// Both, the largest first, at most `count`.
Flexible merge(const Flexible& a, const Flexible& b, Index count) {
  const Index size = a.mu.size() + b.mu.size(), kept = std::min(count, size);
  std::vector<Index> order(static_cast<std::size_t>(size));
  std::iota(order.begin(), order.end(), Index{0});
  const auto mu = [&](Index i) { return i < a.mu.size() ? a.mu[i] : b.mu[i - a.mu.size()]; };
  std::stable_sort(order.begin(), order.end(), [&](Index i, Index j) { return mu(i) > mu(j); });
  Flexible result{Vector(kept), Matrix(a.shape.rows(), kept)};
  for (Index k = 0; k < kept; ++k) {
    const Index i = order[static_cast<std::size_t>(k)];
    result.mu[k] = mu(i);
    if (i < a.mu.size())
      result.shape.col(k) = a.shape.col(i);
    else
      result.shape.col(k) = b.shape.col(i - a.mu.size());
  }
  return result;
}

}  // namespace

Flexible flexible_dense(const Factor& a, const Sparse& mass, const std::vector<int>& massive, Index count) {
  const Index n = mass.rows(), size = static_cast<Index>(massive.size());
  Matrix flexibility(size, size), block_mass(size, size), right, answer;
  constexpr Index block = 64;  // columns at a time
  for (Index first = 0; first < size; first += block) {
    const Index columns = std::min(block, size - first);
    right.setZero(n, columns);
    for (Index k = 0; k < columns; ++k) right(massive[static_cast<std::size_t>(first + k)], k) = 1;
    a.solve(right, answer);
    for (Index k = 0; k < columns; ++k)
      for (Index i = 0; i < size; ++i) flexibility(i, first + k) = answer(massive[static_cast<std::size_t>(i)], k);
  }
  for (Index j = 0; j < size; ++j)
    for (Index i = 0; i < size; ++i)
      block_mass(i, j) = mass.coeff(massive[static_cast<std::size_t>(i)], massive[static_cast<std::size_t>(j)]);
  const Matrix root = semidefinite_root(block_mass);
  Matrix seen = root.transpose() * flexibility * root;
  seen = ((seen + seen.transpose()) / 2).eval();
  const SymmetricEigen eigen(seen);
  const Index rank = root.cols(), found = std::min(count, rank);
  Flexible result{Vector(found), Matrix()};
  Matrix force = Matrix::Zero(n, found);
  for (Index k = 0; k < found; ++k) {
    result.mu[k] = eigen.eigenvalues()[rank - 1 - k];
    const Vector at_masses = root * eigen.eigenvectors().col(rank - 1 - k);
    for (Index i = 0; i < size; ++i) force(massive[static_cast<std::size_t>(i)], k) = at_masses[i];
  }
  a.solve(force, result.shape);
  purify(a, mass, result.shape);
  return result;
}

Flexible flexible_lanczos(const Factor& a, const Sparse& mass, Index count, bool repeated) {
  const double unit = mass.diagonal().cwiseAbs().maxCoeff();
  const Sparse scaled = mass / unit;
  Flexible found = search(a, scaled, Matrix(mass.rows(), 0), count, precise);
  for (Index pass = 0; repeated && found.mu.size() > 0 && pass < count; ++pass) {
    const double least = found.mu.size() < count ? 1e-12 * found.mu[0] : found.mu.tail<1>()[0] * (1 + 1e-9);
    const Flexible seen = search(a, scaled, found.shape, 1, rough);
    if (seen.mu.size() == 0 || !(seen.mu[0] > least)) break;
    const Flexible more = search(a, scaled, found.shape, 2, precise);
    if (more.mu.size() == 0) break;
    found = merge(found, more, count);
  }
  found.mu *= unit;
  if (found.mu.size() > 0) purify(a, mass, found.shape);
  return found;
}

}  // namespace uplift
