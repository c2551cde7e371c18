#include "uplift/interface/joint.h"

#include <fmt/format.h>

#include "uplift/interface/interface.h"
#include "uplift/laws/soil_bed.h"
#include "uplift/math/shapes.h"

namespace uplift {

namespace {

void refuse_exchanged_sides(const Vec3& upper, const Vec3& lower, const Vec3& normal, Space space, const Where& where) {
  const Vec3 apart = upper - lower;
  // the initial gap is never taken from the coordinates, so only a clear distance counts
  if (apart.dot(normal) < -1e-9 * (1 + upper.norm() + lower.norm()))
    throw InputError(where, "interface.normal", "a normal from the lower to the upper side",
                     fmt::format("an interface inside out: the upper node at {} m lies on the lower side of its partner at {} m",
                                 to_string(upper, space), to_string(lower, space)));
}

Vec3 unit(const Vec3& v, const Where& where) {
  if (!(v.norm() > 0)) throw InputError(where, "interface.normal", "a direction", "a vector of length zero");
  return v.normalized();
}

void check_partners(std::size_t upper, std::size_t lower, const Where& where) {
  if (upper == 0) throw InputError(where, "interface.upper", "at least one node", "none");
  if (lower != 0 && lower != upper)
    throw InputError(where, "interface.lower", fmt::format("as many nodes as the upper side ({})", upper), fmt::format("{}", lower));
}

void check_points(FootingRule rule, int points, std::string_view key, const Where& where) {
  const int least = rule == FootingRule::nodal ? 2 : 1;
  if (points < least)
    throw InputError(where, fmt::format("interface.{}", key), fmt::format("at least {}", least), fmt::format("{}", points));
}

/// A point of one line element; the shape functions of both sides are the same.
JointPoint element_point(const LineJoint& joint, std::size_t first, double xi, double weight, const Where& where) {
  const LineShape shape = line_shape(joint.nodes_per_element, xi);
  JointPoint point;
  Vec3 along = Vec3::Zero();
  for (int k = 0; k < joint.nodes_per_element; ++k) {
    const SideNode& node = joint.upper[first + k];
    point.position += shape.value[k] * node.position;
    along += shape.slope[k] * node.position;
    if (shape.value[k] == 0) continue;  // nodal rule: one pair only
    point.upper.emplace_back(node.node, shape.value[k]);
    if (!joint.lower.empty()) point.lower.emplace_back(joint.lower[first + k].node, shape.value[k]);
  }
  if (!(along.norm() > 0)) throw InputError(where, "interface.upper", "nodes in order along a line", "neighbours that coincide");
  point.area = weight * along.norm() * joint.thickness;
  point.normal = Place(-along.y(), along.x()).normalized();
  point.gap = joint.gap;
  return point;
}

Vector relative_stiffness(const Quadrature& points, double ratio) {
  return ratio > 0 ? bed_distribution(points, ratio).value() : Vector(Vector::Ones(points.point.size()));
}

/// Direction of the width.
Vec3 direction_along(const Footing& footing, const Vec3& n) {
  return footing.length > 0 ? turned_axis(n, footing.azimuth, 0) : local_axis(Space{2}, n, 0);
}

}  // namespace

Quadrature footing_rule(FootingRule rule, int points) {
  switch (rule) {
    case FootingRule::nodal:
      return trapezoid(points);
    case FootingRule::midpoint:
      return midpoint(points);
    case FootingRule::gauss:
      break;
  }
  return gauss_legendre(points);
}

std::vector<JointPoint> footing_points(const Footing& footing, const Where& where) {
  const bool rectangle = footing.length > 0;
  check_points(footing.rule, footing.points, "points", where);
  if (rectangle) check_points(footing.rule, footing.points_across, "points_across", where);
  if (!(footing.width > 0)) throw InputError(where, "interface.width", "a width > 0 m", fmt::format("{:g}", footing.width));
  if (!(footing.thickness > 0)) throw InputError(where, "interface.thickness", "a thickness > 0 m", fmt::format("{:g}", footing.thickness));
  const Vec3 n = unit(footing.normal, where), along = direction_along(footing, n), across = cross(n, along);
  const Quadrature rule = footing_rule(footing.rule, footing.points);
  const Quadrature rule_across =
      rectangle ? footing_rule(footing.rule, footing.points_across) : Quadrature{Vector::Zero(1), Vector::Ones(1)};
  const Vector along_stiffness = relative_stiffness(rule, footing.ratio),
               across_stiffness = relative_stiffness(rule_across, footing.ratio_across);
  const double half = footing.width / 2, half_across = rectangle ? footing.length / 2 : footing.thickness;
  std::vector<JointPoint> points;
  for (Index j = 0; j < rule_across.point.size(); ++j)
    for (Index i = 0; i < rule.point.size(); ++i) {
      JointPoint point;
      point.position = footing.centre + half * rule.point[i] * along + half_across * rule_across.point[j] * across;
      point.normal = n;
      point.area = half * rule.weight[i] * half_across * rule_across.weight[j];
      point.stiffness = along_stiffness[i] * across_stiffness[j];
      point.gap = footing.gap;
      point.upper = {{footing.body, 1.0}};
      point.rigid_upper = true;
      points.push_back(std::move(point));
    }
  return points;
}

std::vector<Place> footing_corners(const Footing& footing) {
  const Vec3 n = footing.normal.normalized(), along = direction_along(footing, n), across = cross(n, along);
  std::vector<Place> corners;
  for (const double side : {-1.0, 1.0})
    for (const double far : {-1.0, 1.0})
      if (footing.length > 0 || far > 0)
        corners.push_back(footing.centre + side * footing.width / 2 * along + far * footing.length / 2 * across);
  return corners;
}

std::vector<JointPoint> pair_points(const std::vector<SideNode>& upper, const std::vector<SideNode>& lower, const Place& normal,
                                    double area, double gap, Space space, const Where& where) {
  check_partners(upper.size(), lower.size(), where);
  if (!(area > 0)) throw InputError(where, "interface.area", "an area > 0 m2", fmt::format("{:g}", area));
  const Vec3 n = unit(normal, where);
  std::vector<JointPoint> points;
  for (std::size_t i = 0; i < upper.size(); ++i) {
    JointPoint point;
    point.position = upper[i].position;
    point.normal = n;
    point.area = area;
    point.gap = gap;
    point.upper = {{upper[i].node, 1.0}};
    if (!lower.empty()) {
      refuse_exchanged_sides(upper[i].position, lower[i].position, n, space, where);
      point.lower = {{lower[i].node, 1.0}};
    }
    points.push_back(std::move(point));
  }
  return points;
}

std::vector<JointPoint> line_points(const LineJoint& joint, const Where& where) {
  const std::size_t per = joint.nodes_per_element;
  check_partners(joint.upper.size(), joint.lower.size(), where);
  if (per != 2 && per != 3) throw InputError(where, "interface.nodes_per_element", "2 or 3", fmt::format("{}", per));
  if (joint.upper.size() < per || (joint.upper.size() - 1) % (per - 1) != 0)
    throw InputError(where, "interface.upper",
                     fmt::format("{} nodes for the first joint element and {} more for each further one", per, per - 1),
                     fmt::format("{} nodes", joint.upper.size()));
  if (!(joint.thickness > 0)) throw InputError(where, "interface.thickness", "a thickness > 0 m", fmt::format("{:g}", joint.thickness));
  const bool nodal = joint.quadrature == LineQuadrature::nodal;
  const Quadrature rule = nodal ? gauss_lobatto(static_cast<int>(per)) : gauss_legendre(static_cast<int>(per));
  std::vector<JointPoint> points;
  for (std::size_t first = 0; first + per <= joint.upper.size(); first += per - 1) {
    for (std::size_t k = 0; k < per; ++k) {
      JointPoint point = element_point(joint, first, rule.point[static_cast<Index>(k)], rule.weight[static_cast<Index>(k)], where);
      if (!joint.lower.empty())
        refuse_exchanged_sides(joint.upper[first + k].position, joint.lower[first + k].position, point.normal, Space{2}, where);
      const bool shared = nodal && k == 0 && !points.empty() && (points.back().normal - point.normal).norm() < 1e-9;
      if (shared)
        points.back().area += point.area;
      else
        points.push_back(std::move(point));
    }
  }
  return points;
}

}  // namespace uplift
