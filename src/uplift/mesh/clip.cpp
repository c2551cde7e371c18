#include "uplift/mesh/clip.h"

#include <algorithm>
#include <array>
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

/// Length, area or volume over that of the reference cell.
double measure(const Simplex& simplex, int dimension) {
  std::array<Vec3, 3> tangent{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (int k = 0; k < dimension; ++k) tangent[at(k)] = simplex[at(k) + 1] - simplex[0];
  return cell_measure(dimension, tangent);
}

/// The one local coordinate that changes across the plane, of a cell with parallel sides; -1: several do.
int axis_across(const PlacedCell& cell, const HalfSpace& plane) {
  std::array<double, 3> slope{};
  for (int k = 0; k < info(cell.type()).dimension; ++k) slope[at(k)] = std::abs(plane.normal.dot(cell.tangent(k)));
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

/// In all directions together: N^T N of a quad4, of a wedge6 and, where the sides are parallel, of a hex8.
int degree_in_simplex(Cell cell, bool parallel) {
  if (is_simplex(cell)) return 2;
  if (cell == Cell::hex8) return parallel ? 6 : 5;
  return info(cell).dimension + 2;
}

/// The rule of parts that are boxes.
const CellRule& box_rule(Cell cell) {
  static const std::array<CellRule, 3> all{cell_rule(Cell::line2, degree_in_box(Cell::line2)),
                                           cell_rule(Cell::quad4, degree_in_box(Cell::quad4)),
                                           cell_rule(Cell::hex8, degree_in_box(Cell::hex8))};
  return all[at(info(cell).dimension) - 1];
}

constexpr std::size_t most_points = 24;  // of a simplex

/// The rule of a simplex: shares of its corners at each point.
struct SimplexRule {
  std::vector<std::array<double, 4>> share;
  std::vector<double> weight;
};
const SimplexRule& simplex_rule(const PlacedCell& cell) {
  static const auto all = [] {
    std::array<std::array<SimplexRule, 2>, num_cell_types> rules;
    for (std::size_t k = 0; k < 2 * num_cell_types; ++k) {
      const CellInfo& type = all_cells()[k / 2];
      if (type.dimension == 0 || type.nodes != type.corners) continue;
      const Cell simplex = simplex_cell(type.dimension);
      const CellRule rule = cell_rule(simplex, degree_in_simplex(type.cell, k % 2 != 0));
      SimplexRule& made = rules[static_cast<std::size_t>(type.cell)][k % 2];
      made.weight = rule.weight;
      for (const Vec3& point : rule.point) {
        const CellShape shape = cell_shape(simplex, point);
        made.share.push_back({shape.value[0], shape.value[1], shape.value[2], shape.value[3]});
      }
    }
    return rules;
  }();
  return all[static_cast<std::size_t>(cell.type())][cell.parallel() ? 1 : 0];
}

struct Box {
  std::array<double, 3> from{-1, -1, -1}, to{1, 1, 1};  // local coordinates
  bool is_empty(int dimension) const {
    for (std::size_t k = 0; k < at(dimension); ++k)
      if ((to[k] - from[k]) / 2 <= 0) return true;
    return false;
  }
};

/// None: a plane is not parallel to sides of the cell.
std::optional<Box> box_within(const PlacedCell& cell, std::span<const HalfSpace> within, double tolerance) {
  if (!is_box(cell.type()) || !cell.parallel()) return std::nullopt;
  Box box;
  for (const HalfSpace& space : within) {
    if (side_of_cell(space, cell.corners(), tolerance) == PlaneSide::inside) continue;
    const int k = axis_across(cell, space);
    if (k < 0) return std::nullopt;
    const double slope = space.normal.dot(cell.tangent(k)), here = -space.distance(cell.centre()) / slope;
    double& end = slope > 0 ? box.to[at(k)] : box.from[at(k)];
    end = slope > 0 ? std::min(end, here) : std::max(end, here);
  }
  return box;
}

/// Which corner of a line2, quad4 or hex8 lies across it in each direction.
constexpr std::array<std::size_t, 3> turn{1, 3, 4};  // bits that change

/// A box in a cell, and the inclined plane that ends it.
struct Column {
  Box box;
  const HalfSpace* end = nullptr;         // null: none
  int axis = 0;                           // the end lies across this one alone
  std::array<Vec3, max_corners> corners;  // local coordinates
};

/// Moves the corners of a box to an inclined plane along the direction in which it crosses all edges; false: there is none.
bool cut_box(const PlacedCell& cell, double tolerance, Column& column) {
  const std::span<const std::array<double, 3>> nodes = cell_nodes(cell.type());
  std::array<double, max_corners> distance{};
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    distance[a] = column.end->distance(cell.place(column.corners[a]));
    if (std::abs(distance[a]) <= tolerance) return false;
  }
  for (int k = 0; k < info(cell.type()).dimension; ++k) {
    const bool from_is_in = distance[0] < 0;  // the first corner is at the lower end of all axes
    bool across = true;
    for (std::size_t a = 0; a < nodes.size(); ++a) across = across && (distance[a] < 0) == ((nodes[a][at(k)] < 0) == from_is_in);
    if (!across) continue;
    column.axis = k;
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const std::size_t b = a ^ turn[at(k)];
      if (distance[a] > 0)
        column.corners[a][k] += distance[a] / (distance[a] - distance[b]) * (column.corners[b][k] - column.corners[a][k]);
    }
    return true;
  }
  return false;
}

