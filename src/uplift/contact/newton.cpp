#include "uplift/contact/newton.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "uplift/contact/newton_many.h"
#include "uplift/contact/point_rows.h"
#include "uplift/math/small.h"

namespace uplift {
namespace {

void size_scratch(const InterfaceProblem& problem, InterfaceSolution& solution) {
  NewtonScratch& scratch = solution.newton;
  const Eigen::Index rows = problem.rows(), r = problem.factor.cols();
  if (scratch.first_slope.size() == problem.blocks.size() && solution.opening.size() == rows && scratch.gradient.size() == r &&
      solution.now.size() == problem.old.size())
    return;
  scratch.first_slope.clear();
  int slopes = 0;
  for (const Block& block : problem.blocks) {
    scratch.first_slope.push_back(slopes);
    slopes += block.batch.points * block.batch.components * block.batch.components;
  }
  scratch.slope.setZero(slopes);
  scratch.gradient.setZero(r);
  scratch.direction.setZero(r);
  scratch.origin.setZero(r);
  if (r <= few) scratch.hessian.setZero(r, r);
  scratch.end.setZero(rows);
  solution.opening.setZero(rows);
  solution.force.setZero(rows);
  if (solution.z.size() != r) solution.z.setZero(r);
  solution.now.assign(problem.old.size(), 0.0);
}

/// P(multiplier + stiffness * opening) of a cone block.
void cone_force(const InterfaceProblem& problem, const Block& block, const AugmentedForce& augmented, double* slope,
                InterfaceSolution& solution) {
  const int n = block.batch.points, components = block.batch.components, normal = block.batch.normal();
  double* force = solution.force.data() + block.first;
  const double* multiplier = augmented.multiplier->data() + block.first;
  const double* stiffness = augmented.stiffness->data() + block.first;
  const double* opening = solution.opening.data() + block.first;
  const double* from = problem.from.data() + block.first;
  for (int i = 0; i < n * components; ++i) force[i] = multiplier[i] + stiffness[i] * (i >= normal ? opening[i] : opening[i] - from[i]);
  block.cone->project(block.batch, force, force, slope);
  if (slope == nullptr) return;
  for (int r = 0; r < components; ++r)
    for (int c = 0; c < components; ++c)
      for (int i = 0; i < n; ++i) slope[(r * components + c) * n + i] *= stiffness[c * n + i];
}

/// H += C_block^T k C_block for a block whose slope couples its components, and G += C_block^T p.
void add_general(const InterfaceProblem& problem, const Block& block, const double* slope, InterfaceSolution& solution) {
  NewtonScratch& scratch = solution.newton;
  const int n = block.batch.points, components = block.batch.components;
  const Eigen::Index r = problem.factor.cols(), rows = problem.factor.rows();
  for (Eigen::Index j = 0; j < r; ++j) {
    const double* column_j = problem.factor.data() + j * rows + block.first;
    scratch.gradient[j] += small::dot(block.rows(), column_j, solution.force.data() + block.first);
    for (Eigen::Index i = 0; i < r; ++i) {
      const double* column_i = problem.factor.data() + i * rows + block.first;
      double sum = 0;
      for (int a = 0; a < components; ++a)
        for (int b = 0; b < components; ++b) {
          const double* k = slope + (a * components + b) * n;
          const double *left = column_i + a * n, *right = column_j + b * n;
#pragma omp simd reduction(+ : sum)
          for (int p = 0; p < n; ++p) sum += left[p] * k[p] * right[p];
        }
      scratch.hessian(i, j) += sum;
    }
  }
}

void add_block(const InterfaceProblem& problem, const Block& block, const double* slope, InterfaceSolution& solution) {
  NewtonScratch& scratch = solution.newton;
  const Eigen::Index r = problem.factor.cols(), rows = problem.factor.rows();
  const double* c = problem.factor.data() + block.first;
  const double* p = solution.force.data() + block.first;
  double *g = scratch.gradient.data(), *h = scratch.hessian.data();
  if (block.batch.components == 1 && r == 1)
    small::gradient_and_gram<1>(block.batch.points, c, rows, p, slope, g, h);
  else if (block.batch.components == 1 && r == 2)
    small::gradient_and_gram<2>(block.batch.points, c, rows, p, slope, g, h);
  else if (block.batch.components == 1 && r == 3)
    small::gradient_and_gram<3>(block.batch.points, c, rows, p, slope, g, h);
  else
    add_general(problem, block, slope, solution);
}

/// G (and H) at solution.z, the force having been evaluated.
void form_gradient(const InterfaceProblem& problem, bool with_hessian, InterfaceSolution& solution) {
  NewtonScratch& scratch = solution.newton;
  const Eigen::Index r = problem.factor.cols(), rows = problem.rows();
  for (Eigen::Index i = 0; i < r; ++i) scratch.gradient[i] = solution.z[i];
  if (r > few) with_hessian = false;
  if (!with_hessian) {
    small::multiply_transposed_add(problem.factor, solution.force.data(), scratch.gradient.data());
  } else {
    std::fill_n(scratch.hessian.data(), r * r, 0.0);
    for (Eigen::Index i = 0; i < r; ++i) scratch.hessian(i, i) = 1;
    for (std::size_t b = 0; b < problem.blocks.size(); ++b)
      add_block(problem, problem.blocks[b], scratch.slope.data() + scratch.first_slope[b], solution);
  }
  if (problem.shift.size() == 0) return;
  for (Eigen::Index j = 0; j < r; ++j) {  // statics: the closed joint of the factored matrix is taken back
    const double* column = problem.factor.data() + j * rows;
    for (Eigen::Index i = 0; i < rows; ++i) scratch.gradient[j] -= column[i] * problem.shift[i] * solution.opening[i];
    if (!with_hessian) continue;
    for (Eigen::Index k = 0; k < r; ++k) {
      const double* other = problem.factor.data() + k * rows;
      for (Eigen::Index i = 0; i < rows; ++i) scratch.hessian(k, j) -= other[i] * problem.shift[i] * column[i];
    }
  }
}

/// The direction -H^-1 G; false when H is singular. A softening or friction slope may make H indefinite or unsymmetric: Gauss elimination
/// takes both.
bool newton_direction(const InterfaceProblem& problem, InterfaceSolution& solution) {
  NewtonScratch& scratch = solution.newton;
  const Eigen::Index r = scratch.gradient.size();
  if (r > few) return direction_of_many(problem, solution);
  for (Eigen::Index i = 0; i < r; ++i) scratch.direction[i] = -scratch.gradient[i];
  return small::gauss_solve(r, scratch.hessian.data(), scratch.direction.data());
}

/// First guess of a step from the last one: the laws go on linearly from their end-of-step force with their last slope,
///     H_last z = -C^T (p_end + k_last (free_opening - from))
/// which is the solution itself where no law changes its branch. Costs two sums over the points instead of an evaluation of the laws.
void predict(const InterfaceProblem& problem, InterfaceSolution& solution) {
  NewtonScratch& scratch = solution.newton;
  const Eigen::Index r = problem.factor.cols(), rows = problem.rows();
  std::fill_n(scratch.gradient.data(), r, 0.0);
  for (std::size_t b = 0; b < problem.blocks.size(); ++b) {
    const Block& block = problem.blocks[b];
    const int n = block.batch.points, components = block.batch.components;
    const double* k = scratch.slope.data() + scratch.first_slope[b];
    const double *free = problem.free_opening.data() + block.first, *from = problem.from.data() + block.first;
    const double *end = scratch.end.data() + block.first, *area = block.area.data();
    double* force = solution.force.data() + block.first;
    const double scale = problem.scale;
    if (components == 1 && r == 2) {  // a footing that cannot slide: one pass
      const double *left = problem.factor.data() + block.first, *right = left + rows;
      double sum_left = 0, sum_right = 0;
#pragma omp simd reduction(+ : sum_left, sum_right)
      for (int i = 0; i < n; ++i) {
        const double value = scale * area[i] * end[i] + k[i] * (free[i] - from[i]);
        sum_left += left[i] * value;
        sum_right += right[i] * value;
      }
      scratch.gradient[0] += sum_left;
      scratch.gradient[1] += sum_right;
      continue;
    }
    for (int a = 0; a < components; ++a) {
#pragma omp simd
      for (int i = 0; i < n; ++i) force[a * n + i] = scale * area[i] * end[a * n + i];
      for (int c = 0; c < components; ++c)
#pragma omp simd
        for (int i = 0; i < n; ++i) force[a * n + i] += k[(a * components + c) * n + i] * (free[c * n + i] - from[c * n + i]);
    }
    for (Eigen::Index j = 0; j < r; ++j)
      scratch.gradient[j] += small::dot(block.rows(), problem.factor.data() + j * rows + block.first, force);
  }
  for (Eigen::Index i = 0; i < r; ++i) scratch.direction[i] = -scratch.gradient[i];
  if (small::gauss_solve(r, scratch.hessian.data(), scratch.direction.data())) std::copy_n(scratch.direction.data(), r, solution.z.data());
}

double norm(const Vector& v) {
  return std::sqrt(small::sum_of_squares(v.size(), v.data()));
}

/// Follows z = origin + alpha * direction by bisection on the directional derivative until it has fallen enough; the last point is left
/// evaluated.
void line_search(const InterfaceProblem& problem, const AugmentedForce& augmented, double start_slope, double end_slope,
                 InterfaceSolution& solution) {
  NewtonScratch& scratch = solution.newton;
  double low = 0, high = 1, low_slope = start_slope, high_slope = end_slope;
  for (int trial = 0; trial < 30; ++trial) {
    double alpha = 0.5 * (low + high);
    if (high_slope > 0 && low_slope < 0) {  // regula falsi, kept away from the ends
      const double secant = low - low_slope * (high - low) / (high_slope - low_slope);
      alpha = std::clamp(secant, low + 0.1 * (high - low), high - 0.1 * (high - low));
    }
    for (Eigen::Index i = 0; i < solution.z.size(); ++i) solution.z[i] = scratch.origin[i] + alpha * scratch.direction[i];
    evaluate(problem, augmented, true, solution);
    form_gradient(problem, false, solution);
    const double slope = small::dot(scratch.gradient.size(), scratch.gradient.data(), scratch.direction.data());
    if (std::abs(slope) <= 0.5 * std::abs(start_slope)) return;
    (slope < 0 ? low : high) = alpha;
    (slope < 0 ? low_slope : high_slope) = slope;
  }
}

/// Where friction or softening leave no potential: the step is shortened until the residual |G| falls; the last point is left evaluated,
/// with its Hessian.
double shorten(const InterfaceProblem& problem, const AugmentedForce& augmented, double before, InterfaceSolution& solution) {
  NewtonScratch& scratch = solution.newton;
  double alpha = 1, size = before;
  for (int trial = 0; trial < 12; ++trial) {
    alpha *= 0.5;
    for (Eigen::Index i = 0; i < solution.z.size(); ++i) solution.z[i] = scratch.origin[i] + alpha * scratch.direction[i];
    evaluate(problem, augmented, true, solution);
    form_gradient(problem, true, solution);
    size = norm(scratch.gradient);
    if (size <= (1 - 1e-3 * alpha) * before) break;
  }
  return size;
}

/// Size of G that round-off in the openings alone makes: stiff joints magnify it.
double round_off(const InterfaceProblem& problem, const InterfaceSolution& solution) {
  const NewtonScratch& scratch = solution.newton;
  double sum = 0;
  for (Eigen::Index j = 0; j < problem.factor.cols(); ++j) {
    double component = std::abs(solution.z[j]);
    for (std::size_t b = 0; b < problem.blocks.size(); ++b) {
      const Block& block = problem.blocks[b];
      const int n = block.batch.points, components = block.batch.components;
      for (int c = 0; c < components; ++c)
        for (int i = 0; i < n; ++i) {
          const Eigen::Index row = block.first + c * n + i;
          const double slope = std::abs(scratch.slope[scratch.first_slope[b] + (c * components + c) * n + i]);
          const double moved = std::abs(problem.free_opening[row]) + std::abs(solution.opening[row] - problem.free_opening[row]);
          component += std::abs(problem.factor(row, j)) * (slope * moved + std::abs(solution.force[row]));
        }
    }
    sum += component * component;
  }
  return std::numeric_limits<double>::epsilon() * std::sqrt(sum);
}

/// What the balance is measured against: the largest of |z| and |C^T p|. In dynamics C^T p = G - z; in statics the closed joint is taken
/// back in G.
double balance_scale(const InterfaceProblem& problem, InterfaceSolution& solution) {
  NewtonScratch& scratch = solution.newton;
  const Eigen::Index r = scratch.gradient.size();
  double scale = 0;
  if (problem.shift.size() > 0) {
    scratch.direction.setZero();
    small::multiply_transposed_add(problem.factor, solution.force.data(), scratch.direction.data());
    for (Eigen::Index i = 0; i < r; ++i) scale = std::max(scale, std::abs(scratch.direction[i]));
  }
  for (Eigen::Index i = 0; i < r; ++i) {
    scale = std::max(scale, std::abs(solution.z[i]));
    if (problem.shift.size() == 0) scale = std::max(scale, std::abs(scratch.gradient[i] - solution.z[i]));
  }
  return scale;
}

}  // namespace

void evaluate(const InterfaceProblem& problem, const AugmentedForce& augmented, bool with_slope, InterfaceSolution& solution) {
  size_scratch(problem, solution);
  small::affine(problem.factor, problem.free_opening.data(), solution.z.data(), solution.opening.data());
  for (std::size_t b = 0; b < problem.blocks.size(); ++b) {
    const Block& block = problem.blocks[b];
    double* slope = with_slope ? solution.newton.slope.data() + solution.newton.first_slope[b] : nullptr;
    if (block.law != nullptr)
      law_force(problem, block, solution.opening.data(),
                {solution.force.data() + block.first, slope, solution.now.data() + block.first_history,
                 problem.average ? solution.newton.end.data() + block.first : nullptr});
    else
      cone_force(problem, block, augmented, slope, solution);
  }
}

Outcome solve_by_newton(const InterfaceProblem& problem, const AugmentedForce& augmented, const NewtonOptions& options,
                        InterfaceSolution& solution) {
  size_scratch(problem, solution);
  NewtonScratch& scratch = solution.newton;
  Outcome outcome;
  int patience = 12;         // iterations after which the search turns from the potential to the residual
  constexpr int again = 25;  // when a large problem starts afresh: caught between two branches of a point, as friction can be
  // where an iteration is expensive, round-off counts as converged at once; sums over many columns have more of it
  const bool large = PointRows::suits(problem);
  const int enough = large ? 1 : patience;
  const double noise = large ? 8 * std::sqrt(static_cast<double>(problem.factor.cols())) : 8;
  const Eigen::Index r = problem.factor.cols();
  const bool predictable = problem.average && r <= few && augmented.multiplier == nullptr;
  if (predictable && scratch.follows) predict(problem, solution);
  scratch.follows = false;
  evaluate(problem, augmented, true, solution);
  form_gradient(problem, true, solution);
  double size = norm(scratch.gradient);
  for (outcome.iterations = 0; outcome.iterations < options.most_iterations; ++outcome.iterations) {
    if (!std::isfinite(size)) {
      outcome.why = "the interface forces are not finite";
      return outcome;
    }
    const double reference = balance_scale(problem, solution);
    outcome.residual = size / std::max(reference, 1e-300);
    if (size <= options.tolerance * reference || size == 0 ||
        (outcome.iterations >= enough && (!large || outcome.residual <= 1e-9) && size <= noise * round_off(problem, solution))) {
      outcome.converged = true;
      scratch.follows = predictable;
      return outcome;
    }
    if (large && outcome.iterations == again) {
      patience += again;
      solution.z.setZero();
      evaluate(problem, augmented, true, solution);
      form_gradient(problem, true, solution);
      size = norm(scratch.gradient);
    }
    const double before = size;
    std::copy_n(solution.z.data(), r, scratch.origin.data());
    // the gradient is needed again by the line search
    if (!newton_direction(problem, solution)) {
      outcome.why = "the Newton matrix of the interface is singular";
      return outcome;
    }
    const double start_slope = small::dot(r, scratch.gradient.data(), scratch.direction.data());
    for (Eigen::Index i = 0; i < r; ++i) solution.z[i] = scratch.origin[i] + scratch.direction[i];
    evaluate(problem, augmented, true, solution);
    form_gradient(problem, true, solution);
    size = norm(scratch.gradient);
    if (size > 0.5 * before && size > options.tolerance * reference) {
      const double end_slope = small::dot(r, scratch.gradient.data(), scratch.direction.data());
      if (outcome.iterations >= patience) {
        if (size > before) size = shorten(problem, augmented, before, solution);
      } else if (start_slope < 0 && end_slope > 0.5 * std::abs(start_slope)) {
        line_search(problem, augmented, start_slope, end_slope, solution);
        form_gradient(problem, true, solution);
        size = norm(scratch.gradient);
      }
    }
  }
  outcome.why = fmt::format("Newton's method did not converge in {} iterations (residual {:.2e} of the interface force)",
                            options.most_iterations, outcome.residual);
  return outcome;
}

}  // namespace uplift
