#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <random>

#include "unit/io/mesh_file_support.h"
#include "uplift/base/file.h"
#include "uplift/io/hdf5/child.h"
#include "uplift/io/hdf5/library.h"
#include "uplift/io/mesh/file.h"
#include "uplift/io/mesh/med.h"
#include "uplift/io/mesh/med_file.h"
#include "uplift/io/mesh/med_message.h"

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
namespace fs = std::filesystem;

const std::string step = "/ENS_MAA/soil/-0000000000000000001-0000000000000000001";

/// An HDF5 file, made by the C library alone.
class RawFile {
 public:
  RawFile()
      : path_(fs::temp_directory_path() /
              ("uplift-raw-" + std::to_string(::getpid()) + "-" + std::to_string(reinterpret_cast<std::uintptr_t>(this)) + ".med")) {
    const Hdf5Call call;
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);  // as MED does
    H5Pset_file_locking(access, false, true);
    file = H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
    H5Pclose(access);
    parents = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(parents, 1);
  }
  ~RawFile() {
    H5Pclose(parents);
    H5Fclose(file);
    fs::remove(path_);
  }
  RawFile(const RawFile&) = delete;
  RawFile& operator=(const RawFile&) = delete;

  void group(const std::string& path) { H5Gclose(H5Gcreate2(file, path.c_str(), parents, H5P_DEFAULT, H5P_DEFAULT)); }
  void attribute(const std::string& path, const char* name, int value) {
    const hid_t space = H5Screate(H5S_SCALAR), object = H5Oopen(file, path.c_str(), H5P_DEFAULT);
    if (H5Aexists(object, name) > 0) H5Adelete(object, name);
    const hid_t made = H5Acreate2(object, name, H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(made, H5T_NATIVE_INT, &value);
    H5Aclose(made);
    H5Oclose(object);
    H5Sclose(space);
  }
  /// `values` null: nothing is written.
  void data(const std::string& path, hid_t file_type, hid_t memory_type, const void* values, std::vector<hsize_t> lengths,
            hid_t storage = H5P_DEFAULT) {
    const hid_t space = H5Screate_simple(static_cast<int>(lengths.size()), lengths.data(), nullptr);
    const hid_t made = H5Dcreate2(file, path.c_str(), file_type, space, parents, storage, H5P_DEFAULT);
    if (values) H5Dwrite(made, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    H5Dclose(made);
    H5Sclose(space);
  }
  void integers(const std::string& path, const std::vector<int>& values, hid_t type = H5T_STD_I64LE) {
    data(path, type, H5T_NATIVE_INT, values.data(), {values.size()});
  }
  void numbers(const std::string& path, const std::vector<double>& values) {
    data(path, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values.data(), {values.size()});
  }
  /// Names of groups as MED 3 and 4 write them: arrays of 80 bytes.
  void names(const std::string& path, const std::vector<std::string>& names) {
    const hsize_t length = 80;
    const hid_t type = H5Tarray_create2(H5T_STD_I8LE, 1, &length);
    std::string all(80 * names.size(), '\0');
    for (std::size_t i = 0; i < names.size(); ++i) all.replace(80 * i, names[i].size(), names[i]);
    data(path, type, type, all.data(), {names.size()});
    H5Tclose(type);
  }
  void remove(const std::string& path) { H5Ldelete(file, path.c_str(), H5P_DEFAULT); }

  std::string image() const {
    H5Fflush(file, H5F_SCOPE_GLOBAL);
    return read_file(path_);
  }

  hid_t file = -1, parents = -1;

 private:
  fs::path path_;
};

/// Every type of cell; family -1 - s for type s, in the groups "cells of TYPE" and, for volumes, "all volumes"; nodes of odd number,
/// counted from 0, in a group.
class SampleFile : public RawFile {
 public:
  explicit SampleFile(const std::vector<Shape>& all = shapes()) {
    group("/INFOS_GENERALES");
    attribute("/INFOS_GENERALES", "MAJ", 4);
    group(step);
    attribute("/ENS_MAA/soil", "ESP", 3);
    attribute("/ENS_MAA/soil", "TYP", 0);
    int first = 1;
    for (std::size_t s = 0; s < all.size(); ++s) {
      const std::vector<Vec3> own = med_nodes(all[s], s);
      std::vector<int> nodes;
      for (std::size_t n = 0; n < own.size(); ++n) nodes.push_back(first + static_cast<int>(n));
      first += static_cast<int>(own.size());
      points.insert(points.end(), own.begin(), own.end());
      const std::string type = step + "/MAI/" + all[s].med, family = "/FAS/soil/ELEME/FAM_" + std::to_string(s);
      integers(type + "/NOD", nodes);
      attribute(type + "/NOD", "NBR", 1);
      integers(type + "/FAM", {-1 - static_cast<int>(s)}, H5T_STD_I32LE);
      group(family);
      attribute(family, "NUM", -1 - static_cast<int>(s));
      names(family + "/GRO/NOM", info(all[s].cell).dimension == 3
                                     ? std::vector<std::string>{"cells of " + std::string(all[s].med), "all volumes"}
                                     : std::vector<std::string>{"cells of " + std::string(all[s].med)});
    }
    std::vector<double> x;
    std::vector<int> families;
    for (int k = 0; k < 3; ++k)
      for (const Vec3& point : points) x.push_back(point[k]);
    for (std::size_t i = 0; i < points.size(); ++i) families.push_back(i % 2 ? 1 : 0);
    numbers(step + "/NOE/COO", x);
    integers(step + "/NOE/FAM", families);
    group("/FAS/soil/NOEUD/FAM_1");
    attribute("/FAS/soil/NOEUD/FAM_1", "NUM", 1);
    names("/FAS/soil/NOEUD/FAM_1/GRO/NOM", {"odd nodes"});
    group("/FAS/soil/FAMILLE_ZERO");
    attribute("/FAS/soil/FAMILLE_ZERO", "NUM", 0);
  }
  std::vector<Vec3> points;
};

Mesh read_image(const RawFile& file, const std::string& mesh = {}) {
  return read_med(Hdf5Reader::from_memory(file.image(), "a.med"), mesh);
}

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

// ---- apart from this process ----

/// The mesh is returned; what it refers to must be there.
void expect_whole(const Mesh& mesh) {
  for (const CellBlock& block : mesh.blocks)
    for (const int node : block.nodes) ASSERT_TRUE(node >= 0 && static_cast<std::size_t>(node) < mesh.nodes.size());
  for (const auto& [name, group] : mesh.groups)
    for (const CellId cell : group.cells)
      ASSERT_TRUE(cell.index >= 0 && cell.index < mesh.blocks.at(static_cast<std::size_t>(cell.block)).count());
}

/// Damages to a file: read, or refused with the file's name, and this process lives.
void expect_read_or_refused(const std::string& bytes, int& refused) {
  try {
    expect_whole(read_med_bytes(bytes, "damaged.med"));
  } catch (const InputError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("damaged.med")) << error.what();
    ++refused;
  }
}

