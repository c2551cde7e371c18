#include <algorithm>
#include <utility>

#include "uplift/dynamics/initial_contact.h"
#include "uplift/dynamics/step.h"
#include "uplift/linear/memory.h"

// The beginning of a dynamic stage, or of a run that goes on: what follows from the state.
namespace uplift {

/// Work space of the size of the bulk.
void Stepper::make_room() {
  const Eigen::Index n = stage_.bulk.unknowns;
  for (Vector* v : {&force_now_, &force_next_, &stiff_now_, &momentum_now_, &right_, &increment_, &work_}) v->setZero(n);
  if (filtered_) stiff_next_.setZero(n), momentum_next_.setZero(n);
}

/// The acceleration at the beginning, and contact forces of constraints that belong to it, from the balance.
void Stepper::begin_acceleration() {
  const std::vector<Block> blocks = blocks_of(stage_.model, contact_.laws).blocks;
  if (motion_.acts()) motion_.set_rates(now_.time);
  release_parting(blocks, stage_.b, motion_, now_);
  forces_at(now_, right_);
  now_.acceleration.setZero(stage_.bulk.unknowns);
  accelerator().solve(right_, now_.acceleration);
  const bool constrained = std::ranges::any_of(blocks, [](const Block& block) { return block.cone != nullptr; });
  if (impacts_ != nullptr && constrained) {
    hold_initial_acceleration(blocks, impacts_->rows(), now_);
  } else if (constrained && accelerator().why().empty()) {
    ContactRows rows(stage_.model, stage_.bulk, stage_.b, motion_, accelerator().spread(stage_.b));
    hold_initial_acceleration(blocks, rows, now_);
  }
  if (impact_ == nullptr) accelerator_.reset();  // the factor is large, and the scheme carries accelerations on
}

void Stepper::start(State state, const StageHandover* before) {
  now_ = std::move(state);
  start_time_ = now_.time;
  if (newton_ != nullptr) {
    plastic_now_ = yielding_.state(std::move(now_.bulk_history));
    now_.bulk_history = plastic_now_.history;
  }
  make_room();
  if (path_) {
    now_.acceleration.resize(0);
  } else if (before == nullptr || !before->acceleration) {
    begin_acceleration();
  }
  sizes_.at(0);
  if (!stage_.bulk.small) {
    give_back_free_memory();  // of the factorisation
    pair_ = solver_.pair(stage_.bulk.stiffness_matrix, stage_.bulk.mass_matrix);
  }
  const bool forgets = now_.filter.gain != options_.scheme.gain;  // what the filters of another scheme hold
  if (forgets) now_.filter = {};
  follow_state();
  energies_ = before != nullptr ? before->energies : Energies{};
  energies_.kinetic = 0.5 * now_.velocity.dot(momentum_now_);
  energies_.strain = 0.5 * now_.displacement.dot(stiff_now_);
  if (newton_ != nullptr) energies_.strain += yielding_.energy(now_.displacement, now_.time, plastic_now_);
  energies_.stored = interface_energy_.stored;
  energies_.interface_dissipated = interface_energy_.dissipated + energies_.friction;
  if (forgets) energies_.algorithmic += std::exchange(energies_.filter, 0);
  origin_ = energies_.sum() - energies_.residual;
  initial_energy_ =
      before != nullptr ? before->initial_energy : energies_.kinetic + energies_.strain + energies_.stored + energies_.interface_dissipated;
  largest_external_ = before != nullptr ? before->largest_external : 0;
  if (impacts_ != nullptr && before != nullptr && before->acceleration) impacts_->set_kick(before->kick);
}

/// What follows from the present state: filtered products, forces, products with the matrices, energy of the interfaces.
void Stepper::follow_state() {
  if (velocity_before_.size() > 0) velocity_before_ = now_.velocity;
  if (filtered_) begin_filters();
  next_ = now_;
  force_at(now_.time, force_now_);
  products(now_.displacement, now_.velocity, stiff_now_, momentum_now_);
  interface_energy_.update(blocks_of(stage_.model, contact_.laws).blocks, now_.opening, now_.history);
}

State Stepper::whole_state() const {
  State state = now_;
  if (joint_filter_ != nullptr) joint_filter_->give(state.filter);
  return state;
}

MarchState Stepper::march_state() const {
  return {whole_state(), handover(), counts_, start_time_, origin_, sizes_.made()};
}

void Stepper::resume(MarchState from) {
  now_ = std::move(from.state);
  make_room();
  for (const int halving : from.sizes) sizes_.at(halving);
  if (!stage_.bulk.small) {
    give_back_free_memory();
    pair_ = solver_.pair(stage_.bulk.stiffness_matrix, stage_.bulk.mass_matrix);
  }
  energies_ = from.handover.energies;
  initial_energy_ = from.handover.initial_energy;
  largest_external_ = from.handover.largest_external;
  if (impacts_ != nullptr) impacts_->set_kick(from.handover.kick);
  counts_ = from.counts;
  start_time_ = from.start_time;
  origin_ = from.origin;
  reenter();
}

void Stepper::reenter() {
  sizes_.forget();
  if (impacts_ != nullptr) impacts_->forget();
  interface_energy_ = {};
  if (joint_filter_ != nullptr) joint_filter_->give(now_.filter);
  if (newton_ != nullptr) {
    newton_->forget();
    plastic_now_ = yielding_.state(now_.bulk_history);
  }
  follow_state();
}

}  // namespace uplift
