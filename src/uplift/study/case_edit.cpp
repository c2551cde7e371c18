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

}  // namespace

Raw edited(const Raw& raw, const std::vector<CaseEdit>& edits) {
  Raw made = raw;
  for (const CaseEdit& edit : edits) made = put(made, edit.path, edit);
  return made;
}

}  // namespace uplift
