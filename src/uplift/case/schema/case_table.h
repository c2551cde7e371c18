#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "uplift/base/declare.h"
#include "uplift/elements/space.h"

// Tables of the case file as structs. The keys of a table are read in one place, right below its declaration.
namespace uplift {

/// What the struct of a table keeps of the file: places for messages.
struct CaseTable {
  const Values* table = nullptr;
  /// Of a key, or of the table.
  Where where(std::string_view key = {}) const { return table->where(key); }
  std::string path(std::string_view key = {}) const { return table->path(key); }
};
/// Throws the InputError of a key, see fail(const Values&, ...).
[[noreturn]] void fail(const CaseTable& table, std::string_view key, const std::string& wanted, const std::string& found,
                       const std::string& nearest = {});

/// A name that a table gives, or uses for something named elsewhere: a node, a group, a function.
struct NameUsed {
  std::string name;
  const Values* table = nullptr;  // that uses it ...
  std::string_view key;           // ... here
  Where where() const { return table->where(key); }
  std::string path() const { return table->path(key); }
};
[[noreturn]] void fail(const NameUsed& name, const std::string& wanted, const std::string& found, const std::string& nearest = {});

NameUsed name_used(const Values& table, std::string_view key);
/// Of a list; empty when the key is absent.
std::vector<NameUsed> names_used(const Values& table, std::string_view key);
// Nothing when the key is absent.
std::optional<NameUsed> name_if(const Values& table, std::string_view key);
std::optional<double> number_if(const Values& table, std::string_view key);
std::optional<Vec3> vector_if(const Values& table, std::string_view key, Space space);
/// As stated, else this text.
std::string text_or(const Values& table, std::string_view key, std::string absent);
/// The table below this key; null when it is absent.
const Values* table_if(const Values& values, std::string_view key);

/// What a table acts on: a node, or all nodes of a group.
struct NodeOrGroup : CaseTable {
  std::optional<NameUsed> node, group;
  /// The name of the one that is given.
  const std::string& name() const { return node ? node->name : group->name; }
};
/// From the keys node and group; InputError unless exactly one is given.
NodeOrGroup node_or_group(const Values& table);

}  // namespace uplift
