#include "uplift/contact/lagrange_rows.h"

#include <algorithm>
#include <cmath>

namespace uplift {
namespace {

// what a signature holds: of a law point the slopes k (row-major), of a cone point
enum At { status = 0, first_direction = 1, second_direction = 2, turning = 3, friction = 4 };

/// Tells factors apart without looking at all of them.
double mark_of(const Matrix& c) {
  double sum = 0;
  for (Index i = 0; i < c.rows(); ++i) sum += (1.0 + static_cast<double>(i)) * c(i, std::min(i, c.cols() - 1)) + c(i, 0);
  return sum;
}

}  // namespace

void StatusRows::prepare(const InterfaceProblem& problem) {
  const Index rows = problem.rows();
  const double mark = mark_of(problem.factor);
  std::size_t points = 0;
  bool seen = seen_ == problem.factor.data() && mark_ == mark && compliance_.rows() == rows;
  for (const Block& block : problem.blocks) {
    const std::size_t first = points;
    points += static_cast<std::size_t>(block.batch.points);
    seen = seen && points <= places_.size() && places_[first].first == block.first && places_[first].law == (block.law != nullptr);
  }
  if (seen && places_.size() == points) return;
  seen_ = problem.factor.data();
  mark_ = mark;
  valid_ = false;
  compliance_.resize(rows, rows);
  compliance_.noalias() = problem.factor * problem.factor.transpose();
  matrix_.size(rows);
  right_.setZero(rows);
  opening_.setZero(rows);
  places_.clear();
  for (const Block& block : problem.blocks)
    for (int i = 0; i < block.batch.points; ++i)
      places_.push_back({block.first + i, block.batch.points, block.batch.components, block.law != nullptr});
  now_.assign(points, {});
  base_.assign(points, {});
  list_.reserve(points);
}

void StatusRows::describe(const System& system) {
  for (const FrictionPoint& point : system.points)
    now_[static_cast<std::size_t>(point.index)] = {static_cast<double>(static_cast<int>(point.status)), point.direction[0],
                                                   point.direction[1], point.turning, point.friction};
  std::size_t index = 0;
  for (std::size_t b = 0; b < system.problem.blocks.size(); ++b) {
    const Block& block = system.problem.blocks[b];
    const int n = block.batch.points, entries = block.batch.components * block.batch.components;
    for (int i = 0; i < n; ++i, ++index)
      for (int e = 0; block.law != nullptr && e < entries; ++e)
        now_[index][static_cast<std::size_t>(e)] = system.slope[system.offsets[b] + e * n + i];
  }
}

bool StatusRows::same(const Signature& a, const Signature& b, bool law) {
  constexpr double little = 0.02;
  if (!law) {
    if (a[status] != b[status] || a[friction] != b[friction]) return false;
    if (static_cast<int>(a[status]) != static_cast<int>(Status::slip)) return true;
    return std::hypot(a[first_direction] - b[first_direction], a[second_direction] - b[second_direction]) <= little &&
           std::abs(a[turning] - b[turning]) <= little * std::max(a[turning], b[turning]);
  }
  double size = 0, change = 0;
  for (std::size_t e = 0; e < a.size(); ++e) size = std::max(size, std::abs(b[e])), change = std::max(change, std::abs(a[e] - b[e]));
  return change <= little * size;
}

void StatusRows::fill_row(const System& system, std::size_t point, int component, double* row) const {
  const Place& at = places_[point];
  const Signature& now = now_[point];
  const Index n = compliance_.rows(), i = at.first + component * at.stride;
  const auto add = [&](int c, double factor) {
    if (factor == 0) return;
    const double* f = compliance_.col(at.first + c * at.stride).data();
    for (Index k = 0; k < n; ++k) row[k] += factor * f[k];
  };
  std::fill_n(row, n, 0.0);
  const Status status_now = static_cast<Status>(static_cast<int>(now[status]));
  const int normal = at.components - 1;
  if (!at.law && status_now != Status::open && (component == normal || status_now == Status::stick)) {
    add(component, 1 / compliance_(i, i));
    return;
  }
  row[i] = 1;
  if (system.problem.shift.size() > 0) add(component, -system.problem.shift[i]);
  if (at.law) {
    for (int c = 0; c < at.components; ++c) add(c, now[static_cast<std::size_t>(component * at.components + c)]);
    return;
  }
  if (status_now != Status::slip || !(now[friction] > 0)) return;
  const auto direction = [&](int c) { return now[static_cast<std::size_t>(first_direction + c)]; };
  row[at.first + normal * at.stride] += now[friction] * direction(component);
  for (int c = 0; c < normal && now[turning] > 0; ++c)
    add(c, now[turning] * ((c == component ? 1 : 0) - direction(component) * direction(c)));
}

bool StatusRows::factorise(const System& system) {
  for (std::size_t p = 0; p < places_.size(); ++p)
    for (int c = 0; c < places_[p].components; ++c)
      fill_row(system, p, c, matrix_.base().col(places_[p].first + c * places_[p].stride).data());
  std::copy(now_.begin(), now_.end(), base_.begin());
  valid_ = matrix_.base().allFinite() && matrix_.factorise();
  return valid_;
}

/// The factor that there is, with the equations of points that changed; false when a new one is better.
bool StatusRows::update(const System& system) {
  if (!valid_) return false;
  list_.clear();
  Index rows = 0;
  for (std::size_t p = 0; p < places_.size(); ++p)
    if (!same(now_[p], base_[p], places_[p].law)) list_.push_back(p), rows += places_[p].components;
  if (rows > matrix_.most()) return false;
  matrix_.restore();
  for (const std::size_t p : list_)
    for (int c = 0; c < places_[p].components; ++c) fill_row(system, p, c, matrix_.change(places_[p].first + c * places_[p].stride));
  return matrix_.prepare();
}

/// What the equations lack at these forces [N], with the present directions and slopes. Returns the largest.
double StatusRows::fill_residual(const System& system, const Vector& forces) {
  const InterfaceProblem& problem = system.problem;
  const bool shifted = problem.shift.size() > 0;
  double largest = 0;
  for (std::size_t p = 0; p < places_.size(); ++p) {
    const Place& at = places_[p];
    const Signature& now = now_[p];
    const int normal = at.components - 1;
    const Status status_now = static_cast<Status>(static_cast<int>(now[status]));
    const auto row = [&](int c) { return at.first + c * at.stride; };
    for (int c = 0; c < at.components; ++c) {
      const Index i = row(c);
      double value = forces[i] + (shifted ? problem.shift[i] * opening_[i] : 0);
      if (at.law) {
        value -= system.linear_force[i];
        for (int k = 0; k < at.components; ++k)
          value -= now[static_cast<std::size_t>(c * at.components + k)] * (opening_[row(k)] - problem.free_opening[row(k)]);
      } else if (status_now != Status::open && (c == normal || status_now == Status::stick)) {
        value = -(opening_[i] - (c == normal ? 0 : problem.from[i])) / compliance_(i, i);
      } else if (status_now == Status::slip && now[friction] > 0) {
        const auto direction = [&](int t) { return now[static_cast<std::size_t>(first_direction + t)]; };
        value += now[friction] * direction(c) * forces[row(normal)];
        for (int t = 0; t < normal && now[turning] > 0; ++t)
          value -= now[turning] * ((t == c ? 1 : 0) - direction(c) * direction(t)) * (opening_[row(t)] - problem.from[row(t)]);
      }
      right_[i] = -value;
      largest = std::max(largest, std::abs(value));
    }
  }
  return largest;
}

/// Corrections until the residual is round-off.
bool StatusRows::iterate(const System& system, Vector& z, Vector& forces) {
  constexpr int most = 12;
  forces.setZero();
  opening_ = system.problem.free_opening;
  double before = fill_residual(system, forces);
  const double start = before;
  for (int pass = 0; pass < most; ++pass) {
    matrix_.solve(right_);
    forces += right_;
    z.noalias() = -system.problem.factor.transpose() * forces;
    opening_ = system.problem.free_opening;
    opening_.noalias() += system.problem.factor * z;
    const double now = fill_residual(system, forces);
    if (!std::isfinite(now)) return false;
    const double size = std::max(start, forces.cwiseAbs().maxCoeff());
    if (now <= 1e-14 * size) return true;
    if (pass > 0 && now > 0.25 * before) return now <= 1e-11 * size;
    before = now;
  }
  return false;
}

bool StatusRows::solve(const System& system, Vector& z, Vector& forces) {
  prepare(system.problem);
  describe(system);
  if (update(system) && iterate(system, z, forces)) return true;
  return factorise(system) && iterate(system, z, forces);
}

}  // namespace uplift
