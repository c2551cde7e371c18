#include "uplift/analysis/case_names.h"

namespace uplift {

int Names::add(const Values& table, std::string_view key, std::string automatic) {
  if (!table.has(key)) return add(std::move(automatic), table.where(), table.path());
  return add(table.text(key), table.where(key), table.path(key));
}

int Names::add(std::string name, const Where& where, const std::string& path) {
  if (name.empty()) throw InputError(where, path, "a name for the " + what_, "an empty text");
  for (const auto& [used, place] : names_)
    if (used == name)
      throw InputError(where, path, "a name that no other " + what_ + " has",
                       "\"" + name + "\", which line " + std::to_string(place.line) + " uses already");
  names_.emplace_back(std::move(name), where);
  return size() - 1;
}

int Names::find(const std::string& name, const Where& where, const std::string& path) const {
  std::vector<std::string> known;
  for (int i = 0; i < size(); ++i) {
    if (names_[i].first == name) return i;
    known.push_back(names_[i].first);
  }
  throw InputError(where, path, std::string("the name of a") + (what_.front() == 'i' ? "n " : " ") + what_, "\"" + name + "\"",
                   nearest_name(name, known));
}

}  // namespace uplift
