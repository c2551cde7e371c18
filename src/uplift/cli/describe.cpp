#include <fmt/format.h>

#include <algorithm>

#include "uplift/case/schema/sections.h"
#include "uplift/case/schema/verdict_quantities.h"
#include "uplift/cli/commands.h"
#include "uplift/cli/console.h"
#include "uplift/contact/impact/impact.h"
#include "uplift/contact/method.h"
#include "uplift/dynamics/scheme.h"
#include "uplift/elements/bulk_law.h"
#include "uplift/elements/element_entry.h"
#include "uplift/laws/law.h"
#include "uplift/linear/solver.h"
#include "uplift/model/function.h"
#include "uplift/motion/formats/record_format.h"
#include "uplift/motion/generate.h"
#include "uplift/motion/processing/processing.h"
#include "uplift/motion/target.h"
#include "uplift/study/schema/study_plan.h"

namespace uplift::cli {
namespace {

struct Family {
  const char *name, *meaning;
  std::span<const PartInfo* const> parts;
};

std::vector<Family> families() {
  return {{"law", "what an interface does: traction laws, and cones (contact by constraint)", interface_behaviours()},
          {"foundation", "what the ground under a whole footing does: [[foundation]]", foundation_models()},
          {"bulk_law", "what a solid is made of: stress from strain", bulk_laws()},
          {"element", "elements: tables [[beam]], [[spring]], [[dashpot]], [[solid]], [[absorbing]], ...", element_kinds()},
          {"method", "how the interface problem of a step is solved", contact_methods()},
          {"impact", "velocity corrections on impact, for constraints", impact_rules()},
          {"scheme", "time integration", schemes()},
          {"function", "functions of time", time_functions()},
          {"record", "formats of recorded ground motions, found by content", record_formats()},
          {"process", "processing steps of ground motions", motion_processes()},
          {"target", "target spectra of generated motions", target_spectra()},
          {"study_method", "which intensities a study runs", study_methods()},
          {"distribution", "distributions of the variables of a study", study_distributions()},
          {"solver", "factorisation of the structure's matrices", linear_solvers()}};
}

/// A table of the case file with its path: "interface.footing.bed".
struct Place {
  std::string path;
  const Section* section;
  Kind kind;
};

void collect(const Section& section, const std::string& path, std::vector<Place>& places) {
  for (const Field& field : section.fields) {
    if (!field.section) continue;
    const std::string inner = path.empty() ? std::string(field.name) : path + "." + std::string(field.name);
    places.push_back({inner, field.section, field.kind});
    collect(*field.section, inner, places);
  }
}

std::vector<Place> places() {
  std::vector<Place> all{{"case", &case_section(), Kind::table}};
  collect(case_section(), "", all);
  all.push_back({"generate", &generate_section(), Kind::table});
  all.push_back({"study", &study_section(), Kind::table});
  collect(study_section(), "study", all);
  return all;
}

std::string unit_of(const Field& field) {
  return field.unit.empty() || field.unit == "1" ? "-" : std::string(field.unit);
}

std::string default_of(const Field& field) {
  std::string text = standard_text(field);
  if (!text.empty()) return text;
  return field.required && field.kind != Kind::tables && field.kind != Kind::table ? "needed" : "-";
}

std::string range_of(const Field& field) {
  switch (field.kind) {
    case Kind::choice: {
      std::string text;
      for (const std::string_view word : field.choices) text += (text.empty() ? "" : " | ") + std::string(word);
      return text;
    }
    case Kind::flag:
      return "true | false";
    case Kind::text:
      return "text";
    case Kind::texts:
      return "list of texts";
    case Kind::numbers:
      return field.size > 0 ? "list of " + size_text(field) : "list";
    case Kind::table:
      return "[table]";
    case Kind::tables:
      return "[[table]], any number";
    case Kind::named:
      return "[table] of names";
    case Kind::part:
      return "part, see below";
    default:
      break;
  }
  const std::string bounds = bounds_text(field);
  return bounds.empty() ? "any" : bounds;
}

void print_fields(const std::vector<Field>& fields) {
  if (fields.empty()) {
    say("  no parameters");
    return;
  }
  std::vector<std::vector<std::string>> rows{{"  key", "unit", "default", "range", "meaning"}};
  for (const Field& field : fields)
    rows.push_back({"  " + std::string(field.name), unit_of(field), default_of(field), range_of(field), std::string(field.meaning)});
  print_table(rows);
}

void print_indented(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    say("  " + std::string(text.substr(0, end)));
    text = end == text.npos ? std::string_view() : text.substr(end + 1);
  }
}

void print_part(const Family& family, const PartInfo& part) {
  say(fmt::format("{} {}: {}", family.name, part.name, part.summary));
  say("\nequations");
  print_indented(part.equations);
  say("\nparameters");
  print_fields(part.params);
  say("\nsource\n  " + std::string(part.source));
}

void print_family(const Family& family) {
  std::vector<std::vector<std::string>> rows;
  for (const PartInfo* part : family.parts) rows.push_back({"  " + std::string(part->name), std::string(part->summary)});
  say(fmt::format("{}: {}", family.name, family.meaning));
  print_table(rows);
}

void print_sections() {
  std::vector<std::vector<std::string>> rows;
  for (const Place& place : places()) rows.push_back({"  " + place.path, std::string(place.section->meaning)});
  say("section: tables of the case file, and of the plan of a study");
  print_table(rows);
}

std::string head_of(const Place& place) {
  if (place.path == "case") return "the keys at the top of a case file";
  if (place.section == &study_section()) return "the keys at the top of plan.toml of a study";
  if (place.path.starts_with("study."))
    return (place.kind == Kind::tables ? "[[" + place.path.substr(6) + "]]" : "[" + place.path.substr(6) + "]") + " of plan.toml";
  if (place.section == &generate_section()) return "KEY=VALUE words of uplift motion --generate";
  return place.kind == Kind::tables ? "[[" + place.path + "]]" : "[" + place.path + "]";
}

/// The parts that a key takes, with their parameters and defaults, and where more is said of them.
void print_choices(const Field& field) {
  std::vector<std::vector<std::string>> rows;
  for (const PartInfo* part : field.parts()) {
    std::string keys;
    for (const Field& key : part->params) {
      keys += (keys.empty() ? "" : ", ") + std::string(key.name);
      if (key.unit != "1" && !key.unit.empty()) keys += fmt::format(" [{}]", key.unit);
      if (const std::string standard = standard_text(key); !standard.empty()) keys += " = " + standard;
    }
    rows.push_back({"  " + std::string(part->name), keys.empty() ? "no parameters" : keys});
  }
  say(fmt::format("\n{} = {{ type = ..., ... }}: one of these, with their parameters and defaults", field.name));
  print_table(rows);
  for (const Family& family : families())
    if (family.parts.data() == field.parts().data()) say(fmt::format("more: uplift describe {} {}", family.name, field.parts()[0]->name));
}

/// The numbers of the verdict: what a criterion may limit and summary.json contains.
int describe_quantities(const std::string& name) {
  std::vector<std::vector<std::string>> rows{{"  quantity", "unit", "of", "limit", "meaning"}};
  std::vector<std::string> known;
  for (const VerdictQuantity& each : verdict_quantities) {
    known.emplace_back(each.name);
    if (!name.empty() && each.name != name) continue;
    std::string of = each.of_beam() ? "beam" : "run";
    if (each.of_interface()) of = !each.of_wall() ? "base" : each.of_base() ? "base, wall" : "wall";
    rows.push_back(
        {"  " + std::string(each.name), std::string(each.unit), of, each.at_least ? "at least" : "at most", std::string(each.meaning)});
  }
  if (rows.size() == 1)
    throw InputError({"uplift describe quantity", 0}, "", "a number of the verdict", "\"" + name + "\"", nearest_name(name, known));
  if (name.empty()) say("quantity: numbers of the verdict, in summary.json and for [[verdict.criterion]]");
  print_table(rows);
  return Exit::done;
}

int describe_section(const std::string& name) {
  std::vector<std::string> known;
  for (const Place& place : places()) {
    known.push_back(place.path);
    const std::string last = place.path.substr(place.path.rfind('.') + 1);
    if (place.path != name && last != name) continue;
    say(fmt::format("section {}: {}\n{}\n", place.path, place.section->meaning, head_of(place)));
    print_fields(place.section->fields);
    for (const Field& field : place.section->fields)
      if (field.parts) print_choices(field);
    return Exit::done;
  }
  throw InputError({"uplift describe section", 0}, "", "a table of the case file", "\"" + name + "\"", nearest_name(name, known));
}

/// Every part of this name, or else the table or the number of the verdict. False when there is none.
bool describe_name(const std::string& name, const std::vector<Family>& all) {
  int found = 0;
  for (const Family& family : all) {
    for (const PartInfo* part : family.parts) {
      if (part->name != name) continue;
      if (found++ > 0) say("");
      print_part(family, *part);
    }
  }
  if (found > 0) return true;  // the table [[beam]] has the keys of the element
  for (const Place& place : places())
    if (place.path == name || place.path.ends_with("." + name)) return describe_section(name), true;
  for (const VerdictQuantity& quantity : verdict_quantities)
    if (quantity.name == name) return describe_quantities(name), true;
  return false;
}

/// All names that describe_name knows, for the nearest one.
std::vector<std::string> all_names(const std::vector<Family>& all) {
  std::vector<std::string> names;
  for (const Family& family : all)
    for (const PartInfo* part : family.parts) names.emplace_back(part->name);
  for (const Place& place : places()) names.push_back(place.path.substr(place.path.rfind('.') + 1));
  for (const VerdictQuantity& quantity : verdict_quantities) names.emplace_back(quantity.name);
  return names;
}

}  // namespace

