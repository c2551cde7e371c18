#include "uplift/base/declare.h"

#include <cassert>

#include "uplift/base/text.h"
#include "uplift/base/units.h"

// The declaration of inputs: what a field is, and how that reads in words.
namespace uplift {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Field make(std::string_view name, Kind kind, std::string_view meaning) {
  Field field;
  field.name = name;
  field.kind = kind;
  field.meaning = meaning;
  return field;
}

[[maybe_unused]] bool takes_numbers(const Field& field) {
  return field.kind == Kind::number || field.kind == Kind::integer || field.kind == Kind::numbers;
}

template <class Names>
std::string one_of(const Names& names) {
  std::vector<std::string> words;
  for (const std::string_view name : names) words.push_back(escaped(name));
  return listed(words);
}

}  // namespace

const Raw* RawTable::find(std::string_view key) const {
  for (const auto& [name, raw] : entries)
    if (name == key) return &raw;
  return nullptr;
}

// ---- modifiers ----

Field Field::positive() const {
  assert(takes_numbers(*this));
  Field field = *this;
  field.least = 0;
  field.least_excluded = true;
  return field;
}

Field Field::nonnegative() const {
  assert(takes_numbers(*this));
  Field field = *this;
  field.least = 0;
  field.least_excluded = false;
  return field;
}

Field Field::negative() const {
  assert(takes_numbers(*this));
  Field field = *this;
  field.most = 0;
  field.most_excluded = true;
  return field;
}

Field Field::between(double a, double b) const {
  assert(takes_numbers(*this) && a <= b);
  Field field = *this;
  field.least = a;
  field.most = b;
  field.least_excluded = field.most_excluded = false;
  return field;
}

Field Field::standard(double value) const {
  assert(kind == Kind::number || kind == Kind::integer);
  Field field = *this;
  field.standard_number = value;
  field.required = false;
  return field;
}

Field Field::standard(int value) const {
  return standard(static_cast<double>(value));
}

Field Field::standard(bool value) const {
  assert(kind == Kind::flag);
  Field field = *this;
  field.standard_flag = value;
  field.required = false;
  return field;
}

Field Field::standard(const char* value) const {
  assert(kind == Kind::text || kind == Kind::choice || kind == Kind::part || kind == Kind::number);
  Field field = *this;
  field.standard_text = value;
  field.required = false;
  return field;
}

Field Field::optional() const {
  Field field = *this;
  field.required = false;
  return field;
}

Field Field::or_word(std::string_view word) const {
  assert(kind == Kind::number);
  Field field = *this;
  field.words.push_back(word);
  return field;
}
Field Field::standard_type(std::string_view part) const {
  assert(kind == Kind::part);
  Field field = *this;
  field.type = part;
  return field;
}

// ---- kinds ----

Field number(std::string_view name, std::string_view unit, std::string_view meaning) {
  Field field = make(name, Kind::number, meaning);
  field.unit = unit;
  return field;
}

Field integer(std::string_view name, std::string_view meaning) {
  Field field = make(name, Kind::integer, meaning);
  field.unit = "1";
  return field;
}

Field flag(std::string_view name, std::string_view meaning) {
  return make(name, Kind::flag, meaning);
}

Field text(std::string_view name, std::string_view meaning) {
  return make(name, Kind::text, meaning);
}

Field choice(std::string_view name, std::vector<std::string_view> choices, std::string_view meaning) {
  assert(!choices.empty());
  Field field = make(name, Kind::choice, meaning);
  field.choices = std::move(choices);
  return field;
}

Field numbers(std::string_view name, std::string_view unit, std::string_view meaning, int size) {
  Field field = make(name, Kind::numbers, meaning);
  field.unit = unit;
  field.size = field.most_size = size;
  return field;
}

Field vector(std::string_view name, std::string_view unit, std::string_view meaning) {
  Field field = numbers(name, unit, meaning, 2);
  field.most_size = 3;
  return field;
}

Field texts(std::string_view name, std::string_view meaning) {
  return make(name, Kind::texts, meaning);
}

Field table(std::string_view name, const Section& section, std::string_view meaning) {
  Field field = make(name, Kind::table, meaning);
  field.section = &section;
  return field;
}

Field tables(std::string_view name, const Section& section, std::string_view meaning) {
  Field field = make(name, Kind::tables, meaning);
  field.section = &section;
  field.required = false;
  return field;
}

Field named(std::string_view name, const Section& section, std::string_view meaning) {
  Field field = make(name, Kind::named, meaning);
  field.section = &section;
  field.required = false;
  return field;
}

Field part(std::string_view name, std::span<const PartInfo* const> (*parts)(), std::string_view meaning) {
  Field field = make(name, Kind::part, meaning);
  field.parts = parts;
  return field;
}

// ---- in words ----

std::string bounds_text(const Field& field) {
  const std::string unit = field.unit.empty() || field.unit == "1" ? "" : " " + std::string(field.unit);
  const bool below = field.least > -infinity, above = field.most < infinity;
  if (below && above && !field.least_excluded && !field.most_excluded)
    return "from " + shortest(field.least) + " to " + shortest(field.most) + unit;
  std::string out;
  if (below) out += (field.least_excluded ? "> " : ">= ") + shortest(field.least) + unit;
  if (above) out += (below ? " and " : "") + std::string(field.most_excluded ? "< " : "<= ") + shortest(field.most) + unit;
  return out;
}

std::string size_text(const Field& field) {
  return std::to_string(field.size) + (field.most_size > field.size ? " or " + std::to_string(field.most_size) : "");
}

std::string wanted_text(const Field& field) {
  const std::string bounds = bounds_text(field), bounded = bounds.empty() ? "" : " " + bounds;
  switch (field.kind) {
    case Kind::number: {
      const std::string what = bounds.empty() ? quantity_name(field.unit) : std::string(dimension_name(field.unit)) + bounded;
      return field.words.empty() ? what : what + " or " + one_of(field.words);
    }
    case Kind::integer:
      return "an integer" + bounded;
    case Kind::flag:
      return "true or false";
    case Kind::text:
      return field.unit == "*" ? "a number, or a text with a number and its unit" : "a text";
    case Kind::choice:
      return one_of(field.choices);
    case Kind::numbers: {
      const std::string count = (field.size > 0 ? size_text(field) + " " : "") + (field.most_size == 1 ? "number" : "numbers");
      const std::string unit = field.unit.empty() || field.unit == "1" || !bounds.empty() ? "" : " [" + std::string(field.unit) + "]";
      return "a list of " + count + unit + (bounds.empty() ? "" : ", each" + bounded);
    }
    case Kind::texts:
      return "a list of texts";
    case Kind::table:
      return "a table [" + std::string(field.name) + "]";
    case Kind::tables:
      return "tables [[" + std::string(field.name) + "]]";
    case Kind::named:
      return "a table [" + std::string(field.name) + "] of names";
    case Kind::part: {
      std::vector<std::string_view> names;
      for (const PartInfo* info : field.parts()) names.push_back(info->name);
      return one_of(names);
    }
  }
  return {};
}

std::string standard_text(const Field& field) {
  if (field.standard_number) return shortest(*field.standard_number);
  if (field.standard_flag) return *field.standard_flag ? "true" : "false";
  if (field.standard_text) return escaped(*field.standard_text);
  return {};
}

}  // namespace uplift
