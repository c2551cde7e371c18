#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/contact/lagrange/augmentation.h"
#include "uplift/contact/lagrange/failures.h"
#include "uplift/contact/lagrange/force_share.h"
#include "uplift/contact/lagrange/lagrange.h"
#include "uplift/contact/lagrange/status.h"
#include "uplift/contact/newton/newton.h"

// Semismooth Newton on the contact status of frictional points. For a status the step is linear (status.h). Then each point looks
// at its trial:
//   closed  opens when its pressure is tensile; an open one closes when it penetrates
//   stick   slips when |p_t| > -mu p_n, in the direction of p_t
//   slip    sticks when p_t + rho slip falls inside the bound (in 2D: when it moves against its friction force)
// Points of a rigid base then share the force anew (force_share.h): the status tells its resultant, not how it is distributed.
namespace uplift {
namespace {

/// One point at a time, many points take long, and what they have not found by then they seldom find.
constexpr int most_single_changes = 500;

class Frictional final : public MethodWork {
 public:
  Outcome solve(const InterfaceProblem& problem, const LagrangeOptions& options, InterfaceSolution& solution) {
    problem_ = &problem, options_ = &options, solution_ = &solution;
    outcome_ = Outcome();
    step_.begin(problem, options.gap_of(*problem.model), solution);
    visited_.reserve(static_cast<std::size_t>(options.most_iterations) + 50 + 8 * step_.points().size());
    return find();
  }

 private:
  Outcome find() {
    if (!problem_->free_opening.allFinite()) return fail("the openings are not finite");
    step_.guess_from_solution();
    if (settle(options_->most_iterations, false) && confirmed()) return finish();
    step_.guess_from_free_opening();
    if (settle(options_->most_iterations, false) && confirmed()) return finish();
    if (!step_.finite()) return fail("the interface forces are not finite");
    ++outcome_.cycles;
    step_.guess_from_free_opening();
    if (settle(std::min(50 + 8 * static_cast<int>(step_.points().size()), most_single_changes), true) && confirmed()) return finish();
    ++outcome_.cycles;
    if (raise_friction() && confirmed()) return finish();
    ++outcome_.cycles;
    return by_augmentation();
  }

  Outcome fail(std::string why) {
    outcome_.why = std::move(why);
    return outcome_;
  }

  /// The settled status is an answer only when the common residual says so; points may be off by the gap tolerance. In statics a loose body
  /// that has flown away meets its balance too: another status may hold it.
  bool confirmed() {
    if (problem_->model->shift.size() > 0 && ran_away()) return false;
    step_.write_status();
    outcome_.residual = contact_residual(*problem_, *solution_, residual_);
    const double moved = problem_->rows() > 0 ? (solution_->opening - problem_->free_opening).cwiseAbs().maxCoeff() : 0;
    return outcome_.residual <= 1e-8 + (moved > 0 ? 4 * options_->gap_of(*problem_->model) / moved : 1);
  }

  Outcome finish() {
    outcome_.converged = true;
    if (share_.solve(*problem_, step_.gap(), *solution_)) outcome_.residual = share_.residual();
    return outcome_;
  }

  /// Newton until status and forces stand still. `single`: one point changes at a time, least index first (Bland's rule). False when a
  /// status comes back, when the closed points contradict each other or when the iterations are used up.
  bool settle(int most, bool single) {
    visited_.clear();
    double before = std::numeric_limits<double>::infinity();
    for (int iteration = 0; iteration < most; ++iteration, ++outcome_.iterations) {
      if (!step_.solve()) return false;
      if (step_.update_status(single)) {
        const std::uint64_t code = step_.code();
        if (std::find(visited_.begin(), visited_.end(), code) != visited_.end()) return false;
        visited_.push_back(code);
        before = std::numeric_limits<double>::infinity();
        continue;
      }
      const double residual = step_.residual();
      if (settled(residual, before, options_->tolerance)) return true;
      before = residual;
    }
    return false;
  }

  /// From no friction to the full coefficient in steps, the status of one being the guess for the next.
  bool raise_friction() {
    constexpr int steps = 20;
    step_.guess_from_free_opening();
    for (int k = 0; k <= steps; ++k) {
      step_.scale_friction(static_cast<double>(k) / steps);
      if (settle(options_->most_iterations, false)) continue;
      step_.scale_friction(1);
      return false;
    }
    return true;
  }

