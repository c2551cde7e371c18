#include "uplift/contact/newton/jump_direction.h"

#include <algorithm>
#include <cmath>

namespace uplift {
namespace {

constexpr int cheap_iterations = 12;  // iterations that cost less than a factor
constexpr double round_off = 1e-13;   // residual that counts as none, of the right side
constexpr double accurate = 1e-8;     // residual after a new factor, which iterations cannot mend

/// W_row . jump
double felt(const SparseRows& rows, Index row, const Vector& jump) {
  double sum = 0;
  for (Index e = rows.outerIndexPtr()[row]; e < rows.outerIndexPtr()[row + 1]; ++e)
    sum += rows.valuePtr()[e] * jump[rows.innerIndexPtr()[e]];
  return sum;
}

/// pull += W_row^T force
void pull_by(const SparseRows& rows, Index row, double force, Vector& pull) {
  for (Index e = rows.outerIndexPtr()[row]; e < rows.outerIndexPtr()[row + 1]; ++e)
    pull[rows.innerIndexPtr()[e]] += rows.valuePtr()[e] * force;
}

/// matrix += W_left^T slope W_right, of a symmetric sum its lower triangle alone
void add_product(const SparseRows& rows, Index left, Index right, double slope, bool symmetric, Matrix& matrix) {
  const auto* const first = rows.outerIndexPtr();
  for (Index e = first[right]; e < first[right + 1]; ++e) {
    const Index j = rows.innerIndexPtr()[e];
    const double factor = slope * rows.valuePtr()[e];
    double* const column = matrix.data() + j * matrix.rows();
    for (Index f = first[left]; f < first[left + 1]; ++f)
      if (const Index i = rows.innerIndexPtr()[f]; !symmetric || i >= j) column[i] += rows.valuePtr()[f] * factor;
  }
}

}  // namespace

void JumpDirection::begin(const ContactModel& model) {
  model_ = &model;
  if (seen_.is(model)) return;
  seen_.take(model);
  valid_ = false;
  const Index r = model.factor.cols();
  Matrix inverse = Matrix::Identity(r, r);
  model.jumps.lower.triangularView<lower_triangle>().solveInPlace(inverse);
  stiffness_.noalias() = inverse.transpose() * inverse;
  for (Vector* v : {&rest_, &weight_, &solution_, &direction_, &image_, &right_}) v->setZero(r);
  directions_.resize(r, cheap_iterations);
  images_.resize(r, cheap_iterations);
  places_.clear();
  Index slope = 0;
  for (const Block& block : model.blocks) {
    for (int i = 0; i < block.batch.points; ++i)
      places_.push_back({block.first + i, block.batch.points, slope + i, block.batch.components});
    slope += block.slopes();
  }
}

/// k - D of the components a and c of a point.
double JumpDirection::slope(const Vector& slopes, const Place& at, int a, int c) const {
  const double k = slopes[at.slope + (a * at.components + c) * at.stride];
  return a == c && model_->shift.size() > 0 ? k - model_->shift[at.first + a * at.stride] : k;
}

/// Points whose slopes are not those of the factor, or all.
void JumpDirection::list_changes(const Vector& slopes, bool all) {
  changes_.clear();
  for (const Place& at : places_) {
    Change change{&at};
    bool any = false;
    for (int a = 0; a < at.components; ++a)
      for (int c = 0; c < at.components; ++c) {
        double& k = change.slope[a * at.components + c];
        k = slope(slopes, at, a, c) - (all ? 0 : slope(slopes_, at, a, c));
        any = any || k != 0;
      }
    if (any) changes_.push_back(change);
  }
}

void JumpDirection::sum() {
  matrix_ = stiffness_;
  for (const Place& at : places_)
    for (int a = 0; a < at.components; ++a)
      for (int c = 0; c < at.components; ++c)
        if (const double k = slope(slopes_, at, a, c); k != 0)
          add_product(model_->jumps.rows, at.first + a * at.stride, at.first + c * at.stride, k, symmetric_, matrix_);
  weight_ = matrix_.diagonal().cwiseAbs().cwiseMax(1e-300).cwiseInverse();
}

/// Cholesky's factor where no law softens and the slopes of no point are unsymmetric, as those of friction are.
void JumpDirection::factorise(const Vector& slopes) {
  slopes_ = slopes;
  symmetric_ = true;
  for (const Place& at : places_)
    for (int a = 0; a < at.components; ++a)
      for (int c = 0; c < a; ++c) symmetric_ = symmetric_ && slope(slopes_, at, a, c) == slope(slopes_, at, c, a);
  sum();
  if (symmetric_) {
    cholesky_.compute(matrix_);
    if (cholesky_->info() == Success) return;
    symmetric_ = false;
    sum();
  }
  lu_.compute(matrix_);
}

void JumpDirection::divide(const Vector& right, Vector& solution) const {
  if (symmetric_)
    cholesky_.solve(right, solution);
  else
    lu_.solve(right, solution);
}

/// result += (S - S of the factor) moved
void JumpDirection::add_changes(const Vector& moved, Vector& result) const {
  const SparseRows& rows = model_->jumps.rows;
  for (const Change& change : changes_) {
    const Place& at = *change.place;
    double opening[most_components];
    for (int c = 0; c < at.components; ++c) opening[c] = felt(rows, at.first + c * at.stride, moved);
    for (int a = 0; a < at.components; ++a) {
      double force = 0;
      for (int c = 0; c < at.components; ++c) force += change.slope[a * at.components + c] * opening[c];
      if (force != 0) pull_by(rows, at.first + a * at.stride, force, result);
    }
  }
}

double JumpDirection::size(const Vector& v) const {
  return std::sqrt(v.cwiseAbs2().dot(weight_));
}

/// Generalised conjugate residuals from nothing; false when the residual is not round-off after so many.
bool JumpDirection::iterate(int most) {
  solution_.setZero();
  rest_ = right_;
  const double none = round_off * size(rest_);
  for (int k = 0; k < most; ++k) {
    divide(rest_, direction_);
    image_ = rest_;
    add_changes(direction_, image_);
    for (int pass = 0; pass < 2; ++pass)
      for (int j = 0; j < k; ++j) {
        const double share = images_.col(j).cwiseProduct(weight_).dot(image_);
        image_ -= share * images_.col(j);
        direction_ -= share * directions_.col(j);
      }
    const double length = size(image_);
    if (!(length > 0) || !std::isfinite(length)) return false;
    images_.col(k) = image_ / length;
    directions_.col(k) = direction_ / length;
    const double step = images_.col(k).cwiseProduct(weight_).dot(rest_);
    rest_ -= step * images_.col(k);
    solution_ += step * directions_.col(k);
    if (size(rest_) <= none) return true;
  }
  return false;
}

/// With a new factor; false where that is not accurate.
bool JumpDirection::solve_anew(const Vector& slopes) {
  factorise(slopes);
  divide(right_, solution_);
  image_.noalias() = stiffness_ * solution_;
  list_changes(slopes, true);
  add_changes(solution_, image_);
  rest_ = right_ - image_;
  return size(rest_) <= accurate * size(right_);
}

bool JumpDirection::solve(const InterfaceProblem& problem, NewtonWork& work, InterfaceSystems& counts) {
  if (!work.slope.allFinite()) return false;
  if (problem.model->shift.size() == 0 && work.slope.isZero(0)) {  // all is open: without the round-off of L, z becomes zero at once
    work.direction = -work.gradient;
    return true;
  }
  begin(*problem.model);
  const auto lower = model_->jumps.lower.triangularView<lower_triangle>();
  right_ = -work.gradient;
  lower.transpose().solveInPlace(right_);
  if (valid_) list_changes(work.slope, false);
  const bool iterated = valid_ && iterate(changes_.empty() ? 1 : cheap_iterations);
  ++(iterated ? counts.iterated : counts.factored);
  if (!iterated) valid_ = solve_anew(work.slope);
  work.direction = solution_;
  lower.solveInPlace(work.direction);
  return valid_ && work.direction.allFinite();
}

}  // namespace uplift
