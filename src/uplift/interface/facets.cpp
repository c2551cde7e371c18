#include "uplift/interface/facets.h"

#include <algorithm>
#include <cmath>

#include "uplift/math/dense.h"
#include "uplift/math/lanes.h"
#include "uplift/mesh/cell_quadrature.h"
#include "uplift/mesh/cell_shapes.h"

namespace uplift {

namespace {

using Corner = Facets::Corner;

int add_corner(Corner corner, Facets& facets) {
  facets.corners.push_back(std::move(corner));
  return facets.num_points + static_cast<int>(facets.corners.size()) - 1;
}

/// From `near` away from `far`, by `share` of their distance.
Corner beyond(int near, int far, double share) {
  return {{near, 1 + share}, {far, -share}};
}

/// The points `first` to `last` along one line.
void add_line(const std::vector<JointPoint>& points, int first, int last, double thickness, Facets& facets) {
  const auto distance = [&](int i) {
    return (points[static_cast<std::size_t>(i) + 1].position - points[static_cast<std::size_t>(i)].position).norm();
  };
  double rest = points[static_cast<std::size_t>(last)].area / thickness;
  for (int i = first; i < last; ++i) {
    facets.pieces.push_back({{i, i + 1, i + 1}, distance(i)});
    rest += points[static_cast<std::size_t>(i)].area / thickness - distance(i);
  }
  if (first == last) {
    facets.pieces.push_back({{first, first, first}, rest});
    return;
  }
  const double begin = distance(first), end = distance(last - 1);
  if (!(rest > 0.1 * (begin + end)) || !(begin > 0) || !(end > 0)) return;  // nodal rules reach the ends; the rest of an arc is no end
  const double share = rest / (begin + end);
  for (const auto& [near, far, apart] : {std::tuple{first, first + 1, begin}, {last, last - 1, end}})
    facets.pieces.push_back({{near, add_corner(beyond(near, far, share), facets), near}, share * apart});
}

/// Both ways to halve a quadrilateral, with half the weight each.
void add_quadrilateral(const std::array<int, 4>& corner, const std::array<double, 4>& half_area, Facets& facets) {
  static constexpr int split[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}};
  for (std::size_t k = 0; k < 4; ++k) {
    const auto at = [&](int i) { return corner[static_cast<std::size_t>(split[k][i])]; };
    facets.pieces.push_back({{at(0), at(1), at(2)}, half_area[k] / 2});
  }
}

/// Coordinates across a rectangle and how the value at each follows from the points of the rule; beyond them the edges.
struct Line {
  std::vector<double> at;
  std::vector<Corner> terms;
};
Line extended(const std::vector<double>& points, double half) {
  Line line;
  const int n = static_cast<int>(points.size());
  const auto at = [&](int i) { return points[static_cast<std::size_t>(i)]; };
  const auto edge = [&](double end, int near, int far) {
    const double away = std::abs(end - at(near));
    if (away < 1e-9 * half) return;
    line.at.push_back(end);
    line.terms.push_back(n > 1 ? beyond(near, far, away / std::abs(at(near) - at(far))) : Corner{{near, 1.0}});
  };
  edge(-half, 0, std::min(1, n - 1));
  for (int i = 0; i < n; ++i) line.at.push_back(at(i)), line.terms.push_back({{i, 1.0}});
  edge(half, n - 1, std::max(n - 2, 0));
  return line;
}

/// Triangles and quadrilaterals between the nodes of a face (after them its centre), by corners.
void add_face(Cell cell, const std::vector<int>& corner, const std::vector<Vec3>& x, Facets& facets) {
  const auto triangle = [&](std::size_t a, std::size_t b, std::size_t c) {
    facets.pieces.push_back({{corner[a], corner[b], corner[c]}, triangle_area(x[a], x[b], x[c])});
  };
  const auto quadrilateral = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    add_quadrilateral({corner[a], corner[b], corner[c], corner[d]},
                      {triangle_area(x[a], x[b], x[c]), triangle_area(x[a], x[c], x[d]), triangle_area(x[a], x[b], x[d]),
                       triangle_area(x[b], x[c], x[d])},
                      facets);
  };
  switch (cell) {
    case Cell::tri3:
      return triangle(0, 1, 2);
    case Cell::tri6:
      return triangle(0, 3, 5), triangle(3, 1, 4), triangle(5, 4, 2), triangle(3, 4, 5);
    case Cell::quad4:
      return quadrilateral(0, 1, 2, 3);
    default:  // quad8 and quad9
      return quadrilateral(0, 4, 8, 7), quadrilateral(4, 1, 5, 8), quadrilateral(8, 5, 2, 6), quadrilateral(7, 8, 6, 3);
  }
}

