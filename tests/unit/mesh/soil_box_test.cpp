#include "uplift/mesh/soil_box.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "unit/mesh/mesh_support.h"

namespace uplift::soil_box_test {
namespace {

using namespace support;

SoilBox model_3d() {
  SoilBox model;
  model.dimension = 3;
  model.cell = Cell::hex8;
  model.soil = {{40, 30}, {{2.5, 1}, {7.3, 2}, {5, 2}}, 5};
  model.raft = {{8, 6}, 1.2, {0, 0}, 0.8};
  model.block = {{4, 3}, 9, {1.5, -0.5}, 1};
  return model;
}
SoilBox model_2d() {
  SoilBox model = model_3d();
  model.dimension = 2;
  model.cell = Cell::quad4;
  return model;
}
Mesh made(const SoilBox& model) {
  Mesh mesh = soil_box(model, mesh_file);
  check_mesh(mesh, mesh_file);
  for (const auto& [nodes, cells] : side_map(mesh)) EXPECT_LE(cells.size(), 2u);
  return mesh;
}

/// Sizes of parts and surfaces in closed form, for every cell type, on the surface and embedded (by less and by more than the raft's
/// thickness).
TEST(SoilBoxModel, AreasAndVolumes) {
  for (const double depth : {0.0, 0.7, 2.0}) {
    const double in_raft = std::min(depth, 1.2), in_block = std::max(0.0, depth - 1.2);
    for (const Cell cell : plane_cells) {
      SoilBox model = model_2d();
      model.cell = cell;
      model.embedment = depth;
      const Mesh mesh = made(model);
      EXPECT_NEAR(size_of(mesh, "raft"), 8 * 1.2, 1e-11);
      EXPECT_NEAR(size_of(mesh, "block"), 4 * 9, 1e-11);
      EXPECT_NEAR(size_of(mesh, "soil_1"), 40 * 2.5 - 8 * in_raft - 4 * in_block, 1e-11);
      EXPECT_NEAR(size_of(mesh, "soil_2"), 40 * 7.3, 1e-10);
      EXPECT_NEAR(size_of(mesh, "soil_3"), 40 * 5, 1e-10);
      EXPECT_NEAR(size_of(mesh, "interface"), 8 + 2 * in_raft + (in_block > 0 ? 8 - 4 : 0) + 2 * in_block, 1e-11);
      EXPECT_NEAR(size_of(mesh, "soil_left"), 14.8, 1e-12);
      EXPECT_NEAR(size_of(mesh, "soil_bottom"), 40, 1e-11);
      EXPECT_NEAR(size_of(mesh, "soil_top"), 40 - (in_block > 0 ? 4 : 8), 1e-11);
      EXPECT_NEAR(size_of(mesh, "block_top"), 4, 1e-12);
    }
    for (const Cell cell : {Cell::hex8, Cell::hex20, Cell::tet4, Cell::wedge6}) {
      SoilBox model = model_3d();
      model.cell = cell;
      model.embedment = depth;
      const Mesh mesh = made(model);
      EXPECT_NEAR(size_of(mesh, "raft"), 48 * 1.2, 1e-10);
      EXPECT_NEAR(size_of(mesh, "block"), 12 * 9, 1e-10);
      EXPECT_NEAR(size_of(mesh, "soil_1"), 1200 * 2.5 - 48 * in_raft - 12 * in_block, 1e-9);
      EXPECT_NEAR(size_of(mesh, "soil_3"), 1200 * 5, 1e-9);
      EXPECT_NEAR(size_of(mesh, "interface"), 48 + 28 * in_raft + (in_block > 0 ? 48 - 12 : 0) + 14 * in_block, 1e-10);
      EXPECT_NEAR(size_of(mesh, "soil_front"), 40 * 14.8, 1e-10);
      EXPECT_NEAR(size_of(mesh, "soil_right"), 30 * 14.8, 1e-10);
      EXPECT_NEAR(size_of(mesh, "soil_top"), 1200 - (in_block > 0 ? 12 : 48), 1e-9);
      EXPECT_NEAR(size_of(mesh, "soil_bottom"), 1200, 1e-9);
    }
  }
}

/// Each face of the interface has soil on one side, towards which its normal does not point, and the structure on the other.
TEST(SoilBoxModel, InterfaceBetweenSoilAndStructure) {
  SoilBox model = model_3d();
  model.embedment = 2;
  const Mesh mesh = made(model);
  std::set<CellId> structure;
  for (const char* part : {"raft", "block"}) structure.insert(mesh.groups.at(part).cells.begin(), mesh.groups.at(part).cells.end());
  const auto sides = side_map(mesh);
  std::size_t between = 0;
  for (const auto& [nodes, cells] : sides) between += cells.size() == 2 && structure.contains(cells[0]) != structure.contains(cells[1]);
  EXPECT_EQ(mesh.groups.at("interface").cells.size(), between);
  for (const CellId id : mesh.groups.at("interface").cells) {
    const auto& cells = sides.at(sorted_nodes(mesh, id));
    ASSERT_EQ(cells.size(), 2u);
    const bool first = structure.contains(cells[0]);
    ASSERT_NE(first, structure.contains(cells[1]));
    const Vec3 up = centre(mesh, cells[first ? 0 : 1]) - centre(mesh, cells[first ? 1 : 0]);
    EXPECT_GT(area_of(mesh, mesh.type(id), mesh.cell(id)).dot(up), 0);
  }
}

TEST(SoilBoxModel, PlacesOfParts) {
  SoilBox model = model_3d();
  model.embedment = 0.7;
  const Mesh mesh = made(model);
  const auto bounds = [&](const std::string& group) {
    Vec3 least = Vec3::Constant(1e9), most = -least;
    for (const int node : nodes_of(mesh, mesh.groups.at(group))) {
      least = least.cwiseMin(mesh.nodes[node]);
      most = most.cwiseMax(mesh.nodes[node]);
    }
    return std::pair{least, most};
  };
  const auto near = [](const Vec3& a, const Vec3& b) { return (a - b).norm() < 1e-12; };
  EXPECT_TRUE(near(bounds("raft").first, {-4, -3, -0.7}) && near(bounds("raft").second, {4, 3, 0.5}));
  EXPECT_TRUE(near(bounds("block").first, {-0.5, -2, 0.5}) && near(bounds("block").second, {3.5, 1, 9.5}));
  EXPECT_TRUE(near(bounds("soil_1").first, {-20, -15, -2.5}) && near(bounds("soil_1").second, {20, 15, 0}));
  EXPECT_TRUE(near(bounds("soil_2").first, {-20, -15, -9.8}) && near(bounds("soil_2").second, {20, 15, -2.5}));
  EXPECT_TRUE(near(bounds("soil_bottom").first, {-20, -15, -14.8}) && near(bounds("soil_bottom").second, {20, 15, -14.8}));
}

/// No element is longer than its part's size, in any direction.
TEST(SoilBoxModel, SizesOfElements) {
  const SoilBox model = model_3d();
  const Mesh mesh = made(model);
  const auto largest = [&](const std::string& group, int axis) {
    double most = 0;
    for (const CellId id : mesh.groups.at(group).cells) {
      const auto nodes = mesh.cell(id);
      most = std::max(most, mesh.nodes[nodes[6]][axis] - mesh.nodes[nodes[0]][axis]);  // opposite corners of a brick along the axes
    }
    return most;
  };
  const double tight = 1 + 1e-9;
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(largest("raft", axis), 0.8 * tight);
    EXPECT_LE(largest("block", axis), 1 * tight);
  }
  EXPECT_LE(largest("soil_1", 2), 1 * tight);
  EXPECT_LE(largest("soil_2", 2), 2 * tight);
  for (int axis = 0; axis < 2; ++axis) EXPECT_LE(largest("soil_1", axis), 5 * tight);
  EXPECT_GT(largest("soil_1", 0), 2);  // coarser far away
}

TEST(SoilBoxModel, BlockWithoutRaftAndRaftWithoutBlock) {
  SoilBox model = model_2d();
  model.raft.height = 0;
  Mesh mesh = made(model);
  EXPECT_FALSE(mesh.groups.contains("raft"));
  EXPECT_NEAR(size_of(mesh, "interface"), 4, 1e-12);
  for (const int node : nodes_of(mesh, mesh.groups.at("interface"))) {
    EXPECT_EQ(mesh.nodes[node].y(), 0);
    EXPECT_LE(std::abs(mesh.nodes[node].x() - 1.5), 2 + 1e-12);
  }
  model = model_2d();
  model.block.height = 0;
  mesh = made(model);
  EXPECT_FALSE(mesh.groups.contains("block"));
  EXPECT_NEAR(size_of(mesh, "interface"), 8, 1e-12);
  EXPECT_NEAR(size_of(mesh, "raft_top"), 8, 1e-12);
}

/// Block and raft with the same edge but for round-off: no sliver between their lines.
TEST(SoilBoxModel, FlushEdges) {
  SoilBox model = model_2d();
  model.raft.width[0] = 0.3;
  model.block.width[0] = 0.1;
  model.block.offset[0] = 0.3 / 2 - 0.1 / 2 + 1e-16;
  model.soil.width[0] = 2;
  const Mesh mesh = made(model);
  for (const CellId id : mesh.groups.at("raft").cells) EXPECT_GT(signed_size(mesh, id), 1e-4);
  EXPECT_NEAR(size_of(mesh, "block"), 0.9, 1e-12);
}

TEST(SoilBoxModel, LevelGround) {
  SoilBox model = model_3d();
  model.raft.height = model.block.height = model.embedment = 0;
  const Mesh mesh = soil_box(model, mesh_file);
  double depth = 0, volume = 0;
  for (const SoilBox::Layer& layer : model.soil.layers) depth += layer.thickness;
  for (std::size_t i = 0; i < model.soil.layers.size(); ++i) volume += size_of(mesh, "soil_" + std::to_string(i + 1));
  const double plan = model.soil.width[0] * model.soil.width[1];
  EXPECT_NEAR(volume, plan * depth, 1e-9 * plan * depth);
  EXPECT_NEAR(size_of(mesh, "soil_top"), plan, 1e-9 * plan);
  for (const char* none : {"interface", "raft", "block", "block_top"}) EXPECT_FALSE(mesh.groups.contains(none)) << none;
}

TEST(SoilBoxModel, BadValuesAreNamed) {
  const auto refusal = [](const std::function<void(SoilBox&)>& change) {
    SoilBox model = model_3d();
    change(model);
    return mesh_refusal([&] { soil_box(model, mesh_file); });
  };
  EXPECT_EQ(refusal([](SoilBox& m) { m.soil.width[1] = -1; }), "case.toml:7: soil.width: expected a length > 0 m, found -1 m");
  EXPECT_EQ(refusal([](SoilBox& m) { m.soil.layers.clear(); }), "case.toml:7: soil.layers: expected at least one layer, found none");
  EXPECT_EQ(refusal([](SoilBox& m) { m.soil.layers[1].size = 0; }), "case.toml:7: soil.layers.size: expected a length > 0 m, found 0 m");
  EXPECT_EQ(refusal([](SoilBox& m) { m.raft.size = NAN; }), "case.toml:7: raft.size: expected a length > 0 m, found nan m");
  EXPECT_EQ(refusal([](SoilBox& m) { m.block.size = 1e-12; }),
            "case.toml:7: block.size: expected a length of at least a millionth of the soil's width (4e-05 m), found 1e-12 m");
  EXPECT_EQ(refusal([](SoilBox& m) { m.growth = 1; }), "case.toml:7: growth: expected a factor from 1.01 to 2, found 1");
  EXPECT_EQ(refusal([](SoilBox& m) { m.raft.height = m.block.height = 0, m.embedment = 1; }),
            "case.toml:7: embedment: expected 0 m where there is neither a raft nor a block, found 1 m");
  EXPECT_EQ(refusal([](SoilBox& m) { m.block.offset[0] = 2.5; }),
            "case.toml:7: block.width: expected a block inside the plan of the raft, 8 m wide, found 4 m with its middle at 2.5 m");
  EXPECT_EQ(refusal([](SoilBox& m) { m.raft.width[1] = 31; }),
            "case.toml:7: raft.width: expected a raft inside the plan of the soil, 30 m wide, found 31 m with its middle at 0 m");
  EXPECT_EQ(refusal([](SoilBox& m) { m.raft.offset[0] = 1; }),
            "case.toml:7: raft.offset: expected 0 m: the raft is the middle of the model, found 1 m");
  EXPECT_EQ(
      refusal([](SoilBox& m) { m.embedment = 10.2; }),
      "case.toml:7: embedment: expected a depth from 0 m to less than that of the soil and the height of the structure (10.2 m), found "
      "10.2 m");
  EXPECT_EQ(refusal([](SoilBox& m) { m.cell = Cell::quad4; }), "case.toml:7: cell: expected a cell of dimension 3, found quad4");
  EXPECT_NE(
      refusal([](SoilBox& m) { m.soil.size = m.raft.size = 1e-3; }).find("soil.size: expected sizes that make at most 50 million elements"),
      std::string::npos);
}

}  // namespace
}  // namespace uplift::soil_box_test
