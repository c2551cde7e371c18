#include "uplift/mesh/cell_shapes.h"

#include <cassert>

namespace uplift {

namespace {

using Local = std::array<double, 3>;

constexpr std::array<Local, 3> line_nodes{{{-1, 0, 0}, {1, 0, 0}, {0, 0, 0}}};
constexpr std::array<Local, 6> triangle_nodes{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {.5, 0, 0}, {.5, .5, 0}, {0, .5, 0}}};
constexpr std::array<Local, 9> quad_nodes{
    {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 0}}};
constexpr std::array<Local, 10> tet_nodes{
    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {.5, 0, 0}, {.5, .5, 0}, {0, .5, 0}, {0, 0, .5}, {.5, 0, .5}, {0, .5, .5}}};
constexpr std::array<Local, 15> wedge_nodes{{{0, 0, -1},
                                             {1, 0, -1},
                                             {0, 1, -1},
                                             {0, 0, 1},
                                             {1, 0, 1},
                                             {0, 1, 1},  // corners
                                             {.5, 0, -1},
                                             {.5, .5, -1},
                                             {0, .5, -1},
                                             {.5, 0, 1},
                                             {.5, .5, 1},
                                             {0, .5, 1},  // triangles
                                             {0, 0, 0},
                                             {1, 0, 0},
                                             {0, 1, 0}}};  // upright edges
constexpr std::array<Local, 27> hex_nodes{{{-1, -1, -1}, {1, -1, -1}, {1, 1, -1},  {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1},
                                           {1, 1, 1},    {-1, 1, 1},  // corners
                                           {0, -1, -1},  {1, 0, -1},  {0, 1, -1},  {-1, 0, -1}, {0, -1, 1},  {1, 0, 1},
                                           {0, 1, 1},    {-1, 0, 1},  {-1, -1, 0}, {1, -1, 0},  {1, 1, 0},   {-1, 1, 0},  // edges
                                           {-1, 0, 0},   {1, 0, 0},   {0, -1, 0},  {0, 1, 0},   {0, 0, -1},  {0, 0, 1},   // faces
                                           {0, 0, 0}}};

/// One factor of a tensor product: the polynomial of a direction that is 1 at the node's coordinate c.
struct Factor {
  double value, slope;
};

inline Factor linear(double c, double x) {
  return {(1 + c * x) / 2, c / 2};
}

inline Factor quadratic(double c, double x) {
  if (c == 0) return {1 - x * x, -2 * x};
  return {x * (x + c) / 2, x + c / 2};
}

/// Sets one function to the product of its factors, one per direction.
template <int Dim>
void set_product(CellShape& shape, int a, const std::array<Factor, 3>& factor) {
  const auto n = static_cast<std::size_t>(a);
  double value = 1;
  for (std::size_t k = 0; k < Dim; ++k) {
    value *= factor[k].value;
    double slope = factor[k].slope;
    for (std::size_t m = 0; m < Dim; ++m)
      if (m != k) slope *= factor[m].value;
    shape.slope[n][k] = slope;
  }
  shape.value[n] = value;
}

/// The numbers of nodes and directions are known to the compiler: cut cells evaluate these functions most.
template <int Dim, int Nodes, Factor (*polynomial)(double, double), std::size_t All>
void set_tensor(CellShape& shape, const std::array<Local, All>& nodes, const Vec3& x) {
  static_assert(Nodes <= All);
  for (int a = 0; a < Nodes; ++a) {
    std::array<Factor, 3> factor{};
    for (std::size_t k = 0; k < Dim; ++k) factor[k] = polynomial(nodes[static_cast<std::size_t>(a)][k], x[static_cast<Index>(k)]);
    set_product<Dim>(shape, a, factor);
  }
}

/// Serendipity of degree 2: a mid-side function is (1 - x_k^2) times linear factors; a corner function is the product of linear factors
/// times (sum of c_k x_k - (Dim - 1)).
template <int Dim>
void set_serendipity(CellShape& shape, std::span<const Local> nodes, const Vec3& x) {
  for (int a = 0; a < shape.nodes; ++a) {
    const auto n = static_cast<std::size_t>(a);
    std::array<Factor, 3> factor{};
    bool corner = true;
    double sum = 1 - Dim;
    for (std::size_t k = 0; k < Dim; ++k) {
      const double c = nodes[n][k], at = x[static_cast<Index>(k)];
      factor[k] = c == 0 ? quadratic(0, at) : linear(c, at);
      corner &= c != 0;
      sum += c * at;
    }
    set_product<Dim>(shape, a, factor);
    if (!corner) continue;
    for (std::size_t k = 0; k < Dim; ++k) shape.slope[n][k] = shape.slope[n][k] * sum + shape.value[n] * nodes[n][k];
    shape.value[n] *= sum;
  }
}

