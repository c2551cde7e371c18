#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <random>

#include "unit/io/med_file_support.h"
#include "uplift/io/hdf5/child.h"
#include "uplift/io/mesh/file.h"
#include "uplift/io/mesh/med_message.h"

namespace uplift::mesh_med_apart_test {
namespace {

using namespace sample;
namespace fs = std::filesystem;

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
}  // namespace uplift::mesh_med_apart_test
