#include "uplift/io/results/result_writer.h"

#include <nlohmann/json.hpp>
#include <utility>

namespace uplift {

using Json = nlohmann::ordered_json;

/// The schema as far as it is made: the object that is open, in those around it.
struct ResultWriter::Schema {
  struct Level {
    std::string key, meaning, kind, unit;
    Shape shape = Shape::object;
    bool required = true;
    Json object{{"type", "object"}, {"properties", Json::object()}, {"required", Json::array()}, {"additionalProperties", false}};
  };
  std::vector<Level> open{1};
  Json kinds = Json::object();  // by name
  bool required = true;         // the next member

  void put(std::string_view key, Json schema, std::string_view meaning) {
    schema["description"] = meaning;
    Json& object = open.back().object;
    object["properties"][std::string(key)] = std::move(schema);
    if (std::exchange(required, true)) object["required"].push_back(key);
  }
  void put_number(std::string_view key, Json schema, std::string_view unit, std::string_view meaning) {
    schema["unit"] = unit;
    put(key, std::move(schema), meaning);
  }
};

namespace {

/// An object with one member.
Json with(const char* key, Json value) {
  Json made = Json::object();
  made[key] = std::move(value);
  return made;
}

Json number_or_null_schema() {
  return with("type", Json::array({"number", "null"}));
}

Json array_of(Json items) {
  return {{"type", "array"}, {"items", std::move(items)}};
}

}  // namespace

ResultWriter::ResultWriter(JsonWriter& json) : json_(&json) {}

ResultWriter::ResultWriter(std::string_view title, std::string_view meaning) : schema_(std::make_unique<Schema>()) {
  schema_->open.front().key = title;
  schema_->open.front().meaning = meaning;
}

ResultWriter::~ResultWriter() = default;

std::string ResultWriter::schema() const {
  const Schema::Level& root = schema_->open.front();
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", root.key}, {"description", root.meaning}};
  schema.update(root.object);
  if (!schema_->kinds.empty()) schema["$defs"] = schema_->kinds;
  return schema.dump(2);
}

ResultWriter& ResultWriter::when(bool present) {
  present_ = present;
  if (is_schema()) schema_->required = false;
  return *this;
}

bool ResultWriter::takes(std::string_view key) {
  const bool present = std::exchange(present_, true);
  if (present) json_->key(key);
  return present;
}

void ResultWriter::text(std::string_view key, std::string_view value, std::string_view meaning) {
  if (is_schema())
    schema_->put(key, with("type", "string"), meaning);
  else if (takes(key))
    json_->value(value);
}

void ResultWriter::texts(std::string_view key, const std::vector<std::string>& values, std::string_view meaning) {
  if (is_schema())
    schema_->put(key, array_of(with("type", "string")), meaning);
  else if (takes(key))
    json_->texts(values);
}

void ResultWriter::word(std::string_view key, std::string_view value, std::vector<std::string_view> words, std::string_view meaning) {
  if (is_schema())
    schema_->put(key, with("enum", std::move(words)), meaning);
  else if (takes(key))
    json_->value(value);
}

void ResultWriter::constant(std::string_view key, std::string_view value, std::string_view meaning) {
  if (is_schema())
    schema_->put(key, with("const", value), meaning);
  else if (takes(key))
    json_->value(value);
}

void ResultWriter::flag(std::string_view key, bool value, std::string_view meaning) {
  if (is_schema())
    schema_->put(key, with("type", "boolean"), meaning);
  else if (takes(key))
    json_->value(value);
}

void ResultWriter::count(std::string_view key, long value, std::string_view meaning) {
  if (is_schema())
    schema_->put_number(key, with("type", "integer"), "1", meaning);
  else if (takes(key))
    json_->value(value);
}

void ResultWriter::number(std::string_view key, double value, std::string_view unit, std::string_view meaning) {
  if (is_schema())
    schema_->put_number(key, number_or_null_schema(), unit, meaning);
  else if (takes(key))
    json_->value(value);
}

void ResultWriter::number(std::string_view key, const std::optional<double>& value, std::string_view unit, std::string_view meaning) {
  when(value.has_value()).number(key, value.value_or(0), unit, meaning);
}

void ResultWriter::number_or_null(std::string_view key, const std::optional<double>& value, std::string_view unit,
                                  std::string_view meaning) {
  if (is_schema()) {
    schema_->put_number(key, number_or_null_schema(), unit, meaning);
  } else if (takes(key)) {
    if (value)
      json_->value(*value);
    else
      json_->null();
  }
}

void ResultWriter::numbers(std::string_view key, std::span<const double> values, std::string_view unit, std::string_view meaning) {
  if (is_schema())
    schema_->put_number(key, array_of(number_or_null_schema()), unit, meaning);
  else if (takes(key))
    json_->numbers(values);
}

void ResultWriter::numbers_or_null(std::string_view key, const std::vector<std::optional<double>>& values, std::string_view unit,
                                   std::string_view meaning) {
  if (is_schema()) {
    schema_->put_number(key, array_of(number_or_null_schema()), unit, meaning);
  } else if (takes(key)) {
    json_->begin_array();
    for (const std::optional<double>& value : values) {
      if (value)
        json_->value(*value);
      else
        json_->null();
    }
    json_->end_array();
  }
}

bool ResultWriter::begin(std::string_view key, std::string_view meaning, Shape shape, std::string_view kind, std::string_view unit) {
  if (is_schema()) {
    Schema::Level level;
    level.key = key;
    level.meaning = meaning;
    level.kind = kind;
    level.unit = unit;
    level.shape = shape;
    level.required = std::exchange(schema_->required, true);
    schema_->open.push_back(std::move(level));
    return true;
  }
  if (!takes(key)) return false;
  if (shape == Shape::list)
    json_->begin_array();
  else
    json_->begin_object();
  open_.push_back(shape);
  return true;
}

void ResultWriter::end() {
  if (is_schema()) {
    Schema::Level level = std::move(schema_->open.back());
    schema_->open.pop_back();
    schema_->required = level.required;
    if (level.shape == Shape::list) {
      schema_->put(level.key, array_of(std::move(level.object)), level.meaning);
    } else if (level.shape == Shape::named) {
      schema_->put(level.key, {{"type", "object"}, {"additionalProperties", std::move(level.object)}}, level.meaning);
    } else if (level.kind.empty()) {
      schema_->put(level.key, std::move(level.object), level.meaning);
    } else {
      schema_->kinds[level.kind] = std::move(level.object);
      schema_->put_number(level.key, {{"$ref", "#/$defs/" + level.kind}, {"properties", with("unit", with("const", level.unit))}},
                          level.unit, level.meaning);
    }
    return;
  }
  if (open_.back() == Shape::list)
    json_->end_array();
  else
    json_->end_object();
  open_.pop_back();
}

}  // namespace uplift
