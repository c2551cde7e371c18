#include <algorithm>
#include <cmath>
#include <utility>

#include "uplift/contact/impact/projection.h"
#include "uplift/dynamics/step_level.h"

// The acceleration at the beginning of a dynamic stage under constraints, and the contact forces that belong to it.
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
  if (b_.rows() == 0 || now_.velocity.isZero(0)) return;
  const Vector rate = b_ * now_.velocity;
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
  const Vector rate = b_ * now_.velocity;
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
    project_rate(data, acceleration, 1, Select::all, impact_scratch_);
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
  if (!carries) slide_initially(blocks, data, free);
  now_.force = now_.mean_force = contact_;
}

}  // namespace uplift
