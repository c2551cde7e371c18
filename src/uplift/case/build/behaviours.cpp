#include "uplift/case/build/behaviours.h"

#include "uplift/laws/stated.h"

namespace uplift {

/// Values as they would be read from a file again, with one number replaced.
Values with_number(const Values& part, std::string_view key, double number) {
  auto table = std::make_shared<RawTable>();
  const auto add = [&](std::string_view name, auto data) {
    table->entries.emplace_back(std::string(name), Raw{std::move(data), part.where(name), part.path(name)});
  };
  add("type", part.type());
  for (const auto& [name, item] : part.items()) {
    if (name == key || !item.given) continue;
    if (const auto* flag = std::get_if<bool>(&item.data)) add(name, *flag);
    if (const auto* whole = std::get_if<std::int64_t>(&item.data)) add(name, *whole);
    if (const auto* real = std::get_if<double>(&item.data)) add(name, *real);
    if (const auto* text = std::get_if<std::string>(&item.data)) add(name, *text);
  }
  add(key, number);
  return check_part(Raw{table, part.where(), part.path()}, interface_behaviours());
}

/// An elastic joint that never opens, with the damping of the one that may: what differs between the runs is the uplift alone.
Values bonded_behaviour(const Values& like, const std::vector<double>& stiffness) {
  auto table = std::make_shared<RawTable>();
  const auto add = [&](const char* name, auto data) { table->entries.emplace_back(name, Raw{std::move(data), like.where(), like.path()}); };
  add("type", std::string("elastic"));
  add("K_n", stiffness.back());
  if (const auto dashpot = stated_numbers(like).dashpot) add("c", *dashpot);
  if (stiffness.size() > 1 && stiffness.front() > 0)
    add("K_t", stiffness.front());
  else
    add("tangential", std::string("none"));
  return check_part(Raw{table, like.where(), like.path()}, interface_behaviours());
}

Values bonded_foundation(const Values& like, const Interface& foundation) {
  std::vector<double> k(static_cast<std::size_t>(foundation.batch.components));
  foundation.law->closed_stiffness(foundation.batch.components, k.data());
  auto table = std::make_shared<RawTable>();
  const auto add = [&](const char* name, auto data) { table->entries.emplace_back(name, Raw{std::move(data), like.where(), like.path()}); };
  add("type", std::string("elastic"));
  const auto keys = foundation_stiffness_keys(foundation.batch.components);
  for (std::size_t r = 0; r < keys.size(); ++r) add(keys[r], k[r]);
  return check_part(Raw{table, like.where(), like.path()}, foundation_models());
}

}  // namespace uplift
