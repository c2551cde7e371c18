#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <limits>

#include "unit/io/fields_support.h"
#include "uplift/io/fields/fields.h"

// XDMF files, and what both formats share: numbers that are refused, sizes, folders.
namespace uplift::fields_xdmf_test {
namespace {

using namespace fields_support;

/// The data of an XDMF file while a test runs.
class DataFile {
 public:
  explicit DataFile(const std::string& name)
      : path_((std::filesystem::temp_directory_path() / ("uplift_" + name + "_" + std::to_string(::getpid()) + ".h5")).string()) {}
  ~DataFile() { std::filesystem::remove(path_); }
  Hdf5Writer writer() const { return Hdf5Writer::create(path_); }
  Hdf5Reader reader() const { return Hdf5Reader::open(path_); }
  std::int64_t bytes() const { return static_cast<std::int64_t>(std::filesystem::file_size(path_)); }

 private:
  std::string path_;
};

// ---- XDMF ----

TEST(Xdmf, EveryNumberComesBackAndTheDescriptionFits) {
  const Mesh mesh = two_boxes(Cell::wedge15, Cell::hex27);
  const std::vector<FieldMesh> blocks{both(mesh), field_mesh(mesh, "all of/it", {"right"}, here),
                                      field_mesh(mesh, "<\"&>\x01", {"right"}, here)};
  for (const FieldPrecision precision : {FieldPrecision::float32, FieldPrecision::float64}) {
    Files files;
    const DataFile file_of_data("every_number");
    XdmfWriter writer("out/fields", blocks, precision, file_of_data.writer());
    for (int k = 0; k < 3; ++k) EXPECT_FALSE(writer.write(frame_of(blocks, k)));
    writer.finish(into(files));
    ASSERT_EQ(files.size(), 1u);
    const Hdf5Reader data = file_of_data.reader();
    EXPECT_EQ(data.children("/frames").size(), 3u);
    EXPECT_EQ(data.children("/mesh"), (std::vector<std::string>{"_____", "all_of_it", "all_of_it_2"}));

    const XmlElement file = XmlParser::parse(files.at("out/fields.xdmf"));
    const XmlElement& frames = file.at("Domain").at("Grid");
    EXPECT_EQ(frames.attributes.at("CollectionType"), "Temporal");
    ASSERT_EQ(frames.children.size(), 3u);
    std::vector<const XmlElement*> items;
    file.all("DataItem", items);
    for (const XmlElement* item : items) {  // what the description says of a data set is what it is
      ASSERT_EQ(item->text.substr(0, 12), "./fields.h5:");
      std::string lengths;
      for (const std::int64_t length : data.shape(item->text.substr(12))) lengths += (lengths.empty() ? "" : " ") + std::to_string(length);
      EXPECT_EQ(item->attributes.at("Dimensions"), lengths) << item->text;
    }
    for (int k = 0; k < 3; ++k) {
      const XmlElement& frame = frames.children[static_cast<std::size_t>(k)];
      EXPECT_EQ(std::stod(frame.at("Time").attributes.at("Value")), 0.1 * k);
      std::size_t first = 0;
      for (const std::string type : {"wedge15", "hex27"}) {
        const XmlElement& grid = frame.at("Grid", "all of it " + type);
        const auto read = [&](const std::string& attribute) {
          return data.numbers(grid.at("Attribute", attribute).at("DataItem").text.substr(12));
        };
        const auto count = std::stoul(grid.at("Topology").attributes.at("NumberOfElements"));
        EXPECT_EQ(grid.at("Topology").attributes.at("TopologyType"), type == "hex27" ? "Hexahedron_27" : "Wedge_15");
        EXPECT_EQ(read("displacement [m]"), unique_values(FieldKind::vector, blocks[0].points.size(), k));
        const auto all = unique_values(FieldKind::tensor, blocks[0].cell.size(), k);
        const auto begin = all.begin() + static_cast<std::ptrdiff_t>(6 * first);
        EXPECT_EQ(read("stress"), std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(6 * count)));
        const auto& groups = blocks[0].marks[0].values;
        EXPECT_EQ(read("group"), std::vector<double>(groups.begin() + static_cast<std::ptrdiff_t>(first),
                                                     groups.begin() + static_cast<std::ptrdiff_t>(first + count)));
        first += count;
      }
      EXPECT_EQ(first, blocks[0].cell.size());
    }
  }
}

TEST(Xdmf, MeshIsThatOfTheVtuFiles) {
  const std::vector<FieldMesh> blocks{both(two_boxes(Cell::wedge6, Cell::hex8))};
  Files files;
  VtuWriter vtu("f", blocks, FieldPrecision::float64, into(files));
  const DataFile file_of_data("mesh");
  XdmfWriter xdmf("f", blocks, FieldPrecision::float64, file_of_data.writer());
  ASSERT_FALSE(vtu.write(frame_of(blocks, 0)));
  ASSERT_FALSE(xdmf.write(frame_of(blocks, 0)));
  xdmf.finish(into(files));
  const Hdf5Reader data = file_of_data.reader();
  const XmlElement file = XmlParser::parse(files.at("f/all_of_it_000000.vtu"));
  std::vector<int> nodes = data.integers("/mesh/all_of_it/wedge6/nodes");
  const std::vector<int> bricks = data.integers("/mesh/all_of_it/hex8/nodes");
  nodes.insert(nodes.end(), bricks.begin(), bricks.end());
  EXPECT_EQ(numbers_of<int>(piece_of(file).at("Cells").at("DataArray", "connectivity")), nodes);
  EXPECT_EQ(numbers_of<double>(piece_of(file).at("Points").at("DataArray")), data.numbers("/mesh/all_of_it/points"));
}

// ---- numbers that must not reach a file ----

TEST(Fields, NothingIsWrittenOfAFrameWithANumberThatIsNotFinite) {
  const Mesh mesh = two_boxes(Cell::hex8, Cell::tet4);
  const std::vector<FieldMesh> blocks{both(mesh)};
  Files files, description;
  VtuWriter vtu("f", blocks, FieldPrecision::float32, into(files));
  const DataFile file_of_data("not_finite");
  XdmfWriter xdmf("f", blocks, FieldPrecision::float32, file_of_data.writer());
  const auto expect_trouble = [&](const FieldFrame& frame, const std::vector<std::string>& parts) {
    const auto one = vtu.write(frame), other = xdmf.write(frame);
    ASSERT_TRUE(one && other);
    EXPECT_EQ(one->reason, other->reason);
    for (const std::string& part : parts) EXPECT_NE(one->reason.find(part), std::string::npos) << one->reason;
    EXPECT_TRUE(files.empty());
  };
  constexpr double inf = std::numeric_limits<double>::infinity();
  FieldFrame bad = frame_of(blocks, 0);
  bad.blocks[0].points[0].values[3 * 13 + 1] = std::numeric_limits<double>::quiet_NaN();
  expect_trouble(bad, {"displacement [m]", "all of it", "nan", "node 14 (0.5, 0.5, 0.5)"});
  EXPECT_TRUE(find_trouble(blocks, bad, FieldPrecision::float64));
  bad = frame_of(blocks, 0);
  bad.blocks[0].cells[0].values[6 * 7 + 5] = -inf;
  expect_trouble(bad, {"stress", "-inf", "hex8 8 (0.75, 0.75, 0.75)"});
  EXPECT_TRUE(find_trouble(blocks, bad, FieldPrecision::float64));
  bad = frame_of(blocks, 0);
  bad.blocks[0].cells[2].values.back() = 1e39;
  expect_trouble(bad, {"status", "1e+39", "tet4", "32 bits"});
  bad = frame_of(blocks, 0);
  bad.time = inf;
  expect_trouble(bad, {"time"});

  bad = frame_of(blocks, 0);
  bad.blocks[0].cells[2].values.back() = 1e39;
  EXPECT_FALSE(find_trouble(blocks, bad, FieldPrecision::float64));
  ASSERT_FALSE(vtu.write(frame_of(blocks, 1)));  // and the next good frame is number 0
  ASSERT_FALSE(xdmf.write(frame_of(blocks, 1)));
  xdmf.finish(into(description));
  EXPECT_TRUE(files.contains("f/all_of_it_000000.vtu"));
  EXPECT_EQ(file_of_data.reader().children("/frames"), std::vector<std::string>{"000000"});
}

// ---- files ----

std::int64_t bytes_of(const Files& files) {
  std::int64_t sum = 0;
  for (const auto& [name, bytes] : files) sum += static_cast<std::int64_t>(bytes.size());
  return sum;
}

TEST(Fields, SizesAreForeseen) {
  const auto lines = uniform_lines(0, 1, 12);
  const Mesh mesh = box(lines, lines, lines);
  const std::vector<FieldMesh> blocks{field_mesh(mesh, "soil", {"volume"}, here), field_mesh(mesh, "sides", {"left", "top"}, here)};
  for (const FieldPrecision precision : {FieldPrecision::float32, FieldPrecision::float64}) {
    FieldFrame shape = frame_of(blocks, 0);
    for (BlockFields& fields : shape.blocks)
      for (auto* list : {&fields.points, &fields.cells})
        for (FieldValues& field : *list) field.values.clear();
    constexpr int frames = 20;
    Files vtu, xdmf;
    VtuWriter vtu_writer("fields", blocks, precision, into(vtu));
    const DataFile file_of_data("sizes");
    XdmfWriter xdmf_writer("fields", blocks, precision, file_of_data.writer());
    for (int k = 0; k < frames; ++k) {
      ASSERT_FALSE(vtu_writer.write(frame_of(blocks, k)));
      ASSERT_FALSE(xdmf_writer.write(frame_of(blocks, k)));
    }
    vtu_writer.finish();
    xdmf_writer.finish(into(xdmf));
    const FieldSize of_vtu = size_per_frame(FieldFormat::vtu, blocks, shape, precision);
    const FieldSize of_xdmf = size_per_frame(FieldFormat::xdmf, blocks, shape, precision);
    const std::int64_t foreseen_vtu = of_vtu.once + frames * of_vtu.per_frame, foreseen_xdmf = of_xdmf.once + frames * of_xdmf.per_frame;
    EXPECT_NEAR(static_cast<double>(bytes_of(vtu)), static_cast<double>(foreseen_vtu), 2 * 20 * frames);  // digits of times, per block
    EXPECT_NEAR(static_cast<double>(file_of_data.bytes() + bytes_of(xdmf)), static_cast<double>(foreseen_xdmf),
                0.01 * static_cast<double>(foreseen_xdmf));
  }
}

TEST(Fields, AppearInAFolderWholeOrNotAtAll) {
  const auto place = std::filesystem::temp_directory_path() / ("uplift_fields_" + std::to_string(::getpid()));
  std::filesystem::create_directories(place);
  const std::vector<FieldMesh> blocks{both(two_boxes(Cell::hex8, Cell::tet4))};
  const auto write = [&](bool to_the_end) {
    ResultFolder folder((place / "results").string());
    VtuWriter vtu("fields", blocks, FieldPrecision::float32, into(folder));
    XdmfWriter xdmf("fields", blocks, FieldPrecision::float32, Hdf5Writer::create(folder.place("fields.h5")));
    EXPECT_FALSE(vtu.write(frame_of(blocks, 0)) || xdmf.write(frame_of(blocks, 0)));
    if (!to_the_end) return;
    vtu.finish();
    xdmf.finish(into(folder));
    folder.finish();
  };
  write(false);
  EXPECT_FALSE(std::filesystem::exists(place / "results"));
  write(true);
  for (const char* file : {"fields.pvd", "fields.xdmf", "fields.h5", "fields/all_of_it_000000.vtu"})
    EXPECT_TRUE(std::filesystem::exists(place / "results" / file)) << file;
  EXPECT_EQ(Hdf5Reader::open((place / "results/fields.h5").string()).children("/frames").size(), 1u);
  std::filesystem::remove_all(place);
}

TEST(Fields, DescriptionNamesTheDataFileBesideIt) {
  const auto place = std::filesystem::temp_directory_path() / ("uplift_fields_disk_" + std::to_string(::getpid()));
  std::filesystem::create_directories(place);
  const std::string path = (place / "fields.h5").string();
  const std::vector<FieldMesh> blocks{both(two_boxes(Cell::hex8, Cell::tet4))};
  Files files;
  XdmfWriter writer((place / "fields").string(), blocks, FieldPrecision::float64, Hdf5Writer::create(path));
  ASSERT_FALSE(writer.write(frame_of(blocks, 4)));
  writer.finish(into(files));
  ASSERT_EQ(files.size(), 1u);
  EXPECT_NE(files.begin()->second.find(">./fields.h5:/frames/000000/all_of_it/points/displacement<"), std::string::npos);
  EXPECT_EQ(Hdf5Reader::open(path).numbers("/frames/000000/all_of_it/points/displacement"),
            unique_values(FieldKind::vector, blocks[0].points.size(), 4));
  std::filesystem::remove_all(place);
}

}  // namespace
}  // namespace uplift::fields_xdmf_test
