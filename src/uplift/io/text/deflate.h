#pragma once
#include <string>
#include <string_view>

namespace uplift {

/// The bytes as a zlib stream (RFC 1950), which browsers decode with DecompressionStream("deflate").
std::string deflated(std::string_view bytes);

}  // namespace uplift
