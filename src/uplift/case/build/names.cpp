#include "uplift/case/build/names.h"

#include <algorithm>
#include <cassert>

#include "uplift/base/text.h"

namespace uplift {

void check_name(const std::string& name, const std::string& of, const Where& where, const std::string& path) {
  constexpr std::size_t most = 200;  // bytes
  const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
  if (name.find_first_not_of(' ') == name.npos)
    throw InputError(where, path, "a name for " + of, name.empty() ? "an empty text" : "blanks");
  if (name.size() > most)
    throw InputError(where, path, "a name for " + of + " of at most " + std::to_string(most) + " bytes",
                     std::to_string(name.size()) + " bytes");
  if (std::ranges::any_of(name, control))
    throw InputError(where, path, "a name for " + of + " without control characters", in_quotes(name));
  if (std::string_view("=+-@").find(name.front()) != std::string_view::npos)
    throw InputError(where, path,
                     "a name for " + of + " that does not begin with '=', '+', '-' or '@' (tables would take it for a formula)",
                     in_quotes(name));
}

int Names::add(const Values& table, std::string_view key, std::string automatic) {
  if (!table.has(key)) return add(std::move(automatic), table.where(), table.path());
  return add(table.text(key), table.where(key), table.path(key));
}

int Names::add(std::string name, const Where& where, const std::string& path) {
  check_name(name, "the " + what_, where, path);
  if (const auto [used, added] = index_.emplace(name, size()); !added) {
    const int line = names_[static_cast<std::size_t>(used->second)].second.line;
    throw InputError(
        where, path, "a name that no other " + what_ + " has",
        in_quotes(name) + (line > 0 ? ", which line " + std::to_string(line) + " uses already" : ", which is there automatically"));
  }
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
  throw InputError(where, path, std::string("the name of a") + (what_.front() == 'i' ? "n " : " ") + what_, in_quotes(name),
                   nearest_name(name, known));
}

}  // namespace uplift
