#pragma once
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "uplift/base/error.h"

// One declaration of an input, used by everything: the check of a case file, its defaults, `uplift describe`, `uplift schema`.
namespace uplift {

// ---- what a file holds: a tree with positions, no meaning yet ----

struct RawTable;
struct Raw;
using RawList = std::vector<Raw>;
/// One value as read from a file, with its position and its path ("stage[1].step").
struct Raw {
  std::variant<std::monostate, bool, std::int64_t, double, std::string, RawList, std::shared_ptr<RawTable>> data;
  Where where;
  std::string path;
};
/// A table in the order of the file.
struct RawTable {
  std::vector<std::pair<std::string, Raw>> entries;
  const Raw* find(std::string_view key) const;
};

// ---- what is wanted ----

enum class Kind { number, integer, flag, text, choice, numbers, texts, table, tables, named, part };

struct Section;
/// A part that a user can choose by name (a law, a method, a scheme): what is known without making it.
struct PartInfo;

/// One key of a table: its kind, unit, meaning, default and bounds.
struct Field {
  std::string_view name;
  Kind kind = Kind::number;
  std::string_view unit;     // SI unit of number(s), "1" when dimensionless; of a text "*": it may be a bare number
  std::string_view meaning;  // one line, for the reader of `describe`
  bool required = true;
  std::optional<double> standard_number;  // also integers
  std::optional<bool> standard_flag;
  std::optional<std::string_view> standard_text;
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool least_excluded = false;                            // least < value instead of least <= value
  bool most_excluded = false;                             // value < most instead of value <= most
  std::vector<std::string_view> choices;                  // Kind::choice
  const Section* section = nullptr;                       // Kind::table, tables, named
  std::span<const PartInfo* const> (*parts)() = nullptr;  // Kind::part: the catalog
  std::string_view type = {};                             // Kind::part: what a table without `type` is; empty: refused
  int size = 0, most_size = 0;                            // Kind::numbers: length from, to; 0 = any
  std::vector<std::string_view> words = {};               // Kind::number: words taken instead of a number (e.g. "rigid")

  // Modifiers, so that a declaration reads as one line: number("K_n", "Pa/m", "normal stiffness").positive()
  Field positive() const;                   // > 0
  Field nonnegative() const;                // >= 0
  Field negative() const;                   // < 0
  Field between(double a, double b) const;  // a <= value <= b
  Field standard(double value) const;       // default; makes the key optional
  Field standard(int value) const;
  Field standard(bool value) const;
  Field standard(const char* value) const;
  Field optional() const;                            // may be absent, no default
  Field or_word(std::string_view word) const;        // Kind::number that may also be this word
  Field standard_type(std::string_view name) const;  // Kind::part: a table may leave `type` out
};

Field number(std::string_view name, std::string_view unit, std::string_view meaning);
Field integer(std::string_view name, std::string_view meaning);
Field flag(std::string_view name, std::string_view meaning);
Field text(std::string_view name, std::string_view meaning);
Field choice(std::string_view name, std::vector<std::string_view> choices, std::string_view meaning);
Field numbers(std::string_view name, std::string_view unit, std::string_view meaning, int size = 0);
Field vector(std::string_view name, std::string_view unit, std::string_view meaning);  // 2 numbers in plane models, 3 in space
Field texts(std::string_view name, std::string_view meaning);
// [name]. An absent table takes the defaults of its keys, and is missing when one of them has none; with optional() it stays absent.
Field table(std::string_view name, const Section& section, std::string_view meaning);
Field tables(std::string_view name, const Section& section, std::string_view meaning);  // [[name]]; may be absent
// [name.KEY] tables under free keys; may be absent. When the section has one key only, "value", an entry may be that value: [nodes] top =
// [0, 5].
Field named(std::string_view name, const Section& section, std::string_view meaning);
Field part(std::string_view name, std::span<const PartInfo* const> (*parts)(), std::string_view meaning);  // { type = "...", ... }

/// A table of the case file.
struct Section {
  std::string_view name, meaning;
  std::vector<Field> fields;
};

struct PartInfo {
  std::string_view name;       // the word in the case file
  std::string_view summary;    // one line
  std::string_view equations;  // plain text, several lines
  std::string_view source;     // paper and equation numbers
  std::vector<Field> params;
};

// ---- what was checked: SI numbers, defaults filled in ----

/// One checked table. Asking for a key that was not declared, or with the wrong kind, is a bug (assertion).
class Values {
 public:
  double number(std::string_view key) const;  // SI
  int integer(std::string_view key) const;
  bool flag(std::string_view key) const;
  const std::string& text(std::string_view key) const;             // text and choice
  const std::vector<double>& numbers(std::string_view key) const;  // SI; empty when absent
  const std::vector<std::string>& texts(std::string_view key) const;
  const Values& table(std::string_view key) const;
  const std::vector<Values>& tables(std::string_view key) const;  // tables and named (key() gives the free key)
  const Values& part(std::string_view key) const;                 // type() gives the part's name

