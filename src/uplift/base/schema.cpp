#include <cmath>
#include <nlohmann/json.hpp>

#include "uplift/base/declare.h"
#include "uplift/base/text.h"

// JSON Schema (draft 2020-12) of a declaration, for editors and for machines that write case files.
// It cannot say everything: bounds hold for bare numbers only, and the unit of a text is not checked.
namespace uplift {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* number_pattern = R"([ \t]*[-+]?([0-9]|\.[0-9]).*)";

Json object_of(const std::vector<Field>& fields, std::string_view type = {}, bool names_type = true);

void add_bounds(Json& schema, const Field& field) {
  if (std::isfinite(field.least)) schema[field.least_excluded ? "exclusiveMinimum" : "minimum"] = field.least;
  if (std::isfinite(field.most)) schema[field.most_excluded ? "exclusiveMaximum" : "maximum"] = field.most;
}

/// A bare number in SI, a text with a unit, or one of the words.
Json number_schema(const Field& field) {
  std::string pattern = number_pattern;
  for (const std::string_view word : field.words) pattern += "|" + std::string(word);
  Json schema{{"type", {"number", "string"}}, {"pattern", "^(" + pattern + ")$"}};
  add_bounds(schema, field);
  return schema;
}

Json entries_of(const Field& field) {
  Field one = field;
  one.kind = Kind::number;
  Json schema{{"type", "array"}, {"items", number_schema(one)}};
  if (field.size > 0) {
    schema["minItems"] = field.size;
    schema["maxItems"] = field.most_size;
  }
  return schema;
}

/// One alternative per part, told apart by `type`; the bare names of those that need no parameter.
Json part_of(const Field& field) {
  Json names = Json::array(), alternatives = Json::array();
  for (const PartInfo* info : field.parts()) {
    bool needs = false;
    for (const Field& parameter : info->params) needs = needs || parameter.required;
    if (!needs) names.push_back(info->name);
    Json alternative = object_of(info->params, info->name, info->name != field.type);
    alternative["description"] = info->summary;
    alternatives.push_back(std::move(alternative));
  }
  if (!names.empty()) alternatives.insert(alternatives.begin(), Json{{"type", "string"}, {"enum", std::move(names)}});
  return {{"oneOf", std::move(alternatives)}};
}

Json named_of(const Section& section) {
  const Json entry = object_of(section.fields);
  Json schema{{"type", "object"}};
  const bool bare = section.fields.size() == 1 && section.fields.front().name == "value";
  schema["additionalProperties"] = bare ? Json{{"anyOf", {entry["properties"]["value"], entry}}} : entry;
  return schema;
}

Json shape_of(const Field& field) {
  switch (field.kind) {
    case Kind::number:
      return number_schema(field);
    case Kind::integer: {
      Json schema{{"type", "integer"}};
      add_bounds(schema, field);
      return schema;
    }
    case Kind::flag:
      return {{"type", "boolean"}};
    case Kind::text:
      if (field.unit == "*") return {{"type", {"number", "string"}}};
      return {{"type", "string"}};
    case Kind::choice:
      return {{"enum", field.choices}};
    case Kind::numbers:
      return entries_of(field);
    case Kind::texts:
      return {{"type", "array"}, {"items", {{"type", "string"}}}};
    case Kind::table:
      return object_of(field.section->fields);
    case Kind::tables:
      return {{"type", "array"}, {"items", object_of(field.section->fields)}};
    case Kind::named:
      return named_of(*field.section);
    case Kind::part:
      return part_of(field);
  }
  return {};
}

Json schema_of(const Field& field) {
  Json schema = shape_of(field);
  std::string description(field.meaning);
  if (!field.unit.empty() && field.unit != "1") description += " [" + std::string(field.unit) + "]";
  if (const std::string bounds = bounds_text(field); !bounds.empty()) description += ", " + bounds;
  schema["description"] = description;
  if (field.standard_number && field.kind == Kind::integer) schema["default"] = static_cast<std::int64_t>(*field.standard_number);
  if (field.standard_number && field.kind == Kind::number) schema["default"] = *field.standard_number;
  if (field.standard_flag) schema["default"] = *field.standard_flag;
  if (field.standard_text) schema["default"] = *field.standard_text;
  return schema;
}

/// A table that is absent takes its defaults, so it is required only when one of its keys has none.
bool must_be_given(const Field& field) {
  if (!field.required || field.kind != Kind::table) return field.required;
  for (const Field& inner : field.section->fields)
    if (must_be_given(inner)) return true;
  return false;
}

Json object_of(const std::vector<Field>& fields, std::string_view type, bool names_type) {
  Json properties = Json::object(), required = Json::array();
  if (!type.empty()) {
    properties["type"] = {{"const", type}};
    if (names_type) required.push_back("type");
  }
  for (const Field& field : fields) {
    properties[std::string(field.name)] = schema_of(field);
    if (must_be_given(field)) required.push_back(field.name);
  }
  Json schema{{"type", "object"}, {"properties", std::move(properties)}};
  if (!required.empty()) schema["required"] = std::move(required);
  schema["additionalProperties"] = false;
  return schema;
}

}  // namespace

std::string to_json_schema(const Section& section) {
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", section.name}, {"description", section.meaning}};
  schema.update(object_of(section.fields));
  return schema.dump(2) + "\n";
}

}  // namespace uplift
