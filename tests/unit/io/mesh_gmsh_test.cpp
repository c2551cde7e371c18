#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>

#include "data_support.h"
#include "text_support.h"
#include "unit/io/mesh_file_support.h"
#include "uplift/base/file.h"
#include "uplift/io/mesh/gmsh.h"

namespace uplift::mesh_gmsh_test {
namespace {

using namespace sample;

/// How a file is written.
struct Variant {
  int version;  // 2 or 4
  bool binary;
};
constexpr Variant variants[] = {{2, false}, {4, false}, {4, true}};

std::string name(const Variant& v) {
  return std::to_string(v.version) + (v.binary ? " binary" : " text");
}

/// Writes the sample with every type of cell, by the manual. Tags of nodes descend with gaps; nodes 1 and 2 of the file belong to no cell.
class Writer {
 public:
  explicit Writer(Variant variant, std::vector<Shape> cells = shapes()) : as_(variant), shapes_(std::move(cells)) {
    for (std::size_t i = 0; i < shapes_.size(); ++i) nodes_.push_back(gmsh_nodes(shapes_[i], i));
  }

  std::string file() {
    format();
    out_ += "$PhysicalNames\n3\n0 1 \"a point\"\n3 100 \"all volumes\"\n2 9 \"empty\"\n$EndPhysicalNames\n";
    out_ += "$Unknown\nany text\n$EndUnknown\n";
    if (as_.version == 4) entities();
    as_.version == 4 ? nodes_4() : nodes_2();
    out_ += "$Periodic\n0\n$EndPeriodic\n";
    as_.version == 4 ? elements_4() : elements_2();
    return out_;
  }

 private:
  template <class T>
  void raw(T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    out_.append(bytes, sizeof(T));
  }
  void put(double value) {
    char text[40];
    std::snprintf(text, sizeof(text), "%.17g ", value);
    as_.binary ? raw(value) : void(out_ += text);
  }
  void put(int value) { as_.binary ? raw<std::int32_t>(value) : void(out_ += std::to_string(value) + " "); }
  void size(std::size_t value) { as_.binary ? raw<std::uint64_t>(value) : void(out_ += std::to_string(value) + " "); }
  void line() {
    if (!as_.binary) out_ += "\n";
  }
  void begin(const char* section) { out_ += std::string("$") + section + "\n"; }
  void end(const char* section) { out_ += std::string("\n$End") + section + "\n"; }

  void format() {
    begin("MeshFormat");
    out_ += std::string(as_.version == 4 ? "4.1" : "2.2") + (as_.binary ? " 1 8\n" : " 0 8\n");
    if (as_.binary) raw<std::int32_t>(1);
    end("MeshFormat");
  }

  int tag(std::size_t shape, std::size_t node) const { return 100000 - static_cast<int>(100 * shape + 3 * node); }
  std::size_t count(std::size_t shape) const { return nodes_[shape].size(); }
  std::size_t all_nodes() const {
    return std::accumulate(nodes_.begin(), nodes_.end(), std::size_t{2}, [](std::size_t sum, const auto& own) { return sum + own.size(); });
  }
  int dimension(std::size_t shape) const { return info(shapes_[shape].cell).dimension; }
  /// Each volume is in a group of its own and in "all volumes", each line and surface in a group without a name.
  std::vector<int> physical(std::size_t shape) const {
    if (dimension(shape) == 0) return {1};
    if (dimension(shape) == 3) return {static_cast<int>(shape), 100};
    return {-static_cast<int>(shape)};  // the sign says that the orientation was reversed
  }

  void coordinates(const Vec3& x) {
    for (int k = 0; k < 3; ++k) put(x[k]);
  }

  void nodes_2() {
    begin("Nodes");
    out_ += std::to_string(all_nodes()) + "\n";
    for (const int unused : {1, 2}) put(unused), coordinates({-1, -1, -1}), line();
    for (std::size_t s = 0; s < shapes_.size(); ++s)
      for (std::size_t n = 0; n < count(s); ++n) put(tag(s, n)), coordinates(nodes_[s][n]), line();
    end("Nodes");
  }

