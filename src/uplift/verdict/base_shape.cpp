#include "uplift/verdict/base_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <ranges>

namespace uplift {
namespace {

using Point = std::array<double, 2>;

double turn(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Convex hull, counter-clockwise, by Andrew's monotone chain (Inf. Process. Lett. 9 (1979) 216-219); points within `flat` [m2] of an edge
/// are left out.
std::vector<Point> convex_hull(std::vector<Point> points, double flat) {
  std::ranges::sort(points);
  std::vector<Point> hull;
  const auto chain = [&](auto first, auto last) {
    const std::size_t start = hull.size();
    for (; first != last; ++first) {
      while (hull.size() >= start + 2 && turn(hull[hull.size() - 2], hull.back(), *first) <= flat) hull.pop_back();
      hull.push_back(*first);
    }
    hull.pop_back();  // the other chain begins with it
  };
  chain(points.begin(), points.end());
  chain(points.rbegin(), points.rend());
  return hull;
}

/// Direction of the side of a rectangle that is within 45 degrees of the first axis, of a square turned by 45 degrees the one
/// counter-clockwise from it; nothing for other outlines.
std::optional<Point> side_of_rectangle(const std::vector<Point>& hull) {
  constexpr double right_angle = 1e-6;  // its cosine at most
  const auto side = [&hull](std::size_t i) -> Point {
    const Point &from = hull[i % 4], &to = hull[(i + 1) % 4];
    const double length = std::hypot(to[0] - from[0], to[1] - from[1]);
    return {(to[0] - from[0]) / length, (to[1] - from[1]) / length};
  };
  if (hull.size() != 4) return std::nullopt;
  for (std::size_t i = 0; i < 4; ++i)
    if (const Point a = side(i), b = side(i + 1); std::abs(a[0] * b[0] + a[1] * b[1]) > right_angle) return std::nullopt;
  for (std::size_t i = 0; i < 4; ++i)  // one direction of four is within -45 to 45 degrees, the upper end included
    if (const Point a = side(i); a[0] > 0 && a[1] <= a[0] * (1 + right_angle) && a[1] > -a[0] * (1 - right_angle)) return a;
  return Point{1, 0};
}

/// Diameter of the circle on which the corners lie; nothing for other outlines. The nodes of a mesh are given with few digits.
std::optional<double> diameter_of(const std::vector<Point>& hull) {
  constexpr double on_circle = 1e-3;
  constexpr std::size_t fewest = 12;
  if (hull.size() < fewest) return std::nullopt;
  Point middle{};
  for (std::size_t k = 0; k < 2; ++k) {
    const auto [least, most] = std::ranges::minmax(hull | std::views::transform([k](const Point& point) { return point[k]; }));
    middle[k] = (least + most) / 2;
  }
  const auto [least, most] = std::ranges::minmax(
      hull | std::views::transform([&](const Point& point) { return std::hypot(point[0] - middle[0], point[1] - middle[1]); }));
  return most - least <= on_circle * most ? std::optional(2 * most) : std::nullopt;
}

}  // namespace

BaseShape::BaseShape(const Model& model, const Interface& interface, const InterfaceFacts& facts) {
  std::vector<Place> corners = facts.corners;
  if (corners.empty())
    for (const int node : facts.upper) corners.push_back(model.nodes[static_cast<std::size_t>(node)].position);
  if (corners.empty()) return;
  const Vec3 normal = mean_normal(interface);
  const int axes = interface.space.dimension - 1;
  std::vector<Point> points;
  for (const Place& corner : corners) {
    Point point{};
    for (int k = 0; k < axes; ++k)
      point[static_cast<std::size_t>(k)] = local_axis(interface.space, normal, k).dot(corner - interface.reference);
    points.push_back(point);
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(axes); ++k) {
    const auto [least, most] = std::ranges::minmax_element(points, {}, [k](const Point& point) { return point[k]; });
    width[k] = (*most)[k] - (*least)[k];
    if (axes == 1) edges_ = {{{1, 0}, (*most)[k]}, {{-1, 0}, -(*least)[k]}};
  }
  if (axes == 1) return;
  const std::vector<Point> hull = convex_hull(points, 1e-9 * width[0] * width[1]);
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point &from = hull[i], &to = hull[(i + 1) % hull.size()];
    const double length = std::hypot(to[0] - from[0], to[1] - from[1]);
    if (!(length > 0)) continue;
    const Point out{(to[1] - from[1]) / length, (from[0] - to[0]) / length};
    edges_.push_back({out, out[0] * from[0] + out[1] * from[1]});
  }
  const std::optional<Point> side = side_of_rectangle(hull);
  const std::optional<double> diameter = diameter_of(hull);
  outline = side ? Outline::rectangle : diameter ? Outline::round : Outline::other;
  if (side) first_ = *side;
  for (std::size_t k = 0; k < 2; ++k) {
    const auto [least, most] = std::ranges::minmax(points | std::views::transform([&](const Point& point) { return along(point, k); }));
    width[k] = diameter.value_or(most - least);
  }
}

double BaseShape::along(const std::array<double, 2>& vector, std::size_t axis) const {
  return axis == 0 ? first_[0] * vector[0] + first_[1] * vector[1] : first_[0] * vector[1] - first_[1] * vector[0];
}

double BaseShape::eccentricity(const Thrust& thrust, std::size_t axis) const {
  return along(thrust.first, axis) / (thrust.force * width[axis]);
}

double BaseShape::eccentricity(const Thrust& thrust) const {
  const double first = std::abs(eccentricity(thrust, 0)), second = width[1] > 0 ? std::abs(eccentricity(thrust, 1)) : 0;
  return outline == Outline::round ? std::hypot(first, second) : std::max(first, second);
}

double BaseShape::overturning_safety(const Thrust& stabilises, const Thrust& now) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Edge& edge : edges_) {
    const auto about = [&edge](const Thrust& thrust) {
      return thrust.force * edge.distance - edge.out[0] * thrust.first[0] - edge.out[1] * thrust.first[1];
    };
    const double stabilising = about(stabilises), driving = stabilising - about(now);
    if (stabilising > 0 && driving > 0) least = std::min(least, stabilising / driving);
  }
  return least;
}

}  // namespace uplift
