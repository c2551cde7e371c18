#include "uplift/contact/newton/fused.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "uplift/math/small.h"

namespace uplift {
namespace {

/// All that a pass reads and writes.
FusedEvaluation lay_out(const InterfaceProblem& problem, NewtonWork& work, InterfaceSolution& solution) {
  const ContactModel& model = *problem.model;
  const Block& block = model.blocks.front();
  return {.points = block.batch.points,
          .columns = model.factor.cols(),
          .z = solution.z.data(),
          .factor = model.factor.data(),
          .stride = model.factor.rows(),
          .free = problem.free_opening.data(),
          .from = problem.from.data(),
          .old = problem.old.data(),
          .area = block.area.data(),
          .scale = model.scale,
          .coefficient = problem.filter.acts() ? problem.filter.coefficient.data() : nullptr,
          .lag = problem.filter.lag.data(),
          .opening = solution.opening.data(),
          .force = solution.force.data(),
          .slope = work.slope.data(),
          .now = solution.now.data(),
          .end = solution.end_traction.data(),
          .next = solution.next_slope.data(),
          .pull = work.gradient.data(),
          .stiffness = work.hessian.data(),
          .end_pull = work.end_pull.data(),
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

/// C^T (scale area end), where the last step was not fused.
template <int R>
void pull_at_end(const FusedEvaluation& evaluation) {
  Lanes pull[R] = {};
  for_lanes(evaluation.points, [&](const auto& at) {
    const Lanes force = evaluation.scale * at(evaluation.area) * at(evaluation.end);
    for (int j = 0; j < R; ++j) pull[j] += at(evaluation.factor + j * evaluation.stride) * force;
  });
  for (int j = 0; j < R; ++j) evaluation.end_pull[j] = sum(pull[j]);
}

/// What the joint filter's memory pulls, one step later. `pole`: a of the scheme.
template <int R>
void advance_lag(double pole, FilterSums& sums) {
  for (int j = 0; j < R; ++j) {
    double pull = 0;
    for (int i = 0; i < R; ++i) pull += sums.stiffness[j * R + i] * sums.moved[i];
    sums.lag[j] = pole * sums.lag[j] + (1 - pole) * pull;
  }
}

/// The laws go on linearly from their force at the end of the last step with their slope there:
///     H z = -C^T (scale area (end - c d_f)) - (H - I) free_increment        free_opening - from = C free_increment
template <int R>
[[gnu::always_inline]] inline void guess(const FusedEvaluation& evaluation, const double* free_increment, double* z) {
  double x[R];
  for (int j = 0; j < R; ++j) {
    x[j] = evaluation.end_pull[j] - free_increment[j];
    for (int i = 0; i < R; ++i) x[j] += evaluation.stiffness[i * R + j] * free_increment[i];
  }
  if (descend<R>(evaluation.stiffness, x)) std::copy_n(x, R, z);
}

/// After a step that the law bent in: H of the step to come, in which it goes on straight, and with a joint filter its sums. Points in
/// contact then have the coefficient gain * 2 next, so that their part of H is that of the filter but for a factor.
template <int R, bool filters>
void go_on(const FusedEvaluation& evaluation, double gain, FilterSums& sums) {
  Lanes gram[R][R] = {}, open_gram[R][R] = {}, lag[R] = {};
  bool opens = false;
  for_lanes(evaluation.points, [&](const auto& at) {
    const Lanes next = at(evaluation.next);
    Lanes slope = 2 * at(evaluation.area) * next;  // see Newton::go_on
    if constexpr (filters) {
      const LaneMask open = at(evaluation.coefficient) < Lanes(0);
      if (any(open && next != Lanes(0))) {  // open at the start: the traction at the end where it dissipates
        opens = true;
        const Lanes at_end = choose(open, evaluation.scale * at(evaluation.area) * (next + larger(next, Lanes(0))), Lanes(0));
        for (int j = 0; j < R; ++j)
          for (int i = j; i < R; ++i)
            open_gram[j][i] += at_end * at(evaluation.factor + j * evaluation.stride) * at(evaluation.factor + i * evaluation.stride);
        slope = choose(open, Lanes(0), slope);
      }
    }
    for (int j = 0; j < R; ++j) {
      const Lanes weighted = slope * at(evaluation.factor + j * evaluation.stride);
      for (int i = j; i < R; ++i) gram[j][i] += weighted * at(evaluation.factor + i * evaluation.stride);
      if constexpr (filters) lag[j] += weighted * at(evaluation.lag);
    }
  });
  const double of_filter = evaluation.scale * gain;
  for (int j = 0; j < R; ++j) {
    for (int i = j; i < R; ++i) {
      double entry = sum(gram[j][i]);
      if constexpr (filters) {
        sums.stiffness[j * R + i] = sums.stiffness[i * R + j] = of_filter * entry;
        if (opens) entry += sum(open_gram[j][i]);
      }
      evaluation.stiffness[j * R + i] = evaluation.stiffness[i * R + j] = entry + (i == j ? 1 : 0);
    }
    if constexpr (filters) sums.lag[j] = of_filter * sum(lag[j]);
  }
}

/// The first guess of a step that follows the last one.
template <int R, bool filters>
[[gnu::always_inline]] inline void predict(const InterfaceProblem& problem, bool fused, NewtonWork& work, double* z) {
  const FusedEvaluation& evaluation = work.evaluation;
  if (!fused) pull_at_end<R>(evaluation);
  if (work.bent || (filters && !fused))
    go_on<R, filters>(evaluation, problem.filter.gain, work.filter);
  else if (filters)
    advance_lag<R>(problem.filter.pole, work.filter);
  if constexpr (filters)
    for (int j = 0; j < R; ++j) evaluation.end_pull[j] -= work.filter.lag[j];
  guess<R>(evaluation, problem.free_opening_increment.data(), z);
}

template <int R>
bool iterate(const InterfaceProblem& problem, const NewtonOptions& options, NewtonWork& work, InterfaceSolution& solution,
             Outcome& outcome) {
  const InterfaceLaw& law = *problem.model->blocks.front().law;
  const FusedEvaluation& evaluation = work.evaluation;
  double* z = solution.z.data();
  const bool filters = evaluation.coefficient != nullptr;
  const double* free_increment = problem.free_opening_increment.data();
  if (work.follows) filters ? predict<R, true>(problem, solution.fused, work, z) : predict<R, false>(problem, solution.fused, work, z);
  work.follows = false;
  double before = std::numeric_limits<double>::infinity();
  const int most = std::min(patience_of_newton, options.most_iterations);
  for (outcome.iterations = 0; outcome.iterations < most; ++outcome.iterations) {
    solution.fused = law.fused(evaluation);
    if (!solution.fused) return false;
    double gradient[R], square = 0, reference = 0;  // the largest of |z| and |C^T p|
    for (int j = 0; j < R; ++j) {
      const double pull = evaluation.pull[j];
      gradient[j] = z[j] + pull;
      evaluation.stiffness[j * R + j] += 1;
      square += gradient[j] * gradient[j];
      reference = larger(reference, larger(absolute(z[j]), absolute(pull)));
    }
    const double size = std::sqrt(square);
    if (size <= options.tolerance * reference || size == 0) {
      outcome.converged = true;
      outcome.residual = size / larger(reference, 1e-300);
      work.bent = outcome.iterations > 0;
      if (filters)
        for (int j = 0; j < R; ++j) work.filter.moved[j] = free_increment[j] + z[j];
      work.follows = true;
      return true;
    }
    if (!(size <= 0.5 * before) || !descend<R>(evaluation.stiffness, gradient)) return false;
    before = size;
    for (int j = 0; j < R; ++j) z[j] += gradient[j];
  }
  return false;
}

}  // namespace

bool may_sweep(const InterfaceProblem& problem, NewtonWork& work, InterfaceSolution& solution) {
  const FusedEvaluation& evaluation = work.evaluation;
  if (problem.free_opening_increment.size() == 0) return false;
  const ContactModel& model = *problem.model;
  if (work.model.is(model) && evaluation.z == solution.z.data() && evaluation.stored == &solution.stored &&
      evaluation.free == problem.free_opening.data())
    return true;  // the same two as before
  if (!model.average || model.shift.size() > 0 || model.blocks.size() != 1 || model.blocks.front().batch.components != 1 ||
      model.blocks.front().law == nullptr)
    return false;
  size_newton(problem, work, solution);
  work.evaluation = lay_out(problem, work, solution);
  return true;
}

bool solve_by_sweeps(const InterfaceProblem& problem, const NewtonOptions& options, NewtonWork& work, InterfaceSolution& solution,
                     Outcome& outcome) {
  switch (problem.free_opening_increment.size()) {
    case 1:
      return iterate<1>(problem, options, work, solution, outcome);
    case 2:
      return iterate<2>(problem, options, work, solution, outcome);
    case 3:
      return iterate<3>(problem, options, work, solution, outcome);
    default:
      return false;
  }
}

}  // namespace uplift
