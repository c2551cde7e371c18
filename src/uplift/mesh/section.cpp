#include "uplift/mesh/section.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "uplift/mesh/index.h"
#include "uplift/mesh/placed_cell.h"

namespace uplift {

std::vector<Vec3> section(Cell cell, std::span<const Vec3> corners, const HalfSpace& plane, double tolerance) {
  struct Found {
    Vec3 place;
    double angle = 0;
  };
  constexpr std::size_t most = max_corners + 12;  // a place on each corner and edge
  std::array<Found, most> found;
  std::size_t count = 0;
  const auto take = [&](const Vec3& place) {
    for (std::size_t k = 0; k < count; ++k)
      if ((place - found[k].place).norm() <= tolerance) return;
    found[count++].place = place;
  };
  std::array<double, max_corners> distance{};
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const double d = plane.distance(corners[k]);
    distance[k] = std::abs(d) <= tolerance ? 0 : d;
    if (distance[k] == 0) take(corners[k]);
  }
  const std::span<const int> edges = info(cell).edges;
  for (std::size_t e = 0; e + 1 < edges.size(); e += 2) {
    const std::size_t a = at(edges[e]), b = at(edges[e + 1]);
    if (distance[a] * distance[b] < 0) take(crossing(corners[a], distance[a], corners[b], distance[b]));
  }
  if (count < at(info(cell).dimension)) return {};
  const std::span<Found> all = std::span(found).first(count);
  if (info(cell).dimension == 3) {
    Vec3 middle = Vec3::Zero();
    for (const Found& each : all) middle += each.place / static_cast<double>(count);
    const Vec3 first = (all.front().place - middle).normalized(), second = cross(plane.normal, first);
    for (Found& each : all) each.angle = std::atan2(second.dot(each.place - middle), first.dot(each.place - middle));
    std::ranges::sort(all, {}, &Found::angle);
  }
  std::vector<Vec3> places(count);
  for (std::size_t k = 0; k < count; ++k) places[k] = all[k].place;
  return places;
}

std::vector<Vec3> clip_section(std::vector<Vec3> corners, const std::vector<HalfSpace>& within, double tolerance) {
  for (const HalfSpace& space : within) {
    std::vector<Vec3> left;
    const std::size_t n = corners.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 &a = corners[i], &b = corners[(i + 1) % n];
      const double at_a = space.distance(a), at_b = space.distance(b);
      if (at_a <= tolerance) left.push_back(a);
      const bool closing = n == 2 && i == 1;  // of a line
      if (!closing && ((at_a < -tolerance && at_b > tolerance) || (at_a > tolerance && at_b < -tolerance)))
        left.push_back(crossing(a, at_a, b, at_b));
    }
    corners = std::move(left);
    if (corners.size() < 2) return {};
  }
  return corners;
}

}  // namespace uplift
