#include "uplift/contact/newton/newton.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/contact/newton/balance.h"
#include "uplift/contact/newton/fused.h"
#include "uplift/contact/newton/many.h"
#include "uplift/contact/newton/row_newton.h"
#include "uplift/contact/point_rows.h"
#include "uplift/math/line_search.h"
#include "uplift/math/small.h"

namespace uplift {
namespace {

/// One solve. R: number of coordinates where it is known beforehand (a rigid footing has up to three in the plane, six in space), so that
/// what goes over them is unrolled; else 0.
template <int R>
class Newton {
 public:
  Newton(const InterfaceProblem& problem, const AugmentedForce& augmented, const NewtonOptions& options, NewtonWork& work,
         InterfaceSolution& solution)
      : problem_(problem),
        model_(*problem.model),
        augmented_(augmented),
        options_(options),
        solution_(solution),
        work_(work),
        r_(R > 0 ? R : problem.model->factor.cols()),
        rows_(problem.model->factor.rows()) {}

  Outcome solve(int done);

 private:
  static constexpr Index most = R > 0 ? R : few;  // where H is formed
  Index r() const { return R > 0 ? R : r_; }
  const double* column(Index j) const { return model_.factor.data() + j * rows_; }
  const double* slope_of(std::size_t block) const { return work_.slope.data() + work_.first_slope[block]; }

  /// Sum over the coordinates.
  double dot(const Vector& a, const Vector& b) const {
    double sum = 0;
    for (Index i = 0; i < r(); ++i) sum += a.data()[i] * b.data()[i];
    return sum;
  }

  void predict();
  void add_lag(Lanes* total, double* of_points);
  void go_on();
  void look(bool with_hessian);
  void move(double alpha, bool with_hessian);
  void form_gradient(bool with_hessian);
  void add_block(const Block& block, const double* slope, double* g, double* h);
  template <int components>
  void add_point(const Block& block, const double* slope, double* g, double* h);
  void add_general(const Block& block, const double* slope, double* g, double* h);
  void take_back_shift(bool with_hessian);
  bool direction();
  bool direction_of_few(double* d) const;
  void line_search(double start_slope, double end_slope);
  void shorten(double before);

  const InterfaceProblem& problem_;
  const ContactModel& model_;
  const AugmentedForce& augmented_;
  const NewtonOptions& options_;
  InterfaceSolution& solution_;
  NewtonWork& work_;
  Index r_, rows_;
  double size_ = 0;  // |G| where it was looked at last
};

/// First guess of a step from the last one: the laws go on linearly from their end-of-step force with their slope there,
///     H_end z = -C^T (p_end + k_end (free_opening - from))
/// which is the solution itself where no law changes its branch (with a joint filter less scale area c d_f). Costs two sums over the points
/// instead of an evaluation of the laws.
template <int R>
void Newton<R>::predict() {
  Lanes total[most] = {};
  double of_points[most] = {};  // of blocks of one point
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    const Block& block = model_.blocks[b];
    const int n = block.batch.points, components = block.batch.components;
    const double *free = problem_.free_opening.data() + block.first, *from = problem_.from.data() + block.first;
    const double *end = solution_.end_traction.data() + block.first, *area = block.area.data(), *slope = slope_of(b);
    if (components == 1) {
      const double* columns = column(0) + block.first;
      const double scale = model_.scale;
      for_lanes(n, [=, this, &total](const auto& at) {
        const Lanes force = scale * at(area) * at(end) + at(slope) * (at(free) - at(from));
        for (Index j = 0; j < r(); ++j) total[j] += at(columns + j * rows_) * force;
      });
      continue;
    }
    if (n == 1) {
      for (int a = 0; a < components; ++a) {
        double force = model_.scale * area[0] * end[a];
        for (int c = 0; c < components; ++c) force += slope[a * components + c] * (free[c] - from[c]);
        for (Index j = 0; j < r(); ++j) of_points[j] += column(j)[block.first + a] * force;
      }
      continue;
    }
    for (int a = 0; a < components; ++a)
      for_lanes(n, [&](const auto& at) {
        Lanes force = model_.scale * at(area) * at(end + a * n);
        for (int c = 0; c < components; ++c) force += at(slope + (a * components + c) * n) * (at(free + c * n) - at(from + c * n));
        for (Index j = 0; j < r(); ++j) total[j] += at(column(j) + block.first + a * n) * force;
      });
  }
  if (problem_.filter.acts()) add_lag(total, of_points);
  for (Index j = 0; j < r(); ++j) work_.gradient[j] = of_points[j] + sum(total[j]);
  direction_of_few(solution_.z.data());
}

/// What the joint filter's memory pulls at the start of the step, -scale area c d_f.
template <int R>
void Newton<R>::add_lag(Lanes* total, double* of_points) {
  for (const Block& block : model_.blocks) {
    const double* area = block.area.data();
    if (block.batch.points == 1) {
      for (int row = block.first; row < block.first + block.batch.components; ++row) {
        const double force = model_.scale * area[0] * larger(problem_.filter.coefficient[row], 0.0) * problem_.filter.lag[row];
        for (Index j = 0; j < r(); ++j) of_points[j] -= column(j)[row] * force;
      }
      continue;
    }
    for (int a = 0; a < block.batch.components; ++a) {
      const int first = block.first + a * block.batch.points;
      const double *coefficient = problem_.filter.coefficient.data() + first, *lag = problem_.filter.lag.data() + first;
      for_lanes(block.batch.points, [&](const auto& at) {
        const Lanes force = model_.scale * at(area) * larger(at(coefficient), Lanes(0)) * at(lag);
        for (Index j = 0; j < r(); ++j) total[j] -= at(column(j) + first) * force;
      });
    }
  }
}

/// After a step that some law bent in: slopes and Hessian of the step to come, in which it goes on straight. A joint filter in contact
/// makes the slope larger by 1 + 2 b, which scale is smaller by.
template <int R>
void Newton<R>::go_on() {
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    const Block& block = model_.blocks[b];
    const int n = block.batch.points, components = block.batch.components;
    double* slope = work_.slope.data() + work_.first_slope[b];
    const double *next = solution_.next_slope.data() + work_.first_slope[b], *area = block.area.data();
    if (n == 1) {
      for (int c = 0; c < components * components; ++c) slope[c] = 2 * area[0] * next[c];
      continue;
    }
    for (int c = 0; c < components * components; ++c)
#pragma omp simd
      for (int i = 0; i < n; ++i) slope[c * n + i] = 2 * area[i] * next[c * n + i];
  }
  form_gradient(true);
}

