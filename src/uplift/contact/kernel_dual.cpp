#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "uplift/contact/kernel.h"
#include "uplift/contact/kernel_dense.h"

// The dual active-set method of Goldfarb & Idnani for the identity as Hessian: it starts at z = 0, the minimum without constraints, and
// adds the most violated row; multipliers stay admissible all along, so that |z| grows strictly and no set can come back: it is finite. The
// rows of the set are kept independent as C_A^T = Q R with Q orthonormal (Gram-Schmidt, done twice), R upper triangular.
namespace uplift {
namespace {

class DualSet {
 public:
  DualSet(const Rows& rows, const ConstMatrixMap& c)
      : rows_(rows), c_(c), target_(rows.target, rows.count), q_(c.cols(), 0), z_(Vector::Zero(c.cols())) {
    in_.assign(static_cast<std::size_t>(rows.count), 0);
  }

  /// Steps until row i is satisfied. False when it cannot be.
  bool enforce(Index i) {
    const bool free_sign = !(rows_.limit[i] > 0);
    double gap = target_[i] + c_.row(i).dot(z_);
    const double sign = free_sign && gap > 0 ? -1 : 1;  // the constraint is sign * opening >= 0
    const Vector normal = sign * c_.row(i).transpose();
    const double size = normal.norm();
    gap *= sign;
    double multiplier = 0;
    if (!(size > 0)) return false;
    for (;;) {
      Vector direction = normal;
      const Vector coefficients = orthogonalise(direction);
      const Vector change = triangular(coefficients);  // of the multipliers of the set, per unit of the new one
      const double slope = direction.squaredNorm();
      const bool independent = std::sqrt(slope) > 1e-10 * size;
      double full = std::numeric_limits<double>::infinity(), partial = full;
      if (independent) full = -gap / slope;
      std::size_t leaving = set_.size();
      for (std::size_t k = 0; k < set_.size(); ++k) {
        const double rate = change[static_cast<Index>(k)];
        if (!(rows_.limit[set_[k]] > 0) || !(rate > 1e-14)) continue;
        const double length = multipliers_[k] / rate;
        if (length < partial) partial = length, leaving = k;
      }
      const double length = std::min(full, partial);
      if (!std::isfinite(length)) return false;
      if (independent) {
        z_ += length * direction;
        gap += length * slope;
      }
      for (std::size_t k = 0; k < set_.size(); ++k) multipliers_[k] -= length * change[static_cast<Index>(k)];
      multiplier += length;
      ++steps_;
      if (full <= partial) {
        append(i, sign, direction, coefficients, multiplier);
        return true;
      }
      remove(leaving);
    }
  }

  /// z and multipliers again from the set alone, free of accumulated round-off. `force` receives the multipliers as p (tension > 0).
  void finish(double* force) {
    const Index k = static_cast<Index>(set_.size());
    std::fill_n(force, rows_.count, 0.0);
    if (k == 0) {
      z_.setZero();
      return;
    }
    Vector right(k);
    for (Index j = 0; j < k; ++j) right[j] = -signs_[static_cast<std::size_t>(j)] * target_[set_[static_cast<std::size_t>(j)]];
    const auto upper = r_.topLeftCorner(k, k).triangularView<upper_triangle>();
    const Vector a = upper.transpose().solve(right);
    z_ = q_.leftCols(k) * a;
    const Vector multipliers = upper.solve(a);
    for (Index j = 0; j < k; ++j) {
      const std::size_t s = static_cast<std::size_t>(j);
      force[set_[s]] = rows_.limit[set_[s]] > 0 ? -std::max(0.0, multipliers[j]) : -signs_[s] * multipliers[j];
    }
  }

  const Vector& z() const { return z_; }
  bool contains(Index i) const { return in_[static_cast<std::size_t>(i)] != 0; }
  int steps() const { return steps_; }

 private:
  /// Takes the part in the range of Q out of v, returns the coefficients.
  Vector orthogonalise(Vector& v) const {
    const Index k = static_cast<Index>(set_.size());
    Vector coefficients = q_.leftCols(k).transpose() * v;
    v -= q_.leftCols(k) * coefficients;
    const Vector again = q_.leftCols(k).transpose() * v;
    v -= q_.leftCols(k) * again;
    return coefficients + again;
  }
  Vector triangular(const Vector& b) const {
    if (b.size() == 0) return b;
    return r_.topLeftCorner(b.size(), b.size()).triangularView<upper_triangle>().solve(b);
  }
  void append(Index i, double sign, const Vector& direction, const Vector& coefficients, double multiplier) {
    const Index k = static_cast<Index>(set_.size());
    const double size = direction.norm();
    q_.conservativeResize(c_.cols(), k + 1);
    r_.conservativeResize(k + 1, k + 1);
    q_.col(k) = direction / size;
    r_.row(k).setZero();
    r_.col(k).head(k) = coefficients;
    r_(k, k) = size;
    set_.push_back(i), signs_.push_back(sign), multipliers_.push_back(multiplier);
    in_[static_cast<std::size_t>(i)] = 1;
  }
  void remove(std::size_t leaving) {
    const std::vector<Index> set = set_;
    const std::vector<double> signs = signs_, multipliers = multipliers_;
    in_[static_cast<std::size_t>(set[leaving])] = 0;
    set_.clear(), signs_.clear(), multipliers_.clear();
    for (std::size_t k = 0; k < set.size(); ++k) {
      if (k == leaving) continue;
      Vector direction = signs[k] * c_.row(set[k]).transpose();
      const Vector coefficients = orthogonalise(direction);
      append(set[k], signs[k], direction, coefficients, multipliers[k]);
    }
  }

