#include <fmt/format.h>

#include "uplift/case/schema/record_sections.h"
#include "uplift/study/schema/plan_sections.h"

namespace uplift {

const Section& plan_motion_section() {
  static const Section s{
      "motion",
      "a motion of the study: records that take the places of others, one for each component. Without [[motion]] and "
      "[[motions]] the study has those of [[compare.motion]] of the case, and without these its own motion alone",
      {text("name", "name"), text("label", "as shown").optional(), texts("replace", "names of records or functions that drive the case"),
       texts("by", "names of the records that take their places, in the same order; of the case or of the plan")}};
  return s;
}

const Section& motions_section() {
  static const Section s = [] {
    Section made{"motions", "many motions at once: from files, or generated for a target spectrum", {}};
    made.fields = {text("name", "beginning of their names: NAME-1, NAME-2, ..."),
                   texts("replace", "names of records or functions that drive the case, one for each component"),
                   texts("files", "files of the records; of several components the files of one motion stand side by side").optional(),
                   integer("count", "number of generated motions").between(1, 100000).optional()};
    for (const Field& field : record_section().fields) {
      if (field.name == "name" || field.name == "file" || field.name == "component") continue;
      made.fields.push_back(field);
      if (field.name == "generate") {
        made.fields.back().kind = Kind::tables;
        made.fields.back().required = false;
        made.fields.back().meaning =
            "a target and times for each component in the order of `replace`; motion i has the seed `seed` + i - 1";
      }
    }
    return made;
  }();
  return s;
}

StudyManyMotions many_motions_of(const Values& table) {
  StudyManyMotions made{table.text("name"), table.texts("replace"), table.texts("files"), 0, {}};
  if (made.replace.empty()) fail(table, "replace", "one name at least", "none");
  const bool files = first_of_two(table, "files", "count");
  const std::vector<Values>& generate = table.tables("generate");
  if (!files && generate.size() != made.replace.size())
    fail(table, "generate", fmt::format("as many as names in replace ({})", made.replace.size()), fmt::format("{}", generate.size()));
  if (files && !generate.empty()) fail(table, "generate", "either files or generate", "both");
  const std::size_t given = made.files.size();
  if (files && (given == 0 || given % made.replace.size() != 0))
    fail(table, "files", fmt::format("a file for each of the {} names in replace, motion by motion", made.replace.size()),
         fmt::format("{} files", given));
  made.count = files ? given / made.replace.size() : static_cast<std::size_t>(table.integer("count"));
  for (const Values& each : generate) made.seeds.push_back(each.integer("seed"));
  return made;
}

}  // namespace uplift
