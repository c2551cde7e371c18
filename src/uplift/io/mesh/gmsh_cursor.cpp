#include "uplift/io/mesh/gmsh_cursor.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "uplift/base/text.h"

namespace uplift {
namespace {

constexpr std::size_t longest_name = 80;  // of a section; a limit keeps the search for its end fast

bool blank(char c) {
  return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

int line_at(std::string_view bytes, std::size_t offset) {
  return 1 + static_cast<int>(std::count(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(offset), '\n'));
}

[[noreturn]] void refuse(std::string_view bytes, std::size_t at, const std::string& file, const std::string& wanted,
                         const std::string& found) {
  throw InputError({file, line_at(bytes, at)}, "byte " + std::to_string(at), wanted, found);
}

std::string_view line_from(std::string_view bytes, std::size_t at) {
  return bytes.substr(at, bytes.find('\n', at) - at);
}

}  // namespace

std::vector<GmshSection> gmsh_sections(std::string_view bytes, const std::string& file) {
  std::vector<GmshSection> sections;
  for (std::size_t at = 0;;) {
    while (at < bytes.size() && blank(bytes[at])) ++at;
    if (at == bytes.size()) return sections;
    const std::string_view line = line_from(bytes, at), name = trim(line);
    if (name.size() < 2 || name.size() > longest_name || name[0] != '$' || name.starts_with("$End"))
      refuse(bytes, at, file, "the beginning of a section ($Name)", in_quotes(name));
    const std::string end = "$End" + std::string(name.substr(1));
    const std::size_t begin = std::min(at + line.size() + 1, bytes.size()), closing = bytes.find(end, begin);
    if (closing == bytes.npos) refuse(bytes, at, file, in_quotes(end) + " after " + in_quotes(name), "the end of the file");
    const std::string_view rest = line_from(bytes, closing);
    if (trim(rest) != end) refuse(bytes, closing, file, in_quotes(end), in_quotes(trim(rest)));
    sections.push_back({name.substr(1), bytes.substr(begin, closing - begin)});
    at = closing + rest.size();
  }
}

GmshCursor::GmshCursor(std::string_view bytes, const GmshSection& section, const std::string& file, bool binary)
    : begin_(bytes.data()),
      at_(section.content.data()),
      end_(section.content.data() + section.content.size()),
      name_("$" + std::string(section.name)),
      file_(file),
      binary_(binary) {}

Where GmshCursor::where() const {
  if (binary_) return {file_, 0};
  return {file_, line_at({begin_, static_cast<std::size_t>(end_ - begin_)}, static_cast<std::size_t>(at_ - begin_))};
}

std::string GmshCursor::path() const {
  return binary_ ? name_ + ", byte " + std::to_string(at_ - begin_) : name_;
}

void GmshCursor::fail(const std::string& wanted, const std::string& found) const {
  throw InputError(where(), path(), wanted, found);
}

std::string GmshCursor::next_text() const {
  if (at_ == end_) return "the end of the section";
  if (binary_) return std::to_string(left()) + " bytes before the end of the section";
  return in_quotes({at_, static_cast<std::size_t>(std::find_if(at_, end_, blank) - at_)});
}

void GmshCursor::skip_blanks() {
  while (at_ != end_ && blank(*at_)) ++at_;
}

std::int64_t GmshCursor::text_integer(const char* what, std::int64_t least, std::int64_t most) {
  skip_blanks();
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(at_, end_, value);
  if (error != std::errc{} || (end != end_ && !blank(*end)) || value < least || value > most)
    fail(least == 0 ? std::string(what) + " (an integer, not negative)" : std::string(what) + " (an integer)", next_text());
  at_ = end;
  return value;
}

double GmshCursor::text_real(const char* what) {
  skip_blanks();
  double value = 0;
  const auto [end, error] = std::from_chars(at_, end_, value);
  if (error != std::errc{} || (end != end_ && !blank(*end)) || !std::isfinite(value))
    fail(std::string(what) + " (a finite number)", next_text());
  at_ = end;
  return value;
}

template <class T>
T GmshCursor::raw(const char* what) {
  if (left() < sizeof(T)) fail(std::string(what) + " (" + std::to_string(sizeof(T)) + " bytes)", next_text());
  T value;
  std::memcpy(&value, at_, sizeof(T));
  at_ += sizeof(T);
  return value;
}

int GmshCursor::raw_integer(const char* what) {
  return raw<std::int32_t>(what);
}

std::int64_t GmshCursor::raw_size(const char* what) {
  const auto value = raw<std::int64_t>(what);
  if (value >= 0) return value;
  at_ -= sizeof(value);
  fail(std::string(what) + " (not negative)", std::to_string(value));
}

double GmshCursor::raw_real(const char* what) {
  const auto value = raw<double>(what);
  if (std::isfinite(value)) return value;
  at_ -= sizeof(value);
  fail(std::string(what) + " (a finite number)", shortest(value));
}

std::uint32_t GmshCursor::raw_bytes(const char* what) {
  return raw<std::uint32_t>(what);
}

std::int64_t GmshCursor::count(const char* what, std::size_t text_bytes, std::size_t binary_bytes) {
  const std::int64_t items = size(what);
  check_count(items, what, text_bytes, binary_bytes);
  return items;
}

void GmshCursor::check_count(std::int64_t items, const char* what, std::size_t text_bytes, std::size_t binary_bytes) {
  // The last number of a section of text may lack its blank.
  const std::size_t room = (left() + (binary_ ? 0 : 1)) / (binary_ ? binary_bytes : text_bytes);
  if (items < 0 || static_cast<std::uint64_t>(items) > room || items >= INT32_MAX)
    fail(std::string(what) + " that the section can hold (at most " + std::to_string(std::min<std::size_t>(room, INT32_MAX - 1)) + ")",
         std::to_string(items));
}

std::string_view GmshCursor::quoted(const char* what) {
  skip_blanks();
  const std::string_view line = line_from({at_, left()}, 0);
  const std::size_t last = line.rfind('"');
  if (line.empty() || line[0] != '"' || last == 0) fail(std::string(what) + " in double quotes", next_text());
  at_ += last + 1;
  return line.substr(1, last - 1);
}

std::string_view GmshCursor::word(const char* what) {
  skip_blanks();
  if (at_ == end_) fail(what, next_text());
  const char* begin = at_;
  at_ = std::find_if(at_, end_, blank);
  return {begin, static_cast<std::size_t>(at_ - begin)};
}

void GmshCursor::end_line() {
  while (at_ != end_ && *at_ != '\n' && blank(*at_)) ++at_;
  if (at_ == end_) return;
  if (*at_ != '\n') fail("the end of the line", next_text());
  ++at_;
}

void GmshCursor::finish(const char* what) {
  if (!binary_ || left() <= 2) skip_blanks();  // the end of the line before $End
  if (at_ != end_) fail(what, next_text());
}

}  // namespace uplift
