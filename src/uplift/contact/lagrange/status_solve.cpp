#include <algorithm>
#include <cmath>

#include "uplift/contact/lagrange/laws.h"
#include "uplift/contact/lagrange/status.h"
#include "uplift/contact/point_rows.h"
#include "uplift/math/small.h"

// The linear problem of one status (status.h).
namespace uplift {
namespace {

/// Pivot of H that is taken for zero: H is of order one, the identity less a share of it.
constexpr double singular = 1e-12;

}  // namespace

StatusStep::StatusStep() : rows_(std::make_unique<PointRows>()) {}
StatusStep::~StatusStep() = default;

void StatusStep::size_work() {
  const Index rows = problem_->rows(), r = problem_->model->factor.cols();
  if (moved_.size() == rows && z_.size() == r) return;
  for (Vector* v : {&linear_force_, &q_, &excess_, &moved_, &motion_, &taken_, &known_, &force_}) v->setZero(rows);
  for (Vector* v : {&right_, &z_, &reaction_}) v->setZero(r);
  for (Vector* v : {&more_, &resultant_}) v->setZero(std::max(rows, r));
  held_.reserve(static_cast<std::size_t>(rows));
  changed_.reserve(static_cast<std::size_t>(rows));
}

void StatusStep::open_at(const Vector& z) {
  motion_.noalias() = problem_->model->factor * z;
  solution_->opening = problem_->free_opening + motion_;
}

void StatusStep::list_held() {
  held_.clear();
  for (const FrictionPoint& point : points_) {
    if (point.status == Status::open) continue;
    held_.push_back({point.normal(), 0, point.area, point.status == Status::slip && point.friction > 0 ? &point : nullptr});
    if (point.status != Status::stick) continue;
    for (int c = 0; c < point.tangents(); ++c) held_.push_back({point.row(c), problem_->from[point.row(c)], point.area, nullptr});
  }
}

void StatusStep::linearise_laws() {
  if (offsets_.back() == 0) return;
  law_forces(*problem_, offsets_, slope_.data(), *solution_);
  moved_ = solution_->opening - problem_->free_opening;
  for (std::size_t b = 0; b < problem_->model->blocks.size(); ++b) {
    const Block& block = problem_->model->blocks[b];
    if (block.law == nullptr) continue;
    const int n = block.batch.points, components = block.batch.components;
    for (int row = 0; row < components; ++row) {
      auto part = linear_force_.segment(block.first + row * n, n);
      part = solution_->force.segment(block.first + row * n, n);
      for (int column = 0; column < components; ++column)
        part -= slope_.segment(offsets_[b] + (row * components + column) * n, n).cwiseProduct(moved_.segment(block.first + column * n, n));
    }
  }
}

/// Slip in 3D: bound * trial / |trial| with trial = p_t + rho slip; across its direction d the force turns with the slip,
/// p = s (I - d d^T) slip, s = bound / |slip| at the solution.
void StatusStep::turn_slip() {
  for (FrictionPoint& point : points_) {
    point.turning = 0;
    if (point.status != Status::slip || point.tangents() < 2 || !(point.friction > 0)) continue;
    const double bound = std::max(0.0, -point.friction * solution_->force[point.normal()]);
    const std::array<double, 2> moved = slip(point);
    const double along = moved[0] * point.direction[0] + moved[1] * point.direction[1];
    point.turning = bound / std::max(along, 1e-3 * bound / point.rho_tangent + 1e-300);
  }
}

/// H and the right-hand side; false when something is not finite, or when nothing holds the body.
bool StatusStep::assemble() {
  const Matrix& c = problem_->model->factor;
  const Index rows = problem_->rows(), r = c.cols(), least = std::min(rows, r);
  if (hessian_.rows() != r || u_.cols() != rows) {  // not before they are needed: many independent rows do without
    hessian_.setZero(r, r);
    work_.setZero(rows, r);
    u_.setZero(r, rows);
    v_.setZero(r, rows);
    inverse_.setZero(r, least);
    product_.setZero(rows, least);
    range_ = image_ = reduced_ = Orthonormal();
    range_.size(r, rows);
    image_.size(rows, least);
    reduced_.size(rows, least);
  }
  plain_ = offsets_.back() == 0 && problem_->model->shift.size() == 0;
  hessian_.setIdentity();
  right_.setZero();
  if (offsets_.back() > 0) {
    add_law_slopes(*problem_->model, offsets_, slope_, false, work_, hessian_);
    right_.noalias() -= c.transpose() * linear_force_;
  }
  if (problem_->model->shift.size() > 0) {
    taken_ = -problem_->model->shift;
    known_.setZero();
    for (const Held& held : held_) {
      known_[held.row] = problem_->model->shift[held.row] * held.target;
      taken_[held.row] = 0;
    }
    known_ -= taken_.cwiseProduct(problem_->free_opening);
    add_weighted_gram(*problem_->model, 0, 0, ConstMap(taken_.data(), taken_.size()), work_, hessian_);
    right_.noalias() += c.transpose() * known_;
  }
  for (const FrictionPoint& point : points_) {
    if (!(point.turning > 0)) continue;
    plain_ = false;
    z_ = (-point.direction[1] * c.row(point.row(0)) + point.direction[0] * c.row(point.row(1))).transpose();
    const double known = -point.direction[1] * (problem_->free_opening[point.row(0)] - problem_->from[point.row(0)]) +
                         point.direction[0] * (problem_->free_opening[point.row(1)] - problem_->from[point.row(1)]);
    for (Index j = 0; j < z_.size(); ++j) small::add(z_.size(), point.turning * z_[j], z_.data(), hessian_.col(j).data());
    right_ -= point.turning * known * z_;
  }
  finite_ = hessian_.allFinite() && right_.allFinite();
  if (!finite_) return false;
  if (plain_) {
    z_ = right_;
    return true;
  }
  lu_.compute(hessian_);
  lu_.solve(right_, z_);
  return lu_->matrixLU().diagonal().cwiseAbs().minCoeff() > singular;
}

/// U^T and V^T.
void StatusStep::list_held_rows() {
  for (std::size_t k = 0; k < held_.size(); ++k) {
    const Held& held = held_[k];
    const double root = std::sqrt(held.area);
    auto u = u_.col(static_cast<Index>(k)), v = v_.col(static_cast<Index>(k));
    u = root * problem_->model->factor.row(held.row).transpose();
    v = u;
    if (held.slipping == nullptr) continue;
    for (int t = 0; t < held.slipping->tangents(); ++t)
      v -= root * held.slipping->friction * held.slipping->direction[static_cast<std::size_t>(t)] *
           problem_->model->factor.row(held.slipping->row(t)).transpose();
  }
}

bool StatusStep::solve() {
  linearise_laws();
  list_held();
  turn_slip();
  if (solve_by_rows()) return true;
  if (!assemble()) return false;
  if (!held_.empty() && !hold()) return false;
  finite_ = z_.allFinite() && q_.head(static_cast<Index>(held_.size())).allFinite();
  if (!finite_) return false;
  solution_->z = z_;
  open_at(z_);
  write_forces();
  return true;
}

bool StatusStep::solve_by_rows() {
  if (!PointRows::suits(*problem_->model)) return false;
  rows_->begin(*problem_);
  for (std::size_t b = 0; b < problem_->model->blocks.size(); ++b)
    if (problem_->model->blocks[b].law != nullptr) rows_->linearise(b, slope_.data() + offsets_[b], solution_->force, solution_->opening);
  for (const FrictionPoint& point : points_) relate(point, rows_->relation(point.index));
  if (!rows_->solve(force_, moved_, z_, solution_->systems)) return false;
  for (std::size_t k = 0; k < held_.size(); ++k) {
    const Held& held = held_[k];
    const double taken = problem_->model->shift.size() > 0 ? problem_->model->shift[held.row] * held.target : 0;
    q_[static_cast<Index>(k)] = (force_[held.row] + taken) / std::sqrt(held.area);
  }
  finite_ = true;
  solution_->z = z_;
  solution_->opening = moved_;
  motion_ = moved_ - problem_->free_opening;
  write_forces();
  return true;
}

/// The relation between P = p - D opening and the opening g of a cone point for its status (s = turning, e across the slip d):
///     closed, normal     g_n = 0
///     sticks             g_t = from_t
///     open, frictionless P + D g = 0
///     slips              P_t + D_t g_t = -mu d p_n + s e (e . (g_t - from_t))
/// Without D an open point has no unknown; a slipping one has its pressure and the force across d.
void StatusStep::relate(const FrictionPoint& point, PointRelation& relation) const {
  const bool shifted = problem_->model->shift.size() > 0, slips = point.status == Status::slip && point.friction > 0;
  const int normal = point.tangents();
  relation = PointRelation();
  relation.kind = 1 + static_cast<int>(point.status) + (slips ? 3 : 0);
  const PointRelation::Local along{slips ? point.direction[0] : 0, slips && normal > 1 ? point.direction[1] : 0, 0};
  const PointRelation::Local across{-along[1], along[0], 0};
  const double flexible = normal > 0 ? std::max(rows_->compliance(point.row(0)), rows_->compliance(point.row(normal - 1))) : 0;
  const double weight = 1 / (1 + point.turning * flexible);
  const auto hold = [&](int c, double target) {
    const std::size_t f = static_cast<std::size_t>(relation.count++);
    relation.basis[f][static_cast<std::size_t>(c)] = 1;
    relation.opening[f][static_cast<std::size_t>(c)] = 1 / rows_->compliance(point.row(c));
    relation.right[f] = target / rows_->compliance(point.row(c));
  };
  const auto turn = [&](std::size_t f, double share) {  // + share s e . (g_t - from_t)
    for (int t = 0; t < normal; ++t) {
      const double slope = weight * share * point.turning * across[static_cast<std::size_t>(t)];
      relation.opening[f][static_cast<std::size_t>(t)] += slope;
      relation.right[f] += slope * problem_->from[point.row(t)];
    }
  };
  if (point.status != Status::open) hold(normal, 0);
  if (point.status == Status::stick) {
    for (int c = 0; c < normal; ++c) hold(c, problem_->from[point.row(c)]);
  } else if (shifted) {
    for (int c = 0; c < (point.status == Status::open ? normal + 1 : normal); ++c) {
      const std::size_t f = static_cast<std::size_t>(relation.count++), at = static_cast<std::size_t>(c);
      relation.basis[f][at] = 1;
      relation.force[f][at] = weight;
      if (slips) relation.force[f][static_cast<std::size_t>(normal)] = weight * point.friction * along[at];
      relation.opening[f][at] = -weight * problem_->model->shift[point.row(c)];
      if (slips && normal > 1) turn(f, across[at]);
    }
  } else if (slips) {
    for (int c = 0; c < normal; ++c) relation.basis[0][static_cast<std::size_t>(c)] = -point.friction * along[static_cast<std::size_t>(c)];
    if (normal < 2) return;
    const std::size_t f = static_cast<std::size_t>(relation.count++);
    relation.basis[f] = across;
    for (std::size_t t = 0; t < 2; ++t) relation.force[f][t] = weight * across[t];
    turn(f, 1);
  }
}

/// Openings of the held rows beyond their targets, times the root of the area.
void StatusStep::measure_excess() {
  for (std::size_t k = 0; k < held_.size(); ++k) {
    const Held& held = held_[k];
    excess_[static_cast<Index>(k)] =
        u_.col(static_cast<Index>(k)).dot(z_) + std::sqrt(held.area) * (problem_->free_opening[held.row] - held.target);
  }
}

/// z <- z - H^-1 V^T q so that the held rows are on target; each pass takes the round-off of the one before.
bool StatusStep::hold() {
  constexpr int passes = 3;
  const Index count = static_cast<Index>(held_.size()), r = problem_->model->factor.cols();
  list_held_rows();
  range_.compute(v_, r, count, 1e-10);
  const Index rank = range_.rank();
  auto inverse = inverse_.leftCols(rank);
  const auto basis = range_.basis().leftCols(rank);
  if (plain_)
    inverse = basis;
  else
    lu_.solve(basis, inverse);
  product_.topLeftCorner(count, rank).noalias() = u_.leftCols(count).transpose() * inverse;
  reduced_.compute(product_, count, rank, 1e-10);
  resultant_.head(rank).setZero();
  for (int pass = 0; pass < passes; ++pass) {
    measure_excess();
    reduced_.solve(excess_, more_);
    resultant_.head(rank) += more_.head(rank);
    z_.noalias() -= inverse * more_.head(rank);
  }
  measure_excess();
  for (Index k = 0; k < count; ++k)
    if (!(std::abs(excess_[k]) <= gap_ * std::sqrt(held_[static_cast<std::size_t>(k)].area))) return false;
  product_.topLeftCorner(count, rank).noalias() = v_.leftCols(count).transpose() * basis;
  image_.compute(product_, count, rank, 0);
  image_.solve_transposed(resultant_, q_);
  return true;
}

/// Forces of the cone points from the multipliers q of the held rows (per root of area).
void StatusStep::write_forces() {
  Vector& force = solution_->force;
  for (const FrictionPoint& point : points_)
    for (int c = 0; c < point.components; ++c) force[point.row(c)] = 0;
  for (std::size_t k = 0; k < held_.size(); ++k) force[held_[k].row] = q_[static_cast<Index>(k)] * std::sqrt(held_[k].area);
  largest_force_ = 0;
  for (const FrictionPoint& point : points_) {
    largest_force_ = std::max(largest_force_, std::abs(force[point.normal()]));
    if (point.status != Status::slip || !(point.friction > 0)) continue;
    const double bound = -point.friction * force[point.normal()];
    for (int c = 0; c < point.tangents(); ++c) force[point.row(c)] = bound * point.direction[static_cast<std::size_t>(c)];
    if (point.tangents() < 2) continue;
    const std::array<double, 2> moved = slip(point);
    const double turn = point.turning * (-point.direction[1] * moved[0] + point.direction[0] * moved[1]);
    force[point.row(0)] -= point.direction[1] * turn;
    force[point.row(1)] += point.direction[0] * turn;
  }
}

}  // namespace uplift
