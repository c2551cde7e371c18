#include "uplift/contact/lagrange/force_share.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "uplift/contact/point_rows.h"
#include "uplift/math/dense.h"
#include "uplift/math/line_search.h"
#include "uplift/math/small.h"

namespace uplift {
namespace {

/// sqrt(a^2 + b^2) of numbers that are neither huge nor tiny.
double root_of_squares(double a, double b) {
  return std::sqrt(a * a + b * b);
}

}  // namespace

void ForceShare::size(Index rows, Index r) {
  if (given_.rows() == rows && given_.cols() == r) return;
  given_.setZero(rows, r);
  range_ = Orthonormal();
  range_.size(rows, r);
  const Index least = std::min(rows, r);
  rows_.setZero(least, rows);
  hessian_.setZero(least, least);
  for (Vector* v : {&found_, &more_, &kept_}) v->setZero(rows);
  for (Vector* v : {&rest_, &pull_}) v->setZero(r);
  for (Vector* v : {&resultant_, &dual_, &step_, &tried_, &gradient_, &column_}) v->setZero(least);
  points_.reserve(static_cast<std::size_t>(rows));
}

/// Adds a row of C, times `factor`, to the row of given_ that comes next.
void ForceShare::add_given(Index row, double factor, const Matrix& factors) {
  for (Index k = 0; k < factors.cols(); ++k) given_(columns_, k) += factor * factors(row, k);
}

/// The closed points, with their forces. Held points may be off by the gap in each direction, and by 1e-8 of the motion for the contact
/// residual: less than that is no slip.
void ForceShare::list(const InterfaceProblem& problem, double gap, const InterfaceSolution& solution) {
  constexpr double near = 1e-8, round_off = 8 * std::numeric_limits<double>::epsilon();
  const double still = std::max({2 * gap, round_off * solution.opening.cwiseAbs().maxCoeff(),
                                 near * (solution.opening - problem.free_opening).cwiseAbs().maxCoeff()});
  columns_ = 0;
  points_.clear();
  given_.setZero();
  rest_.setZero();
  for (const Block& block : problem.model->blocks) {
    if (block.cone == nullptr) continue;
    const int n = block.batch.points, tangents = block.batch.components - 1;
    for (int i = 0; i < n; ++i) {
      Point point;
      point.first = block.first + i, point.stride = n, point.components = tangents + 1;
      const Index normal = point.first + tangents * n;
      if (!(solution.force[normal] < 0) && !(solution.opening[normal] <= gap)) continue;
      point.column = columns_;
      point.root = std::sqrt(block.area[i]);
      point.friction = tangents > 0 ? block.cone->friction() : 0;
      double slip = 0;
      for (int c = 0; c < tangents; ++c) slip = std::hypot(slip, solution.opening[point.first + c * n] - problem.from[point.first + c * n]);
      point.slides = !(point.friction > 0) || slip > still;
      if (point.slides) {
        add_slide(problem, solution, point);
      } else {
        for (int c = 0; c <= tangents; ++c) {
          add_given(point.first + c * n, point.root, problem.model->factor);
          found_[columns_++] = solution.force[point.first + c * n] / point.root;
        }
      }
      points_.push_back(point);
    }
  }
}

/// The ray has the direction of the friction force or, where there is none, of the slip. What of the force is off the ray goes to rest_.
void ForceShare::add_slide(const InterfaceProblem& problem, const InterfaceSolution& solution, Point& point) {
  const Matrix& factor = problem.model->factor;
  const std::size_t normal = static_cast<std::size_t>(point.components - 1);
  const double unit = 1 / std::hypot(1, point.friction);
  std::array<double, 3> force{}, slip{};
  for (std::size_t c = 0; c <= normal; ++c) {
    const Index row = point.first + static_cast<Index>(c) * point.stride;
    force[c] = solution.force[row], slip[c] = solution.opening[row] - problem.from[row];
  }
  const double pressure = std::max(0.0, -force[normal]);
  const std::array<double, 3>& along = pressure > 0 && std::hypot(force[0], normal > 1 ? force[1] : 0) > 0 ? force : slip;
  const double length = normal == 0 ? 0 : std::hypot(along[0], normal > 1 ? along[1] : 0);
  for (std::size_t c = 0; c < normal; ++c) point.ray[c] = length > 0 ? unit * point.friction * along[c] / length : 0;
  point.ray[normal] = -unit;
  for (std::size_t c = 0; c <= normal; ++c) {
    const Index row = point.first + static_cast<Index>(c) * point.stride;
    add_given(row, point.root * point.ray[c], factor);
    const double off = force[c] - point.ray[c] * pressure / unit;
    for (Index k = 0; k < factor.cols(); ++k) rest_[k] += off * factor(row, k);
  }
  found_[columns_++] = pressure / (unit * point.root);
}

/// In the coordinates of range_: the resultant C^T p of the forces on entry. False where the rows in use do not span it.
bool ForceShare::find_resultant() {
  constexpr double round_off = 1e-14, enough = 1e-11;
  rows_.topLeftCorner(rank_, columns_) = range_.basis().topLeftCorner(columns_, rank_).transpose();
  pull_ = rest_;
  pull_.noalias() += given_.topRows(columns_).transpose() * found_.head(columns_);
  const double size = pull_.norm();
  if (rest_.norm() > round_off * size) {
    range_.solve_transposed(rest_, more_);
    found_.head(columns_) += more_.head(columns_);
    pull_.noalias() -= given_.topRows(columns_).transpose() * found_.head(columns_);
    if (!(pull_.norm() <= enough * size)) return false;
  }
  resultant_.setZero();
  for (Index k = 0; k < columns_; ++k) small::add(rank_, found_[k], rows_.col(k).data(), resultant_.data());
  return true;
}

/// The forces that belong to the dual, and gradient_ = their resultant - that found. Returns its length.
double ForceShare::evaluate(const Vector& dual) {
  const Index r = rows_.rows();
  gradient_ = -resultant_;
  small::with_size(rank_, [&](auto size) {
    for (Point& point : points_) {
      const double* column = rows_.data() + point.column * r;
      const int count = point.slides ? 1 : point.components;
      for (int c = 0; c < count; ++c) point.pressed[static_cast<std::size_t>(c)] = small::dot(size, column + c * r, dual.data());
      if (point.slides) {
        point.force[0] = std::max(0.0, point.pressed[0]);
      } else {
        const std::size_t normal = static_cast<std::size_t>(count - 1);
        const double along = count == 3 ? root_of_squares(point.pressed[0], point.pressed[1]) : std::abs(point.pressed[0]),
                     mu = point.friction;
        const double pressure = -point.pressed[normal], bound = (pressure + mu * along) / (1 + mu * mu);
        point.force = point.pressed;
        if (!(bound > 0)) {
          point.force = {};
        } else if (along > mu * pressure) {
          for (std::size_t c = 0; c < normal; ++c) point.force[c] *= mu * bound / along;
          point.force[normal] = -bound;
        }
      }
      for (int c = 0; c < count; ++c) small::add(size, point.force[static_cast<std::size_t>(c)], column + c * r, gradient_.data());
    }
  });
  return gradient_.norm();
}

void ForceShare::add_outer(double weight, const double* column) {
  small::with_size(rank_, [&](auto size) {
    for (std::ptrdiff_t k = 0; k < size; ++k) small::add(size, weight * column[k], column, hessian_.col(k).data());
  });
}

/// A generalised derivative of the gradient at the dual that was evaluated last, plus a share of the identity.
void ForceShare::fill_hessian(double share) {
  const Index r = rows_.rows();
  for (Index k = 0; k < rank_; ++k) {
    std::fill_n(hessian_.col(k).data(), rank_, 0.0);
    hessian_(k, k) = share;
  }
  for (const Point& point : points_) {
    const double* column = rows_.data() + point.column * r;
    if (point.slides) {
      if (point.pressed[0] > 0) add_outer(1, column);
      continue;
    }
    const int tangents = point.components - 1;
    const std::size_t normal = static_cast<std::size_t>(tangents);
    const double along = tangents == 2 ? root_of_squares(point.pressed[0], point.pressed[1]) : std::abs(point.pressed[0]),
                 mu = point.friction;
    const double pressure = -point.pressed[normal];
    if (!(pressure + mu * along > 0)) continue;
    if (!(along > mu * pressure)) {
      for (int c = 0; c <= tangents; ++c) add_outer(1, column + c * r);
      continue;
    }
    const double unit = 1 / std::hypot(1, mu);
    const double cosine = point.pressed[0] / along, sine = tangents == 2 ? point.pressed[1] / along : 0;
    column_.setZero();
    small::add(rank_, mu * unit * cosine, column, column_.data());
    if (tangents == 2) small::add(rank_, mu * unit * sine, column + r, column_.data());
    small::add(rank_, -unit, column + tangents * r, column_.data());
    add_outer(1, column_.data());
    if (tangents < 2) continue;
    column_.setZero();
    small::add(rank_, -sine, column, column_.data());
    small::add(rank_, cosine, column + r, column_.data());
    add_outer(mu * (pressure + mu * along) / ((1 + mu * mu) * along), column_.data());
  }
}

/// Newton's. The factor takes the place of the Hessian.
bool ForceShare::find_step() {
  auto hessian = hessian_.topLeftCorner(rank_, rank_);
  const Eigen::LLT<Eigen::Ref<Matrix>> factor(hessian);
  if (factor.info() != Success) return false;
  step_ = -gradient_;
  auto step = step_.head(rank_);
  factor.solveInPlace(step);
  return true;
}

/// The dual of the resultant. The Hessian gets a share of the identity that vanishes with the gradient: without points that bear, or with
/// points in a line, it is singular.
bool ForceShare::newton() {
  constexpr int most = 60;
  constexpr double round_off = 1e-14, enough = 1e-11, least_share = 1e-15, share = 1e-6;
  const double size = resultant_.norm();
  dual_ = resultant_;
  double length = evaluate(dual_), least = length;
  for (iterations_ = 0; iterations_ < most && length > round_off * size; ++iterations_) {
    fill_hessian(std::max(least_share, share * std::min(1.0, length / size)));
    if (!find_step()) return false;
    LineSearch search(-step_.dot(gradient_));
    for (bool goes_on = true; goes_on;) {
      tried_ = dual_ + search.share() * step_;
      length = evaluate(tried_);
      if (!std::isfinite(length)) return false;
      goes_on = search.goes_on(-step_.dot(gradient_));
    }
    if (least <= enough * size && !(length < least)) {  // round-off
      length = evaluate(dual_);
      break;
    }
    dual_.swap(tried_);
    least = std::min(least, length);
  }
  return length <= enough * size;
}

/// Whether the contact residual is as good as the methods' own, or as that of the force kept; else that force comes back.
bool ForceShare::is_good(const InterfaceProblem& problem, double gap, InterfaceSolution& solution) {
  const double moved = (solution.opening - problem.free_opening).cwiseAbs().maxCoeff();
  residual_ = contact_residual(problem, solution, scratch_);
  if (residual_ <= 1e-8 + (moved > 0 ? 4 * gap / moved : 1)) return true;
  solution.force.swap(kept_);
  if (!(residual_ <= contact_residual(problem, solution, scratch_))) return false;
  solution.force.swap(kept_);
  return true;
}

bool ForceShare::solve(const InterfaceProblem& problem, double gap, InterfaceSolution& solution) {
  if (problem.model->factor.cols() == 0 || PointRows::suits(*problem.model)) return false;
  size(problem.rows(), problem.model->factor.cols());
  list(problem, gap, solution);
  if (points_.empty()) return false;
  constexpr double alike = 1e-9;  // directions of slips have the round-off of the slips: a base that slides as a whole has few coordinates
  range_.compute(given_, columns_, given_.cols(), alike);
  rank_ = range_.rank();
  if (rank_ == columns_ || !find_resultant() || !newton()) return false;
  kept_ = solution.force;
  for (const Point& point : points_)
    for (int c = 0; c < point.components; ++c) {
      const std::size_t at = static_cast<std::size_t>(c);
      solution.force[point.first + c * point.stride] = point.root * (point.slides ? point.ray[at] * point.force[0] : point.force[at]);
    }
  return is_good(problem, gap, solution);
}

}  // namespace uplift
