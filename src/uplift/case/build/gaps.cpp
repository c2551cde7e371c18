#include <fmt/format.h>

#include <algorithm>

#include "uplift/case/build/model.h"
#include "uplift/case/schema/profile.h"

// Initial gaps at the points of an interface.
namespace uplift {
namespace {

/// Largest distance between the faces across the normal, as a share of the extent of the interface.
constexpr double most_offset = 1e-3;

Vec3 place_of(const std::vector<std::pair<int, double>>& side, const CaseNames& names) {
  Vec3 sum = Vec3::Zero();
  for (const auto& [node, shape] : side) sum += shape * names.positions[static_cast<std::size_t>(node)];
  return sum;
}

double extent(const std::vector<JointPoint>& points) {
  Vec3 least = points.front().position, most = least;
  for (const JointPoint& point : points) least = least.cwiseMin(point.position), most = most.cwiseMax(point.position);
  return (most - least).norm();
}

/// The distance of both sides along the normal. They must lie opposite to each other: a pressure between faces that are offset along the
/// interface would be a moment.
void take_geometry(const CaseInterface& interface, std::vector<JointPoint>& points, const CaseNames& names) {
  const double size = extent(points);
  for (JointPoint& point : points) {
    if (point.rigid_upper || point.lower.empty())
      fail(interface, "gap", "a gap in m for an interface whose faces are not both drawn (a footing, fixed ground)", "\"geometry\"");
    const Vec3 normal = point.normal.normalized(), apart = place_of(point.upper, names) - place_of(point.lower, names);
    const double gap = apart.dot(normal), offset = (apart - gap * normal).norm();
    if (size > 0 && offset > most_offset * size)
      fail(interface, "gap", fmt::format("sides that lie opposite to each other along the normal, within {:.3g} m", most_offset * size),
           fmt::format("an offset of {:.3g} m along the interface at {} m", offset, to_string(point.position, names.space)));
    if (gap < -1e-9 * size)
      fail(interface, "gap", "an upper side that is drawn above the lower one",
           fmt::format("sides that overlap by {:.3g} m at {} m", -gap, to_string(point.position, names.space)));
    point.gap += std::max(0.0, gap);
  }
}

}  // namespace

void set_gaps(const CaseInterface& interface, std::vector<JointPoint>& points, const CaseNames& names) {
  if (interface.gap_of_geometry) take_geometry(interface, points, names);
  if (!interface.gap_profile) return;
  const Profile profile = gap_profile(*interface.gap_profile, names.space);
  std::vector<Vec3> places;
  for (const JointPoint& point : points) places.push_back(point.position);
  profile.require_overlap(places);
  for (JointPoint& point : points) point.gap += profile.at(point.position);
}

}  // namespace uplift