  bool has(std::string_view key) const;      // given by the user or by a default
  bool given(std::string_view key) const;    // written in the file
  bool is_word(std::string_view key) const;  // a number given as one of its words
  const std::string& type() const { return type_; }
  const std::string& key() const { return key_; }
  const Section* section() const { return section_; }
  const PartInfo* part_info() const { return part_; }
  /// Position of a key, or of the table when the key is absent or empty.
  Where where(std::string_view key = {}) const;
  std::string path(std::string_view key = {}) const;

  struct Item {
    std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<double>, std::vector<std::string>,
                 std::vector<Values>>
        data;  // table and part: one element in vector<Values>
    bool given = false;
    Where where;
  };
  using Items = std::map<std::string, Item, std::less<>>;
  const Items& items() const { return items_; }

 private:
  friend class Checker;
  const Item& item(std::string_view key) const;
  Items items_;
  std::string type_, key_, path_;
  Where where_;
  const Section* section_ = nullptr;  // or
  const PartInfo* part_ = nullptr;
};

/// Throws the InputError of a key of a table, or with an empty key of the table itself.
[[noreturn]] void fail(const Values& table, std::string_view key, const std::string& wanted, const std::string& found,
                       const std::string& nearest = {});
/// Exactly one of two keys must be given: whether it is the first.
bool first_of_two(const Values& table, std::string_view first, std::string_view second);

/// Checks a table against its declaration: unknown keys (with the nearest name), missing keys, kinds, units and dimensions, bounds.
/// Throws InputError. The values keep a pointer to the declaration. Numbers may be written bare (SI) or as text with a unit ("20000 MPa").
Values check(const Raw& raw, const Section& section);
/// The same for a part: a table with `type = "name"`, or the bare name when no parameter is needed.
/// `type`: what a table that does not name one is; empty: it is refused.
Values check_part(const Raw& raw, std::span<const PartInfo* const> catalog, std::string_view type = {});

/// The checked table as TOML text, defaults filled in, SI numbers with their unit as a comment: reading it again gives the same values.
std::string to_toml(const Values& values);
/// JSON Schema (draft 2020-12) of a section, made from the declaration alone.
std::string to_json_schema(const Section& section);

/// What a field takes, for messages and reference pages: "a pressure > 0 Pa", "an integer from 1 to 10", "\"path\" or \"end\"".
std::string wanted_text(const Field& field);
/// How many numbers a list takes: "2", "2 or 3".
std::string size_text(const Field& field);
/// Only the bounds, with the unit: "> 0 Pa", "from 0 to 0.5"; empty when there are none.
std::string bounds_text(const Field& field);
/// The default as it would be written in a file: "0.3", "true", "\"path\""; empty when there is none.
std::string standard_text(const Field& field);

}  // namespace uplift
