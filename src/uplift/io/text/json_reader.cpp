#include "uplift/io/text/json_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "uplift/base/text.h"

namespace uplift {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_json_bytes = std::size_t{16} << 20;
constexpr int most_json_levels = 64;

Where position(std::string_view text, std::size_t byte, const std::string& file) {
  const std::string_view before = text.substr(0, std::min(byte > 0 ? byte - 1 : 0, text.size()));
  const std::size_t line_begin = before.find_last_of('\n');
  return {file, 1 + static_cast<int>(std::ranges::count(before, '\n')),
          1 + static_cast<int>(before.size() - (line_begin == std::string_view::npos ? 0 : line_begin + 1))};
}

Raw converted(const Json& value, const std::string& file, const std::string& path) {
  Raw raw{{}, {file, 0}, path};
  switch (value.type()) {
    case Json::value_t::object: {
      auto table = std::make_shared<RawTable>();
      for (const auto& [key, entry] : value.items())
        table->entries.emplace_back(key, converted(entry, file, path.empty() ? key : path + "." + key));
      raw.data = std::move(table);
      break;
    }
    case Json::value_t::array: {
      RawList list;
      for (std::size_t i = 0; i < value.size(); ++i) list.push_back(converted(value[i], file, fmt::format("{}[{}]", path, i)));
      raw.data = std::move(list);
      break;
    }
    case Json::value_t::string:
      raw.data = value.get<std::string>();
      break;
    case Json::value_t::boolean:
      raw.data = value.get<bool>();
      break;
    case Json::value_t::number_integer:
      raw.data = value.get<std::int64_t>();
      break;
    case Json::value_t::number_unsigned:
      if (value.get<std::uint64_t>() <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
        raw.data = value.get<std::int64_t>();
      else
        raw.data = value.get<double>();
      break;
    case Json::value_t::number_float:
      raw.data = value.get<double>();
      break;
    default:
      throw InputError(raw.where, raw.path, "a number, a text, true or false, a list or a table", "null");
  }
  return raw;
}

Json json_of(const Raw& raw) {
  if (const auto* truth = std::get_if<bool>(&raw.data)) return *truth;
  if (const auto* whole = std::get_if<std::int64_t>(&raw.data)) return *whole;
  if (const auto* number = std::get_if<double>(&raw.data)) return std::isfinite(*number) ? Json(*number) : Json(fmt::format("{}", *number));
  if (const auto* text = std::get_if<std::string>(&raw.data)) return *text;
  if (const auto* list = std::get_if<RawList>(&raw.data)) {
    Json made = Json::array();
    for (const Raw& each : *list) made.push_back(json_of(each));
    return made;
  }
  Json made = Json::object();
  if (const auto* table = std::get_if<std::shared_ptr<RawTable>>(&raw.data))
    for (const auto& [key, value] : (*table)->entries) made[key] = json_of(value);
  return made;
}

}  // namespace

std::string json_text(const Raw& raw) {
  return json_of(raw).dump();
}

Raw read_json_text(std::string_view text, const std::string& file) {
  if (text.size() > most_json_bytes) throw InputError({file, 0}, "", "at most 16 MiB of JSON", fmt::format("{} bytes", text.size()));
  int levels = 0;
  std::vector<std::vector<std::string>> keys;  // of the objects that are open
  const auto watch = [&](int depth, Json::parse_event_t event, Json& parsed) {
    levels = std::max(levels, depth);
    if (levels > most_json_levels) throw InputError({file, 0}, "", fmt::format("at most {} levels of JSON", most_json_levels), "more");
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event == Json::parse_event_t::key) {
      std::string name = parsed.get<std::string>();
      if (std::ranges::find(keys.back(), name) != keys.back().end())
        throw InputError({file, 0}, name, "each key once in a table", in_quotes(name) + " twice");
      keys.back().push_back(std::move(name));
    }
    return true;
  };
  try {
    const Json value = Json::parse(text, watch);
    if (!value.is_object()) throw InputError({file, 0}, "", "a JSON object", value.type_name());
    return converted(value, file, "");
  } catch (const Json::parse_error& error) {
    throw InputError(position(text, error.byte, file), "", "JSON", "unbalanced brackets or invalid characters");
  } catch (const Json::exception&) {
    throw InputError({file, 0}, "", "JSON with numbers of at most 1e308", "a larger number");
  }
}

}  // namespace uplift
