#include "uplift/contact/newton_many.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "uplift/contact/lagrange.h"
#include "uplift/contact/updated_rows.h"

// With F = C C^T and the block-diagonal slopes k (the statics' -D among them)
//     H^-1 = I - C^T k (I + F k)^-1 C
// so that nothing of order r^2 m is formed: A = I + k^T F has one row per interface row, a point whose slopes change changes its own rows,
// and (I + F k)^-1 = A^-T goes on being used (updated_rows.h). Slopes that moved a little are left in A; one or two corrections with the
// true ones make up for it. Where rows are many more than coordinates, as under a rigid footing, H itself is formed.
namespace uplift {
namespace {

constexpr double little = 0.02;  // relative change of a slope that is left in A

class Direction final : public MethodWork {
 public:
  bool solve(const InterfaceProblem& problem, InterfaceSolution& solution) {
    if (problem.rows() > 2 * problem.factor.cols()) return solve_by_hessian(problem, solution);
    return solve_by_rows(problem, solution) || solve_by_hessian(problem, solution);
  }

 private:
  bool solve_by_hessian(const InterfaceProblem& problem, InterfaceSolution& solution) {
    const Index r = problem.factor.cols();
    hessian_.setIdentity(r, r);
    work_.resize(problem.rows(), r);
    const NewtonScratch& scratch = solution.newton;
    for (std::size_t b = 0; b < problem.blocks.size(); ++b) {
      const Block& block = problem.blocks[b];
      const int n = block.batch.points, components = block.batch.components;
      for (int row = 0; row < components; ++row)
        for (int column = 0; column < components; ++column)
          add_weighted_gram(problem, block.first + row * n, block.first + column * n,
                            ConstMap(scratch.slope.data() + scratch.first_slope[b] + (row * components + column) * n, n), work_, hessian_);
    }
    if (problem.shift.size() > 0) {
      taken_ = -problem.shift;
      add_weighted_gram(problem, 0, 0, ConstMap(taken_.data(), taken_.size()), work_, hessian_);
    }
    lu_.compute(hessian_);
    solution.newton.direction = lu_.solve(scratch.gradient);
    solution.newton.direction *= -1;
    return solution.newton.direction.allFinite();
  }

  bool solve_by_rows(const InterfaceProblem& problem, InterfaceSolution& solution) {
    prepare(problem, solution.newton.slope.size());
    const Vector& slope = solution.newton.slope;
    if (!slope.allFinite()) return false;
    slope_ = slope.data();
    if (update(problem, solution.newton) && correct(problem, solution)) return true;
    if (!factorise(problem, solution.newton)) return false;
    return correct(problem, solution);
  }

  void prepare(const InterfaceProblem& problem, Index slopes) {
    const Index rows = problem.rows();
    double mark = 0;
    for (Index i = 0; i < rows; ++i)
      mark += (1.0 + static_cast<double>(i)) * problem.factor(i, std::min(i, problem.factor.cols() - 1)) + problem.factor(i, 0);
    if (seen_ == problem.factor.data() && mark_ == mark && compliance_.rows() == rows && base_.size() == slopes) return;
    seen_ = problem.factor.data();
    mark_ = mark;
    valid_ = false;
    compliance_.resize(rows, rows);
    compliance_.noalias() = problem.factor * problem.factor.transpose();
    matrix_.size(rows);
    base_.setZero(slopes);
    for (Vector* v : {&taken_, &force_}) v->setZero(rows);
    for (Vector* v : {&rest_, &step_}) v->setZero(problem.factor.cols());
    changed_.reserve(static_cast<std::size_t>(rows));
  }

  /// Row of A: e_i + sum over c of k(c, component) F_c, k the point's slopes less D.
  void fill_row(const InterfaceProblem& problem, const Block& block, int first_slope, int point, int component, double* row) const {
    const int n = block.batch.points, components = block.batch.components;
    const Index i = block.first + component * n + point, rows = problem.rows();
    std::fill_n(row, rows, 0.0);
    row[i] = 1;
    for (int c = 0; c < components; ++c) {
      double k = slope_[first_slope + (c * components + component) * n + point];
      if (c == component && problem.shift.size() > 0) k -= problem.shift[i];
      if (k == 0) continue;
      const double* f = compliance_.col(block.first + c * n + point).data();
      for (Index j = 0; j < rows; ++j) row[j] += k * f[j];
    }
  }

