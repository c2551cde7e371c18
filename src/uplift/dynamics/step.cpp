#include "uplift/dynamics/step.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "uplift/contact/unheld.h"
#include "uplift/math/small.h"

namespace uplift {
namespace {

/// A step that has taken so many is given up, whatever halvings are left: it would take minutes, and seldom arrives.
constexpr long most_iterations_of_a_step = 8000;

/// Two halvings first, before a step keeps forces of its beginning that create energy.
constexpr double smallest_share = 0.3;

/// Of the forces at the beginning of a step: each at least halves what a point keeps, or leaves nothing of it.
constexpr int most_reductions = 60;

/// Exchanges without copies what every march changes in a step; the rest is the same in both where it is not exchanged too.
void exchange(State& now, State& next) {
  std::swap(now.time, next.time);
  now.displacement.swap(next.displacement), now.velocity.swap(next.velocity);
  now.opening.swap(next.opening), now.force.swap(next.force), now.mean_force.swap(next.mean_force);
  now.history.swap(next.history);
}

/// With the path average and the filters of the scheme only where they apply. Constraints: the trapezoidal rule, whose impacts have rules
/// of their own.
StepOptions in_use(StepOptions options, const ContactMethod& method) {
  options.path_average = options.path_average && options.scheme.average_acceleration() && !method.constrains();
  if (!options.path_average) options.scheme.gain = 0;
  return options;
}

}  // namespace

Stepper::Stepper(const StageModel& stage, const ContactChoice& contact, const ImpactRule& impact, const LinearSolver& solver,
                 const StepOptions& options, LinearCounts& counts)
    : stage_(stage),
      contact_(contact),
      solver_(solver),
      options_(in_use(options, contact.method)),
      linear_(counts),
      path_(options_.path_average),
      filtered_(options_.scheme.filtered()),
      impact_(impact.acts() && !path_ && stage.b.rows() > 0 ? &impact : nullptr),
      motion_(stage.model, stage.gap),
      sizes_(stage_, contact, impact_, motion_, solver, options_, counts),
      yielding_(stage.model) {
  still_force_ = options.held != nullptr ? *options.held : Vector(Vector::Zero(stage.bulk.unknowns));
  stage.model.add_constant_force(still_force_);
  if (filtered_ && stage.b.rows() > 0) joint_filter_ = std::make_unique<JointFilter>(stage.model, contact.laws, options_.scheme);
  // Two factors are kept: the one of the step, which needs the most room while it is made, comes first. One that is needed for the
  // acceleration of the beginning alone comes and goes before it (start).
  if (path_ || impact_ != nullptr) sizes_.at(0);
  if (impact_ != nullptr && accelerator().why().empty())
    impacts_ = std::make_unique<ContactImpacts>(
        *impact_, options_.scheme, stage.bulk, ContactRows(stage.model, stage.bulk, stage.b, motion_, accelerator().spread(stage.b)),
        blocks_of(stage.model, contact.laws).blocks, [this](const State& state, Vector& forces) { forces_at(state, forces); }, counts);
  if (yielding_.any()) newton_ = std::make_unique<PlasticNewton>(yielding_, stage.bulk.stiffness_diagonal(), options.plastic);
}

const Accelerator& Stepper::accelerator() const {
  if (accelerator_ == nullptr) {
    solver_.wait_for_room();
    accelerator_ = std::make_unique<Accelerator>(stage_.model, stage_.bulk, impact_ != nullptr ? &stage_.b : nullptr, solver_, linear_);
    if (impact_ != nullptr || accelerator_->too_large()) mass_failure_ = accelerator_->why();
  }
  return *accelerator_;
}

/// The displacement increment: by the linear step, or by the outer Newton around it.
inline Outcome Stepper::solve(StepSize& size) {
  StepSolver* last = size.solver.get();
  StepStart start{now_.displacement, now_.opening, now_.history};
  if (joint_filter_ != nullptr) {
    joint_filter_->begin(last->filter());
    start.filter = &last->filter();
  }
  if (newton_ == nullptr) {
    last_ = &last->problem();
    solution_ = &last->solution();
    return last->solve(right_, start, increment_);
  }
  const PlasticNewton::Make soften = [&](const Sparse& d, std::string& why) { return sizes_.softened(size, d, why); };
  Outcome outcome = newton_->solve({right_, start, plastic_now_, next_.time, 1 / options_.scheme.stretch(), size.step}, *last, soften,
                                   increment_, plastic_next_);
  last = &newton_->last();
  last_ = &last->problem();
  solution_ = &last->solution();
  return outcome;
}

void Stepper::force_at(double time, Vector& force) const {
  const double* still = still_force_.data();
  double* sum = force.data();
  small::with_size(still_force_.size(), [=](auto count) { std::copy_n(still, static_cast<Eigen::Index>(count), sum); });
  stage_.model.add_varying_force(time, force);
  if (options_.second_order != nullptr)
    for (const TimeLoad& time_load : *options_.second_order) force += time_load.factor(time) * time_load.shape;
}

void Stepper::forces_at(const State& state, Vector& result) const {  // f - C v - K u - r - B^T p; r is that of now_
  force_at(state.time, result);
  stage_.bulk.damping.multiply(state.velocity, work_);
  result -= work_;
  stage_.bulk.stiffness.multiply(state.displacement, work_);
  result -= work_;
  if (newton_ != nullptr) result -= plastic_now_.force;
  if (stage_.b.rows() == 0) return;
  work_.noalias() = stage_.b.transpose() * state.force;
  result -= work_;
}

void Stepper::acceleration(Vector& result) const {
  if (!path_) {
    result = now_.acceleration;
    return;
  }
  result.resize(stage_.bulk.unknowns);
  if (averages_acceleration() && counts_.steps > 0) {
    const bool divided = last_step_ > 0 && last_step_ < options_.step;
    result = (now_.velocity - (divided ? velocity_before_ : next_.velocity)) / options_.step;
    return;
  }
  forces_at(now_, right_);
  accelerator().solve(right_, result);
}

StepBalance Stepper::balance(const Vector& start) const {
  if (!(last_step_ > 0)) return StepBalance::of_state(now_, start);
  if (path_) return StepBalance::mean(next_, now_, last_step_, options_.scheme.gain);
  return StepBalance::weighted(next_, now_, options_.scheme.alpha_f, options_.scheme.alpha_m);
}

void Stepper::products(const Vector& u, const Vector& v, Vector& ku, Vector& mv) const {
  if (pair_ != nullptr) {
    pair_->multiply(u, v, ku, mv);
    return;
  }
  stage_.bulk.stiffness.multiply(u, ku);
  stage_.bulk.mass.multiply(v, mv);
}

inline void Stepper::right_hand_side(const StepSize& size) {
  const double* f0 = force_now_.data();
  const double* f1 = force_next_.data();
  const double* ku = stiff_now_.data();
  double* right = right_.data();
  const Eigen::Index n = stage_.bulk.unknowns;
  if (filtered_) {
    const double *mv = momentum_now_.data(), *filtered_stiff = filtered_stiff_.data(), *filtered_momentum = filtered_momentum_.data();
    const double w = size.weights.share, gain = options_.scheme.gain, inertia = size.weights.mass_velocity;
    small::with_size(n, [=](auto count) {
#pragma omp simd
      for (Eigen::Index i = 0; i < count; ++i)
        right[i] = w * (f0[i] + f1[i] - 2 * (ku[i] - gain * filtered_stiff[i]) + inertia * (mv[i] - gain * filtered_momentum[i]));
    });
    if (newton_ != nullptr) right_ -= w * plastic_now_.force;
    return;
  }
  if (path_) {
    const double* mv = momentum_now_.data();
    const double inertia = size.weights.mass_velocity;  // 4/dt
    small::with_size(n, [=](auto count) {
#pragma omp simd
      for (Eigen::Index i = 0; i < count; ++i) right[i] = f0[i] + f1[i] - 2 * ku[i] + inertia * mv[i];
    });
    if (newton_ != nullptr) right_ -= plastic_now_.force;
    return;
  }
  const double w = 1 - options_.scheme.alpha_f, ratio = options_.scheme.alpha_f / w;
  const double of_velocity = size.weights.mass_velocity, of_acceleration = size.weights.mass_acceleration;
  const double *v0 = now_.velocity.data(), *a0 = now_.acceleration.data();
  double* weighted = increment_.data();  // not solved for yet
  small::with_size(n, [=](auto count) {
#pragma omp simd
    for (Eigen::Index i = 0; i < count; ++i) {
      right[i] = f1[i] + ratio * f0[i] - ku[i] / w;
      weighted[i] = of_velocity * v0[i] + of_acceleration * a0[i];
    }
  });
  stage_.bulk.mass.multiply(increment_, work_);
  small::with_size(n, [=, inertia = work_.data()](auto count) {
#pragma omp simd
    for (Eigen::Index i = 0; i < count; ++i) right[i] += inertia[i];
  });
  if (!stage_.bulk.damping.zero()) {
    for (Eigen::Index i = 0; i < n; ++i)
      increment_[i] = size.weights.damping_velocity * now_.velocity[i] + size.weights.damping_acceleration * now_.acceleration[i];
    stage_.bulk.damping.multiply(increment_, work_);
    right_ -= work_;
  }
  if (newton_ != nullptr && ratio != 0) right_ -= ratio * plastic_now_.force;
  if (ratio == 0 || stage_.b.rows() == 0) return;
  work_.noalias() = stage_.b.transpose() * now_.force;
  right_ -= ratio * work_;
}

/// Displacement, velocity and acceleration at the end of the step; false when they are not finite.
inline bool Stepper::kinematics(const StepSize& size) {
  const double dt = size.step;
  const Scheme& s = options_.scheme;
  const double* du = increment_.data();
  const double *u0 = now_.displacement.data(), *v0 = now_.velocity.data(), *a0 = now_.acceleration.data();
  double *u1 = next_.displacement.data(), *v1 = next_.velocity.data(), *a1 = next_.acceleration.data();
  double norm2 = 0;
  if (filtered_) {
    const double *filtered = now_.filter.velocity.data(), gain = s.gain, rate = 1 / dt, inverse = 2 * size.weights.share;
    small::with_size(stage_.bulk.unknowns, [=, &norm2](auto count) {
      double sum = 0;
#pragma omp simd reduction(+ : sum)
      for (Eigen::Index i = 0; i < count; ++i) {
        u1[i] = u0[i] + du[i];
        v1[i] = v0[i] + inverse * (rate * du[i] - v0[i] + gain * filtered[i]);
        sum += du[i] * du[i];
      }
      norm2 = sum;
    });
    return std::isfinite(norm2);
  }
  if (path_) {
    const double rate = 0.5 * size.weights.mass_velocity;  // 2/dt
    small::with_size(stage_.bulk.unknowns, [=, &norm2](auto count) {
      double sum = 0;
#pragma omp simd reduction(+ : sum)
      for (Eigen::Index i = 0; i < count; ++i) {
        u1[i] = u0[i] + du[i];
        v1[i] = rate * du[i] - v0[i];
        sum += du[i] * du[i];
      }
      norm2 = sum;
    });
    return std::isfinite(norm2);
  }
  const double inertia = s.beta * dt * dt, before = 1 / (2 * s.beta) - 1, gamma = s.gamma;
  small::with_size(stage_.bulk.unknowns, [=, &norm2](auto count) {
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (Eigen::Index i = 0; i < count; ++i) {
      u1[i] = u0[i] + du[i];
      a1[i] = (du[i] - dt * v0[i]) / inertia - before * a0[i];
      v1[i] = v0[i] + dt * ((1 - gamma) * a0[i] + gamma * a1[i]);
      sum += du[i] * du[i];
    }
    norm2 = sum;
  });
  return std::isfinite(norm2);
}

/// The displacement at the end of the step. Forces at its beginning that would create energy are left out, as far as there is a solution
/// without them.
inline bool Stepper::balance_step(StepSize& size) {
  for (int reductions = 0;; ++reductions) {
    right_hand_side(size);
    if (sizes_.shift().size() > 0)
      right_ -= stage_.b.transpose() * sizes_.shift().cwiseProduct(motion_.gap() + stage_.b * now_.displacement).eval();
    const Outcome outcome = solve(size);
    counts_.iterations += outcome.iterations;
    counts_.cycles += outcome.cycles;
    if (outcome.converged) {
      if (impacts_ == nullptr) return true;
      contact_work_ = impacts_->contact_work(last_->model->blocks, now_, *solution_);
      if (!impacts_->drop_creating(last_->model->blocks, now_, *solution_, energies_, contact_work_,
                                   std::max(largest_external_, std::abs(initial_energy_))))
        return true;
      if (reductions == 0) first_try_.increment = increment_, first_try_.plastic = plastic_next_, first_try_.solution = *solution_;
      if (reductions < most_reductions) continue;
    }
    why_ = outcome.converged ? fmt::format("forces at the beginning of the step give energy back after {} reductions", most_reductions)
                             : outcome.why;
    if (reductions == 0 || size.step > smallest_share * options_.step) return false;
    increment_ = first_try_.increment, plastic_next_ = first_try_.plastic, solution_ = &first_try_.solution;
    impacts_->restore_dropped(now_);  // only impacts drop forces
    contact_work_ = impacts_->contact_work(last_->model->blocks, now_, *solution_);
    return true;
  }
}

inline bool Stepper::try_step(StepSize& size) {
  if (!mass_failure_.empty() || !size.why.empty()) {
    why_ = mass_failure_.empty() ? size.why : "the mass matrix: " + mass_failure_;
    return false;
  }
  if (filtered_ && now_.filter.step > size.step) shorten_filters(size.step);
  next_.time = now_.time + size.step;
  force_at(next_.time, force_next_);
  if (motion_.acts()) motion_.go(now_.time, next_.time);
  if (motion_.acts() && impacts_ != nullptr) motion_.set_rates(next_.time);
  if (!balance_step(size)) return false;
  const InterfaceSolution& solution = *solution_;
  if (sizes_.shift().size() > 0) {
    why_ = unheld_motion(*last_, solution, runaway_ratio);
    if (!why_.empty()) return false;
  }
  if (!kinematics(size)) {
    why_ = "the displacement is not finite";
    return false;
  }
  small::copy(solution.opening.size(), solution.opening.data(), next_.opening.data());
  small::copy(solution.now.size(), solution.now.data(), next_.history.data());
  if (newton_ != nullptr) next_.bulk_history = plastic_next_.history;
  products(next_.displacement, next_.velocity, stiff_end(), momentum_end());
  if (path_) {
    const double to_mean = 1 / last_->model->scale;
    for (const Block& block : last_->model->blocks)
      for (int c = 0; c < block.batch.components; ++c) {
        const int points = block.batch.points, first = block.first + c * points;
        const double *end = solution.end_traction.data() + first, *force = solution.force.data() + first, *area = block.area.data();
        double *at_end = next_.force.data() + first, *mean = next_.mean_force.data() + first;
        if (points == 1) {
          *at_end = *end * *area, *mean = to_mean * *force;
          continue;
        }
        for_lanes(points, [=](const auto& at) {
          at.put(at_end, at(end) * at(area));
          at.put(mean, to_mean * at(force));
        });
      }
  } else {
    small::copy(solution.force.size(), solution.force.data(), next_.force.data());
    const double end = impacts_ != nullptr ? options_.scheme.end_share() : 0.5;
    const double friction = friction_work(last_->model->blocks, now_, next_, end);
    // what moving supports put in through the interfaces, by the forces that moved the step
    if (motion_.acts()) energies_.external += (1 - end) * now_.force.dot(motion_.change()) + end * next_.force.dot(motion_.change());
    if (impacts_ != nullptr) {
      SolvedStep step{size.impacts, last_->model->blocks, now_, next_, momentum_end(), energies_, friction, contact_work_};
      impacts_->apply(step);
      energies_.friction += step.friction;
    } else {
      next_.mean_force = next_.force;
      energies_.friction += friction;
    }
  }
  return true;
}

bool Stepper::substep(int halving) {
  StepSize& now = sizes_.at(halving);
  if (impacts_ != nullptr) impacts_->begin_step(now_, now.step);
  if (try_step(now)) {
    book_energies(now);
    exchange(now_, next_);
    force_now_.swap(force_next_);
    if (!path_) now_.acceleration.swap(next_.acceleration);
    if (impacts_ != nullptr) impacts_->accept();
    if (filtered_) {
      std::swap(now_.filter.step, next_.filter.step);
      now_.filter.displacement.swap(next_.filter.displacement), now_.filter.velocity.swap(next_.filter.velocity);
      stiff_now_.swap(stiff_next_);
      momentum_now_.swap(momentum_next_);
    }
    if (newton_ != nullptr) {
      now_.bulk_history.swap(next_.bulk_history);
      std::swap(plastic_now_, plastic_next_);
    }
    counts_.deepest = std::max(counts_.deepest, halving);
    last_step_ = now.step;
    return true;
  }
  if (path_) next_.velocity = now_.velocity;  // what has failed may not be finite
  if (impacts_ != nullptr) impacts_->undo(now_);
  failed_step_ = now.step;
  if (now.hopeless || !mass_failure_.empty() || halving >= options_.halvings) return false;
  if (const long spent = counts_.iterations - iterations_before_; spent > most_iterations_of_a_step) {
    why_ += fmt::format("; given up after {} iterations of the interface in one step", spent);
    return false;
  }
  ++counts_.retries;
  if (path_ && halving == 0) velocity_before_ = now_.velocity;
  return substep(halving + 1) && substep(halving + 1);
}

bool Stepper::advance() {
  iterations_before_ = counts_.iterations;
  if (!substep(0)) return false;
  now_.time = start_time_ + static_cast<double>(++counts_.steps) * options_.step;  // not summed: no round-off grows in a long run
  return true;
}

}  // namespace uplift