/// A barycentric coordinate and its gradient.
struct Barycentric {
  double value;
  std::array<double, 3> slope;
};

template <int Dim>
std::array<Barycentric, Dim + 1> barycentric(const Vec3& x) {
  std::array<Barycentric, Dim + 1> l{};
  l[0].value = 1;
  for (std::size_t k = 0; k < Dim; ++k) {
    const double at = x[static_cast<Index>(k)];
    l[0].value -= at;
    l[0].slope[k] = -1;
    l[k + 1].value = at;
    l[k + 1].slope[k] = 1;
  }
  return l;
}

using Edge = std::array<std::size_t, 2>;
constexpr std::array<Edge, 6> simplex_edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

/// Corner functions L (2 L - 1), edge functions 4 L_i L_j.
template <int Dim>
void set_simplex(CellShape& shape, bool second_order, const Vec3& x) {
  const auto l = barycentric<Dim>(x);
  for (std::size_t a = 0; a <= Dim; ++a) {
    shape.value[a] = second_order ? l[a].value * (2 * l[a].value - 1) : l[a].value;
    for (std::size_t k = 0; k < Dim; ++k) shape.slope[a][k] = (second_order ? 4 * l[a].value - 1 : 1) * l[a].slope[k];
  }
  for (auto a = static_cast<std::size_t>(Dim + 1); a < static_cast<std::size_t>(shape.nodes); ++a) {
    const auto [i, j] = simplex_edges[a - Dim - 1];
    shape.value[a] = 4 * l[i].value * l[j].value;
    for (std::size_t k = 0; k < Dim; ++k) shape.slope[a][k] = 4 * (l[i].slope[k] * l[j].value + l[i].value * l[j].slope[k]);
  }
}

/// Function f(L) h(t) of a wedge.
void set_wedge_function(CellShape& shape, std::size_t a, double f, const std::array<double, 3>& f_slope, Factor h) {
  shape.value[a] = f * h.value;
  shape.slope[a] = {f_slope[0] * h.value, f_slope[1] * h.value, f * h.slope};
}

void set_wedge6(CellShape& shape, const Vec3& x) {
  const auto l = barycentric<2>(x);
  for (std::size_t a = 0; a < 6; ++a) set_wedge_function(shape, a, l[a % 3].value, l[a % 3].slope, linear(wedge_nodes[a][2], x[2]));
}

/// Corners L (1 + ct) (2 L + ct - 2)/2 with c = t of the node, edges of the triangles 2 L_i L_j (1 + ct), upright edges L (1 - t^2).
void set_wedge15(CellShape& shape, const Vec3& x) {
  const auto l = barycentric<2>(x);
  for (std::size_t a = 0; a < 6; ++a) {
    const Barycentric& b = l[a % 3];
    const double c = wedge_nodes[a][2], h = 1 + c * x[2], rest = 2 * b.value + c * x[2] - 2;
    shape.value[a] = b.value * h * rest / 2;
    for (std::size_t k = 0; k < 2; ++k) shape.slope[a][k] = b.slope[k] * h * (rest + 2 * b.value) / 2;
    shape.slope[a][2] = b.value * c * (rest + h) / 2;
  }
  for (std::size_t a = 6; a < 12; ++a) {
    const auto [i, j] = simplex_edges[a % 3];
    std::array<double, 3> slope{};
    for (std::size_t k = 0; k < 2; ++k) slope[k] = 4 * (l[i].slope[k] * l[j].value + l[i].value * l[j].slope[k]);
    set_wedge_function(shape, a, 4 * l[i].value * l[j].value, slope, linear(wedge_nodes[a][2], x[2]));
  }
  for (std::size_t a = 12; a < 15; ++a) set_wedge_function(shape, a, l[a - 12].value, l[a - 12].slope, quadratic(0, x[2]));
}

}  // namespace

