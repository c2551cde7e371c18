#include "uplift/run/plan.h"

#include <algorithm>

namespace uplift {

const Stage* dynamic_stage(const RunPlan& plan) {
  for (const Stage& stage : plan.stages)
    if (stage.type == Stage::Type::dynamics) return &stage;
  return nullptr;
}

bool statics_alone(const RunPlan& plan) {
  return !plan.stages.empty() && dynamic_stage(plan) == nullptr;
}

std::vector<std::size_t> stopping_stages(const RunPlan& plan) {
  std::vector<std::size_t> found;
  for (std::size_t k = 1; k < plan.stages.size(); ++k)
    if (plan.stages[k].type == Stage::Type::statics && plan.stages[k - 1].type == Stage::Type::dynamics) found.push_back(k);
  return found;
}

int find_request(const std::vector<Request>& columns, Request::Kind kind, int unknown_or_interface) {
  using enum Request::Kind;
  const bool node = kind == displacement || kind == velocity || kind == acceleration || kind == absolute_acceleration;
  const auto found = std::ranges::find_if(columns, [&](const Request& column) {
    return column.kind == kind && column.below < 0 && (node ? column.unknown : column.interface) == unknown_or_interface;
  });
  return found == columns.end() ? -1 : static_cast<int>(found - columns.begin());
}

int find_request(const std::vector<Request>& columns, std::string_view name) {
  const auto found = std::ranges::find(columns, name, &Request::name);
  return found == columns.end() ? -1 : static_cast<int>(found - columns.begin());
}

}  // namespace uplift