  /// The augmented Lagrangian on the same problem, on softer and softer springs: on these Newton's method, which follows no potential with
  /// friction, arrives from afar. The first reason is told.
  Outcome by_augmentation() {
    std::string why;
    for (const double factor : {100.0, 1.0, 0.01}) {
      outcome_.why.clear();
      if (by_augmentation(factor).converged) return outcome_;
      if (why.empty()) why = outcome_.why;
    }
    return fail(why);
  }

  /// Updates of the augmented Lagrangian, the exact solve being tried from the status that they show after every few of them.
  Outcome by_augmentation(double factor) {
    multiplier_.setZero(problem_->rows());
    augmentation(*problem_->model, factor, stiffness_);
    const AugmentedForce augmented{&multiplier_, &stiffness_};
    NewtonOptions newton;
    newton.most_iterations = 100;
    solution_->z.setZero();
    double before = std::numeric_limits<double>::infinity();
    for (int update = 1; update <= 200; ++update) {
      const Outcome inner = solve_by_newton(*problem_, augmented, newton, newton_, *solution_);
      outcome_.iterations += inner.iterations;
      if (ran_away()) return fail(unsettled() + "; nothing holds the structure against sliding or lifting off");
      if (!inner.converged) return fail(unsettled() + "; the augmented Lagrangian: " + inner.why);
      double change = 0, size = 0;
      for (const FrictionPoint& point : step_.points())
        for (int c = 0; c < point.components; ++c) {
          const Index row = point.row(c);
          change = std::max(change, std::abs(solution_->force[row] - multiplier_[row]));
          size = std::max(size, std::abs(solution_->force[row]));
        }
      multiplier_ = solution_->force;
      const bool settled = change <= 1e-12 * size || (change <= 1e-3 * size && update >= 8 && found_by_augmentation());
      if (update >= 4 && change > 0.25 * before && factor < 1e4) stiffness_ *= 16, factor *= 16;
      before = change;
      if (!settled && update % 4 != 0) continue;
      z_ = solution_->z;
      step_.guess_from_solution();
      if (settle(10, false) && confirmed()) return finish();
      solution_->z = z_;
      if (!settled) continue;
      solve_by_newton(*problem_, augmented, newton, newton_, *solution_);
      if (!found_by_augmentation()) break;
      step_.guess_from_solution();
      step_.write_status();
      return finish();
    }
    return fail(unsettled());
  }

  /// Forces of redundant points may wander for ever while everything else stands still. In a short step of a body that has slid far the
  /// round-off of its slip is what the residual cannot fall below.
  bool found_by_augmentation() {
    constexpr double round_off = 64 * std::numeric_limits<double>::epsilon(), most = 1e-6;
    const double slip = (solution_->opening - problem_->from).cwiseAbs().maxCoeff();
    const double noise = slip > 0 ? std::min(most, round_off * solution_->opening.cwiseAbs().maxCoeff() / slip) : 0;
    outcome_.residual = contact_residual(*problem_, *solution_, residual_);
    return outcome_.residual <= 1e-9 + noise;
  }

  /// In statics a loose body has no equilibrium: the balance, which is relative, is then met at infinity.
  bool ran_away() const {
    const Vector moved = problem_->model->factor * solution_->z;
    return !(moved.cwiseAbs().maxCoeff() <= 1e6 * (problem_->free_opening - problem_->from).cwiseAbs().maxCoeff());
  }

  std::string unsettled() const {
    if (step_.changed().empty())
      return "no contact status was found: the closed points contradict each other, or nothing holds the structure";
    return fmt::format("the contact status did not settle at {}", point_names(*problem_->model, step_.changed()));
  }

  const InterfaceProblem* problem_ = nullptr;
  const LagrangeOptions* options_ = nullptr;
  InterfaceSolution* solution_ = nullptr;
  StatusStep step_;
  ForceShare share_;
  NewtonWork newton_;  // of the augmentation
  ResidualScratch residual_;
  std::vector<std::uint64_t> visited_;  // hashes of the sets met
  Vector multiplier_, stiffness_, z_;   // of the augmentation
  Outcome outcome_;
};

}  // namespace

Outcome solve_frictional(const InterfaceProblem& problem, const LagrangeOptions& options, std::unique_ptr<MethodWork>& work,
                         InterfaceSolution& solution) {
  if (work == nullptr) work = std::make_unique<Frictional>();
  return static_cast<Frictional&>(*work).solve(problem, options, solution);
}

}  // namespace uplift
