#include "uplift/case/build/water.h"

#include <fmt/format.h>

#include <algorithm>

#include "uplift/base/format.h"
#include "uplift/base/text.h"

namespace uplift {

void set_water(const std::optional<CaseWater>& water, std::vector<JointPoint>& points, const CaseNames& names) {
  if (!water) return;
  const int up = names.space.up();
  for (JointPoint& point : points) {
    const double head = water->level ? *water->level - point.position[up] : water->head;
    point.water = water->unit_weight * std::max(0.0, head);
  }
}

std::string note_of_water(const InterfacePart& part) {
  double force = 0, most = 0;  // N, Pa
  for (const JointPoint& point : part.joint.points) force += point.water * point.area, most = std::max(most, point.water);
  if (!part.water) return {};
  if (most == 0) return fmt::format("the water stands below the joint \"{}\": it has no pressure there", part.name);
  return fmt::format(
      "the water in the joint \"{}\" pushes with {} over {:.4g} m2 (at most {}); contact pressures are effective ones, in "
      "addition to it",
      part.name, format_quantity(force, "N"), part.joint.facts.area, format_quantity(most, "Pa"));
}

void check_second_order_water(const Case& read) {
  for (const CaseStage& stage : read.input->stages) {
    if (!stage.p_delta) continue;
    for (const CaseInterface& interface : read.input->interfaces) {
      const CaseFooting* footing = interface.footing();
      if (!interface.water || !footing || !footing->offset) continue;
      fail(stage, "p_delta",
           fmt::format("without p_delta, or no offset of the footing with water: a body {} in the middle of the underside",
                       in_quotes(footing->body.name)),
           fmt::format("an offset in the interface {}", in_quotes(interface.name.name)));
    }
  }
}

}  // namespace uplift