/// None: the part is not a box with at most one inclined end.
std::optional<Column> column_within(const PlacedCell& cell, std::span<const HalfSpace> within, double tolerance) {
  if (!is_box(cell.type())) return std::nullopt;
  Column column;
  std::array<HalfSpace, 6> level;
  std::size_t levels = 0;
  for (const HalfSpace& space : within) {
    if (side_of_cell(space, cell.corners(), tolerance) == PlaneSide::inside) continue;
    if (cell.parallel() && axis_across(cell, space) >= 0 && levels < level.size())
      level[levels++] = space;
    else if (column.end == nullptr)
      column.end = &space;
    else
      return std::nullopt;
  }
  if (const std::optional<Box> box = box_within(cell, std::span(level).first(levels), tolerance)) column.box = *box;
  const std::span<const std::array<double, 3>> nodes = cell_nodes(cell.type());
  for (std::size_t a = 0; a < nodes.size(); ++a)
    for (int k = 0; k < 3; ++k) {
      const double side = nodes[a][at(k)];
      column.corners[a][k] = k >= info(cell.type()).dimension ? 0 : side < 0 ? column.box.from[at(k)] : column.box.to[at(k)];
    }
  if (column.box.is_empty(info(cell.type()).dimension)) column.end = nullptr;
  if (column.end != nullptr && !cut_box(cell, tolerance, column)) return std::nullopt;
  return column;
}

/// Gauss points of the reference cell for a box with an inclined end along an axis: products of two shape functions are quadratic in each
/// direction; with the length along the axis, linear in the others, they have degree 5 there.
const CellRule& column_rule(int dimension, int axis) {
  static const auto all = [] {
    std::array<std::array<CellRule, 3>, 4> rules;
    const CellRule three = cell_rule(Cell::line2, 5), two = cell_rule(Cell::line2, 3);
    for (int d = 2; d <= 3; ++d)
      for (int k = 0; k < d; ++k) {
        const auto along = [&](int m) -> const CellRule& { return m == k ? two : three; };
        CellRule& made = rules[at(d)][at(k)];
        for (std::size_t i = 0; i < along(0).weight.size(); ++i)
          for (std::size_t j = 0; j < along(1).weight.size(); ++j)
            for (std::size_t l = 0; l < (d == 3 ? along(2).weight.size() : 1); ++l) {
              made.point.emplace_back(along(0).point[i].x(), along(1).point[j].x(), d == 3 ? along(2).point[l].x() : 0);
              made.weight.push_back(along(0).weight[i] * along(1).weight[j] * (d == 3 ? along(2).weight[l] : 1));
            }
      }
    return rules;
  }();
  return all[at(dimension)][at(axis)];
}