/// Forces, G and |G| at solution.z, and the Hessian when wanted.
template <int R>
void Newton<R>::look(bool with_hessian) {
  evaluate(problem_, augmented_, true, work_, solution_);
  form_gradient(with_hessian);
}

/// Goes to origin + alpha * direction.
template <int R>
void Newton<R>::move(double alpha, bool with_hessian) {
  double* z = solution_.z.data();
  const double *origin = work_.origin.data(), *direction = work_.direction.data();
  for (Index i = 0; i < r(); ++i) z[i] = origin[i] + alpha * direction[i];
  look(with_hessian);
}

/// G (and H) at solution.z, the force having been evaluated.
template <int R>
void Newton<R>::form_gradient(bool with_hessian) {
  const bool forms = with_hessian && r() <= few;
  const double* z = solution_.z.data();
  if (forms) {
    double g[most], h[most * most];  // not in memory where their number is known
    for (Index j = 0; j < r(); ++j) {
      g[j] = z[j];
      for (Index i = 0; i < r(); ++i) h[j * r() + i] = i == j ? 1 : 0;
    }
    for (std::size_t b = 0; b < model_.blocks.size(); ++b) add_block(model_.blocks[b], slope_of(b), g, h);
    std::copy_n(g, r(), work_.gradient.data());
    std::copy_n(h, r() * r(), work_.hessian.data());
  } else {
    double* g = work_.gradient.data();
    for (Index i = 0; i < r(); ++i) g[i] = z[i];
    if (R == 0 && model_.jumps.given())
      model_.jumps.gather(solution_.force, work_.jump, work_.gradient);
    else
      small::add_transposed<R>(rows_, r(), column(0), rows_, solution_.force.data(), g);
  }
  if (model_.shift.size() > 0) take_back_shift(forms);
  size_ = std::sqrt(dot(work_.gradient, work_.gradient));
}

/// h += C_block^T k C_block and g += C_block^T p.
template <int R>
[[gnu::always_inline]] inline void Newton<R>::add_block(const Block& block, const double* slope, double* g, double* h) {
  if constexpr (R > 0)
    if (block.batch.components == 1)
      return small::gradient_and_gram<R>(block.batch.points, column(0) + block.first, rows_, solution_.force.data() + block.first, slope, g,
                                         h);
  if (block.batch.points == 1 && block.batch.components == 3) return add_point<3>(block, slope, g, h);
  if (block.batch.points == 1 && block.batch.components == 6) return add_point<6>(block, slope, g, h);
  add_general(block, slope, g, h);
}

