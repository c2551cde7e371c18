#include "uplift/mesh/jacobian.h"

#include <array>
#include <cassert>
#include <cmath>

#include "uplift/mesh/cell_quadrature.h"
#include "uplift/mesh/cell_shapes.h"

namespace uplift {
namespace {

/// Shape functions of a cell type at its corners where its edges are straight, then at the integration points of solids. At a corner of a
/// cell with curved edges nothing is evaluated: two of them may meet there on a smooth boundary.
using Samples = std::vector<CellShape>;

Samples make_samples(Cell cell) {
  Samples samples;
  const CellInfo& type = info(cell);
  if (type.dimension < 2) return samples;
  for (const auto& local : cell_nodes(cell).first(cell == type.linear ? static_cast<std::size_t>(type.corners) : 0))
    samples.push_back(cell_shape(cell, {local[0], local[1], local[2]}));
  for (const int degree : solid_degrees(cell))
    for (const Vec3& local : cell_rule(cell, degree).point) samples.push_back(cell_shape(cell, local));
  return samples;
}

const Samples& samples_of(Cell cell) {
  static const auto all = [] {
    std::array<Samples, num_cell_types> samples;
    for (const CellInfo& type : all_cells()) samples[static_cast<std::size_t>(type.cell)] = make_samples(type.cell);
    return samples;
  }();
  return all[static_cast<std::size_t>(cell)];
}

double scaled_determinant(const CellShape& shape, std::span<const Vec3> positions, int dimension) {
  const Vec3 r = cell_tangent(shape, positions, 0), s = cell_tangent(shape, positions, 1);
  const Vec3 t = dimension == 3 ? cell_tangent(shape, positions, 2) : Vec3(0, 0, 1);
  const double lengths = r.norm() * s.norm() * t.norm();
  return lengths > 0 ? cross(r, s).dot(t) / lengths : 0.0;
}

}  // namespace

LeastJacobian least_jacobian(const Mesh& mesh, CellId id) {
  const CellInfo& type = info(mesh.type(id));
  assert(type.dimension == mesh.dimension);
  std::array<Vec3, max_cell_nodes> nodes;
  const auto cell = mesh.cell(id);
  for (std::size_t i = 0; i < cell.size(); ++i) nodes[i] = mesh.nodes[static_cast<std::size_t>(cell[i])];
  const std::span<const Vec3> positions(nodes.data(), cell.size());
  const Samples& samples = samples_of(type.cell);
  std::size_t least = 0;
  double value = HUGE_VAL;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double here = scaled_determinant(samples[i], positions, type.dimension);
    if (!(here >= value)) value = here, least = i;
  }
  const int corner = type.cell == type.linear && least < static_cast<std::size_t>(type.corners) ? static_cast<int>(least) : -1;
  return {value, corner, cell_position(samples[least], positions)};
}

}  // namespace uplift
