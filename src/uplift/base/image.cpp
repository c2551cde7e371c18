#include "uplift/base/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <string_view>
#include <vector>

#include "uplift/base/file.h"

// Notes and segments: System V ABI, chapter 5 ("Program Loading and Dynamic Linking"), and elf.h.
namespace uplift {
namespace {

std::string_view bytes_of(std::uintptr_t begin, const ElfW(Phdr) & segment) {
  return {reinterpret_cast<const char*>(begin + segment.p_vaddr), segment.p_memsz};
}

/// The build id in a segment of notes, in hexadecimal digits; empty: none.
std::string build_id_in(std::string_view notes) {
  const auto padded = [](std::size_t size) { return (size + 3) / 4 * 4; };
  ElfW(Nhdr) note;
  while (notes.size() >= sizeof note) {
    std::memcpy(&note, notes.data(), sizeof note);
    notes.remove_prefix(sizeof note);
    const std::size_t before = padded(note.n_namesz), size = before + padded(note.n_descsz);
    if (notes.size() < size) break;
    if (note.n_type == NT_GNU_BUILD_ID && notes.starts_with(std::string_view(ELF_NOTE_GNU, sizeof ELF_NOTE_GNU))) {
      std::string id;
      for (const char byte : notes.substr(before, note.n_descsz)) id += fmt::format("{:02x}", static_cast<unsigned char>(byte));
      return id;
    }
    notes.remove_prefix(size);
  }
  return "";
}

using Visit = std::function<void(const dl_phdr_info&)>;

void visit_images(const Visit& visit) {
  ::dl_iterate_phdr(
      [](dl_phdr_info* image, std::size_t, void* data) {
        (*static_cast<const Visit*>(data))(*image);
        return 0;
      },
      const_cast<Visit*>(&visit));
}

std::span<const ElfW(Phdr)> headers_of(const dl_phdr_info& image) {
  return {image.dlpi_phdr, image.dlpi_phnum};
}

bool is_own(const dl_phdr_info& image) {
  const auto here = reinterpret_cast<std::uintptr_t>(&identity_of_program);
  return std::ranges::any_of(headers_of(image), [&](const ElfW(Phdr) & segment) {
    return segment.p_type == PT_LOAD && here - (image.dlpi_addr + segment.p_vaddr) < segment.p_memsz;
  });
}

}  // namespace

std::string build_id_of(std::uintptr_t begin, std::span<const ElfW(Phdr)> headers) {
  std::string id;
  std::size_t size = 0;
  for (const ElfW(Phdr) & segment : headers) {
    if (segment.p_type == PT_LOAD) size += segment.p_memsz;
    if (segment.p_type == PT_NOTE && id.empty()) id = build_id_in(bytes_of(begin, segment));
  }
  return id.empty() ? "" : fmt::format("build id {}, {} bytes", id, size);
}

std::string identity_of_program() {
  std::string found, file;
  visit_images([&](const dl_phdr_info& image) {
    if (is_own(image)) found = build_id_of(image.dlpi_addr, headers_of(image)), file = image.dlpi_name;
  });
  return found.empty() ? "SHA-256 " + sha256(read_file(file.empty() ? "/proc/self/exe" : file)) : found;
}

std::string identity_of_libraries() {
  std::vector<std::string> lines;
  visit_images([&](const dl_phdr_info& image) {
    const std::string_view path(image.dlpi_name), name = path.substr(path.rfind('/') + 1);
    const bool of_kernel = name.starts_with("linux-");  // its own few functions: linux-vdso.so.1
    if (!is_own(image) && !name.empty() && !of_kernel)
      lines.push_back(fmt::format("{}: {}\n", name, build_id_of(image.dlpi_addr, headers_of(image))));
  });
  std::ranges::sort(lines);
  std::string all;
  for (const std::string& line : lines) all += line;
  return all;
}

}  // namespace uplift