/// Values at the corners of a face from its Gauss points: the least-squares fit of a plane, on quadrilaterals with the product r s.
Matrix corner_fit(Cell linear, const CellRule& rule) {
  const Index terms = info(linear).corners;
  const auto row = [&](double r, double s) { return Vector(Vec4(1, r, s, r * s).head(terms)); };
  Matrix shape(static_cast<Index>(rule.point.size()), terms), at_corners(terms, terms);
  for (Index i = 0; i < shape.rows(); ++i) {
    const Vec3& at = rule.point[static_cast<std::size_t>(i)];
    shape.row(i) = row(at.x(), at.y()).transpose();
  }
  for (Index a = 0; a < terms; ++a) {
    const auto& at = cell_nodes(linear)[static_cast<std::size_t>(a)];
    at_corners.row(a) = row(at[0], at[1]).transpose();
  }
  return at_corners * PivotedLdlt(Matrix(shape.transpose() * shape)).solve(Matrix(shape.transpose()));
}

}  // namespace

Facets line_facets(const std::vector<JointPoint>& points, double thickness) {
  Facets facets{.num_points = static_cast<int>(points.size()), .at_edge = true};
  int first = 0;
  for (std::size_t i = 1; i <= points.size(); ++i) {
    const bool goes_on =
        i < points.size() && (points[i].position - points[i - 1].position).norm() * thickness < 1.2 * (points[i].area + points[i - 1].area);
    if (goes_on) continue;
    add_line(points, first, static_cast<int>(i) - 1, thickness, facets);
    first = static_cast<int>(i);
  }
  return facets;
}

Facets rectangle_facets(const Footing& footing, const std::vector<JointPoint>& points) {
  const std::vector<Place> corners = footing_corners(footing);
  const auto line = [&](const Vec3& edge, double length, int count, int stride) {
    std::vector<double> at;
    for (int i = 0; i < count; ++i)
      at.push_back((points[static_cast<std::size_t>(i * stride)].position - footing.centre).dot(edge.normalized()));
    return extended(at, length / 2);
  };
  const Line along = line(corners[2] - corners[0], footing.width, footing.points, 1),
             across = line(corners[1] - corners[0], footing.length, footing.points_across, footing.points);
  Facets facets{.num_points = footing.points * footing.points_across, .dimension = 3, .at_edge = true};
  std::vector<int> corner;
  for (const Corner& b : across.terms)
    for (const Corner& a : along.terms) {
      Corner product;
      for (const auto& [j, weight_j] : b)
        for (const auto& [i, weight_i] : a) product.emplace_back(j * footing.points + i, weight_i * weight_j);
      corner.push_back(product.size() == 1 && product[0].second == 1 ? product[0].first : add_corner(product, facets));
    }
  const std::size_t n = along.at.size();
  for (std::size_t j = 0; j + 1 < across.at.size(); ++j)
    for (std::size_t i = 0; i + 1 < n; ++i) {
      const double half = (along.at[i + 1] - along.at[i]) * (across.at[j + 1] - across.at[j]) / 2;
      const std::size_t k = j * n + i;
      add_quadrilateral({corner[k], corner[k + 1], corner[k + n + 1], corner[k + n]}, {half, half, half, half}, facets);
    }
  return facets;
}

Facets face_facets(const Mesh& mesh, const std::vector<FacePair>& faces, FaceQuadrature quadrature, const FaceJoints& joints) {
  Facets facets{.num_points = static_cast<int>(joints.points.size()), .dimension = 3};
  int inside = -1;  // where the surface ends inside the continuum nothing opens
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const std::vector<int>& own = joints.of_face[f];
    if (own.empty()) continue;
    const Cell cell = mesh.type(faces[f].lower), linear = info(cell).linear;
    std::vector<Vec3> positions;
    for (const int node : mesh.cell(faces[f].lower)) positions.push_back(mesh.nodes[static_cast<std::size_t>(node)]);
    std::vector<int> corner;
    if (quadrature == FaceQuadrature::nodal) {
      for (const int k : own) {
        if (k < 0 && inside < 0) inside = add_corner({}, facets);
        corner.push_back(k < 0 ? inside : k);
      }
      if (positions.size() < own.size()) positions.push_back(cell_position(cell_shape(cell, cell_centre(cell)), positions));
      add_face(cell, corner, positions, facets);
    } else {
      const Matrix fit = corner_fit(linear, cell_rule(cell, linear == cell ? 2 : 4));
      for (Index a = 0; a < fit.rows(); ++a) {
        Corner terms;
        for (std::size_t i = 0; i < own.size(); ++i) terms.emplace_back(own[i], fit(a, static_cast<Index>(i)));
        corner.push_back(add_corner(std::move(terms), facets));
      }
      add_face(linear, corner, positions, facets);
    }
  }
  return facets;
}

