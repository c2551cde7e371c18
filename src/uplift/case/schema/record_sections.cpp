#include "uplift/case/schema/record_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "uplift/motion/generate.h"
#include "uplift/motion/processing/processing.h"

namespace uplift {
namespace {

const Section& process_section() {
  static const Section s{"process", "a step of the processing of a record", {part("do", motion_processes, "what is done")}};
  return s;
}

const Section& generate_record_section() {
  static const Section s = [] {
    Section made = generate_section();
    made.meaning = "an acceleration made to have a target spectrum; records with the same seed are statistically independent of each other";
    made.fields.insert(made.fields.begin(), part("target", target_spectra, "the spectrum"));
    return made;
  }();
  return s;
}

/// Path of a record's file that can be opened from here.
std::string location_of(const Values& record) {
  const std::filesystem::path given = record.text("file");
  const std::filesystem::path folder = std::filesystem::path(record.where().file).parent_path();
  return (given.is_absolute() ? given : folder / given).lexically_normal().string();
}

std::vector<const Values*> processes_of(const Values& record) {
  std::vector<const Values*> made;
  for (const Values& step : record.tables("process")) made.push_back(&step.part("do"));
  return made;
}

}  // namespace

const Section& record_section() {
  static const Section s{
      "record",
      "a motion of the ground, from a file or generated. Its name stands wherever that of a function can: ground_acceleration takes its "
      "acceleration, an "
      "incident wave its velocity, a prescribed motion its displacement, by exact integration",
      {text("name", "name, different from those of functions"),
       text("file", "path, relative to the case file: AT2, ESM, K-NET, COSMOS, SMC, text with columns ...; or give generate").optional(),
       table("generate", generate_record_section(), "make it instead of reading it").optional(),
       text("format", "name of the reader; absent: found by content").optional(),
       text("unit", "of the numbers in the file (\"g\", \"cm/s2\"); absent: as the file says").optional(),
       number("step", "s", "of files without times").positive().optional(),
       text("column", "of tables: name, or number from 1; absent: all that their head gives a unit, else the first after the time")
           .optional(),
       text("component", "which one, when the file has several: its name as the file has it, or its number from 1").optional(),
       tables("process", process_section(), "steps between the record as read and what drives the model, in order")}};
  return s;
}

CaseRecordSource case_record(const Values& table) {
  const Values* generate = table_if(table, "generate");
  if (first_of_two(table, "file", "generate"))
    return {{&table},
            name_used(table, "name"),
            name_used(table, "file"),
            location_of(table),
            {text_or(table, "format", ""), text_or(table, "unit", ""), number_if(table, "step"), text_or(table, "column", "")},
            name_if(table, "component"),
            {},
            processes_of(table)};
  for (const char* key : {"format", "unit", "step", "column", "component"})
    if (table.has(key)) fail(table, key, "a key of generate", fmt::format("{}, which is for files", key));
  return {{&table}, name_used(table, "name"), {}, {}, {}, {}, CaseGenerated{{generate}, &generate->part("target")}, processes_of(table)};
}

CaseNamed case_named(const Values& table) {
  return {{&table}, name_used(table, "name"), text_or(table, "label", table.text("name"))};
}

const Section& compare_motion_section() {
  static const Section s{
      "motion",
      "for `uplift compare`: a further motion. Every variant, or the case itself when there are none, and the bonded model are run with "
      "the motion of the case and with every further one. The report shows the most demanding of them for the first variant, with the mean "
      "and the envelope of all. A table that replaces every name by itself only gives the motion of the case a name and a label",
      {text("name", "name, part of the names of the runs"), text("label", "as shown").optional(),
       texts("replace", "names of records or functions that drive the case"),
       texts("by", "names of the records that take their places, in the same order")}};
  return s;
}

CaseOtherMotion case_other_motion(const Values& table) {
  return {case_named(table), table.texts("replace"), table.texts("by")};
}

const std::string& CaseOtherMotion::taken(const std::string& asked) const {
  const auto found = std::ranges::find(replace, asked);
  return found == replace.end() ? asked : by[static_cast<std::size_t>(found - replace.begin())];
}

}  // namespace uplift
