#include "uplift/interface/cut_joint.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "uplift/interface/interface.h"
#include "uplift/mesh/cell_shapes.h"
#include "uplift/mesh/placed_cell.h"

namespace uplift {
namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

using Weights = std::vector<std::pair<int, double>>;

/// Nodes of a cell with shape functions, those that do not vanish, ascending.
void set_weights(std::span<const int> nodes, const CellShape& shape, Weights& weights) {
  weights.clear();
  for (std::size_t a = 0; a < nodes.size(); ++a)
    if (std::abs(shape.value[a]) > 1e-13) weights.emplace_back(nodes[a], shape.value[a]);
  std::ranges::sort(weights);
}

/// Points that faces share are one point with the sum of their areas.
class Points {
 public:
  Points(const Mesh& mesh, const Vec3& normal, double gap) : mesh_(mesh), normal_(normal), gap_(gap), table_(1024, -1) {}
  /// The points that follow lie on this face.
  void begin(const CutFace& face) {
    lower_ = mesh_.cell(face.lower), upper_ = mesh_.cell(face.upper);
    lower_type_ = mesh_.type(face.lower), upper_type_ = mesh_.type(face.upper);
    lower_places_.clear(), upper_places_.clear();
    for (const int node : lower_) lower_places_.push_back(mesh_.nodes[at(node)]);
    for (const int node : upper_) upper_places_.push_back(mesh_.nodes[at(node)]);
    of_one_cell_ = lower_type_ == upper_type_ && lower_places_ == upper_places_;
  }
  int add(const Vec3& place, double area) {
    const CellShape above = cell_shape(upper_type_, local_coordinates(upper_type_, upper_places_, place));
    set_weights(upper_, above, at_upper_);
    if (of_one_cell_)
      set_weights(lower_, above, at_lower_);
    else
      set_weights(lower_, cell_shape(lower_type_, local_coordinates(lower_type_, lower_places_, place)), at_lower_);
    int& found = slot_of(at_upper_, at_lower_);
    if (found >= 0) {
      points[at(found)].area += area;
      return found;
    }
    const int number = found = static_cast<int>(points.size());
    JointPoint& point = points.emplace_back();
    point.position = place;
    point.normal = normal_;
    point.area = area;
    point.gap = gap_;
    point.upper = at_upper_;
    point.lower = at_lower_;
    if (2 * points.size() > table_.size()) grow();
    return number;
  }
  std::vector<JointPoint> points;

