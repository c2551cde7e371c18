#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "uplift/io/text/json_writer.h"

namespace uplift {

/// Writes a result document (summary.json, trust.json) or, by the same calls, its JSON Schema. What a document contains is therefore stated
/// once, where it is written: key, value, unit and meaning. For the schema, `list` and `named` write one entry of default values.
class ResultWriter {
 public:
  /// Writes members into the object that is open in `json`.
  explicit ResultWriter(JsonWriter& json);
  /// Makes the schema of a document with this name.
  ResultWriter(std::string_view title, std::string_view meaning);
  ~ResultWriter();
  ResultWriter(const ResultWriter&) = delete;
  ResultWriter& operator=(const ResultWriter&) = delete;
  bool is_schema() const { return schema_ != nullptr; }
  /// The schema as text (draft 2020-12), once everything is written.
  std::string schema() const;

  /// The next member is in the document only if `present`; the schema does not require it.
  ResultWriter& when(bool present);

  void text(std::string_view key, std::string_view value, std::string_view meaning);
  void texts(std::string_view key, const std::vector<std::string>& values, std::string_view meaning);
  /// One of a few words.
  void word(std::string_view key, std::string_view value, std::vector<std::string_view> words, std::string_view meaning);
  /// Always the same text: a format, a unit.
  void constant(std::string_view key, std::string_view value, std::string_view meaning);
  void flag(std::string_view key, bool value, std::string_view meaning);
  void count(std::string_view key, long value, std::string_view meaning);
  /// A value that is not finite is null.
  void number(std::string_view key, double value, std::string_view unit, std::string_view meaning);
  /// Left out where there is none.
  void number(std::string_view key, const std::optional<double>& value, std::string_view unit, std::string_view meaning);
  /// null where there is none.
  void number_or_null(std::string_view key, const std::optional<double>& value, std::string_view unit, std::string_view meaning);
  void numbers(std::string_view key, std::span<const double> values, std::string_view unit, std::string_view meaning);
  void numbers_or_null(std::string_view key, const std::vector<std::optional<double>>& values, std::string_view unit,
                       std::string_view meaning);
  /// The unit of the numbers beside it.
  void unit(std::string_view unit) { constant("unit", unit, "unit of the numbers beside it"); }

  template <class Write>
  void object(std::string_view key, std::string_view meaning, const Write& write) {
    if (!begin(key, meaning, Shape::object)) return;
    write();
    end();
  }
  /// An object of a kind that occurs in many places: the schema describes the kind once, under this name. `unit` is that of its numbers.
  template <class Write>
  void object_of(std::string_view kind, std::string_view key, std::string_view unit, std::string_view meaning, const Write& write) {
    if (!begin(key, meaning, Shape::object, kind, unit)) return;
    write();
    end();
  }
  /// write(entry) for every entry.
  template <class Range, class Write>
  void list(std::string_view key, std::string_view meaning, const Range& range, const Write& write) {
    if (!begin(key, meaning, Shape::list)) return;
    if (is_schema()) {
      write(typename Range::value_type{});
    } else {
      for (const auto& entry : range) {
        json_->begin_object();
        write(entry);
        json_->end_object();
      }
    }
    end();
  }
  /// An object whose keys are names that the case chooses: key_of(entry), write(entry).
  template <class Range, class Key, class Write>
  void named(std::string_view key, std::string_view meaning, const Range& range, const Key& key_of, const Write& write) {
    if (!begin(key, meaning, Shape::named)) return;
    if (is_schema()) {
      write(typename Range::value_type{});
    } else {
      for (const auto& entry : range) {
        json_->key(key_of(entry)).begin_object();
        write(entry);
        json_->end_object();
      }
    }
    end();
  }

 private:
  enum class Shape { object, list, named };
  struct Schema;
  bool begin(std::string_view key, std::string_view meaning, Shape shape, std::string_view kind = {}, std::string_view unit = {});
  void end();
  /// Whether the next value is written into the document, with its key.
  bool takes(std::string_view key);

  JsonWriter* json_ = nullptr;
  std::unique_ptr<Schema> schema_;
  std::vector<Shape> open_;
  bool present_ = true;  // see when()
};

}  // namespace uplift
