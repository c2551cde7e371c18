#include "uplift/mesh/torn.h"

#include <gtest/gtest.h>

#include "unit/mesh/mesh_support.h"
#include "uplift/mesh/convert.h"

// Cells side by side that share no nodes.
namespace uplift::torn_test {
namespace {

using namespace support;

/// Two copies of one mesh side by side along x, with nodes of their own.
Mesh side_by_side(Mesh mesh, double shift) {
  const int nodes = static_cast<int>(mesh.nodes.size());
  for (int i = 0; i < nodes; ++i) mesh.nodes.push_back(mesh.nodes[static_cast<std::size_t>(i)] + Vec3(shift, 0, 0));
  for (CellBlock& block : mesh.blocks) {
    const std::vector<int> first = block.nodes;
    for (const int node : first) block.nodes.push_back(node + nodes);
  }
  return mesh;
}

/// Two meshes as one, in which they share the nodes at the same place.
Mesh joined(Mesh mesh, const Mesh& other) {
  std::vector<int> number;
  for (const Vec3& x : other.nodes) {
    const auto same = std::ranges::find_if(mesh.nodes, [&](const Vec3& y) { return (x - y).norm() < 1e-12; });
    number.push_back(static_cast<int>(same - mesh.nodes.begin()));
    if (same == mesh.nodes.end()) mesh.nodes.push_back(x);
  }
  for (const CellBlock& block : other.blocks)
    for (const int node : block.nodes) mesh.block(block.cell).nodes.push_back(number[static_cast<std::size_t>(node)]);
  return mesh;
}

TEST(Torn, SidesOfAllCells) {
  const std::vector<double> two{0, 0.5, 1}, three{0, 1, 2, 3};
  for (const Cell cell : plane_cells) {
    EXPECT_TRUE(torn_sides(rectangle(two, three, cell), {}).empty()) << info(cell).name;
    EXPECT_EQ(torn_sides(side_by_side(rectangle(two, three, cell), 1), {}).size(), 3u) << info(cell).name;
    EXPECT_TRUE(torn_sides(side_by_side(rectangle(two, three, cell), 1.001), {}).empty()) << info(cell).name;
  }
  for (const Cell cell : {Cell::hex8, Cell::hex20, Cell::hex27}) {
    EXPECT_TRUE(torn_sides(box(two, two, three, cell), {}).empty()) << info(cell).name;
    const std::vector<Vec3> torn = torn_sides(side_by_side(box(two, two, three, cell), 1), {});
    EXPECT_EQ(torn.size(), 6u) << info(cell).name;
    for (const Vec3& middle : torn) EXPECT_NEAR(middle.x(), 1, 1e-14);
  }
}

/// The nodes are shared, the cells do not match.
TEST(Torn, CellsThatDoNotMatch) {
  const std::vector<double> left{0, 1}, right{1, 2}, one{0, 2}, two{0, 1, 2}, apart{0.5, 1.5};
  EXPECT_TRUE(torn_sides(joined(rectangle(left, two), rectangle(right, two, Cell::tri3)), {}).empty());
  // the middle of the large side is where the small ones end
  EXPECT_EQ(torn_sides(joined(rectangle(left, one), rectangle(right, two)), {}).size(), 3u);
  EXPECT_EQ(torn_sides(joined(rectangle(left, one, Cell::quad8), rectangle(right, two)), {}).size(), 3u);
  EXPECT_EQ(torn_sides(joined(rectangle(left, two), rectangle(right, apart)), {}).size(), 3u);
  EXPECT_EQ(torn_sides(joined(rectangle(left, one), rectangle(right, {0, 0.3, 2})), {}).size(), 3u);
  EXPECT_EQ(torn_sides(joined(rectangle(left, one, Cell::tri6), rectangle(right, one, Cell::tri3)), {}).size(), 1u);
  EXPECT_EQ(torn_sides(joined(box(left, one, one), box(right, two, two)), {}).size(), 5u);
  EXPECT_EQ(torn_sides(joined(box(left, one, one), box(right, two, one)), {}).size(), 3u);
  // the middle of the quadrilateral is on the diagonal
  EXPECT_EQ(torn_sides(joined(box(left, one, one), box(right, one, one, Cell::tet4)), {}).size(), 3u);
  // edges alone are shared, in a plane and across
  EXPECT_TRUE(torn_sides(joined(box(left, one, two), box(right, {2, 3}, two)), {}).empty());
  EXPECT_TRUE(torn_sides(joined(box(left, one, one), box(left, one, {2, 3})), {}).empty());
}

/// What an interface opens is meant to be open.
TEST(Torn, OpenedSurfaces) {
  Mesh mesh = side_by_side(rectangle({0, 1}, {0, 1, 2}), 1);
  std::vector<FacePair> faces;
  CellBlock& lines = mesh.block(Cell::line2);
  const int before = lines.count();
  std::vector<int> left, right;
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i)
    if (std::abs(mesh.nodes[static_cast<std::size_t>(i)].x() - 1) < 1e-12) (left.size() < 3 ? left : right).push_back(i);
  ASSERT_EQ(right.size(), 3u);
  lines.nodes.insert(lines.nodes.end(), {left[0], left[1], right[0], right[1]});
  const int block = mesh.find_block(Cell::line2);
  faces.push_back({{block, before}, {block, before + 1}});
  EXPECT_EQ(torn_sides(mesh, {}).size(), 2u);
  EXPECT_EQ(torn_sides(mesh, {faces}).size(), 1u);
  // named pairs of nodes join the other side too: of one pair alone they join none
  const std::vector<int> two_pairs{left[1], left[2], right[1], right[2]}, one_pair{left[2], right[2]};
  EXPECT_EQ(torn_sides(mesh, {}, two_pairs).size(), 1u);
  EXPECT_EQ(torn_sides(mesh, {}, one_pair).size(), 2u);
  EXPECT_TRUE(torn_sides(mesh, {faces}, two_pairs).empty());
}

}  // namespace
}  // namespace uplift::torn_test
