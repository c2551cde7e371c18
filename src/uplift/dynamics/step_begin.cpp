#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "uplift/contact/impact/projection.h"
#include "uplift/dynamics/step_level.h"
#include "uplift/linear/memory.h"

// The beginning of a dynamic stage, or of a run that goes on: what follows from the state. Under constraints the acceleration at the
// beginning and the contact forces belong to each other.
namespace uplift {
namespace {

/// The points of a cone with friction that a stage begins on, and what they carry together.
struct Sliding {
  const Block* block;
  double friction;
  std::array<double, 2> direction{};  // unit: of the force on the rows along the tangents
};

/// Sums over the points of a block.
struct Carried {
  double pressure = 0;              // N, compression > 0
  std::array<double, 2> tangent{};  // N
  double size() const { return std::hypot(tangent[0], tangent[1]); }
};
Carried carried_by(const Block& block, const Vector& force) {
  const int n = block.batch.points;
  Carried sum;
  sum.pressure = -force.segment(block.first + block.batch.normal(), n).sum();
  for (int c = 0; c + 1 < block.batch.components; ++c)
    sum.tangent[static_cast<std::size_t>(c)] = force.segment(block.first + c * n, n).sum();
  return sum;
}

}  // namespace

/// Points whose faces part from the first instant on press no longer, whatever the stage before says.
void Stepper::release_parting() {
  if (b_.rows() == 0 || (now_.velocity.isZero(0) && !gap_moves_)) return;
  Vector rate = b_ * now_.velocity;
  if (gap_moves_) rate += moved_velocity_;
  const double nothing = 1e-12 * rate.cwiseAbs().maxCoeff();
  for (const Block& block : blocks_of(model_, behaviours_).blocks) {
    if (block.cone == nullptr) continue;
    const int n = block.batch.points, normal = block.first + block.batch.normal();
    for (int i = 0; i < n; ++i)
      if (rate[normal + i] > nothing)
        for (int c = 0; c < block.batch.components; ++c) now_.force[block.first + c * n + i] = now_.mean_force[block.first + c * n + i] = 0;
  }
}

/// The rows on which a stage begins without any contact force: closed normal rows that do not open, and the tangents of their points, which
/// are taken to stick. False when there are none.
bool Stepper::select_closed(const std::vector<Block>& blocks) {
  Vector rate = b_ * now_.velocity;
  if (gap_moves_) rate += moved_velocity_;
  bool any = false;
  pressed_.setZero(b_.rows());
  tangents_.clear();
  for (const Block& block : blocks) {
    if (block.cone == nullptr) continue;
    const int n = block.batch.points, normal = block.first + block.batch.normal();
    for (int i = normal; i < normal + n; ++i) {
      if (now_.opening[i] > closed_gap_ || rate[i] > 0) continue;
      pressed_[i] = row_area_[i];
      any = true;
      if (block.cone->friction() > 0)
        for (int c = 0; c + 1 < block.batch.components; ++c) tangents_.push_back(i - normal + block.first + c * n);
    }
  }
  return any;
}

/// Projects an acceleration without contact forces onto the active rows. Closed points stay closed or open (inequality), sticking ones
/// stick. contact_ receives the forces of the active rows. False when there are none.
bool Stepper::project_initial(Impact& data, Vector& acceleration) {
  std::swap(data.tangents, tangents_);
  const bool any = select_rows(data, Hold::inequality, impact_scratch_);
  if (any) {
    project_rate(data, acceleration, data.moved_acceleration, 1, Select::all, impact_scratch_);
    correct(data, 1, acceleration, impact_scratch_);
    for (Eigen::Index row = 0; row < pressed_.size(); ++row)
      if (pressed_[row] > 0) contact_[row] = impact_scratch_.impulse[row];
    for (const int row : data.tangents) contact_[row] = impact_scratch_.impulse[row];
  }
  std::swap(data.tangents, tangents_);
  return any;
}

/// A stage that begins on closed points without any contact force: bases whose sticking would need more than the friction slide against
/// it. The friction depends on the pressure and the pressure on the friction: a few rounds.
void Stepper::slide_initially(const std::vector<Block>& blocks, Impact& data, const Vector& free) {
  constexpr int most_rounds = 100;
  std::vector<Sliding> sliding;
  for (const Block& block : blocks) {
    if (block.cone == nullptr || !(block.cone->friction() > 0)) continue;
    const Carried sum = carried_by(block, contact_);
    if (sum.size() <= block.cone->friction() * sum.pressure * (1 + 1e-9)) continue;
    sliding.push_back({&block, block.cone->friction(), {sum.tangent[0] / sum.size(), sum.tangent[1] / sum.size()}});
    std::erase_if(tangents_, [&](int row) { return row >= block.first && row < block.first + block.batch.normal(); });
  }
  for (int round = 0; round < most_rounds && !sliding.empty(); ++round) {
    const Vector before = contact_;
    Vector friction = Vector::Zero(b_.rows());
    for (const Sliding& each : sliding) {
      const int n = each.block->batch.points, normal = each.block->first + each.block->batch.normal();
      for (int c = 0; c + 1 < each.block->batch.components; ++c) {
        const int first = each.block->first + c * n;
        friction.segment(first, n) = -each.friction * each.direction[static_cast<std::size_t>(c)] * before.segment(normal, n);
        contact_.segment(first, n) = friction.segment(first, n);
      }
    }
    now_.acceleration = free;
    mass_spread_->add(-1, mass_spread_->factor.transpose() * friction, now_.acceleration);
    project_initial(data, now_.acceleration);
    if ((contact_ - before).norm() <= 1e-12 * contact_.norm()) return;
  }
}

/// Those of the stage before hold another load; a stage without one before it may begin on closed points, which press from the first
/// instant on.
void Stepper::hold_initial_acceleration() {
  const std::vector<Block> blocks = blocks_of(model_, behaviours_).blocks;
  if (std::ranges::none_of(blocks, [](const Block& block) { return block.cone != nullptr; })) return;
  if (mass_spread_ == nullptr) prepare_impacts();
  if (mass_spread_ == nullptr) return;
  const bool carries = std::ranges::any_of(
      blocks, [&](const Block& block) { return block.cone != nullptr && !now_.force.segment(block.first, block.rows()).isZero(0); });
  if (!(carries ? select_pressed(blocks, now_.force) : select_closed(blocks))) return;
  Impact data = impact_data(now_.force);
  const Vector free = now_.acceleration;
  contact_ = now_.force;
  if (!project_initial(data, now_.acceleration)) return;
  slide_initially(blocks, data, free);
  now_.force = now_.mean_force = contact_;
}

/// Work space of the size of the bulk and of the interfaces.
void Stepper::make_room() {
  const Eigen::Index n = bulk_.unknowns;
  for (Vector* v : {&force_now_, &force_next_, &stiff_now_, &momentum_now_, &right_, &increment_, &work_, &work2_}) v->setZero(n);
  if (filtered_) stiff_next_.setZero(n), momentum_next_.setZero(n);
  contact_.setZero(b_.rows());
  impulse_.setZero(b_.rows());
  if (impacts_) {
    lag_.setZero(n);
    for (Kick* kick : {&kick_, &kick_next_, &unkicked_}) {
      kick->acceleration.setZero(n);
      kick->force.setZero(b_.rows());
    }
  }
}

void Stepper::set_kick(const Ledger& from) {
  if (from.kick.step > 0) kick_ = from.kick;
}

void Stepper::start(State state, const Ledger* before) {
  now_ = std::move(state);
  start_time_ = now_.time;
  if (newton_ != nullptr) {
    plastic_now_ = yielding_.state(std::move(now_.bulk_history));
    now_.bulk_history = plastic_now_.history;
  }
  const Eigen::Index n = bulk_.unknowns;
  make_room();
  if (path_) {
    now_.acceleration.resize(0);
  } else if (before == nullptr || !before->acceleration) {
    if (gap_moves_) move_rates(now_.time);
    release_parting();
    forces_at(now_, work_);
    now_.acceleration.setZero(n);
    accelerator().solve(work_, now_.acceleration);
    hold_initial_acceleration();
    if (!impacts_) {  // the factor is large, and the scheme carries accelerations on
      mass_spread_.reset();
      accelerator_.reset();
    }
  }
  level(0);
  if (!bulk_.small) {
    give_back_free_memory();  // of the factorisation
    pair_ = solver_.pair(bulk_.stiffness_matrix, bulk_.mass_matrix);
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
  impact_loss_ = energies_.impact;
  if (forgets) energies_.algorithmic += std::exchange(energies_.filter, 0);
  origin_ = energies_.sum() - energies_.residual;
  initial_energy_ =
      before != nullptr ? before->initial_energy : energies_.kinetic + energies_.strain + energies_.stored + energies_.interface_dissipated;
  largest_external_ = before != nullptr ? before->largest_external : 0;
  if (before != nullptr && before->acceleration && !path_) set_kick(*before);
}

/// What follows from the present state: filtered products, forces, products with the matrices, energy of the interfaces.
void Stepper::follow_state() {
  if (velocity_before_.size() > 0) velocity_before_ = now_.velocity;
  if (filtered_) begin_filters();
  next_ = now_;
  force_at(now_.time, force_now_);
  products(now_.displacement, now_.velocity, stiff_now_, momentum_now_);
  interface_energy_.update(blocks_of(model_, behaviours_).blocks, now_.opening, now_.history);
}

State Stepper::whole_state() const {
  State state = now_;
  if (joint_filter_ != nullptr) joint_filter_->give(state.filter);
  return state;
}

MarchState Stepper::march_state() const {
  MarchState march{whole_state(), ledger(), counts_, start_time_, origin_, {}};
  for (std::size_t halving = 0; halving < levels_.size(); ++halving)
    if (levels_[halving] != nullptr) march.sizes.push_back(static_cast<int>(halving));
  return march;
}

void Stepper::resume(MarchState from) {
  now_ = std::move(from.state);
  make_room();
  for (const int halving : from.sizes) level(halving);
  if (!bulk_.small) {
    give_back_free_memory();
    pair_ = solver_.pair(bulk_.stiffness_matrix, bulk_.mass_matrix);
  }
  energies_ = from.ledger.energies;
  initial_energy_ = from.ledger.initial_energy;
  largest_external_ = from.ledger.largest_external;
  set_kick(from.ledger);
  impact_loss_ = energies_.impact;
  counts_ = from.counts;
  start_time_ = from.start_time;
  origin_ = from.origin;
  reenter();
}

void Stepper::reenter() {
  for (const std::unique_ptr<Level>& level : levels_)
    if (level != nullptr && level->solver != nullptr) level->solver->forget();
  impact_scratch_ = {};
  interface_energy_ = {};
  if (joint_filter_ != nullptr) joint_filter_->give(now_.filter);
  if (newton_ != nullptr) {
    newton_->forget();
    plastic_now_ = yielding_.state(now_.bulk_history);
  }
  follow_state();
}

}  // namespace uplift
