#include "uplift/analysis/case_names.h"

#include <cassert>

namespace uplift {

void fail(const Values& table, std::string_view key, const std::string& wanted, const std::string& found, const std::string& nearest) {
  throw InputError(table.where(key), table.path(key), wanted, found, nearest);
}

int Names::add(const Values& table, std::string_view key, std::string automatic) {
  if (!table.has(key)) return add(std::move(automatic), table.where(), table.path());
  return add(table.text(key), table.where(key), table.path(key));
}

int Names::add(std::string name, const Where& where, const std::string& path) {
  if (name.empty()) throw InputError(where, path, "a name for the " + what_, "an empty text");
  if (const auto [used, added] = index_.emplace(name, size()); !added)
    throw InputError(
        where, path, "a name that no other " + what_ + " has",
        "\"" + name + "\", which line " + std::to_string(names_[static_cast<std::size_t>(used->second)].second.line) + " uses already");
  names_.emplace_back(std::move(name), where);
  return size() - 1;
}

void Names::also(const std::string& name, int index) {
  [[maybe_unused]] const bool added = index_.emplace(name, index).second;
  assert(added);
  also_.push_back(name);
}

int Names::find(const std::string& name, const Where& where, const std::string& path) const {
  if (const auto found = index_.find(name); found != index_.end()) return found->second;
  std::vector<std::string> known = also_;
  for (const auto& [other, place] : names_) known.push_back(other);
  throw InputError(where, path, std::string("the name of a") + (what_.front() == 'i' ? "n " : " ") + what_, "\"" + name + "\"",
                   nearest_name(name, known));
}

}  // namespace uplift
