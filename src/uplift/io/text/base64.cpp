#include "uplift/io/text/base64.h"

namespace uplift {

void append_base64(std::string& text, std::string_view bytes) {
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  constexpr unsigned low = 63;  // six bits
  const std::size_t begin = text.size(), whole = bytes.size() / 3 * 3, rest = bytes.size() - whole;
  text.resize(begin + base64_length(bytes.size()), '=');
  char* out = text.data() + begin;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(bytes[i])); };
  const auto put = [&](unsigned bits, std::size_t characters) {
    for (std::size_t i = 0; i < characters; ++i) *out++ = digits[(bits >> (18 - 6 * i)) & low];
  };
  for (std::size_t i = 0; i < whole; i += 3) put(byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2), 4);
  if (rest == 1) put(byte(whole) << 16, 2);
  if (rest == 2) put(byte(whole) << 16 | byte(whole + 1) << 8, 3);
}

}  // namespace uplift
