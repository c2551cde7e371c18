#include "uplift/io/text/numbers.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cmath>

namespace uplift {

char* write_number(char* out, double value, int digits) {
  assert(std::isfinite(value) && digits >= 1 && digits <= 15);
  return std::to_chars(out, out + number_room, value + 0.0, std::chars_format::general, digits).ptr;  // -0 becomes 0
}

void append_number(std::string& text, double value, int digits) {
  char out[number_room];
  text.append(out, write_number(out, value, digits));
}

void append_numbers(std::string& text, std::span<const double> values, int digits) {
  std::array<char, 64 * number_room> some;
  char* out = some.data();
  for (const double value : values) {
    if (out > some.data() + some.size() - 2 * number_room) {
      text.append(some.data(), out);
      out = some.data();
    }
    out = std::isfinite(value) ? write_number(out, value, digits) : std::copy_n("null", 4, out);
    *out++ = ',';
  }
  text.append(some.data(), values.empty() ? out : out - 1);
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

void append_exact(std::string& text, double value) {
  assert(std::isfinite(value));
  char out[40];
  text.append(out, std::to_chars(out, out + sizeof out, value).ptr);
}

}  // namespace uplift
