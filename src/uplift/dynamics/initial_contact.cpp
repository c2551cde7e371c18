#include "uplift/dynamics/initial_contact.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "uplift/contact/impact/projection.h"

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

Vector opening_rate(const Sparse& b, const SupportMotion& motion, const Vector& velocity) {
  Vector rate = b * velocity;
  if (motion.acts()) rate += *motion.velocity();
  return rate;
}

/// The rows on which a stage begins without any contact force: closed normal rows that do not open, and the tangents of their points, which
/// are taken to stick. False when there are none.
bool select_closed(const std::vector<Block>& blocks, const State& state, ContactRows& rows) {
  const Vector rate = opening_rate(rows.b, rows.motion, state.velocity);
  bool any = false;
  rows.pressed.setZero(rows.b.rows());
  rows.tangents.clear();
  for (const Block& block : blocks) {
    if (block.cone == nullptr) continue;
    const int n = block.batch.points, normal = block.first + block.batch.normal();
    for (int i = normal; i < normal + n; ++i) {
      if (state.opening[i] > rows.closed_gap || rate[i] > 0) continue;
      rows.pressed[i] = rows.area[i];
      any = true;
      if (block.cone->friction() > 0)
        for (int c = 0; c + 1 < block.batch.components; ++c) rows.tangents.push_back(i - normal + block.first + c * n);
    }
  }
  return any;
}

/// Projects an acceleration without contact forces onto the active rows. Closed points stay closed or open (inequality), sticking ones
/// stick. `contact` receives the forces of the active rows. False when there are none.
bool project_initial(const ContactRows& rows, const Vector& given, Vector& acceleration, Vector& contact, ImpactScratch& scratch) {
  const Impact data = rows.impact(given);
  if (!select_rows(data, Hold::inequality, scratch)) return false;
  project_rate(data, acceleration, data.moved_acceleration, 1, Select::all, scratch);
  correct(data, 1, acceleration, scratch);
  for (Eigen::Index row = 0; row < rows.pressed.size(); ++row)
    if (rows.pressed[row] > 0) contact[row] = scratch.impulse[row];
  for (const int row : rows.tangents) contact[row] = scratch.impulse[row];
  return true;
}

}  // namespace

void release_parting(const std::vector<Block>& blocks, const Sparse& b, const SupportMotion& motion, State& state) {
  if (b.rows() == 0 || (state.velocity.isZero(0) && !motion.acts())) return;
  const Vector rate = opening_rate(b, motion, state.velocity);
  const double nothing = 1e-12 * rate.cwiseAbs().maxCoeff();
  for (const Block& block : blocks) {
    if (block.cone == nullptr) continue;
    const int n = block.batch.points, normal = block.first + block.batch.normal();
    for (int i = 0; i < n; ++i)
      if (rate[normal + i] > nothing)
        for (int c = 0; c < block.batch.components; ++c)
          state.force[block.first + c * n + i] = state.mean_force[block.first + c * n + i] = 0;
  }
}

/// Where sticking would need more than the friction, bases slide against it. The friction depends on the pressure and the pressure on the
/// friction: a few rounds.
void hold_initial_acceleration(const std::vector<Block>& blocks, ContactRows& rows, State& state) {
  constexpr int most_rounds = 100;
  const bool carries = std::ranges::any_of(
      blocks, [&](const Block& block) { return block.cone != nullptr && !state.force.segment(block.first, block.rows()).isZero(0); });
  if (!(carries ? rows.select_pressed(blocks, state.force) : select_closed(blocks, state, rows))) return;
  ImpactScratch scratch;
  const Vector free = state.acceleration;
  Vector contact = state.force;
  if (!project_initial(rows, state.force, state.acceleration, contact, scratch)) return;
  std::vector<Sliding> sliding;
  for (const Block& block : blocks) {
    if (block.cone == nullptr || !(block.cone->friction() > 0)) continue;
    const Carried sum = carried_by(block, contact);
    if (sum.size() <= block.cone->friction() * sum.pressure * (1 + 1e-9)) continue;
    sliding.push_back({&block, block.cone->friction(), {sum.tangent[0] / sum.size(), sum.tangent[1] / sum.size()}});
    std::erase_if(rows.tangents, [&](int row) { return row >= block.first && row < block.first + block.batch.normal(); });
  }
  for (int round = 0; round < most_rounds && !sliding.empty(); ++round) {
    const Vector before = contact;
    Vector friction = Vector::Zero(contact.size());
    for (const Sliding& each : sliding) {
      const int n = each.block->batch.points, normal = each.block->first + each.block->batch.normal();
      for (int c = 0; c + 1 < each.block->batch.components; ++c) {
        const int first = each.block->first + c * n;
        friction.segment(first, n) = -each.friction * each.direction[static_cast<std::size_t>(c)] * before.segment(normal, n);
        contact.segment(first, n) = friction.segment(first, n);
      }
    }
    state.acceleration = free;
    rows.mass.add(-1, rows.mass.factor.transpose() * friction, state.acceleration);
    project_initial(rows, state.force, state.acceleration, contact, scratch);
    if ((contact - before).norm() <= 1e-12 * contact.norm()) break;
  }
  state.force = state.mean_force = contact;
}

}  // namespace uplift
