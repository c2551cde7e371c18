#include "uplift/contact/newton_swept.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "uplift/math/small.h"

namespace uplift {
namespace {

/// All that a pass reads and writes.
Sweep lay_out(const InterfaceProblem& problem, InterfaceSolution& solution) {
  const Block& block = problem.blocks.front();
  NewtonScratch& scratch = solution.newton;
  return {.points = block.batch.points,
          .columns = problem.factor.cols(),
          .z = solution.z.data(),
          .factor = problem.factor.data(),
          .stride = problem.factor.rows(),
          .free = problem.free_opening.data(),
          .from = problem.from.data(),
          .old = problem.old.data(),
          .area = block.area.data(),
          .scale = problem.scale,
          .coefficient = problem.filter.acts() ? problem.filter.coefficient.data() : nullptr,
          .lag = problem.filter.lag.data(),
          .opening = solution.opening.data(),
          .force = solution.force.data(),
          .slope = scratch.slope.data(),
          .now = solution.now.data(),
          .end = scratch.end.data(),
          .next = scratch.next.data(),
          .pull = scratch.gradient.data(),
          .stiffness = scratch.hessian.data(),
          .end_pull = scratch.end_pull.data(),
          .plain = solution.plain.data(),
          .stored = &solution.stored};
}

/// x = -H^-1 x; false when H is singular. Without softening H is at least the identity, so that Cramer's rule may solve two equations.
template <int R>
[[gnu::always_inline]] inline bool descend(const double* hessian, double* x) {
  if constexpr (R == 2) {
    const double determinant = hessian[0] * hessian[3] - hessian[1] * hessian[2], inverse = -1 / determinant, first = x[0];
    x[0] = (hessian[3] * first - hessian[2] * x[1]) * inverse;
    x[1] = (hessian[0] * x[1] - hessian[1] * first) * inverse;
    return determinant > 0;
  } else {
    double h[R * R];
    std::copy_n(hessian, R * R, h);
    for (int j = 0; j < R; ++j) x[j] = -x[j];
    return small::gauss_solve<R>(R, h, x);
  }
}

/// C^T (scale area end), where the last step was not swept.
template <int R>
void pull_at_end(const Sweep& sweep) {
  Lanes pull[R] = {};
  for_lanes(sweep.points, [&](const auto& at) {
    const Lanes force = sweep.scale * at(sweep.area) * at(sweep.end);
    for (int j = 0; j < R; ++j) pull[j] += at(sweep.factor + j * sweep.stride) * force;
  });
  for (int j = 0; j < R; ++j) sweep.end_pull[j] = sum(pull[j]);
}

/// What the joint filter's memory adds to it, C^T (-scale area c d_f).
template <int R>
void add_lag(const Sweep& sweep) {
  Lanes pull[R] = {};
  for_lanes(sweep.points, [&](const auto& at) {
    const Lanes force = sweep.scale * at(sweep.area) * larger(at(sweep.coefficient), Lanes(0)) * at(sweep.lag);
    for (int j = 0; j < R; ++j) pull[j] += at(sweep.factor + j * sweep.stride) * force;
  });
  for (int j = 0; j < R; ++j) sweep.end_pull[j] -= sum(pull[j]);
}

/// The laws go on linearly from their force at the end of the last step with their slope there:
///     H z = -C^T (scale area (end - c d_f)) - (H - I) way        free_opening - from = C way
template <int R>
[[gnu::always_inline]] inline void guess(const Sweep& sweep, const double* way, double* z) {
  double x[R];
  for (int j = 0; j < R; ++j) {
    x[j] = sweep.end_pull[j] - way[j];
    for (int i = 0; i < R; ++i) x[j] += sweep.stiffness[i * R + j] * way[i];
  }
  if (descend<R>(sweep.stiffness, x)) std::copy_n(x, R, z);
}

/// After a step that the law bent in: H of the step to come, in which it goes on straight.
template <int R>
void go_on(const Sweep& sweep) {
  Lanes gram[R][R] = {};
  for_lanes(sweep.points, [&](const auto& at) {
    const Lanes slope = 2 * at(sweep.area) * at(sweep.next);  // see Newton::go_on
    for (int j = 0; j < R; ++j) {
      const Lanes weighted = slope * at(sweep.factor + j * sweep.stride);
      for (int i = j; i < R; ++i) gram[j][i] += weighted * at(sweep.factor + i * sweep.stride);
    }
  });
  for (int j = 0; j < R; ++j)
    for (int i = j; i < R; ++i) sweep.stiffness[j * R + i] = sweep.stiffness[i * R + j] = sum(gram[j][i]) + (i == j ? 1 : 0);
}

template <int R>
bool iterate(const InterfaceProblem& problem, const NewtonOptions& options, InterfaceSolution& solution, Outcome& outcome) {
  const InterfaceLaw& law = *problem.blocks.front().law;
  NewtonScratch& scratch = solution.newton;
  const Sweep& sweep = scratch.sweep;
  double* z = solution.z.data();
  if (scratch.follows) {
    if (!solution.swept) pull_at_end<R>(sweep);
    if (sweep.coefficient != nullptr) add_lag<R>(sweep);
    guess<R>(sweep, problem.way.data(), z);
  }
  scratch.follows = false;
  double before = std::numeric_limits<double>::infinity();
  const int most = std::min(patience_of_newton, options.most_iterations);
  for (outcome.iterations = 0; outcome.iterations < most; ++outcome.iterations) {
    solution.swept = law.sweep(sweep);
    if (!solution.swept) return false;
    double gradient[R], square = 0, reference = 0;  // the largest of |z| and |C^T p|
    for (int j = 0; j < R; ++j) {
      const double pull = sweep.pull[j];
      gradient[j] = z[j] + pull;
      sweep.stiffness[j * R + j] += 1;
      square += gradient[j] * gradient[j];
      reference = larger(reference, larger(absolute(z[j]), absolute(pull)));
    }
    const double size = std::sqrt(square);
    if (size <= options.tolerance * reference || size == 0) {
      outcome.converged = true;
      outcome.residual = size / larger(reference, 1e-300);
      if (outcome.iterations > 0) go_on<R>(sweep);
      scratch.follows = true;
      return true;
    }
    if (!(size <= 0.5 * before) || !descend<R>(sweep.stiffness, gradient)) return false;
    before = size;
    for (int j = 0; j < R; ++j) z[j] += gradient[j];
  }
  return false;
}

}  // namespace

bool may_sweep(const InterfaceProblem& problem, InterfaceSolution& solution) {
  const Sweep& sweep = solution.newton.sweep;
  if (problem.way.size() == 0) return false;
  if (sweep.z == solution.z.data() && sweep.stored == &solution.stored && sweep.free == problem.free_opening.data())
    return true;  // the same two as before
  if (!problem.average || problem.shift.size() > 0 || problem.blocks.size() != 1 || problem.blocks.front().batch.components != 1 ||
      problem.blocks.front().law == nullptr)
    return false;
  size_newton(problem, solution);
  solution.newton.sweep = lay_out(problem, solution);
  return true;
}

bool solve_by_sweeps(const InterfaceProblem& problem, const NewtonOptions& options, InterfaceSolution& solution, Outcome& outcome) {
  switch (problem.way.size()) {
    case 1:
      return iterate<1>(problem, options, solution, outcome);
    case 2:
      return iterate<2>(problem, options, solution, outcome);
    case 3:
      return iterate<3>(problem, options, solution, outcome);
    default:
      return false;
  }
}

}  // namespace uplift
