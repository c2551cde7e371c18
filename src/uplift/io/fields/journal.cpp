#include "uplift/io/fields/journal.h"

#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>

namespace uplift {

namespace {
constexpr std::string_view frame_kind = "uplift frame 1\n";
}  // namespace

FrameJournal::FrameJournal(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "wbe")), failed_(file_ == nullptr) {}

void FrameJournal::append(const FieldFrame& frame) {
  if (failed_) return;
  ArchiveWriter content, size;
  content(frame);
  const std::string bytes = sealed(frame_kind, content.bytes());
  size(bytes.size());
  for (const std::string& each : {size.bytes(), bytes}) {
    failed_ = failed_ || std::fwrite(each.data(), 1, each.size(), file_.get()) != each.size();
    bytes_ += each.size();
  }
}

std::uint64_t FrameJournal::sync() {
  if (failed_ || std::fflush(file_.get()) != 0 || ::fdatasync(::fileno(file_.get())) != 0) {
    failed_ = true;
    throw std::filesystem::filesystem_error("frames of the fields", path_, std::error_code(errno, std::generic_category()));
  }
  return bytes_;
}

bool read_journal(const std::string& path, std::uint64_t bytes, const std::function<void(const FieldFrame&)>& take, std::string& why) {
  std::ifstream file(path, std::ios::binary);
  why = "the frames of its fields are cut off";
  while (bytes > 0) {
    std::size_t size = 0;
    if (bytes < sizeof size || !file.read(reinterpret_cast<char*>(&size), sizeof size)) return false;
    bytes -= sizeof size;
    if (bytes < size) return false;
    std::string record(size, '\0');
    if (!file.read(record.data(), static_cast<std::streamsize>(size))) return false;
    bytes -= size;
    const std::optional<std::string_view> content = unsealed(frame_kind, record, why);
    if (!content) return false;
    FieldFrame frame;
    ArchiveReader reader(*content);
    reader(frame);
    if (reader.failed() || !reader.at_end()) return false;
    take(frame);
  }
  return true;
}

}  // namespace uplift
