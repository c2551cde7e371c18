#include <gtest/gtest.h>

#include <cmath>

#include "unit/io/med_file_support.h"

#ifdef __SANITIZE_ADDRESS__
// HDF5 asks for what a damaged file says and takes a refusal well; some memory it loses when such a file does not close.
extern "C" const char* __asan_default_options() {
  return "allocator_may_return_null=1";
}
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libhdf5\nleak:H5\n";  // as a shared library, and linked in
}
#endif

namespace uplift::mesh_med_test {
namespace {

using namespace sample;

TEST(Med, ReadsEveryCellAndItsGroups) {
  const SampleFile file;
  const Mesh mesh = read_image(file);
  EXPECT_EQ(mesh.dimension, 3);
  EXPECT_EQ(mesh.nodes, file.points);
  const std::vector<Shape> all = shapes();
  for (std::size_t s = 0; s < all.size(); ++s) expect_in_order(mesh, all[s], s);
  check_mesh(mesh, {"a.med", 0});
  ASSERT_EQ(mesh.groups.size(), all.size() + 2);
  for (const Shape& shape : all) {
    const Group& group = mesh.groups.at("cells of " + std::string(shape.med));
    ASSERT_EQ(group.cells.size(), 1u);
    EXPECT_EQ(mesh.type(group.cells[0]), shape.cell);
  }
  EXPECT_EQ(mesh.groups.at("all volumes").cells.size(), 7u);
  const Group& odd = mesh.groups.at("odd nodes");
  EXPECT_TRUE(odd.cells.empty());
  ASSERT_EQ(odd.nodes.size(), file.points.size() / 2);
  for (std::size_t i = 0; i < odd.nodes.size(); ++i) EXPECT_EQ(odd.nodes[i], static_cast<int>(2 * i + 1));
}

TEST(Med, CellsNumberedAsInVtkAreTurned) {
  // As some converters write volumes: the corners are not mirrored.
  std::vector<Shape> all = shapes();
  for (Shape& shape : all) shape.med_corners = counted(shape.corners.size());
  const Mesh mesh = read_image(SampleFile(all));
  check_mesh(mesh, {"a.med", 0});
  for (std::size_t s = 0; s < all.size(); ++s) expect_in_order(mesh, all[s], s);
}

TEST(Med, PlaneMeshesAndLooseNodes) {
  RawFile file;
  file.group("/INFOS_GENERALES");
  file.attribute("/INFOS_GENERALES", "MAJ", 3);
  file.group(step);
  file.attribute("/ENS_MAA/soil", "ESP", 2);
  file.numbers(step + "/NOE/COO", {0, 1, 9, 0, 8, 0, 0, 9, 1, 8});  // five nodes; the third and fifth belong to no cell
  file.integers(step + "/MAI/TR3/NOD", {1, 4, 2});                  // clockwise
  file.integers(step + "/NOE/FAM", {0, 0, 0, 0, 3});
  file.group("/FAS/soil/NOEUD/master");
  file.attribute("/FAS/soil/NOEUD/master", "NUM", 3);
  file.names("/FAS/soil/NOEUD/master/GRO/NOM", {"tour \xe9lanc\xe9"
                                                "e"});
  const Mesh mesh = read_image(file);
  EXPECT_EQ(mesh.dimension, 2);
  ASSERT_EQ(mesh.nodes.size(), 4u);  // the fifth is in a group
  EXPECT_EQ(mesh.nodes[3], Vec3(8, 8, 0));
  EXPECT_EQ(mesh.groups
                .at("tour \xc3\xa9lanc\xc3\xa9"
                    "e")
                .nodes,
            std::vector<int>{3});
  EXPECT_EQ(signed_size(mesh, {0, 0}), 0.5);
}

TEST(Med, SeveralMeshesNeedAName) {
  SampleFile file;
  file.group("/ENS_MAA/raft");
  EXPECT_EQ(error_of([&] { read_image(file); }),
            "a.med: /ENS_MAA: expected one mesh, or the name of the one to take, found \"raft\" or \"soil\"");
  EXPECT_EQ(read_image(file, "soil").cells(), num_cell_types);
  EXPECT_EQ(error_of([&] { read_image(file, "soli"); }),
            "a.med: /ENS_MAA: expected one of the meshes \"raft\" or \"soil\", found \"soli\" (did you mean \"soil\"?)");
}

// ---- what is wrong ----

std::string error_after(const std::function<void(SampleFile&)>& change) {
  SampleFile file;
  change(file);
  return error_of([&] { read_image(file); });
}
std::string error_with_data(const std::string& path, hid_t type, const std::vector<hsize_t>& lengths, hid_t storage = H5P_DEFAULT) {
  return error_after([&](SampleFile& file) {
    file.remove(path);
    file.data(path, type, type, nullptr, lengths, storage);
  });
}

TEST(Med, ErrorsNameTheObject) {
  const std::string mesh = "a.med: /ENS_MAA/soil", nod = step + "/MAI/TE4/NOD", at = "a.med: " + nod + ": ";
  const auto nodes = [&](const std::vector<int>& values) {
    return error_after([&](SampleFile& file) { file.remove(nod), file.integers(nod, values); });
  };
  EXPECT_EQ(nodes({1, 2, 3, 0}), at + "expected nodes from 1 to 126, found 0 in cell 1");
  EXPECT_EQ(nodes({1, 2, 3, 127}), at + "expected nodes from 1 to 126, found 127 in cell 1");
  EXPECT_EQ(nodes({1, 2, 3, -2147483647}), at + "expected nodes from 1 to 126, found -2147483647 in cell 1");
  EXPECT_EQ(nodes({1, 2, 3}), at + "expected 4 nodes for each cell, found 3 numbers");
  EXPECT_EQ(error_after([&](SampleFile& file) { file.attribute(nod, "NBR", 5); }), at + "expected 5 items (attribute \"NBR\"), found 1");
  EXPECT_EQ(error_after([&](SampleFile& file) { file.remove(nod); }), at + "expected this group or data set, found nothing of this name");
  EXPECT_EQ(error_after([&](SampleFile& file) { file.attribute("/ENS_MAA/soil", "ESP", 4); }),
            mesh + ": expected 1, 2 or 3 coordinates (attribute \"ESP\"), found 4");
  EXPECT_EQ(error_after([&](SampleFile& file) { file.attribute("/ENS_MAA/soil", "TYP", 1); }),
            mesh + ": expected an unstructured mesh (attribute \"TYP\" 0), found a grid");
  EXPECT_EQ(error_after([&](SampleFile& file) { file.attribute("/INFOS_GENERALES", "MAJ", 2); }),
            "a.med: /INFOS_GENERALES: expected MED format 3 or later, found 2");
  EXPECT_TRUE(error_after([&](SampleFile& file) {
                file.integers(step + "/MAI/PY5/NOD", {1, 2, 3, 4, 5});
              }).ends_with("found a 5-node pyramid (\"PY5\")"));
  EXPECT_TRUE(error_after([&](SampleFile& file) {
                file.remove("/FAS/soil/ELEME/FAM_8");
              }).ends_with("expected a family of /FAS/soil, found family -9"));
  EXPECT_EQ(error_after([&](SampleFile& file) {
              std::vector<double> x(378, 1.0);
              x[127] = NAN;
              file.remove(step + "/NOE/COO"), file.numbers(step + "/NOE/COO", x);
            }),
            "a.med: " + step + "/NOE/COO: expected finite coordinates, found nan at node 2");
  EXPECT_TRUE(error_after([&](SampleFile& file) {
                file.group("/ENS_MAA/soil/-0000000000000000002-0000000000000000001"), file.remove(step);
              }).starts_with("a.med: /ENS_MAA/soil/"));
}

TEST(Med, TypesAndLengthsThatDoNotFitAreRefused) {
  const std::string x = step + "/NOE/COO", nod = step + "/MAI/TE4/NOD", names = "/FAS/soil/ELEME/FAM_3/GRO/NOM";
  EXPECT_EQ(error_with_data(x, H5T_C_S1, {378}),
            "a.med: " + x + ": expected 378 bytes of data, found 0 bytes in a file of " + std::to_string(SampleFile().image().size()));
  EXPECT_NE(error_with_data(nod, H5T_IEEE_F64LE, {4}), "no error");
  EXPECT_NE(error_with_data(nod, H5T_STD_I64LE, {}), "no error");
  EXPECT_NE(error_with_data(nod, H5T_STD_I64LE, {0}), error_with_data(nod, H5T_STD_I64LE, {4}));  // no cells is not wrong here
  EXPECT_NE(error_with_data(names, H5T_STD_I32LE, {3}), "no error");
  EXPECT_NE(error_after([&](SampleFile& file) { file.remove(x), file.group(x); }), "no error");
  EXPECT_NE(error_after([&](SampleFile& file) { file.remove(step + "/MAI"), file.integers(step + "/MAI", {1}); }), "no error");
}

TEST(Med, ClaimsThatTheFileCannotHoldAreRefusedBeforeMemoryIsTaken) {
  const std::string x = step + "/NOE/COO";
  constexpr hsize_t huge = hsize_t{1} << 50;
  EXPECT_TRUE(error_with_data(x, H5T_IEEE_F64LE, {3 * huge}).starts_with("a.med: " + x + ": expected 27021597764222976 bytes of data"));
  const hid_t storage = H5Pcreate(H5P_DATASET_CREATE);
  const hsize_t chunk = hsize_t{1} << 28;
  H5Pset_chunk(storage, 1, &chunk);
  H5Pset_deflate(storage, 9);
  EXPECT_TRUE(error_with_data(x, H5T_IEEE_F64LE, {huge}, storage)
                  .starts_with("a.med: " + x + ": expected chunks that the file can hold, found 2147483648 bytes"));
  H5Pclose(storage);
}

TEST(Med, AFamilyIsInAHundredGroupsAtMost) {
  const auto in_groups = [&](std::size_t count) {
    return error_after([&](SampleFile& file) {
      const std::string names = "/FAS/soil/ELEME/FAM_3/GRO/NOM";
      std::vector<std::string> groups;
      for (std::size_t i = 0; i < count; ++i) groups.push_back("group " + std::to_string(i));
      file.remove(names), file.names(names, groups);
    });
  };
  EXPECT_EQ(in_groups(100), "no error");
  EXPECT_EQ(in_groups(101), "a.med: /FAS/soil/ELEME/FAM_3/GRO/NOM: expected at most 100 groups for a family, found 101");
}

TEST(Med, CompressedDataAreRead) {
  SampleFile file;
  const hid_t storage = H5Pcreate(H5P_DATASET_CREATE);
  const hsize_t chunk = 2;
  H5Pset_chunk(storage, 1, &chunk);
  H5Pset_shuffle(storage);
  H5Pset_deflate(storage, 9);
  const Mesh before = read_image(file);
  const CellBlock& block = before.blocks[static_cast<std::size_t>(before.find_block(Cell::quad4))];
  const std::vector<int> nodes{block.nodes[0] + 1, block.nodes[1] + 1, block.nodes[2] + 1, block.nodes[3] + 1};
  file.remove(step + "/MAI/QU4/NOD");
  file.data(step + "/MAI/QU4/NOD", H5T_STD_I32BE, H5T_NATIVE_INT, nodes.data(), {4}, storage);
  H5Pclose(storage);
  const Mesh after = read_image(file);
  EXPECT_EQ(after.blocks[static_cast<std::size_t>(after.find_block(Cell::quad4))].nodes, block.nodes);
}

TEST(Med, DataOfOtherFilesAreNotTouched) {
  const std::string x = step + "/NOE/COO";
  const hid_t storage = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_external(storage, "/etc/hostname", 0, 3024);
  EXPECT_EQ(error_with_data(x, H5T_IEEE_F64LE, {378}, storage), "a.med: " + x + ": expected data in this file, found data in another one");
  H5Pclose(storage);
  const auto link = [&](bool external) {
    return error_after([&](SampleFile& file) {
      file.remove(x);
      if (external)
        H5Lcreate_external("other.med", "/x", file.file, x.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      else
        H5Lcreate_soft("/INFOS_GENERALES", file.file, x.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    });
  };
  EXPECT_EQ(link(true), "a.med: " + x + ": expected an object of this file, found a link");
  EXPECT_EQ(link(false), "a.med: " + x + ": expected an object of this file, found a link");
}

TEST(Med, ACutFileIsAnError) {
  const std::vector<Shape> all = shapes();
  const std::string bytes = SampleFile({all[0], all[3]}).image();
  for (std::size_t n = 0; n < bytes.size(); ++n)
    ASSERT_THROW(read_med(Hdf5Reader::from_memory(std::string_view(bytes).substr(0, n), "cut.med")), InputError) << n;
}

}  // namespace
}  // namespace uplift::mesh_med_test
