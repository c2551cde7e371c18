#include "uplift/run/floor_record.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace uplift {

bool records_accelerations(const RunPlan& plan) {
  return !plan.floors.empty() || std::ranges::any_of(plan.requests, [](const Request& request) {
    return request.kind == Request::Kind::acceleration || request.kind == Request::Kind::absolute_acceleration;
  });
}

double floor_record_bytes(const RunPlan& plan) {
  double steps = 0;
  for (const Stage& stage : plan.stages)
    if (stage.type == Stage::Type::dynamics) steps += std::round(stage.duration / stage.step) + 1;
  return 8 * steps * static_cast<double>(plan.floors.size());
}

FloorRecorder::FloorRecorder(const Model& model, const RunPlan& plan, long steps, double step, Recorded& result) : result_(result) {
  result_.floors.resize(plan.floors.size());
  for (std::size_t k = 0; k < plan.floors.size(); ++k) {
    const FloorRequest& floor = plan.floors[k];
    FloorRecord& record = result_.floors[k];
    assert(record.acceleration.empty() || std::abs(record.step - step) <= 1e-12 * step);
    record.step = step;
    record.acceleration.reserve(record.acceleration.size() + static_cast<std::size_t>(steps) + 1);
    Source source;
    for (int axis = 0; axis < model.space.dimension; ++axis) {
      const double share = floor.direction[axis];
      if (share == 0) continue;
      const int unknown = model.space.unknowns() * floor.node + axis;
      for (Sparse::InnerIterator entry(model.expansion, unknown); entry; ++entry)
        source.unknowns.emplace_back(static_cast<int>(entry.row()), share * entry.value());
      for (const PrescribedMotion& motion : model.motions)
        if (motion.shape[unknown] != 0) source.supports.emplace_back(motion.function.get(), share * motion.shape[unknown]);
    }
    for (const GroundAcceleration& ground : model.grounds)
      if (const double share = ground.direction.dot(floor.direction); share != 0) source.ground.emplace_back(ground.function.get(), share);
    sources_.push_back(std::move(source));
  }
}

void FloorRecorder::record(const Vector& acceleration, double from, double to) {
  const auto mean = [=](const auto& value) { return 0.5 * (value(from) + value(to)); };
  for (std::size_t k = 0; k < sources_.size(); ++k) {
    double sum = 0;
    for (const auto& [unknown, share] : sources_[k].unknowns) sum += share * acceleration[unknown];
    for (const auto& [function, share] : sources_[k].supports) sum += share * mean([&](double t) { return function->acceleration(t); });
    for (const auto& [function, share] : sources_[k].ground) sum += share * mean([&](double t) { return function->value(t); });
    result_.floors[k].acceleration.push_back(sum);
  }
}

}  // namespace uplift
