#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "uplift/contact/lagrange/augmentation.h"
#include "uplift/contact/lagrange/force_share.h"
#include "uplift/contact/lagrange/lagrange.h"
#include "uplift/contact/newton/newton.h"
#include "uplift/contact/point_rows.h"

// Augmented Lagrangian (paper, eq 1 with alpha > 0): p = P(m + e g), solved by Newton; then m <- p, until the multipliers stand still. Each
// update contracts the error by 1/(1 + e F): with e F_ii = factor a handful of updates reaches round-off. Where it contracts slowly
// (neighbouring points of a rigid footing are nearly one row), e grows by 16 until round-off in the openings would show in the forces. The
// updates leave open how redundant points (a rigid footing on many of them) share their force; force_share.h tells it, as for the
// multipliers alone (lagrange).
namespace uplift {

namespace {

struct AugmentedWork final : MethodWork {
  SeenModel model;               // that the stiffness belongs to
  Vector multiplier, stiffness;  // rows [N], [N/m]
  double growth = 1;             // of the stiffness in this step
  NewtonWork newton;
  std::unique_ptr<MethodWork> frictional;
  ResidualScratch residual;
  ForceShare share;
};

class AugmentedLagrangian final : public ContactMethod {
 public:
  AugmentedLagrangian(double factor, double tolerance, int most_updates, NewtonOptions newton)
      : factor_(factor), tolerance_(tolerance), most_updates_(most_updates), newton_(newton) {}

  std::unique_ptr<MethodWork> make_work() const override { return std::make_unique<AugmentedWork>(); }
  Outcome solve(const InterfaceProblem& problem, MethodWork& kept, InterfaceSolution& solution) const override {
    AugmentedWork& work = static_cast<AugmentedWork&>(kept);
    prepare(*problem.model, work);
    const Outcome guess = guess_by_status(problem, work, solution);
    Outcome total = iterate(problem, work, guess.converged, solution);
    total.iterations += guess.iterations;
    reset_stiffness(work);
    for (const double softer : {1.0 / 128, 1.0 / 16384}) {
      if (total.converged) break;
      const Outcome again = iterate_from(softer, problem, work, solution);
      const int iterations = total.iterations + again.iterations;
      if (again.converged) total = again;
      total.iterations = iterations;
    }
    if (total.converged) work.share.solve(problem, no_gap * problem.model->size, solution);
    return total;
  }

  bool constrains() const override { return true; }

 private:
  /// The same from rest on softer springs (a power of two, which the growth takes back): on these Newton's method, which follows no
  /// potential with friction, arrives from afar.
  Outcome iterate_from(double softer, const InterfaceProblem& problem, AugmentedWork& work, InterfaceSolution& solution) const {
    work.multiplier.setZero();
    work.stiffness *= softer;
    work.growth = softer;
    solution.z.setZero();
    Outcome outcome = iterate(problem, work, false, solution);
    reset_stiffness(work);
    return outcome;
  }

