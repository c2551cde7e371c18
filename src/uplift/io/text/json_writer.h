#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

// A small writer of JSON text: reports hold some hundred thousand numbers, which a document tree would make slow.
namespace uplift {

/// Writes JSON from front to back: begin/end of objects and arrays, keys, values. Numbers that are not finite become null. Calls that do
/// not nest are a bug (assertion).
class JsonWriter {
 public:
  /// `digits`: significant digits of numbers; 0: shortest text that reads back as the same number. `indent`: spaces per level, 0: one line.
  explicit JsonWriter(int digits = 0, int indent = 0) : digits_(digits), indent_(indent) {}

  JsonWriter& begin_object();
  JsonWriter& end_object();
  JsonWriter& begin_array();
  JsonWriter& end_array();
  JsonWriter& key(std::string_view name);
  JsonWriter& value(std::string_view text);
  JsonWriter& value(const char* text) { return value(std::string_view(text)); }
  JsonWriter& value(const std::string& text) { return value(std::string_view(text)); }
  JsonWriter& value(double number);
  JsonWriter& value(long number);
  JsonWriter& value(int number) { return value(static_cast<long>(number)); }
  JsonWriter& value(bool truth);
  JsonWriter& null();
  /// An array of numbers, on one line.
  JsonWriter& numbers(std::span<const double> values);
  JsonWriter& texts(const std::vector<std::string>& values);
  /// A finished JSON text as a value.
  JsonWriter& document(std::string_view text);
  template <class Value>
  JsonWriter& member(std::string_view name, const Value& given) {
    return key(name).value(given);
  }

  /// The finished text.
  std::string take();

 private:
  void separate();
  void open(char bracket);
  void close(char bracket);
  void newline();
  void number(double value);

  std::string text_;
  std::vector<bool> filled_;  // per open level: something stands in it already
  bool after_key_ = false;
  int digits_, indent_;
};

}  // namespace uplift
