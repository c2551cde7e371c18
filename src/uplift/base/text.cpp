#include "uplift/base/text.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <system_error>

namespace uplift {
namespace {

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Length of the UTF-8 character at the beginning of `text`, 0 when it is not valid (RFC 3629, table of section 4).
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const auto follows = [&](std::size_t i, int least = 0x80, int most = 0xBF) {
    return i < text.size() && byte(i) >= least && byte(i) <= most;
  };
  const int first = byte(0);
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) return follows(1) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) return follows(1, first == 0xE0 ? 0xA0 : 0x80, first == 0xED ? 0x9F : 0xBF) && follows(2) ? 3 : 0;
  if (first >= 0xF0 && first <= 0xF4)
    return follows(1, first == 0xF0 ? 0x90 : 0x80, first == 0xF4 ? 0x8F : 0xBF) && follows(2) && follows(3) ? 4 : 0;
  return 0;
}

}  // namespace

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

std::string escaped(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) switch (c) {
      case '"':
        out += "\\\"";
        break;
      case '\\':
        out += "\\\\";
        break;
      case '\b':
        out += "\\b";
        break;
      case '\t':
        out += "\\t";
        break;
      case '\n':
        out += "\\n";
        break;
      case '\f':
        out += "\\f";
        break;
      case '\r':
        out += "\\r";
        break;
      default:
        if (static_cast<std::uint8_t>(c) < 0x20 || c == 0x7f)
          out += fmt::format("\\u{:04x}", static_cast<int>(c));
        else
          out += c;
    }
  return out + "\"";
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t most = 60;  // bytes; a character is never cut in two
  std::string shown;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text.substr(i));
    if (i + length > most) return escaped(shown + "...");
    if (length == 0)
      shown += "?";
    else
      shown += text.substr(i, length);
    i += length == 0 ? 1 : length;
  }
  return escaped(shown);
}

std::string shortest(double value) {
  return fmt::format("{}", value);
}

std::string format_bytes(double bytes) {
  if (bytes < 1e3) return fmt::format("{:.0f} bytes", bytes);
  if (bytes < 1e6) return fmt::format("{:.3g} kB", bytes / 1e3);
  return bytes < 1e9 ? fmt::format("{:.3g} MB", bytes / 1e6) : fmt::format("{:.4g} GB", bytes / 1e9);
}

std::string listed(const std::vector<std::string>& items) {
  std::string out;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) out += i + 1 == items.size() ? " or " : ", ";
    out += items[i];
  }
  return out;
}

std::optional<std::size_t> invalid_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text.substr(i));
    if (length == 0) return i;
    i += length;
  }
  return std::nullopt;
}

LeadingNumber leading_number(std::string_view text) {
  std::size_t begin = 0;
  if (!text.empty() && text[0] == '+') begin = 1;  // from_chars reads '-' but not '+'
  const std::size_t first = !text.empty() && (text[0] == '+' || text[0] == '-') ? 1 : 0;
  const bool digit = first < text.size() && is_digit(text[first]);
  const bool point = first + 1 < text.size() && text[first] == '.' && is_digit(text[first + 1]);
  if (!digit && !point) return {};
  LeadingNumber number;
  const auto [end, error] = std::from_chars(text.data() + begin, text.data() + text.size(), number.value);
  number.length = static_cast<std::size_t>(end - text.data());
  number.out_of_range = error == std::errc::result_out_of_range;
  return number;
}

}  // namespace uplift
