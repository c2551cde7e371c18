#include "uplift/case/build/water.h"

#include <fmt/format.h>

#include <algorithm>

#include "uplift/base/format.h"
#include "uplift/base/text.h"

namespace uplift {

void set_water(const Values& interface, std::vector<JointPoint>& points, const CaseNames& names) {
  const Values* water = table_if(interface, "water");
  if (!water) return;
  const bool by_level = first_of_two(*water, "level", "head");
  const int up = names.space.up();
  double most = 0;
  for (JointPoint& point : points) {
    const double head = by_level ? water->number("level") - point.position[up] : water->number("head");
    point.water = water->number("unit_weight") * std::max(0.0, head);
    most = std::max(most, point.water);
  }
  if (by_level && !(most > 0))
    fail(*water, "level", "a level above the lowest point of the interface",
         fmt::format("{:g} m, with all points at {:.6g} m or higher", water->number("level"),
                     std::ranges::min(points, {}, [&](const JointPoint& point) { return point.position[up]; }).position[up]));
}

std::string note_of_water(const InterfacePart& part) {
  double force = 0, most = 0;  // N, Pa
  for (const JointPoint& point : part.joint.points) force += point.water * point.area, most = std::max(most, point.water);
  if (most == 0) return {};
  return fmt::format(
      "the water in the joint \"{}\" pushes with {} over {:.4g} m2 (at most {}); contact pressures are effective ones, in "
      "addition to it",
      part.name, format_quantity(force, "N"), part.joint.facts.area, format_quantity(most, "Pa"));
}

void check_second_order_water(const Case& read) {
  for (const CaseStage& stage : read.input->stages) {
    if (!stage.p_delta) continue;
    for (const Values& interface : read.values.tables("interface")) {
      const Values* footing = interface.has("water") ? table_if(interface, "footing") : nullptr;
      if (!footing || !footing->has("offset")) continue;
      fail(stage, "p_delta",
           fmt::format("without p_delta, or no offset of the footing with water: a body {} in the middle of the underside",
                       in_quotes(footing->text("body"))),
           fmt::format("an offset in the interface {}", in_quotes(interface.text("name"))));
    }
  }
}

}  // namespace uplift
