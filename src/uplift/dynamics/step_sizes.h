#pragma once
#include <memory>
#include <string>
#include <vector>

#include "uplift/dynamics/contact_impacts.h"
#include "uplift/dynamics/plastic_newton.h"
#include "uplift/dynamics/scheme.h"
#include "uplift/dynamics/stage_model.h"
#include "uplift/dynamics/support_motion.h"

namespace uplift {

/// How a dynamic stage marches.
struct StepOptions {
  Scheme scheme;
  double step = 0;           // s
  bool path_average = true;  // only with the average acceleration rule (filtered or not) and a method that does not constrain
  int halvings = 8;
  bool monolithic = false;       // the oracle: Newton on all unknowns instead of the condensed step
  double oracle_tolerance = 0;   // > 0: every condensed step is also taken by the oracle; a larger relative difference fails it
  const Vector* held = nullptr;  // constant forces beside those of the model [N, N m], free unknowns: what released supports have borne
  // What prescribed motions do through the geometric stiffness of P-Delta; null: nothing
  const std::vector<TimeLoad>* second_order = nullptr;
  PlasticOptions plastic;
};

/// Everything that depends on the size of the step.
struct StepSize {
  double step = 0;  // s
  StepWeights weights;
  std::unique_ptr<StepSolver> solver;
  std::shared_ptr<const BulkFactor> tangent;  // the last one of yielding solids, whose analysis serves the next one
  ImpactFactors impacts;
  std::string why;        // when the matrix could not be factorised
  bool hopeless = false;  // nor would that of a smaller step be
};

/// The nominal step of a stage and its halves, each made when it is needed for the first time, and kept.
class StepSizes {
 public:
  /// `impact`: null where no impacts act. All must stay alive. `options`: as returned by in_use().
  StepSizes(const StageModel& stage, const ContactChoice& contact, const ImpactRule* impact, const SupportMotion& motion,
            const LinearSolver& solver, const StepOptions& options, LinearCounts& counts);
  StepSize& at(int halving) {
    const std::unique_ptr<StepSize>& made = sizes_[static_cast<std::size_t>(halving)];
    return made != nullptr ? *made : make(halving);
  }
  /// Halvings that have been made.
  std::vector<int> made() const;
  /// The next steps do not begin at the last solutions.
  void forget();
  /// The solver with another tangent of yielding solids: `softening` is what K_eff changes by. Null when it cannot be factorised.
  std::unique_ptr<StepSolver> softened(StepSize& size, const Sparse& softening, std::string& why) const;
  /// D of the interface problem [N/m], rows, for unknowns without mass that interfaces alone hold; empty without them.
  const Vector& shift() const { return shift_; }

 private:
  StepSize& make(int halving);
  void make_impact_factors(StepSize& size) const;
  std::unique_ptr<StepSolver> condensed(std::shared_ptr<const BulkFactor> factor, ContactModel contact) const;
  Vector stiffness_for_massless() const;
  Sparse matrix_of(const StepSize& size) const;
  OwnedSum upper_of(const StepSize& size) const;
  OwnedSum damped_mass(double w) const;
  ContactModel contact_model_of(const StepSize& size) const;

  const StageModel stage_;
  const ContactChoice contact_;
  const ImpactRule* impact_;
  const SupportMotion& motion_;
  const LinearSolver& solver_;
  const StepOptions& options_;
  LinearCounts& counts_;
  Vector shift_;
  std::vector<std::unique_ptr<StepSize>> sizes_;
};

}  // namespace uplift
