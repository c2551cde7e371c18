#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace uplift {

/// Appends bytes as base64 (RFC 4648, section 4, filled up with "=").
void append_base64(std::string& text, std::string_view bytes);
/// Characters of `bytes` bytes in base64.
constexpr std::size_t base64_length(std::size_t bytes) {
  return (bytes + 2) / 3 * 4;
}

}  // namespace uplift
