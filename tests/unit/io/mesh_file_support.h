#pragma once
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "uplift/base/error.h"
#include "uplift/mesh/mesh.h"

// One cell of each type, apart from each other, as the manuals of Gmsh and MED number its nodes: corners by their place, then the middles
// of edges and faces by the corners that they lie between. Nothing here knows the order that the readers must produce.
namespace uplift::sample {

using Between = std::vector<std::vector<int>>;  // corners around each further node

struct Shape {
  Cell cell;
  int gmsh;         // number of the type
  const char* med;  // name of the type
  std::vector<Vec3> corners;
  Between in_gmsh, in_med;
  std::vector<int> med_corners;  // MED's corner k is corner med_corners[k] of the list above
};

inline std::vector<int> counted(std::size_t n) {
  std::vector<int> numbers(n);
  for (std::size_t i = 0; i < n; ++i) numbers[i] = static_cast<int>(i);
  return numbers;
}

inline Between joined(Between a, const Between& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

inline std::vector<Shape> shapes() {
  const std::vector<Vec3> line{{0, 0, 0}, {1, 0, 0}}, tri{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
      quad{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::vector<Vec3> tet{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<Vec3> wedge{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  const std::vector<Vec3> hex{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  const Between line_edges{{0, 1}}, tri_edges{{0, 1}, {1, 2}, {2, 0}}, quad_edges{{0, 1}, {1, 2}, {2, 3}, {3, 0}}, quad_face{{0, 1, 2, 3}};
  // Gmsh reference manual, "Node ordering".
  const Between gmsh_tet{{0, 1}, {1, 2}, {0, 2}, {0, 3}, {2, 3}, {1, 3}};
  const Between gmsh_wedge{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 4}, {2, 5}, {3, 4}, {3, 5}, {4, 5}};
  const Between gmsh_hex{{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 5}, {2, 3}, {2, 6}, {3, 7}, {4, 5}, {4, 7}, {5, 6}, {6, 7}};
  const Between gmsh_faces{{0, 3, 2, 1}, {0, 1, 5, 4}, {0, 4, 7, 3}, {1, 2, 6, 5}, {2, 3, 7, 6}, {4, 5, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7}};
  // MED, "Numérotation des noeuds": around the first face, around the second, then between them; volumes seen from the other side.
  const Between med_tet{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  const Between med_wedge{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}};
  const Between med_hex{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  const Between med_faces{{0, 1, 2, 3}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7}};
  const std::vector<int> tet_turned{0, 2, 1, 3}, wedge_turned{0, 2, 1, 3, 5, 4}, hex_turned{0, 3, 2, 1, 4, 7, 6, 5};
  return {{Cell::point, 15, "PO1", {{0, 0, 0}}, {}, {}, counted(1)},
          {Cell::line2, 1, "SE2", line, {}, {}, counted(2)},
          {Cell::line3, 8, "SE3", line, line_edges, line_edges, counted(2)},
          {Cell::tri3, 2, "TR3", tri, {}, {}, counted(3)},
          {Cell::tri6, 9, "TR6", tri, tri_edges, tri_edges, counted(3)},
          {Cell::quad4, 3, "QU4", quad, {}, {}, counted(4)},
          {Cell::quad8, 16, "QU8", quad, quad_edges, quad_edges, counted(4)},
          {Cell::quad9, 10, "QU9", quad, joined(quad_edges, quad_face), joined(quad_edges, quad_face), counted(4)},
          {Cell::tet4, 4, "TE4", tet, {}, {}, tet_turned},
          {Cell::tet10, 11, "T10", tet, gmsh_tet, med_tet, tet_turned},
          {Cell::wedge6, 6, "PE6", wedge, {}, {}, wedge_turned},
          {Cell::wedge15, 18, "P15", wedge, gmsh_wedge, med_wedge, wedge_turned},
          {Cell::hex8, 5, "HE8", hex, {}, {}, hex_turned},
          {Cell::hex20, 17, "H20", hex, gmsh_hex, med_hex, hex_turned},
          {Cell::hex27, 12, "H27", hex, joined(gmsh_hex, gmsh_faces), joined(med_hex, med_faces), hex_turned}};
}

/// A skew box in place of the unit cube (determinant 2.5), so that no two directions look alike; each type in a place of its own.
inline Vec3 placed(const Vec3& x, std::size_t type) {
  return {x[0] + 0.5 * x[1] + 10 * static_cast<double>(type), 2 * x[1] + 0.25 * x[2], 0.5 * x[0] + 1.1875 * x[2]};
}

inline std::vector<Vec3> with_middles(const std::vector<Vec3>& corners, const Between& between) {
  std::vector<Vec3> nodes = corners;
  for (const auto& around : between) {
    Vec3 sum = Vec3::Zero();
    for (const int corner : around) sum += corners[static_cast<std::size_t>(corner)];
    nodes.push_back(sum / static_cast<double>(around.size()));
  }
  return nodes;
}

/// Nodes of a shape in the file's order.
inline std::vector<Vec3> gmsh_nodes(const Shape& shape, std::size_t type) {
  std::vector<Vec3> corners;
  for (const Vec3& x : shape.corners) corners.push_back(placed(x, type));
  return with_middles(corners, shape.in_gmsh);
}
inline std::vector<Vec3> med_nodes(const Shape& shape, std::size_t type) {
  std::vector<Vec3> corners;
  for (const int k : shape.med_corners) corners.push_back(placed(shape.corners[static_cast<std::size_t>(k)], type));
  return with_middles(corners, shape.in_med);
}

inline double determinant(const Vec3& a, const Vec3& b, const Vec3& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// The one cell of a type, judged by where its nodes are: in its own place, positive orientation, middles of edges, centres of faces and
/// cell.
inline void expect_in_order(const Mesh& mesh, const Shape& shape, std::size_t type) {
  SCOPED_TRACE(info(shape.cell).name);
  const CellInfo& about = info(shape.cell);
  const int b = mesh.find_block(shape.cell);
  ASSERT_GE(b, 0);
  ASSERT_EQ(mesh.blocks[static_cast<std::size_t>(b)].count(), 1);
  const auto nodes = mesh.cell({b, 0});
  const auto at = [&](int k) { return mesh.nodes[static_cast<std::size_t>(nodes[static_cast<std::size_t>(k)])]; };
  const auto expect_at = [&](const Vec3& x, const Vec3& wanted) { EXPECT_LT((x - wanted).norm(), 1e-12); };
  expect_at(at(0), placed(shape.corners[0], type));
  if (about.dimension < 3)
    for (int k = 0; k < about.corners; ++k) expect_at(at(k), placed(shape.corners[static_cast<std::size_t>(k)], type));
  if (about.dimension == 3) {
    const int up = about.corners == 4 ? 3 : about.corners / 2, side = about.corners == 8 ? 3 : 2;
    EXPECT_NEAR(determinant(at(1) - at(0), at(side) - at(0), at(up) - at(0)),
                determinant(placed({1, 0, 0}, 0), placed({0, 1, 0}, 0), placed({0, 0, 1}, 0)), 1e-12);
  }
  const int edges = about.nodes > about.corners ? static_cast<int>(about.edges.size()) / 2 : 0;
  for (int e = 0; e < edges; ++e) {
    const int from = about.edges[static_cast<std::size_t>(2 * e)], to = about.edges[static_cast<std::size_t>(2 * e) + 1];
    expect_at(at(about.corners + e), (at(from) + at(to)) / 2);
  }
  if (shape.cell == Cell::quad9) expect_at(at(8), (at(0) + at(1) + at(2) + at(3)) / 4);
  if (shape.cell != Cell::hex27) return;
  expect_at(at(26), (at(0) + at(6)) / 2);
  for (std::size_t side = 0; side < about.sides.size(); ++side) {
    const auto face = about.side_nodes.subspan(9 * side, 9);
    expect_at(at(face[8]), (at(face[0]) + at(face[1]) + at(face[2]) + at(face[3])) / 4);
  }
}

inline std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace uplift::sample
