#include "uplift/contact/lagrange/force_share.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "uplift/contact/point_rows.h"
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
  found_.setZero(rows);
  points_.reserve(static_cast<std::size_t>(rows));
}

/// Adds a row of C, times `factor`, to the row of given_ that comes next.
void ForceShare::add_given(Index row, double factor, const Matrix& factors) {
  for (Index k = 0; k < factors.cols(); ++k) given_(columns_, k) += factor * factors(row, k);
}

/// The closed points, with their forces.
void ForceShare::list(const InterfaceProblem& problem, double gap, const InterfaceSolution& solution) {
  constexpr double near = 1e-9, round_off = 8 * std::numeric_limits<double>::epsilon();
  const Matrix& factor = problem.model->factor;
  const double still =
      std::max(round_off * solution.opening.cwiseAbs().maxCoeff(), near * (solution.opening - problem.free_opening).cwiseAbs().maxCoeff());
  columns_ = 0;
  points_.clear();
  given_.setZero();
  for (const Block& block : problem.model->blocks) {
    if (block.cone == nullptr) continue;
    const int n = block.batch.points, tangents = block.batch.components - 1;
    for (int i = 0; i < n; ++i) {
      Point point;
      point.first = block.first + i, point.stride = n, point.components = tangents + 1;
      const Index normal = point.first + tangents * n;
      const double pressure = -solution.force[normal];
      if (!(pressure > 0) && !(solution.opening[normal] <= gap)) continue;
      point.column = columns_;
      point.root = std::sqrt(block.area[i]);
      point.friction = tangents > 0 ? block.cone->friction() : 0;
      std::array<double, 2> slip{}, force{};
      for (std::size_t c = 0; c < static_cast<std::size_t>(tangents); ++c) {
        const Index row = point.first + static_cast<Index>(c) * n;
        slip[c] = solution.opening[row] - problem.from[row], force[c] = solution.force[row];
      }
      point.slides = !(point.friction > 0) || std::hypot(slip[0], slip[1]) > still;
      if (point.slides) {
        const std::array<double, 2>& along = pressure > 0 ? force : slip;
        const double length = std::hypot(along[0], along[1]), unit = 1 / std::hypot(1, point.friction);
        for (std::size_t c = 0; c < static_cast<std::size_t>(tangents); ++c) {
          point.ray[c] = length > 0 ? unit * point.friction * along[c] / length : 0;
          add_given(point.first + static_cast<Index>(c) * n, point.root * point.ray[c], factor);
        }
        point.ray[static_cast<std::size_t>(tangents)] = -unit;
        add_given(normal, -point.root * unit, factor);
        found_[columns_++] = pressure / (unit * point.root);
      } else {
        for (int c = 0; c <= tangents; ++c) {
          add_given(point.first + c * n, point.root, factor);
          found_[columns_++] = solution.force[point.first + c * n] / point.root;
        }
      }
      points_.push_back(point);
    }
  }
}

void ForceShare::orthonormalise() {
  range_.compute(given_, columns_, given_.cols(), 1e-12);
  const Index rank = range_.rank();
  if (rows_.rows() != rank || rows_.cols() != given_.rows()) {
    rows_.setZero(rank, given_.rows());
    hessian_.setZero(rank, rank);
    for (Vector* v : {&resultant_, &dual_, &step_, &tried_, &gradient_, &column_}) v->setZero(rank);
  }
  rows_.leftCols(columns_) = range_.basis().topLeftCorner(columns_, rank).transpose();
  resultant_.noalias() = rows_.leftCols(columns_) * found_.head(columns_);
}

/// The forces that belong to the dual, and gradient_ = their resultant - that found. Returns its length.
double ForceShare::evaluate(const Vector& dual) {
  const Index r = rows_.rows();
  gradient_ = -resultant_;
  small::with_size(r, [&](auto size) {
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
  small::with_size(rows_.rows(), [&](auto size) {
    for (std::ptrdiff_t k = 0; k < size; ++k) small::add(size, weight * column[k], column, hessian_.data() + k * size);
  });
}

/// A generalised derivative of the gradient at the dual that was evaluated last.
void ForceShare::add_slopes() {
  const Index r = rows_.rows();
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
    small::add(r, mu * unit * cosine, column, column_.data());
    if (tangents == 2) small::add(r, mu * unit * sine, column + r, column_.data());
    small::add(r, -unit, column + tangents * r, column_.data());
    add_outer(1, column_.data());
    if (tangents < 2) continue;
    column_.setZero();
    small::add(r, -sine, column, column_.data());
    small::add(r, cosine, column + r, column_.data());
    add_outer(mu * (pressure + mu * along) / ((1 + mu * mu) * along), column_.data());
  }
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
    hessian_.setZero();
    add_slopes();
    hessian_.diagonal().array() += std::max(least_share, share * std::min(1.0, length / size));
    cholesky_.compute(hessian_);
    if (cholesky_->info() != Success) return false;
    gradient_ = -gradient_;
    cholesky_.solve(gradient_, step_);
    LineSearch search(step_.dot(gradient_));
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

bool ForceShare::solve(const InterfaceProblem& problem, double gap, InterfaceSolution& solution) {
  if (problem.model->factor.cols() == 0 || PointRows::suits(*problem.model)) return false;
  size(problem.rows(), problem.model->factor.cols());
  list(problem, gap, solution);
  if (points_.empty()) return false;
  orthonormalise();
  if (!newton()) return false;
  for (const Point& point : points_)
    for (int c = 0; c < point.components; ++c) {
      const std::size_t at = static_cast<std::size_t>(c);
      solution.force[point.first + c * point.stride] = point.root * (point.slides ? point.ray[at] * point.force[0] : point.force[at]);
    }
  return true;
}

}  // namespace uplift
