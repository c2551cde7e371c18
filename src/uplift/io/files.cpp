#include "uplift/io/files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "uplift/base/error.h"

namespace uplift {
namespace fs = std::filesystem;

namespace {

struct Closer {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Closer>;

[[noreturn]] void refuse(const std::string& path, const char* wanted, const std::string& why) {
  throw InputError({path, 0}, "", wanted, why);
}

/// What stands in the way is moved aside only when it holds results: a case, or a home, is not ours to move.
void check_place(const std::string& path) {
  std::error_code error;
  if (!fs::exists(path, error)) return;
  if (!fs::is_directory(path, error)) refuse(path, "a folder for the results", "a file");
  if (!fs::is_empty(path, error) && !fs::exists(fs::path(path) / "summary.json", error))
    refuse(path, "a new folder for the results, or one with earlier results",
           "a folder with something else in it (it has no summary.json)");
}

}  // namespace

ResultFolder::ResultFolder(std::string path) : path_(fs::path(path).lexically_normal().string()) {
  if (path_.size() > 1 && path_.back() == '/') path_.pop_back();
  check_place(path_);
  work_ = fmt::format("{}.part-{}", path_, getpid());
  std::error_code error;
  fs::remove_all(work_, error);
  if (!fs::create_directories(work_, error) && error) refuse(work_, "a folder that can be made for the results", error.message());
}

ResultFolder::~ResultFolder() {
  std::error_code ignored;
  if (!finished_) fs::remove_all(work_, ignored);
}

void ResultFolder::write(const std::string& name, std::string_view text) {
  const std::string path = place(name);
  File file(std::fopen(path.c_str(), "wb"));
  if (!file) refuse(path, "a file that can be written", std::strerror(errno));
  const bool written = std::fwrite(text.data(), 1, text.size(), file.get()) == text.size();
  if (std::fclose(file.release()) != 0 || !written) refuse(path, "room for the results", std::strerror(errno));
}

std::string ResultFolder::place(const std::string& name) const {
  const fs::path path = fs::path(work_) / name;
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  return path.string();
}

std::string ResultFolder::finish() {
  std::string moved;
  std::error_code error;
  if (fs::is_directory(path_, error) && fs::is_empty(path_, error)) fs::remove(path_, error);
  if (fs::exists(path_, error)) {
    int number = 1;
    while (fs::exists(fmt::format("{}.{}", path_, number), error)) ++number;
    moved = fmt::format("{}.{}", path_, number);
    fs::rename(path_, moved, error);
    if (error) refuse(path_, "earlier results that can be moved aside", error.message());
  }
  fs::rename(work_, path_, error);
  if (error) refuse(path_, "a place for the results", error.message());
  finished_ = true;
  return moved;
}

}  // namespace uplift
