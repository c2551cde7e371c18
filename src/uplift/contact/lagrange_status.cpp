#include "uplift/contact/lagrange_status.h"

#include <algorithm>
#include <cmath>

namespace uplift {
namespace {

/// Pivot of H that is taken for zero: H is of order one, the identity less a share of it.
constexpr double singular = 1e-12;

double length(const std::array<double, 2>& v) {
  return std::hypot(v[0], v[1]);
}

}  // namespace

StatusStep::StatusStep(const InterfaceProblem& problem, double gap_tolerance, InterfaceSolution& solution)
    : problem_(problem), gap_(gap_tolerance), solution_(solution), offsets_(slope_offsets(problem)) {
  if (problem.rows() > 0) gap_ = std::max(gap_, 1e-14 * problem.free_opening.cwiseAbs().maxCoeff());
  slope_.setZero(offsets_.back());
  const Vector flexible = problem.factor.rowwise().squaredNorm();
  const double largest = problem.rows() > 0 ? flexible.maxCoeff() : 0;
  const auto rho = [&](Index row) { return 1 / (flexible[row] > 1e-12 * largest ? flexible[row] : std::max(largest, 1e-300)); };
  Index index = 0;
  for (const Block& block : problem.blocks)
    for (int i = 0; i < block.batch.points; ++i, ++index) {
      if (block.cone == nullptr) continue;
      FrictionPoint point;
      point.components = block.batch.components;
      point.first = block.first + i;
      point.stride = block.batch.points;
      point.index = index;
      point.area = block.area[static_cast<std::size_t>(i)];
      point.friction = point.full_friction = point.tangents() > 0 ? block.cone->friction() : 0;
      point.rho_normal = rho(point.normal());
      for (int c = 0; c < point.tangents(); ++c) point.rho_tangent = std::max(point.rho_tangent, rho(point.row(c)));
      points_.push_back(point);
    }
}

void StatusStep::guess_from_solution() {
  solution_.opening = problem_.free_opening + problem_.factor * solution_.z;
  for (FrictionPoint& point : points_) {
    point.status = solution_.status[static_cast<std::size_t>(point.index)];
    std::array<double, 2> force{}, moved{};
    for (int c = 0; c < point.tangents(); ++c) {
      force[static_cast<std::size_t>(c)] = solution_.force[point.row(c)];
      moved[static_cast<std::size_t>(c)] = problem_.free_opening[point.row(c)] - problem_.from[point.row(c)];
    }
    const std::array<double, 2>& shown = length(force) > 0 ? force : moved;
    const double size = length(shown);
    point.direction = size > 0 ? std::array<double, 2>{shown[0] / size, shown[1] / size} : std::array<double, 2>{1, 0};
    if (!(point.friction > 0) && point.status == Status::stick) point.status = Status::slip;
  }
}

void StatusStep::guess_from_free_opening() {
  const auto penetrates = [&](const FrictionPoint& point) { return problem_.free_opening[point.normal()] < -gap_; };
  const bool any = std::any_of(points_.begin(), points_.end(), penetrates);
  for (FrictionPoint& point : points_)
    point.status = any && !penetrates(point) ? Status::open : point.friction > 0 ? Status::stick : Status::slip;
  solution_.z.setZero();
  solution_.opening = problem_.free_opening;
}

void StatusStep::scale_friction(double share) {
  for (FrictionPoint& point : points_) {
    point.friction = share * point.full_friction;
    if (!(point.friction > 0) && point.status == Status::stick) point.status = Status::slip;
  }
}

void StatusStep::list_held() {
  held_.clear();
  for (const FrictionPoint& point : points_) {
    if (point.status == Status::open) continue;
    held_.push_back({point.normal(), 0, point.area, point.status == Status::slip && point.friction > 0 ? &point : nullptr});
    if (point.status != Status::stick) continue;
    for (int c = 0; c < point.tangents(); ++c) held_.push_back({point.row(c), problem_.from[point.row(c)], point.area, nullptr});
  }
}

std::array<double, 2> StatusStep::slip(const FrictionPoint& point) const {
  std::array<double, 2> result{};
  for (int c = 0; c < point.tangents(); ++c)
    result[static_cast<std::size_t>(c)] = solution_.opening[point.row(c)] - problem_.from[point.row(c)];
  return result;
}

void StatusStep::linearise_laws() {
  law_forces(problem_, offsets_, slope_.data(), solution_);
  linear_force_.setZero(problem_.rows());
  const Vector moved = problem_.factor * solution_.z;
  for (std::size_t b = 0; b < problem_.blocks.size(); ++b) {
    const Block& block = problem_.blocks[b];
    if (block.law == nullptr) continue;
    const int n = block.batch.points, components = block.batch.components;
    for (int row = 0; row < components; ++row) {
      auto part = linear_force_.segment(block.first + row * n, n);
      part = solution_.force.segment(block.first + row * n, n);
      for (int column = 0; column < components; ++column)
        part -= slope_.segment(offsets_[b] + (row * components + column) * n, n).cwiseProduct(moved.segment(block.first + column * n, n));
    }
  }
}

void StatusStep::assemble(Matrix& hessian, Vector& right) {
  const Matrix& c = problem_.factor;
  hessian.setIdentity(c.cols(), c.cols());
  add_law_slopes(problem_, offsets_, slope_, false, hessian);
  right = -(c.transpose() * linear_force_);
  if (problem_.shift.size() > 0) {
    Vector taken = problem_.shift, known = Vector::Zero(problem_.rows());
    for (const Held& held : held_) {
      known[held.row] = taken[held.row] * held.target;
      taken[held.row] = 0;
    }
    hessian.noalias() -= c.transpose() * taken.asDiagonal() * c;
    right += c.transpose() * (known + taken.cwiseProduct(problem_.free_opening));
  }
  // slip in 3D: bound * trial / |trial| with trial = p_t + rho slip; across its direction d the force turns with the slip, p = s (I - d
  // d^T) slip, s = bound / |slip| at the solution
  for (FrictionPoint& point : points_) {
    point.turning = 0;
    if (point.status != Status::slip || point.tangents() < 2 || !(point.friction > 0)) continue;
    const double bound = std::max(0.0, -point.friction * solution_.force[point.normal()]);
    const std::array<double, 2> moved = slip(point);
    const double along = moved[0] * point.direction[0] + moved[1] * point.direction[1];
    point.turning = bound / std::max(along, 1e-3 * bound / point.rho_tangent + 1e-300);
    const Vector row = (-point.direction[1] * c.row(point.row(0)) + point.direction[0] * c.row(point.row(1))).transpose();
    const double known = -point.direction[1] * (problem_.free_opening[point.row(0)] - problem_.from[point.row(0)]) +
                         point.direction[0] * (problem_.free_opening[point.row(1)] - problem_.from[point.row(1)]);
    hessian.noalias() += point.turning * row * row.transpose();
    right -= point.turning * known * row;
  }
}

bool StatusStep::solve() {
  linearise_laws();
  list_held();
  Matrix hessian;
  Vector right;
  assemble(hessian, right);
  finite_ = hessian.allFinite() && right.allFinite();
  if (!finite_) return false;
  const PartialLu lu(hessian);
  if (!(lu.matrixLU().diagonal().cwiseAbs().minCoeff() > singular)) return false;  // nothing holds the body
  const Index count = static_cast<Index>(held_.size());
  Matrix u(count, problem_.factor.cols()), v(count, problem_.factor.cols());
  for (Index k = 0; k < count; ++k) {
    const Held& held = held_[static_cast<std::size_t>(k)];
    const double root = std::sqrt(held.area);
    u.row(k) = v.row(k) = root * problem_.factor.row(held.row);
    if (held.slipping == nullptr) continue;
    for (int t = 0; t < held.slipping->tangents(); ++t)
      v.row(k) -= root * held.slipping->friction * held.slipping->direction[static_cast<std::size_t>(t)] *
                  problem_.factor.row(held.slipping->row(t));
  }
  Vector z = lu.solve(right), q = Vector::Zero(count);
  field_.resize(0);
  if (count > 0 && !hold(lu, u, v, z, q)) return false;
  finite_ = z.allFinite() && q.allFinite();
  if (!finite_) return false;
  solution_.z = z;
  solution_.opening = problem_.free_opening + problem_.factor * z;
  write_forces(q);
  return true;
}

/// Openings of the held rows beyond their targets, times the root of the area.
Vector StatusStep::excess(const Vector& z) const {
  Vector result(static_cast<Index>(held_.size()));
  for (Index k = 0; k < result.size(); ++k) {
    const Held& held = held_[static_cast<std::size_t>(k)];
    result[k] = std::sqrt(held.area) * (problem_.free_opening[held.row] + problem_.factor.row(held.row).dot(z) - held.target);
  }
  return result;
}

/// z <- z - H^-1 V^T q so that the held rows are on target; each pass takes the round-off of the one before.
bool StatusStep::hold(const PartialLu& hessian, const Matrix& u, const Matrix& v, Vector& z, Vector& q) {
  constexpr int passes = 3;
  const Index count = u.rows();
  if (count <= u.cols()) {
    const Matrix inverse = hessian.solve(v.transpose());
    const FullLu lu(u * inverse);
    if (std::abs(lu.matrixLU()(count - 1, count - 1)) > 1e-9 * std::abs(lu.matrixLU()(0, 0))) {
      for (int pass = 0; pass < passes; ++pass) {
        const Vector more = lu.solve(excess(z));
        q += more;
        z -= inverse * more;
      }
      return true;
    }
  }
  // redundant rows: only the resultant V^T q = N s is known, N an orthonormal basis of the range of V^T
  CompleteQr range;
  range.setThreshold(1e-10);
  range.compute(v.transpose());
  const Matrix basis = Matrix(range.householderQ()).leftCols(range.rank());
  const Matrix inverse = hessian.solve(basis);
  CompleteQr reduced;
  reduced.setThreshold(1e-10);
  reduced.compute(u * inverse);
  Vector resultant = Vector::Zero(basis.cols());
  for (int pass = 0; pass < passes; ++pass) {
    const Vector more = reduced.solve(excess(z));
    resultant += more;
    z -= inverse * more;
  }
  const Vector left = excess(z);
  for (Index k = 0; k < count; ++k)
    if (!(std::abs(left[k]) <= gap_ * std::sqrt(held_[static_cast<std::size_t>(k)].area))) return false;
  q = range.solve(basis * resultant);
  field_ = problem_.factor * Vector(range.transpose().solve(q));
  return true;
}

/// Forces of the cone points from the multipliers q of the held rows (per root of area).
void StatusStep::write_forces(const Vector& q) {
  for (const FrictionPoint& point : points_)
    for (int c = 0; c < point.components; ++c) solution_.force[point.row(c)] = 0;
  for (std::size_t k = 0; k < held_.size(); ++k) solution_.force[held_[k].row] = q[static_cast<Index>(k)] * std::sqrt(held_[k].area);
  largest_force_ = 0;
  for (const FrictionPoint& point : points_) {
    largest_force_ = std::max(largest_force_, std::abs(solution_.force[point.normal()]));
    if (point.status != Status::slip || !(point.friction > 0)) continue;
    const double bound = -point.friction * solution_.force[point.normal()];
    for (int c = 0; c < point.tangents(); ++c) solution_.force[point.row(c)] = bound * point.direction[static_cast<std::size_t>(c)];
    if (point.tangents() < 2) continue;
    const std::array<double, 2> moved = slip(point);
    const double turn = point.turning * (-point.direction[1] * moved[0] + point.direction[0] * moved[1]);
    solution_.force[point.row(0)] -= point.direction[1] * turn;
    solution_.force[point.row(1)] += point.direction[0] * turn;
  }
}

/// What the point would rather be, and in which direction it would slip.
Status StatusStep::trial(const FrictionPoint& point, std::array<double, 2>& direction) const {
  const double normal = solution_.force[point.normal()], opening = solution_.opening[point.normal()], small = 1e-12 * largest_force_;
  const bool touches = field_.size() > 0 && opening <= gap_ && field_[point.normal()] * point.area < -small;
  const bool closed = point.status != Status::open;
  if (closed ? normal > small : opening >= -gap_ && !touches) return Status::open;
  if (!(point.friction > 0)) return Status::slip;
  const double bound = point.friction * (closed ? std::max(0.0, -normal) : std::max(0.0, -opening * point.rho_normal));
  std::array<double, 2> push = slip(point);
  for (int c = 0; c < point.tangents(); ++c) {
    double& value = push[static_cast<std::size_t>(c)];
    value = point.status == Status::stick ? 0 : point.rho_tangent * value;
    value += closed ? solution_.force[point.row(c)] : 0;
  }
  const double size = length(push);
  if (size > 0) direction = {push[0] / size, push[1] / size};
  if (point.status == Status::slip) return size < bound - point.rho_tangent * gap_ - small ? Status::stick : Status::slip;
  return size > bound + small ? Status::slip : Status::stick;
}

bool StatusStep::update_status(bool single) {
  changed_.clear();
  for (FrictionPoint& point : points_) {
    std::array<double, 2> direction = point.direction;
    const Status wanted = trial(point, direction);
    const double cosine = direction[0] * point.direction[0] + direction[1] * point.direction[1];
    const bool reversed = wanted == Status::slip && point.status == Status::slip && point.tangents() == 1 && cosine < 0;
    if (wanted == point.status && !reversed) {
      if (wanted == Status::slip) point.direction = direction;
      continue;
    }
    if (single && !changed_.empty()) continue;
    point.status = wanted;
    point.direction = direction;
    changed_.push_back(point.normal());
  }
  return !changed_.empty();
}

double StatusStep::residual() {
  law_forces(problem_, offsets_, nullptr, solution_);
  Vector force = solution_.force;
  const Vector reaction = problem_.factor.transpose() * force;
  if (problem_.shift.size() > 0) force -= problem_.shift.cwiseProduct(solution_.opening);
  const double size = std::max(solution_.z.norm(), reaction.norm());
  double worst = size > 0 ? (solution_.z + problem_.factor.transpose() * force).norm() / size : 0;
  for (const FrictionPoint& point : points_) {
    if (point.status != Status::slip || point.tangents() < 2 || !(largest_force_ > 0)) continue;
    const double bound = -point.friction * solution_.force[point.normal()];  // the direction is the trial's by now
    worst = std::max(worst, std::hypot(solution_.force[point.row(0)] - bound * point.direction[0],
                                       solution_.force[point.row(1)] - bound * point.direction[1]) /
                                largest_force_);
  }
  return worst;
}

void StatusStep::write_status() {
  std::fill(solution_.status.begin(), solution_.status.end(), Status::open);
  for (const FrictionPoint& point : points_) {
    solution_.status[static_cast<std::size_t>(point.index)] = point.status;
    double& normal = solution_.force[point.normal()];
    if (normal > 0) {  // round-off of a point without pressure
      normal = 0;
      for (int c = 0; c < point.tangents(); ++c) solution_.force[point.row(c)] = 0;
    }
  }
}

std::vector<signed char> StatusStep::code() const {
  std::vector<signed char> result;
  for (const FrictionPoint& point : points_) {
    const bool back = point.status == Status::slip && point.direction[0] < 0;
    result.push_back(static_cast<signed char>(back ? 3 : static_cast<int>(point.status)));
  }
  return result;
}

}  // namespace uplift