  void elements_2() {
    begin("Elements");
    std::size_t all = 0;
    for (std::size_t s = 0; s < shapes_.size(); ++s) all += physical(s).size();
    out_ += std::to_string(all) + "\n";
    int number = 1;
    for (std::size_t s = 0; s < shapes_.size(); ++s)
      for (const int group : physical(s)) {
        put(number++), put(shapes_[s].gmsh), put(2), put(group), put(1);
        for (std::size_t n = 0; n < count(s); ++n) put(tag(s, n));
        line();
      }
    end("Elements");
  }

  void entities() {
    begin("Entities");
    for (int d = 0; d <= 3; ++d)
      size(static_cast<std::size_t>(
          std::count_if(shapes_.begin(), shapes_.end(), [&](const Shape& s) { return info(s.cell).dimension == d; })));
    line();
    for (int d = 0; d <= 3; ++d)
      for (std::size_t s = 0; s < shapes_.size(); ++s) {
        if (dimension(s) != d) continue;
        put(static_cast<int>(s) + 1);
        for (int k = 0; k < (d == 0 ? 3 : 6); ++k) put(0.5);
        size(physical(s).size());
        for (const int group : physical(s)) put(group);
        if (d > 0) size(2), put(1), put(-2);
        line();
      }
    end("Entities");
  }

  void nodes_4() {
    begin("Nodes");
    size(shapes_.size() + 1), size(all_nodes()), size(1), size(100000), line();
    put(0), put(77), put(0), size(2), line(), size(1), line(), size(2), line(), coordinates({-1, -1, -1}), coordinates({-1, -1, -1}),
        line();
    for (std::size_t s = 0; s < shapes_.size(); ++s) {
      put(dimension(s)), put(static_cast<int>(s) + 1), put(1), size(count(s)), line();
      for (std::size_t n = 0; n < count(s); ++n) size(static_cast<std::size_t>(tag(s, n))), line();
      for (std::size_t n = 0; n < count(s); ++n) {
        coordinates(nodes_[s][n]);
        for (int k = 0; k < dimension(s); ++k) put(0.125);
        line();
      }
    }
    end("Nodes");
  }

  void elements_4() {
    begin("Elements");
    size(shapes_.size()), size(shapes_.size()), size(1), size(shapes_.size()), line();
    for (std::size_t s = 0; s < shapes_.size(); ++s) {
      put(dimension(s)), put(static_cast<int>(s) + 1), put(shapes_[s].gmsh), size(1), line(), size(s + 1);
      for (std::size_t n = 0; n < count(s); ++n) size(static_cast<std::size_t>(tag(s, n)));
      line();
    }
    end("Elements");
  }

