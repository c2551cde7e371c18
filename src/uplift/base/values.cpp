#include <cassert>

#include "uplift/base/declare.h"

// Access to what was checked. A key that was not declared, or asked for with the wrong kind, is a bug of the program: an assertion, and
// std::bad_variant_access where assertions are compiled out.
namespace uplift {

const Values::Item& Values::item(std::string_view key) const {
  static const Item nothing;
  const auto found = items_.find(key);
  assert(found != items_.end() && "key was not declared");
  return found == items_.end() ? nothing : found->second;
}

double Values::number(std::string_view key) const {
  return std::get<double>(item(key).data);
}
int Values::integer(std::string_view key) const {
  return static_cast<int>(std::get<std::int64_t>(item(key).data));
}
bool Values::flag(std::string_view key) const {
  return std::get<bool>(item(key).data);
}
const std::string& Values::text(std::string_view key) const {
  return std::get<std::string>(item(key).data);
}

const std::vector<double>& Values::numbers(std::string_view key) const {
  static const std::vector<double> none;
  const Item& found = item(key);
  return std::holds_alternative<std::monostate>(found.data) ? none : std::get<std::vector<double>>(found.data);
}

const std::vector<std::string>& Values::texts(std::string_view key) const {
  static const std::vector<std::string> none;
  const Item& found = item(key);
  return std::holds_alternative<std::monostate>(found.data) ? none : std::get<std::vector<std::string>>(found.data);
}

const std::vector<Values>& Values::tables(std::string_view key) const {
  static const std::vector<Values> none;
  const Item& found = item(key);
  return std::holds_alternative<std::monostate>(found.data) ? none : std::get<std::vector<Values>>(found.data);
}

const Values& Values::table(std::string_view key) const {
  const auto& one = std::get<std::vector<Values>>(item(key).data);
  assert(one.size() == 1);
  return one.front();
}

const Values& Values::part(std::string_view key) const {
  return table(key);
}

bool Values::has(std::string_view key) const {
  return !std::holds_alternative<std::monostate>(item(key).data);
}
bool Values::given(std::string_view key) const {
  return item(key).given;
}
bool Values::is_word(std::string_view key) const {
  return std::holds_alternative<std::string>(item(key).data);
}

Where Values::where(std::string_view key) const {
  const auto found = items_.find(key);
  return found != items_.end() && found->second.given ? found->second.where : where_;
}

std::string Values::path(std::string_view key) const {
  if (key.empty()) return path_;
  return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
}

void fail(const Values& table, std::string_view key, const std::string& wanted, const std::string& found, const std::string& nearest) {
  throw InputError(table.where(key), table.path(key), wanted, found, nearest);
}

bool first_of_two(const Values& table, std::string_view first, std::string_view second) {
  const bool a = table.has(first), b = table.has(second);
  const std::string wanted = "either " + std::string(first) + " or " + std::string(second);
  if (a == b) fail(table, a ? second : "", wanted, a ? "both" : "neither");
  return a;
}

}  // namespace uplift
