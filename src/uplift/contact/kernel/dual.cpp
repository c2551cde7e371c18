#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "uplift/contact/kernel/dense.h"
#include "uplift/contact/kernel/kernel.h"

// The dual active-set method of Goldfarb & Idnani for the identity as Hessian: it starts at z = 0, the minimum without constraints, and
// adds the most violated row; multipliers stay admissible all along, so that |z| grows strictly and no set can come back: it is finite. The
// rows of the set are kept independent as C_A^T = Q R with Q orthonormal (Gram-Schmidt, done twice), R upper triangular.
namespace uplift {
namespace {

class DualSet {
 public:
  DualSet(const Rows& rows, const ConstMatrixMap& c, DualScratch& scratch) : rows_(rows), c_(c), s_(scratch) {
    const Index r = c.cols();
    if (s_.q.rows() != r || s_.opening.size() != rows.count) {
      s_.q.setZero(r, r);
      s_.triangle.setZero(r, r);
      for (Vector* v : {&s_.normal, &s_.direction, &s_.coefficients, &s_.again, &s_.change, &s_.solution, &s_.rest, &s_.part})
        v->setZero(r);
      s_.opening.setZero(rows.count);
      s_.field.setZero(rows.count);
      for (std::vector<std::ptrdiff_t>* v : {&s_.set, &s_.closed, &s_.behind}) v->reserve(static_cast<std::size_t>(rows.count));
      for (std::vector<double>* v : {&s_.signs, &s_.multipliers, &s_.weight, &s_.behind_signs, &s_.behind_multipliers})
        v->reserve(static_cast<std::size_t>(rows.count));
      s_.pressed.reserve(static_cast<std::size_t>(rows.count));
    }
    s_.z.setZero(r);
    s_.set.clear(), s_.signs.clear(), s_.multipliers.clear();
    s_.in.assign(static_cast<std::size_t>(rows.count), 0);
  }

  /// Steps until row i is satisfied. False when it cannot be.
  bool enforce(Index i) {
    const bool free_sign = !(rows_.limit[i] > 0);
    double gap = rows_.target[i] + c_.row(i).dot(s_.z);
    const double sign = free_sign && gap > 0 ? -1 : 1;  // the constraint is sign * opening >= 0
    s_.normal = sign * c_.row(i).transpose();
    const double size = s_.normal.norm();
    gap *= sign;
    double multiplier = 0;
    if (!(size > 0)) return false;
    for (;;) {
      s_.direction = s_.normal;
      orthogonalise();
      const Index k = count();
      s_.change.head(k) = s_.coefficients.head(k);  // of the multipliers of the set, per unit of the new one
      back_substitute(s_.change);
      const double slope = s_.direction.squaredNorm();
      const bool independent = std::sqrt(slope) > 1e-10 * size && k < c_.cols();
      double full = std::numeric_limits<double>::infinity(), partial = full;
      if (independent) full = -gap / slope;
      std::size_t leaving = s_.set.size();
      for (std::size_t j = 0; j < s_.set.size(); ++j) {
        const double rate = s_.change[static_cast<Index>(j)];
        if (!(rows_.limit[s_.set[j]] > 0) || !(rate > 1e-14)) continue;
        const double length = s_.multipliers[j] / rate;
        if (length < partial) partial = length, leaving = j;
      }
      const double length = std::min(full, partial);
      if (!std::isfinite(length)) return false;
      if (independent) {
        s_.z += length * s_.direction;
        gap += length * slope;
      }
      for (std::size_t j = 0; j < s_.set.size(); ++j) s_.multipliers[j] -= length * s_.change[static_cast<Index>(j)];
      multiplier += length;
      ++steps_;
      if (full <= partial) {
        append(i, sign, multiplier);
        return true;
      }
      remove(leaving);
    }
  }

