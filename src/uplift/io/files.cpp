#include "uplift/io/files.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>

#include "uplift/base/error.h"

namespace uplift {
namespace fs = std::filesystem;

namespace {

constexpr std::string_view part_suffix = ".part-";

struct Closer {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Closer>;

[[noreturn]] void refuse(const std::string& path, const char* wanted, const std::string& why) {
  constexpr std::size_t most = 300;
  throw InputError({path.size() <= most ? path : path.substr(0, most) + "...", 0}, "", wanted, why);
}

/// The folder that a path stands for: links and a final "." or ".." are resolved, because a folder is moved by its own name.
std::string resolved(const std::string& given) {
  if (given.empty()) refuse(given, "a folder for the results", "an empty name");
  std::error_code error;
  fs::path path = fs::path(given).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  const fs::path name = path.filename();
  const bool link = fs::is_symlink(path, error);
  if (link && !fs::exists(path, error)) {
    const fs::path target = fs::read_symlink(path, error);
    refuse(given, "a folder for the results", "a symbolic link to " + target.string() + ", which does not exist");
  }
  if (link || name == "." || name == "..") path = fs::canonical(path, error);
  return path.string();
}

bool is_mount_point(const std::string& path) {
  struct stat own, above;
  return stat(path.c_str(), &own) == 0 && stat((path + "/..").c_str(), &above) == 0 && own.st_dev != above.st_dev;
}

/// What stands in the way is moved aside only when it holds results: a case, or a home, is not ours to move.
void check_place(const std::string& path) {
  std::error_code error;
  if (!fs::exists(path, error)) return;
  if (!fs::is_directory(path, error)) refuse(path, "a folder for the results", "a file");
  if (is_mount_point(path)) refuse(path, "a folder that can be moved", "a mount point (a folder in it can be given)");
  if (!fs::is_empty(path, error) && !fs::exists(fs::path(path) / "summary.json", error))
    refuse(path, "a new folder for the results, or one with earlier results",
           "a folder with something else in it (it has no summary.json)");
}

/// True when a folder holds nothing but folders.
bool without_files(const fs::path& folder) {
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->is_symlink(error) || !entry->is_directory(error)) return false;
  return !error;
}

/// The process that a working folder belongs to; 0: none.
pid_t owner_of(const std::string& name, const std::string& stem) {
  if (!name.starts_with(stem) || name.size() == stem.size() || !std::isdigit(static_cast<unsigned char>(name[stem.size()]))) return 0;
  return static_cast<pid_t>(std::strtol(name.c_str() + stem.size(), nullptr, 10));
}

}  // namespace

ResultFolder::ResultFolder(const std::string& path) : path_(resolved(path)) {
  check_place(path_);
  find_abandoned();
  std::error_code error;
  const fs::path above = fs::path(path_).parent_path();
  if (!above.empty()) fs::create_directories(above, error);
  // Process numbers come again: a folder of this name is not ours.
  for (int number = 1;; ++number) {
    work_ = fmt::format("{}{}{}{}", path_, part_suffix, getpid(), number > 1 ? fmt::format("-{}", number) : "");
    if (mkdir(work_.c_str(), 0777) == 0) return;
    // why the folder above could not be made says more than that it is not there
    if (errno != EEXIST) refuse(path_, "a folder that can be made for the results", error ? error.message() : std::strerror(errno));
  }
}

ResultFolder::~ResultFolder() {
  std::error_code ignored;
  if (!finished_ && without_files(work_)) fs::remove_all(work_, ignored);
}

/// A process on another machine may look ended here. It does not miss an empty folder: place() makes it again.
void ResultFolder::find_abandoned() {
  std::error_code error;
  const fs::path own(path_), above = own.has_parent_path() ? own.parent_path() : fs::path(".");
  const std::string stem = own.filename().string() + std::string(part_suffix);
  std::vector<fs::path> found;
  for (fs::directory_iterator entry(above, error), end; !error && entry != end; entry.increment(error)) {
    const pid_t owner = owner_of(entry->path().filename().string(), stem);
    if (owner > 0 && kill(owner, 0) != 0 && errno == ESRCH && fs::is_directory(entry->symlink_status(error)))
      found.push_back(entry->path());
  }
  std::ranges::sort(found);
  for (const fs::path& folder : found) {
    if (without_files(folder))
      fs::remove_all(folder, error);
    else
      abandoned_.push_back((own.parent_path() / folder.filename()).string());
  }
}

bool ResultFolder::has_files() const {
  return !without_files(work_);
}

void ResultFolder::note_failure(const std::string& name, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  if (failure_.empty()) failure_ = fmt::format("{}/{}: cannot write the file: {}", path_, name, reason);
}

void ResultFolder::write(const std::string& name, std::string_view text) {
  const std::string place = this->place(name), path = place + ".new";  // what is there stays until all of it is written
  errno = 0;
  File file(std::fopen(path.c_str(), "wb"));
  if (!file) return note_failure(name, std::strerror(errno));
  const bool written = std::fwrite(text.data(), 1, text.size(), file.get()) == text.size();
  const int reason = errno;
  if (std::fclose(file.release()) == 0 && written && std::rename(path.c_str(), place.c_str()) == 0) return;
  note_failure(name, std::strerror(written ? errno : reason));
  std::error_code ignored;
  fs::remove(path, ignored);
}

std::string ResultFolder::place(const std::string& name) const {
  const fs::path path = fs::path(work_) / name;
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  return path.string();
}

std::string ResultFolder::finish() {
  if (!failure_.empty()) throw OutputError(failure_);
  std::string moved;
  std::error_code error;
  if (fs::is_directory(path_, error) && fs::is_empty(path_, error)) fs::remove(path_, error);
  if (fs::exists(path_, error)) {
    int number = 1;
    while (fs::exists(fmt::format("{}.{}", path_, number), error)) ++number;
    moved = fmt::format("{}.{}", path_, number);
    fs::rename(path_, moved, error);
    if (error) throw OutputError(fmt::format("{}: cannot move the earlier results to {}: {}", path_, moved, error.message()));
  }
  fs::rename(work_, path_, error);
  if (error) throw OutputError(fmt::format("{}: cannot move the results to this place: {}", path_, error.message()));
  finished_ = true;
  return moved;
}

}  // namespace uplift
