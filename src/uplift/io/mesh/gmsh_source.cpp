#include "uplift/io/mesh/gmsh_source.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <system_error>
#include <utility>

#include "uplift/base/error.h"
#include "uplift/base/text.h"

namespace uplift {

GmshSource GmshSource::of_file(const std::string& path) {
  const auto refuse = [path](const std::string& wanted, const std::string& found) { throw InputError({path, 0}, "", wanted, found); };
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(path, error);
  const auto in = std::make_shared<std::ifstream>(path, std::ios::binary);
  if (error || !*in) refuse("a file that can be read", escaped(path));
  return {path, size, usual_piece, [in, refuse](std::uint64_t at, std::span<char> to) {
            if (!in->seekg(static_cast<std::streamoff>(at)) || !in->read(to.data(), static_cast<std::streamsize>(to.size())))
              refuse("a file that can be read to its end", "no byte " + std::to_string(at + to.size()) + " any more");
          }};
}

GmshSource GmshSource::of_bytes(std::string_view bytes, const std::string& file, std::size_t piece) {
  return {file, bytes.size(), piece, [bytes](std::uint64_t at, std::span<char> to) { bytes.copy(to.data(), to.size(), at); }};
}

void GmshSource::append(std::string& to, std::uint64_t begin, std::size_t count, std::uint64_t end) const {
  const std::size_t before = to.size(), more = begin < end ? std::min<std::uint64_t>(count, end - begin) : 0;
  to.resize(before + more);
  if (more > 0) read_(begin, {to.data() + before, more});
}

std::string GmshSource::line_from(std::uint64_t at, std::size_t most) const {
  std::string line;
  append(line, at, most, size_);
  return line.substr(0, line.find('\n'));
}

std::uint64_t GmshSource::find(std::string_view text, std::uint64_t from) const {
  std::string piece;
  for (std::uint64_t at = from; at < size_; at += piece_) {
    piece.clear();
    append(piece, at, piece_ + text.size() - 1, size_);  // pieces overlap, so that none divides the text
    if (const std::size_t found = piece.find(text); found != piece.npos) return at + found;
  }
  return size_;
}

std::uint64_t GmshSource::after_blanks(std::uint64_t at) const {
  std::string piece;
  for (; at < size_; at += piece.size()) {
    piece.clear();
    append(piece, at, piece_, size_);
    const auto other = std::ranges::find_if_not(piece, gmsh_blank);
    if (other != piece.end()) return at + static_cast<std::uint64_t>(other - piece.begin());
  }
  return size_;
}

int GmshSource::line_at(std::uint64_t at) const {
  std::ptrdiff_t ends = 0;
  std::string piece;
  for (std::uint64_t from = 0; from < at; from += piece.size()) {
    piece.clear();
    append(piece, from, piece_, at);
    ends += std::ranges::count(piece, '\n');
  }
  return 1 + static_cast<int>(ends);
}

}  // namespace uplift
