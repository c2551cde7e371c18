#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/contact/kernel/kernel.h"
#include "uplift/contact/lagrange/failures.h"
#include "uplift/contact/lagrange/lagrange.h"
#include "uplift/contact/lagrange/laws.h"
#include "uplift/math/dense.h"

// Sequential quadratic programming in z. At the iterate z_k, with the gradient g of the potential (without multipliers) and a Hessian H = L
// L^T,
//     x = L^T (z - z_n)     z_n = z_k - H^-1 g     opening = opening(z_n) + C L^-T x
// turns the step into the kernel's problem. The constraints are linear, so that every iterate after the first is feasible, and so is every
// point of the line search between two of them. In statics H takes back the closed joint D of the open rows only: where a row is closed,
// its opening is zero and D does not act; this keeps H positive definite for a body that rests on contact alone.
namespace uplift {
namespace {

class Frictionless final : public MethodWork {
 public:
  Outcome solve(const InterfaceProblem& problem, const LagrangeOptions& options, InterfaceSolution& solution) {
    problem_ = &problem, options_ = &options, solution_ = &solution;
    outcome_ = Outcome();
    prepare();
    return iterate();
  }

 private:
  void prepare() {
    const Index rows = problem_->rows(), r = problem_->model->factor.cols();
    slope_offsets(*problem_->model, offsets_);
    slope_.setZero(offsets_.back());
    for (Vector* v : {&limit_, &held_, &multiplier_, &opening_, &target_, &force_, &taken_}) v->setZero(rows);
    for (Vector* v : {&start_, &newton_, &direction_, &reaction_, &x_, &end_}) v->setZero(r);
    work_.resize(rows, r);
    factor_.resize(rows, r);
    half_.resize(r, rows);
    hessian_.resize(r, r);
    std::size_t point = 0;
    for (const Block& block : problem_->model->blocks)
      for (int i = 0; i < block.batch.points; ++i, ++point) {
        if (block.cone == nullptr) continue;
        const int row = block.normal_row() + i;
        limit_[row] = block.area[static_cast<std::size_t>(i)];
        if (solution_->status[point] != Status::open) held_[row] = limit_[row];
      }
  }

  Outcome iterate() {
    move_to(solution_->z);
    double before = std::numeric_limits<double>::infinity();
    for (outcome_.iterations = 1; outcome_.iterations <= options_->most_iterations; ++outcome_.iterations) {
      if (!gradient_.allFinite()) return fail("the interface forces are not finite");
      start_ = solution_->z;
      const double slope_before = quadratic_program();
      if (!outcome_.why.empty()) return outcome_;
      const bool full = outcome_.iterations == 1 || !search(slope_before);
      const double residual = balance();
      if (full && settled(residual, before, options_->tolerance)) return finish();
      before = full ? residual : std::numeric_limits<double>::infinity();
    }
    return fail(fmt::format("the balance did not fall below {:g} in {} iterations (now {:g})", options_->tolerance,
                            options_->most_iterations, balance()));
  }

  Outcome fail(std::string why) {
    outcome_.why = std::move(why);
    return outcome_;
  }

  /// `z` may be the solution's own.
  void move_to(const Vector& z) {
    solution_->z = z;
    solution_->opening = problem_->free_opening;
    solution_->opening.noalias() += problem_->model->factor * solution_->z;
    law_forces(*problem_, offsets_, slope_.data(), *solution_);
    force_ = solution_->force;
    for (const Block& block : problem_->model->blocks)
      if (block.cone != nullptr) force_.segment(block.first, block.rows()).setZero();
    if (problem_->model->shift.size() > 0) force_ -= problem_->model->shift.cwiseProduct(solution_->opening);
    gradient_ = solution_->z;
    gradient_.noalias() += problem_->model->factor.transpose() * force_;
  }

  /// Cholesky factor of H: with the true slopes, then with the shift kept on all rows, then with positive slopes only.
  void factorise() {
    for (int attempt = 0; attempt < 3; ++attempt) {
      hessian_.setIdentity();
      add_law_slopes(*problem_->model, offsets_, slope_, attempt == 2, work_, hessian_);
      for (Index j = 0; j < hessian_.cols(); ++j)
        for (Index i = 0; i < j; ++i) hessian_(i, j) = hessian_(j, i) = 0.5 * (hessian_(i, j) + hessian_(j, i));
      if (attempt == 0 && problem_->model->shift.size() > 0) {
        for (Index i = 0; i < taken_.size(); ++i) taken_[i] = held_[i] > 0 ? 0 : -problem_->model->shift[i];
        add_weighted_gram(*problem_->model, 0, 0, ConstMap(taken_.data(), taken_.size()), work_, hessian_);
      }
      lower_.compute(hessian_);
      if (lower_->info() != Success) continue;
      const auto diagonal = lower_->matrixLLT().diagonal();
      if (attempt == 2 || diagonal.minCoeff() > 1e-6) return;  // H is the identity less a share of it: smaller is round-off
    }
  }

