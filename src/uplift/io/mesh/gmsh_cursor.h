#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "uplift/base/error.h"

// Reading .msh files from one buffer in memory: sections, and numbers that are written as text or as bytes.
namespace uplift {

/// One section: $name, its content, $Endname.
struct GmshSection {
  std::string_view name;     // without $
  std::string_view content;  // from the line after the name to the $ of $End
};

/// Cuts a file into its sections. Throws InputError with the line or byte when something stands outside of them or an end is missing.
std::vector<GmshSection> gmsh_sections(std::string_view bytes, const std::string& file);

/// Reads the numbers of a section one after another. Every function throws InputError with the line (text) or the byte (binary) where a
/// number is missing, out of range or not what was wanted; `what` names it in the message ("a node tag").
class GmshCursor {
 public:
  /// `section` is part of `bytes`, the whole file.
  GmshCursor(std::string_view bytes, const GmshSection& section, const std::string& file, bool binary);

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
  std::string_view quoted(const char* what);
  /// A word up to white space.
  std::string_view word(const char* what);
  /// The rest of the line of text, with its end, when only blanks stand there.
  void end_line();
  /// Everything must have been read.
  void finish(const char* what);

  std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }
  /// The next 4 bytes of text; advances.
  std::uint32_t raw_bytes(const char* what);
  /// InputError here.
  [[noreturn]] void fail(const std::string& wanted, const std::string& found) const;
  Where where() const;
  std::string path() const;

 private:
  void skip_blanks();
  std::string next_text() const;
  std::int64_t text_integer(const char* what, std::int64_t least, std::int64_t most);
  double text_real(const char* what);
  int raw_integer(const char* what);
  std::int64_t raw_size(const char* what);
  double raw_real(const char* what);
  template <class T>
  T raw(const char* what);

  const char *begin_, *at_, *end_;
  std::string name_;
  const std::string& file_;
  bool binary_;
};

}  // namespace uplift
