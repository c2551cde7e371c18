#include "uplift/study/study_generated.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "uplift/base/file.h"
#include "uplift/base/text.h"

namespace uplift {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view head = "# made by uplift; acceleration in m/s2, step in s: ";

const RawList* records_of(const Raw& raw) {
  const Raw* found = std::get<std::shared_ptr<RawTable>>(raw.data)->find("record");
  return found != nullptr ? std::get_if<RawList>(&found->data) : nullptr;
}

}  // namespace

GeneratedRecords::GeneratedRecords(const Raw& raw, const std::string& folder) : folder_(folder) {
  const RawList* records = folder.empty() ? nullptr : records_of(raw);
  if (records == nullptr) return;
  std::string text = UPLIFT_VERSION;
  for (const Raw& record : *records) {
    const Values values = check(record, record_section());
    const CaseRecordSource source = case_record(values);
    if (!source.generated) continue;
    names_.push_back(source.name.name);
    text += "\n" + to_toml(values);
  }
  hash_ = sha256(text).substr(0, 16);
}

std::string GeneratedRecords::file_of(const std::string& name) const {
  return fmt::format("{}/{}-{}.txt", folder_, hash_, sha256(name).substr(0, 16));
}

bool GeneratedRecords::kept() const {
  return std::ranges::all_of(names_, [&](const std::string& name) { return fs::is_regular_file(file_of(name)); });
}

void GeneratedRecords::keep(const std::vector<CaseRecord>& records) const {
  fs::create_directories(folder_);
  for (const CaseRecord& record : records) {
    if (std::ranges::find(names_, record.name) == names_.end()) continue;
    const Motion& motion = record.motion();
    std::string text = fmt::format("{}{}\n", head, shortest(motion.step));
    for (const double value : motion.values) text += shortest(value) + "\n";
    write_file_atomically(file_of(record.name), text);
  }
}

Raw GeneratedRecords::from_files(const Raw& raw) const {
  RawTable root = *std::get<std::shared_ptr<RawTable>>(raw.data);
  for (auto& [key, value] : root.entries) {
    if (key != "record") continue;
    for (Raw& record : std::get<RawList>(value.data)) {
      const std::string name = std::get<std::string>(std::get<std::shared_ptr<RawTable>>(record.data)->find("name")->data);
      if (std::ranges::find(names_, name) == names_.end()) continue;
      const std::string file = file_of(name), text = read_file(file);
      if (!text.starts_with(head))
        throw InputError({file, 1}, "", "a motion as the study has written it (delete the file)", "another text");
      const auto put = [&](auto data) { return Raw{std::move(data), record.where, record.path}; };
      RawTable made;
      made.entries.emplace_back("name", put(name));
      made.entries.emplace_back("file", put(fs::absolute(file).lexically_normal().string()));
      made.entries.emplace_back("format", put(std::string("columns")));
      made.entries.emplace_back("unit", put(std::string("m/s2")));
      made.entries.emplace_back("step", put(leading_number(std::string_view(text).substr(head.size())).value));
      record.data = std::make_shared<RawTable>(std::move(made));
    }
  }
  Raw made = raw;
  made.data = std::make_shared<RawTable>(std::move(root));
  return made;
}

}  // namespace uplift