 private:
  static bool same(const Weights& a, const Weights& b) {
    const auto near = [](const auto& one, const auto& other) {
      return one.first == other.first && std::abs(one.second - other.second) <= 1e-9;
    };
    return std::ranges::equal(a, b, near);
  }
  /// By the nodes alone: weights of one place have round-off.
  std::size_t first_slot(const Weights& upper, const Weights& lower) const {
    std::uint64_t sum = upper.size();
    for (const Weights* side : {&upper, &lower})
      for (const auto& [node, weight] : *side) sum = (sum ^ static_cast<std::uint64_t>(node)) * 0x9E3779B97F4A7C15U, sum ^= sum >> 29U;
    return sum & (table_.size() - 1);
  }
  /// Where the number of the point with these weights stands, or belongs.
  int& slot_of(const Weights& upper, const Weights& lower) {
    std::size_t slot = first_slot(upper, lower);
    for (; table_[slot] >= 0; slot = (slot + 1) & (table_.size() - 1)) {
      const JointPoint& known = points[at(table_[slot])];
      if (same(known.upper, upper) && same(known.lower, lower)) break;
    }
    return table_[slot];
  }
  void grow() {
    table_.assign(2 * table_.size(), -1);
    for (std::size_t i = 0; i < points.size(); ++i) {
      std::size_t slot = first_slot(points[i].upper, points[i].lower);
      while (table_[slot] >= 0) slot = (slot + 1) & (table_.size() - 1);
      table_[slot] = static_cast<int>(i);
    }
  }
  const Mesh& mesh_;
  Vec3 normal_;
  double gap_;
  std::vector<int> table_;  // numbers of points by the hash of their nodes; -1: free. A power of two, at most half full
  std::span<const int> lower_, upper_;
  Cell lower_type_ = Cell::point, upper_type_ = Cell::point;
  std::vector<Vec3> lower_places_, upper_places_;  // m
  bool of_one_cell_ = false;
  Weights at_upper_, at_lower_;
};

void add_cut_line(const CutFace& face, double thickness, Points& points) {
  const Vec3 &a = face.corners[0], &b = face.corners[1];
  const double area = thickness * (b - a).norm();
  points.add(a, area / (face.level ? 2 : 6));
  points.add(b, area / (face.level ? 2 : 6));
  if (!face.level) points.add((a + b) / 2, area * 2 / 3);
}

void add_level_quadrilateral(const CutFace& face, Points& points, Facets& facets) {
  const std::vector<Vec3>& x = face.corners;
  // the integral of the bilinear function of each corner: a quarter of a parallelogram
  std::array<double, 4> share{};
  for (std::size_t k = 0; k < 4; ++k) {
    const double part = triangle_area(x[(k + 3) % 4], x[k], x[(k + 1) % 4]) / 18;  // of half the Jacobian of this corner
    share[k] += 4 * part, share[(k + 1) % 4] += 2 * part, share[(k + 3) % 4] += 2 * part, share[(k + 2) % 4] += part;
  }
  std::array<int, 4> p{};
  for (std::size_t k = 0; k < 4; ++k) p[k] = points.add(x[k], share[k]);
  for (const auto& [a, b, c] : {std::array<std::size_t, 3>{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}})  // halved both ways
    facets.pieces.push_back({{p[a], p[b], p[c]}, triangle_area(x[a], x[b], x[c]) / 2});
}

bool is_parallelogram(const std::vector<Vec3>& x) {
  constexpr double round_off = 1e-9;
  return x.size() == 4 && (x[0] - x[1] + x[2] - x[3]).norm() <= round_off * (x[2] - x[0]).norm();
}

/// A parallelogram across a hexahedron or a wedge, on which the shape functions are cubic: its corners, which neighbours share, and its
/// middle. With r and s from -1 to 1 along its sides the means of r^2 and s^2 are 4/12, and odd terms vanish: exact to degree 3.
void add_parallelogram(const CutFace& face, Points& points, Facets& facets) {
  const std::vector<Vec3>& x = face.corners;
  const double area = cross(x[1] - x[0], x[3] - x[0]).norm();
  const int middle = points.add((x[0] + x[1] + x[2] + x[3]) / 4, area * 2 / 3);
  std::array<int, 4> corner{};
  for (std::size_t k = 0; k < 4; ++k) corner[k] = points.add(x[k], area / 12);
  for (std::size_t k = 0; k < 4; ++k) facets.pieces.push_back({{corner[k], corner[(k + 1) % 4], middle}, area / 4});
}

/// A face of cells of the second degree: the shape functions are at most cubic in both directions. Simpson's rule in each.
void add_simpson_face(const CutFace& face, Points& points, Facets& facets) {
  const std::vector<Vec3>& x = face.corners;
  constexpr std::array<std::array<int, 2>, 8> ring{{{-1, -1}, {0, -1}, {1, -1}, {1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}}};
  const auto add = [&](int r, int s) {
    const Vec3 along = (1 - s) * (x[1] - x[0]) / 4 + (1 + s) * (x[2] - x[3]) / 4,
               across = (1 - r) * (x[3] - x[0]) / 4 + (1 + r) * (x[2] - x[1]) / 4;
    const Vec3 place = ((1 - r) * ((1 - s) * x[0] + (1 + s) * x[3]) + (1 + r) * ((1 - s) * x[1] + (1 + s) * x[2])) / 4;
    return std::pair{points.add(place, (r == 0 ? 4 : 1) * (s == 0 ? 4 : 1) * cross(along, across).norm() / 9), place};
  };
  const auto middle = add(0, 0);
  auto last = add(ring.back()[0], ring.back()[1]);
  const auto first = last;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const auto next = k + 1 < ring.size() ? add(ring[k][0], ring[k][1]) : first;
    facets.pieces.push_back({{last.first, next.first, middle.first}, triangle_area(last.second, next.second, middle.second)});
    last = next;
  }
}

