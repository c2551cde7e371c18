#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "uplift/base/file.h"
#include "uplift/base/text.h"
#include "uplift/case/build/model.h"
#include "uplift/case/schema/sections.h"
#include "uplift/elements/bulk_law.h"

namespace uplift {
namespace {

const std::string* text_in(const RawTable& table, std::string_view key) {
  const Raw* found = table.find(key);
  return found ? std::get_if<std::string>(&found->data) : nullptr;
}

/// A record is an acceleration; an acceleration as its factor, "9.81 m/s2", multiplies the earthquake by 9.81. The checked numbers have
/// lost their units, so that this looks at the file's.
void check_factors_of_records(const Raw& raw, const Case& read) {
  const auto* root = std::get_if<std::shared_ptr<RawTable>>(&raw.data);
  const Raw* grounds = root != nullptr ? (*root)->find("ground_acceleration") : nullptr;
  const auto* tables = grounds != nullptr ? std::get_if<RawList>(&grounds->data) : nullptr;
  for (std::size_t i = 0; tables != nullptr && i < tables->size(); ++i) {
    const auto* table = std::get_if<std::shared_ptr<RawTable>>(&(*tables)[i].data);
    const std::string* amplitude = table != nullptr ? text_in(**table, "amplitude") : nullptr;
    const std::string* function = table != nullptr ? text_in(**table, "function") : nullptr;
    if (amplitude == nullptr || function == nullptr) continue;
    const bool of_record = std::ranges::find(read.records, *function, &CaseRecord::name) != read.records.end();
    const bool has_unit = leading_number(trim(*amplitude)).length < trim(*amplitude).size();
    const CaseGround& ground = read.input->grounds[i];
    if (of_record && has_unit && ground.amplitude != 1)
      fail(ground, "amplitude", "a factor without unit: the record " + in_quotes(*function) + " is an acceleration itself",
           fmt::format("{}, a factor of {:g}", in_quotes(*amplitude), ground.amplitude));
  }
}

/// The tables as structs, and between them the mesh unless it is there already.
void fill_input(bool same_mesh, const MeshReader& read_mesh, Case& read) {
  auto made = std::make_unique<CaseInput>(input_of_mesh(read.values));
  CaseInput& input = *made;
  read.input.reset(made.release());
  if (!same_mesh) read.mesh = mesh_of_case(read, read_mesh);
  add_rest_of_input(read.values, read.mesh ? &read.mesh->mesh : nullptr, input);
}

}  // namespace

void FreeInput::operator()(const CaseInput* input) const {
  delete input;
}

Case check_case(const Raw& raw, const std::string& file, const MeshReader& read_mesh) {
  Case read{check(raw, case_section()), file, nullptr, {}, nullptr};
  fill_input(false, read_mesh, read);
  read.records = read_records(read.input->records);
  check_factors_of_records(raw, read);
  return read;
}

Case check_case_like(const Case& like, bool same_mesh, const Raw& raw, const MeshReader& read_mesh) {
  Case read{check(raw, case_section()), like.file, like.mesh, like.records, nullptr};
  fill_input(same_mesh, read_mesh, read);
  check_factors_of_records(raw, read);
  return read;
}

std::vector<std::string> input_files(const Case& read) {
  std::vector<std::string> files;
  const auto add = [&](const NameUsed& file) {
    const std::filesystem::path path = std::filesystem::path(read.file).parent_path() / file.name;
    require_file(path, file.where(), file.path());
    files.push_back(path.lexically_normal().string());
  };
  for (const CaseFunction& function : read.input->functions)
    if (function.file) add(*function.file);
  if (read.input->mesh && read.input->mesh->file) add(*read.input->mesh->file);
  for (const CaseElement& solid : read.input->elements_at(ElementPlace::cells))
    if (const Values* law = stated_bulk_law(*solid.table))
      if (const std::filesystem::path path = library_of(*law); std::filesystem::is_regular_file(path))  // else the law refuses it
        files.push_back(path.lexically_normal().string());
  if (const std::optional<std::string>& file = read.input->reduced_model) {
    const Where& where = read.values.where("reduced_model");
    const std::filesystem::path path = path_beside(where, *file);
    require_file(path, where, "reduced_model");
    files.push_back(path.lexically_normal().string());
  }
  for (const CaseRecordSource& record : read.input->records)
    if (record.file) files.push_back(record.location);
  for (const CaseVariant& variant : read.input->variants)
    if (variant.other_case) {
      const std::filesystem::path path = path_beside(variant.other_case->where(), variant.other_case->name);
      if (std::filesystem::is_regular_file(path)) files.push_back(path.lexically_normal().string());  // else `compare` refuses it
    }
  return files;
}

std::shared_ptr<const LinearSolver> bulk_solver(const Case& read) {
  return make_part(solver_catalog(), *read.input->solver);
}

}  // namespace uplift
