#include "uplift/case/build/names.h"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <ranges>

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

int Names::Numbered::find(const std::string& name) const {
  if (count == 0 || !name.starts_with(prefix)) return -1;
  int wanted = 0;
  const char *begin = name.data() + prefix.size(), *end = name.data() + name.size();
  if (std::from_chars(begin, end, wanted).ec != std::errc()) return -1;
  const auto all = std::views::iota(0, count);
  const auto found = std::ranges::lower_bound(all, wanted, {}, number);
  return found != all.end() && (*this)[*found] == name ? *found : -1;
}

int Names::index_of(const std::string& name) const {
  if (const int found = numbered_.find(name); found >= 0) return numbered_.first + found;
  const auto found = index_.find(name);
  return found != index_.end() ? found->second : -1;
}

std::string Names::operator[](int index) const {
  return is_numbered(index) ? numbered_[index - numbered_.first] : given(index).first;
}

void Names::refuse_second(const std::string& name, int line, const Where& where, const std::string& path) const {
  throw InputError(
      where, path, "a name that no other " + what_ + " has",
      in_quotes(name) + (line > 0 ? ", which line " + std::to_string(line) + " uses already" : ", which is there automatically"));
}

int Names::add(std::string name, const Where& where, const std::string& path) {
  check_name(name, "the " + what_, where, path);
  if (const int used = index_of(name); used >= 0) refuse_second(name, is_numbered(used) ? numbered_.line : given(used).second, where, path);
  index_.emplace(name, size());
  names_.emplace_back(std::move(name), where.line);
  return size() - 1;
}

void Names::add_numbered(std::string prefix, int count, std::function<int(int)> number, const Where& where, const std::string& path) {
  assert(numbered_.count == 0);
  numbered_ = {std::move(prefix), size(), count, where.line, std::move(number)};
  for (const auto& [name, line] : names_)
    if (numbered_.find(name) >= 0) refuse_second(name, line, where, path);
}

void Names::also(const std::string& name, int index) {
  [[maybe_unused]] const bool added = index_.emplace(name, index).second;
  assert(added);
  also_.push_back(name);
}

int Names::find(const std::string& name, const Where& where, const std::string& path) const {
  if (const int found = index_of(name); found >= 0) return found;
  std::vector<std::string> known = also_;
  for (int i = 0; i < size(); ++i) known.push_back((*this)[i]);
  throw InputError(where, path, std::string("the name of a") + (what_.front() == 'i' ? "n " : " ") + what_, in_quotes(name),
                   nearest_name(name, known));
}

}  // namespace uplift
