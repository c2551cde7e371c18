#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "uplift/base/error.h"
#include "uplift/io/mesh/gmsh_source.h"

// Reading .msh files: sections, and numbers that are written as text or as bytes.
namespace uplift {

/// One section: $name, its content, $Endname.
struct GmshSection {
  std::string name;                  // without $
  std::uint64_t begin = 0, end = 0;  // of its content: from the line after the name to the $ of $End
};

/// Finds the sections of a file. Throws InputError with the line or byte when something stands outside of them or an end is missing.
std::vector<GmshSection> gmsh_sections(const GmshSource& source);

/// Reads the numbers of a section one after another. Every function throws InputError with the line (text) or the byte (binary) where a
/// number is missing, out of range or not what was wanted; `what` names it in the message ("a node tag").
class GmshCursor {
 public:
  GmshCursor(const GmshSource& source, const GmshSection& section, bool binary);

  /// An integer of 4 bytes when binary.
  int integer(const char* what) { return binary_ ? raw_integer(what) : static_cast<int>(text_integer(what, -2147483648LL, 2147483647LL)); }
  /// A count or a tag, not negative, of 8 bytes when binary.
  std::int64_t size(const char* what) { return binary_ ? raw_size(what) : text_integer(what, 0, INT64_MAX); }
  /// A finite number.
  double real(const char* what) { return binary_ ? raw_real(what) : text_real(what); }
  /// Number of items that follow. Each takes at least so many bytes as text or binary: more than the section could hold is refused, so that
  /// nobody makes room for items that are not there.
  std::int64_t count(const char* what, std::size_t text_bytes, std::size_t binary_bytes);
  /// The same check for a count that was read before.
  void check_count(std::int64_t items, const char* what, std::size_t text_bytes, std::size_t binary_bytes);
  /// A text in double quotes, which ends at the last quote of its line.
  std::string quoted(const char* what);
  /// A word up to white space.
  std::string word(const char* what);
  /// The rest of the line of text, with its end, when only blanks stand there.
  void end_line();
  /// Everything must have been read.
  void finish(const char* what);

  /// Bytes of the section that have not been read.
  std::uint64_t left() const { return end_ - offset(); }
  /// The next 4 bytes of text; advances.
  std::uint32_t raw_bytes(const char* what);
  /// InputError here.
  [[noreturn]] void fail(const std::string& wanted, const std::string& found) const;
  Where where() const;
  std::string path() const;
  const std::string& file() const { return source_->file(); }

 private:
  /// Where the next byte stands in the file.
  std::uint64_t offset() const { return behind_window_ - (window_.size() - at_); }
  std::string_view ahead() const { return std::string_view(window_).substr(at_); }
  /// Has so many bytes ahead in the window, or all that the section still has.
  void look_ahead(std::size_t bytes) {
    if (window_.size() - at_ < bytes && behind_window_ < end_) fill(bytes);
  }
  void fill(std::size_t bytes);
  /// The number of bytes ahead for which `wanted` does not hold; all of them are in the window then.
  template <class Wanted>
  std::size_t length_before(Wanted wanted);
  void skip_blanks();
  std::string next_text();
  /// Reads the number ahead without passing it. Returns the length of its text, up to the next blank; 0 when no number stands there.
  template <class Number>
  std::size_t read_number(Number& value);
  std::int64_t text_integer(const char* what, std::int64_t least, std::int64_t most);
  double text_real(const char* what);
  int raw_integer(const char* what);
  std::int64_t raw_size(const char* what);
  double raw_real(const char* what);
  template <class T>
  T raw(const char* what);

  const GmshSource* source_;
  std::string name_, window_;  // a piece of the section
  std::size_t at_ = 0;         // in the window
  std::uint64_t behind_window_, end_;
  bool binary_;
};

}  // namespace uplift
