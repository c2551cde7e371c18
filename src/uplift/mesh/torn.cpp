#include "uplift/mesh/torn.h"

#include <algorithm>
#include <cmath>

#include "uplift/mesh/sides.h"

namespace uplift {
namespace {

constexpr double tolerance = 1e-6;  // of the size of a side

struct Outer {
  double place = 0;   // of the middle, along a direction in which few sides of a mesh stand at the same place
  double radius = 0;  // m: no corner is farther from the middle
  Vec3 middle = Vec3::Zero();
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
      for (const int node : one.corners)
        one.radius = std::max(one.radius, (mesh.nodes[static_cast<std::size_t>(node)] - one.middle).norm());
      one.place = along.dot(one.middle);
      outer.push_back(std::move(one));
    }
  std::ranges::sort(outer, {}, &Outer::place);
  return outer;
}

const Vec3& corner(const Mesh& mesh, const Outer& side, std::size_t k) {
  return mesh.nodes[static_cast<std::size_t>(side.corners[k % side.corners.size()])];
}

bool coincide(const Mesh& mesh, const Outer& a, const Outer& b) {
  const auto near = [&](int one) {
    return std::ranges::any_of(b.corners, [&](int other) {
      return (mesh.nodes[static_cast<std::size_t>(one)] - mesh.nodes[static_cast<std::size_t>(other)]).norm() <= tolerance * a.radius;
    });
  };
  return a.corners.size() == b.corners.size() && std::ranges::all_of(a.corners, near);
}

bool in_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double part = (p - a).dot(along) / along.squaredNorm();
  return part >= -tolerance && part <= 1 + tolerance && (p - a - part * along).norm() <= tolerance * along.norm();
}

bool in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = cross(b - a, c - a);
  const double square = normal.squaredNorm();  // four times that of the area
  if (std::abs((p - a).dot(normal)) > tolerance * std::pow(square, 0.75)) return false;
  const auto part = [&](const Vec3& from, const Vec3& to) { return cross(to - from, p - from).dot(normal) / square; };
  return part(a, b) >= -tolerance && part(b, c) >= -tolerance && part(c, a) >= -tolerance;
}

/// The line of an edge or the normal of a face.
Vec3 direction(const Mesh& mesh, const Outer& side) {
  const Vec3 along = corner(mesh, side, 1) - corner(mesh, side, 0);
  return (side.corners.size() == 2 ? along : cross(along, corner(mesh, side, 2) - corner(mesh, side, 0))).normalized();
}

/// Whether the middle of one side lies in another that has its plane (its line).
bool contains(const Mesh& mesh, const Outer& side, const Outer& other) {
  const auto at = [&](std::size_t k) -> const Vec3& { return corner(mesh, side, k); };
  const Vec3& p = other.middle;
  const bool inside = side.corners.size() == 2
                          ? in_segment(p, at(0), at(1))
                          : in_triangle(p, at(0), at(1), at(2)) || (side.corners.size() == 4 && in_triangle(p, at(0), at(2), at(3)));
  return inside && std::abs(direction(mesh, side).dot(direction(mesh, other))) > 1 - tolerance;
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
  std::vector<char> is_torn(outer.size(), 0);
  for (std::size_t i = 0; i < outer.size(); ++i) {
    const Outer& side = outer[i];
    for (auto other = std::ranges::lower_bound(outer, side.place - side.radius, {}, &Outer::place);
         other != outer.end() && other->place <= side.place + side.radius; ++other) {
      const auto k = static_cast<std::size_t>(other - outer.begin());
      const bool same = k != i && coincide(mesh, side, *other);
      if (same ? k > i : k != i && contains(mesh, side, *other)) is_torn[k] = is_torn[k] != 0 || !are_meant(side, *other);
    }
  }
  std::vector<Vec3> torn;
  for (std::size_t k = 0; k < outer.size(); ++k)
    if (is_torn[k] != 0) torn.push_back(outer[k].middle);
  return torn;
}

}  // namespace uplift
