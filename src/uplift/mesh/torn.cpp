#include "uplift/mesh/torn.h"

#include <algorithm>

#include "uplift/mesh/sides.h"

namespace uplift {
namespace {

constexpr double tolerance = 1e-6;  // of the size of a side

struct Outer {
  double place = 0;  // along a direction in which few sides of a mesh stand at the same place
  Vec3 middle = Vec3::Zero();
  double size = 0;
  std::vector<int> corners;
};

std::vector<char> nodes_of_interfaces(const Mesh& mesh, const std::vector<std::vector<FacePair>>& opened, std::span<const int> joined) {
  std::vector<char> marked(mesh.nodes.size(), 0);
  for (const int node : joined) marked[static_cast<std::size_t>(node)] = 1;
  for (const std::vector<FacePair>& faces : opened)
    for (const FacePair& face : faces)
      for (const CellId cell : {face.lower, face.upper})
        for (const int node : mesh.cell(cell)) marked[static_cast<std::size_t>(node)] = 1;
  return marked;
}

std::vector<Outer> outer_sides(const Mesh& mesh) {
  const Vec3 along(0.6, 0.5316, 0.5977);
  const Sides sides(mesh, full_cells(mesh));
  std::vector<Outer> outer;
  for (int cell = 0; cell < static_cast<int>(sides.cells().size()); ++cell)
    for (int side = 0; side < sides.count(cell); ++side) {
      if (sides.twin(Sides::stride * cell + side) >= 0) continue;
      const CellId id = sides.cells()[static_cast<std::size_t>(cell)];
      const std::span<const int> numbers = side_of(mesh.type(id), side);
      const auto corners = static_cast<std::size_t>(info(info(mesh.type(id)).sides[static_cast<std::size_t>(side)]).corners);
      Outer one;
      for (std::size_t i = 0; i < corners; ++i) {
        one.corners.push_back(mesh.cell(id)[static_cast<std::size_t>(numbers[i])]);
        one.middle += mesh.nodes[static_cast<std::size_t>(one.corners.back())] / static_cast<double>(corners);
      }
      one.size = (mesh.nodes[static_cast<std::size_t>(one.corners[1])] - mesh.nodes[static_cast<std::size_t>(one.corners[0])]).norm();
      one.place = along.dot(one.middle);
      outer.push_back(std::move(one));
    }
  std::ranges::sort(outer, {}, &Outer::place);
  return outer;
}

bool coincide(const Mesh& mesh, const Outer& a, const Outer& b) {
  const auto near = [&](int one) {
    return std::ranges::any_of(b.corners, [&](int other) {
      return (mesh.nodes[static_cast<std::size_t>(one)] - mesh.nodes[static_cast<std::size_t>(other)]).norm() <= tolerance * a.size;
    });
  };
  return a.corners.size() == b.corners.size() && std::ranges::all_of(a.corners, near);
}

}  // namespace

std::vector<Vec3> torn_sides(const Mesh& mesh, const std::vector<std::vector<FacePair>>& opened, std::span<const int> joined) {
  const std::vector<char> meant = nodes_of_interfaces(mesh, opened, joined);
  const auto has = [](const Outer& side, int node) { return std::ranges::find(side.corners, node) != side.corners.end(); };
  const auto is_joined = [&](const Outer& a, const Outer& b) {  // an interface that ends within the mesh leaves the node at its end single
    return std::ranges::all_of(a.corners, [&](int node) { return meant[static_cast<std::size_t>(node)] != 0 || has(b, node); });
  };
  const auto are_meant = [&](const Outer& a, const Outer& b) {
    return is_joined(a, b) && is_joined(b, a) && !std::ranges::all_of(a.corners, [&](int node) { return has(b, node); });
  };
  const std::vector<Outer> outer = outer_sides(mesh);
  std::vector<Vec3> torn;
  for (std::size_t i = 0; i < outer.size(); ++i)
    for (std::size_t k = i + 1; k < outer.size() && outer[k].place - outer[i].place <= tolerance * outer[i].size; ++k)
      if (coincide(mesh, outer[i], outer[k]) && !are_meant(outer[i], outer[k])) torn.push_back(outer[i].middle);
  return torn;
}

}  // namespace uplift
