#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "uplift/base/error.h"

namespace uplift {

/// A path that an input file names: relative to the folder of that file.
std::filesystem::path path_beside(const Where& where, const std::string& given);

/// The file in the folder of a path whose name is the nearest to its name; empty when none is near enough to be a likely misspelling.
std::string nearest_file(const std::filesystem::path& path);

/// Throws InputError at the key that names the file unless it is a regular file: what is amiss with it, and the nearest name in its folder.
void require_file(const std::filesystem::path& path, const Where& where, const std::string& key, const std::string& wanted = "a file");

inline constexpr double usual_file_limit = 2000;  // MB

/// The whole file, byte for byte. Throws InputError with the reason: when there is no such file, with the nearest name in its folder; when
/// it is no regular file (reading a pipe or /dev/zero might never end); and when it has more than `most` MB. The environment variable
/// UPLIFT_MAX_FILE_MB replaces that limit.
std::string read_file(const std::filesystem::path& path, double most = usual_file_limit);

/// Writes a file so that a reader finds the old text or the new one and never a part: beside it first, then renamed. The folder must exist.
/// Throws std::filesystem::filesystem_error with the reason; an older file is kept then.
void write_file_atomically(const std::filesystem::path& path, std::string_view text);

/// The same, and the text is on the disk before the file appears: it outlives a power cut.
void write_file_durably(const std::filesystem::path& path, std::string_view text);

/// The mark of a process that uses a folder. The system removes it with the process, however that ends.
class FolderLock {
 public:
  explicit FolderLock(const std::string& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  /// Another process (or another lock of this one) had it already.
  bool is_taken() const { return taken_; }

 private:
  int descriptor_;
  bool taken_;
};

/// SHA-256 (FIPS 180-4) of a text, as 64 hexadecimal digits. It says whether inputs are the same; it protects nothing.
std::string sha256(std::string_view text);

}  // namespace uplift