PositiveShare::PositiveShare(const Facets& facets) : facets_(facets) {
  for (const Facets::Piece& piece : facets.pieces) total_ += piece.area;
  if (facets.dimension == 3) return;
  const Index points = facets.num_points;
  length_.setZero(std::max<Index>(points - 1, 0));
  const auto joins = [](const Facets::Piece& piece) { return piece.corner[1] == piece.corner[0] + 1; };
  for (const Facets::Piece& piece : facets.pieces)
    if (joins(piece) && piece.corner[1] < points) length_[piece.corner[0]] += piece.area;
  std::erase_if(facets_.pieces, [&](const Facets::Piece& piece) { return joins(piece) && piece.corner[1] < points; });
  if (length_.size() < lanes) return;
  last_ = length_.tail(lanes);
  last_.head((lanes - length_.size() % lanes) % lanes).setZero();
}

Index PositiveShare::room() const {
  return facets_.num_points + static_cast<Index>(facets_.corners.size());
}

double PositiveShare::positive(double* value) const {
  double* corner = value + facets_.num_points;
  for (const Corner& terms : facets_.corners) {
    double sum = 0;
    for (const auto& [point, weight] : terms) sum += weight * value[point];
    *corner++ = sum;
  }
  return above(0, value);
}

double PositiveShare::above(double level, const double* value) const {
  return (facets_.dimension == 2 ? along_lines(level, value) : on_triangles(level, value)) / total_;
}

namespace {

/// On a line from a to b the positive part is (a+ + b+)/(|a| + |b|) of it.
template <class T>
[[gnu::always_inline]] inline T positive_length(T length, T a, T b) {
  constexpr double tiny = 1e-300;  // a and b may both be 0
  const T zero = 0;
  return length * (larger(a, zero) + larger(b, zero)) / (absolute(a) + absolute(b) + T(tiny));
}

}  // namespace

/// The division is made only where the sign changes. The last register overlaps the one before it.
double PositiveShare::along_lines(double level, const double* value) const {
  const Lanes zero = 0, height = level;
  const Index count = length_.size();
  double total = 0;
  if (count >= lanes) {
    Lanes sum = zero;
    const auto add = [&](Index first, const double* lengths) __attribute__((always_inline)) {
      const Lanes a = WholeLanes{first}(value), b = WholeLanes{first + 1}(value), length = WholeLanes{0}(lengths);
      const LaneMask above = a > height;
      if (any(above != (b > height)))
        sum += positive_length(length, Lanes(a - height), Lanes(b - height));
      else
        sum += choose(above, length, zero);
    };
    const Index whole = count / lanes * lanes;
    for (Index i = 0; i < whole; i += lanes) add(i, length_.data() + i);
    if (whole < count) add(count - lanes, last_.data());
    total = uplift::sum(sum);
  } else {
    for (Index i = 0; i < count; ++i) total += positive_length(length_[i], value[i] - level, value[i + 1] - level);
  }
  for (const Facets::Piece& piece : facets_.pieces)
    total += positive_length(piece.area, value[piece.corner[0]] - level, value[piece.corner[1]] - level);
  return total;
}

/// A corner of one sign alone, with the value a beside b and c, cuts off a^2/((a - b)(a - c)) of the triangle.
double PositiveShare::on_triangles(double level, const double* value) const {
  double total = 0;
  for (const Facets::Piece& piece : facets_.pieces) {
    const double a = value[piece.corner[0]] - level, b = value[piece.corner[1]] - level, c = value[piece.corner[2]] - level;
    const bool pa = a > 0, pb = b > 0, pc = c > 0;
    if (pa == pb && pb == pc) {
      total += pa ? piece.area : 0;
      continue;
    }
    const bool lone_a = pb == pc, lone_b = pa == pc;
    const double lone = lone_a ? a : lone_b ? b : c, second = lone_a ? b : a, third = lone_a || lone_b ? c : b;
    const double cut = lone * lone / ((lone - second) * (lone - third));
    total += piece.area * (lone > 0 ? cut : 1 - cut);
  }
  return total;
}

}  // namespace uplift
