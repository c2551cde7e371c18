#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "uplift/base/declare.h"
#include "uplift/base/text.h"
#include "uplift/base/units.h"

// A table of a file against its declaration.
namespace uplift {
namespace {

constexpr std::string_view only_value = "value";  // the key of a section whose entries may be written without it

std::string joined(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : path + "." + std::string(key);
}

const RawTable* table_of(const Raw& raw) {
  const auto* table = std::get_if<std::shared_ptr<RawTable>>(&raw.data);
  return table ? table->get() : nullptr;
}

/// What stands in the file, in words.
std::string found_text(const Raw& raw) {
  struct Words {
    std::string operator()(std::monostate) const { return "nothing"; }
    std::string operator()(bool value) const { return value ? "true" : "false"; }
    std::string operator()(std::int64_t value) const { return std::to_string(value); }
    std::string operator()(double value) const { return shortest(value); }
    std::string operator()(const std::string& value) const { return "the text " + in_quotes(value); }
    std::string operator()(const RawList& list) const {
      for (const Raw& entry : list)
        if (!table_of(entry)) return "a list";
      return list.empty() ? "an empty list" : "a list of tables";
    }
    std::string operator()(const std::shared_ptr<RawTable>&) const { return "a table"; }
  };
  return std::visit(Words{}, raw.data);
}

[[noreturn]] void refuse(const Raw& raw, const Field& field, const std::string& found, const std::string& nearest = {}) {
  throw InputError(raw.where, raw.path, wanted_text(field), found, nearest);
}

template <class Names>
std::vector<std::string> strings(const Names& names) {
  return {names.begin(), names.end()};
}

bool within(const Field& field, double value) {
  const bool above = field.least_excluded ? value > field.least : value >= field.least;
  const bool below = field.most_excluded ? value < field.most : value <= field.most;
  return above && below;
}

/// A thousand times beyond what an engineer means. Products of such numbers leave the range of a double.
void check_magnitude(const Raw& raw, const Field& field, double value, const std::string& shown) {
  const double most = field.unit == "m" ? 1e10 : 1e30, least = 1e-30;
  const std::string unit = field.unit.empty() || field.unit == "1" ? "" : " " + std::string(field.unit);
  if (std::abs(value) > most)
    throw InputError(raw.where, raw.path, std::string(dimension_name(field.unit)) + fmt::format(" of at most {:g}", most) + unit, shown);
  if (field.least_excluded && field.least == 0 && value < least)
    throw InputError(raw.where, raw.path, std::string(dimension_name(field.unit)) + fmt::format(" of at least {:g}", least) + unit, shown);
}

/// A number in SI: bare, or a text with a unit.
double number_of(const Raw& raw, const Field& field) {
  double value = 0;
  std::string found;
  if (const auto* whole = std::get_if<std::int64_t>(&raw.data)) {
    value = static_cast<double>(*whole);
  } else if (const auto* real = std::get_if<double>(&raw.data)) {
    value = *real;
  } else if (const auto* text = std::get_if<std::string>(&raw.data)) {
    Quantity quantity = parse_quantity(*text, field.unit);
    if (!quantity.ok) {
      const std::string word = nearest_name(*text, strings(field.words));
      refuse(raw, field, quantity.found, word.empty() ? quantity.nearest : word);
    }
    value = quantity.value;
    found = in_quotes(*text);
  } else {
    refuse(raw, field, found_text(raw));
  }
  const bool dimensionless = field.unit.empty() || field.unit == "1";
  const std::string shown = shortest(value) + (dimensionless ? "" : " " + std::string(field.unit));
  const std::string in_words = found.empty() ? shown : found + " (" + shown + ")";
  if (!std::isfinite(value) || !within(field, value)) refuse(raw, field, in_words);
  check_magnitude(raw, field, value, in_words);
  return value;
}

std::int64_t integer_of(const Raw& raw, Field field) {
  // Values::integer gives an int.
  field.least = std::max(field.least, static_cast<double>(std::numeric_limits<int>::min()));
  field.most = std::min(field.most, static_cast<double>(std::numeric_limits<int>::max()));
  if (const auto* whole = std::get_if<std::int64_t>(&raw.data)) {
    if (!within(field, static_cast<double>(*whole))) refuse(raw, field, found_text(raw));
    return *whole;
  }
  const auto* real = std::get_if<double>(&raw.data);
  if (!real || !within(field, *real) || *real != std::floor(*real)) refuse(raw, field, found_text(raw));
  return static_cast<std::int64_t>(*real);
}

const std::string& text_of(const Raw& raw, const Field& field) {
  const auto* text = std::get_if<std::string>(&raw.data);
  if (!text) refuse(raw, field, found_text(raw));
  return *text;
}

bool bare_number(const Raw& raw) {
  return std::holds_alternative<std::int64_t>(raw.data) || std::holds_alternative<double>(raw.data);
}

const RawList& list_of(const Raw& raw, const Field& field) {
  const auto* list = std::get_if<RawList>(&raw.data);
  if (!list) refuse(raw, field, found_text(raw));
  return *list;
}

/// A key that its table does not have.
struct UnknownKey {
  std::string key;
  const Raw& entry;
  const std::vector<Field>& known;
  std::string table;
};

/// Tables at and below a section that have a key of this name.
void find_tables_with(std::string_view key, const Section& section, std::vector<std::string>& found) {
  if (std::ranges::find(section.fields, key, &Field::name) != section.fields.end() && std::ranges::find(found, section.name) == found.end())
    found.emplace_back(section.name);
  for (const Field& field : section.fields)
    if (field.section != nullptr) find_tables_with(key, *field.section, found);
}

/// `file`: of the whole file, whose other tables may have the key; null: not known.
[[noreturn]] void refuse(const UnknownKey& unknown, const Section* file) {
  std::vector<std::string> known;
  for (const Field& field : unknown.known) known.emplace_back(field.name);
  const std::string nearest = nearest_name(unknown.key, known);
  std::string wanted = "a key of " + unknown.table, found = in_quotes(unknown.key);
  if (known.empty()) wanted = "no key, as " + unknown.table + " has no parameters";
  if (nearest.empty() && !known.empty()) wanted += ": " + listed(known);
  std::vector<std::string> tables;
  if (nearest.empty() && file != nullptr) find_tables_with(unknown.key, *file, tables);
  constexpr std::size_t most_tables = 3;  // of more, none is likely to be meant but the file itself, which comes first
  if (tables.size() > most_tables) tables.resize(tables.front() == file->name ? 1 : 0);
  if (!tables.empty()) found += ", a key of " + listed(tables);
  throw InputError(unknown.entry.where, unknown.entry.path, wanted, found, nearest);
}

bool bare_value(const Section& section) {
  return section.fields.size() == 1 && section.fields.front().name == only_value;
}

}  // namespace

/// Fills Values; it alone may.
class Checker {
 public:
  static Values section(const Raw& raw, const Section& section) {
    const RawTable* table = table_of(raw);
    if (!table) throw InputError(raw.where, raw.path, "a table", found_text(raw));
    Values values = begin(raw);
    values.section_ = &section;
    fill(values, raw, *table, section.fields, section.name);
    return values;
  }

