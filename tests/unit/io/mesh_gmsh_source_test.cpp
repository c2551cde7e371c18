#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "data_support.h"
#include "text_support.h"
#include "uplift/base/file.h"
#include "uplift/io/mesh/file.h"
#include "uplift/io/mesh/gmsh.h"

// A .msh file is read in pieces: their size must not matter.
namespace uplift::gmsh_source_test {
namespace {

namespace fs = std::filesystem;
const std::string folder = support::source_folder() + "/fuzz/corpus/gmsh/";

/// A mesh as text, or the error.
std::string outcome(const GmshSource& source) {
  try {
    const Mesh mesh = read_gmsh(source);
    std::string text;
    for (const Vec3& x : mesh.nodes)
      for (int k = 0; k < 3; ++k) text += std::to_string(x[k]) + " ";
    for (const CellBlock& block : mesh.blocks) {
      for (const int node : block.nodes) text += std::to_string(node) + " ";
      for (const std::int64_t number : block.file_number) text += std::to_string(number) + " ";
    }
    for (const auto& [name, group] : mesh.groups) text += name + " " + std::to_string(group.cells.size()) + " ";
    return text;
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(GmshSource, PiecesOfAnySizeGiveTheSameMeshAndTheSameErrors) {
  int files = 0, meshes = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string bytes = read_file(entry.path());
    for (const std::size_t length : {bytes.size(), bytes.size() / 2, bytes.size() - bytes.size() / 3}) {
      const std::string_view part = std::string_view(bytes).substr(0, length);
      const std::string expected = outcome(GmshSource::of_bytes(part, "a.msh", part.size() + 1));
      for (const std::size_t piece : {1, 7, 100, 4096})
        EXPECT_EQ(outcome(GmshSource::of_bytes(part, "a.msh", piece)), expected) << entry.path() << ", pieces of " << piece;
      meshes += !expected.starts_with("a.msh");
    }
    ++files;
  }
  EXPECT_GE(files, 3);
  EXPECT_GE(meshes, 3);
}

TEST(GmshSource, ANameAndANumberAcrossPieces) {
  const std::string name(3000, 'x'), zeros(2000, '0');  // the coordinate is 1 followed by 2000 zeros behind the point
  const std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"" + name +
                           "\"\n$EndPhysicalNames\n"
                           "$Nodes\n3\n1 0 0 0\n2 1." +
                           zeros + " 0 0\n3 0 1 0\n$EndNodes\n$Elements\n1\n1 2 2 1 1 1 2 3\n$EndElements\n";
  for (const std::size_t piece : {1, 10, 1000, 100000}) {
    const std::string long_tag = std::string(2000, '7') + " ";
    EXPECT_EQ(outcome(GmshSource::of_bytes(support::replaced(text, "1 0 0 0", long_tag + "0 0 0"), "a.msh", piece)),
              outcome(GmshSource::of_bytes(support::replaced(text, "1 0 0 0", long_tag + "0 0 0"), "a.msh", 1000000)));
    const Mesh mesh = read_gmsh(GmshSource::of_bytes(text, "a.msh", piece));
    EXPECT_EQ(mesh.nodes[1], Vec3(1, 0, 0));
    EXPECT_TRUE(mesh.groups.contains(name));
  }
}

TEST(GmshSource, LinesAndPlacesAreThoseOfTheFile) {
  const std::string text = "first\nsecond\n\nfourth $Mark";
  for (const std::size_t piece : {1, 4, 100}) {
    const GmshSource source = GmshSource::of_bytes(text, "a", piece);
    EXPECT_EQ(source.find("$Mark", 0), text.find("$Mark"));
    EXPECT_EQ(source.find("$Mask", 0), text.size());
    EXPECT_EQ(source.find("first", 1), text.size());
    EXPECT_EQ(source.after_blanks(12), 14u);
    EXPECT_EQ(source.line_at(0), 1);
    EXPECT_EQ(source.line_at(6), 2);
    EXPECT_EQ(source.line_at(text.size()), 4);
    EXPECT_EQ(source.line_from(6, 100), "second");
    EXPECT_EQ(source.line_from(6, 3), "sec");
  }
}

TEST(GmshSource, AFileThatBecomesShorterIsAnError) {
  const fs::path path = fs::temp_directory_path() / ("uplift_source_" + std::to_string(::getpid()) + ".msh");
  std::ofstream(path) << std::string(100, ' ');
  const GmshSource source = GmshSource::of_file(path.string());
  fs::resize_file(path, 10);
  EXPECT_THROW(source.line_at(50), InputError);
  fs::remove(path);
  EXPECT_THROW(GmshSource::of_file(path.string()), InputError);
}

}  // namespace
}  // namespace uplift::gmsh_source_test