/// Of a cell with parallel sides.
CellRule rule_of_column(const PlacedCell& cell, const Column& column) {
  const int d = info(cell.type()).dimension, axis = column.axis;
  if (column.box.is_empty(d)) return {};
  CellRule made = column.end == nullptr ? box_rule(cell.type()) : column_rule(d, axis);
  Vec3 middle = Vec3::Zero(), half = Vec3::Zero();
  double share = 1;
  for (int k = 0; k < d; ++k) {
    middle[k] = (column.box.from[at(k)] + column.box.to[at(k)]) / 2, half[k] = (column.box.to[at(k)] - column.box.from[at(k)]) / 2;
    share *= half[k];
  }
  const double slope = column.end == nullptr ? 0 : column.end->normal.dot(cell.tangent(axis));
  for (std::size_t p = 0; p < made.point.size(); ++p) {
    const double along = made.point[p][axis];
    made.point[p] = middle + half.cwiseProduct(made.point[p]);
    made.weight[p] *= share;
    if (column.end == nullptr) continue;
    made.point[p][axis] = middle[axis];
    const double end = middle[axis] - column.end->distance(cell.place(made.point[p])) / slope;
    const double far = slope > 0 ? middle[axis] - half[axis] : middle[axis] + half[axis];
    made.point[p][axis] = (end + far) / 2 + std::abs(end - far) / 2 * along;
    made.weight[p] *= std::abs(end - far) / (2 * half[axis]);
  }
  return made;
}

/// Divides a linear cell. Where its faces are warped they are divided from their middle, so that the cells beside it fit.
void add_simplices(const PlacedCell& cell, std::vector<Simplex>& made) {
  const std::span<const Vec3> x = cell.corners();
  if (is_simplex(cell.type())) {
    std::copy(x.begin(), x.end(), made.emplace_back().begin());
    return;
  }
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) { made.push_back({x[a], x[b], x[c], x[d]}); };
  if (cell.type() == Cell::quad4) return add(0, 1, 2, 2), add(0, 2, 3, 3);  // of triangles nobody looks at the fourth corner
  if (cell.type() == Cell::hex8 && cell.parallel())                         // four corners off
    return add(0, 1, 2, 5), add(0, 2, 3, 7), add(0, 4, 5, 7), add(2, 5, 6, 7), add(0, 2, 5, 7);
  Vec3 centre = Vec3::Zero();
  for (const Vec3& corner : x) centre += corner / static_cast<double>(x.size());
  for (int side = 0; side < static_cast<int>(info(cell.type()).sides.size()); ++side) {
    const std::span<const int> nodes = side_of(cell.type(), side);
    if (nodes.size() == 3) {
      made.push_back({x[at(nodes[0])], x[at(nodes[1])], x[at(nodes[2])], centre});
      continue;
    }
    Vec3 middle = Vec3::Zero();
    for (const int node : nodes) middle += x[at(node)] / 4;
    for (std::size_t k = 0; k < 4; ++k) made.push_back({x[at(nodes[k])], x[at(nodes[(k + 1) % 4])], middle, centre});
  }
}

/// Adds the part of a simplex with distances <= 0.
void add_below(const Simplex& simplex, int dimension, const HalfSpace& space, double tolerance, std::vector<Simplex>& made) {
  Simplex in, out;
  std::array<double, 4> depth{}, height{};
  std::size_t ins = 0, outs = 0;
  bool on_plane = true;  // all that is not below
  for (const Vec3& corner : std::span(simplex).first(at(dimension) + 1)) {
    const double distance = space.distance(corner);
    if (distance < -tolerance) {
      in[ins] = corner, depth[ins++] = distance;
    } else {
      out[outs] = corner, height[outs++] = std::abs(distance) <= tolerance ? 0 : distance;
      on_plane = on_plane && height[outs - 1] == 0;
    }
  }
  const auto cross_at = [&](std::size_t i, std::size_t o) { return crossing(in[i], depth[i], out[o], height[o]); };
  if (ins == 0) return;
  if (on_plane) {
    made.push_back(simplex);
  } else if (ins == 1) {
    Simplex tip{in[0]};
    for (std::size_t o = 0; o < outs; ++o) tip[o + 1] = cross_at(0, o);
    made.push_back(tip);
  } else if (dimension == 2) {
    const Vec3 a = cross_at(0, 0), b = cross_at(1, 0);
    made.push_back({in[0], in[1], b, b});
    made.push_back({in[0], b, a, a});
  } else {  // two triangles a, b with three edges between them
    std::array<Vec3, 3> a, b;
    if (ins == 3)
      a = {in[0], in[1], in[2]}, b = {cross_at(0, 0), cross_at(1, 0), cross_at(2, 0)};
    else
      a = {in[0], cross_at(0, 0), cross_at(0, 1)}, b = {in[1], cross_at(1, 0), cross_at(1, 1)};
    made.push_back({a[0], a[1], a[2], b[2]});
    made.push_back({a[0], a[1], b[1], b[2]});
    made.push_back({a[0], b[0], b[1], b[2]});
  }
}

