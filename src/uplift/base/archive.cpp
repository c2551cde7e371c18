#include "uplift/base/archive.h"

#include <zlib.h>

namespace uplift {
namespace {

constexpr std::size_t head_size = 2 * sizeof(std::size_t);  // size and checksum of the content

std::size_t checksum(std::string_view bytes) {
  return crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
}

}  // namespace

std::string sealed(std::string_view kind, std::string_view content) {
  ArchiveWriter head;
  head(content.size(), checksum(content));
  return std::string(kind) + head.bytes() + std::string(content);
}

std::optional<std::string_view> unsealed(std::string_view kind, std::string_view bytes, std::string& why) {
  const std::string what(kind.substr(0, kind.find('\n')));
  why = "it does not begin with \"" + what + "\"";
  if (!bytes.starts_with(kind)) return {};
  bytes.remove_prefix(kind.size());
  why = "it is cut off";
  if (bytes.size() < head_size) return {};
  std::size_t size = 0, sum = 0;
  ArchiveReader(bytes.substr(0, head_size))(size, sum);
  bytes.remove_prefix(head_size);
  if (bytes.size() < size) return {};
  why = "it is damaged";
  if (bytes.size() > size || checksum(bytes) != sum) return {};
  why.clear();
  return bytes;
}

}  // namespace uplift
