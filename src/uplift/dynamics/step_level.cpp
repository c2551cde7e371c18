#include "uplift/dynamics/step_level.h"

#include <cassert>
#include <cmath>
#include <utility>

#include "uplift/dynamics/closed_joint.h"
#include "uplift/dynamics/monolithic.h"
#include "uplift/dynamics/statics.h"
#include "uplift/model/mechanism.h"

namespace uplift {

Stepper::Level& Stepper::make_level(int halving) {
  solver_.wait_for_room();
  auto& slot = levels_[static_cast<std::size_t>(halving)];
  slot = std::make_unique<Level>();
  Level& made = *slot;
  made.step = options_.step / std::pow(2.0, halving);
  made.weights = weights_of(options_.scheme, made.step);
  ContactModel frame = frame_of(made);
  if (options_.monolithic) {
    made.solver = make_monolithic(matrix_of(made), b_, motion_.gap(), std::move(frame));
    ++linear_.factorisations;
  } else {
    // Yielding solids halve steps often. The matrices of all lengths have their entries in the same places: one symbolic analysis serves
    // them. Other models may share their factors with other runs (linear/lockstep.h), which the solver does for itself.
    const StepSolver* whole = newton_ != nullptr && halving > 0 && levels_.front() != nullptr ? levels_.front()->solver.get() : nullptr;
    auto factor = std::make_shared<const BulkFactor>(upper_of(made), &b_, bulk_.small, solver_, model_, linear_,
                                                     whole != nullptr ? whole->factor() : nullptr);
    if (!factor->ok()) {
      made.why = factor->why();
      made.hopeless = factor->too_large();
      return made;
    }
    std::unique_ptr<StepSolver> oracle;
    if (options_.oracle_tolerance > 0) oracle = make_monolithic(matrix_of(made), b_, motion_.gap(), frame);
    made.solver =
        std::make_unique<Condensed>(model_, b_, motion_.gap(), motion_.acts(), std::move(factor), std::move(frame), method_, linear_);
    if (oracle != nullptr)
      made.solver = make_compared(matrix_of(made), std::move(made.solver), std::move(oracle), options_.oracle_tolerance);
  }
  if (impacts_act()) make_impact_factors(made);
  return made;
}

/// A matrix that cannot be factorised is the failure of the step size.
void Stepper::make_impact_factors(Level& level) const {
  const Scheme& s = options_.scheme;
  ImpactFactors& made = level.impacts;
  made.step = level.step;
  made.mass = level.weights.mass;
  const auto spread_by = [&](const OwnedSum& matrix, std::unique_ptr<Spread>& spread) {
    made.factor = std::make_unique<BulkFactor>(matrix, &b_, bulk_.small, solver_, model_, linear_);
    if (!made.factor->ok()) level.why = "the matrix of impacts: " + made.factor->why();
    level.hopeless = made.factor->too_large();
    if (level.why.empty()) spread = std::make_unique<Spread>(made.factor->spread(b_, linear_));
  };
  if (impact_.needs_dynamic()) spread_by(bulk_.upper(1, 0, 4 / (level.step * level.step)), made.dynamic);
  if (!impact_.holds_acceleration() || bulk_.damping.zero()) return;
  if (!s.average_acceleration()) {
    made.effective = level.solver->factor();
    if (made.effective != nullptr) return;
    made.factor = std::make_unique<BulkFactor>(upper_of(level), &b_, bulk_.small, solver_, model_, linear_);
    made.effective = made.factor.get();
    level.why = made.factor->why();
    return;
  }
  spread_by(damped_mass(s.velocity_weight(level.step)), made.damped);
  const std::vector<Block> blocks = blocks_of(model_, behaviours_).blocks;
  if (made.damped != nullptr && any_friction(blocks)) made.coulomb = std::make_unique<CoulombRates>(blocks, made.damped->factor);
}

/// M + w D, with a trace of mass where there is none and perhaps no damping either.
OwnedSum Stepper::damped_mass(double w) const {
  constexpr double trace = 1e-12;
  OwnedSum sum = bulk_.upper(0, w, 1);
  const Vector diagonal = bulk_.mass_matrix.diagonal() + w * bulk_.damping_matrix.diagonal() + w * w * bulk_.stiffness_matrix.diagonal();
  std::vector<Triplet> light;
  for (int i = 0; i < bulk_.unknowns; ++i)
    if (bulk_.massless[static_cast<std::size_t>(i)] != 0) light.emplace_back(i, i, trace * diagonal[i]);
  if (light.empty()) return sum;
  Sparse here(bulk_.unknowns, bulk_.unknowns);
  here.setFromTriplets(light.begin(), light.end());
  if (sum.here.size() > 0) here += sum.here;
  sum.here.swap(here);
  return sum;
}

/// Unknowns without mass that nothing but the laws of interfaces holds make K_eff singular: like in a static stage, the closed joint is
/// factored with it and taken back in the interface problem.
Vector Stepper::stiffness_for_massless() const {
  Vector touching = Vector::Zero(b_.rows());
  for (int column = 0; column < b_.outerSize(); ++column)
    if (bulk_.massless[static_cast<std::size_t>(column)] != 0)
      for (Sparse::InnerIterator entry(b_, column); entry; ++entry) touching[entry.row()] = 1;
  if (touching.isZero(0) || unresisted_motion(model_, Resistance::dynamic_open).size() == 0) return {};
  return touching.cwiseProduct(closed_joint(model_, solver_.matrices_of(model_).stiffness, b_, behaviours_));
}

Sparse Stepper::matrix_of(const Level& level) const {
  assert(!bulk_.distributed());
  Sparse linear = bulk_.stiffness_matrix + level.weights.damping * bulk_.damping_matrix + level.weights.mass * bulk_.mass_matrix;
  if (shift_.size() > 0) linear += joint_stiffness(b_, shift_);
  if (!filtered_ || bulk_.geometric == nullptr) return linear;
  return linear - (1 - 1 / options_.scheme.stretch()) * *bulk_.geometric;  // the geometric stiffness is not filtered
}

/// The upper triangle of the same: what a factor is made of.
OwnedSum Stepper::upper_of(const Level& level) const {
  const bool unfiltered = filtered_ && bulk_.geometric != nullptr;
  if (!bulk_.distributed() && (shift_.size() > 0 || unfiltered)) return {matrix_of(level).triangularView<upper_triangle>(), {}};
  OwnedSum sum = bulk_.upper(1, level.weights.damping, level.weights.mass);
  if (!bulk_.distributed()) return sum;
  if (shift_.size() > 0) sum.here += Sparse(joint_stiffness(b_, shift_).triangularView<upper_triangle>());
  if (unfiltered) sum.here -= Sparse((1 - 1 / options_.scheme.stretch()) * bulk_.geometric->triangularView<upper_triangle>());
  return sum;
}

ContactModel Stepper::frame_of(const Level& level) const {
  ContactModel frame = blocks_of(model_, behaviours_);
  frame.average = path_;
  frame.scale = path_ ? 2 / options_.scheme.stretch() : 1;
  frame.step = level.step;
  frame.shift = shift_;
  return frame;
}

}  // namespace uplift
