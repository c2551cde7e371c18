#include "uplift/dynamics/energy.h"

#include <algorithm>

#include "uplift/math/small.h"

namespace uplift {

void InterfaceEnergy::update(const std::vector<Block>& blocks, const Vector& opening, const Vector& history) {
  const bool changed = last_.size() != history.size() || !std::equal(last_.data(), last_.data() + last_.size(), history.data());
  if (changed) last_ = history;
  stored = 0;
  double lost = 0;
  for (const Block& block : blocks) {
    if (block.law == nullptr) continue;
    const Index points = block.batch.points;
    if (density_.size() < points) density_.resize(points), lost_.resize(points);
    block.law->energy(block.batch, opening.data() + block.first, history.data() + block.first_history, density_.data(),
                      changed ? lost_.data() : nullptr);
    stored += small::dot(block.batch.points, density_.data(), block.area.data());
    if (changed) lost += small::dot(block.batch.points, lost_.data(), block.area.data());
  }
  if (changed) dissipated = lost;
}

double friction_work(const std::vector<Block>& blocks, const State& from, const State& to, double end_share) {
  double total = 0;
  for (const Block& block : blocks) {
    if (block.cone == nullptr || !(block.cone->friction() > 0)) continue;
    const int n = block.batch.points;
    for (int i = 0; i < n; ++i) {
      double work = 0;
      for (int row = block.first + i; row < block.first + block.batch.normal(); row += n)
        work += ((1 - end_share) * from.force[row] + end_share * to.force[row]) * (to.opening[row] - from.opening[row]);
      total += std::max(0.0, work);
    }
  }
  return total;
}

}  // namespace uplift
