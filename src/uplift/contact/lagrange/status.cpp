#include "uplift/contact/lagrange/status.h"

#include <algorithm>
#include <cmath>

#include "uplift/contact/lagrange/augmentation.h"
#include "uplift/contact/lagrange/laws.h"
#include "uplift/contact/point_rows.h"
#include "uplift/math/small.h"

// The statuses: first guesses, trials, and what is read off. The linear problem of one status is in status_solve.cpp.
namespace uplift {
namespace {

double length(const std::array<double, 2>& v) {
  return std::hypot(v[0], v[1]);
}

}  // namespace

void StatusStep::begin(const InterfaceProblem& problem, double gap_tolerance, InterfaceSolution& solution) {
  problem_ = &problem, solution_ = &solution;
  gap_ = problem.rows() > 0 ? std::max(gap_tolerance, 1e-14 * problem.free_opening.cwiseAbs().maxCoeff()) : gap_tolerance;
  finite_ = true;
  changed_.clear();
  slope_offsets(*problem.model, offsets_);
  slope_.setZero(offsets_.back());
  size_work();
  list_points();
}

void StatusStep::list_points() {
  const ContactModel& model = *problem_->model;
  const Index rows = model.rows();
  moved_.setZero();  // F_ii of every row
  for (Index k = 0; k < model.factor.cols(); ++k)
    for (Index i = 0; i < rows; ++i) moved_[i] += model.factor(i, k) * model.factor(i, k);
  const double largest = rows > 0 ? moved_.maxCoeff() : 0;
  const auto rho = [&](Index row) { return 1 / divisor(moved_[row], largest); };
  points_.clear();
  Index index = 0;
  for (const Block& block : model.blocks)
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
  open_at(solution_->z);
  for (FrictionPoint& point : points_) {
    point.status = solution_->status[static_cast<std::size_t>(point.index)];
    std::array<double, 2> force{}, moved{};
    for (int c = 0; c < point.tangents(); ++c) {
      force[static_cast<std::size_t>(c)] = solution_->force[point.row(c)];
      moved[static_cast<std::size_t>(c)] = problem_->free_opening[point.row(c)] - problem_->from[point.row(c)];
    }
    const std::array<double, 2>& shown = length(force) > 0 ? force : moved;
    const double size = length(shown);
    point.direction = size > 0 ? std::array<double, 2>{shown[0] / size, shown[1] / size} : std::array<double, 2>{1, 0};
    if (!(point.friction > 0) && point.status == Status::stick) point.status = Status::slip;
  }
}

void StatusStep::guess_from_free_opening() {
  const auto penetrates = [&](const FrictionPoint& point) { return problem_->free_opening[point.normal()] < -gap_; };
  const bool any = std::any_of(points_.begin(), points_.end(), penetrates);
  for (FrictionPoint& point : points_)
    point.status = any && !penetrates(point) ? Status::open : point.friction > 0 ? Status::stick : Status::slip;
  solution_->z.setZero();
  open_at(solution_->z);
}

void StatusStep::scale_friction(double share) {
  for (FrictionPoint& point : points_) {
    point.friction = share * point.full_friction;
    if (!(point.friction > 0) && point.status == Status::stick) point.status = Status::slip;
  }
}

/// Not opening - from: where a base has slid far, its round-off would turn the friction of points that do not move.
std::array<double, 2> StatusStep::slip(const FrictionPoint& point) const {
  std::array<double, 2> result{};
  for (int c = 0; c < point.tangents(); ++c) {
    const Index row = point.row(c);
    result[static_cast<std::size_t>(c)] = (problem_->free_opening[row] - problem_->from[row]) + motion_[row];
  }
  return result;
}

/// What the point would rather be, and in which direction it would slip.
Status StatusStep::trial(const FrictionPoint& point, std::array<double, 2>& direction) const {
  const double normal = solution_->force[point.normal()], opening = solution_->opening[point.normal()], small = 1e-12 * largest_force_;
  const bool closed = point.status != Status::open;
  if (closed ? normal > small : opening >= -gap_) return Status::open;
  if (!(point.friction > 0)) return Status::slip;
  const double bound = point.friction * (closed ? std::max(0.0, -normal) : std::max(0.0, -opening * point.rho_normal));
  std::array<double, 2> push = slip(point);
  for (int c = 0; c < point.tangents(); ++c) {
    double& value = push[static_cast<std::size_t>(c)];
    value = point.status == Status::stick ? 0 : point.rho_tangent * value;
    value += closed ? solution_->force[point.row(c)] : 0;
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
  law_forces(*problem_, offsets_, nullptr, *solution_);
  reaction_.noalias() = problem_->model->factor.transpose() * solution_->force;
  const double size = std::max(solution_->z.norm(), reaction_.norm());
  if (problem_->model->shift.size() > 0) {
    force_ = solution_->force - problem_->model->shift.cwiseProduct(solution_->opening);
    reaction_.noalias() = problem_->model->factor.transpose() * force_;
  }
  reaction_ += solution_->z;
  double worst = size > 0 ? reaction_.norm() / size : 0;
  for (const FrictionPoint& point : points_) {
    if (point.status != Status::slip || point.tangents() < 2 || !(largest_force_ > 0)) continue;
    const double bound = -point.friction * solution_->force[point.normal()];  // the direction is the trial's by now
    worst = std::max(worst, std::hypot(solution_->force[point.row(0)] - bound * point.direction[0],
                                       solution_->force[point.row(1)] - bound * point.direction[1]) /
                                largest_force_);
  }
  return worst;
}

void StatusStep::write_status() {
  std::fill(solution_->status.begin(), solution_->status.end(), Status::open);
  for (const FrictionPoint& point : points_) {
    solution_->status[static_cast<std::size_t>(point.index)] = point.status;
    double& normal = solution_->force[point.normal()];
    if (normal > 0) {  // round-off of a point without pressure
      normal = 0;
      for (int c = 0; c < point.tangents(); ++c) solution_->force[point.row(c)] = 0;
    }
  }
}

std::uint64_t StatusStep::code() const {
  std::uint64_t value = 14695981039346656037ull;  // FNV-1a
  for (const FrictionPoint& point : points_) {
    const bool back = point.status == Status::slip && point.direction[0] < 0;
    value = (value ^ static_cast<std::uint64_t>(back ? 3 : static_cast<int>(point.status))) * 1099511628211ull;
  }
  return value;
}

}  // namespace uplift
