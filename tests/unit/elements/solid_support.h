#pragma once
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "uplift/elements/solid.h"
#include "uplift/mesh/cell_quadrature.h"
#include "uplift/mesh/cell_shapes.h"

// What the tests of solid elements share: single distorted elements of every type.
namespace uplift {

inline Vec3 local_node(Cell cell, int a) {
  const auto& x = cell_nodes(cell)[static_cast<std::size_t>(a)];
  return {x[0], x[1], x[2]};
}

/// Nodes of a cell whose corners are those of the reference cell moved by up to `amplitude` in every direction; edges straight.
inline std::vector<Vec3> distorted_nodes(Cell cell, double amplitude, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-amplitude, amplitude);
  const Cell linear = info(cell).linear;
  std::vector<Vec3> corners, nodes;
  for (int c = 0; c < info(cell).corners; ++c) {
    Vec3 move(uniform(random), uniform(random), uniform(random));
    if (info(cell).dimension == 2) move.z() = 0;
    corners.push_back(local_node(cell, c) + move);
  }
  for (int a = 0; a < info(cell).nodes; ++a) nodes.push_back(cell_position(cell_shape(linear, local_node(cell, a)), corners));
  return nodes;
}

inline std::vector<int> first_numbers(int count) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

/// One element on its own nodes.
inline Solid single(Cell cell, const std::vector<Vec3>& positions, const SolidSection& section) {
  return Solid(cell, first_numbers(info(cell).nodes), std::make_shared<const std::vector<Vec3>>(positions), section);
}

/// Every kind of solid: cells of dimension 2 and 3, with and without modes.
struct SolidKind {
  std::string name;
  Cell cell;
  bool modes;
  PlaneState plane;
};
inline std::vector<SolidKind> solid_kinds() {
  std::vector<SolidKind> kinds;
  for (const CellInfo& c : all_cells()) {
    if (c.dimension < 2) continue;
    const bool can = c.cell == Cell::quad4 || c.cell == Cell::hex8;
    for (const PlaneState plane : {PlaneState::strain, PlaneState::stress}) {
      if (c.dimension == 3 && plane == PlaneState::stress) continue;
      for (const bool modes : {false, true})
        if (!modes || can)
          kinds.push_back({std::string(c.name) + (plane == PlaneState::stress ? ", plane stress" : "") + (modes ? ", modes" : ""), c.cell,
                           modes, plane});
    }
  }
  return kinds;
}

inline SolidSection section_of(const SolidKind& kind) {
  SolidSection section;
  section.material = {3e9, 0.3, 2000};
  section.plane = kind.plane;
  section.thickness = 0.7;
  section.incompatible_modes = kind.modes;
  return section;
}

/// Nodal values of a linear displacement field u = G x.
inline Vector linear_field(const std::vector<Vec3>& positions, int dimension, const Mat3& gradient) {
  Vector u(dimension * static_cast<Index>(positions.size()));
  for (std::size_t a = 0; a < positions.size(); ++a)
    u.segment(dimension * static_cast<Index>(a), dimension) = (gradient * positions[a]).head(dimension);
  return u;
}

}  // namespace uplift
