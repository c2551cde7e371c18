#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "unit/mesh/mesh_support.h"
#include "uplift/mesh/quality.h"
#include "uplift/mesh/split.h"

// Random surfaces in grids, judged by rules that need no mesh connectivity: which grid cells touch a place.
namespace uplift::split_random_test {
namespace {

using namespace support;

struct RandomGrid {
  std::array<int, 3> n;
  std::vector<int> part;  // 0 soil, 1 rest, x fastest
  int at(int i, int j, int k) const { return part[static_cast<std::size_t>((k * n[1] + j) * n[0] + i)]; }
};

/// Uniform in [least, most] from the first case on (rapidcheck would begin with small ranges).
int any_of(int least, int most) {
  return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(least, most + 1));
}

RandomGrid random_grid(bool plane) {
  RandomGrid grid{{any_of(1, 5), any_of(1, 5), plane ? 1 : any_of(1, 4)}, {}};
  const int chance = any_of(1, 9);
  for (int c = 0; c < grid.n[0] * grid.n[1] * grid.n[2]; ++c) grid.part.push_back(any_of(0, 9) < chance ? 0 : 1);
  return grid;
}

Mesh mesh_of(const RandomGrid& g, bool plane, Cell cell) {
  const Grid lines{uniform_lines(0, g.n[0], g.n[0]), uniform_lines(0, g.n[1], g.n[1]),
                   plane ? std::vector<double>{} : uniform_lines(0, g.n[2], g.n[2])};
  return with_cells(grid(
                        lines, [&](int i, int j, int k) { return g.at(i, j, k); }, {"soil", "rest"},
                        [](int part, Direction direction, int other) {
                          if (other < 0) return std::string(name_of(direction));
                          return part == 0 ? std::string("joint") : std::string();
                        }),
                    cell);
}

/// Which parts have a grid cell at a place: bit 1 soil, bit 2 rest.
int parts_at(const RandomGrid& g, const Vec3& x, bool plane) {
  int found = 0;
  for (int k = 0; k < g.n[2]; ++k)
    for (int j = 0; j < g.n[1]; ++j)
      for (int i = 0; i < g.n[0]; ++i)
        if (x[0] >= i && x[0] <= i + 1 && x[1] >= j && x[1] <= j + 1 && (plane || (x[2] >= k && x[2] <= k + 1)))
          found |= g.at(i, j, k) == 0 ? 1 : 2;
  return found;
}

/// Bodies of grid cells that touch, if only in a corner, and are of the same part.
int bodies(const RandomGrid& g) {
  std::vector<int> body(g.part.size(), -1);
  int count = 0;
  const auto number = [&](int i, int j, int k) { return static_cast<std::size_t>((k * g.n[1] + j) * g.n[0] + i); };
  const std::function<void(int, int, int)> flood = [&](int i, int j, int k) {
    body[number(i, j, k)] = count;
    for (int c = std::max(0, k - 1); c <= std::min(g.n[2] - 1, k + 1); ++c)
      for (int b = std::max(0, j - 1); b <= std::min(g.n[1] - 1, j + 1); ++b)
        for (int a = std::max(0, i - 1); a <= std::min(g.n[0] - 1, i + 1); ++a)
          if (body[number(a, b, c)] < 0 && g.at(a, b, c) == g.at(i, j, k)) flood(a, b, c);
  };
  for (int k = 0; k < g.n[2]; ++k)
    for (int j = 0; j < g.n[1]; ++j)
      for (int i = 0; i < g.n[0]; ++i)
        if (body[number(i, j, k)] < 0) flood(i, j, k), ++count;
  return count;
}

void full_boundary(bool plane) {
  const RandomGrid g = random_grid(plane);
  const Cell cell = *rc::gen::elementOf(plane ? plane_cells : space_cells);
  Mesh mesh = mesh_of(g, plane, cell);
  RC_PRE(mesh.groups.contains("joint"));
  const Mesh before = mesh;
  std::vector<int> doubled;
  for (int i = 0; i < static_cast<int>(before.nodes.size()); ++i)
    if (parts_at(g, before.nodes[i], plane) == 3) doubled.push_back(i);

  const OpenedSurface surface = split(mesh, {"joint"}, {"soil"}, mesh_file)[0];
  check_mesh(mesh, mesh_file);
  RC_ASSERT(mesh.nodes.size() == before.nodes.size() + doubled.size());
  std::vector<int> lower;
  for (const NodePair& pair : surface.pairs) {
    lower.push_back(pair.lower);
    RC_ASSERT(pair.upper >= static_cast<int>(before.nodes.size()));
    RC_ASSERT(mesh.nodes[pair.lower] == mesh.nodes[pair.upper]);
  }
  RC_ASSERT(lower == doubled);
  // No node has cells of both sides, and the soil has its old ones.
  const auto soil = nodes_of(mesh, mesh.groups.at("soil")), rest = nodes_of(mesh, mesh.groups.at("rest"));
  std::vector<int> common;
  std::set_intersection(soil.begin(), soil.end(), rest.begin(), rest.end(), std::back_inserter(common));
  RC_ASSERT(common.empty());
  RC_ASSERT(soil == nodes_of(before, before.groups.at("soil")));
  RC_ASSERT(connected_pieces(mesh).count() == bodies(g));
  // Every face that is named still has its cell, and lies where it lay.
  const auto sides = side_map(mesh);
  for (const auto& [name, group] : mesh.groups)
    if (group.dimension == mesh.dimension - 1)
      for (const CellId id : group.cells) {
        const auto found = sides.find(sorted_nodes(mesh, id));
        RC_ASSERT(found != sides.end());
        RC_ASSERT(found->second.size() == 1u);
      }
  for (const FacePair& face : surface.faces) {
    const CellId below = sides.at(sorted_nodes(mesh, face.lower))[0], above = sides.at(sorted_nodes(mesh, face.upper))[0];
    const Vec3 normal = area_of(mesh, mesh.type(face.lower), mesh.cell(face.lower));
    RC_ASSERT(normal.dot(centre(mesh, above) - centre(mesh, below)) > 0);
    RC_ASSERT(centre(mesh, face.lower) == centre(mesh, face.upper));
  }
}

RC_GTEST_PROP(SplitRandom, BoundaryOfTwoSetsOfCellsInThePlane, ()) {
  full_boundary(true);
}
RC_GTEST_PROP(SplitRandom, BoundaryOfTwoSetsOfCellsInSpace, ()) {
  full_boundary(false);
}

/// Random faces of one plane: a node is doubled when all faces of the plane around it are open. (Triangles lie in pairs, so a face of the
/// grid is open as a whole.)
RC_GTEST_PROP(SplitRandom, PartsOfAPlane, ()) {
  const int nx = any_of(1, 5), ny = any_of(1, 5), chance = any_of(1, 10);
  const Cell cell = *rc::gen::elementOf(space_cells);
  RandomGrid g{{nx, ny, 2}, {}};
  g.part.assign(static_cast<std::size_t>(2 * nx * ny), 1);
  std::fill_n(g.part.begin(), nx * ny, 0);
  std::vector<bool> is_open;
  for (int f = 0; f < nx * ny; ++f) is_open.push_back(any_of(0, 9) < chance);
  const auto open_at = [&](int i, int j) { return bool(is_open[static_cast<std::size_t>(j * nx + i)]); };
  Mesh mesh = mesh_of(g, false, cell);
  std::erase_if(mesh.groups["joint"].cells, [&](CellId id) {
    const Vec3 c = centre(mesh, id);
    return !open_at(static_cast<int>(c.x()), static_cast<int>(c.y()));
  });
  std::vector<int> doubled;
  for (int node = 0; node < static_cast<int>(mesh.nodes.size()); ++node) {
    const Vec3& x = mesh.nodes[node];
    if (x.z() != 1) continue;
    bool all = true;
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        if (x[0] >= i && x[0] <= i + 1 && x[1] >= j && x[1] <= j + 1) all = all && open_at(i, j);
    if (all) doubled.push_back(node);
  }
  if (doubled.empty()) {
    RC_ASSERT(!mesh_refusal([&] { split(mesh, {"joint"}, {"soil"}, mesh_file); }).empty());
    return;
  }
  const std::size_t before = mesh.nodes.size();
  const OpenedSurface surface = split(mesh, {"joint"}, {"soil"}, mesh_file)[0];
  RC_ASSERT(mesh.nodes.size() == before + doubled.size());
  std::vector<int> lower;
  for (const NodePair& pair : surface.pairs) lower.push_back(pair.lower);
  RC_ASSERT(lower == doubled);
  const bool whole = std::find(is_open.begin(), is_open.end(), false) == is_open.end();
  RC_ASSERT(connected_pieces(mesh).count() == (whole ? 2 : 1));
}

}  // namespace
}  // namespace uplift::split_random_test
