#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace uplift {

/// The bytes of a .msh file, which are read in pieces: a file of any size takes the memory of one piece.
class GmshSource {
 public:
  static constexpr std::size_t usual_piece = 1 << 18;

  /// A file on the disk. Throws InputError when it cannot be read, or later when it has become shorter.
  static GmshSource of_file(const std::string& path);
  /// Bytes that stay where they are as long as the source exists; `file` stands for them in messages.
  static GmshSource of_bytes(std::string_view bytes, const std::string& file, std::size_t piece = usual_piece);

  const std::string& file() const { return file_; }
  std::uint64_t size() const { return size_; }
  /// Number of bytes that a reader takes at a time.
  std::size_t piece() const { return piece_; }
  /// Appends up to `count` bytes from `begin` on, as far as `end`.
  void append(std::string& to, std::uint64_t begin, std::size_t count, std::uint64_t end) const;
  /// The line from here on without its end, or its first `most` bytes.
  std::string line_from(std::uint64_t at, std::size_t most) const;
  /// Where the text stands for the first time, from here on; size() when it does not.
  std::uint64_t find(std::string_view text, std::uint64_t from) const;
  /// The first byte from here on that is not white space; size() when there is none.
  std::uint64_t after_blanks(std::uint64_t at) const;
  /// The line in which a byte stands, counted from 1.
  int line_at(std::uint64_t at) const;

 private:
  using Read = std::function<void(std::uint64_t at, std::span<char> to)>;
  GmshSource(std::string file, std::uint64_t size, std::size_t piece, Read read)
      : file_(std::move(file)), size_(size), piece_(piece), read_(std::move(read)) {}

  std::string file_;
  std::uint64_t size_;
  std::size_t piece_;
  Read read_;
};

/// White space between the numbers of a .msh file.
inline bool gmsh_blank(char c) {
  return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

}  // namespace uplift