  Variant as_;
  std::vector<Shape> shapes_;
  std::vector<std::vector<Vec3>> nodes_;
  std::string out_;
};

TEST(Gmsh, ReadsEveryCellInEveryFormat) {
  for (const Variant& variant : variants) {
    SCOPED_TRACE(name(variant));
    const Mesh mesh = read_gmsh(Writer(variant).file(), "all.msh");
    EXPECT_EQ(mesh.dimension, 3);
    EXPECT_EQ(mesh.nodes.size(), 1u + 2 + 3 + 3 + 6 + 4 + 8 + 9 + 4 + 10 + 6 + 15 + 8 + 20 + 27);  // without the two that no cell uses
    const std::vector<Shape> all = shapes();
    for (std::size_t s = 0; s < all.size(); ++s) expect_in_order(mesh, all[s], s);
    check_mesh(mesh, {"all.msh", 0});
  }
}

TEST(Gmsh, GroupsComeFromPhysicalGroupsInEveryFormat) {
  for (const Variant& variant : variants) {
    SCOPED_TRACE(name(variant));
    const Mesh mesh = read_gmsh(Writer(variant).file(), "all.msh");
    ASSERT_EQ(mesh.groups.size(), 3u + 14);
    EXPECT_EQ(mesh.groups.at("a point").cells.size(), 1u);
    EXPECT_TRUE(mesh.groups.at("empty").cells.empty());
    EXPECT_EQ(mesh.groups.at("empty").dimension, 2);
    const Group& volumes = mesh.groups.at("all volumes");
    EXPECT_EQ(volumes.cells.size(), 7u);  // once each, though format 2 writes them twice
    EXPECT_TRUE(std::is_sorted(volumes.cells.begin(), volumes.cells.end()));
    for (std::size_t s = 1; s < shapes().size(); ++s) {
      const Cell cell = shapes()[s].cell;
      const int d = info(cell).dimension;
      const Group& group = mesh.groups.at("physical_" + std::to_string(d) + "_" + std::to_string(s));
      EXPECT_EQ(group.dimension, d);
      ASSERT_EQ(group.cells.size(), 1u);
      EXPECT_EQ(mesh.type(group.cells[0]), cell);
    }
  }
}

TEST(Gmsh, FilesOfGmshItself) {
  // Written by Gmsh 4.8: a rectangle 1 m x 2 m of two 9-node quadrilaterals, its bottom line, group 3 of two lines, a point.
  const std::string folder = support::source_folder() + "/fuzz/corpus/gmsh/";
  for (const char* file : {"plane_msh22_text.msh", "plane_msh41_text.msh", "plane_msh41_binary.msh"}) {
    SCOPED_TRACE(file);
    const Mesh mesh = read_gmsh(read_file(folder + file), file);
    check_mesh(mesh, {file, 0});
    EXPECT_EQ(mesh.dimension, 2);
    EXPECT_EQ(mesh.nodes.size(), 15u);
    ASSERT_EQ(mesh.groups.size(), 4u);
    const auto total = [&](const char* group) {
      double sum = 0;
      for (const CellId id : mesh.groups.at(group).cells) sum += signed_size(mesh, id);
      return sum;
    };
    EXPECT_NEAR(total("soil"), 2, 1e-12);
    EXPECT_NEAR(total("bottom"), 1, 1e-12);
    EXPECT_NEAR(total("physical_1_3"), 1 + 2, 1e-12);  // the bottom, which is in both groups, and a side
    EXPECT_EQ(nodes_of(mesh, mesh.groups.at("p")).size(), 1u);
  }
}

// ---- what is wrong ----

TEST(Gmsh, ACutFileIsAnError) {
  const std::vector<Shape> all = shapes();
  const std::vector<Shape> few{all[0], all[3], all[9]};
  for (const Variant& variant : variants) {
    const std::string bytes = Writer(variant, few).file();
    ASSERT_NO_THROW(read_gmsh(bytes, "cut.msh"));
    for (std::size_t n = 0; n + 1 < bytes.size(); ++n)
      ASSERT_THROW(read_gmsh(std::string_view(bytes).substr(0, n), "cut.msh"), InputError) << name(variant) << " cut at byte " << n;
  }
}

const std::string plane =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
    "$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n"
    "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n";
const std::string plane_2 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"
    "$Elements\n1\n1 2 2 0 1 1 2 3\n$EndElements\n";

std::string error_with(const std::string& text, const std::string& from, const std::string& to) {
  return error_of([&] { read_gmsh(support::replaced(text, from, to), "a.msh"); });
}

TEST(Gmsh, ErrorsHaveTheirLine) {
  ASSERT_NO_THROW(read_gmsh(plane, "a.msh"));
  ASSERT_NO_THROW(read_gmsh(plane_2, "a.msh"));
  EXPECT_EQ(error_with(plane, "1 0 0\n", "1 x 0\n"), "a.msh:11: $Nodes: expected a coordinate (a finite number), found \"x\"");
  EXPECT_EQ(error_with(plane, "1 0 0\n", "1 nan 0\n"), "a.msh:11: $Nodes: expected a coordinate (a finite number), found \"nan\"");
  EXPECT_EQ(error_with(plane, "1 0 0\n", "1 1e999 0\n"), "a.msh:11: $Nodes: expected a coordinate (a finite number), found \"1e999\"");
  EXPECT_EQ(error_with(plane, "1 1 2 3", "1 1 2 4"), "a.msh:17: $Elements: expected the tag of a node, found 4");
  EXPECT_EQ(error_with(plane, "1 1 2 3", "1 1 -2 3"), "a.msh:17: $Elements: expected a node tag (an integer, not negative), found \"-2\"");
  EXPECT_EQ(error_with(plane, "2 1 2 1\n", "2 1 7 1\n").substr(0, 53), "a.msh:16: $Elements: expected points, lines of 2 or 3");
  EXPECT_TRUE(error_with(plane, "2 1 2 1\n", "2 1 7 1\n").ends_with("found a 5-node pyramid (type 7)"));
  EXPECT_EQ(error_with(plane, "2 1 2 1\n", "1 1 2 1\n"), "a.msh:16: $Elements: expected elements of dimension 1, found tri3 (type 2)");
  EXPECT_EQ(error_with(plane, "1\n2\n3\n", "1\n2\n2\n").substr(0, 17), "a.msh:5: $Nodes: ");
  EXPECT_EQ(error_with(plane_2, "2 1 0 0", "-2 1 0 0"), "a.msh:7: $Nodes: expected a node tag (not negative), found -2");
  EXPECT_EQ(error_with(plane, "4.1 0 8", "4.0 0 8"),
            "a.msh:2: $MeshFormat: expected format 4.1 or 2.2 (Gmsh: Save As, or -format msh41), found version \"4.0\"");
  EXPECT_EQ(error_with(plane, "4.1 0 8", "4.1 0 4"), "a.msh:2: $MeshFormat: expected numbers of 8 bytes, found 4");
  const std::string elements_at = std::to_string(plane.find("$Elements"));
  EXPECT_EQ(error_with(plane, "$EndElements", "$EndElement"),
            "a.msh:14: byte " + elements_at + ": expected \"$EndElements\" after \"$Elements\", found the end of the file");
  EXPECT_EQ(error_with(plane, "$Nodes\n", "$Node\n").substr(0, 9), "a.msh:13:");
  EXPECT_EQ(error_with(plane, "$EndNodes\n", "$EndNodes\nnoise\n"),
            "a.msh:14: byte " + elements_at + ": expected the beginning of a section ($Name), found \"noise\"");
  EXPECT_EQ(error_with(plane, "1 1 2 3\n", "1 1 2 3 4\n"),
            "a.msh:17: $Elements: expected $EndElements after the last element, found \"4\"");
}

TEST(Gmsh, CountsThatTheFileCannotHoldAreRefusedBeforeMemoryIsTaken) {
  for (const char* count : {"1000000000000000000", "9223372036854775807", "18446744073709551616", "4294967299", "4"}) {
    const std::string many = count;
    EXPECT_NE(error_with(plane, "1 3 1 3", "1 " + many + " 1 3"), "no error") << many;
    EXPECT_NE(error_with(plane, "2 1 0 3", "2 1 0 " + many), "no error") << many;
    EXPECT_NE(error_with(plane, "1 1 1 1\n", "1 " + many + " 1 1\n"), "no error") << many;
    EXPECT_NE(error_with(plane, "1 1 1 1\n", many + " 1 1 1\n"), "no error") << many;
    EXPECT_NE(error_with(plane, "2 1 2 1\n", "2 1 2 " + many + "\n"), "no error") << many;
    EXPECT_NE(error_with(plane_2, "3\n1 0", many + "\n1 0"), "no error") << many;
    EXPECT_NE(error_with(plane_2, "1\n1 2", many + "\n1 2"), "no error") << many;
    EXPECT_NE(error_with(plane_2, "1 2 2 0 1", "1 2 " + many + " 0 1"), "no error") << many;
  }
}

TEST(Gmsh, SectionsMayComeInAnyOrderButOnce) {
  const std::string nodes = plane.substr(plane.find("$Nodes"), plane.find("$Elements") - plane.find("$Nodes"));
  const std::string elements = plane.substr(plane.find("$Elements")), head = plane.substr(0, plane.find("$Nodes"));
  EXPECT_EQ(read_gmsh(head + elements + nodes, "a.msh").cells(), 1);
  EXPECT_EQ(read_gmsh("$Comments\nwhatever\n$EndComments\n" + plane, "a.msh").cells(), 1);
  EXPECT_EQ(error_of([&] { read_gmsh(head + nodes + nodes + elements, "a.msh"); }),
            "a.msh:15: $Nodes: expected one section $Nodes, found a second one");
  EXPECT_EQ(error_of([&] { read_gmsh(head + elements, "a.msh"); }),
            "a.msh: expected a section $Nodes, found only $MeshFormat or $Elements");
  std::string windows;
  for (const char c : plane) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(read_gmsh(windows, "a.msh").nodes.size(), 3u);
}

TEST(Gmsh, PartitionedFilesHaveTheirGroupsInEntitiesOfTheirOwn) {
  const std::string entities = "$Entities\n0 0 1 0\n1 0 0 0 1 1 0 1 5 0\n$EndEntities\n";
  const std::string parts = "$PartitionedEntities\n2 1\n8 1\n0 0 1 0\n1 2 1 2 1 2 0 0 0 1 1 0 1 9 1 -4\n$EndPartitionedEntities\n";
  const std::string ghosts = "$GhostElements\n1\n1 1 1 2\n$EndGhostElements\n";
  const auto read = [&](const std::string& before) {
    return read_gmsh(support::replaced(plane, "$Nodes", before + "$Nodes") + ghosts, "a.msh");
  };
  EXPECT_EQ(read(entities).groups.at("physical_2_5").cells.size(), 1u);
  EXPECT_EQ(read(entities + parts).groups.at("physical_2_9").cells.size(), 1u);
}

TEST(Gmsh, AnEntityIsInAHundredGroupsAtMost) {
  const auto in_groups = [&](int count) {
    std::string entity = "$Entities\n0 0 1 0\n1 0 0 0 1 1 0 " + std::to_string(count);
    for (int tag = 1; tag <= count; ++tag) entity += " " + std::to_string(tag);
    return error_with(plane, "$Nodes", entity + " 0\n$EndEntities\n$Nodes");
  };
  EXPECT_EQ(in_groups(100), "no error");
  EXPECT_EQ(in_groups(101), "a.msh:6: $Entities: expected at most 100 physical groups for an entity, found 101");
}

TEST(Gmsh, ParametersOfNodesAreSkipped) {
  const std::string parametric =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
      "$ParametricNodes\n3\n1 0 0 0 0 1\n2 1 0 0 1 4 0.5\n3 0 1 0 2 7 0.5 0.25\n$EndParametricNodes\n"
      "$Elements\n1\n1 2 2 0 1 1 2 3\n$EndElements\n";
  EXPECT_EQ(read_gmsh(parametric, "a.msh").nodes, read_gmsh(plane_2, "a.msh").nodes);
  EXPECT_EQ(read_gmsh(support::replaced(support::replaced(plane, "2 1 0 3", "2 1 1 3"), "0 0 0\n1 0 0\n0 1 0\n",
                                        "0 0 0 7 8\n1 0 0 7 8\n0 1 0 7 8\n"),
                      "a.msh")
                .nodes,
            read_gmsh(plane, "a.msh").nodes);
}

TEST(Gmsh, TagsMayBeFarApart) {
  const Mesh mesh = read_gmsh(
      support::replaced(support::replaced(plane, "1\n2\n3\n", "900000000000000000\n2\n3\n"), "1 1 2 3\n", "1 900000000000000000 2 3\n"),
      "a.msh");
  EXPECT_EQ(mesh.nodes, read_gmsh(plane, "a.msh").nodes);
  EXPECT_EQ(mesh.blocks[0].nodes, (std::vector<int>{0, 1, 2}));
}

TEST(Gmsh, TextCalledBinaryAndBinaryCalledTextAreErrors) {
  EXPECT_NE(error_with(plane, "4.1 0 8", "4.1 1 8"), "no error");
  EXPECT_NE(error_with(plane_2, "2.2 0 8", "2.2 1 8"), "no error");
  for (const Variant& variant : variants) {
    if (!variant.binary) continue;
    const std::string bytes = support::replaced(Writer(variant).file(), " 1 8\n", " 0 8\n");
    EXPECT_THROW(read_gmsh(bytes, "a.msh"), InputError) << name(variant);
  }
}

TEST(Gmsh, BinaryFormat2AndTheOtherOrderOfBytesAreRefusedWithWhatToDo) {
  const std::string folder = support::source_folder() + "/fuzz/corpus/gmsh/";
  const std::string old = error_of([&] { read_gmsh(read_file(folder + "plane_msh22_binary.msh"), "a.msh"); });
  EXPECT_TRUE(old.starts_with("a.msh:2: ")) << old;
  EXPECT_NE(old.find("-format msh41"), std::string::npos) << old;
  std::string bytes = read_file(folder + "plane_msh41_binary.msh");
  const std::size_t one = bytes.find(" 1 8\n") + 5;
  std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(one), bytes.begin() + static_cast<std::ptrdiff_t>(one) + 4);
  const std::string other = error_of([&] { read_gmsh(bytes, "a.msh"); });
  EXPECT_NE(other.find("order of bytes"), std::string::npos) << other;
  EXPECT_NE(other.find("Save As text"), std::string::npos) << other;
}

TEST(Gmsh, NodesOfAClockwisePlaneCellAreMirrored) {
  const Mesh mesh = read_gmsh(support::replaced(plane, "1 1 2 3", "1 1 3 2"), "a.msh");
  EXPECT_EQ(mesh.dimension, 2);
  EXPECT_EQ(signed_size(mesh, {0, 0}), 0.5);
}

TEST(Gmsh, NamesThatAreUsedForSeveralDimensionsAreToldApart) {
  const std::string named =
      "$PhysicalNames\n2\n1 1 \"base\"\n2 1 \"b\xe9ton\"\n$EndPhysicalNames\n";  // Latin-1, as old Windows programs write
  const std::string lines = support::replaced(plane_2, "$Elements\n1\n1 2 2 0 1 1 2 3\n", "$Elements\n2\n1 2 2 1 1 1 2 3\n2 1 2 1 1 1 2\n");
  const Mesh mesh = read_gmsh(named + lines, "a.msh");
  EXPECT_EQ(mesh.groups.count("b\xc3\xa9ton"), 1u);
  const Mesh both = read_gmsh(support::replaced(named, "b\xe9ton", "base") + lines, "a.msh");
  ASSERT_EQ(both.groups.size(), 2u);
  EXPECT_EQ(both.groups.at("base_1d").dimension, 1);
  EXPECT_EQ(both.groups.at("base_2d").dimension, 2);
}

RC_GTEST_PROP(Gmsh, DamagedFilesAreReadOrRefused, ()) {
  const Variant variant = *rc::gen::elementOf(std::vector<Variant>(std::begin(variants), std::end(variants)));
  std::string bytes = Writer(variant).file();
  const int changes = *rc::gen::inRange(1, 6);
  for (int i = 0; i < changes; ++i) {
    const auto at = *rc::gen::inRange<std::size_t>(0, bytes.size());
    switch (*rc::gen::inRange(0, 4)) {
      case 0:
        bytes[at] = static_cast<char>(*rc::gen::inRange(0, 256));
        break;
      case 1:
        bytes[at] = *rc::gen::elementOf(std::string("0123456789-.e $\n"));
        break;
      case 2:
        bytes.erase(at, *rc::gen::inRange<std::size_t>(1, 40));
        break;
      default:
        bytes.insert(at, bytes.substr(*rc::gen::inRange<std::size_t>(0, bytes.size()), *rc::gen::inRange<std::size_t>(1, 40)));
    }
    if (bytes.empty()) return;
  }
  try {
    const Mesh mesh = read_gmsh(bytes, "damaged.msh");
    for (const CellBlock& block : mesh.blocks)
      for (const int node : block.nodes) RC_ASSERT(node >= 0 && static_cast<std::size_t>(node) < mesh.nodes.size());
  } catch (const InputError& error) {
    RC_ASSERT(std::string(error.what()).starts_with("damaged.msh"));
  }
}

}  // namespace
}  // namespace uplift::mesh_gmsh_test