/// The same for one point, under a whole foundation: products of small matrices, with the rows of C_block side by side.
template <int R>
template <int components>
void Newton<R>::add_point(const Block& block, const double* slope, double* g, double* h) {
  const double* force = solution_.force.data() + block.first;
  double row[components][most], pull[components][most];  // of C, of k C
  for (Index j = 0; j < r(); ++j) {
    const double* from = column(j) + block.first;
    for (int a = 0; a < components; ++a) row[a][j] = from[a];
  }
  for (int a = 0; a < components; ++a) {
    for (Index j = 0; j < r(); ++j) pull[a][j] = slope[a * components] * row[0][j];
    for (int b = 1; b < components; ++b)
      for (Index j = 0; j < r(); ++j) pull[a][j] += slope[a * components + b] * row[b][j];
    for (Index j = 0; j < r(); ++j) g[j] += row[a][j] * force[a];
  }
  for (Index j = 0; j < r(); ++j)
    for (int a = 0; a < components; ++a)
      for (Index i = 0; i < r(); ++i) h[j * r() + i] += row[a][i] * pull[a][j];
}

/// The same where the slope couples the components: k C_block column by column, and its products with every column.
template <int R>
void Newton<R>::add_general(const Block& block, const double* slope, double* g, double* h) {
  const int n = block.batch.points, components = block.batch.components, rows = block.rows();
  double* pull = work_.pull.data();
  for (Index j = 0; j < r(); ++j) {
    const double* right = column(j) + block.first;
    g[j] += small::dot(rows, right, solution_.force.data() + block.first);
    std::fill_n(pull, rows, 0.0);
    for (int a = 0; a < components; ++a)
      for (int b = 0; b < components; ++b) {
        const double *k = slope + (a * components + b) * n, *from = right + b * n;
        double* to = pull + a * n;
#pragma omp simd
        for (int p = 0; p < n; ++p) to[p] += k[p] * from[p];
      }
    for (Index i = 0; i < r(); ++i) h[j * r() + i] += small::dot(rows, column(i) + block.first, pull);
  }
}

/// Statics: the closed joint of the factored matrix is taken back.
template <int R>
void Newton<R>::take_back_shift(bool with_hessian) {
  for (Index j = 0; j < r(); ++j) {
    const double* own = column(j);
    for (Index i = 0; i < rows_; ++i) work_.gradient[j] -= own[i] * model_.shift[i] * solution_.opening[i];
    if (!with_hessian) continue;
    for (Index k = 0; k < r(); ++k) {
      const double* other = column(k);
      for (Index i = 0; i < rows_; ++i) work_.hessian(k, j) -= other[i] * model_.shift[i] * own[i];
    }
  }
}

/// The direction -H^-1 G; false when H is singular. A softening or friction slope may make H indefinite or unsymmetric: Gauss elimination
/// takes both.
template <int R>
bool Newton<R>::direction() {
  return r() > few ? direction_of_many(problem_, work_, solution_) : direction_of_few(work_.direction.data());
}

/// Writes it to d; nothing when H is singular.
template <int R>
bool Newton<R>::direction_of_few(double* d) const {
  double h[most * most], x[most];
  std::copy_n(work_.hessian.data(), r() * r(), h);
  for (Index i = 0; i < r(); ++i) x[i] = -work_.gradient.data()[i];
  if (!small::gauss_solve<R>(r(), h, x)) return false;
  for (Index i = 0; i < r(); ++i) d[i] = x[i];
  return true;
}

/// Follows origin + alpha * direction until the directional derivative has fallen enough; the last point is left evaluated, with its
/// Hessian.
template <int R>
void Newton<R>::line_search(double start_slope, double end_slope) {
  LineSearch search(-start_slope);
  for (double slope = end_slope; search.goes_on(-slope); slope = dot(work_.gradient, work_.direction)) move(search.share(), false);
  form_gradient(true);
}

/// Where friction or softening leave no potential: the step is shortened until the residual |G| falls; the last point is left evaluated,
/// with its Hessian.
template <int R>
void Newton<R>::shorten(double before) {
  double alpha = 1;
  for (int trial = 0; trial < 12; ++trial) {
    alpha *= 0.5;
    move(alpha, true);
    if (size_ <= (1 - 1e-3 * alpha) * before) break;
  }
}

