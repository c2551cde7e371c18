#include "uplift/study/case_edit.h"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <memory>
#include <string_view>

namespace uplift {
namespace {

/// Cuts the first key or place off a path: "stage[1].step" gives "stage", then "[1]", then "step".
std::string_view next_of(std::string_view& path) {
  if (path.starts_with('.')) path.remove_prefix(1);
  const std::size_t end = path.starts_with('[') ? path.find(']') + 1 : std::min(path.find_first_of(".["), path.size());
  const std::string_view step = path.substr(0, end);
  path.remove_prefix(end);
  return step;
}

Raw put(const Raw& raw, std::string_view path, const CaseEdit& edit) {
  Raw made = raw;
  if (path.empty()) {
    std::visit([&](const auto& value) { made.data = value; }, edit.value);
    return made;
  }
  const std::string_view step = next_of(path);
  if (step.starts_with('[')) {
    std::size_t place = 0;
    std::from_chars(step.data() + 1, step.data() + step.size() - 1, place);
    auto& list = std::get<RawList>(made.data);
    assert(place < list.size());
    list[place] = put(list[place], path, edit);
    return made;
  }
  auto table = std::make_shared<RawTable>();
  if (const auto* old = std::get_if<std::shared_ptr<RawTable>>(&raw.data))
    table->entries = (*old)->entries;
  else if (const auto* word = std::get_if<std::string>(&raw.data))
    table->entries.emplace_back("type", Raw{*word, raw.where, raw.path + ".type"});
  const auto found = std::ranges::find(table->entries, step, [](const auto& entry) -> std::string_view { return entry.first; });
  if (found != table->entries.end()) {
    found->second = put(found->second, path, edit);
  } else {
    const Raw fresh{{}, raw.where, raw.path.empty() ? std::string(step) : raw.path + "." + std::string(step)};
    table->entries.emplace_back(std::string(step), put(fresh, path, edit));
  }
  made.data = std::move(table);
  return made;
}

/// The place of "[3]"; nothing for a key.
std::optional<std::size_t> place_of(std::string_view step) {
  std::size_t place = 0;
  const char *first = step.data() + 1, *last = step.data() + step.size() - 1;
  if (step.size() < 3 || step.front() != '[' || step.back() != ']') return std::nullopt;
  const auto [end, error] = std::from_chars(first, last, place);
  return end == last && error == std::errc() ? std::optional(place) : std::nullopt;
}

const Field* field_of(const Values& table, std::string_view key) {
  const std::vector<Field>* fields = table.section() ? &table.section()->fields : table.part_info() ? &table.part_info()->params : nullptr;
  if (fields == nullptr) return nullptr;
  const auto found = std::ranges::find(*fields, key, &Field::name);
  return found == fields->end() ? nullptr : &*found;
}

/// The path with the nearest key of the table in place of `key`, which stands before `rest`, if it is written there; empty where none is
/// near.
std::string with_nearest_key(const Values& table, std::string_view whole, std::string_view key, bool written, std::string_view rest) {
  std::vector<std::string> keys;
  for (const auto& [name, item] : table.items())  // not those of words and flags
    if (std::holds_alternative<double>(item.data) || std::holds_alternative<std::vector<double>>(item.data) ||
        std::holds_alternative<std::vector<Values>>(item.data))
      keys.emplace_back(name);
  const std::string near = nearest_name(key, keys);
  if (near.empty()) return "";
  const std::string before(whole.substr(0, whole.size() - rest.size() - (written ? key.size() : 0)));
  return before + (written ? "" : ".") + near + std::string(rest);
}

/// The table of several that the path goes into.
const Values* table_at(const std::vector<Values>& tables, const Field& field, std::string_view& path) {
  if (field.kind == Kind::named) {
    const auto found = std::ranges::find(tables, next_of(path), &Values::key);
    return found == tables.end() ? nullptr : &*found;
  }
  if (field.kind != Kind::tables) return tables.empty() ? nullptr : &tables.front();
  const std::optional<std::size_t> place = place_of(next_of(path));
  return place && *place < tables.size() ? &tables[*place] : nullptr;
}

}  // namespace

std::optional<NumberAt> number_at(const Values& root, std::string_view path, std::string* nearest) {
  const std::string_view whole = path;
  const Values* table = &root;
  std::string_view key = next_of(path);
  bool written = true;  // the key stands in the path
  while (true) {
    const auto found = table->items().find(key);
    const Field* field = field_of(*table, key);
    if (found == table->items().end() || field == nullptr) {
      if (nearest != nullptr) {
        *nearest = with_nearest_key(*table, whole, key, written, path);
        if (!number_at(root, *nearest)) nearest->clear();  // more is wrong than this key
      }
      return std::nullopt;
    }
    if (const auto* number = std::get_if<double>(&found->second.data))
      return path.empty() ? std::optional(NumberAt{*number, field}) : std::nullopt;
    if (const auto* numbers = std::get_if<std::vector<double>>(&found->second.data)) {
      const std::optional<std::size_t> place = place_of(next_of(path));
      if (!place || *place >= numbers->size() || !path.empty()) return std::nullopt;
      return NumberAt{(*numbers)[*place], field};
    }
    const auto* tables = std::get_if<std::vector<Values>>(&found->second.data);
    table = tables != nullptr && !path.empty() ? table_at(*tables, *field, path) : nullptr;
    if (table == nullptr || path.empty()) return std::nullopt;
    written = !path.starts_with('[');
    key = written ? next_of(path) : std::string_view("value");  // [nodes] top = [0, 5] stands for its only key
  }
}

Raw edited(const Raw& raw, const std::vector<CaseEdit>& edits) {
  Raw made = raw;
  for (const CaseEdit& edit : edits) made = put(made, edit.path, edit);
  return made;
}

}  // namespace uplift
