#include "uplift/io/results/interface_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace uplift {

std::string points_text(const Interface& interface) {
  constexpr int all = 12, first = 3, last = 2;
  const int count = interface.batch.points;
  double size = 0;
  for (const Place& at : interface.position) size = std::max(size, (at - interface.position.front()).norm());
  const auto shown = [&](double x) { return std::abs(x) > 1e-12 * size ? x : 0.0; };  // no round-off of a middle at 0
  std::string text;
  for (int i = 0; i < count; ++i) {
    if (count > all && i == first) text += ", ...";
    if (count > all && i >= first && i < count - last) continue;
    const Place& at = interface.position[static_cast<std::size_t>(i)];
    text += fmt::format("{}{} ({:.4g}, {:.4g}", text.empty() ? "" : ", ", i + 1, shown(at.x()), shown(at.y()));
    text += interface.space.dimension == 3 ? fmt::format(", {:.4g})", shown(at.z())) : ")";
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