/// A face in triangles, whose shares of it add up to 1 everywhere. They depend neither on the corner from which it is listed nor on the
/// sense: of the diagonals of a square round-off would choose one. Only corners: all fans from a corner in equal parts; else quadrilaterals
/// are halved both ways, and more corners have a fan from their mean.
struct PartOfFace {
  std::array<Vec3, 3> corner;
  double share;
};
std::vector<PartOfFace> triangles_of(const std::vector<Vec3>& x, bool only_corners) {
  const std::size_t n = x.size();
  std::vector<PartOfFace> parts;
  if (n > 4 && !only_corners) {
    Vec3 mean = Vec3::Zero();
    for (const Vec3& corner : x) mean += corner / static_cast<double>(n);
    for (std::size_t k = 0; k < n; ++k) parts.push_back({{x[k], x[(k + 1) % n], mean}, 1});
    return parts;
  }
  const std::size_t fans = n == 3 ? 1 : n == 4 ? 2 : n;
  for (std::size_t from = 0; from < fans; ++from)
    for (std::size_t k = 2; k < n; ++k)
      parts.push_back({{x[from], x[(from + k - 1) % n], x[(from + k) % n]}, 1 / static_cast<double>(fans)});
  return parts;
}

void add_triangles(const CutFace& face, Points& points, Facets& facets) {
  for (const auto& [corner, share] : triangles_of(face.corners, face.level)) {
    const double area = share * triangle_area(corner[0], corner[1], corner[2]);
    if (area == 0) continue;
    std::array<int, 3> c{}, m{};
    for (std::size_t i = 0; i < 3; ++i) c[i] = points.add(corner[i], area * (face.level ? 1.0 / 3 : 1.0 / 20));
    if (face.level) {
      facets.pieces.push_back({{c[0], c[1], c[2]}, area});
      continue;
    }
    for (std::size_t i = 0; i < 3; ++i) m[i] = points.add((corner[i] + corner[(i + 1) % 3]) / 2, area * 2 / 15);
    const int middle = points.add((corner[0] + corner[1] + corner[2]) / 3, area * 9 / 20);
    for (std::size_t i = 0; i < 3; ++i) {
      facets.pieces.push_back({{c[i], m[i], middle}, area / 6});
      facets.pieces.push_back({{m[i], c[(i + 1) % 3], middle}, area / 6});
    }
  }
}

/// Order of the points along the line, or by rows.
std::vector<int> order_of(const std::vector<JointPoint>& points, const Vec3& normal, int dimension) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  const Vec3 t1 = local_axis({dimension}, normal, 0), t2 = dimension == 3 ? local_axis({3}, normal, 1) : Vec3::Zero().eval();
  double size = 0;
  for (const JointPoint& point : points) size = std::max(size, (point.position - points.front().position).norm());
  std::vector<double> along(points.size());  // m
  std::vector<long> row(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    along[i] = t1.dot(points[i].position);
    row[i] = size > 0 ? std::lround(t2.dot(points[i].position) / (1e-9 * size)) : 0;
  }
  std::ranges::stable_sort(
      order, [&](int a, int b) { return std::abs(row[at(a)] - row[at(b)]) > 1 ? row[at(a)] < row[at(b)] : along[at(a)] < along[at(b)]; });
  return order;
}

/// The jump at each node of a cut cell: of its two nodes there one is the double, the other one the node itself.
class CellJump {
 public:
  CellJump(const Mesh& mesh, const CutFace& face, const Vec3& normal) : lower_(mesh.cell(face.lower)), upper_(mesh.cell(face.upper)) {
    for (const int node : lower_) {
      places_.push_back(mesh.nodes[at(node)]);
      above_.push_back(normal.dot(places_.back() - face.corners.front()) > 0);
    }
  }
  std::size_t size() const { return places_.size(); }
  Vec3 arm(std::size_t i) const { return places_[i] - places_.front(); }
  /// Adds the jump, upper less lower, of one node times a factor; the double comes first.
  void add(std::size_t i, int component, double factor, JumpEquation& to) const {
    to.push_back({above_[i] ? lower_[i] : upper_[i], component, above_[i] ? -factor : factor});
    to.push_back({above_[i] ? upper_[i] : lower_[i], component, above_[i] ? factor : -factor});
  }

