// What tells one program from another without reading its file.
#include "uplift/base/image.h"

#include <elf.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <vector>

#include "uplift/base/file.h"

namespace uplift::image_test {
namespace {

/// An image as it stands in memory: a segment with two notes, the second of which is the build id, and one with data.
struct Image {
  std::string notes, data = std::string(300, 'x');
  std::vector<ElfW(Phdr)> headers;

  static std::string note(std::uint32_t type, const std::string& name, const std::string& content) {
    const auto padded = [](std::string text) { return text += std::string((4 - text.size() % 4) % 4, '\0'); };
    const std::array<std::uint32_t, 3> head{static_cast<std::uint32_t>(name.size() + 1), static_cast<std::uint32_t>(content.size()), type};
    return std::string(reinterpret_cast<const char*>(head.data()), sizeof head) + padded(name + '\0') + padded(content);
  }
  explicit Image(const std::string& last_note) : notes(note(NT_GNU_ABI_TAG, "GNU", "abc") + last_note) {
    for (const auto& [type, bytes] : {std::pair{PT_NOTE, &notes}, {PT_LOAD, &notes}, {PT_LOAD, &data}}) {
      ElfW(Phdr) header{};
      header.p_type = static_cast<ElfW(Word)>(type);
      header.p_vaddr = reinterpret_cast<std::uintptr_t>(bytes->data());
      header.p_memsz = bytes->size();
      headers.push_back(header);
    }
  }
  Image(const Image&) = delete;
  std::string id() const { return build_id_of(0, headers); }
};

TEST(Image, HasTheBuildIdAndTheSizeOfItsSegments) {
  Image image(Image::note(NT_GNU_BUILD_ID, "GNU", std::string("\x01\xab\xff\x00\x10", 5)));
  EXPECT_EQ(image.id(), "build id 01abff0010, " + std::to_string(image.notes.size() + 300) + " bytes");
  image.headers[2].p_memsz = 200;
  EXPECT_EQ(image.id(), "build id 01abff0010, " + std::to_string(image.notes.size() + 200) + " bytes");
}

TEST(Image, WithoutABuildIdHasNone) {
  EXPECT_EQ(Image(Image::note(NT_GNU_BUILD_ID, "Go", "1234")).id(), "");
  EXPECT_EQ(Image(Image::note(NT_GNU_ABI_TAG, "GNU", "1234")).id(), "");
  const std::string whole = Image::note(NT_GNU_BUILD_ID, "GNU", "1234");
  for (std::size_t size = 0; size < whole.size(); ++size) EXPECT_EQ(Image(whole.substr(0, size)).id(), "") << size;
}

/// The build id in the file of this program, found through its sections instead of its segments; empty: none.
std::string id_in_the_file() {
  const std::string file = read_file("/proc/self/exe");
  ElfW(Ehdr) head;
  std::memcpy(&head, file.data(), sizeof head);
  for (int i = 0; i < head.e_shnum; ++i) {
    ElfW(Shdr) section;
    std::memcpy(&section, file.data() + head.e_shoff + i * sizeof section, sizeof section);
    const std::string_view content = std::string_view(file).substr(section.sh_offset, section.sh_type == SHT_NOTE ? section.sh_size : 0);
    if (content.size() != 36 || static_cast<unsigned char>(content[8]) != NT_GNU_BUILD_ID) continue;
    std::string id;
    for (const char byte : content.substr(16)) {
      constexpr const char* digits = "0123456789abcdef";
      id += digits[static_cast<unsigned char>(byte) / 16], id += digits[static_cast<unsigned char>(byte) % 16];
    }
    return id;
  }
  return "";
}

TEST(Image, OfThisProgramIsTheOneInItsFile) {
  EXPECT_FALSE(id_in_the_file().empty());  // the build asks the linker for one
  EXPECT_TRUE(identity_of_program().starts_with("build id " + id_in_the_file() + ", ")) << identity_of_program();
}

TEST(Image, LibrariesAreNamedWithTheirIds) {
  const std::string libraries = identity_of_libraries();
  EXPECT_NE(libraries.find("libm.so.6: build id "), std::string::npos) << libraries;
  EXPECT_EQ(libraries.find("vdso"), std::string::npos) << libraries;
  EXPECT_EQ(libraries.find(identity_of_program()), std::string::npos) << libraries;
}

}  // namespace
}  // namespace uplift::image_test
