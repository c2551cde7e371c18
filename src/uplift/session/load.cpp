#include "uplift/session/load.h"

#include <fmt/chrono.h>

#include <ctime>
#include <filesystem>

#include "uplift/base/file.h"
#include "uplift/case/decided.h"
#include "uplift/case/schema/case_input.h"
#include "uplift/io/mesh/file.h"
#include "uplift/io/text/json_reader.h"
#include "uplift/io/text/toml.h"
#include "uplift/session/reduce.h"

namespace uplift {
namespace fs = std::filesystem;

namespace {

LoadedCase checked(Raw raw, const std::string& text, const std::string& file, const std::string& command, MeshFiles files) {
  LoadedCase loaded;
  loaded.raw = std::move(raw);
  loaded.mesh_files = files;
  loaded.read_mesh = [isolated = files == MeshFiles::isolated](const std::string& path, const Where& where, const std::string& name) {
    return read_mesh(path, where, name, isolated);
  };
  loaded.read = check_case(loaded.raw, file, loaded.read_mesh);
  Provenance& from = loaded.from;
  from.reduced = read_reduced_model_of(loaded.read.values);
  if (from.reduced != nullptr) from.reduced_file = *loaded.read.input->reduced_model;
  from.title = loaded.read.input->title;
  from.subtitle = loaded.read.input->description;
  from.command = command;
  from.version = UPLIFT_VERSION;
#if defined(__clang__)
  from.built_with = "Clang " __clang_version__;
#else
  from.built_with = "GCC " __VERSION__;
#endif
  from.created = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  from.case_file = file;
  from.case_hash = sha256(text);
  for (const std::string& input : input_files(loaded.read)) from.inputs.emplace_back(input, sha256(read_file(input)));
  from.resolved = to_toml(loaded.read.values, decided_texts(loaded.read));
  return loaded;
}

}  // namespace

LoadedCase load_case(const std::string& given, const std::string& command, MeshFiles files) {
  std::string file = given;
  std::error_code error;
  if (fs::is_directory(file, error)) file = (fs::path(file) / "case.toml").string();
  Raw raw = read_toml_file(file);
  return checked(std::move(raw), read_file(file), file, command, files);
}

LoadedCase load_case_text(const std::string& text, const std::string& file, const std::string& command, MeshFiles files) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const bool is_json = first != std::string::npos && text[first] == '{';
  return checked(is_json ? read_json_text(text, file) : read_toml_text(text, file), text, file, command, files);
}

std::string default_result_path(const Case& read) {
  const fs::path file = fs::absolute(read.file).lexically_normal();
  const std::string name = file.filename() == "case.toml" ? file.parent_path().filename().string() : file.stem().string();
  return (fs::path("out") / name).string();
}

}  // namespace uplift