  static Values part(const Raw& raw, std::span<const PartInfo* const> catalog, std::string_view standard = {}) {
    static const RawTable empty;
    std::vector<std::string> names;
    for (const PartInfo* info : catalog) names.emplace_back(info->name);
    const auto wanted = [&names] {
      std::vector<std::string> words;
      for (const std::string& name : names) words.push_back(escaped(name));
      return listed(words);
    };
    const auto* word = std::get_if<std::string>(&raw.data);
    const RawTable* table = table_of(raw);
    if (!word && !table) throw InputError(raw.where, raw.path, wanted(), found_text(raw));
    const Raw* type = table ? table->find("type") : &raw;
    const Raw unnamed{std::string(standard), raw.where, joined(raw.path, "type")};
    if (!type && !standard.empty()) type = &unnamed;
    if (!type) throw InputError(raw.where, joined(raw.path, "type"), wanted(), "nothing");
    const auto* name = std::get_if<std::string>(&type->data);
    if (!name) throw InputError(type->where, type->path, wanted(), found_text(*type));
    for (const PartInfo* info : catalog) {
      if (info->name != *name) continue;
      Values values = begin(raw);
      values.part_ = info;
      values.type_ = *name;
      fill(values, raw, table ? *table : empty, info->params, *name);
      return values;
    }
    throw InputError(type->where, type->path, wanted(), in_quotes(*name), nearest_name(*name, names));
  }

 private:
  static Values begin(const Raw& raw) {
    Values values;
    values.path_ = raw.path;
    values.where_ = raw.where;
    return values;
  }

  /// Checks the entries of a table against the fields and fills in the defaults. `what` names the table in messages. What is written
  /// wrongly is reported before what is missing: a misspelled key first, as it explains the missing one.
  static void fill(Values& values, const Raw& raw, const RawTable& table, const std::vector<Field>& fields, std::string_view what) {
    const auto type_of_part = [&values](const std::string& key) { return values.part_ && key == "type"; };
    for (const auto& [key, entry] : table.entries)
      if (!type_of_part(key) && std::ranges::find(fields, key, &Field::name) == fields.end())
        throw UnknownKey{key, entry, fields, std::string(what)};
    for (const auto& [key, entry] : table.entries)
      for (const Field& field : fields)
        if (field.name == key && !type_of_part(key)) values.items_.emplace(key, given(entry, field));
    for (const Field& field : fields)
      if (!table.find(field.name)) values.items_.emplace(field.name, absent(raw, field));
  }

