#include "uplift/dynamics/statics.h"

#include <fmt/format.h>

#include <utility>

#include "uplift/dynamics/plastic_bulk.h"
#include "uplift/model/geometric.h"
#include "uplift/model/matrix_sum.h"
#include "uplift/model/reduced.h"
#include "uplift/run/buckling.h"
#include "uplift/run/runner.h"

namespace uplift {

std::vector<int> rotations_on_interfaces(const Model& model, const Sparse& b) {
  std::vector<int> rotations;
  if (is_reduced(model)) return rotations;  // its unknowns are not those of nodes
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
  const Energies before = run_.handover ? run_.handover->energies : run_.static_energies;
  Energies energies = before;
  Recorder recorder(resting, plan_, run_.state, energies, nullptr, bases_.views(), {resting, second_order_of(stage)}, stage.steps, 0,
                    run_.load_steps);
  const auto record = [&](const StaticProgress& progress) {
    energies = static_energies(resting, before, progress);
    bases_.look(run_.state);
    recorder.record(true, run_.static_stages + progress.share);
  };
  if (run_.state.load_factor == 0) {
    run_.unloaded_energy = static_energies(resting, before, {}).sum();
    record({});
  }
  const auto after_step = [&](const StaticProgress& progress) {
    record(progress);
    return bases_.moves_little(run_.state, resting, rotations, progress.share);
  };
  const bool begins_second_order = stage.p_delta && geometric_ == nullptr;
  bool solved = stage.p_delta && geometric_ != nullptr ? solve_second_order(stage, after_step) : solve(stage, nullptr, nullptr, after_step);
  recorder.finish();
  if (solved && begins_second_order)
    solved = stand_in_second_order(stage, before, energies) && bases_.moves_little(run_.state, resting, rotations, 1);
  ++run_.static_stages;
  run_.static_energies = energies;
  if (run_.handover) run_.result.final_energy = run_.handover->energies = energies;
  show(stage, nullptr, stage.steps, true);
  return solved;
}

/// Solves a static stage; false when there is no equilibrium, or when `after_step` has ended it.
bool Runner::solve(const Stage& stage, const Sparse* geometric, const std::vector<TimeLoad>* second_order,
                   const std::function<bool(const StaticProgress&)>& after_step) {
  const Model& resting = rest_ != nullptr ? *rest_ : model_;
  const Sparse b = rest_ != nullptr ? stack_interfaces(*rest_) : b_;
  const Bulk bulk(plan_.solver->matrices_of(resting), geometric);
  const StaticOptions options{stage.steps, stage.halvings, second_order, {}, after_step};
  const StaticOutcome outcome =
      solve_statics({resting, bulk, b, gap_}, {*laws_, *plan_.method}, *plan_.solver, options, run_.state, run_.linear);
  run_.result.counts.load_steps += outcome.steps;
  run_.result.counts.retries += outcome.retries;
  run_.result.counts.iterations += outcome.iterations;
  run_.result.not_unique = outcome.not_unique;
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
  energies.strain = 0.5 * run_.state.displacement.dot(stiffness_times(plan_.solver->matrices_of(resting), run_.state.displacement));
  if (const PlasticBulk yielding(resting); yielding.any())
    energies.strain += yielding.energy(run_.state.displacement, run_.state.instant(), yielding.state(run_.state.bulk_history));
  InterfaceEnergy interfaces;
  interfaces.update(blocks_of(model_, *laws_).blocks, run_.state.opening, run_.state.history);
  energies.stored = interfaces.stored, energies.interface_dissipated = interfaces.dissipated + energies.friction;
  if (run_.handover)
    energies.stop += before.sum() - energies.sum();
  else
    energies.residual = energies.sum() - run_.unloaded_energy;
  return energies;
}

/// Static stages alone: how the structure stands at their end, or where they ended the run, is the result; the table has their load steps.
/// What the verdict calls left is then measured from the unloaded structure.
void Runner::stand() {
  {
    const ForceStage resting{rest_ != nullptr ? *rest_ : model_, second_order_of(plan_.stages.back())};
    const Vector still = Vector::Zero(resting.model.free());
    EquilibriumCheck equilibrium(resting);
    equilibrium.note(StepBalance::at_rest(run_.state, still));
    equilibrium.finish(run_.result.equilibrium);
  }
  if (rest_ != nullptr) run_.state = carried();
  run_.result.final_energy = run_.static_energies;
  bases_.reserve(0, 1);
  bases_.note(run_.state);
  bases_.sum_up(0);
  for (const InterfaceView& view : bases_.views()) run_.result.steps.rest.push_back(view.resultant);
  Recorder recorder(model_, plan_, run_.state, run_.result.final_energy, nullptr, bases_.views(),
                    {model_, second_order_of(plan_.stages.back())}, 0, 0, run_.result);
  recorder.record(true);
  if (plan_.frames > 0) recorder.picture(run_.state);
  recorder.finish();
  run_.result.table = std::move(run_.load_steps.table);
  run_.result.combined = std::move(run_.load_steps.combined);
}

/// The geometric stiffness of the present static state, and equilibrium with it.
bool Runner::second_order(const std::function<bool(const StaticProgress&)>& after_step) {
  const Model& resting = rest_ != nullptr ? *rest_ : model_;
  run_.second_order = uplift::second_order(resting, run_.state);
  use_second_order();
  if (const auto share = buckling_share(model_, *geometric_, *plan_.solver)) {
    fail(fmt::format("P-delta: the structure buckles under {:.4g} times its dead loads: with the whole of them K + K_g is not positive "
                     "definite, even with all interfaces bonded",
                     *share),
         nullptr);
    return false;
  }
  if (run_.state.displacement.isZero(0)) return true;
  Stage again;
  again.type = Stage::Type::statics;
  again.steps = 1;
  return solve_second_order(again, after_step);
}

/// Solves a static stage with the geometric stiffness.
bool Runner::solve_second_order(const Stage& stage, const std::function<bool(const StaticProgress&)>& after_step) {
  if (rest_ == nullptr) return solve(stage, geometric_.get(), &second_order_loads_, after_step);
  const Sparse reduction = rest_->reduction(), geometric = reduction.transpose() * run_.second_order->stiffness * reduction;
  const std::vector<TimeLoad> time_loads = second_order_loads(*rest_);
  return solve(stage, &geometric, &time_loads, after_step);
}

/// After the load steps of first order: the equilibrium of second order under their loads, with the axial forces that they have led to. One
/// more row of the table of load steps. The external work is then what has been done to the structure on a slow way between both, that of
/// the loads with the motions of second order among it.
bool Runner::stand_in_second_order(const Stage& stage, const Energies& before, Energies& energies) {
  const Model& resting = rest_ != nullptr ? *rest_ : model_;
  StaticProgress all{1, energies.external - before.external, energies.plastic - before.plastic, energies.friction - before.friction};
  const auto add = [&](const StaticProgress& again) {
    all.work += again.work, all.dissipated += again.dissipated, all.friction += again.friction;
    return true;
  };
  if (!second_order(add)) return false;
  energies = static_energies(resting, before, all);
  energies.external += std::exchange(energies.residual, 0);
  bases_.look(run_.state);
  Recorder recorder(resting, plan_, run_.state, energies, nullptr, bases_.views(), {resting, second_order_of(stage)}, 1, 0,
                    run_.load_steps);
  recorder.record(true, run_.static_stages + 1);
  recorder.finish();
  return true;
}

/// What follows from the second order for the free unknowns of the dynamic stages.
void Runner::use_second_order() {
  const Sparse reduction = model_.reduction();
  geometric_ = std::make_unique<Sparse>(reduction.transpose() * run_.second_order->stiffness * reduction);
  second_order_loads_ = second_order_loads(model_);
}

/// What prescribed motions do through the geometric stiffness.
std::vector<TimeLoad> Runner::second_order_loads(const Model& model) const {
  std::vector<TimeLoad> time_loads;
  for (const PrescribedMotion& motion : model.motions)
    if (Vector force = -(model.expansion * (run_.second_order->stiffness * motion.shape)); !force.isZero(0))
      time_loads.push_back({motion.name, std::move(force), motion.function});
  return time_loads;
}

/// The state of the model with all supports on the free unknowns of the one without those of static stages alone: the same displacements.
State Runner::carried() const {
  State state = run_.state;
  const Vector full = rest_->full(run_.state.displacement, 0, run_.state.instant());
  const Eigen::Index n = model_.free();
  state.displacement.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) state.displacement[i] = full[model_.kept[static_cast<std::size_t>(i)]];
  state.velocity = state.acceleration = Vector::Zero(n);
  return state;
}

/// Goes over to the model without these supports. What is missing for equilibrium, r = K u + B^T p - f, is what they have borne; from now
/// on it is a constant load, so that nothing moves when nothing shakes (docs/theory, eq 22).
void Runner::release() {
  run_.state = carried();
  run_.held = stiffness_times(plan_.solver->matrices_of(model_), run_.state.displacement);
  if (geometric_ != nullptr) run_.held += *geometric_ * run_.state.displacement;
  if (const PlasticBulk yielding(model_); yielding.any()) run_.held += yielding.state(run_.state.bulk_history).force;
  if (b_.rows() > 0) run_.held += b_.transpose() * run_.state.force;
  for (const TimeLoad& time_load : model_.time_loads)
    if (time_load.is_static()) run_.held -= time_load.factor(run_.state.time) * time_load.shape;
  for (const TimeLoad& time_load : second_order_loads_) run_.held -= time_load.factor(run_.state.time) * time_load.shape;
  rest_ = nullptr;
}

}  // namespace uplift
