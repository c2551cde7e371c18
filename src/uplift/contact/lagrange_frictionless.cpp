#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/contact/lagrange.h"
#include "uplift/math/dense.h"

// Sequential quadratic programming in z. At the iterate z_k, with the gradient g of the potential (without multipliers) and a Hessian H = L
// L^T,
//     x = L^T (z - z_n)     z_n = z_k - H^-1 g     opening = opening(z_n) + C L^-T x
// turns the step into the kernel's problem. The constraints are linear, so that every iterate after the first is feasible, and so is every
// point of the line search between two of them. In statics H takes back the closed joint D of the open rows only: where a row is closed,
// its opening is zero and D does not act; this keeps H positive definite for a body that rests on contact alone.
namespace uplift {

std::vector<int> slope_offsets(const InterfaceProblem& problem) {
  std::vector<int> offsets{0};
  for (const Block& block : problem.blocks)
    offsets.push_back(offsets.back() + (block.law != nullptr ? block.batch.points * block.batch.components * block.batch.components : 0));
  return offsets;
}

void law_forces(const InterfaceProblem& problem, const std::vector<int>& first_slope, double* slope, InterfaceSolution& solution) {
  for (std::size_t b = 0; b < problem.blocks.size(); ++b) {
    const Block& block = problem.blocks[b];
    if (block.law == nullptr) continue;
    Batch batch = block.batch;
    batch.step = problem.step;
    Reply reply;
    reply.traction = solution.force.data() + block.first;
    reply.slope = slope != nullptr ? slope + first_slope[b] : nullptr;
    reply.now = solution.now.data() + block.first_history;
    const double *from = problem.from.data() + block.first, *to = solution.opening.data() + block.first;
    const double* old = problem.old.data() + block.first_history;
    if (problem.average)
      block.law->mean(batch, from, to, old, reply);
    else
      block.law->respond(batch, from, to, old, reply);
    const int n = batch.points;
    for (int i = 0; i < block.rows(); ++i) reply.traction[i] *= problem.scale * block.area[static_cast<std::size_t>(i % n)];
    for (int i = 0; slope != nullptr && i < block.rows() * batch.components; ++i)
      reply.slope[i] *= problem.scale * block.area[static_cast<std::size_t>(i % n)];
  }
}

void add_law_slopes(const InterfaceProblem& problem, const std::vector<int>& first_slope, const Vector& slope, bool convex,
                    Matrix& hessian) {
  for (std::size_t b = 0; b < problem.blocks.size(); ++b) {
    const Block& block = problem.blocks[b];
    if (block.law == nullptr) continue;
    const int n = block.batch.points, components = block.batch.components;
    for (int row = 0; row < components; ++row)
      for (int column = 0; column < components; ++column) {
        if (convex && row != column) continue;
        Vector k = slope.segment(first_slope[b] + (row * components + column) * n, n);
        if (convex) k = k.cwiseMax(0.0);
        hessian.noalias() += problem.factor.middleRows(block.first + row * n, n).transpose() * k.asDiagonal() *
                             problem.factor.middleRows(block.first + column * n, n);
      }
  }
}

namespace {

class Frictionless {
 public:
  Frictionless(const InterfaceProblem& problem, const LagrangeOptions& options, InterfaceSolution& solution)
      : problem_(problem), options_(options), solution_(solution), scratch_(solution.lagrange), offsets_(slope_offsets(problem)) {
    slope_.setZero(offsets_.back());
    scratch_.limit.setZero(problem.rows());
    scratch_.held.setZero(problem.rows());
    multiplier_.setZero(problem.rows());
    std::size_t point = 0;
    for (const Block& block : problem.blocks)
      for (int i = 0; i < block.batch.points; ++i, ++point) {
        if (block.cone == nullptr) continue;
        const int row = block.first + block.batch.normal() + i;
        scratch_.limit[row] = block.area[static_cast<std::size_t>(i)];
        if (solution.status[point] != Status::open) scratch_.held[row] = scratch_.limit[row];
      }
  }

  Outcome solve() {
    move_to(solution_.z);
    double before = std::numeric_limits<double>::infinity();
    for (outcome_.iterations = 1; outcome_.iterations <= options_.most_iterations; ++outcome_.iterations) {
      if (!gradient_.allFinite()) return fail("the interface forces are not finite");
      const Vector start = solution_.z;
      const double slope_before = quadratic_program();
      if (!outcome_.why.empty()) return outcome_;
      const bool full = outcome_.iterations == 1 || !search(start, slope_before);
      const double residual = balance();
      if (full && (residual <= options_.tolerance || (residual <= 1e-9 && residual > 0.5 * before))) return finish();
      before = full ? residual : std::numeric_limits<double>::infinity();
    }
    return fail(fmt::format("the balance did not fall below {:g} in {} iterations (now {:g})", options_.tolerance, options_.most_iterations,
                            balance()));
  }

 private:
  Outcome fail(std::string why) {
    outcome_.why = std::move(why);
    return outcome_;
  }

