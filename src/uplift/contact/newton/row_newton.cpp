#include "uplift/contact/newton/row_newton.h"

#include <algorithm>
#include <cmath>

#include "uplift/contact/newton/balance.h"
#include "uplift/contact/point_rows.h"
#include "uplift/math/columns.h"
#include "uplift/math/line_search.h"
#include "uplift/math/small.h"

namespace uplift {
namespace {

constexpr int most_iterations = 30, patience = 12;
constexpr double worth_a_factor = 4;  // iterations of a chord
constexpr double of_change = 8;       // a chord leaves about so many times the change of the slopes
constexpr double most_contraction = 0.5;
constexpr double price_of_reference = 10;    // factors of all rows: what points that slide gain does not last
constexpr int patience_with_candidate = 20;  // factors
constexpr int most_updates = 50;             // of a reference, before round-off is left behind
constexpr double negligible = 0.1;           // of what an iteration may leave: all that it takes as zero
constexpr double near_solution = 1e-3;       // of |z|: iterations from there on hardly add to what the directions left as round-off
constexpr double same_slope = 1e-10;         // of a slope: a smaller difference is round-off

double cubed(std::size_t rows) {
  const double n = static_cast<double>(rows);
  return n * n * n;
}

}  // namespace

bool RowNewton::suits(const ContactModel& model) {
  if (!PointRows::suits(model) || model.rows() > most_rows || model.solver != InterfaceSolver::automatic) return false;
  return model.shift.size() == 0 && std::ranges::all_of(model.blocks, [](const Block& block) { return block.law != nullptr; });
}

void RowNewton::begin(const InterfaceProblem& problem) {
  problem_ = &problem;
  const ContactModel& model = *problem.model;
  if (seen_.is(model)) return;
  seen_.take(model);
  const Index rows = model.rows();
  compliance_.setZero(whole_registers(rows), rows);
  compliance_.topRows(rows).noalias() = model.factor * model.factor.transpose();
  lu_.size(rows);
  reference_compliance_.setZero(compliance_.rows(), rows);
  valid_ = slow_ = follows_ = has_reference_ = from_reference_ = false;
  largest_ = 0;
  candidate_age_ = updates_ = 0;
  for (Vector* v : {&force_, &opening_, &rest_, &origin_force_, &origin_opening_, &opening_step_, &force_step_, &part_, &sum_, &from_,
                    &end_, &kept_, &product_, &apart_})
    v->setZero(rows);
  moved_.setZero(compliance_.rows());
  for (std::vector<Index>* each : {&rows_, &other_rows_, &bent_}) {
    each->clear();
    each->reserve(static_cast<std::size_t>(rows));
  }
  share_ = compliance_.diagonal().cwiseMax(0).cwiseSqrt();
  flexible_.setZero(rows);
  Index slopes = 0;
  for (const Block& block : model.blocks) {
    const Index n = block.batch.points;
    for (int c = 0; c < block.batch.components; ++c)
      flexible_.segment(block.first, n) =
          flexible_.segment(block.first, n).cwiseMax(compliance_.diagonal().segment(block.first + c * n, n));
    slopes += block.slopes();
  }
  for (Vector* v : {&none_, &reference_, &candidate_, &change_}) v->setZero(slopes);
}

/// Largest change of a point's slopes since the factor was made, as part of what its compliance and the slopes leave together.
double RowNewton::change_of_slopes(const Vector& slopes) const {
  Lanes worst = 0;
  Index first_slope = 0;
  for (const Block& block : problem_->model->blocks) {
    const Index n = block.batch.points, components = block.batch.components;
    for_lanes(n, [&](const auto& at) {
      Lanes change = 0, size = 0;
      for (Index k = 0; k < components * components; ++k) {
        const Lanes now = at(slopes.data() + first_slope + k * n), then = at(slopes_.data() + first_slope + k * n);
        change = larger(change, absolute(now - then));
        size = larger(size, absolute(then));
      }
      const Lanes flexible = at(flexible_.data() + block.first);
      worst = larger(worst, change * flexible / (1 + size * flexible));
    });
    first_slope += block.slopes();
  }
  return largest(worst);
}

/// The rows whose force has other slopes than in `from`, ascending.
void RowNewton::rows_apart(const Vector& slopes, const Vector& from, std::vector<Index>& rows) {
  rows.clear();
  double* apart = apart_.data();
  Index first_slope = 0;
  for (const Block& block : problem_->model->blocks) {
    const Index n = block.batch.points, components = block.batch.components;
    for (Index a = 0; a < components; ++a) {
      std::fill_n(apart, n, 0.0);
      for (Index c = 0; c < components; ++c) {
        const double *one = slopes.data() + first_slope + (a * components + c) * n,
                     *other = from.data() + first_slope + (a * components + c) * n;
#pragma omp simd
        for (Index i = 0; i < n; ++i) apart[i] = larger(apart[i], std::abs(one[i] - other[i]) - same_slope * std::abs(other[i]));
      }
      for (Index i = 0; i < n; ++i)
        if (apart[i] > 0) rows.push_back(block.first + a * n + i);
    }
    first_slope += block.slopes();
  }
}

/// The changes of the slopes of these rows with respect to their own openings, where they depend on no others; else false.
bool RowNewton::own_changes(const std::vector<Index>& rows) {
  Index first_slope = 0;
  for (const Block& block : problem_->model->blocks) {
    const Index n = block.batch.points, components = block.batch.components;
    for (Index a = 0; a < components; ++a)
      for (Index c = 0; c < components; ++c) {
        const auto slopes = change_.segment(first_slope + (a * components + c) * n, n);
        if (a == c)
          product_.segment(block.first + a * n, n) = slopes;
        else if (!slopes.isZero(0))
          return false;
      }
    first_slope += block.slopes();
  }
  for (std::size_t i = 0; i < rows.size(); ++i) part_[static_cast<Index>(i)] = product_[rows[i]];
  return true;
}

/// I + change * compliance, of these rows and columns.
void RowNewton::fill(const Matrix& compliance, const std::vector<Index>& rows) {
  const Index n = static_cast<Index>(rows.size());
  const bool own = own_changes(rows);
  for (Index j = 0; j < n; ++j) {
    const double* of_row = compliance.col(rows[static_cast<std::size_t>(j)]).data();
    double* column = lu_.column(j);
    if (own) {
      for (Index i = 0; i < n; ++i) column[i] = part_[i] * of_row[rows[static_cast<std::size_t>(i)]];
    } else {
      slope_product(change_, of_row, product_.data());
      for (Index i = 0; i < n; ++i) column[i] = product_[rows[static_cast<std::size_t>(i)]];
    }
    column[j] += 1;
  }
}

/// The compliance with other slopes, from that of the reference or of no slopes: with the changes q of the slopes, which are not zero in
/// the rows R alone,
///     (I + F0 q)^-1 F0 = F0 - F0_R (I + (q F0)_RR)^-1 (q F0)_R
void RowNewton::refer_to(const Vector& slopes) {
  if (updates_ == most_updates) has_reference_ = false;
  choose_rows(slopes);
  updates_ = from_reference_ ? updates_ + 1 : 0;
  if (!from_reference_) reference_compliance_ = compliance_;
  change_ = slopes - (from_reference_ ? reference_ : none_);
  fill(reference_compliance_, rows_);
  const Index n = static_cast<Index>(rows_.size());
  has_reference_ = lu_.factorise(n);
  if (!has_reference_) return;
  reference_ = slopes;
  chosen_.resize(reference_compliance_.rows(), n);
  images_.resize(n, reference_compliance_.cols());
  for (Index i = 0; i < n; ++i) chosen_.col(i) = reference_compliance_.col(rows_[static_cast<std::size_t>(i)]);
  for (Index j = 0; j < images_.cols(); ++j) {
    slope_product(change_, reference_compliance_.col(j).data(), product_.data());
    for (Index i = 0; i < n; ++i) images_(i, j) = product_[rows_[static_cast<std::size_t>(i)]];
  }
  lu_.solve(images_);
  reference_compliance_.noalias() -= chosen_ * images_;
}

/// Takes the candidate for the reference, and says so, when it would have spared its price since it is the candidate. `paid`: cube of the
/// rows of a factor without it.
bool RowNewton::look_for_reference(const Vector& slopes, double paid) {
  bool made = false;
  if (candidate_age_ > 0) {
    rows_apart(slopes, candidate_, other_rows_);
    spared_ += paid - cubed(other_rows_.size());
    const double all = static_cast<double>(compliance_.cols());
    made = spared_ > price_of_reference * all * all * all;
    if (made) refer_to(candidate_);
  }
  if (made || candidate_age_ == 0 || candidate_age_ > patience_with_candidate) {
    candidate_ = slopes;
    spared_ = 0;
    candidate_age_ = 0;
  }
  ++candidate_age_;
  return made;
}

/// The rows of a factor: those whose slopes are not 0, or not those of the reference where these are fewer.
void RowNewton::choose_rows(const Vector& slopes) {
  rows_apart(slopes, none_, rows_);
  from_reference_ = false;
  if (!has_reference_) return;
  rows_apart(slopes, reference_, other_rows_);
  from_reference_ = other_rows_.size() < rows_.size();
  if (from_reference_) rows_.swap(other_rows_);
}

/// I + (k - k0) F0 in the rows that need it, or I + k F.
bool RowNewton::factorise(const Vector& slopes) {
  valid_ = false;
  if (!slopes.allFinite()) return false;
  choose_rows(slopes);
  if (look_for_reference(slopes, cubed(rows_.size()))) choose_rows(slopes);
  slopes_ = slopes;
  change_ = slopes - (from_reference_ ? reference_ : none_);
  fill(from_reference_ ? reference_compliance_ : compliance_, rows_);
  valid_ = lu_.factorise(static_cast<Index>(rows_.size()));
  return valid_;
}

/// k times the changes of the openings.
void RowNewton::slope_product(const Vector& slopes, const double* moved, double* force) const {
  Index first_slope = 0;
  for (const Block& block : problem_->model->blocks) {
    const Index n = block.batch.points, components = block.batch.components;
    for (Index a = 0; a < components; ++a) {
      double* sum = force + block.first + a * n;
      const double* slope = slopes.data() + first_slope + a * components * n;
      std::fill_n(sum, n, 0.0);
      for (Index c = 0; c < components; ++c, slope += n) {
        const double* step = moved + block.first + c * n;
#pragma omp simd
        for (Index i = 0; i < n; ++i) sum[i] += slope[i] * step[i];
      }
    }
    first_slope += block.slopes();
  }
}

/// Newton's direction in openings and forces, or that of the chord.
bool RowNewton::direction(const Vector& slopes, InterfaceSystems& counts) {
  const double contraction = valid_ && !slow_ ? of_change * change_of_slopes(slopes) : 1;
  const bool keeps = contraction < most_contraction && std::log(std::max(aim_ / size_, 1e-300)) > worth_a_factor * std::log(contraction);
  ++(keeps ? counts.iterated : counts.factored);
  if (!keeps && !factorise(slopes)) return false;
  const Matrix& compliance = from_reference_ ? reference_compliance_ : compliance_;
  bent_.clear();
  const double least = negligible * aim_ / std::sqrt(static_cast<double>(rest_.size()));
  for (Index row = 0; row < rest_.size(); ++row)
    if (std::abs(rest_[row]) * share_[row] > least) bent_.push_back(row);
  moved_.setZero();
  add_columns_of(compliance, 1, bent_, rest_.data(), moved_.data());
  const Index n = static_cast<Index>(rows_.size());
  slope_product(change_, moved_.data(), product_.data());
  for (Index i = 0; i < n; ++i) part_[i] = -product_[rows_[static_cast<std::size_t>(i)]];
  lu_.solve(part_.data());
  force_step_ = rest_;
  sum_.setZero();
  for (Index i = 0; i < n; ++i) {
    const Index row = rows_[static_cast<std::size_t>(i)];
    sum_[row] = part_[i];
    force_step_[row] += part_[i];
  }
  add_columns_of(compliance, 1, rows_, sum_.data(), moved_.data());
  opening_step_ = -moved_.head(opening_step_.size());
  if (from_reference_) {
    slope_product(reference_, opening_step_.data(), product_.data());
    force_step_ += product_;
  }
  return opening_step_.allFinite();
}

/// How large s is where the laws have been evaluated.
void RowNewton::measure() {
  double sum = 0;
  for (Index row = 0; row < rest_.size(); ++row) sum += rest_[row] * rest_[row] * share_[row] * share_[row];
  size_ = std::sqrt(sum);
}

/// Goes to origin + alpha step: forces, openings, laws and s.
void RowNewton::look(double alpha, NewtonWork& work, InterfaceSolution& solution) {
  force_ = origin_force_ + alpha * force_step_;
  if (opens_anew_)
    opening_of(force_, opening_);
  else
    opening_ = origin_opening_ + alpha * opening_step_;
  solution.opening = opening_;
  evaluate_laws(*problem_, {}, true, work, solution);
  rest_ = solution.force - force_;
}

/// Where friction or softening leave no potential: the step is shortened until s falls.
void RowNewton::shorten(double before, NewtonWork& work, InterfaceSolution& solution) {
  constexpr int most_halvings = 12;
  double alpha = 1;
  for (int trial = 0; trial < most_halvings; ++trial) {
    alpha *= 0.5;
    look(alpha, work, solution);
    measure();
    if (size_ <= (1 - 1e-3 * alpha) * before) break;
  }
}

/// Openings of the forces, laws at them, and s.
void RowNewton::look_at_forces(NewtonWork& work, InterfaceSolution& solution) {
  opening_of(force_, opening_);
  solution.opening = opening_;
  evaluate_laws(*problem_, {}, true, work, solution);
  rest_ = solution.force - force_;
}

/// free opening - F P
void RowNewton::opening_of(const Vector& force, Vector& opening) {
  small::multiply_symmetric(compliance_, force.data(), product_.data());
  opening = problem_->free_opening - product_;
}

/// z = -C^T P
void RowNewton::coordinates_of(const Vector& force, Vector& z) {
  z.noalias() = problem_->model->factor.transpose() * force;
  z *= -1;
}

/// Whether the forces that the iteration has arrived at solve the problem: |G| = |C^T s| against the largest |z_j| (balance_scale). Without
/// reading all of C, what is not less than |G| is held against what is not more than the largest |z_j|: the sum of sqrt(F_ii) |s_i|, or
/// sqrt(s F s) with its round-off, against that coordinate which was the largest when all were known.
bool RowNewton::is_solution(double tolerance, NewtonWork& work, InterfaceSolution& solution, Result& result) {
  look_at_forces(work, solution);
  const Matrix& factor = problem_->model->factor;
  double scale = std::abs(factor.col(largest_).dot(force_)), size = share_.dot(rest_.cwiseAbs());
  if (!(size <= tolerance * scale)) {
    small::multiply_symmetric(compliance_, rest_.data(), product_.data());
    size = std::sqrt(std::max(0.0, rest_.dot(product_)) + 1e-13 * size * size);
  }
  if (!(size <= tolerance * scale)) {
    coordinates_of(force_, solution.z);
    solution.z.cwiseAbs().maxCoeff(&largest_);
    work.gradient.noalias() = factor.transpose() * rest_;
    size = work.gradient.norm();
    scale = balance_scale(*problem_, work, solution);
  }
  result.residual = size / std::max(scale, 1e-300);
  result.converged = size <= tolerance * scale;
  if (!result.converged && result.residual <= 1e-9) {
    const double noise = 8 * std::sqrt(static_cast<double>(factor.cols()));
    result.converged = size <= noise * balance_round_off(*problem_, work, solution);
  }
  return result.converged;
}

/// Iterations until s is round-off. In the first one s belongs to the tangents of the laws at another opening.
bool RowNewton::iterate(double tolerance, NewtonWork& work, InterfaceSolution& solution, Result& result) {
  measure();
  bool made_anew = false;
  for (int k = 0; k < most_iterations; ++k) {
    if (!std::isfinite(size_)) return false;
    const double reference = std::sqrt(std::max(0.0, force_.dot(problem_->free_opening - opening_)));  // |z|
    aim_ = 0.1 * tolerance * reference;
    if (k > 0 && size_ <= aim_) {
      if (is_solution(tolerance, work, solution, result)) return true;
      measure();
      if (size_ <= aim_) return true;
    }
    const double before = size_;
    if (!direction(work.slope, solution.systems)) return false;
    ++result.iterations;
    LineSearch search(k > 0 && k < patience ? -rest_.dot(opening_step_) : 0);  // G . d = s . dg
    origin_force_ = force_;
    origin_opening_ = opening_;
    opens_anew_ = !made_anew && size_ <= near_solution * reference;
    made_anew |= opens_anew_;
    do look(search.share(), work, solution);
    while (search.goes_on(-rest_.dot(opening_step_)));
    measure();
    if (k >= patience && size_ > before) shorten(before, work, solution);
    slow_ = size_ > 0.3 * before;
    if (size_ <= 1e-10 * reference && slow_) {  // round-off
      is_solution(tolerance, work, solution, result);
      return true;
    }
  }
  return false;
}

/// Where the points come to when they move on as in the last step, with the tangents of the laws there.
void RowNewton::guess(NewtonWork& work, InterfaceSolution& solution) {
  const InterfaceProblem& problem = *problem_;
  if (follows_ && (end_ - problem.from).cwiseAbs().maxCoeff() <= 1e-8 * (end_ - from_).cwiseAbs().maxCoeff())
    solution.opening = 2 * problem.from - from_;
  else if (problem.model->forces_suffice)
    opening_of(solution.force, solution.opening);
  else {
    solution.opening = problem.free_opening;
    solution.opening.noalias() += problem.model->factor * solution.z;
  }
  opening_ = solution.opening;
  evaluate_laws(problem, {}, true, work, solution);
  force_ = solution.force;
  opening_of(force_, origin_opening_);
  opening_step_ = origin_opening_ - opening_;
  slope_product(work.slope, opening_step_.data(), rest_.data());
  opening_ = origin_opening_;
}

RowNewton::Result RowNewton::solve(const InterfaceProblem& problem, double tolerance, NewtonWork& work, InterfaceSolution& solution) {
  Result result;
  begin(problem);
  if (!problem.free_opening.allFinite()) return result;
  const bool by_forces = problem.model->forces_suffice;
  kept_ = by_forces ? solution.force : solution.z;
  guess(work, solution);
  follows_ = result.arrived = iterate(tolerance, work, solution, result);
  if (result.arrived) {
    from_ = problem.from;
    end_ = opening_;
  } else {
    updates_ = most_updates;  // should round-off of the reference be the reason
  }
  if (by_forces && result.converged) return result;
  if (by_forces || result.arrived)
    coordinates_of(result.arrived ? force_ : kept_, solution.z);
  else
    solution.z = kept_;
  return result;
}

RowNewton::Result solve_by_rows(const InterfaceProblem& problem, const NewtonOptions& options, NewtonWork& work,
                                InterfaceSolution& solution) {
  if (!RowNewton::suits(*problem.model)) return {};
  if (work.rows == nullptr) work.rows = std::make_unique<RowNewton>();
  return static_cast<RowNewton&>(*work.rows).solve(problem, options.tolerance, work, solution);
}

}  // namespace uplift
