#include "uplift/mesh/quality.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>

#include "uplift/math/linalg.h"
#include "uplift/mesh/index.h"

namespace uplift {
namespace {

/// For each corner the corners at the other ends of its edges, turning so that an upright cell has a positive determinant.
constexpr int tri_ends[] = {1, 2, 2, 0, 0, 1};
constexpr int quad_ends[] = {1, 3, 2, 0, 3, 1, 0, 2};
constexpr int tet_ends[] = {1, 2, 3, 2, 0, 3, 0, 1, 3, 0, 2, 1};
constexpr int wedge_ends[] = {1, 2, 3, 2, 0, 4, 0, 1, 5, 5, 4, 0, 3, 5, 1, 4, 3, 2};
constexpr int hex_ends[] = {1, 3, 4, 2, 0, 5, 3, 1, 6, 0, 2, 7, 7, 5, 0, 4, 6, 1, 5, 7, 2, 6, 4, 3};

/// Those ends, and the value of the ideal cell.
struct Corners {
  std::span<const int> ends;
  double ideal = 1;
};
Corners corners_of(Cell linear) {
  const double half_root_3 = std::sqrt(3.0) / 2;
  switch (linear) {
    case Cell::tri3:
      return {tri_ends, half_root_3};
    case Cell::quad4:
      return {quad_ends, 1};
    case Cell::tet4:
      return {tet_ends, std::sqrt(0.5)};
    case Cell::wedge6:
      return {wedge_ends, half_root_3};
    case Cell::hex8:
      return {hex_ends, 1};
    default:
      return {};
  }
}

/// Nodes of a cell as points.
struct Points {
  const Mesh& mesh;
  std::span<const int> nodes;
  const Vec3& operator[](int i) const { return mesh.nodes[at(nodes[at(i)])]; }
};

/// Number of the edge between two corners.
int edge_between(const CellInfo& type, int a, int b) {
  for (std::size_t e = 0; e < type.edges.size(); e += 2)
    if ((type.edges[e] == a && type.edges[e + 1] == b) || (type.edges[e] == b && type.edges[e + 1] == a)) return static_cast<int>(e / 2);
  assert(false);
  return 0;
}

/// Direction of the edge at its corner `from`: slope of the parabola through its three nodes, or of the straight line.
Vec3 tangent(const CellInfo& type, const Points& x, int from, int to) {
  if (type.cell == type.linear) return x[to] - x[from];
  const Vec3& middle = x[type.corners + edge_between(type, from, to)];
  return 4 * middle - 3 * x[from] - x[to];
}

double least_jacobian(const Mesh& mesh, const CellInfo& type, const Points& x) {
  const Corners corners = corners_of(type.linear);
  const int d = type.dimension;
  Vec3 normal{0, 0, 1};
  if (d == 2 && mesh.dimension == 3) {
    normal = type.corners == 3 ? cross(x[1] - x[0], x[2] - x[0]) : cross(x[2] - x[0], x[3] - x[1]);
    normal.normalize();
  }
  double least = HUGE_VAL;
  for (int c = 0; c < type.corners; ++c) {
    std::array<Vec3, 3> t;
    double lengths = 1;
    for (int e = 0; e < d; ++e) {
      t[at(e)] = tangent(type, x, c, corners.ends[at(c * d + e)]);
      lengths *= t[at(e)].norm();
    }
    const double determinant = d == 3 ? t[0].dot(cross(t[1], t[2])) : normal.dot(cross(t[0], t[1]));
    least = std::min(least, lengths > 0 ? determinant / (lengths * corners.ideal) : 0.0);
  }
  return least;
}

}  // namespace

CellQuality quality(const Mesh& mesh, CellId id) {
  const CellInfo& type = info(mesh.type(id));
  assert(type.dimension > 0);
  const Points x{mesh, mesh.cell(id)};
  CellQuality result;
  double least = HUGE_VAL, most = 0;
  for (std::size_t e = 0; e < type.edges.size(); e += 2) {
    const double length = (x[type.edges[e + 1]] - x[type.edges[e]]).squaredNorm();
    least = std::min(least, length);
    most = std::max(most, length);
  }
  result.shortest = std::sqrt(least);
  result.longest = std::sqrt(most);
  result.aspect = result.longest / result.shortest;
  if (type.dimension > 1) result.jacobian = least_jacobian(mesh, type, x);
  return result;
}

std::vector<GroupQuality> quality_by_group(const Mesh& mesh) {
  std::vector<GroupQuality> all;
  for (const auto& [name, group] : mesh.groups) {
    if (group.dimension == 0 || group.cells.empty()) continue;
    GroupQuality worst{name, static_cast<int>(group.cells.size()), HUGE_VAL, 0, 0, 0, HUGE_VAL, {}, {}};
    for (const CellId id : group.cells) {
      const CellQuality q = quality(mesh, id);
      const CellInfo& type = info(mesh.type(id));
      worst.shortest = std::min(worst.shortest, q.shortest);
      worst.longest = std::max(worst.longest, q.longest);
      worst.spacing = std::max(worst.spacing, type.cell == type.linear ? q.longest : q.longest / 2);
      if (q.aspect > worst.aspect) worst.aspect = q.aspect, worst.most_slender = id;
      if (q.jacobian < worst.jacobian) worst.jacobian = q.jacobian, worst.most_distorted = id;
    }
    all.push_back(worst);
  }
  return all;
}

double highest_frequency(const GroupQuality& group, double speed, double points_per_wavelength) {
  assert(speed > 0 && points_per_wavelength > 0 && group.spacing > 0);
  return speed / (points_per_wavelength * group.spacing);
}

Pieces connected_pieces(const Mesh& mesh) {
  std::vector<int> parent(mesh.nodes.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[at(i)] != i) i = parent[at(i)] = parent[at(parent[at(i)])];
    return i;
  };
  std::vector<bool> used(mesh.nodes.size(), false);
  for (const CellBlock& block : mesh.blocks)
    for (int i = 0; i < block.count(); ++i)
      for (const int node : block[i]) {
        used[at(node)] = true;
        const int a = root(block[i][0]), b = root(node);
        parent[at(std::max(a, b))] = std::min(a, b);  // so the root is the lowest node
      }
  Pieces pieces;
  std::vector<int> number(mesh.nodes.size(), -1);
  for (int node = 0; node < static_cast<int>(parent.size()); ++node) {
    if (!used[at(node)]) {
      pieces.unused.push_back(node);
      continue;
    }
    int& piece = number[at(root(node))];
    if (piece < 0) {
      piece = pieces.count();
      pieces.nodes.emplace_back();
    }
    pieces.nodes[at(piece)].push_back(node);
  }
  return pieces;
}

}  // namespace uplift
