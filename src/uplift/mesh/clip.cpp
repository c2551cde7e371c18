#include "uplift/mesh/clip.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <optional>

#include "uplift/mesh/cell_shapes.h"
#include "uplift/mesh/index.h"

namespace uplift {
namespace {

using Simplex = std::array<Vec3, 4>;  // as many as the dimension, and one more

Cell simplex_cell(int dimension) {
  return dimension == 1 ? Cell::line2 : dimension == 2 ? Cell::tri3 : Cell::tet4;
}

/// Length, area or volume of the cell over that of the reference cell.
double measure(Cell cell, const CellShape& shape, std::span<const Vec3> corners) {
  const Vec3 x = cell_tangent(shape, corners, 0);
  if (info(cell).dimension == 1) return x.norm();
  const Vec3 area = cross(x, cell_tangent(shape, corners, 1));
  return info(cell).dimension == 2 ? area.norm() : std::abs(area.dot(cell_tangent(shape, corners, 2)));
}

double measure(const Simplex& simplex, int dimension) {
  const Cell cell = simplex_cell(dimension);
  return measure(cell, cell_shape(cell, Vec3::Zero()), std::span(simplex).first(at(dimension) + 1));
}

bool is_simplex(Cell cell) {
  return info(cell).corners == info(cell).dimension + 1;
}

double size_of(std::span<const Vec3> corners) {
  double size = 0;
  for (const Vec3& corner : corners) size = std::max(size, (corner - corners.front()).norm());
  return size;
}

/// The Jacobian is the same everywhere.
bool has_parallel_sides(Cell cell, std::span<const Vec3> corners) {
  if (is_simplex(cell)) return true;
  const CellShape middle = cell_shape(cell, cell_centre(cell));
  const double tolerance = 1e-10 * size_of(corners);
  for (const auto& node : cell_nodes(cell)) {
    const CellShape shape = cell_shape(cell, {node[0], node[1], node[2]});
    for (int k = 0; k < info(cell).dimension; ++k)
      if ((cell_tangent(shape, corners, k) - cell_tangent(middle, corners, k)).norm() > tolerance) return false;
  }
  return true;
}

/// The one local coordinate that changes across the plane, of a cell with parallel sides; -1: several do.
int axis_across(Cell cell, std::span<const Vec3> corners, const HalfSpace& plane) {
  const CellShape middle = cell_shape(cell, cell_centre(cell));
  std::array<double, 3> slope{};
  for (int k = 0; k < info(cell).dimension; ++k) slope[at(k)] = std::abs(plane.normal.dot(cell_tangent(middle, corners, k)));
  const auto largest = std::ranges::max_element(slope);
  for (const double& each : slope)
    if (&each != &*largest && each > 1e-9 * *largest) return -1;
  return static_cast<int>(largest - slope.begin());
}

bool is_box(Cell cell) {
  return cell == Cell::line2 || cell == Cell::quad4 || cell == Cell::hex8;
}

/// Enough for stiffness and mass.
int degree_in_box(Cell cell) {
  return info(cell).dimension == 1 ? 3 : std::max(solid_degrees(cell)[0], solid_degrees(cell)[1]);
}

/// In all directions together: N^T N of a quad4, grad N^T grad N of a hex8.
int degree_in_simplex(Cell cell) {
  return is_simplex(cell) ? 2 : info(cell).dimension == 1 ? 3 : info(cell).dimension == 2 ? 4 : 5;
}

struct Box {
  std::array<double, 3> from{-1, -1, -1}, to{1, 1, 1};  // local coordinates
};

/// None: a plane is not parallel to sides of the cell.
std::optional<Box> box_within(Cell cell, std::span<const Vec3> corners, const std::vector<HalfSpace>& within, double tolerance) {
  if (!is_box(cell) || !has_parallel_sides(cell, corners)) return std::nullopt;
  Box box;
  const CellShape middle = cell_shape(cell, cell_centre(cell));
  const Vec3 centre = cell_position(middle, corners);
  for (const HalfSpace& space : within) {
    if (side_of_cell(space, corners, tolerance) == PlaneSide::inside) continue;
    const int k = axis_across(cell, corners, space);
    if (k < 0) return std::nullopt;
    const double slope = space.normal.dot(cell_tangent(middle, corners, k)), here = -space.distance(centre) / slope;
    double& end = slope > 0 ? box.to[at(k)] : box.from[at(k)];
    end = slope > 0 ? std::min(end, here) : std::max(end, here);
  }
  return box;
}

ClippedCell filled_box(Cell cell, std::span<const Vec3> corners, const Box& box) {
  ClippedCell made;
  const int d = info(cell).dimension;
  Vec3 middle = Vec3::Zero(), half = Vec3::Zero();
  double share = 1;
  for (int k = 0; k < d; ++k) {
    middle[k] = (box.from[at(k)] + box.to[at(k)]) / 2, half[k] = (box.to[at(k)] - box.from[at(k)]) / 2;
    if (half[k] <= 0) return made;
    share *= half[k];
  }
  const auto place = [&](const Vec3& local) { return Vec3(middle + half.cwiseProduct(local)); };
  made.rule = cell_rule(cell, degree_in_box(cell));
  for (Vec3& point : made.rule.point) point = place(point);
  for (double& weight : made.rule.weight) weight *= share;
  ClippedCell::Piece piece{cell, {}};
  for (const auto& node : cell_nodes(cell))
    piece.corners.push_back(cell_position(cell_shape(cell, place({node[0], node[1], node[2]})), corners));
  made.pieces.push_back(std::move(piece));
  return made;
}

/// Divides a linear cell. Where its faces are warped they are divided from their middle, so that the cells beside it fit.
std::vector<Simplex> simplices_of(Cell cell, std::span<const Vec3> x) {
  if (is_simplex(cell)) {
    Simplex one{};
    std::copy(x.begin(), x.end(), one.begin());
    return {one};
  }
  if (cell == Cell::quad4) return {{x[0], x[1], x[2]}, {x[0], x[2], x[3]}};
  if (cell == Cell::hex8 && has_parallel_sides(cell, x))  // round the diagonal 0-6
    return {{x[0], x[1], x[2], x[6]}, {x[0], x[2], x[3], x[6]}, {x[0], x[3], x[7], x[6]},
            {x[0], x[7], x[4], x[6]}, {x[0], x[4], x[5], x[6]}, {x[0], x[5], x[1], x[6]}};
  std::vector<Simplex> made;
  Vec3 centre = Vec3::Zero();
  for (const Vec3& corner : x) centre += corner / static_cast<double>(x.size());
  for (int side = 0; side < static_cast<int>(info(cell).sides.size()); ++side) {
    const std::span<const int> nodes = side_of(cell, side);
    if (nodes.size() == 3) {
      made.push_back({x[at(nodes[0])], x[at(nodes[1])], x[at(nodes[2])], centre});
      continue;
    }
    Vec3 middle = Vec3::Zero();
    for (const int node : nodes) middle += x[at(node)] / 4;
    for (std::size_t k = 0; k < 4; ++k) made.push_back({x[at(nodes[k])], x[at(nodes[(k + 1) % 4])], middle, centre});
  }
  return made;
}

Vec3 crossing(const Vec3& a, double at_a, const Vec3& b, double at_b) {
  return a + at_a / (at_a - at_b) * (b - a);
}

/// Adds the part of a simplex with distances <= 0.
void add_below(const Simplex& simplex, int dimension, const HalfSpace& space, double tolerance, std::vector<Simplex>& made) {
  std::vector<Vec3> in, out;
  std::vector<double> depth, height;
  for (const Vec3& corner : std::span(simplex).first(at(dimension) + 1)) {
    const double distance = space.distance(corner);
    const bool below = distance < -tolerance;
    (below ? in : out).push_back(corner);
    (below ? depth : height).push_back(std::abs(distance) <= tolerance ? 0 : distance);
  }
  const auto cross_at = [&](std::size_t i, std::size_t o) { return crossing(in[i], depth[i], out[o], height[o]); };
  if (in.empty()) return;
  if (out.empty() || std::ranges::all_of(height, [](double h) { return h == 0; })) {
    made.push_back(simplex);
  } else if (in.size() == 1) {
    Simplex tip{in[0]};
    for (std::size_t o = 0; o < out.size(); ++o) tip[o + 1] = cross_at(0, o);
    made.push_back(tip);
  } else if (dimension == 2) {
    const Vec3 a = cross_at(0, 0), b = cross_at(1, 0);
    made.push_back({in[0], in[1], b});
    made.push_back({in[0], b, a});
  } else {  // two triangles a, b with three edges between them
    std::array<Vec3, 3> a, b;
    if (in.size() == 3)
      a = {in[0], in[1], in[2]}, b = {cross_at(0, 0), cross_at(1, 0), cross_at(2, 0)};
    else
      a = {in[0], cross_at(0, 0), cross_at(0, 1)}, b = {in[1], cross_at(1, 0), cross_at(1, 1)};
    made.push_back({a[0], a[1], a[2], b[2]});
    made.push_back({a[0], a[1], b[1], b[2]});
    made.push_back({a[0], b[0], b[1], b[2]});
  }
}

ClippedCell filled_simplices(Cell cell, std::span<const Vec3> corners, const std::vector<HalfSpace>& within, double tolerance) {
  const int d = info(cell).dimension;
  std::vector<Simplex> left = simplices_of(cell, corners), next;
  for (const HalfSpace& space : within) {
    next.clear();
    for (const Simplex& simplex : left) add_below(simplex, d, space, tolerance, next);
    std::swap(left, next);
  }
  const double least = 1e-14 * std::pow(size_of(corners), d);  // of a simplex without extent
  std::erase_if(left, [&](const Simplex& simplex) { return measure(simplex, d) <= least; });
  ClippedCell made;
  const Cell small = simplex_cell(d);
  const CellRule rule = cell_rule(small, degree_in_simplex(cell));
  const LocalCoordinates find_local(cell, corners);
  for (const Simplex& simplex : left) {
    const auto of_simplex = std::span(simplex).first(at(d) + 1);
    const double size = measure(simplex, d);
    for (std::size_t p = 0; p < rule.point.size(); ++p) {
      const Vec3 local = find_local(cell_position(cell_shape(small, rule.point[p]), of_simplex));
      made.rule.point.push_back(local);
      made.rule.weight.push_back(rule.weight[p] * size / find_local.measure(local));
    }
    made.pieces.push_back({small, {of_simplex.begin(), of_simplex.end()}});
  }
  return made;
}

}  // namespace

PlaneSide side_of_cell(const HalfSpace& space, std::span<const Vec3> corners, double tolerance) {
  bool below = false, above = false;
  for (const Vec3& corner : corners) {
    below = below || space.distance(corner) < -tolerance;
    above = above || space.distance(corner) > tolerance;
  }
  return !above ? PlaneSide::inside : below ? PlaneSide::both : PlaneSide::outside;
}

ClippedCell clip_cell(Cell cell, std::span<const Vec3> corners, const std::vector<HalfSpace>& within, double tolerance) {
  if (const std::optional<Box> box = box_within(cell, corners, within, tolerance)) return filled_box(cell, corners, *box);
  return filled_simplices(cell, corners, within, tolerance);
}

bool is_level(Cell cell, std::span<const Vec3> corners, const HalfSpace& plane) {
  return is_simplex(cell) || (is_box(cell) && has_parallel_sides(cell, corners) && axis_across(cell, corners, plane) >= 0);
}

std::vector<Vec3> section(Cell cell, std::span<const Vec3> corners, const HalfSpace& plane, double tolerance) {
  std::vector<Vec3> found;
  const auto take = [&](const Vec3& place) {
    if (std::ranges::none_of(found, [&](const Vec3& other) { return (place - other).norm() <= tolerance; })) found.push_back(place);
  };
  std::vector<double> distance;
  for (const Vec3& corner : corners) {
    const double d = plane.distance(corner);
    distance.push_back(std::abs(d) <= tolerance ? 0 : d);
    if (distance.back() == 0) take(corner);
  }
  const std::span<const int> edges = info(cell).edges;
  for (std::size_t e = 0; e + 1 < edges.size(); e += 2) {
    const std::size_t a = at(edges[e]), b = at(edges[e + 1]);
    if (distance[a] * distance[b] < 0) take(crossing(corners[a], distance[a], corners[b], distance[b]));
  }
  if (found.size() < at(info(cell).dimension)) return {};
  if (info(cell).dimension == 2) return found;
  Vec3 middle = Vec3::Zero();
  for (const Vec3& place : found) middle += place / static_cast<double>(found.size());
  const Vec3 first = (found.front() - middle).normalized(), second = cross(plane.normal, first);
  const auto angle = [&](const Vec3& place) { return std::atan2(second.dot(place - middle), first.dot(place - middle)); };
  std::ranges::sort(found, {}, angle);
  return found;
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

namespace {

/// Gradients of the local coordinates; of those that the cell does not have 0.
std::array<Vec3, 3> dual_tangents(Cell cell, const CellShape& shape, std::span<const Vec3> corners) {
  const int d = info(cell).dimension;
  std::array<Vec3, 3> t{}, dual{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (int k = 0; k < d; ++k) t[at(k)] = cell_tangent(shape, corners, k);
  if (d == 1) t[1] = std::abs(t[0].x()) < 0.9 * t[0].norm() ? Vec3::UnitX() : Vec3::UnitY();
  if (d < 3) t[2] = cross(t[0], t[1]);
  if (d == 1) t[1] = cross(t[2], t[0]);
  const double volume = t[0].dot(cross(t[1], t[2]));
  for (int k = 0; k < d; ++k) dual[at(k)] = cross(t[at((k + 1) % 3)], t[at((k + 2) % 3)]) / volume;
  return dual;
}

}  // namespace

Vec3 local_coordinates(Cell cell, std::span<const Vec3> corners, const Vec3& place) {
  constexpr double enough = 1e-8;  // Newton's method squares it
  Vec3 local = cell_centre(cell);
  for (int iteration = 0; iteration < 30; ++iteration) {
    const CellShape shape = cell_shape(cell, local);
    const Vec3 miss = place - cell_position(shape, corners);
    const std::array<Vec3, 3> dual = dual_tangents(cell, shape, corners);
    const Vec3 change(dual[0].dot(miss), dual[1].dot(miss), dual[2].dot(miss));
    local += change;
    if (change.norm() < enough) break;
  }
  return local;
}

LocalCoordinates::LocalCoordinates(Cell cell, std::span<const Vec3> corners)
    : cell_(cell), corners_(corners.begin(), corners.end()), parallel_(has_parallel_sides(cell, corners)), middle_(cell_centre(cell)) {
  const CellShape shape = cell_shape(cell, middle_);
  origin_ = cell_position(shape, corners);
  dual_ = dual_tangents(cell, shape, corners);
  measure_ = uplift::measure(cell, shape, corners);
}

Vec3 LocalCoordinates::operator()(const Vec3& place) const {
  if (!parallel_) return local_coordinates(cell_, corners_, place);
  const Vec3 from = place - origin_;
  return middle_ + Vec3(dual_[0].dot(from), dual_[1].dot(from), dual_[2].dot(from));
}

double LocalCoordinates::measure(const Vec3& local) const {
  return parallel_ ? measure_ : uplift::measure(cell_, cell_shape(cell_, local), corners_);
}

}  // namespace uplift
