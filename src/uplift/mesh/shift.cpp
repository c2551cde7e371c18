#include "uplift/mesh/shift.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "uplift/mesh/index.h"
#include "uplift/mesh/sides.h"

namespace uplift {
namespace {

constexpr double reach = 3;  // heights of the cells that the plane crosses

std::set<CellId> cells_of(const Mesh& mesh, const std::vector<std::string>& groups, bool full) {
  std::set<CellId> cells;
  for (const std::string& name : groups)
    if (const auto group = mesh.groups.find(name); group != mesh.groups.end() && (group->second.dimension == mesh.dimension) == full)
      cells.insert(group->second.cells.begin(), group->second.cells.end());
  return cells;
}

/// Whether a direction lies in a side of a cell.
bool lies_in(const Mesh& mesh, std::span<const int> side, const Vec3& direction) {
  const Vec3& origin = mesh.nodes[at(side[0])];
  const Vec3 edge = (mesh.nodes[at(side[1])] - origin).normalized();
  if (mesh.dimension == 2) return cross(edge, direction).norm() < 1e-9;
  const Vec3 normal = cross(edge, mesh.nodes[at(side[2])] - origin).normalized();
  return std::abs(normal.dot(direction)) < 1e-9;
}

}  // namespace

void shift_nodes(Mesh& mesh, const CutPlane& plane, double share, const std::vector<std::string>& lines) {
  std::vector<double> height(mesh.nodes.size(), std::numeric_limits<double>::infinity());  // m: the least of the cells at each node
  const auto keep = [&](std::span<const int> nodes) {
    for (const int node : nodes) height[at(node)] = 0;
  };
  const std::set<CellId> chosen = cells_of(mesh, plane.through, true);
  double highest = 0;
  for (const CellId id : full_cells(mesh)) {
    const std::span<const int> nodes = mesh.cell(id);
    if (!chosen.contains(id)) {
      keep(nodes);
      continue;
    }
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const int node : nodes) {
      const double distance = plane.below.distance(mesh.nodes[at(node)]);
      least = std::min(least, distance), most = std::max(most, distance);
    }
    for (const int node : nodes) height[at(node)] = std::min(height[at(node)], most - least);
    if (least <= 0 && most >= 0) highest = std::max(highest, most - least);
  }
  const Sides sides(mesh, {chosen.begin(), chosen.end()});
  std::vector<int> nodes;
  for (int cell = 0; cell < static_cast<int>(sides.cells().size()); ++cell)
    for (int side = 0; side < sides.count(cell); ++side) {
      if (sides.twin(Sides::stride * cell + side) >= 0) continue;
      sides.nodes_of(mesh, Sides::stride * cell + side, nodes);
      if (!lies_in(mesh, nodes, plane.below.normal)) keep(nodes);
    }
  for (const CellId id : cells_of(mesh, lines, false)) keep(mesh.cell(id));
  for (const auto& [name, group] : mesh.groups) keep(group.nodes);

  for (std::size_t node = 0; node < mesh.nodes.size(); ++node) {
    const double near = 1 - std::abs(plane.below.distance(mesh.nodes[node])) / (reach * highest);
    if (near > 0 && std::isfinite(height[node])) mesh.nodes[node] += share * near * height[node] * plane.below.normal;
  }
}

}  // namespace uplift
