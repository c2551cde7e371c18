#include <fmt/format.h>

#include <cassert>

#include "uplift/base/declare.h"
#include "uplift/base/resolved.h"
#include "uplift/base/text.h"

// Checked values as TOML: plain keys first, then the tables, in the order of the declaration.
namespace uplift {
namespace {

std::string key_text(std::string_view key) {
  const auto bare = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  bool all = !key.empty();
  for (const char c : key) all = all && bare(c);
  return all ? std::string(key) : escaped(key);
}

/// With point or exponent, so that "-0.0" stays what it is and a real is not read as an integer.
std::string real_text(double value) {
  const std::string text = shortest(value);
  return text.find_first_of(".e") == text.npos ? text + ".0" : text;
}

template <class List, class Text>
std::string list_text(const List& list, Text text) {
  std::string out;
  for (const auto& entry : list) out += (out.empty() ? "" : ", ") + text(entry);
  return "[" + out + "]";
}

const std::vector<Field>& fields_of(const Values& values) {
  assert(values.section() || values.part_info());
  return values.section() ? values.section()->fields : values.part_info()->params;
}

/// A part none of whose parameters has a value is written as its bare name.
bool bare_part(const Values& values) {
  for (const Field& field : fields_of(values))
    if (values.has(field.name)) return false;
  return true;
}

class Writer {
 public:
  explicit Writer(const DecidedTexts& decided) : decided_(decided) {}
  void write(const Values& values, const std::string& header) {
    if (!values.type().empty()) line("type", escaped(values.type()), {});
    for (const Field& field : fields_of(values)) {
      if (!values.has(field.name)) continue;
      const auto decided = decided_.find(values.path(field.name));
      const std::string value = decided != decided_.end() ? escaped(decided->second) : plain(values, field);
      if (!value.empty()) line(field.name, value, field.unit);
    }
    for (const Field& field : fields_of(values))
      if (values.has(field.name)) tables(values, field, header.empty() ? key_text(field.name) : header + "." + key_text(field.name));
  }
  std::string text;

 private:
  const DecidedTexts& decided_;

  void line(std::string_view key, const std::string& value, std::string_view unit) {
    const bool comment = !unit.empty() && unit != "1" && value.front() != '"';
    text += fmt::format("{} = {}{}{}\n", key_text(key), value, comment ? "  # " : "", comment ? unit : "");
  }

  void open(const std::string& header) { text += (text.empty() ? "" : "\n") + header + "\n"; }

  /// Text of what fits on one line; empty for tables.
  static std::string plain(const Values& values, const Field& field) {
    switch (field.kind) {
      case Kind::number:
        return values.is_word(field.name) ? escaped(values.text(field.name)) : real_text(values.number(field.name));
      case Kind::integer:
        return std::to_string(values.integer(field.name));
      case Kind::flag:
        return values.flag(field.name) ? "true" : "false";
      case Kind::text:
      case Kind::choice:
        return escaped(values.text(field.name));
      case Kind::numbers:
        return list_text(values.numbers(field.name), real_text);
      case Kind::texts:
        return list_text(values.texts(field.name), [](const std::string& entry) { return escaped(entry); });
      case Kind::part:
        return bare_part(values.part(field.name)) ? escaped(values.part(field.name).type()) : "";
      case Kind::tables:
        return values.tables(field.name).empty() ? "[]" : "";
      case Kind::table:
      case Kind::named:
        return "";
    }
    return "";
  }

  void tables(const Values& values, const Field& field, const std::string& header) {
    if (field.kind == Kind::table || (field.kind == Kind::part && !bare_part(values.part(field.name)))) {
      open("[" + header + "]");
      write(values.table(field.name), header);
    }
    if (field.kind == Kind::tables)
      for (const Values& entry : values.tables(field.name)) {
        open("[[" + header + "]]");
        write(entry, header);
      }
    if (field.kind == Kind::named) {
      open("[" + header + "]");
      for (const Values& entry : values.tables(field.name))
        if (const std::string value = bare_entry(entry); !value.empty()) line(entry.key(), value, field.section->fields.front().unit);
      for (const Values& entry : values.tables(field.name)) {
        if (!bare_entry(entry).empty()) continue;
        const std::string inner = header + "." + key_text(entry.key());
        open("[" + inner + "]");
        write(entry, inner);
      }
    }
  }

  /// Text of a named entry that is one value; empty for entries that are tables.
  static std::string bare_entry(const Values& entry) {
    const std::vector<Field>& fields = fields_of(entry);
    const bool bare = fields.size() == 1 && fields.front().name == "value" && entry.has("value");
    return bare ? plain(entry, fields.front()) : "";
  }
};

}  // namespace

std::string to_toml(const Values& values) {
  return to_toml(values, {});
}

std::string to_toml(const Values& values, const DecidedTexts& decided) {
  Writer writer(decided);
  writer.write(values, "");
  return writer.text;
}

}  // namespace uplift
