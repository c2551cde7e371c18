#include "uplift/io/fields/fields.h"

#include <gtest/gtest.h>

#include "unit/io/fields_support.h"
#include "uplift/base/error.h"
#include "uplift/io/text/base64.h"
#include "uplift/math/linalg.h"

// Blocks of fields and VTU files: judged by what a reader finds in them, exact numbers and geometry in VTK's own convention.
namespace uplift::fields_test {
namespace {

using namespace fields_support;

// ---- base64 ----

TEST(Base64, VectorsOfRfc4648) {
  const std::vector<std::pair<std::string, std::string>> vectors{
      {"", ""}, {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"foob", "Zm9vYg=="}, {"fooba", "Zm9vYmE="}, {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : vectors) {
    std::string written = "before ";
    append_base64(written, bytes);
    EXPECT_EQ(written, "before " + text);
    EXPECT_EQ(base64_length(bytes.size()), text.size());
  }
  std::string all, written;
  for (int byte = 0; byte < 256; ++byte) all += static_cast<char>(byte);
  append_base64(written, all);
  EXPECT_EQ(from_base64(written), all);
}

// ---- blocks ----

TEST(FieldMesh, CellsOfSeveralGroupsOnceWithTheNodesTheyUse) {
  const Mesh mesh = box(uniform_lines(0, 3, 3), uniform_lines(0, 1, 1), uniform_lines(0, 1, 1));
  Mesh named = mesh;
  const int solid = mesh.find_block(Cell::hex8);
  named.groups["first"] = {3, {{solid, 0}, {solid, 1}}, {}};
  named.groups["middle"] = {3, {{solid, 1}}, {}};
  const FieldMesh block = field_mesh(named, "part", {"middle", "first"}, here);
  ASSERT_EQ(block.cell.size(), 2u);
  EXPECT_EQ(block.points.size(), 12u);
  ASSERT_EQ(block.marks.size(), 1u);
  EXPECT_EQ(block.marks[0].values, (std::vector<int>{1, 0}));  // the second cell is in both; "middle" was named first
  for (std::size_t i = 0; i < block.points.size(); ++i) EXPECT_EQ(block.points[i], mesh.nodes[static_cast<std::size_t>(block.node[i])]);
  for (std::size_t c = 0; c < 2; ++c)
    for (std::size_t i = 0; i < 8; ++i)
      EXPECT_EQ(block.node[static_cast<std::size_t>(block.blocks[0][static_cast<int>(c)][i])], mesh.cell(block.cell[c])[i]);
}

TEST(FieldMesh, SaysWhichGroupIsWrong) {
  Mesh mesh = rectangle(uniform_lines(0, 1, 1), uniform_lines(0, 1, 1));
  mesh.groups["corner"] = {0, {}, {0}};
  const auto message = [&](const std::vector<std::string>& groups) {
    try {
      field_mesh(mesh, "part", groups, here);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message({"volum"}).find("did you mean \"volume\"?"), std::string::npos);
  EXPECT_NE(message({"volume", "corner"}).find("corner"), std::string::npos);
  EXPECT_NE(message({}).find("at least one group"), std::string::npos);
}

TEST(FieldMesh, VectorsOfAPlaneModelGetAThirdComponent) {
  const Mesh mesh = rectangle(uniform_lines(0, 2, 2), uniform_lines(0, 1, 1));
  std::vector<double> nodal;
  for (const Vec3& node : mesh.nodes) nodal.insert(nodal.end(), {node.x() + 10, node.y() + 20});
  const FieldMesh block = field_mesh(mesh, "right", {"right"}, here);
  ASSERT_EQ(block.points.size(), 2u);
  EXPECT_EQ(at_points(block, FieldKind::vector, nodal, 2), (std::vector<double>{12, 20, 0, 12, 21, 0}));
}

// ---- faces ----

/// Soil below y = 0 with a notch: the surface runs along a bottom and up a wall, and its other end stops inside the continuum.
TEST(InterfaceMesh, FacesShareNoPointsAndCornersBelongToTheirFaces) {
  Mesh mesh = rectangle(uniform_lines(0, 4, 4), uniform_lines(0, 2, 2));
  const int solid = mesh.find_block(Cell::quad4);
  Group soil{2, {}, {}};
  for (int i = 0; i < 8; ++i)
    if (i < 4 || i == 7) soil.cells.push_back({solid, i});  // the lower row and the last of the upper row
  mesh.groups["soil"] = soil;
  CellBlock& edges = mesh.block(Cell::line2);
  const auto node = [&](double x, double y) {
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
      if (mesh.nodes[i] == Vec3(x, y, 0)) return static_cast<int>(i);
    throw std::runtime_error("no such node");
  };
  const int lines = mesh.find_block(Cell::line2), before = edges.count();
  for (const int n : {node(2, 1), node(1, 1), node(3, 1), node(2, 1), node(3, 2), node(3, 1)}) edges.nodes.push_back(n);
  mesh.groups["bottom_joint"] = {1, {{lines, before}, {lines, before + 1}}, {}};
  mesh.groups["wall_joint"] = {1, {{lines, before + 2}}, {}};
  const auto surfaces = split(mesh, {"bottom_joint", "wall_joint"}, {"soil"}, here);
  const InterfaceMesh faces = interface_mesh(mesh, "joints", surfaces);
  const FieldMesh& block = faces.mesh;
  ASSERT_EQ(block.cell.size(), 6u);     // three faces, two faces each
  EXPECT_EQ(block.points.size(), 12u);  // two of each side of each face
  EXPECT_EQ(block.marks[0].meanings, (std::vector<std::string>{"bottom_joint", "wall_joint"}));

  // Opening of a place: 10 x + y of its node, 100 more on the wall. Both faces have it, whichever surface asks.
  std::vector<double> opening;
  for (const OpenedSurface& surface : surfaces)
    for (const FacePair& face : surface.faces)
      for (const int n : mesh.cell(face.lower)) {
        const Vec3& at = mesh.nodes[static_cast<std::size_t>(n)];
        opening.push_back(10 * at.x() + at.y() + (surface.name == "wall_joint" ? 100 : 0));
      }
  const std::vector<double> values = at_points(faces, FieldKind::scalar, opening);
  std::vector<double> by_face{7, 8, 9};
  const std::vector<double> of_cells = at_cells(faces, FieldKind::scalar, by_face);
  std::vector<int> met(12, 0);
  for (int cell = 0; cell < 6; ++cell) {
    const auto c = static_cast<std::size_t>(cell);
    const bool wall = block.marks[0].values[c] == 1;
    const FacePair& face = wall ? surfaces[1].faces[0] : surfaces[0].faces[static_cast<std::size_t>(faces.face[c])];
    EXPECT_EQ(block.cell[c], block.marks[1].values[c] == 0 ? face.lower : face.upper);
    EXPECT_EQ(of_cells[c], by_face[static_cast<std::size_t>(faces.face[c])]);
    for (std::size_t i = 0; i < 2; ++i) {
      const auto point = static_cast<std::size_t>(block.blocks[0][cell][i]);
      EXPECT_EQ(block.node[point], mesh.cell(block.cell[c])[i]);
      const Vec3& at = block.points[point];
      ++met[point];
      EXPECT_EQ(values[point], 10 * at.x() + at.y() + (wall ? 100 : 0));
    }
  }
  EXPECT_EQ(met, std::vector<int>(12, 1));  // no point belongs to two cells
}

// ---- VTU ----

TEST(Vtu, EveryNumberComesBack) {
  const Mesh mesh = two_boxes(Cell::hex20, Cell::tet10);
  const std::vector<FieldMesh> blocks{both(mesh), field_mesh(mesh, "all <of> \"it\"", {"right"}, here)};
  for (const FieldPrecision precision : {FieldPrecision::float32, FieldPrecision::float64}) {
    Files files;
    VtuWriter writer("out/fields", blocks, precision, into(files));
    for (int k = 0; k < 3; ++k) EXPECT_FALSE(writer.write(frame_of(blocks, k)));
    writer.finish();
    EXPECT_EQ(files.size(), 2u * 3 + 2 + 1);

    std::vector<const XmlElement*> entries;
    const XmlElement list = XmlParser::parse(files.at("out/fields.pvd"));
    list.all("DataSet", entries);
    ASSERT_EQ(entries.size(), 6u);
    for (int i = 0; i < 6; ++i) {
      const int k = i / 2, b = i % 2;
      const auto& entry = entries[static_cast<std::size_t>(i)]->attributes;
      EXPECT_EQ(std::stod(entry.at("timestep")), 0.1 * k);
      EXPECT_EQ(entry.at("part"), std::to_string(b));
      const FieldMesh& block = blocks[static_cast<std::size_t>(b)];
      EXPECT_EQ(entry.at("name"), block.name);
      const XmlElement file = XmlParser::parse(files.at("out/" + entry.at("file")));
      EXPECT_EQ(file.attributes.at("header_type"), "UInt64");
      EXPECT_EQ(numbers_of<double>(file.at("UnstructuredGrid").at("FieldData").at("DataArray", "TimeValue")), std::vector{0.1 * k});
      const XmlElement& piece = piece_of(file);
      EXPECT_EQ(std::stoul(piece.attributes.at("NumberOfPoints")), block.points.size());
      EXPECT_EQ(std::stoul(piece.attributes.at("NumberOfCells")), block.cell.size());
      const auto points = numbers_of<double>(piece.at("Points").at("DataArray"));
      for (std::size_t p = 0; p < block.points.size(); ++p)
        for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(points[3 * p + c], block.points[p][static_cast<Index>(c)]);
      EXPECT_EQ(numbers_of<int>(piece.at("CellData").at("DataArray", "group")), block.marks[0].values);
      const auto expect_values = [&](const std::string& place, const std::string& name, FieldKind kind, std::size_t places) {
        const XmlElement& array = piece.at(place).at("DataArray", name);
        const std::vector<double> wanted = unique_values(kind, places, k);
        if (precision == FieldPrecision::float64)
          EXPECT_EQ(numbers_of<double>(array), wanted);
        else
          EXPECT_EQ(numbers_of<float>(array), std::vector<float>(wanted.begin(), wanted.end()));
      };
      expect_values("PointData", "displacement [m]", FieldKind::vector, block.points.size());
      expect_values("PointData", "pressure [m]", FieldKind::scalar, block.points.size());
      expect_values("CellData", "stress", FieldKind::tensor, block.cell.size());
      expect_values("CellData", "velocity", FieldKind::vector, block.cell.size());
      expect_values("CellData", "status", FieldKind::scalar, block.cell.size());
    }
    EXPECT_EQ(files.at("out/fields/all_of_it_names.csv"), "cell field,value,name\ngroup,0,\"<left> & \"\"rest\"\"\"\ngroup,1,\"right\"\n");
  }
}

/// VTK's convention of cells of each type: number, corners of its first face (its normal points out), a corner beyond that face, pairs of
/// corners whose middles follow the corners (VTK User's Guide, "Cell types"; vtkWedge.h for the direction of wedges).
struct VtkCell {
  Cell cell;
  int type;
  std::array<int, 3> face;
  int beyond;
  std::vector<std::pair<int, int>> middles;
};
const std::vector<std::pair<int, int>> hex_middles{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                                   {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
const std::vector<VtkCell> vtk_cells{
    {Cell::tet4, 10, {0, 2, 1}, 3, {}},
    {Cell::tet10, 24, {0, 2, 1}, 3, {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}},
    {Cell::wedge6, 13, {0, 1, 2}, 3, {}},
    {Cell::wedge15, 26, {0, 1, 2}, 3, {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}},
    {Cell::hex8, 12, {0, 3, 2}, 4, {}},
    {Cell::hex20, 25, {0, 3, 2}, 4, hex_middles},
    {Cell::hex27, 29, {0, 3, 2}, 4, hex_middles}};

TEST(Vtu, CellsStandAsVtkWantsThem) {
  for (const VtkCell& wanted : vtk_cells) {
    const std::vector<FieldMesh> blocks{both(two_boxes(wanted.cell, Cell::hex8))};
    Files files;
    VtuWriter writer("f", blocks, FieldPrecision::float64, into(files));
    ASSERT_FALSE(writer.write(frame_of(blocks, 0)));
    const XmlElement file = XmlParser::parse(files.at("f/all_of_it_000000.vtu"));
    const XmlElement& cells = piece_of(file).at("Cells");
    const auto nodes = numbers_of<int>(cells.at("DataArray", "connectivity")), ends = numbers_of<int>(cells.at("DataArray", "offsets"));
    const auto types = numbers_of<unsigned char>(cells.at("DataArray", "types"));
    const auto points = numbers_of<double>(piece_of(file).at("Points").at("DataArray"));
    ASSERT_EQ(ends.size(), blocks[0].cell.size());
    ASSERT_EQ(types.size(), ends.size());
    EXPECT_EQ(ends.back(), static_cast<int>(nodes.size()));
    int checked = 0;
    for (std::size_t c = 0; c < ends.size(); ++c) {
      if (types[c] != wanted.type) continue;
      ++checked;
      const auto point = [&](int i) {
        const auto at = static_cast<std::size_t>(nodes[static_cast<std::size_t>((c ? ends[c - 1] : 0) + i)]) * 3;
        return Vec3(points[at], points[at + 1], points[at + 2]);
      };
      const Vec3 normal = cross(point(wanted.face[1]) - point(wanted.face[0]), point(wanted.face[2]) - point(wanted.face[0]));
      EXPECT_LT(normal.dot(point(wanted.beyond) - point(wanted.face[0])), -0.1 / 8);  // the height is at least 0.5, the area 1 / 8
      int middle = info(wanted.cell).corners;
      for (const auto& [a, b] : wanted.middles) EXPECT_LT((point(middle++) - (point(a) + point(b)) / 2).norm(), 1e-15);
    }
    EXPECT_GE(checked, 8);
  }
}

TEST(Vtu, TypesOfSurfacesAndLines) {
  const std::vector<std::pair<Cell, int>> surfaces{
      {Cell::tri3, 5}, {Cell::tri6, 22}, {Cell::quad4, 9}, {Cell::quad8, 23}, {Cell::quad9, 28}};
  for (const auto& [cell, type] : surfaces) {
    const Mesh mesh = rectangle(uniform_lines(0, 1, 1), uniform_lines(0, 1, 1), cell);
    const std::vector<FieldMesh> blocks{field_mesh(mesh, "plane", {"volume", "top"}, here)};
    Files files;
    VtuWriter writer("f", blocks, FieldPrecision::float32, into(files));
    ASSERT_FALSE(writer.write(frame_of(blocks, 0)));
    const XmlElement file = XmlParser::parse(files.at("f/plane_000000.vtu"));
    const auto types = numbers_of<unsigned char>(piece_of(file).at("Cells").at("DataArray", "types"));
    const int edge = info(cell).nodes == info(cell).corners ? 3 : 21;
    EXPECT_EQ(std::count(types.begin(), types.end(), type), info(cell).corners == 3 ? 2 : 1);
    EXPECT_EQ(std::count(types.begin(), types.end(), edge), 1);
  }
}

}  // namespace
}  // namespace uplift::fields_test