 private:
  std::span<const int> lower_, upper_;
  std::vector<Vec3> places_;
  std::vector<bool> above_;
};

}  // namespace

std::vector<JumpEquation> jump_equations(const Mesh& mesh, const CutFace& face, const Vec3& normal, JumpShape shape) {
  assert(mesh.dimension == 2);
  const CellJump jump(mesh, face, normal);
  std::vector<JumpEquation> equations;
  const auto add = [&](std::size_t i, int component, const Vec3& turned) {  // jump_i = jump_0 + rotation turned
    JumpEquation& equation = equations.emplace_back();
    jump.add(i, component, 1, equation);
    jump.add(0, component, -1, equation);
    if (turned[component] == 0) return;
    const Vec3 arm = jump.arm(1), across(-arm.y(), arm.x(), 0);  // the rotation is (jump_1 - jump_0) . across/|arm|^2
    for (const int k : {0, 1}) {
      const double factor = turned[component] * across[k] / arm.squaredNorm();
      if (factor == 0) continue;
      jump.add(1, k, -factor, equation);
      jump.add(0, k, factor, equation);
    }
  };
  if (shape == JumpShape::rigid) {  // nothing stretches from node 0 to node 1
    const Vec3 arm = jump.arm(1).normalized();
    JumpEquation& equation = equations.emplace_back();
    for (const int k : std::abs(arm.x()) > std::abs(arm.y()) ? std::array{0, 1} : std::array{1, 0}) {
      jump.add(1, k, arm[k], equation);
      jump.add(0, k, -arm[k], equation);
    }
  }
  for (std::size_t i = shape == JumpShape::rigid ? 2 : 1; i < jump.size(); ++i)
    for (const int k : {0, 1}) add(i, k, shape == JumpShape::rigid ? Vec3(-jump.arm(i).y(), jump.arm(i).x(), 0) : Vec3(Vec3::Zero()));
  return equations;
}

bool is_crossed(const Mesh& mesh, CellId cell, const CutFace& face) {
  const Vec3 along = face.corners[1] - face.corners[0];
  const Vec3 normal = mesh.dimension == 2 ? Vec3(-along.y(), along.x(), 0) : cross(along, face.corners[2] - face.corners[0]);
  const double tolerance = 1e-6 * normal.norm() * std::pow(signed_size(mesh, cell), 1.0 / mesh.dimension);
  bool below = false, above = false;
  for (const int node : mesh.cell(cell)) {
    const double distance = normal.dot(mesh.nodes[at(node)] - face.corners[0]);
    below = below || distance < -tolerance, above = above || distance > tolerance;
  }
  return below && above;
}

CutJoints cut_joints(const Mesh& mesh, const std::vector<CutFace>& faces, const Vec3& normal, double thickness, double gap) {
  Points points(mesh, normal, gap);
  CutJoints made;
  for (const CutFace& face : faces) {
    made.inclined = made.inclined || !face.level;
    made.simplices = made.simplices || (is_simplex(mesh.type(face.upper)) && is_crossed(mesh, face.upper, face));
    points.begin(face);
    if (mesh.dimension == 2)
      add_cut_line(face, thickness, points);
    else if (face.level && face.corners.size() == 4 && info(mesh.type(face.upper)).corners > 4)
      add_level_quadrilateral(face, points, made.facets);
    else if (face.corners.size() == 4 && info(mesh.type(face.upper)).linear != mesh.type(face.upper))
      add_simpson_face(face, points, made.facets);
    else if (!face.level && is_parallelogram(face.corners))
      add_parallelogram(face, points, made.facets);
    else
      add_triangles(face, points, made.facets);
  }
  const std::vector<int> order = order_of(points.points, normal, mesh.dimension);
  std::vector<int> number(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    number[at(order[i])] = static_cast<int>(i);
    made.points.push_back(std::move(points.points[at(order[i])]));
  }
  if (mesh.dimension == 2) {
    made.facets = line_facets(made.points, thickness);
    return made;
  }
  for (Facets::Piece& piece : made.facets.pieces)
    for (int& corner : piece.corner) corner = number[at(corner)];
  made.facets.num_points = static_cast<int>(made.points.size());
  made.facets.dimension = 3;
  made.facets.at_edge = true;
  return made;
}

}  // namespace uplift