  /// `guessed`: the multipliers are expected to be the answer.
  Outcome iterate(const InterfaceProblem& problem, AugmentedWork& work, bool guessed, InterfaceSolution& solution) const {
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    const AugmentedForce augmented{&work.multiplier, &work.stiffness};
    Outcome total;
    double before = std::numeric_limits<double>::infinity();
    for (int update = 0; update < most_updates_; ++update) {
      const Outcome inner = solve_by_newton(problem, augmented, newton_, work.newton, solution);
      total.iterations += inner.iterations + 1;
      total.residual = inner.residual;
      if (!inner.converged) {
        total.why = fmt::format("augmented Lagrangian, update {}: {}", update + 1, inner.why);
        return total;
      }
      bool rubs = false;
      double change = 0, largest = 0, noise = 0;  // noise: what round-off in the openings makes of a stiff augmentation
      for (const Block& block : problem.model->blocks) {
        if (block.cone == nullptr) continue;
        rubs = rubs || block.cone->friction() > 0;
        for (int i = block.first; i < block.first + block.rows(); ++i) {
          change = std::max(change, std::abs(solution.force[i] - work.multiplier[i]));
          largest = std::max(largest, std::abs(solution.force[i]));
          noise = std::max(
              noise, work.stiffness[i] * (std::abs(problem.free_opening[i]) + std::abs(solution.opening[i] - problem.free_opening[i])));
          work.multiplier[i] = solution.force[i];
        }
      }
      // under a rigid footing friction can be shared in many ways, between which the multipliers wander while everything else stands still
      const bool wanders = rubs && (guessed || update >= 8) && change <= 1e-3 * largest &&
                           contact_residual(problem, solution, work.residual) <= 10 * tolerance_;
      if (change <= tolerance_ * largest || wanders || change <= 4 * epsilon * noise) {
        total.converged = true;
        return total;
      }
      if (update >= 4 && change > 0.25 * before && 64 * epsilon * noise < 1e-8 * largest) {
        work.growth *= 16;
        work.stiffness *= 16;
      }
      before = change;
    }
    total.why = fmt::format("the multipliers did not settle in {} updates of the augmented Lagrangian", most_updates_);
    return total;
  }

  /// Where many independent rows rub, Newton's method has no potential to follow and fails from a poor guess: the exact status iteration
  /// gives the first multipliers, which the updates then have to confirm.
  static Outcome guess_by_status(const InterfaceProblem& problem, AugmentedWork& work, InterfaceSolution& solution) {
    const bool rubs = std::any_of(problem.model->blocks.begin(), problem.model->blocks.end(),
                                  [](const Block& block) { return block.cone != nullptr && block.cone->friction() > 0; });
    if (!rubs || !PointRows::suits(*problem.model)) return {};
    size_solution(problem, solution);
    Outcome outcome = solve_frictional(problem, {}, work.frictional, solution);
    if (outcome.converged)
      work.multiplier = solution.force;
    else
      solution.z.setZero();
    return outcome;
  }

  static void reset_stiffness(AugmentedWork& work) {
    if (work.growth != 1) work.stiffness /= work.growth;  // a power of two: exact
    work.growth = 1;
  }

  /// Multipliers start at zero, so that the answer depends on the problem alone.
  void prepare(const ContactModel& model, AugmentedWork& work) const {
    work.multiplier.setZero(model.rows());
    if (work.model.is(model)) return;
    work.model.take(model);
    augmentation(model, factor_, work.stiffness);
  }

  double factor_, tolerance_;
  int most_updates_;
  NewtonOptions newton_;
};

}  // namespace

const Entry<ContactMethod>& entry_method_augmented_lagrangian() {
  static const Entry<ContactMethod> entry{
      {.name = "augmented_lagrangian",
       .summary = "penalty with multiplier updates until the constraints hold to round-off",
       .equations = "p = P(m + e g), m <- p, repeat while max|p - m| > tolerance max|p|\n"
                    "e = factor / F_ii; the error contracts by 1/(1 + e F) per update",
       .source = "Cherubini, Richard & Frau, eq 1",
       .params = {number("factor", "1", "penalty stiffness times compliance, e F_ii").positive().standard(1000.0),
                  number("tolerance", "1", "largest change of a contact force in the last update, relative to the largest force")
                      .positive()
                      .standard(1e-11),
                  integer("most_updates", "multiplier updates before the step is cut").between(1, 10000).standard(60.0),
                  integer("most_iterations", "Newton iterations per update").between(1, 10000).standard(60.0)}},
      [](const Values& values) -> std::unique_ptr<const ContactMethod> {
        return std::make_unique<AugmentedLagrangian>(values.number("factor"), values.number("tolerance"), values.integer("most_updates"),
                                                     NewtonOptions{1e-12, values.integer("most_iterations")});
      }};
  return entry;
}

}  // namespace uplift
