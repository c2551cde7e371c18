#include "uplift/contact/newton/row_newton.h"

#include <algorithm>
#include <cmath>

#include "uplift/contact/point_rows.h"
#include "uplift/math/line_search.h"
#include "uplift/math/small.h"

namespace uplift {
namespace {

constexpr int most_iterations = 30, patience = 12;
constexpr double worth_a_factor = 4;  // iterations of a chord
constexpr double of_change = 8;       // a chord leaves about so many times the change of the slopes
constexpr double most_contraction = 0.5;
constexpr double price_of_reference = 10;    // factors of all rows
constexpr int patience_with_candidate = 20;  // factors
constexpr double same_slope = 1e-10;         // of a slope: a smaller difference is round-off

double cubed(const std::vector<Index>& rows) {
  const double n = static_cast<double>(rows.size());
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
  compliance_.resize(rows, rows);
  compliance_.noalias() = model.factor * model.factor.transpose();
  lu_.size(rows);
  reference_compliance_.resize(rows, rows);
  valid_ = slow_ = follows_ = has_reference_ = from_reference_ = false;
  candidate_age_ = 0;
  for (Vector* v : {&force_, &opening_, &rest_, &moved_, &origin_force_, &origin_opening_, &opening_step_, &force_step_, &part_, &sum_,
                    &from_, &end_, &kept_})
    v->setZero(rows);
  for (std::vector<Index>* each : {&rows_, &other_rows_}) {
    each->clear();
    each->reserve(static_cast<std::size_t>(rows));
  }
  owner_.assign(static_cast<std::size_t>(rows), 0);
  places_.clear();
  Index slope = 0;
  for (const Block& block : model.blocks) {
    for (int i = 0; i < block.batch.points; ++i)
      places_.push_back({block.first + i, block.batch.points, slope + i, block.batch.components});
    for (int row = 0; row < block.rows(); ++row)
      owner_[static_cast<std::size_t>(block.first + row)] =
          places_.size() - static_cast<std::size_t>(block.batch.points - row % block.batch.points);
    slope += block.slopes();
  }
  for (Vector* v : {&none_, &reference_, &candidate_, &change_}) v->setZero(slope);
}

/// Largest change of a point's slopes since the factor was made, as part of what its compliance and the slopes leave together.
double RowNewton::change_of_slopes(const Vector& slopes) const {
  double worst = 0;
  for (const Place& at : places_) {
    double change = 0, size = 0, flexible = 0;
    for (int k = 0; k < at.components * at.components; ++k) {
      const double now = slopes[at.slope + k * at.stride], then = slopes_[at.slope + k * at.stride];
      change = std::max(change, std::abs(now - then));
      size = std::max(size, std::abs(then));
    }
    if (change == 0) continue;
    for (int c = 0; c < at.components; ++c) flexible = std::max(flexible, compliance_(at.first + c * at.stride, at.first + c * at.stride));
    worst = std::max(worst, change * flexible / (1 + size * flexible));
  }
  return worst;
}

/// The rows whose opening has other slopes than in `from`.
void RowNewton::rows_apart(const Vector& slopes, const Vector& from, std::vector<Index>& rows) const {
  rows.clear();
  const Index all = compliance_.rows();
  for (Index row = 0; row < all; ++row) {
    const Place& at = places_[owner_[static_cast<std::size_t>(row)]];
    const Index c = (row - at.first) / at.stride;
    bool apart = false;
    for (int a = 0; a < at.components; ++a) {
      const Index k = at.slope + (a * at.components + c) * at.stride;
      apart = apart || std::abs(slopes[k] - from[k]) > same_slope * std::abs(from[k]);
    }
    if (apart) rows.push_back(row);
  }
}

/// The columns `rows` of I + F change, without the other rows.
void RowNewton::fill(const Vector& change, const Matrix& compliance, const std::vector<Index>& rows) {
  const Index all = compliance.rows(), n = static_cast<Index>(rows.size());
  double* sum = sum_.data();
  for (Index j = 0; j < n; ++j) {
    const Index row = rows[static_cast<std::size_t>(j)];
    const Place& at = places_[owner_[static_cast<std::size_t>(row)]];
    const Index c = (row - at.first) / at.stride;
    sum_.setZero();
    for (int a = 0; a < at.components; ++a)
      if (const double k = change[at.slope + (a * at.components + c) * at.stride]; k != 0)
        small::add(all, k, compliance.col(at.first + a * at.stride).data(), sum);
    double* column = lu_.column(j);
    for (Index i = 0; i < n; ++i) column[i] = sum[rows[static_cast<std::size_t>(i)]];
    column[j] += 1;
  }
}

/// F0 = (I + F k0)^-1 F of the slopes k0.
void RowNewton::refer_to(const Vector& slopes) {
  rows_apart(slopes, none_, rows_);
  fill(slopes, compliance_, rows_);
  const Index n = static_cast<Index>(rows_.size());
  has_reference_ = lu_.factorise(n);
  if (!has_reference_) return;
  reference_ = slopes;
  for (Index j = 0; j < compliance_.cols(); ++j) {  // F0 = F (I - k0 X), (I + F k0) X = F in the rows of k0
    for (Index i = 0; i < n; ++i) part_[i] = compliance_(rows_[static_cast<std::size_t>(i)], j);
    lu_.solve(part_.data());
    sum_.setZero();
    for (Index i = 0; i < n; ++i) sum_[rows_[static_cast<std::size_t>(i)]] = -part_[i];
    slope_product(slopes, sum_, sum_);
    sum_[j] += 1;
    reference_compliance_.col(j).noalias() = compliance_ * sum_;
  }
}

/// Takes the candidate for the reference, and says so, when it would have spared its price since it is the candidate. `paid`: cube of the
/// rows of a factor without it.
bool RowNewton::look_for_reference(const Vector& slopes, double paid) {
  bool made = false;
  if (candidate_age_ > 0) {
    rows_apart(slopes, candidate_, other_rows_);
    spared_ += paid - cubed(other_rows_);
    const double all = static_cast<double>(compliance_.rows());
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

/// I + F k in the rows that k needs, or I + F0 (k - k0).
bool RowNewton::factorise(const Vector& slopes) {
  valid_ = false;
  if (!slopes.allFinite()) return false;
  choose_rows(slopes);
  if (look_for_reference(slopes, cubed(rows_))) choose_rows(slopes);
  slopes_ = slopes;
  change_ = slopes - (from_reference_ ? reference_ : none_);
  fill(change_, from_reference_ ? reference_compliance_ : compliance_, rows_);
  valid_ = lu_.factorise(static_cast<Index>(rows_.size()));
  return valid_;
}

/// k times the changes of the openings; both may be the same vector.
void RowNewton::slope_product(const Vector& slopes, const Vector& moved, Vector& force) const {
  for (const Place& at : places_) {
    double step[most_components];
    for (int c = 0; c < at.components; ++c) step[c] = moved[at.first + c * at.stride];
    for (int a = 0; a < at.components; ++a) {
      double sum = 0;
      for (int c = 0; c < at.components; ++c) sum += slopes[at.slope + (a * at.components + c) * at.stride] * step[c];
      force[at.first + a * at.stride] = sum;
    }
  }
}

/// Newton's direction in openings and forces, or that of the chord.
bool RowNewton::direction(const Vector& slopes, InterfaceSystems& counts) {
  const double contraction = valid_ && !slow_ ? of_change * change_of_slopes(slopes) : 1;
  const bool keeps = contraction < most_contraction && std::log(std::max(aim_ / size_, 1e-300)) > worth_a_factor * std::log(contraction);
  ++(keeps ? counts.iterated : counts.factored);
  if (!keeps && !factorise(slopes)) return false;
  const Index n = static_cast<Index>(rows_.size());
  if (from_reference_) opening_step_.noalias() = reference_compliance_ * rest_;
  const Vector& moved = from_reference_ ? opening_step_ : moved_;  // F0 s
  for (Index i = 0; i < n; ++i) part_[i] = -moved[rows_[static_cast<std::size_t>(i)]];
  lu_.solve(part_.data());
  sum_.setZero();
  for (Index i = 0; i < n; ++i) sum_[rows_[static_cast<std::size_t>(i)]] = part_[i];
  slope_product(change_, sum_, sum_);
  force_step_ = rest_ + sum_;
  if (from_reference_) {
    opening_step_.noalias() = reference_compliance_ * force_step_;
    slope_product(reference_, opening_step_, sum_);
    force_step_ -= sum_;
  }
  opening_step_.noalias() = compliance_ * force_step_;
  opening_step_ *= -1;
  return opening_step_.allFinite();
}

/// s, F s and |G| where the laws have been evaluated.
void RowNewton::measure() {
  moved_.noalias() = compliance_ * rest_;
  size_ = std::sqrt(std::max(0.0, rest_.dot(moved_)));
}

/// Goes to origin + alpha step: forces, openings, laws and s.
void RowNewton::look(double alpha, NewtonWork& work, InterfaceSolution& solution) {
  force_ = origin_force_ + alpha * force_step_;
  opening_ = origin_opening_ + alpha * opening_step_;
  solution.opening = opening_;
  evaluate_laws(*problem_, {}, true, work, solution);
  rest_ = solution.force - force_;
}

/// Iterations until s is round-off. In the first one s belongs to the tangents of the laws at another opening.
bool RowNewton::arrive(double tolerance, NewtonWork& work, InterfaceSolution& solution, int& iterations) {
  measure();
  for (int k = 0; k < most_iterations; ++k) {
    if (!std::isfinite(size_)) return false;
    const double reference = std::sqrt(std::max(0.0, force_.dot(problem_->free_opening - opening_)));  // |z|
    if (k > 0 && size_ <= tolerance * reference) return true;
    const double before = size_;
    aim_ = tolerance * reference;
    if (!direction(work.slope, solution.systems)) return false;
    ++iterations;
    LineSearch search(k > 0 && k < patience ? -rest_.dot(opening_step_) : 0);  // G . d = s . dg
    origin_force_ = force_;
    origin_opening_ = opening_;
    do look(search.share(), work, solution);
    while (search.goes_on(-rest_.dot(opening_step_)));
    measure();
    slow_ = size_ > 0.3 * before;
    if (size_ <= 1e-10 * reference && slow_) return true;  // round-off
  }
  return false;
}

/// Where the points come to when they move on as in the last step, with the tangents of the laws there.
void RowNewton::guess(NewtonWork& work, InterfaceSolution& solution) {
  const InterfaceProblem& problem = *problem_;
  if (follows_ && (end_ - problem.from).cwiseAbs().maxCoeff() <= 1e-8 * (end_ - from_).cwiseAbs().maxCoeff())
    solution.opening = 2 * problem.from - from_;
  else {
    solution.opening = problem.free_opening;
    solution.opening.noalias() += problem.model->factor * solution.z;
  }
  opening_ = solution.opening;
  evaluate_laws(problem, {}, true, work, solution);
  force_ = solution.force;
  origin_opening_.noalias() = compliance_ * force_;
  origin_opening_ = problem.free_opening - origin_opening_;
  opening_step_ = origin_opening_ - opening_;
  slope_product(work.slope, opening_step_, rest_);
  opening_ = origin_opening_;
}

RowNewton::Result RowNewton::solve(const InterfaceProblem& problem, double tolerance, NewtonWork& work, InterfaceSolution& solution) {
  Result result;
  begin(problem);
  kept_ = solution.z;
  if (!problem.free_opening.allFinite()) return result;
  guess(work, solution);
  follows_ = result.arrived = arrive(0.1 * tolerance, work, solution, result.iterations);
  if (result.arrived) {
    solution.z.noalias() = problem.model->factor.transpose() * solution.force;
    solution.z *= -1;
    from_ = problem.from;
    end_ = opening_;
  } else {
    solution.z = kept_;
  }
  return result;
}

RowNewton::Result solve_by_rows(const InterfaceProblem& problem, const NewtonOptions& options, NewtonWork& work,
                                InterfaceSolution& solution) {
  if (!RowNewton::suits(*problem.model)) return {};
  if (work.rows == nullptr) work.rows = std::make_unique<RowNewton>();
  return static_cast<RowNewton&>(*work.rows).solve(problem, options.tolerance, work, solution);
}

}  // namespace uplift
