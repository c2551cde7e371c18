#include <cmath>
#include <numbers>

#include "uplift/case/build/model.h"
#include "uplift/elements/discrete.h"

// [[foundation]]: a footing on one point with rotations.
namespace uplift {
namespace {

/// Edges in the plane, corners in space; of a disc points round it, the same for all azimuths.
std::vector<Place> corners_of(const Footprint& footprint, Space space, const JointPoint& point) {
  if (space.dimension == 2) {
    const Vec3 along = 0.5 * footprint.width * local_axis(space, point.normal, 0);
    return {point.position - along, point.position + along};
  }
  const double azimuth = footprint.shape == Footprint::Shape::disc ? 0 : footprint.azimuth;
  const Vec3 along = 0.5 * footprint.width * turned_axis(point.normal, azimuth, 0);
  const Vec3 across = 0.5 * footprint.length * turned_axis(point.normal, azimuth, 1);
  if (footprint.shape != Footprint::Shape::disc)
    return {point.position - along - across, point.position + along - across, point.position + along + across,
            point.position - along + across};
  constexpr int count = 24;
  std::vector<Place> corners;
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * k / count;
    corners.push_back(point.position + std::cos(angle) * along + std::sin(angle) * across);
  }
  return corners;
}

}  // namespace

Footprint footprint_of(const CaseFoundation& foundation, Space space) {
  Footprint made;
  made.shape = foundation.shape;
  made.width = foundation.width;
  made.dimension = space.dimension;
  made.azimuth = foundation.azimuth;
  if (space.dimension == 2 && made.azimuth != 0)
    fail(foundation, "azimuth", "no azimuth in the plane: the width lies along the x axis", "one");
  const bool disc = made.shape == Footprint::Shape::disc, strip = made.shape == Footprint::Shape::strip;
  if (disc && foundation.length) fail(foundation, "length", "no length: the width of a disc is its diameter", "one");
  if (strip && space.dimension == 3) fail(foundation, "shape", "rectangle or disc in space", "strip");
  if (space.dimension == 3 && !disc && !foundation.length) fail(foundation, "", "the length of a rectangle in space", "none");
  made.length = disc ? made.width : foundation.length.value_or(1);
  const Values* soil = foundation.soil;
  if (soil && !disc && !strip && !foundation.length) fail(foundation, "", "the length of a rectangle on [foundation.soil]", "none");
  if (soil) made.soil = footing_on_soil(*soil, made);
  return made;
}

std::unique_ptr<const Element> radiation_dashpot(const CaseFoundation& foundation, const Footprint& footprint, const CaseNames& names) {
  const std::vector<double> damping = radiation_damping(footprint);
  if (damping.empty()) return nullptr;
  const Space space = names.space;
  const bool plane = space.dimension == 2;
  const Vec3 along(damping[0], damping[1], plane ? 0 : damping[2]);
  const Vec3 about = plane ? Vec3(0, 0, damping[2]) : Vec3(damping[3], damping[4], damping[5]);
  Mat3 axes = Mat3::Identity();  // of the foundation, one in each column
  if (!plane)
    for (int k = 0; k < 3; ++k) axes.col(k) = turned_axis(space.axis(space.up()), footprint.azimuth, k);
  const auto tensor = [&](const Vec3& values) { return Mat3(axes * values.asDiagonal() * axes.transpose()); };
  Vec3 offset = Vec3::Zero();
  if (foundation.offset) offset = foundation.offset->in(space);
  return std::make_unique<PointDashpot>(space, names.node(foundation.body), tensor(along), tensor(about), offset);
}

Joint foundation_joint(const CaseFoundation& foundation, const Footprint& footprint, const CaseNames& names) {
  const int body = names.node(foundation.body);
  const Space space = names.space;
  JointPoint point;
  point.position = names.positions[static_cast<std::size_t>(body)];
  if (foundation.offset) point.position += foundation.offset->in(space);
  point.normal = space.axis(space.up());
  point.area = 1;
  point.upper = {{body, 1.0}};
  point.rigid_upper = true;
  Joint joint{{point}, {}, point.position};
  joint.facts.name = foundation.name.name;
  joint.facts.body = names.nodes[body];
  joint.facts.upper = {body};
  joint.facts.area = footprint.area();
  if (footprint.soil) joint.facts.soil = std::make_shared<const FootingOnSoil>(*footprint.soil);
  joint.facts.depth = space.dimension == 2 ? footprint.length : 0;
  joint.facts.corners = corners_of(footprint, space, point);
  return joint;
}

}  // namespace uplift
