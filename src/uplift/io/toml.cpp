#include "uplift/io/toml.h"

#define TOML_HEADER_ONLY 1
#define TOML_FLOAT_CHARCONV 1    // exact and independent of the locale
#define TOML_MAX_NESTED_VALUES 64
#include <toml++/toml.h>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "uplift/base/file.h"
#include "uplift/base/text.h"

namespace uplift {
namespace {

constexpr std::size_t most_bytes = std::size_t{16} << 20;
constexpr int most_levels = TOML_MAX_NESTED_VALUES;

int line_of(std::string_view text, std::size_t offset) {
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(offset), '\n'));
}

/// Keys like a.a.a.a... nest without brackets, where toml++ sets no limit and everything after it recurses.
void refuse_deep_keys(std::string_view text, const std::string& file) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  const auto part_of_key = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '"' || c == '\'' || static_cast<unsigned char>(c) >= 0x80;
  };
  int dots = 0;
  bool after_key = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '.' && after_key) {
      if (++dots >= most_levels) throw InputError({file, line_of(text, i)}, "", fmt::format("a key of at most {} levels", most_levels), "a deeper one");
      after_key = false;
    } else if (part_of_key(c)) {
      after_key = true;
    } else if (!blank(c)) {
      dots = 0;
      after_key = false;
    }
  }
}

class Reader {
 public:
  explicit Reader(const std::string& file) : file_(file) {}

  Raw read(const toml::node& node, std::string path) const {
    Raw raw{{}, {file_, static_cast<int>(node.source().begin.line)}, std::move(path)};
    switch (node.type()) {
      case toml::node_type::table: raw.data = table(*node.as_table(), raw.path); break;
      case toml::node_type::array: raw.data = list(*node.as_array(), raw.path); break;
      case toml::node_type::string: raw.data = node.as_string()->get(); break;
      case toml::node_type::integer: raw.data = node.as_integer()->get(); break;
      case toml::node_type::floating_point: raw.data = node.as_floating_point()->get(); break;
      case toml::node_type::boolean: raw.data = node.as_boolean()->get(); break;
      default: throw InputError(raw.where, raw.path, "a number, a text, true or false, a list or a table", "a date or a time");
    }
    return raw;
  }

 private:
  std::shared_ptr<RawTable> table(const toml::table& node, const std::string& path) const {
    auto out = std::make_shared<RawTable>();
    std::vector<std::pair<const toml::key*, const toml::node*>> entries;
    for (const auto& [key, value] : node) entries.emplace_back(&key, &value);
    // toml++ sorts keys by name.
    std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
      const toml::source_position &x = a.first->source().begin, &y = b.first->source().begin;
      return x.line != y.line ? x.line < y.line : x.column < y.column;
    });
    out->entries.reserve(entries.size());
    for (const auto& [key, value] : entries) {
      const std::string name(key->str());
      out->entries.emplace_back(name, read(*value, path.empty() ? name : path + "." + name));
    }
    return out;
  }

  RawList list(const toml::array& node, const std::string& path) const {
    RawList out;
    out.reserve(node.size());
    for (std::size_t i = 0; i < node.size(); ++i) out.push_back(read(node[i], path + "[" + std::to_string(i) + "]"));
    return out;
  }

  const std::string& file_;
};

}  // namespace

Raw read_toml_text(std::string_view text, const std::string& file) {
  if (text.size() > most_bytes)
    throw InputError({file, 0}, "", fmt::format("at most {} MiB of TOML", most_bytes >> 20), fmt::format("{} MiB", text.size() >> 20));
  if (const auto offset = invalid_utf8(text))
    throw InputError({file, line_of(text, *offset)}, "", "UTF-8", fmt::format("the byte 0x{:02x}", static_cast<unsigned char>(text[*offset])));
  refuse_deep_keys(text, file);
  try {
    const toml::table root = toml::parse(text, std::string_view(file));
    Raw raw = Reader(file).read(root, "");
    raw.where.line = 0;  // the file as a whole
    return raw;
  } catch (const toml::parse_error& error) {
    std::string found(error.description());
    throw InputError({file, static_cast<int>(error.source().begin.line)}, "", "TOML", found);
  }
}

Raw read_toml_file(const std::string& path) { return read_toml_text(read_file(path), path); }

}  // namespace uplift