/// What is left of a cell, in simplices that have an extent. They stay until the next call in the thread: memory anew for each of a million
/// cells would take a fifth of the time.
std::span<const Simplex> simplices_within(const PlacedCell& cell, std::span<const HalfSpace> within, double tolerance) {
  thread_local std::vector<Simplex> left, next;
  const int d = info(cell.type()).dimension;
  left.clear();
  add_simplices(cell, left);
  for (const HalfSpace& space : within) {
    next.clear();
    for (const Simplex& simplex : left) add_below(simplex, d, space, tolerance, next);
    std::swap(left, next);
  }
  const double least = 1e-14 * std::pow(cell.size(), d);
  std::erase_if(left, [&](const Simplex& simplex) { return measure(simplex, d) <= least; });
  return left;
}

/// The points of all simplices in a cell, exact for what rule_within states.
CellRule rule_in_simplices(const PlacedCell& cell, std::span<const Simplex> simplices) {
  const int d = info(cell.type()).dimension;
  const SimplexRule& rule = simplex_rule(cell);
  const std::size_t points = rule.weight.size();
  CellRule made;
  made.point.reserve(simplices.size() * points);
  made.weight.reserve(simplices.size() * points);
  std::array<Vec3, most_points> place, local;
  std::array<double, most_points> whole;
  for (const Simplex& simplex : simplices) {
    const double size = measure(simplex, d);
    for (std::size_t p = 0; p < points; ++p) {
      place[p] = rule.share[p][0] * simplex[0];
      for (std::size_t k = 1; k <= at(d); ++k) place[p] += rule.share[p][k] * simplex[k];
    }
    cell.find(std::span(place).first(points), local, whole);
    made.point.insert(made.point.end(), local.begin(), local.begin() + static_cast<std::ptrdiff_t>(points));
    for (std::size_t p = 0; p < points; ++p) made.weight.push_back(rule.weight[p] * size / whole[p]);
  }
  return made;
}

}  // namespace

PlaneSide side_of_cell(const HalfSpace& space, std::span<const Vec3> corners, double tolerance) {
  bool below = false, above = false;
  for (const Vec3& corner : corners) {
    const double distance = space.distance(corner);
    below = below || distance < -tolerance;
    above = above || distance > tolerance;
  }
  return !above ? PlaneSide::inside : below ? PlaneSide::both : PlaneSide::outside;
}

CellRule rule_within(const PlacedCell& cell, std::span<const HalfSpace> within, double tolerance) {
  if (cell.parallel())
    if (const std::optional<Column> column = column_within(cell, within, tolerance)) return rule_of_column(cell, *column);
  return rule_in_simplices(cell, simplices_within(cell, within, tolerance));
}

void draw_within(const PlacedCell& cell, std::span<const HalfSpace> within, double tolerance, DrawnPart& made) {
  const int d = info(cell.type()).dimension;
  made.corners.clear(), made.local.clear();
  if (const std::optional<Column> column = column_within(cell, within, tolerance)) {
    made.piece = cell.type();
    if (column->box.is_empty(d)) return;
    for (const Vec3& corner : std::span(column->corners).first(cell.corners().size())) {
      made.local.push_back(corner);
      made.corners.push_back(cell.place(corner));
    }
    return;
  }
  made.piece = simplex_cell(d);
  for (const Simplex& simplex : simplices_within(cell, within, tolerance))
    made.corners.insert(made.corners.end(), simplex.begin(), simplex.begin() + d + 1);
}

bool is_clipped_away(const PlacedCell& cell, std::span<const HalfSpace> within, double tolerance) {
  if (const std::optional<Box> box = box_within(cell, within, tolerance)) return box->is_empty(info(cell.type()).dimension);
  return simplices_within(cell, within, tolerance).empty();
}

bool is_level(const PlacedCell& cell, const HalfSpace& plane) {
  return is_simplex(cell.type()) || (is_box(cell.type()) && cell.parallel() && axis_across(cell, plane) >= 0);
}

}  // namespace uplift
