#include "uplift/case/schema/case_table.h"

#include "uplift/elements/element_entry.h"

namespace uplift {

void fail(const CaseTable& table, std::string_view key, const std::string& wanted, const std::string& found, const std::string& nearest) {
  fail(*table.table, key, wanted, found, nearest);
}

void fail(const NameUsed& name, const std::string& wanted, const std::string& found, const std::string& nearest) {
  fail(*name.table, name.key, wanted, found, nearest);
}

NameUsed name_used(const Values& table, std::string_view key) {
  return {table.text(key), &table, key};
}

std::vector<NameUsed> names_used(const Values& table, std::string_view key) {
  std::vector<NameUsed> used;
  for (const std::string& name : table.texts(key)) used.push_back({name, &table, key});
  return used;
}

std::optional<NameUsed> name_if(const Values& table, std::string_view key) {
  return table.has(key) ? std::optional(name_used(table, key)) : std::nullopt;
}

std::optional<double> number_if(const Values& table, std::string_view key) {
  return table.has(key) ? std::optional(table.number(key)) : std::nullopt;
}

std::optional<Vec3> vector_if(const Values& table, std::string_view key, Space space) {
  return table.has(key) ? std::optional<Vec3>(vector_of(table, key, space)) : std::nullopt;
}

std::string text_or(const Values& table, std::string_view key, std::string absent) {
  return table.has(key) ? table.text(key) : std::move(absent);
}

const Values* table_if(const Values& values, std::string_view key) {
  return values.has(key) ? &values.table(key) : nullptr;
}

NodeOrGroup node_or_group(const Values& table) {
  const bool node = table.has("node");
  if (node == table.has("group")) fail(table, node ? "group" : "", "either node or group", node ? "both" : "neither");
  return {{&table}, name_if(table, "node"), name_if(table, "group")};
}

}  // namespace uplift
