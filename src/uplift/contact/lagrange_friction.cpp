#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "uplift/contact/lagrange_status.h"
#include "uplift/contact/newton.h"

// Semismooth Newton on the contact status of frictional points. For a status the step is linear (lagrange_status.h). Then each point looks
// at its trial:
//   closed  opens when its pressure is tensile; an open one closes when it penetrates, or touches where the closed rows press
//   stick   slips when |p_t| > -mu p_n, in the direction of p_t
//   slip    sticks when p_t + rho slip falls inside the bound (in 2D: when it moves against its friction force)
namespace uplift {
namespace {

class Frictional {
 public:
  Frictional(const InterfaceProblem& problem, const LagrangeOptions& options, InterfaceSolution& solution)
      : problem_(problem), options_(options), solution_(solution), step_(problem, options.gap_tolerance, solution) {}

  Outcome solve() {
    if (!problem_.free_opening.allFinite()) return fail("the openings are not finite");
    step_.guess_from_solution();
    if (settle(options_.most_iterations, false)) return finish();
    step_.guess_from_free_opening();
    if (settle(options_.most_iterations, false)) return finish();
    if (!step_.finite()) return fail("the interface forces are not finite");
    ++outcome_.cycles;
    step_.guess_from_free_opening();
    if (settle(50 + 8 * static_cast<int>(step_.points().size()), true)) return finish();
    ++outcome_.cycles;
    if (raise_friction()) return finish();
    ++outcome_.cycles;
    return by_augmentation();
  }

 private:
  Outcome fail(std::string why) {
    outcome_.why = std::move(why);
    return outcome_;
  }

  Outcome finish() {
    step_.write_status();
    outcome_.converged = true;
    outcome_.residual = yardstick(problem_, solution_);
    return outcome_;
  }

  /// Newton until status and forces stand still. `single`: one point changes at a time, least index first (Bland's rule). False when a
  /// status comes back, when the closed points contradict each other or when the iterations are used up.
  bool settle(int most, bool single) {
    std::set<std::vector<signed char>> visited;
    double before = std::numeric_limits<double>::infinity();
    for (int iteration = 0; iteration < most; ++iteration, ++outcome_.iterations) {
      if (!step_.solve()) return false;
      if (step_.update_status(single)) {
        if (!visited.insert(step_.code()).second) return false;
        before = std::numeric_limits<double>::infinity();
        continue;
      }
      const double residual = step_.residual();
      if (residual <= options_.tolerance || (residual <= 1e-9 && residual > 0.5 * before)) return true;
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
      if (settle(options_.most_iterations, false)) continue;
      step_.scale_friction(1);
      return false;
    }
    return true;
  }

  /// Updates of the augmented Lagrangian on the same problem, the exact solve being tried from the status that they show after every few of
  /// them.
  Outcome by_augmentation() {
    Vector multiplier = Vector::Zero(problem_.rows()), stiffness(problem_.rows());
    const double largest = problem_.factor.rowwise().squaredNorm().maxCoeff();
    for (Index i = 0; i < stiffness.size(); ++i) {
      const double flexible = problem_.factor.row(i).squaredNorm();
      stiffness[i] = 100 / (flexible > 1e-12 * largest ? flexible : std::max(largest, 1e-300));
    }
    const AugmentedForce augmented{&multiplier, &stiffness};
    NewtonOptions newton;
    newton.most_iterations = 100;
    solution_.z.setZero();
    for (int update = 1; update <= 200; ++update) {
      const Outcome inner = solve_by_newton(problem_, augmented, newton, solution_);
      outcome_.iterations += inner.iterations;
      if (ran_away()) return fail(unsettled() + "; nothing holds the structure against sliding or lifting off");
      if (!inner.converged) return fail(unsettled() + "; the augmented Lagrangian: " + inner.why);
      double change = 0, size = 0;
      for (const FrictionPoint& point : step_.points())
        for (int c = 0; c < point.components; ++c) {
          const Index row = point.row(c);
          change = std::max(change, std::abs(solution_.force[row] - multiplier[row]));
          size = std::max(size, std::abs(solution_.force[row]));
        }
      multiplier = solution_.force;
      const bool settled = change <= 1e-12 * size;
      if (!settled && update % 4 != 0) continue;
      const Vector z = solution_.z;
      step_.guess_from_solution();
      if (settle(10, false)) return finish();
      solution_.z = z;
      if (!settled) continue;
      solve_by_newton(problem_, augmented, newton, solution_);
      outcome_.residual = yardstick(problem_, solution_);
      if (outcome_.residual > 1e-9) break;
      outcome_.converged = true;
      step_.guess_from_solution();
      step_.write_status();
      return outcome_;
    }
    return fail(unsettled());
  }

  /// In statics a loose body has no equilibrium: the balance, which is relative, is then met at infinity.
  bool ran_away() const {
    const Vector moved = problem_.factor * solution_.z;
    return !(moved.cwiseAbs().maxCoeff() <= 1e6 * (problem_.free_opening - problem_.from).cwiseAbs().maxCoeff());
  }

  std::string unsettled() const {
    if (step_.changed().empty())
      return "no contact status was found: the closed points contradict each other, or nothing holds the structure";
    return fmt::format("the contact status did not settle at {}", point_names(problem_, step_.changed()));
  }

  const InterfaceProblem& problem_;
  const LagrangeOptions& options_;
  InterfaceSolution& solution_;
  StatusStep step_;
  Outcome outcome_;
};

}  // namespace

Outcome solve_frictional(const InterfaceProblem& problem, const LagrangeOptions& options, InterfaceSolution& solution) {
  return Frictional(problem, options, solution).solve();
}

}  // namespace uplift
