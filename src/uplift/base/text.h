#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Small helpers for the texts of messages and files. Nothing here depends on the locale.
namespace uplift {

/// Without white space at both ends.
std::string_view trim(std::string_view text);
/// In double quotes for a message: control characters escaped, long texts cut after 60 characters.
std::string in_quotes(std::string_view text);
/// The shortest decimal that reads back as the same double: "0.1", "20000000000", "1e+20".
std::string shortest(double value);
/// "999 bytes", "1.23 kB", "121 MB", "31.25 GB" (1 MB = 1e6 bytes).
std::string format_bytes(double bytes);
/// "a, b or c".
std::string listed(const std::vector<std::string>& items);
/// Text of a JSON or TOML basic string, with its quotes.
std::string escaped(std::string_view text);
/// Byte offset of the first byte that is not part of valid UTF-8 (overlong forms and surrogates are not valid); none when all is.
std::optional<std::size_t> invalid_utf8(std::string_view text);

/// A number at the beginning of a text.
struct LeadingNumber {
  double value = 0;
  std::size_t length = 0;     // characters used; 0: there is no number
  bool out_of_range = false;  // too large, or so small that it would become zero
};
/// Reads [+-]digits[.digits][e[+-]digits]; neither "inf" nor "nan" nor hexadecimal.
LeadingNumber leading_number(std::string_view text);

}  // namespace uplift