CellShape cell_shape(Cell cell, const Vec3& local) {
  CellShape shape;
  const auto nodes = cell_nodes(cell);
  shape.nodes = static_cast<int>(nodes.size());
  switch (cell) {
    case Cell::point:
      shape.value[0] = 1;
      break;
    case Cell::line2:
      set_tensor<1, 2, linear>(shape, line_nodes, local);
      break;
    case Cell::line3:
      set_tensor<1, 3, quadratic>(shape, line_nodes, local);
      break;
    case Cell::tri3:
      set_simplex<2>(shape, false, local);
      break;
    case Cell::tri6:
      set_simplex<2>(shape, true, local);
      break;
    case Cell::quad4:
      set_tensor<2, 4, linear>(shape, quad_nodes, local);
      break;
    case Cell::quad8:
      set_serendipity<2>(shape, nodes, local);
      break;
    case Cell::quad9:
      set_tensor<2, 9, quadratic>(shape, quad_nodes, local);
      break;
    case Cell::tet4:
      set_simplex<3>(shape, false, local);
      break;
    case Cell::tet10:
      set_simplex<3>(shape, true, local);
      break;
    case Cell::wedge6:
      set_wedge6(shape, local);
      break;
    case Cell::wedge15:
      set_wedge15(shape, local);
      break;
    case Cell::hex8:
      set_tensor<3, 8, linear>(shape, hex_nodes, local);
      break;
    case Cell::hex20:
      set_serendipity<3>(shape, nodes, local);
      break;
    case Cell::hex27:
      set_tensor<3, 27, quadratic>(shape, hex_nodes, local);
      break;
  }
  return shape;
}

std::span<const std::array<double, 3>> cell_nodes(Cell cell) {
  static constexpr Local origin{0, 0, 0};
  switch (cell) {
    case Cell::point:
      return {&origin, 1};
    case Cell::line2:
      return std::span(line_nodes).first(2);
    case Cell::line3:
      return line_nodes;
    case Cell::tri3:
      return std::span(triangle_nodes).first(3);
    case Cell::tri6:
      return triangle_nodes;
    case Cell::quad4:
      return std::span(quad_nodes).first(4);
    case Cell::quad8:
      return std::span(quad_nodes).first(8);
    case Cell::quad9:
      return quad_nodes;
    case Cell::tet4:
      return std::span(tet_nodes).first(4);
    case Cell::tet10:
      return tet_nodes;
    case Cell::wedge6:
      return std::span(wedge_nodes).first(6);
    case Cell::wedge15:
      return wedge_nodes;
    case Cell::hex8:
      return std::span(hex_nodes).first(8);
    case Cell::hex20:
      return std::span(hex_nodes).first(20);
    case Cell::hex27:
      return hex_nodes;
  }
  assert(false);
  return {};
}

Vec3 cell_centre(Cell cell) {
  Vec3 sum = Vec3::Zero();
  const auto corners = cell_nodes(info(cell).linear);
  for (const Local& c : corners) sum += Vec3(c[0], c[1], c[2]);
  return sum / static_cast<double>(corners.size());
}

Vec3 cell_position(const CellShape& shape, std::span<const Vec3> positions) {
  Vec3 x = Vec3::Zero();
  for (std::size_t a = 0; a < static_cast<std::size_t>(shape.nodes); ++a) x += shape.value[a] * positions[a];
  return x;
}

Vec3 cell_tangent(const CellShape& shape, std::span<const Vec3> positions, int k) {
  Vec3 x = Vec3::Zero();
  for (std::size_t a = 0; a < static_cast<std::size_t>(shape.nodes); ++a) x += shape.slope[a][static_cast<std::size_t>(k)] * positions[a];
  return x;
}

Vec3 cell_area_vector(const CellShape& shape, std::span<const Vec3> positions, Cell cell) {
  const Vec3 r = cell_tangent(shape, positions, 0);
  if (info(cell).dimension == 1) return {r.y(), -r.x(), 0};
  assert(info(cell).dimension == 2);
  const Vec3 s = cell_tangent(shape, positions, 1);
  return {r.y() * s.z() - r.z() * s.y(), r.z() * s.x() - r.x() * s.z(), r.x() * s.y() - r.y() * s.x()};
}

}  // namespace uplift