  void move_to(const Vector& z) {
    solution_.z = z;
    solution_.opening.noalias() = problem_.factor * solution_.z;
    solution_.opening += problem_.free_opening;
    law_forces(problem_, offsets_, slope_.data(), solution_);
    Vector force = solution_.force;
    for (const Block& block : problem_.blocks)
      if (block.cone != nullptr) force.segment(block.first, block.rows()).setZero();
    if (problem_.shift.size() > 0) force -= problem_.shift.cwiseProduct(solution_.opening);
    gradient_ = solution_.z + problem_.factor.transpose() * force;
  }

  /// Cholesky factor of H: with the true slopes, then with the shift kept on all rows, then with positive slopes only.
  void factorise() {
    for (int attempt = 0; attempt < 3; ++attempt) {
      Matrix hessian = Matrix::Identity(problem_.factor.cols(), problem_.factor.cols());
      add_law_slopes(problem_, offsets_, slope_, attempt == 2, hessian);
      hessian = (0.5 * (hessian + hessian.transpose())).eval();
      if (attempt == 0 && problem_.shift.size() > 0) {
        Vector taken = problem_.shift;
        for (Index i = 0; i < taken.size(); ++i)
          if (scratch_.held[i] > 0) taken[i] = 0;
        hessian.noalias() -= problem_.factor.transpose() * taken.asDiagonal() * problem_.factor;
      }
      lower_.compute(hessian);
      if (lower_.info() != Success) continue;
      const auto diagonal = lower_.matrixLLT().diagonal();
      if (attempt == 2 || diagonal.minCoeff() > 1e-6) return;  // H is the identity less a share of it: smaller is round-off
    }
  }

  /// One kernel problem; moves to its answer and returns the slope of the potential along the step at its beginning.
  double quadratic_program() {
    factorise();
    const Vector start = solution_.z;
    const Vector newton = start - lower_.solve(gradient_);
    const Matrix factor = lower_.matrixL().solve(problem_.factor.transpose()).transpose();
    const Vector target = problem_.free_opening + problem_.factor * newton;
    Vector x(factor.cols()), opening(problem_.rows());
    const Rows rows{problem_.rows(), factor.cols(),         problem_.rows(), factor.data(),
                    target.data(),   scratch_.limit.data(), nullptr,         options_.gap_tolerance};
    const KernelReply reply = solve_rows(rows, scratch_.held.data(), x.data(), opening.data(), multiplier_.data(), scratch_.kernel);
    outcome_.cycles += reply.cycles;
    if (!reply.solved()) {
      outcome_.why = kernel_failure(problem_, reply, 0);
      return 0;
    }
    const Vector end = newton + lower_.matrixU().solve(x);
    const double slope = gradient_.dot(end - start);
    move_to(end);
    return slope;
  }

  /// Goes back between the iterates when the potential rises beyond its minimum along the step. True when the full step was not taken.
  bool search(const Vector& start, double slope_before) {
    const Vector end = solution_.z, direction = end - start;
    double low = 0, high = 1, low_slope = slope_before, high_slope = gradient_.dot(direction);
    // near the solution both are round-off
    if (!(slope_before < 0) || high_slope <= 0.5 * std::abs(slope_before) || direction.norm() <= 1e-8 * end.norm()) return false;
    for (int trial = 0; trial < 40; ++trial) {
      double alpha = 0.5 * (low + high);
      if (high_slope > 0 && low_slope < 0)
        alpha = std::clamp(low - low_slope * (high - low) / (high_slope - low_slope), low + 0.1 * (high - low), high - 0.1 * (high - low));
      move_to(start + alpha * direction);
      const double here = gradient_.dot(direction);
      if (std::abs(here) <= 0.5 * std::abs(slope_before)) return true;
      (here < 0 ? low : high) = alpha;
      (here < 0 ? low_slope : high_slope) = here;
    }
    return true;
  }

  double balance() const {
    const Vector reaction = problem_.factor.transpose() * multiplier_;
    const double size = std::max({solution_.z.norm(), (gradient_ - solution_.z + reaction).norm(), reaction.norm()});
    return size > 0 ? (gradient_ + reaction).norm() / size : 0;
  }

  Outcome finish() {
    std::size_t point = 0;
    for (const Block& block : problem_.blocks) {
      if (block.cone != nullptr) solution_.force.segment(block.first, block.rows()) = multiplier_.segment(block.first, block.rows());
      for (int i = 0; i < block.batch.points; ++i, ++point)
        solution_.status[point] =
            block.cone != nullptr && scratch_.held[block.first + block.batch.normal() + i] > 0 ? Status::slip : Status::open;
    }
    outcome_.converged = true;
    outcome_.residual = yardstick(problem_, solution_);
    return outcome_;
  }

  const InterfaceProblem& problem_;
  const LagrangeOptions& options_;
  InterfaceSolution& solution_;
  LagrangeScratch& scratch_;
  std::vector<int> offsets_;
  Vector slope_, gradient_, multiplier_;
  Cholesky lower_;
  Outcome outcome_;
};

}  // namespace

Outcome solve_frictionless(const InterfaceProblem& problem, const LagrangeOptions& options, InterfaceSolution& solution) {
  return Frictionless(problem, options, solution).solve();
}

}  // namespace uplift
