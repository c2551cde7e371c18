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
  const Scheme& s = options_.scheme;
  made.step = options_.step / std::pow(2.0, halving);
  const double dt = made.step * s.stretch(), w = 1 - s.alpha_f;
  made.damping = s.gamma / (s.beta * dt);
  made.mass = (1 - s.alpha_m) / (w * s.beta * dt * dt);
  made.share = 1 / s.stretch();
  made.mass_velocity = (1 - s.alpha_m) / (w * s.beta * dt);
  made.mass_acceleration = ((1 - s.alpha_m) * (1 / (2 * s.beta) - 1) - s.alpha_m) / w;
  made.damping_velocity = 1 - s.gamma / s.beta + s.alpha_f / w;
  made.damping_acceleration = dt * (1 - s.gamma / (2 * s.beta));

  ContactModel frame = frame_of(made);
  if (options_.monolithic) {
    made.solver = make_monolithic(matrix_of(made), b_, gap_, std::move(frame));
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
    if (options_.oracle_tolerance > 0) oracle = make_monolithic(matrix_of(made), b_, gap_, frame);
    made.solver = std::make_unique<Condensed>(model_, b_, gap_, gap_moves_, std::move(factor), std::move(frame), method_, linear_);
    if (oracle != nullptr)
      made.solver = make_compared(matrix_of(made), std::move(made.solver), std::move(oracle), options_.oracle_tolerance);
  }
  const auto spread_by = [&](const OwnedSum& matrix, std::unique_ptr<Spread>& spread) {
    made.impact_factor = std::make_unique<BulkFactor>(matrix, &b_, bulk_.small, solver_, model_, linear_);
    if (!made.impact_factor->ok()) made.why = "the matrix of impacts: " + made.impact_factor->why();
    made.hopeless = made.impact_factor->too_large();
    if (made.why.empty()) spread = std::make_unique<Spread>(made.impact_factor->spread(b_, linear_));
  };
  if (impacts_ && impact_.needs_dynamic()) spread_by(bulk_.upper(1, 0, 4 / (dt * dt)), made.dynamic);
  const bool damped = impacts_ && impact_.holds_acceleration() && !bulk_.damping.zero();
  if (damped && !s.average_acceleration() && made.solver->factor() == nullptr) {
    made.impact_factor = std::make_unique<BulkFactor>(upper_of(made), &b_, bulk_.small, solver_, model_, linear_);
    made.why = made.impact_factor->why();
  }
  if (damped && s.average_acceleration()) {
    spread_by(damped_mass(velocity_weight(made)), made.impact);
    const std::vector<Block> blocks = blocks_of(model_, behaviours_).blocks;
    if (made.impact != nullptr && any_friction(blocks)) made.coulomb = std::make_unique<CoulombRates>(blocks, made.impact->factor);
  }
  return made;
}

/// A force p at the end of a step puts -w M^-1 B^T p into the velocity [s].
double Stepper::velocity_weight(const Level& level) const {
  return options_.scheme.gamma * level.step * (1 - options_.scheme.alpha_f) / (1 - options_.scheme.alpha_m);
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
  Sparse linear = bulk_.stiffness_matrix + level.damping * bulk_.damping_matrix + level.mass * bulk_.mass_matrix;
  if (shift_.size() > 0) linear += b_.transpose() * shift_.asDiagonal() * b_;
  if (!filtered_ || bulk_.geometric == nullptr) return linear;
  return linear - (1 - 1 / options_.scheme.stretch()) * *bulk_.geometric;  // the geometric stiffness is not filtered
}

/// The upper triangle of the same: what a factor is made of.
OwnedSum Stepper::upper_of(const Level& level) const {
  const bool unfiltered = filtered_ && bulk_.geometric != nullptr;
  if (!bulk_.distributed() && (shift_.size() > 0 || unfiltered)) return {matrix_of(level).triangularView<upper_triangle>(), {}};
  OwnedSum sum = bulk_.upper(1, level.damping, level.mass);
  if (!bulk_.distributed()) return sum;
  if (shift_.size() > 0) sum.here += Sparse(Sparse(b_.transpose() * shift_.asDiagonal() * b_).triangularView<upper_triangle>());
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
