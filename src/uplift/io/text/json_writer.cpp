#include "uplift/io/text/json_writer.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <utility>

#include "uplift/io/text/numbers.h"

namespace uplift {

void JsonWriter::newline() {
  if (indent_ == 0) return;
  text_ += '\n';
  text_.append(filled_.size() * static_cast<std::size_t>(indent_), ' ');
}

void JsonWriter::separate() {
  if (after_key_) {
    after_key_ = false;
    return;
  }
  if (filled_.empty()) return;
  if (filled_.back()) text_ += ',';
  filled_.back() = true;
  newline();
}

void JsonWriter::open(char bracket) {
  separate();
  text_ += bracket;
  filled_.push_back(false);
}

void JsonWriter::close(char bracket) {
  assert(!filled_.empty() && !after_key_);
  const bool filled = filled_.back();
  filled_.pop_back();
  if (filled) newline();
  text_ += bracket;
}

JsonWriter& JsonWriter::begin_object() {
  open('{');
  return *this;
}
JsonWriter& JsonWriter::end_object() {
  close('}');
  return *this;
}
JsonWriter& JsonWriter::begin_array() {
  open('[');
  return *this;
}
JsonWriter& JsonWriter::end_array() {
  close(']');
  return *this;
}

JsonWriter& JsonWriter::key(std::string_view name) {
  value(name);
  text_ += indent_ > 0 ? ": " : ":";
  after_key_ = true;
  return *this;
}

JsonWriter& JsonWriter::value(std::string_view text) {
  separate();
  text_ += '"';
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      text_ += '\\';
      text_ += c;
    } else if (c == '\n') {
      text_ += "\\n";
    } else if (c == '\t') {
      text_ += "\\t";
    } else if (static_cast<unsigned char>(c) < 0x20) {
      text_ += fmt::format("\\u{:04x}", static_cast<int>(c));
    } else {
      text_ += c;
    }
  }
  text_ += '"';
  return *this;
}

void JsonWriter::number(double value) {
  if (!std::isfinite(value))
    text_ += "null";
  else if (digits_ == 0)
    append_exact(text_, value);
  else
    append_number(text_, value, digits_);
}

JsonWriter& JsonWriter::value(double given) {
  separate();
  number(given);
  return *this;
}

JsonWriter& JsonWriter::value(long given) {
  separate();
  text_ += std::to_string(given);
  return *this;
}

JsonWriter& JsonWriter::value(bool truth) {
  separate();
  text_ += truth ? "true" : "false";
  return *this;
}

JsonWriter& JsonWriter::null() {
  separate();
  text_ += "null";
  return *this;
}

JsonWriter& JsonWriter::numbers(std::span<const double> values) {
  separate();
  text_ += '[';
  if (digits_ > 0) {
    append_numbers(text_, values, digits_);
  } else {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (i > 0) text_ += ',';
      number(values[i]);
    }
  }
  text_ += ']';
  return *this;
}

JsonWriter& JsonWriter::texts(const std::vector<std::string>& values) {
  begin_array();
  for (const std::string& text : values) value(text);
  return end_array();
}

JsonWriter& JsonWriter::document(std::string_view text) {
  separate();
  text_ += text;
  return *this;
}

std::string JsonWriter::take() {
  assert(filled_.empty());
  return std::move(text_);
}

}  // namespace uplift
