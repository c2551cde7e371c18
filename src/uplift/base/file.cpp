#include "uplift/base/file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "uplift/base/error.h"
#include "uplift/base/text.h"

namespace uplift {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

[[noreturn]] void missing(const fs::path& path) {
  const Where where{path.string(), 0};
  std::error_code error;
  const fs::path folder = folder_of(path);
  if (!fs::is_directory(folder, error)) throw InputError(where, "", "a file", "no folder " + escaped(folder.string()));
  throw InputError(where, "", "a file", "no file of this name", nearest_file(path));
}

/// A new file beside the target, removed unless it is published.
class Draft {
 public:
  explicit Draft(const fs::path& target) {
    // Another process may write the same file: each takes a name of its own, and the last rename wins.
    const std::string stem = target.string() + "." + std::to_string(::getpid()) + "-";
    for (int i = 0; descriptor_ < 0 && i < 1000; ++i) {
      name_ = stem + std::to_string(i);
      descriptor_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (descriptor_ < 0 && errno != EEXIST) break;
    }
    if (descriptor_ < 0) fail(target);
  }
  ~Draft() {
    if (descriptor_ < 0) return;
    ::close(descriptor_);
    ::unlink(name_.c_str());
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  void write(std::string_view text, const fs::path& target) const {
    while (!text.empty()) {
      const ssize_t written = ::write(descriptor_, text.data(), text.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(target);
      text.remove_prefix(static_cast<std::size_t>(written));
    }
  }
  void flush(const fs::path& target) const {
    if (::fdatasync(descriptor_) != 0) fail(target);
  }
  void publish(const fs::path& target) {
    const int closed = ::close(descriptor_);
    descriptor_ = -1;
    if (closed == 0 && std::rename(name_.c_str(), target.c_str()) == 0) return;
    const int reason = errno;
    ::unlink(name_.c_str());
    errno = reason;
    fail(target);
  }

 private:
  [[noreturn]] static void fail(const fs::path& target) {
    throw fs::filesystem_error("cannot write the file", target, std::error_code(errno, std::generic_category()));
  }
  std::string name_;
  int descriptor_ = -1;
};

}  // namespace

fs::path path_beside(const Where& where, const std::string& given) {
  return fs::path(where.file).parent_path() / given;  // an absolute path stays
}

std::string nearest_file(const fs::path& path) {
  std::error_code error;
  std::vector<std::string> names;
  for (fs::directory_iterator entry(folder_of(path), error), end; !error && entry != end; entry.increment(error))
    if (entry->is_regular_file(error)) names.push_back(entry->path().filename().string());
  const std::string nearest = nearest_name(path.filename().string(), names);
  return nearest.empty() ? "" : (path.parent_path() / nearest).string();
}

void require_file(const fs::path& path, const Where& where, const std::string& key, const std::string& wanted) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_regular_file(status)) return;
  const auto refuse = [&](const std::string& found, const std::string& nearest = {}) {
    throw InputError(where, key, wanted, found, nearest);
  };
  if (status.type() == fs::file_type::none) refuse(escaped(path.string()) + ": " + error.message());
  if (status.type() != fs::file_type::not_found) refuse(escaped(path.string()) + ", which is no regular file");
  if (!fs::is_directory(folder_of(path), error)) refuse("no folder " + escaped(folder_of(path).string()));
  refuse("no file " + escaped(path.string()), nearest_file(path));
}

std::string read_file(const fs::path& path, double most) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) missing(path);
  if (fs::is_directory(status)) throw InputError({path.string(), 0}, "", "a file", "a folder");
  if (!error && !fs::is_regular_file(status))
    throw InputError({path.string(), 0}, "", "a regular file", "a pipe, a device or a socket (write its content to a file first)");
  if (const char* raised = std::getenv("UPLIFT_MAX_FILE_MB")) most = leading_number(raised).value;
  const double size = static_cast<double>(fs::file_size(path, error));
  if (!error && size > 1e6 * most)
    throw InputError({path.string(), 0}, "",
                     "a file of at most " + format_bytes(1e6 * most) + " (the environment variable UPLIFT_MAX_FILE_MB raises this limit)",
                     format_bytes(size));
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError({path.string(), 0}, "", "a file that may be read", std::error_code(errno, std::generic_category()).message());
  std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (in.bad()) throw InputError({path.string(), 0}, "", "a file that can be read to its end", "an error of the disk");
  return text;
}

void write_file_atomically(const fs::path& path, std::string_view text) {
  Draft draft(path);
  draft.write(text, path);
  draft.publish(path);
}

void write_file_durably(const fs::path& path, std::string_view text) {
  Draft draft(path);
  draft.write(text, path);
  draft.flush(path);
  draft.publish(path);
  if (const int folder = ::open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); folder >= 0) {
    ::fsync(folder);
    ::close(folder);
  }
}

FolderLock::FolderLock(const std::string& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)),
      taken_(descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace uplift
