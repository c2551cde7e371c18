#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "unit/mesh/mesh_support.h"
#include "uplift/mesh/convert.h"

namespace uplift::grid_test {
namespace {

using namespace support;

const std::vector<double> x{0, 1, 2.5, 3}, y{-1, 0, 0.5}, z{0, 2, 2.5, 4, 5};

/// Each side has one or two cells, and the faces of the groups of `outer` are those with one.
void expect_conforming(const Mesh& mesh, const std::vector<std::string>& outer) {
  std::size_t open = 0, named = 0;
  const auto sides = side_map(mesh);
  for (const auto& [nodes, cells] : sides) {
    ASSERT_LE(cells.size(), 2u);
    open += cells.size() == 1;
  }
  for (const std::string& name : outer)
    for (const CellId id : mesh.groups.at(name).cells) {
      const auto found = sides.find(sorted_nodes(mesh, id));
      ASSERT_NE(found, sides.end()) << name;
      EXPECT_EQ(found->second.size(), 1u) << name;
      ++named;
    }
  EXPECT_EQ(open, named);
}

TEST(Box, PlaneOfEveryCell) {
  for (const Cell cell : plane_cells) {
    SCOPED_TRACE(info(cell).name);
    const Mesh mesh = rectangle(x, y, cell);
    expect_conforming(mesh, {"left", "right", "bottom", "top"});
    EXPECT_NEAR(size_of(mesh, "volume"), 4.5, 1e-13);
    EXPECT_NEAR(size_of(mesh, "left"), 1.5, 1e-14);
    EXPECT_NEAR(size_of(mesh, "top"), 3, 1e-14);
    for (const int node : nodes_of(mesh, mesh.groups.at("right"))) EXPECT_EQ(mesh.nodes[node].x(), 3);
    for (const int node : nodes_of(mesh, mesh.groups.at("bottom"))) EXPECT_EQ(mesh.nodes[node].y(), -1);
  }
}

TEST(Box, SpaceOfEveryCell) {
  for (const Cell cell : space_cells) {
    SCOPED_TRACE(info(cell).name);
    const Mesh mesh = box(x, y, z, cell);
    expect_conforming(mesh, {"left", "right", "front", "back", "bottom", "top"});
    EXPECT_NEAR(size_of(mesh, "volume"), 22.5, 1e-12);
    EXPECT_NEAR(size_of(mesh, "left"), 7.5, 1e-13);
    EXPECT_NEAR(size_of(mesh, "back"), 15, 1e-13);
    EXPECT_NEAR(size_of(mesh, "top"), 4.5, 1e-13);
    for (const int node : nodes_of(mesh, mesh.groups.at("front"))) EXPECT_EQ(mesh.nodes[node].y(), -1);
    for (const int node : nodes_of(mesh, mesh.groups.at("top"))) EXPECT_EQ(mesh.nodes[node].z(), 5);
    for (const auto& [name, group] : mesh.groups)  // outward
      if (group.dimension == 2)
        for (const CellId id : group.cells)
          EXPECT_GT(area_of(mesh, mesh.type(id), mesh.cell(id)).dot(centre(mesh, id) - Vec3(1.5, -0.25, 2.5)), 0) << name;
  }
}

TEST(Box, NodeCounts) {
  const int nx = 3, ny = 2, nz = 4;
  const auto nodes = [](const Mesh& mesh) { return static_cast<int>(mesh.nodes.size()); };
  const int linear = (nx + 1) * (ny + 1) * (nz + 1), full = (2 * nx + 1) * (2 * ny + 1) * (2 * nz + 1);
  const int edges = nx * (ny + 1) * (nz + 1) + (nx + 1) * ny * (nz + 1) + (nx + 1) * (ny + 1) * nz;
  for (const Cell cell : {Cell::hex8, Cell::tet4, Cell::wedge6}) EXPECT_EQ(nodes(box(x, y, z, cell)), linear);
  EXPECT_EQ(nodes(box(x, y, z, Cell::hex20)), linear + edges);
  EXPECT_EQ(nodes(box(x, y, z, Cell::hex27)), full);
  EXPECT_EQ(nodes(box(x, y, z, Cell::tet10)), full);  // a diagonal in each face and brick
  EXPECT_EQ(nodes(box(x, y, z, Cell::wedge15)), linear + edges + nx * ny * (nz + 1));
  EXPECT_EQ(nodes(rectangle(x, y, Cell::quad8)), (nx + 1) * (ny + 1) + nx * (ny + 1) + (nx + 1) * ny);
  for (const Cell cell : {Cell::quad9, Cell::tri6}) EXPECT_EQ(nodes(rectangle(x, y, cell)), (2 * nx + 1) * (2 * ny + 1));
  EXPECT_EQ(box(x, y, z, Cell::tet4).block(Cell::tet4).count(), 6 * nx * ny * nz);
  EXPECT_EQ(box(x, y, z, Cell::wedge6).block(Cell::wedge6).count(), 2 * nx * ny * nz);
}

/// Uniform in [least, most] from the first case on (rapidcheck would begin with small ranges).
int any_of(int least, int most) {
  return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(least, most + 1));
}

/// Any numbering of the nodes: the cut of each quadrilateral is the same from both sides.
RC_GTEST_PROP(Convert, SimplicesConformForAnyNumbering, ()) {
  const Mesh base = *rc::gen::element(box(uniform_lines(0, 3, 3), y, uniform_lines(0, 2, 2)),
                                      box(uniform_lines(0, 2, 2), y, uniform_lines(0, 2, 2), Cell::wedge6), rectangle(x, y));
  std::vector<int> order(base.nodes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  for (std::size_t i = 1; i < order.size(); ++i) std::swap(order[i], order[any_of(0, static_cast<int>(i))]);
  Mesh mesh = base;
  for (std::size_t i = 0; i < order.size(); ++i) mesh.nodes[order[i]] = base.nodes[i];
  for (CellBlock& block : mesh.blocks)
    for (int& node : block.nodes) node = order[node];
  const Mesh cut = to_simplices(mesh);
  check_mesh(cut, mesh_file);
  expect_conforming(cut, mesh.dimension == 2 ? std::vector<std::string>{"left", "right", "bottom", "top"}
                                             : std::vector<std::string>{"left", "right", "front", "back", "bottom", "top"});
  RC_ASSERT(!::testing::Test::HasFailure());
  RC_ASSERT(std::abs(size_of(cut, "volume") - size_of(base, "volume")) < 1e-12);
}

TEST(Lines, Uniform) {
  EXPECT_EQ(uniform_lines(-1, 1, 4), (std::vector<double>{-1, -0.5, 0, 0.5, 1}));
  EXPECT_EQ(uniform_lines(0.1, 0.7, 7).front(), 0.1);
  EXPECT_EQ(uniform_lines(0.1, 0.7, 7).back(), 0.7);
}

/// A geometric series fits: 1 + 2 + 4 + 8 beside a cell of 1.
TEST(Lines, GeometricSeries) {
  const std::vector<double> lines = graded_lines(0, {{1 + 2 + 4 + 8, 100}, {16, 1}}, 2);
  ASSERT_EQ(lines.size(), 6u);
  const double wanted[] = {0, 8, 12, 14, 15, 16};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(lines[i], wanted[i], 1e-12);
}

RC_GTEST_PROP(Lines, RefinedInterval, ()) {
  const auto length = [](double least, double most) { return least + (most - least) * (any_of(0, 1000) / 1000.0); };
  const double from = length(-20, 5), fine_from = from + (*rc::gen::arbitrary<bool>() ? length(0.01, 50) : 0.0),
               fine_to = fine_from + length(0.1, 20), to = fine_to + (*rc::gen::arbitrary<bool>() ? length(0.01, 50) : 0.0),
               size = length(0.02, 2), largest = size * length(1, 20), growth = length(1.01, 2);
  const std::vector<double> lines = refined_lines(from, fine_from, fine_to, to, size, largest, growth);
  RC_ASSERT(lines.front() == from && lines.back() == to);
  const auto a = std::find(lines.begin(), lines.end(), fine_from), b = std::find(lines.begin(), lines.end(), fine_to);
  RC_ASSERT(a != lines.end() && b != lines.end());
  const double tight = 1 + 1e-9;
  for (auto i = lines.begin(); i + 1 != lines.end(); ++i) {
    const double h = i[1] - i[0];
    RC_ASSERT(h > 0);
    RC_ASSERT(h <= largest * tight);
    if (i >= a && i < b) {
      RC_ASSERT(h <= size * tight);
      RC_ASSERT(std::abs(h - (fine_to - fine_from) / static_cast<double>(b - a)) <= 1e-9 * size);  // uniform
    }
    if (i + 2 == lines.end() || i + 1 == a || i + 1 == b) continue;
    const double ratio = (i[2] - i[1]) / h;
    RC_ASSERT(ratio <= growth * tight && ratio >= 1 / (growth * tight));
  }
  if (b + 1 != lines.end()) RC_ASSERT(b[1] - b[0] <= size * tight);  // growth starts from the fine size
  if (a != lines.begin()) RC_ASSERT(a[0] - a[-1] <= size * tight);
}

/// A geometric series from any stretch bounds all cells: the one that begins at a distance s from cells of length h is at most h + (growth
/// - 1) s.
RC_GTEST_PROP(Lines, EveryStretchBoundsItsSurroundings, ()) {
  const double growth = 1 + any_of(1, 100) / 100.0;
  double end = 0;
  std::vector<Stretch> stretches;
  for (int i = any_of(1, 5); i > 0; --i) {
    end += any_of(1, 1000) / 100.0;
    stretches.push_back({end, any_of(1, 300) / 100.0});
  }
  const std::vector<double> lines = graded_lines(0, stretches, growth);
  double from = 0;
  for (const Stretch& stretch : stretches) {
    RC_ASSERT(std::find(lines.begin(), lines.end(), stretch.to) != lines.end());
    for (std::size_t i = 1; i < lines.size(); ++i) {
      const double distance = std::max({0.0, from - lines[i], lines[i - 1] - stretch.to});
      RC_ASSERT(lines[i] > lines[i - 1]);
      RC_ASSERT(lines[i] - lines[i - 1] <= (stretch.size + (growth - 1) * distance) * (1 + 1e-9));
    }
    from = stretch.to;
  }
}

}  // namespace
}  // namespace uplift::grid_test