TEST(MedApart, DamagedFilesAreReadOrRefused) {
  const std::string whole = SampleFile().image();
  std::mt19937 random(20261122);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  int refused = 0;
  for (int i = 0; i < 200; ++i) {
    std::string bytes = whole;
    for (std::size_t changes = 1 + below(6); changes > 0; --changes) bytes[below(bytes.size())] = static_cast<char>(random());
    expect_read_or_refused(bytes, refused);
  }
  EXPECT_GT(refused, 10);
  EXPECT_LT(refused, 200);
  refused = 0;
  for (int i = 0; i < 100; ++i) {
    std::string bytes = whole;
    bytes[below(bytes.size())] ^= static_cast<char>(1 << below(8));
    expect_read_or_refused(bytes, refused);
  }
  refused = 0;
  for (int i = 0; i < 50; ++i) expect_read_or_refused(whole.substr(0, below(whole.size())), refused);
  EXPECT_EQ(refused, 50);
}

TEST(MedApart, TheMeshAndTheErrorsAreThoseOfTheReader) {
  SampleFile file;
  const Mesh own = read_image(file), apart = read_med_bytes(file.image(), "a.med");
  EXPECT_EQ(apart.dimension, own.dimension);
  EXPECT_EQ(apart.nodes, own.nodes);
  ASSERT_EQ(apart.blocks.size(), own.blocks.size());
  for (std::size_t b = 0; b < own.blocks.size(); ++b) {
    EXPECT_EQ(apart.blocks[b].cell, own.blocks[b].cell);
    EXPECT_EQ(apart.blocks[b].nodes, own.blocks[b].nodes);
  }
  ASSERT_EQ(apart.groups.size(), own.groups.size());
  for (const auto& [name, group] : own.groups) {
    const Group& other = apart.groups.at(name);
    EXPECT_EQ(other.dimension, group.dimension);
    EXPECT_EQ(other.cells, group.cells);
    EXPECT_EQ(other.nodes, group.nodes);
  }
  const auto both_errors = [&](const std::string& mesh, const std::string& name) {
    const std::string bytes = file.image();
    const std::string here = error_of([&] { read_med(Hdf5Reader::from_memory(bytes, name), mesh); });
    EXPECT_EQ(error_of([&] { read_med_bytes(bytes, name, mesh); }), here);
    EXPECT_NE(here, "no error");
  };
  both_errors("soli", "a.med");  // with a nearest name
  both_errors("x", "it is wanted here, found there.med");
  file.attribute("/ENS_MAA/soil", "ESP", 4);
  both_errors("", "a.med");
  EXPECT_EQ(error_of([&] { read_med_bytes("no HDF5", "b.med"); }).substr(0, 31), "b.med: expected an HDF5 file, f");
}

