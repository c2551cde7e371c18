#include "uplift/io/results/interface_points.h"

#include <fmt/format.h>

namespace uplift {

std::string points_text(const Interface& interface) {
  constexpr int all = 12, first = 3, last = 2;
  const int count = interface.batch.points;
  std::string text;
  for (int i = 0; i < count; ++i) {
    if (count > all && i == first) text += ", ...";
    if (count > all && i >= first && i < count - last) continue;
    const Place& at = interface.position[static_cast<std::size_t>(i)];
    text += fmt::format("{}{} ({:.4g}, {:.4g}", text.empty() ? "" : ", ", i + 1, at.x() + 0.0, at.y() + 0.0);
    text += interface.space.dimension == 3 ? fmt::format(", {:.4g})", at.z() + 0.0) : ")";
  }
  return text + " m";
}

void write_points(ResultWriter& out, const Interface& interface) {
  const auto coordinates = [&](int axis) {
    std::vector<double> values;
    for (const Place& at : interface.position) values.push_back(at[axis]);
    return values;
  };
  out.object("positions", "coordinates and areas of all points, in the order of their numbers from 1 on", [&] {
    out.numbers("x", coordinates(0), "m", "coordinates x");
    out.numbers("y", coordinates(1), "m", "coordinates y");
    if (out.is_schema() || interface.space.dimension == 3) out.when(true).numbers("z", coordinates(2), "m", "coordinates z");
    out.numbers("area", {interface.area.data(), static_cast<std::size_t>(interface.area.size())}, "m2", "areas");
  });
}

}  // namespace uplift