  bool factorise(const InterfaceProblem& problem, const NewtonScratch& scratch) {
    for (std::size_t b = 0; b < problem.blocks.size(); ++b) {
      const Block& block = problem.blocks[b];
      for (int c = 0; c < block.batch.components; ++c)
        for (int i = 0; i < block.batch.points; ++i)
          fill_row(problem, block, scratch.first_slope[b], i, c, matrix_.base().col(block.first + c * block.batch.points + i).data());
    }
    base_ = scratch.slope;
    valid_ = matrix_.factorise();
    return valid_;
  }

  /// The factor that there is, with the rows of points whose slopes changed; false when a new one is better.
  bool update(const InterfaceProblem& problem, const NewtonScratch& scratch) {
    if (!valid_) return false;
    changed_.clear();
    Index rows = 0;
    for (std::size_t b = 0; b < problem.blocks.size(); ++b) {
      const Block& block = problem.blocks[b];
      const int n = block.batch.points, entries = block.batch.components * block.batch.components;
      for (int i = 0; i < n; ++i) {
        double size = 0, change = 0;
        for (int e = 0, at = scratch.first_slope[b] + i; e < entries; ++e, at += n)
          size = std::max(size, std::abs(base_[at])), change = std::max(change, std::abs(slope_[at] - base_[at]));
        if (change <= little * size) continue;
        changed_.push_back({static_cast<int>(b), i});
        rows += block.batch.components;
      }
    }
    if (rows > matrix_.most()) return false;
    matrix_.restore();
    for (const Changed& at : changed_) {
      const std::size_t b = static_cast<std::size_t>(at.block);
      const Block& block = problem.blocks[b];
      for (int c = 0; c < block.batch.components; ++c)
        fill_row(problem, block, scratch.first_slope[b], at.point, c, matrix_.change(block.first + c * block.batch.points + at.point));
    }
    return matrix_.prepare();
  }

  /// force = k taken, with the present slopes less D.
  void apply_slopes(const InterfaceProblem& problem, const NewtonScratch& scratch) {
    force_.setZero();
    for (std::size_t b = 0; b < problem.blocks.size(); ++b) {
      const Block& block = problem.blocks[b];
      const int n = block.batch.points, components = block.batch.components;
      for (int r = 0; r < components; ++r)
        for (int c = 0; c < components; ++c) {
          const double* k = slope_ + scratch.first_slope[b] + (r * components + c) * n;
          for (int i = 0; i < n; ++i) force_[block.first + r * n + i] += k[i] * taken_[block.first + c * n + i];
        }
    }
    if (problem.shift.size() > 0) force_ -= problem.shift.cwiseProduct(taken_);
  }

  /// d = -H^-1 G by corrections d <- d + H_0^-1 (-G - H d), H_0 that of the matrix.
  bool correct(const InterfaceProblem& problem, InterfaceSolution& solution) {
    NewtonScratch& scratch = solution.newton;
    Vector& direction = scratch.direction;
    const double size = scratch.gradient.norm();
    direction.setZero();
    rest_ = -scratch.gradient;
    double before = size;
    for (int pass = 0; pass < 8; ++pass) {
      taken_.noalias() = problem.factor * rest_;
      matrix_.solve_transposed(taken_);
      apply_slopes(problem, scratch);
      step_ = rest_;
      step_.noalias() -= problem.factor.transpose() * force_;
      direction += step_;
      // what is left: -G - d - C^T k C d
      taken_.noalias() = problem.factor * direction;
      apply_slopes(problem, scratch);
      rest_ = -scratch.gradient - direction;
      rest_.noalias() -= problem.factor.transpose() * force_;
      const double now = rest_.norm();
      if (!std::isfinite(now)) return false;
      if (now <= 1e-9 * size) return true;
      if (pass > 0 && now > 0.5 * before) return now <= 1e-6 * size;
      before = now;
    }
    return false;
  }

  struct Changed {
    int block = 0, point = 0;
  };
  const double* seen_ = nullptr;  // the factor that F belongs to, and its mark
  double mark_ = 0;
  bool valid_ = false;
  const double* slope_ = nullptr;
  Matrix hessian_, work_, compliance_;
  UpdatedRows matrix_;
  Vector base_, taken_, force_, rest_, step_;
  std::vector<Changed> changed_;
  PartialLu lu_;
};

}  // namespace

bool direction_of_many(const InterfaceProblem& problem, InterfaceSolution& solution) {
  std::unique_ptr<MethodWork>& kept = solution.newton.direction_of_many.work;
  if (kept == nullptr) kept = std::make_unique<Direction>();
  return static_cast<Direction&>(*kept).solve(problem, solution);
}

}  // namespace uplift
