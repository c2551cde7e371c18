#pragma once
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "uplift/elements/solid.h"
#include "uplift/math/sparse_solvers.h"
#include "uplift/mesh/cell_quadrature.h"
#include "uplift/mesh/cell_shapes.h"

// What the verification cases of solids share: small meshes of every cell type, made here so that the program's own mesh generator is not
// needed, and a plain assembly.
namespace uplift::verification {

/// Cells of one type over a box, nodes shared.
struct SmallMesh {
  Cell cell;
  Coordinates nodes;
  std::vector<std::vector<int>> cells;
  std::vector<Vec3> before;  // places of the nodes in the undistorted box, to find its sides
};

/// Corner lists of the linear cells into which a square or cube (corners as of quad4/hex8) is cut.
inline std::vector<std::vector<int>> cuts(Cell linear) {
  switch (linear) {
    case Cell::tri3:
      return {{0, 1, 2}, {0, 2, 3}};
    case Cell::wedge6:
      return {{0, 1, 2, 4, 5, 6}, {0, 2, 3, 4, 6, 7}};
    case Cell::tet4:  // six tets about the diagonal 0-6 (Kuhn)
      return {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
    case Cell::quad4:
      return {{0, 1, 2, 3}};
    default:
      return {{0, 1, 2, 3, 4, 5, 6, 7}};
  }
}

/// The box of `size` [m] in n[0] x n[1] (x n[2]) pieces; corners moved by `move`, further nodes on straight edges between them.
inline SmallMesh small_mesh(Cell cell, Vec3 size, std::array<int, 3> n, const std::function<Vec3(const Vec3&)>& move) {
  const int dimension = info(cell).dimension;
  const Cell linear = info(cell).linear, block = dimension == 2 ? Cell::quad4 : Cell::hex8;
  if (dimension == 2) n[2] = 1;
  std::vector<Vec3> nodes, before;
  std::map<std::array<long, 3>, int> known;
  const auto number = [&](const Vec3& old_place, const Vec3& place) {
    const std::array<long, 3> key{std::lround(old_place.x() * 1e7), std::lround(old_place.y() * 1e7), std::lround(old_place.z() * 1e7)};
    const auto [entry, fresh] = known.try_emplace(key, static_cast<int>(nodes.size()));
    if (fresh) {
      nodes.push_back(place);
      before.push_back(old_place);
    }
    return entry->second;
  };
  SmallMesh mesh{cell, nullptr, {}, {}};
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i)
        for (const auto& corners : cuts(linear)) {
          std::vector<Vec3> from, to;
          for (const int c : corners) {
            const auto& x = cell_nodes(block)[static_cast<std::size_t>(c)];
            Vec3 place((i + (x[0] + 1) / 2) / n[0] * size.x(), (j + (x[1] + 1) / 2) / n[1] * size.y(), 0);
            if (dimension == 3) place.z() = (k + (x[2] + 1) / 2) / n[2] * size.z();
            from.push_back(place);
            to.push_back(move(place));
          }
          std::vector<int> numbers;
          for (const auto& x : cell_nodes(cell)) {
            const CellShape shape = cell_shape(linear, {x[0], x[1], x[2]});
            numbers.push_back(number(cell_position(shape, from), cell_position(shape, to)));
          }
          mesh.cells.push_back(numbers);
        }
  mesh.nodes = std::make_shared<const std::vector<Vec3>>(nodes);
  mesh.before = before;
  return mesh;
}

/// Solid elements of a mesh and their sums.
struct SolidSystem {
  std::vector<Solid> solids;
  Sparse stiffness, mass;
};

inline SolidSystem assemble(const SmallMesh& mesh, const SolidSection& section) {
  SolidSystem system;
  const int d = info(mesh.cell).dimension;
  const Index n = d * static_cast<Index>(mesh.nodes->size());
  std::vector<Triplet> k, m;
  Matrix ke, me;
  for (const auto& nodes : mesh.cells) {
    system.solids.emplace_back(mesh.cell, nodes, mesh.nodes, section);
    system.solids.back().form({&ke, &me, nullptr});
    for (Index a = 0; a < ke.rows(); ++a)
      for (Index b = 0; b < ke.rows(); ++b) {
        const Index row = d * nodes[static_cast<std::size_t>(a / d)] + a % d, column = d * nodes[static_cast<std::size_t>(b / d)] + b % d;
        k.emplace_back(row, column, ke(a, b));
        if (me(a, b) != 0) m.emplace_back(row, column, me(a, b));
      }
  }
  system.stiffness.resize(n, n);
  system.stiffness.setFromTriplets(k.begin(), k.end());
  system.mass.resize(n, n);
  system.mass.setFromTriplets(m.begin(), m.end());
  return system;
}

/// K u = f with the unknowns marked in `fixed` held at their values in `u`; the others are filled in.
inline void solve_held(const Sparse& stiffness, const Vector& force, const std::vector<bool>& fixed, Vector& u) {
  std::vector<Index> place(fixed.size(), -1);
  Index count = 0;
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (!fixed[i]) place[i] = count++;
  std::vector<Triplet> free;
  Vector rest(count);
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (!fixed[i]) rest[place[i]] = force[static_cast<Index>(i)];
  for (Index c = 0; c < stiffness.outerSize(); ++c)
    for (Sparse::InnerIterator entry(stiffness, c); entry; ++entry) {
      const Index row = place[static_cast<std::size_t>(entry.row())], column = place[static_cast<std::size_t>(c)];
      if (row < 0) continue;
      if (column < 0)
        rest[row] -= entry.value() * u[c];
      else
        free.emplace_back(row, column, entry.value());
    }
  Sparse matrix(count, count);
  matrix.setFromTriplets(free.begin(), free.end());
  const SparseLdlt factor(matrix);
  const Vector solution = factor.solve(rest);
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (!fixed[i]) u[static_cast<Index>(i)] = solution[place[i]];
}

/// Unknowns of the nodes for which `on` holds, asked with the place in the undistorted box.
inline std::vector<bool> held_where(const SmallMesh& mesh, const std::function<bool(const Vec3&)>& on) {
  const auto d = static_cast<std::size_t>(info(mesh.cell).dimension);
  std::vector<bool> fixed(d * mesh.before.size(), false);
  for (std::size_t a = 0; a < mesh.before.size(); ++a)
    for (std::size_t i = 0; i < d; ++i) fixed[d * a + i] = on(mesh.before[a]);
  return fixed;
}

/// On the surface of the box.
inline bool on_surface(const Vec3& x, const Vec3& size, int dimension) {
  for (int i = 0; i < dimension; ++i)
    if (std::abs(x[i]) < 1e-9 || std::abs(x[i] - size[i]) < 1e-9) return true;
  return false;
}

}  // namespace uplift::verification
