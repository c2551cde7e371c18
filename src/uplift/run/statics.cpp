#include "uplift/dynamics/statics.h"

#include <fmt/format.h>

#include "uplift/dynamics/plastic_bulk.h"
#include "uplift/model/geometric.h"
#include "uplift/run/buckling.h"
#include "uplift/run/runner.h"

namespace uplift {

std::vector<int> rotations_on_interfaces(const Model& model, const Sparse& b) {
  std::vector<int> rotations;
  for (int column = 0; column < b.outerSize(); ++column)
    if (Sparse::InnerIterator(b, column) && model.space.is_rotation(model.kept[static_cast<std::size_t>(column)]))
      rotations.push_back(column);
  return rotations;
}

/// Every load step becomes a row of the table of load steps; before the first static stage also the unloaded structure. False when the run
/// ends here.
bool Runner::statics(const Stage& stage) {
  const Model& resting = rest_ != nullptr ? *rest_ : model_;
  const std::vector<int> rotations = rotations_on_interfaces(resting, rest_ != nullptr ? stack_interfaces(*rest_) : b_);
  const Energies before = ledger_ ? ledger_->energies : static_energies_;
  Energies energies = before;
  Recorder recorder(resting, plan_, state_, energies, nullptr, views_, {resting}, stage.steps, 0, load_steps_);
  const auto record = [&](const StaticProgress& progress) {
    energies = static_energies(resting, before, progress);
    viewer_.look(state_.opening, state_.mean_force, views_);
    recorder.record(true, static_stages_ + progress.share);
  };
  if (state_.load_factor == 0) {
    unloaded_energy_ = static_energies(resting, before, {}).sum();
    record({});
  }
  const bool solved = solve(stage, nullptr, nullptr, [&](const StaticProgress& progress) {
    record(progress);
    static_share_ = progress.share;
    find_farthest();
    return moves_little(resting, rotations);
  });
  static_share_.reset();
  recorder.finish();
  ++static_stages_;
  static_energies_ = energies;
  if (ledger_) result_.final_energy = ledger_->energies = energies;
  show(stage, nullptr, stage.steps, true);
  return solved;
}

/// Solves a static stage; false when there is no equilibrium, or when `after_step` has ended it.
bool Runner::solve(const Stage& stage, const Sparse* geometric, const std::vector<TimeLoad>* second_order,
                   const std::function<bool(const StaticProgress&)>& after_step) {
  const Model& resting = rest_ != nullptr ? *rest_ : model_;
  const Sparse b = rest_ != nullptr ? stack_interfaces(*rest_) : b_;
  const Bulk bulk(resting, geometric);
  const StaticOptions options{stage.steps, stage.halvings, second_order, {}, after_step};
  const StaticOutcome outcome = solve_statics(resting, bulk, b, gap_, *laws_, *plan_.method, *plan_.solver, options, state_, linear_);
  result_.counts.load_steps += outcome.steps;
  result_.counts.retries += outcome.retries;
  result_.counts.iterations += outcome.iterations;
  result_.not_unique = outcome.not_unique;
  if (!outcome.why.empty()) fail(outcome.why, outcome.failed ? &*outcome.failed : nullptr);
  return outcome.converged;
}

/// At this point of a static stage that begins with the energies `before`. After a dynamic stage it stops the structure, which is no motion
/// that a ledger could follow: what this takes (or what the way to rest needs) is booked as a term of its own.
Energies Runner::static_energies(const Model& resting, const Energies& before, const StaticProgress& progress) const {
  Energies energies = before;
  energies.kinetic = energies.filter = 0;
  energies.external += progress.work;
  energies.plastic += progress.dissipated;
  energies.friction += progress.friction;
  energies.strain = 0.5 * state_.displacement.dot(resting.stiffness * state_.displacement);
  if (const PlasticBulk yielding(resting); yielding.any())
    energies.strain += yielding.energy(state_.displacement, state_.instant(), yielding.state(state_.bulk_history));
  InterfaceEnergy interfaces;
  interfaces.update(blocks_of(model_, *laws_).blocks, state_.opening, state_.history);
  energies.stored = interfaces.stored, energies.interface_dissipated = interfaces.dissipated + energies.friction;
  if (ledger_)
    energies.stop += before.sum() - energies.sum();
  else
    energies.residual = energies.sum() - unloaded_energy_;
  return energies;
}

/// What the verdict holds the rest of the run against.
void Runner::note_rest() {
  viewer_.look(state_.opening, state_.mean_force, views_);
  for (std::size_t k = 0; k < views_.size(); ++k) {
    result_.steps.rest.push_back(views_[k].resultant);
    result_.steps.rest_poses.push_back(viewer_.pose(state_, k, views_[k]));
  }
}

/// Static stages alone: how the structure stands at their end, or where they ended the run, is the result; the table has their load steps.
/// What the verdict calls left is then measured from the unloaded structure.
void Runner::stand() {
  {
    const ForceStage resting{rest_ != nullptr ? *rest_ : model_};
    const Vector still = Vector::Zero(resting.model.free());
    EquilibriumCheck equilibrium(resting);
    equilibrium.note(StepBalance::at_rest(state_, still));
    equilibrium.finish(result_.equilibrium);
  }
  if (rest_ != nullptr) state_ = carried();
  result_.final_energy = static_energies_;
  result_.steps.reserve(model_.interfaces.size(), 1, 1);
  viewer_.look(state_.opening, state_.mean_force, views_);
  note_views();
  sum_up(0);
  for (const InterfaceView& view : views_) result_.steps.rest.push_back(view.resultant);
  Recorder recorder(model_, plan_, state_, result_.final_energy, nullptr, views_, {model_}, 0, 0, result_);
  recorder.record(true);
  recorder.finish();
  result_.table = std::move(load_steps_.table);
  if (plan_.frames > 0) recorder.picture(state_);
}

/// The geometric stiffness of the present static state, and equilibrium with it.
bool Runner::second_order() {
  const Model& resting = rest_ != nullptr ? *rest_ : model_;
  second_order_ = uplift::second_order(resting, state_);
  geometric_ = std::make_unique<Sparse>(model_.reduction.transpose() * second_order_.stiffness * model_.reduction);
  if (const auto share = buckling_share(model_, *geometric_, *plan_.solver)) {
    fail(fmt::format("P-delta: the structure buckles under {:.4g} times its dead loads: with the whole of them K + K_g is not positive "
                     "definite, even with all interfaces bonded",
                     *share),
         nullptr);
    return false;
  }
  second_order_loads_ = second_order_loads(model_);
  if (state_.displacement.isZero(0)) return true;
  Stage again;
  again.type = Stage::Type::statics;
  again.steps = 1;
  if (rest_ == nullptr) return solve(again, geometric_.get(), &second_order_loads_, {});
  const Sparse geometric = resting.reduction.transpose() * second_order_.stiffness * resting.reduction;
  const std::vector<TimeLoad> time_loads = second_order_loads(resting);
  return solve(again, &geometric, &time_loads, {});
}

/// What prescribed motions do through the geometric stiffness.
std::vector<TimeLoad> Runner::second_order_loads(const Model& model) const {
  std::vector<TimeLoad> time_loads;
  for (const PrescribedMotion& motion : model.motions)
    if (Vector force = -(model.reduction.transpose() * (second_order_.stiffness * motion.shape)); !force.isZero(0))
      time_loads.push_back({motion.name, std::move(force), motion.function});
  return time_loads;
}

/// The state of the model with all supports on the free unknowns of the one without those of static stages alone: the same displacements.
State Runner::carried() const {
  State state = state_;
  const Vector full = rest_->full(state_.displacement, 0, state_.instant());
  const Eigen::Index n = model_.free();
  state.displacement.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) state.displacement[i] = full[model_.kept[static_cast<std::size_t>(i)]];
  state.velocity = state.acceleration = Vector::Zero(n);
  return state;
}

/// Goes over to the model without these supports. What is missing for equilibrium, r = K u + B^T p - f, is what they have borne; from now
/// on it is a constant load, so that nothing moves when nothing shakes (docs/theory, eq 22).
void Runner::release() {
  state_ = carried();
  held_ = model_.stiffness * state_.displacement;
  if (geometric_ != nullptr) held_ += *geometric_ * state_.displacement;
  if (const PlasticBulk yielding(model_); yielding.any()) held_ += yielding.state(state_.bulk_history).force;
  if (b_.rows() > 0) held_ += b_.transpose() * state_.force;
  for (const TimeLoad& time_load : model_.time_loads)
    if (time_load.is_static()) held_ -= time_load.factor(state_.time) * time_load.shape;
  for (const TimeLoad& time_load : second_order_loads_) held_ -= time_load.factor(state_.time) * time_load.shape;
  rest_ = nullptr;
}

}  // namespace uplift