int describe(const std::string& family, const std::string& name) {
  const std::vector<Family> all = families();
  if (family.empty()) {
    for (const Family& each : all) {
      print_family(each);
      say("");
    }
    print_sections();
    say("\nmore: uplift describe law sdm; uplift describe section beam; uplift describe quantity");
    return Exit::done;
  }
  if (family == "section") {
    if (name.empty())
      print_sections();
    else
      return describe_section(name);
    return Exit::done;
  }
  if (family == "quantity") return describe_quantities(name);
  std::vector<std::string> known{"section", "quantity"};
  for (const Family& each : all) {
    known.emplace_back(each.name);
    if (each.name != family) continue;
    if (name.empty()) {
      print_family(each);
      return Exit::done;
    }
    std::vector<std::string> parts;
    for (const PartInfo* part : each.parts) {
      parts.emplace_back(part->name);
      if (part->name != name) continue;
      print_part(each, *part);
      return Exit::done;
    }
    throw InputError({"uplift describe " + family, 0}, "", "the name of a " + family + " (`uplift describe " + family + "` lists them)",
                     "\"" + name + "\"", nearest_name(name, parts));
  }
  if (name.empty() && describe_name(family, all)) return Exit::done;
  const std::string wanted =
      fmt::format("one of {}", fmt::join(known, ", ")) + (name.empty() ? ", or the name of a part, table or quantity" : "");
  if (name.empty())
    for (std::string& each : all_names(all)) known.push_back(std::move(each));
  throw InputError({"uplift describe", 0}, "", wanted, "\"" + family + "\"", nearest_name(family, known));
}

}  // namespace uplift::cli
