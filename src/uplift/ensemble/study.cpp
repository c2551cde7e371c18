#include "uplift/ensemble/study.h"

#include <filesystem>

#include "uplift/base/file.h"
#include "uplift/base/text.h"
#include "uplift/case/schema/case_input.h"
#include "uplift/io/files.h"
#include "uplift/io/mesh/file.h"
#include "uplift/io/text/toml.h"
#include "uplift/session/reduce.h"

namespace uplift {
namespace {

namespace fs = std::filesystem;

std::string folder_of(const std::string& given) {
  std::error_code error;
  const fs::path path(given);
  for (const fs::path& each : {path, fs::path(given + ".study")})
    if (fs::is_directory(each, error)) return each.lexically_normal().string();
  if (path.filename() == "plan.toml") return path.has_parent_path() ? path.parent_path().lexically_normal().string() : ".";
  throw InputError({given, 0}, "", "the folder of a study, with a plan.toml", "no folder of this name");
}

}  // namespace

Study open_study(const std::string& given) {
  Study study;
  study.folder = folder_of(given);
  while (study.folder.size() > 1 && study.folder.ends_with('/')) study.folder.pop_back();
  const fs::path last = fs::absolute(study.folder).lexically_normal().filename();
  study.name = last.extension() == ".study" ? last.stem().string() : last.string();
  const std::string plan_file = study.folder + "/plan.toml", text = read_file(plan_file);
  const StudyPlan plan = study_plan(read_toml_text(text, plan_file));
  study.plan_hash = sha256(text);
  study.case_file = plan.case_file;
  std::error_code error;
  if (fs::is_directory(study.case_file, error)) study.case_file = (fs::path(study.case_file) / "case.toml").lexically_normal().string();
  if (!fs::is_regular_file(study.case_file, error))
    fail(*plan.values, "case", "a case file, or a folder with case.toml", escaped(plan.case_file));
  const std::string case_text = read_file(study.case_file);
  study.case_hash = sha256(case_text);
  StudyPlan located = plan;
  located.case_file = study.case_file;
  const MeshReader reader = [](const std::string& path, const Where& where, const std::string& name) {
    return read_mesh(path, where, name, true);
  };
  const std::string motions = study.folder + "/motions";
  try {
    study.of = study_case(located, read_toml_text(case_text, study.case_file), reader, motions);
  } catch (const fs::filesystem_error& failed) {
    throw OutputError(failed.what());
  }
  for (const std::string& input : input_files(study.of.read))
    if (fs::path(input).parent_path() != fs::absolute(motions).lexically_normal())
      study.inputs.emplace_back(input, sha256(read_file(input)));
  study.reduced = read_reduced_model_of(study.of.read.values);
  return study;
}

std::string Study::reduced_statement() const {
  return reduced ? reduced->statement(*of.read.input->reduced_model) : "";
}

}  // namespace uplift