  static Values::Item given(const Raw& raw, const Field& field) {
    Values::Item item;
    item.given = true;
    item.where = raw.where;
    const auto* text = std::get_if<std::string>(&raw.data);
    switch (field.kind) {
      case Kind::number:
        if (text && std::find(field.words.begin(), field.words.end(), *text) != field.words.end())
          item.data = *text;
        else
          item.data = number_of(raw, field);
        break;
      case Kind::integer:
        item.data = integer_of(raw, field);
        break;
      case Kind::flag:
        if (!std::holds_alternative<bool>(raw.data)) refuse(raw, field, found_text(raw));
        item.data = std::get<bool>(raw.data);
        break;
      case Kind::text:
        item.data = field.unit == "*" && bare_number(raw) ? found_text(raw) : text_of(raw, field);
        break;
      case Kind::choice:
        if (const std::string& word = text_of(raw, field);
            std::find(field.choices.begin(), field.choices.end(), word) == field.choices.end())
          refuse(raw, field, in_quotes(word), nearest_name(word, strings(field.choices)));
        item.data = *text;
        break;
      case Kind::numbers:
        item.data = numbers_of(raw, field);
        break;
      case Kind::texts:
        item.data = texts_of(raw, field);
        break;
      case Kind::table:
        if (!table_of(raw)) refuse(raw, field, found_text(raw));
        item.data = std::vector<Values>{section(raw, *field.section)};
        break;
      case Kind::tables:
        item.data = tables_of(raw, field);
        break;
      case Kind::named:
        item.data = named_of(raw, field);
        break;
      case Kind::part:
        item.data = std::vector<Values>{part(raw, field.parts(), field.type)};
        break;
    }
    return item;
  }

  /// The default of a key that is not in the table `raw`.
  static Values::Item absent(const Raw& raw, const Field& field) {
    Values::Item item;
    item.where = raw.where;
    Raw nothing{{}, raw.where, joined(raw.path, field.name)};
    if (field.required) {
      if (field.kind != Kind::table) refuse(nothing, field, "nothing");
      for (const Field& inner : field.section->fields)
        if (inner.required && inner.kind != Kind::table) refuse(nothing, field, "nothing");
      nothing.data = std::make_shared<RawTable>();
      item.data = std::vector<Values>{section(nothing, *field.section)};
    }
    if (field.standard_number) {
      assert(within(field, *field.standard_number));
      if (field.kind == Kind::integer)
        item.data = static_cast<std::int64_t>(*field.standard_number);
      else
        item.data = *field.standard_number;
    }
    if (field.standard_flag) item.data = *field.standard_flag;
    if (field.standard_text) {
      nothing.data = std::string(*field.standard_text);
      if (field.kind == Kind::part)
        item.data = std::vector<Values>{part(nothing, field.parts())};
      else
        item.data = std::string(*field.standard_text);
    }
    return item;
  }

  static std::vector<double> numbers_of(const Raw& raw, const Field& field) {
    const RawList& list = list_of(raw, field);
    if (field.size > 0 && (static_cast<int>(list.size()) < field.size || static_cast<int>(list.size()) > field.most_size))
      refuse(raw, field, list.empty() ? "an empty list" : std::to_string(list.size()) + (list.size() == 1 ? " number" : " numbers"));
    Field one = field;
    one.kind = Kind::number;
    std::vector<double> out;
    out.reserve(list.size());
    for (const Raw& entry : list) out.push_back(number_of(entry, one));
    return out;
  }

  static std::vector<std::string> texts_of(const Raw& raw, const Field& field) {
    const Field one = text(field.name, field.meaning);
    std::vector<std::string> out;
    for (const Raw& entry : list_of(raw, field)) out.push_back(text_of(entry, one));
    return out;
  }

  static std::vector<Values> tables_of(const Raw& raw, const Field& field) {
    const RawList& list = list_of(raw, field);
    std::vector<Values> out;
    out.reserve(list.size());
    for (const Raw& entry : list) out.push_back(section(entry, *field.section));
    return out;
  }

  static std::vector<Values> named_of(const Raw& raw, const Field& field) {
    const RawTable* table = table_of(raw);
    if (!table) refuse(raw, field, found_text(raw));
    std::vector<Values> out;
    out.reserve(table->entries.size());
    for (const auto& [key, entry] : table->entries) {
      if (bare_value(*field.section) && !table_of(entry)) {
        Values values = begin(entry);
        values.section_ = field.section;
        values.items_.emplace(only_value, given(entry, field.section->fields.front()));
        out.push_back(std::move(values));
      } else {
        out.push_back(section(entry, *field.section));
      }
      out.back().key_ = key;
    }
    return out;
  }
};

Values check(const Raw& raw, const Section& section) {
  try {
    return Checker::section(raw, section);
  } catch (const UnknownKey& unknown) {
    refuse(unknown, &section);
  }
}
Values check_part(const Raw& raw, std::span<const PartInfo* const> catalog, std::string_view type) {
  try {
    return Checker::part(raw, catalog, type);
  } catch (const UnknownKey& unknown) {
    refuse(unknown, nullptr);
  }
}

}  // namespace uplift