  /// z and multipliers again from the set alone, free of accumulated round-off. `force` receives the multipliers as p (tension > 0).
  void finish(double* force) {
    const Index k = count();
    std::fill_n(force, rows_.count, 0.0);
    s_.z.setZero();
    for (Index j = 0; j < k; ++j) {  // R^T a = -target
      const std::size_t s = static_cast<std::size_t>(j);
      const double known = s_.triangle.col(j).head(j).dot(s_.part.head(j));
      s_.part[j] = (-s_.signs[s] * rows_.target[s_.set[s]] - known) / s_.triangle(j, j);
      s_.z += s_.part[j] * s_.q.col(j);
    }
    back_substitute(s_.part);
    for (Index j = 0; j < k; ++j) {
      const std::size_t s = static_cast<std::size_t>(j);
      force[s_.set[s]] = rows_.limit[s_.set[s]] > 0 ? -std::max(0.0, s_.part[j]) : -s_.signs[s] * s_.part[j];
    }
  }

  bool contains(Index i) const { return s_.in[static_cast<std::size_t>(i)] != 0; }
  int steps() const { return steps_; }

 private:
  Index count() const { return static_cast<Index>(s_.set.size()); }
  /// Takes the part in the range of Q out of the direction and keeps its coefficients.
  void orthogonalise() {
    const Index k = count();
    auto first = s_.coefficients.head(k), second = s_.again.head(k);
    const auto q = s_.q.leftCols(k);
    first.noalias() = q.transpose() * s_.direction;
    s_.direction.noalias() -= q * first;
    second.noalias() = q.transpose() * s_.direction;
    s_.direction.noalias() -= q * second;
    first += second;
  }
  void back_substitute(Vector& x) const {
    for (Index j = count(); j-- > 0;) {
      x[j] /= s_.triangle(j, j);
      for (Index i = 0; i < j; ++i) x[i] -= s_.triangle(i, j) * x[j];
    }
  }
  /// The direction and its coefficients become the last column of Q R.
  void append(Index i, double sign, double multiplier) {
    const Index k = count();
    const double size = s_.direction.norm();
    s_.q.col(k) = s_.direction / size;
    s_.triangle.col(k).head(k) = s_.coefficients.head(k);
    s_.triangle(k, k) = size;
    s_.set.push_back(i), s_.signs.push_back(sign), s_.multipliers.push_back(multiplier);
    s_.in[static_cast<std::size_t>(i)] = 1;
  }
  /// Those behind the leaving row are appended again.
  void remove(std::size_t leaving) {
    s_.in[static_cast<std::size_t>(s_.set[leaving])] = 0;
    s_.behind.assign(s_.set.begin() + static_cast<std::ptrdiff_t>(leaving) + 1, s_.set.end());
    s_.behind_signs.assign(s_.signs.begin() + static_cast<std::ptrdiff_t>(leaving) + 1, s_.signs.end());
    s_.behind_multipliers.assign(s_.multipliers.begin() + static_cast<std::ptrdiff_t>(leaving) + 1, s_.multipliers.end());
    s_.set.resize(leaving), s_.signs.resize(leaving), s_.multipliers.resize(leaving);
    for (std::size_t k = 0; k < s_.behind.size(); ++k) {
      s_.direction = s_.behind_signs[k] * c_.row(s_.behind[k]).transpose();
      orthogonalise();
      append(s_.behind[k], s_.behind_signs[k], s_.behind_multipliers[k]);
    }
  }