  const Rows& rows_;
  const ConstMatrixMap& c_;
  ConstMap target_;
  Matrix q_, r_;
  Vector z_;
  std::vector<Index> set_;
  std::vector<double> signs_, multipliers_;
  std::vector<char> in_;
  int steps_ = 0;
};

/// Least-norm forces on the closed rows for the z that is known: p = weight * min(0, C y), C^T p = -z, by Newton on the dual, a convex
/// piecewise quadratic function of y. False when it does not settle: the forces that were there remain.
bool least_norm_forces(const Rows& rows, const ConstMatrixMap& c, const Vector& z, const Vector& opening, double gap, double* held,
                       double* force) {
  const Index n = rows.count;
  std::vector<Index> closed;
  std::vector<double> weight;
  for (Index i = 0; i < n; ++i) {
    const bool fixed = rows.fixed != nullptr && !(rows.limit[i] > 0) && rows.fixed[i] > 0;
    if (fixed || (rows.limit[i] > 0 && std::abs(opening[i]) <= gap)) {
      closed.push_back(i);
      weight.push_back(fixed ? rows.fixed[i] : rows.limit[i]);
    }
  }
  std::vector<char> pressed(closed.size(), 1);
  for (int iteration = 0; iteration < 60; ++iteration) {
    Matrix a = Matrix::Zero(static_cast<Index>(closed.size()), c.cols());
    for (std::size_t k = 0; k < closed.size(); ++k)
      if (pressed[k] != 0) a.row(static_cast<Index>(k)) = std::sqrt(weight[k]) * c.row(closed[k]);
    const HeldRows solver(a);
    const Vector q = solver.multipliers(z);
    const double error = (a.transpose() * q + z).norm();
    const Vector y = solver.least_norm(q);
    double largest = 0;
    Vector field(static_cast<Index>(closed.size()));
    for (std::size_t k = 0; k < closed.size(); ++k) {
      const Index s = static_cast<Index>(k);
      field[s] = pressed[k] != 0 ? q[s] / std::sqrt(weight[k]) : c.row(closed[k]).dot(y);
      if (pressed[k] != 0) largest = std::max(largest, std::abs(field[s]));
    }
    bool changed = false;
    for (std::size_t k = 0; k < closed.size(); ++k) {
      if (!(rows.limit[closed[k]] > 0)) continue;
      const double value = field[static_cast<Index>(k)];
      const char now = pressed[k] != 0 ? value <= 1e-12 * largest : value < -1e-12 * largest;
      changed = changed || now != pressed[k];
      pressed[k] = now;
    }
    if (changed) continue;
    if (!(error <= 1e-11 * z.norm())) return false;
    std::fill_n(force, n, 0.0);
    for (std::size_t k = 0; k < closed.size(); ++k) {
      const Index i = closed[k];
      held[i] = pressed[k] != 0 ? weight[k] : 0;
      const double value = held[i] * field[static_cast<Index>(k)];
      force[i] = rows.limit[i] > 0 ? std::min(0.0, value) : value;
    }
    return true;
  }
  return false;
}

}  // namespace

KernelReply dual_active_set(const Rows& rows, double* held, double* z, double* opening_out, double* force, KernelScratch&) {
  const Index n = rows.count;
  const ConstMatrixMap c(rows.factor, n, rows.columns, ColumnStride(rows.stride));
  const ConstMap target(rows.target, n);
  KernelReply reply;
  reply.exact = true;
  if (!target.allFinite() || !c.allFinite()) {
    reply.end = KernelEnd::not_finite;
    return reply;
  }
  const double gap = n > 0 ? std::max(rows.tolerance, rows.relative * target.norm()) : rows.tolerance;
  DualSet set(rows, c);
  for (Index i = 0; rows.fixed != nullptr && i < n; ++i) {
    if (rows.limit[i] > 0 || !(rows.fixed[i] > 0) || std::abs(target[i] + c.row(i).dot(set.z())) <= gap) continue;
    if (set.enforce(i)) continue;
    reply.end = KernelEnd::inconsistent;
    reply.worst = i;
    return reply;
  }
  const int most = 100 + 20 * static_cast<int>(n + rows.columns);
  Vector opening;
  while (set.steps() < most) {
    opening = target + c * set.z();
    Index worst = -1;
    double depth = gap;
    for (Index i = 0; i < n; ++i)
      if (rows.limit[i] > 0 && -opening[i] > depth && !set.contains(i)) depth = -opening[i], worst = i;
    if (worst < 0) {
      set.finish(force);
      opening = target + c * set.z();
      for (Index i = 0; i < n; ++i) held[i] = force[i] != 0 ? (rows.limit[i] > 0 ? rows.limit[i] : rows.fixed[i]) : 0;
      if (rows.fixed != nullptr)
        for (Index i = 0; i < n; ++i)
          if (!(rows.limit[i] > 0)) held[i] = rows.fixed[i];
      least_norm_forces(rows, c, set.z(), opening, gap, held, force);
      std::copy_n(set.z().data(), rows.columns, z);
      std::copy_n(opening.data(), n, opening_out);
      reply.end = KernelEnd::solved;
      reply.residual = kernel_residual(c, set.z(), force, held, opening, rows.target);
      reply.iterations = set.steps();
      return reply;
    }
    if (set.enforce(worst)) continue;
    reply.end = KernelEnd::inconsistent;
    reply.worst = worst;
    reply.iterations = set.steps();
    return reply;
  }
  reply.iterations = set.steps();
  return reply;
}

}  // namespace uplift
