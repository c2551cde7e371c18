#pragma once
#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "simple_meshes.h"
#include "uplift/mesh/sides.h"

// Slow and obvious views of a mesh, independent of mesh/sides.h.
namespace uplift::support {

inline const Where mesh_file{"case.toml", 7};

inline const std::vector<Cell> plane_cells{Cell::tri3, Cell::tri6, Cell::quad4, Cell::quad8, Cell::quad9};
inline const std::vector<Cell> space_cells{Cell::tet4, Cell::tet10, Cell::wedge6, Cell::wedge15, Cell::hex8, Cell::hex20, Cell::hex27};

inline std::vector<int> sorted(std::vector<int> nodes) {
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}
inline std::vector<int> side_nodes(const Mesh& mesh, CellId id, int side) {
  std::vector<int> nodes;
  for (const int i : side_of(mesh.type(id), side)) nodes.push_back(mesh.cell(id)[i]);
  return nodes;
}

/// All sides of cells of full dimension by the sorted numbers of all their nodes.
inline std::map<std::vector<int>, std::vector<CellId>> side_map(const Mesh& mesh) {
  std::map<std::vector<int>, std::vector<CellId>> sides;
  for (const CellId id : full_cells(mesh))
    for (int s = 0; s < static_cast<int>(info(mesh.type(id)).sides.size()); ++s) sides[sorted(side_nodes(mesh, id, s))].push_back(id);
  return sides;
}
inline std::vector<int> sorted_nodes(const Mesh& mesh, CellId id) {
  const auto nodes = mesh.cell(id);
  return sorted({nodes.begin(), nodes.end()});
}

inline Vec3 centre(const Mesh& mesh, std::span<const int> nodes, int corners) {
  Vec3 sum = Vec3::Zero();
  for (const int n : nodes.first(static_cast<std::size_t>(corners))) sum += mesh.nodes[n] / corners;
  return sum;
}
inline Vec3 centre(const Mesh& mesh, CellId id) {
  return centre(mesh, mesh.cell(id), info(mesh.type(id)).corners);
}

/// Normal times area (length) of a flat face (edge) with its corners in `nodes`, in the sense stated in cells.h.
inline Vec3 area_of(const Mesh& mesh, Cell face, std::span<const int> nodes) {
  const auto x = [&](int i) { return mesh.nodes[nodes[i]]; };
  if (info(face).dimension == 1) return {x(1).y() - x(0).y(), x(0).x() - x(1).x(), 0};
  Vec3 sum = Vec3::Zero();
  const int corners = info(face).corners;
  for (int i = 0; i < corners; ++i) {  // shoelace
    const Vec3 a = x(i), b = x((i + 1) % corners);
    sum += Vec3(a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x()) / 2;
  }
  return sum;
}

/// Sum over the cells of a group of length, area or volume.
inline double size_of(const Mesh& mesh, const std::string& group) {
  double sum = 0;
  for (const CellId id : mesh.groups.at(group).cells) sum += std::abs(signed_size(mesh, id));
  return sum;
}

/// Text of the InputError that `act` throws; empty when it does not.
inline std::string mesh_refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace uplift::support
