#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace uplift {

/// The whole file, byte for byte. Throws InputError with the reason; when there is no such file, with the nearest name in its folder.
std::string read_file(const std::filesystem::path& path);

/// Writes a file so that a reader finds the old text or the new one and never a part: beside it first, then renamed. The folder must exist.
/// Throws std::filesystem::filesystem_error with the reason; an older file is kept then.
void write_file_atomically(const std::filesystem::path& path, std::string_view text);

/// SHA-256 (FIPS 180-4) of a text, as 64 hexadecimal digits. It says whether inputs are the same; it protects nothing.
std::string sha256(std::string_view text);

}  // namespace uplift
