#pragma once
#include <filesystem>
#include <stdexcept>
#include <string>

// The files of tests/data. A missing one is an error of the test, never a reason to skip it.
namespace uplift::support {

/// The root of the repository.
std::string source_folder();

inline std::string data_file(const std::string& path) {
  const std::string file = source_folder() + "/tests/data/" + path;
  if (!std::filesystem::exists(file)) throw std::runtime_error("no file " + file);
  return file;
}

}  // namespace uplift::support
