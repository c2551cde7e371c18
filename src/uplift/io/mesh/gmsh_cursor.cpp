#include "uplift/io/mesh/gmsh_cursor.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "uplift/base/text.h"

namespace uplift {
namespace {

constexpr std::size_t longest_name = 80;    // of a section; a limit keeps the search for its end fast
constexpr std::size_t longest_line = 4096;  // of a section's name with its blanks

[[noreturn]] void refuse(const GmshSource& source, std::uint64_t at, const std::string& wanted, const std::string& found) {
  throw InputError({source.file(), source.line_at(at)}, "byte " + std::to_string(at), wanted, found);
}

}  // namespace

std::vector<GmshSection> gmsh_sections(const GmshSource& source) {
  std::vector<GmshSection> sections;
  for (std::uint64_t at = source.after_blanks(0); at < source.size();) {
    const std::string line = source.line_from(at, longest_line);
    const std::string name(trim(line));
    if (name.size() < 2 || name.size() > longest_name || name[0] != '$' || name.starts_with("$End"))
      refuse(source, at, "the beginning of a section ($Name)", in_quotes(name));
    const std::string end = "$End" + name.substr(1);
    const std::uint64_t begin = std::min<std::uint64_t>(at + line.size() + 1, source.size()), closing = source.find(end, begin);
    if (closing == source.size()) refuse(source, at, in_quotes(end) + " after " + in_quotes(name), "the end of the file");
    const std::string rest = source.line_from(closing, longest_line);
    if (trim(rest) != end) refuse(source, closing, in_quotes(end), in_quotes(trim(rest)));
    sections.push_back({name.substr(1), begin, closing});
    at = source.after_blanks(closing + rest.size());
  }
  return sections;
}

GmshCursor::GmshCursor(const GmshSource& source, const GmshSection& section, bool binary)
    : source_(&source), name_("$" + section.name), behind_window_(section.begin), end_(section.end), binary_(binary) {}

void GmshCursor::fill(std::size_t bytes) {
  window_.erase(0, at_);
  at_ = 0;
  const std::size_t before = window_.size();
  source_->append(window_, behind_window_, std::max(bytes, source_->piece()), end_);
  behind_window_ += window_.size() - before;
}

template <class Wanted>
std::size_t GmshCursor::length_before(Wanted wanted) {
  std::size_t length = 0;
  for (;;) {
    look_ahead(length + 1);
    const std::string_view text = ahead();
    length = static_cast<std::size_t>(std::find_if(text.begin() + static_cast<std::ptrdiff_t>(length), text.end(), wanted) - text.begin());
    if (length < text.size() || behind_window_ == end_) return length;
  }
}

Where GmshCursor::where() const {
  if (binary_) return {file(), 0};
  return {file(), source_->line_at(offset())};
}

std::string GmshCursor::path() const {
  return binary_ ? name_ + ", byte " + std::to_string(offset()) : name_;
}

void GmshCursor::fail(const std::string& wanted, const std::string& found) const {
  throw InputError(where(), path(), wanted, found);
}

std::string GmshCursor::next_text() {
  if (left() == 0) return "the end of the section";
  if (binary_) return std::to_string(left()) + " bytes before the end of the section";
  const std::size_t length = length_before(gmsh_blank);
  return in_quotes(ahead().substr(0, length));
}

void GmshCursor::skip_blanks() {
  for (look_ahead(1); at_ < window_.size() && gmsh_blank(window_[at_]); look_ahead(1)) ++at_;
}

template <class Number>
std::size_t GmshCursor::read_number(Number& value) {
  skip_blanks();
  const std::size_t length = length_before(gmsh_blank);
  const char* const text = window_.data() + at_;
  const auto [end, error] = std::from_chars(text, text + length, value);
  return error == std::errc{} && end == text + length ? length : 0;
}

std::int64_t GmshCursor::text_integer(const char* what, std::int64_t least, std::int64_t most) {
  std::int64_t value = 0;
  const std::size_t length = read_number(value);
  if (length == 0 || value < least || value > most)
    fail(least == 0 ? std::string(what) + " (an integer, not negative)" : std::string(what) + " (an integer)", next_text());
  at_ += length;
  return value;
}

double GmshCursor::text_real(const char* what) {
  double value = 0;
  const std::size_t length = read_number(value);
  if (length == 0 || !std::isfinite(value)) fail(std::string(what) + " (a finite number)", next_text());
  at_ += length;
  return value;
}

template <class T>
T GmshCursor::raw(const char* what) {
  look_ahead(sizeof(T));
  if (left() < sizeof(T)) fail(std::string(what) + " (" + std::to_string(sizeof(T)) + " bytes)", next_text());
  T value;
  std::memcpy(&value, window_.data() + at_, sizeof(T));
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
  const std::uint64_t room = (left() + (binary_ ? 0 : 1)) / (binary_ ? binary_bytes : text_bytes);
  if (items < 0 || static_cast<std::uint64_t>(items) > room || items >= INT32_MAX)
    fail(std::string(what) + " that the section can hold (at most " + std::to_string(std::min<std::uint64_t>(room, INT32_MAX - 1)) + ")",
         std::to_string(items));
}

std::string GmshCursor::quoted(const char* what) {
  skip_blanks();
  const std::size_t length = length_before([](char c) { return c == '\n'; });
  const std::string_view line = ahead().substr(0, length);
  const std::size_t last = line.rfind('"');
  if (line.empty() || line[0] != '"' || last == 0) fail(std::string(what) + " in double quotes", next_text());
  at_ += last + 1;
  return std::string(line.substr(1, last - 1));
}

std::string GmshCursor::word(const char* what) {
  skip_blanks();
  if (left() == 0) fail(what, next_text());
  const std::size_t length = length_before(gmsh_blank);
  at_ += length;
  return window_.substr(at_ - length, length);
}

void GmshCursor::end_line() {
  const auto here = [&] {
    look_ahead(1);
    return left() == 0 ? '\n' : window_[at_];
  };
  while (here() != '\n' && gmsh_blank(window_[at_])) ++at_;
  if (here() != '\n') fail("the end of the line", next_text());
  if (left() > 0) ++at_;
}

void GmshCursor::finish(const char* what) {
  if (!binary_ || left() <= 2) skip_blanks();  // the end of the line before $End
  if (left() > 0) fail(what, next_text());
}

}  // namespace uplift
