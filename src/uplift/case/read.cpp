#include <filesystem>

#include "uplift/base/file.h"
#include "uplift/base/text.h"
#include "uplift/case/build/model.h"
#include "uplift/case/schema/sections.h"

namespace uplift {

Case check_case(const Raw& raw, const std::string& file, const MeshReader& read_mesh) {
  Case read{check(raw, case_section()), file, nullptr, {}};
  read.mesh = mesh_of_case(read.values, file, read_mesh);
  read.records = read_records(read.values);
  return read;
}

Case check_case_like(const Case& like, bool same_mesh, const Raw& raw, const MeshReader& read_mesh) {
  Case read{check(raw, case_section()), like.file, like.mesh, like.records};
  if (!same_mesh) read.mesh = mesh_of_case(read.values, like.file, read_mesh);
  return read;
}

std::vector<std::string> input_files(const Case& read) {
  std::vector<std::string> files;
  const auto add = [&](const Values& table) {
    const std::filesystem::path path = std::filesystem::path(read.file).parent_path() / table.text("file");
    if (!std::filesystem::is_regular_file(path)) fail(table, "file", "a file", escaped(path.string()));
    files.push_back(path.lexically_normal().string());
  };
  for (const Values& function : read.values.tables("function")) {
    const Values& shape = function.part("shape");
    if (shape.items().contains("file") && shape.has("file")) add(shape);
  }
  if (const Values* mesh = table_if(read.values, "mesh"); mesh && mesh->has("file")) add(*mesh);
  for (const Values* solid : element_tables(read.values, ElementPlace::cells))
    for (const char* key : {"law", "plasticity"})
      if (solid->items().contains(key) && solid->has(key) && solid->part(key).items().contains("library")) {
        const Values& law = solid->part(key);
        const std::filesystem::path path = path_beside(law.where("library"), law.text("library"));
        if (std::filesystem::is_regular_file(path)) files.push_back(path.lexically_normal().string());  // else the law refuses it
      }
  if (read.values.has("reduced_model"))
    files.push_back(path_beside(read.values.where("reduced_model"), read.values.text("reduced_model")).lexically_normal().string());
  for (const Values& record : read.values.tables("record"))
    if (record.has("file")) files.push_back(record_path(record));
  for (const Values& variant : read.values.tables("variant"))
    if (variant.has("case")) {
      const std::filesystem::path path = path_beside(variant.where("case"), variant.text("case"));
      if (std::filesystem::is_regular_file(path)) files.push_back(path.lexically_normal().string());  // else `compare` refuses it
    }
  return files;
}

std::shared_ptr<const LinearSolver> bulk_solver(const Case& read) {
  return make_part(solver_catalog(), read.values.part("solver"));
}

}  // namespace uplift