template <int R>
Outcome Newton<R>::solve(int done) {
  Outcome outcome;
  int patience = patience_of_newton;
  constexpr int again = 25;  // when a large problem starts afresh: caught between two branches of a point, as friction can be
  // where an iteration is expensive, round-off counts as converged at once; sums over many columns have more of it
  const bool large = R == 0 && PointRows::suits(model_);
  const int enough = large ? 1 : patience;
  const double noise = large ? 8 * std::sqrt(static_cast<double>(r())) : 8;
  const bool predictable = model_.average && r() <= few && augmented_.multiplier == nullptr && model_.shift.size() == 0;
  if (predictable && work_.follows) predict();
  work_.follows = false;
  look(true);
  for (outcome.iterations = done; outcome.iterations < options_.most_iterations; ++outcome.iterations) {
    if (!std::isfinite(size_)) {
      outcome.why = why_not_finite(problem_, solution_);
      return outcome;
    }
    const double reference = balance_scale(problem_, work_, solution_);
    outcome.residual = size_ / std::max(reference, 1e-300);
    if (size_ <= options_.tolerance * reference || size_ == 0 ||
        (outcome.iterations >= enough && (!large || outcome.residual <= 1e-9) &&
         size_ <= noise * balance_round_off(problem_, work_, solution_))) {
      outcome.converged = true;
      work_.follows = predictable;
      work_.bent = false;
      if (predictable && outcome.iterations > 0) go_on();
      return outcome;
    }
    if (large && outcome.iterations == again) {
      patience += again;
      solution_.z.setZero();
      look(true);
    }
    const double before = size_;
    std::copy_n(solution_.z.data(), r(), work_.origin.data());
    // the gradient is needed again by the line search
    if (!direction()) {
      outcome.why = "the Newton matrix of the interface is singular";
      return outcome;
    }
    const double start_slope = dot(work_.gradient, work_.direction);
    move(1, true);
    if (size_ > 0.5 * before && size_ > options_.tolerance * reference) {
      const double end_slope = dot(work_.gradient, work_.direction);
      if (outcome.iterations >= patience) {
        if (size_ > before) shorten(before);
      } else if (start_slope < 0 && end_slope > 0.5 * std::abs(start_slope)) {
        line_search(start_slope, end_slope);
      }
    }
  }
  outcome.why = fmt::format("Newton's method did not converge in {} iterations (residual {:.2e} of the interface force)",
                            options_.most_iterations, outcome.residual);
  return outcome;
}

/// Many coordinates: by rows first where that suits.
Outcome solve_many(const InterfaceProblem& problem, const AugmentedForce& augmented, const NewtonOptions& options, NewtonWork& work,
                   InterfaceSolution& solution) {
  const RowNewton::Result by_rows = augmented.multiplier == nullptr ? solve_by_rows(problem, options, work, solution) : RowNewton::Result{};
  if (by_rows.converged) {
    Outcome outcome;
    outcome.converged = true;
    outcome.iterations = by_rows.iterations;
    outcome.residual = by_rows.residual;
    work.follows = false;
    return outcome;
  }
  Outcome outcome = Newton<0>(problem, augmented, options, work, solution).solve(by_rows.arrived ? by_rows.iterations : 0);
  if (!by_rows.arrived) outcome.iterations += by_rows.iterations;
  return outcome;
}

/// `done`: iterations that have led to the guess in solution.z.
Outcome solve_in_general(const InterfaceProblem& problem, const AugmentedForce& augmented, const NewtonOptions& options, int done,
                         NewtonWork& work, InterfaceSolution& solution) {
  switch (problem.model->factor.cols()) {
    case 1:
      return Newton<1>(problem, augmented, options, work, solution).solve(done);
    case 2:
      return Newton<2>(problem, augmented, options, work, solution).solve(done);
    case 3:
      return Newton<3>(problem, augmented, options, work, solution).solve(done);
    case 6:
      return Newton<6>(problem, augmented, options, work, solution).solve(done);
    default:
      return solve_many(problem, augmented, options, work, solution);
  }
}

}  // namespace

Outcome solve_by_newton(const InterfaceProblem& problem, const AugmentedForce& augmented, const NewtonOptions& options, NewtonWork& work,
                        InterfaceSolution& solution) {
  Outcome outcome;
  if (!may_sweep(problem, work, solution) || !solve_by_sweeps(problem, options, work, solution, outcome)) {
    size_newton(problem, work, solution);
    solution.fused = false;
    outcome = solve_in_general(problem, augmented, options, outcome.iterations, work, solution);
  }
  return outcome;
}

}  // namespace uplift
