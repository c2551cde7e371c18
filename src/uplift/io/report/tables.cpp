#include <fmt/format.h>

#include <cmath>

#include "uplift/case/build/model.h"
#include "uplift/elements/element_entry.h"
#include "uplift/io/report/motions.h"

// The tables: all runs side by side, the stiffness sweep, and where the values come from.
namespace uplift {
namespace {

void write_run_row(JsonWriter& json, const ReportInput& input, std::size_t i) {
  const RunResult& run = *input.runs[i].result;
  const BuiltCase& built = *input.runs[i].built;
  json.begin_object().member("group", run.group).member("run", run.label).member("name", run.name);
  json.member("status",
              std::string(to_string(run.status)) + (run.expected_to_fail && run.status == RunStatus::failed ? " (expected)" : ""));
  const std::optional<Peak> top = top_motion(built, run);
  if (top) json.member("top", std::abs(top->value)).member("top_time", top->time);
  if (!input.runs[i].spec->bonded)  // a bonded base stretches instead of opening
    json.member("ratio", run.max_uplifted_ratio.value)
        .member("opening", run.max_opening.value < nothing_beside("m") ? 0 : run.max_opening.value);
  json.member("moment", std::abs(run.max_base_moment.value));
  json.member("pressure", run.max_pressure.value).member("created", created_share(run)).member("retries", run.counts.retries);
  json.member("wall", run.wall).member("per_step", run.counts.steps > 0 ? run.wall / static_cast<double>(run.counts.steps) * 1e6 : 0.0);
  if (input.compared) {
    const Agreement& agreement = input.compared->agreement[i];
    json.member("agreement", to_string(agreement.word));
    if (agreement.word == Agreement::Word::agrees || agreement.word == Agreement::Word::differs)
      json.member("deviation", agreement.deviation);
  }
  json.end_object();
}

void write_runs(JsonWriter& json, const ReportInput& input) {
  json.begin_object().member("id", "runs").member("title", input.compared ? "Comparison of all runs" : "Runs");
  std::string caption = "Largest magnitudes. Spurious energy: energy created by the computation, divided by the external work.";
  if (input.compared)
    caption += fmt::format(" Runs that passed all checks agree when {} lie within {:g} % of the median of their group.",
                           compared_text(input.compared->columns), 100 * input.compared->band);
  json.member("caption", caption).key("columns").begin_array();
  for (const TableColumn& column : {TableColumn{"run", "Run", "", "text", 0}, {"status", "Status", "", "status", 0}})
    write_column(json, column);
  if (input.compared) {
    write_column(json, {"agreement", "Agreement", "", "status", 0});
    write_column(json, {"deviation", "Deviation", "", "percent", 2});
  }
  for (const TableColumn& column : {TableColumn{"top", "Top motion", "m", "number", 4},
                                    {"top_time", "at time", "s", "number", 4},
                                    {"ratio", "Uplifted", "", "percent", 3},
                                    {"opening", "Gap", "m", "number", 4},
                                    {"moment", "Base moment", "N m", "number", 4},
                                    {"pressure", "Pressure", "Pa", "number", 4},
                                    {"created", "Spurious energy", "", "percent", 3}})
    write_column(json, column);
  write_column(json, {"retries", "Retries", "", "number", 6});
  write_column(json, {"per_step", "Time per step (µs)", "", "number", 3});
  json.end_array().key("rows").begin_array();
  for (std::size_t i = 0; i < input.runs.size(); ++i) write_run_row(json, input, i);
  json.end_array();
  if (!input.runs.front().result->group.empty()) json.member("rowGroup", "group");
  json.end_object();
}

void write_sweep(JsonWriter& json, const std::vector<SweepRow>& rows) {
  if (rows.empty()) return;
  json.begin_object().member("id", "sweep").member("title", "Spurious energy against the stiffness of the joint");
  json.member("caption",
              "Largest spurious energy divided by the external work. The stiffness ratio k F belongs to the stiffest interface point and "
              "the time step.")
      .key("columns")
      .begin_array();
  for (const TableColumn& column : {TableColumn{"ratio", "k F", "", "number", 3},
                                    {"path", "Path average", "", "percent", 3},
                                    {"path_status", "Status", "", "status", 0},
                                    {"end", "End of step", "", "percent", 3},
                                    {"end_status", "Status", "", "status", 0}})
    write_column(json, column);
  json.end_array().key("rows").begin_array();
  for (const SweepRow& row : rows)
    json.begin_object()
        .member("ratio", row.ratio)
        .member("path", row.path)
        .member("path_status", row.path_status)
        .member("end", row.end)
        .member("end_status", row.end_status)
        .end_object();
  json.end_array().end_object();
}

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
  write_runs(json, input);
  write_motion_tables(json, input);
  write_floor_table(json, input);
  if (input.trust) write_trust_tables(json, *input.trust);
  if (input.compared) write_sweep(json, input.compared->sweep);
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
    for (const Values& stated : read.values.tables("origin"))
      for (const std::string& key : stated.texts("keys"))
        if (covers(key, each.key) || (key == "*" && origin == "user")) {
          origin = stated.text("label");
          note = key != "*" && stated.has("note") ? stated.text("note") : "";
        }
    json.begin_object().member("what", each.key).member("value", each.value).member("origin", origin).member("note", note).end_object();
  }
  for (const std::string& text : built.notes)
    json.begin_object().member("what", "automatic").member("value", text).member("origin", "computed").end_object();
  json.end_array();
}

}  // namespace uplift