  const Rows& rows_;
  const ConstMatrixMap& c_;
  DualScratch& s_;
  int steps_ = 0;
};

/// Least-norm forces on the closed rows for the z that is known: p = weight * min(0, C y), C^T p = -z, by Newton on the dual, a convex
/// piecewise quadratic function of y. False when it does not settle: the forces that were there remain.
bool least_norm_forces(const Rows& rows, const ConstMatrixMap& c, double gap, double* held, double* force, KernelScratch& scratch) {
  const Index n = rows.count;
  DualScratch& s = scratch.dual;
  const Vector& z = s.z;
  std::vector<std::ptrdiff_t>& closed = s.closed;
  std::vector<double>& weight = s.weight;
  std::vector<char>& pressed = s.pressed;
  closed.clear(), weight.clear();
  for (Index i = 0; i < n; ++i) {
    const bool fixed = rows.fixed != nullptr && !(rows.limit[i] > 0) && rows.fixed[i] > 0;
    if (fixed || (rows.limit[i] > 0 && std::abs(s.opening[i]) <= gap)) {
      closed.push_back(i);
      weight.push_back(fixed ? rows.fixed[i] : rows.limit[i]);
    }
  }
  pressed.assign(closed.size(), 1);
  const Index count = static_cast<Index>(closed.size());
  HeldRows& solver = scratch.closed_rows;
  solver.size(n, c.cols());
  if (scratch.multiplier.size() < n) scratch.multiplier.setZero(n);
  Vector &q = scratch.multiplier, &y = s.solution, &field = s.field, &rest = s.rest;
  for (int iteration = 0; iteration < 60; ++iteration) {
    for (std::size_t k = 0; k < closed.size(); ++k)
      solver.transposed().col(static_cast<Index>(k)) = (pressed[k] != 0 ? std::sqrt(weight[k]) : 0.0) * c.row(closed[k]).transpose();
    solver.compute(count);
    solver.multipliers(z, q);
    rest = z;
    rest.noalias() += solver.transposed().leftCols(count) * q.head(count);
    const double error = rest.norm();
    solver.least_norm(q, y);
    double largest = 0;
    for (std::size_t k = 0; k < closed.size(); ++k) {
      const Index row = static_cast<Index>(k);
      field[row] = pressed[k] != 0 ? q[row] / std::sqrt(weight[k]) : c.row(closed[k]).dot(y);
      if (pressed[k] != 0) largest = std::max(largest, std::abs(field[row]));
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

KernelReply dual_active_set(const Rows& rows, double* held, double* z, double* opening_out, double* force, KernelScratch& scratch) {
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
  DualSet set(rows, c, scratch.dual);
  const Vector& solution = scratch.dual.z;
  Vector& opening = scratch.dual.opening;
  if (scratch.step.size() != rows.columns) scratch.step.setZero(rows.columns);
  for (Index i = 0; rows.fixed != nullptr && i < n; ++i) {
    if (rows.limit[i] > 0 || !(rows.fixed[i] > 0) || std::abs(target[i] + c.row(i).dot(solution)) <= gap) continue;
    if (set.enforce(i)) continue;
    reply.end = KernelEnd::inconsistent;
    reply.worst = i;
    return reply;
  }
  const int most = 100 + 20 * static_cast<int>(n + rows.columns);
  while (set.steps() < most) {
    opening = target;
    opening.noalias() += c * solution;
    Index worst = -1;
    double depth = gap;
    for (Index i = 0; i < n; ++i)
      if (rows.limit[i] > 0 && -opening[i] > depth && !set.contains(i)) depth = -opening[i], worst = i;
    if (worst < 0) {
      set.finish(force);
      opening = target;
      opening.noalias() += c * solution;
      for (Index i = 0; i < n; ++i) held[i] = force[i] != 0 ? (rows.limit[i] > 0 ? rows.limit[i] : rows.fixed[i]) : 0;
      if (rows.fixed != nullptr)
        for (Index i = 0; i < n; ++i)
          if (!(rows.limit[i] > 0)) held[i] = rows.fixed[i];
      least_norm_forces(rows, c, gap, held, force, scratch);
      std::copy_n(solution.data(), rows.columns, z);
      std::copy_n(opening.data(), n, opening_out);
      reply.end = KernelEnd::solved;
      reply.residual = kernel_residual(c, solution, force, held, opening, rows.target, scratch.step);
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
