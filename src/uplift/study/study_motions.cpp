#include "uplift/study/study_motions.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "uplift/base/file.h"
#include "uplift/base/text.h"
#include "uplift/case/build/records.h"
#include "uplift/case/schema/case_input.h"
#include "uplift/study/case_edit.h"

namespace uplift {
namespace {

/// A table that is not shared, to be changed.
RawTable copy_of(const Raw& raw) {
  const auto* table = std::get_if<std::shared_ptr<RawTable>>(&raw.data);
  return table != nullptr ? **table : RawTable{};
}

Raw as_raw(RawTable table, const Raw& like) {
  return {std::make_shared<RawTable>(std::move(table)), like.where, like.path};
}

void set(RawTable& table, const std::string& key, Raw value) {
  const auto found = std::ranges::find(table.entries, key, [](const auto& entry) -> const std::string& { return entry.first; });
  if (found != table.entries.end())
    found->second = std::move(value);
  else
    table.entries.emplace_back(key, std::move(value));
}

RawList list_at(const RawTable& table, std::string_view key) {
  const Raw* found = table.find(key);
  const RawList* list = found != nullptr ? std::get_if<RawList>(&found->data) : nullptr;
  return list != nullptr ? *list : RawList{};
}

Raw texts_raw(const std::vector<std::string>& texts, const Raw& like) {
  RawList list;
  for (const std::string& text : texts) list.push_back({text, like.where, like.path});
  return {std::move(list), like.where, like.path};
}

// ---- [[motions]] ----

/// One [[motions]] of a plan, to be written out as records and motions of the case.
class ManyMotions {
 public:
  ManyMotions(const StudyManyMotions& given, const Raw& raw) : given_(given), raw_(raw) {}

  void add(RawList& records, RawList& motions) const {
    for (std::size_t i = 0; i < given_.count; ++i) {
      const std::string name = fmt::format("{}-{}", given_.name, i + 1);
      std::vector<std::string> by;
      for (std::size_t c = 0; c < given_.replace.size(); ++c) {
        by.push_back(given_.replace.size() == 1 ? name : fmt::format("{}-{}", name, c + 1));
        records.push_back(record(by.back(), i, c));
      }
      RawTable motion;
      set(motion, "name", text(name));
      if (!given_.files.empty()) set(motion, "label", text(std::filesystem::path(given_.files[i * given_.replace.size()]).stem().string()));
      set(motion, "replace", texts_raw(given_.replace, raw_));
      set(motion, "by", texts_raw(by, raw_));
      motions.push_back(as_raw(std::move(motion), raw_));
    }
  }

 private:
  Raw text(const std::string& value) const { return {value, raw_.where, raw_.path}; }
  Raw record(const std::string& name, std::size_t motion, std::size_t component) const {
    RawTable made = copy_of(raw_);
    std::erase_if(made.entries, [](const auto& entry) {
      return entry.first == "name" || entry.first == "replace" || entry.first == "files" || entry.first == "count" ||
             entry.first == "generate";
    });
    set(made, "name", text(name));
    if (!given_.files.empty()) {
      set(made, "file", text(given_.files[motion * given_.replace.size() + component]));
    } else {
      RawTable generate = copy_of(list_at(copy_of(raw_), "generate")[component]);
      const std::int64_t seed = given_.seeds[component];
      set(generate, "seed", {seed + static_cast<std::int64_t>(motion), raw_.where, raw_.path + ".generate.seed"});
      set(made, "generate", as_raw(std::move(generate), raw_));
    }
    return as_raw(std::move(made), raw_);
  }

  const StudyManyMotions& given_;
  const Raw& raw_;
};

// ---- one motion ----

std::string absolute_beside(const Where& where, const std::string& file) {
  return std::filesystem::absolute(path_beside(where, file)).lexically_normal().string();
}

/// Every path of a file in the case, absolute.
std::vector<CaseEdit> absolute_files(const Case& read) {
  const CaseInput& input = *read.input;
  std::vector<CaseEdit> edits;
  const auto add = [&](const std::string& path, const std::optional<NameUsed>& file) {
    if (file) edits.push_back({path, absolute_beside(file->where(), file->name)});
  };
  for (std::size_t i = 0; i < input.records.size(); ++i)  // those of the plan have a path there
    add(fmt::format("record[{}].file", i), input.records[i].file);
  for (const CaseFunction& function : input.functions) add(function.shape->path("file"), function.file);
  if (input.mesh) add(input.mesh->path("file"), input.mesh->file);
  if (input.reduced_model) edits.push_back({"reduced_model", absolute_beside(read.values.where("reduced_model"), *input.reduced_model)});
  return edits;
}

/// What multiplies a function that drives, times the factor.
CaseEdit louder(const DrivenBy& place, double factor) {
  return {place.function.table->path(place.key), place.factor * factor};
}

}  // namespace

Raw with_motions(const Raw& raw, const std::vector<StudyManyMotions>& many, const Raw& plan) {
  RawTable root = copy_of(raw);
  const RawTable given = copy_of(plan);
  RawList records = list_at(root, "record"), motions = list_at(given, "motion");
  for (const Raw& record : list_at(given, "record")) records.push_back(record);
  const RawList as_read = list_at(given, "motions");
  for (std::size_t k = 0; k < many.size(); ++k) ManyMotions(many[k], as_read[k]).add(records, motions);
  if (!records.empty()) set(root, "record", {std::move(records), raw.where, "record"});
  if (!motions.empty()) {
    const Raw* old = root.find("compare");
    RawTable compare = old != nullptr ? copy_of(*old) : RawTable{};
    set(compare, "motion", {std::move(motions), plan.where, "motion"});
    set(root, "compare", as_raw(std::move(compare), old != nullptr ? *old : plan));
  }
  return as_raw(std::move(root), raw);
}

Raw with_one_motion(const Raw& raw, const Case& read, const CaseOtherMotion* motion, double factor) {
  std::vector<CaseEdit> edits = absolute_files(read);
  std::set<std::string> drives;
  for (const DrivenBy& place : motions_wanted(read)) {
    const std::string& name = name_taken(motion, place.function.name);
    if (motion != nullptr) edits.push_back({place.function.path(), name});
    if (std::ranges::find(read.records, name, &CaseRecord::name) != read.records.end())
      drives.insert(name);
    else if (factor != 1 && !place.rotates)
      edits.push_back(louder(place, factor));
  }
  RawTable made = copy_of(edited(raw, edits));
  std::erase_if(made.entries, [](const auto& entry) { return entry.first == "compare" || entry.first == "variant"; });
  RawList records = list_at(made, "record");
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (factor == 1 || !drives.contains(read.records[i].name)) continue;
    const auto put = [&](auto value) { return Raw{std::move(value), raw.where, "record"}; };
    RawTable scale, step, record = copy_of(records[i]);
    set(scale, "type", put(std::string("scale")));
    set(scale, "factor", put(factor));
    set(step, "do", put(std::make_shared<RawTable>(std::move(scale))));
    RawList process = list_at(record, "process");
    process.push_back(put(std::make_shared<RawTable>(std::move(step))));
    set(record, "process", put(std::move(process)));
    records[i] = as_raw(std::move(record), records[i]);
  }
  if (!records.empty()) set(made, "record", {std::move(records), raw.where, "record"});
  return as_raw(std::move(made), raw);
}

}  // namespace uplift