  /// One kernel problem; moves to its answer and returns the slope of the potential along the step at its beginning.
  double quadratic_program() {
    factorise();
    lower_.solve(gradient_, newton_);
    newton_ = start_ - newton_;
    half_ = problem_->model->factor.transpose();
    lower_->matrixL().solveInPlace(half_);
    factor_ = half_.transpose();
    target_ = problem_->free_opening;
    target_.noalias() += problem_->model->factor * newton_;
    const Rows rows{problem_->rows(), factor_.cols(), problem_->rows(), factor_.data(),
                    target_.data(),   limit_.data(),  nullptr,          options_->gap_of(*problem_->model)};
    const KernelReply reply = solve_rows(rows, held_.data(), x_.data(), opening_.data(), multiplier_.data(), kernel_);
    outcome_.cycles += reply.cycles;
    if (!reply.solved()) {
      outcome_.why = kernel_failure(*problem_->model, reply, 0);
      return 0;
    }
    lower_->matrixU().solveInPlace(x_);
    end_ = newton_ + x_;
    direction_ = end_ - start_;
    const double slope = gradient_.dot(direction_);
    move_to(end_);
    return slope;
  }

  /// Goes back between the iterates when the potential rises beyond its minimum along the step. True when the full step was not taken.
  bool search(double slope_before) {
    double low = 0, high = 1, low_slope = slope_before, high_slope = gradient_.dot(direction_);
    // near the solution both are round-off
    if (!(slope_before < 0) || high_slope <= 0.5 * std::abs(slope_before) || direction_.norm() <= 1e-8 * end_.norm()) return false;
    for (int trial = 0; trial < 40; ++trial) {
      double alpha = 0.5 * (low + high);
      if (high_slope > 0 && low_slope < 0)
        alpha = std::clamp(low - low_slope * (high - low) / (high_slope - low_slope), low + 0.1 * (high - low), high - 0.1 * (high - low));
      end_ = start_ + alpha * direction_;
      move_to(end_);
      const double here = gradient_.dot(direction_);
      if (std::abs(here) <= 0.5 * std::abs(slope_before)) return true;
      (here < 0 ? low : high) = alpha;
      (here < 0 ? low_slope : high_slope) = here;
    }
    return true;
  }

  double balance() {
    reaction_.noalias() = problem_->model->factor.transpose() * multiplier_;
    newton_ = gradient_ + reaction_;
    const double size = std::max({solution_->z.norm(), (newton_ - solution_->z).norm(), reaction_.norm()});
    return size > 0 ? newton_.norm() / size : 0;
  }

  Outcome finish() {
    std::size_t point = 0;
    for (const Block& block : problem_->model->blocks) {
      if (block.cone != nullptr) solution_->force.segment(block.first, block.rows()) = multiplier_.segment(block.first, block.rows());
      for (int i = 0; i < block.batch.points; ++i, ++point)
        solution_->status[point] = block.cone != nullptr && held_[block.normal_row() + i] > 0 ? Status::slip : Status::open;
    }
    outcome_.converged = true;
    outcome_.residual = contact_residual(*problem_, *solution_, residual_);
    return outcome_;
  }

  const InterfaceProblem* problem_ = nullptr;
  const LagrangeOptions* options_ = nullptr;
  InterfaceSolution* solution_ = nullptr;
  std::vector<int> offsets_;
  KernelScratch kernel_;
  ResidualScratch residual_;
  Vector limit_, held_;  // rows: area of the normal rows of cones, and the same where they are closed
  Vector slope_, gradient_, multiplier_, opening_, target_, force_, taken_;
  Vector start_, newton_, direction_, reaction_, x_, end_;
  Matrix work_, factor_, half_, hessian_;
  Cholesky lower_;
  Outcome outcome_;
};

}  // namespace

Outcome solve_frictionless(const InterfaceProblem& problem, const LagrangeOptions& options, std::unique_ptr<MethodWork>& work,
                           InterfaceSolution& solution) {
  if (work == nullptr) work = std::make_unique<Frictionless>();
  return static_cast<Frictionless&>(*work).solve(problem, options, solution);
}

}  // namespace uplift