TEST(MedApart, AMessageThatIsNotWholeIsADamagedFile) {
  const std::string message = message_of(read_image(SampleFile()));
  const std::string wanted = "a.med: expected a sound MED file, found a damaged one: the HDF5 library failed while reading it";
  expect_whole(mesh_of_message(message, {"a.med", 0}));
  for (std::size_t n = 0; n < message.size(); n += 1 + n / 300)
    ASSERT_EQ(error_of([&] { mesh_of_message(std::string_view(message).substr(0, n), {"a.med", 0}); }), wanted) << n;
  std::mt19937 random(7);
  for (int i = 0; i < 20000; ++i) {
    std::string bytes = message;
    bytes[random() % bytes.size()] = static_cast<char>(random());
    try {
      expect_whole(mesh_of_message(bytes, {"a.med", 0}));
    } catch (const InputError& error) {
      ASSERT_EQ(error.what(), wanted);
    }
  }
}

TEST(Hdf5Child, BringsTheAnswer) {
  std::string large(50'000'000, 'x');
  for (std::size_t i = 0; i < large.size(); i += 977) large[i] = static_cast<char>(i);
  const ChildAnswer answer = answer_of_child([&] { return large; }, {1'000'000'000, 30});
  EXPECT_EQ(answer.failure, "");
  EXPECT_TRUE(answer.bytes == large);
  EXPECT_EQ(answer_of_child([] { return std::string(); }, {1'000'000'000, 30}).failure, "");
}

TEST(Hdf5Child, WhateverHappensHappensToTheChildAlone) {
  const auto failure = [](const std::function<std::string()>& work, int seconds = 60) {
    const ChildAnswer answer = answer_of_child(work, {300'000'000, seconds});
    EXPECT_TRUE(answer.bytes.empty());
    return answer.failure;
  };
  int touched = 0;
  EXPECT_EQ(failure([&]() -> std::string { return ++touched, std::raise(SIGSEGV), "never"; }), "a crash (Segmentation fault)");
  EXPECT_EQ(failure([&]() -> std::string { return ++touched, std::abort(), "never"; }), "a crash (Aborted)");
  EXPECT_EQ(failure(
                [&]() -> std::string {
                  while (::getppid() != 0) touched = 1;
                  return "never";
                },
                1),
            "no end after 1 s of computing");
  EXPECT_EQ(failure([]() -> std::string { throw std::runtime_error("lost"); }), "a crash");
  EXPECT_EQ(failure([]() -> std::string { return std::string(301'000'000 / 2, 'x') + std::string(301'000'000 / 2, 'y'); }).substr(0, 2),
            "a ");
#ifndef __SANITIZE_ADDRESS__  // which ends a process that asks for too much
  EXPECT_EQ(failure([]() -> std::string { return std::string(2'000'000'000, 'x'); }), "a need for more than 300 MB of memory");
#endif
  EXPECT_EQ(touched, 0);
}

// ---- files on the disk ----

class MeshFileTest : public testing::Test {
 protected:
  MeshFileTest() : folder(fs::temp_directory_path() / ("uplift-mesh-" + std::to_string(::getpid()))) { fs::create_directories(folder); }
  ~MeshFileTest() override { fs::remove_all(folder); }
  std::string error_of_reading(const std::string& name) const {
    return error_of([&] { read_mesh((folder / name).string(), {"case.toml", 7}); });
  }
  fs::path folder;
};

TEST_F(MeshFileTest, TheContentDecidesWhatAFileIs) {
  const std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2\n1 0 0 0\n2 1 0 0\n$EndNodes\n$Elements\n1\n1 1 2 0 1 1 2\n$EndElements\n";
  write_file_atomically(folder / "a.med", text);
  write_file_atomically(folder / "b.msh", SampleFile().image());
  EXPECT_EQ(read_mesh((folder / "a.med").string(), {}).cells(), 1);
  EXPECT_EQ(read_mesh((folder / "b.msh").string(), {}).cells(), num_cell_types);
  EXPECT_EQ(read_mesh((folder / "b.msh").string(), {}, "soil").cells(), num_cell_types);
}

TEST_F(MeshFileTest, MissingAndOtherFilesAreReportedWhereTheyAreNamed) {
  write_file_atomically(folder / "soil.msh", "solid ascii\n");
  write_file_atomically(folder / "empty.msh", "");
  const std::string start = "case.toml:7: expected a mesh file (Gmsh .msh or MED), found ", path = (folder / "soil.msh").string();
  EXPECT_EQ(error_of_reading("soil.mhs").substr(0, start.size()), start);
  EXPECT_TRUE(error_of_reading("soil.mhs").ends_with("soil.msh\"?)"));
  EXPECT_EQ(error_of_reading("soil.msh").substr(0, start.size()), start);
  EXPECT_EQ(error_of_reading("empty.msh").substr(0, start.size()), start);
  EXPECT_EQ(error_of_reading("").substr(0, start.size()), start);  // the folder itself
}

TEST_F(MeshFileTest, WhatHdf5WriterWritesIsReadBack) {
  const std::vector<double> numbers{1.5, -2, 1e-300, 4, 5, 6};
  const std::vector<float> singles{0.5f, -3};
  const std::vector<int> integers{1, -7, INT32_MAX};
  const auto fill = [&](Hdf5Writer& writer) {
    writer.group("/mesh");
    writer.attribute("/mesh", "cells", 12);
    writer.attribute("/mesh", "time", 0.25);
    writer.attribute("/mesh", "unit", "m");
    writer.numbers("/steps/1/u", std::span<const double>(numbers), std::vector<std::int64_t>{2, 3});
    writer.numbers("/steps/1/s", std::span<const float>(singles), std::vector<std::int64_t>{2});
    writer.integers("/steps/1/i", integers, std::vector<std::int64_t>{3, 1});
    writer.integers("/steps/2/nothing", {}, std::vector<std::int64_t>{0});
  };
  const auto check = [&](const Hdf5Reader& reader) {
    EXPECT_EQ(reader.integer_attribute("/mesh", "cells"), 12);
    EXPECT_EQ(reader.integer_attribute("/mesh", "none"), std::nullopt);
    EXPECT_THROW(reader.integer_attribute("/mesh", "time"), InputError);
    EXPECT_EQ(reader.numbers("/steps/1/u"), numbers);
    EXPECT_EQ(reader.shape("/steps/1/u"), (std::vector<std::int64_t>{2, 3}));
    EXPECT_EQ(reader.numbers("/steps/1/s"), (std::vector<double>{0.5, -3}));
    EXPECT_EQ(reader.integers("/steps/1/i"), integers);
    EXPECT_TRUE(reader.integers("/steps/2/nothing").empty());
    EXPECT_EQ(reader.children("/steps"), (std::vector<std::string>{"1", "2"}));
    EXPECT_FALSE(reader.has("/steps/3/u"));
  };
  {
    Hdf5Writer writer = Hdf5Writer::create((folder / "a.h5").string());
    fill(writer);
  }
  check(Hdf5Reader::open((folder / "a.h5").string()));
  Hdf5Writer writer = Hdf5Writer::in_memory();
  fill(writer);
  check(Hdf5Reader::from_memory(writer.image(), "memory.h5"));
  EXPECT_THROW(Hdf5Writer::create((folder / "none" / "a.h5").string()), InputError);
}

}  // namespace
}  // namespace uplift::mesh_med_test
