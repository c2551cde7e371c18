#include <fmt/format.h>

#include "uplift/case/schema/case_input.h"
#include "uplift/elements/element_entry.h"
#include "uplift/io/report/motions.h"

// The tables of the motions, and where the values of the case come from.
namespace uplift {
namespace {

/// One value of the case that the user wrote: the key under which an origin may name it, and the value.
struct Given {
  std::string key, value;
};

/// ".column": how an entry of a list of tables is told from the others in a key.
std::string entry_name(const Values& entry, Kind kind, std::size_t index) {
  if (kind == Kind::named) return "." + entry.key();
  if (kind != Kind::tables) return "";
  for (const char* key : {"name", "node"})
    if (entry.items().contains(key) && entry.has(key)) return "." + entry.text(key);
  return "." + std::to_string(index + 1);
}

std::string value_text(const Values::Item& item, const Field& field) {
  const std::string unit = field.unit.empty() || field.unit == "1" ? "" : " " + std::string(field.unit);
  if (const auto* flag = std::get_if<bool>(&item.data)) return *flag ? "true" : "false";
  if (const auto* whole = std::get_if<std::int64_t>(&item.data)) return fmt::format("{}", *whole);
  if (const auto* real = std::get_if<double>(&item.data)) return fmt::format("{:.10g}{}", *real, unit);
  if (const auto* text = std::get_if<std::string>(&item.data)) return *text;
  if (const auto* list = std::get_if<std::vector<double>>(&item.data))
    return list->empty() ? "" : fmt::format("[{:.10g}]{}", fmt::join(*list, ", "), unit);
  return "";
}

/// All given numbers of a table and of the tables and parts in it. `path`: by names ("beam.column"), as far as there are names.
void collect(const Values& values, const std::string& path, std::vector<Given>& given) {
  const std::vector<Field>& fields = values.section() ? values.section()->fields : values.part_info()->params;
  const bool bare_value = fields.size() == 1 && fields.front().name == "value";  // name = [x, y]
  for (const Field& field : fields) {
    if (!values.given(field.name)) continue;
    const Values::Item& item = values.items().at(std::string(field.name));
    const std::string key = path.empty() ? std::string(field.name) : path + "." + std::string(field.name);
    if (const auto* tables = std::get_if<std::vector<Values>>(&item.data)) {
      for (std::size_t i = 0; i < tables->size(); ++i) {
        const Values& inner = (*tables)[i];
        const std::string name = entry_name(inner, field.kind, i);
        if (field.kind == Kind::part) given.push_back({key, inner.type()});
        collect(inner, key + name, given);
      }
      continue;
    }
    if (field.kind == Kind::text || field.kind == Kind::texts) continue;
    given.push_back({bare_value ? path : key, value_text(item, field)});
  }
}

bool covers(const std::string& key, const std::string& path) {
  return key == path || (path.size() > key.size() && path.starts_with(key) && path[key.size()] == '.');
}

}  // namespace

void write_column(JsonWriter& json, const TableColumn& column) {
  json.begin_object().member("key", column.key).member("label", column.label).member("unit", column.unit).member("kind", column.kind);
  if (column.digits > 0) json.member("digits", column.digits);
  json.end_object();
}

void write_tables(JsonWriter& json, const ReportInput& input) {
  json.begin_array();
  write_motion_tables(json, input);
  json.end_array();
}

void write_choices(JsonWriter& json, const Case& read, const BuiltCase& built) {
  std::vector<Given> given;
  std::vector<std::string_view> tables{"nodes"};
  for (const ElementPlace place : {ElementPlace::lines, ElementPlace::nodes}) {
    for (const ElementEntry* element : elements_at(place)) tables.push_back(element->name);
    if (place == ElementPlace::lines) tables.emplace_back("mass");
  }
  for (const char* table : {"rigid", "interface", "gravity", "function", "record", "load", "motion", "ground_acceleration", "initial",
                            "damping", "stage", "compare"})
    tables.emplace_back(table);
  for (const std::string_view table : tables) {
    const Field* field = nullptr;
    for (const Field& each : read.values.section()->fields)
      if (each.name == table) field = &each;
    if (!field || !read.values.given(table)) continue;
    for (std::size_t i = 0; i < read.values.tables(table).size(); ++i) {
      const Values& inner = read.values.tables(table)[i];
      collect(inner, std::string(table) + entry_name(inner, field->kind, i), given);
    }
  }
  json.begin_array();
  for (const Given& each : given) {
    std::string origin = "user", note;
    for (const CaseOrigin& stated : read.input->origins)
      for (const std::string& key : stated.keys)
        if (covers(key, each.key) || (key == "*" && origin == "user")) {
          origin = stated.label;
          note = key != "*" ? stated.note : "";
        }
    json.begin_object().member("what", each.key).member("value", each.value).member("origin", origin).member("note", note).end_object();
  }
  for (const std::string& text : built.notes)
    json.begin_object().member("what", "automatic").member("value", text).member("origin", "computed").end_object();
  json.end_array();
}

}  // namespace uplift
