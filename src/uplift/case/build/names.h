#pragma once
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "uplift/case/schema/case_table.h"

namespace uplift {

/// Names head columns of tables: refused are empty ones, control characters, more than 200 bytes, and beginnings that spreadsheets take for
/// a formula. `of`: "the node".
void check_name(const std::string& name, const std::string& of, const Where& where, const std::string& path);

/// Names of one kind, given in the case file and referred to from elsewhere in it.
class Names {
 public:
  /// `what`: "node"; used in messages.
  explicit Names(std::string what) : what_(std::move(what)) {}
  /// Adds the name under a key of a table, or `automatic` when the key is absent. Returns its index. Throws InputError when it is used
  /// already.
  int add(const Values& table, std::string_view key, std::string automatic = {});
  int add(const NameUsed& name) { return add(name.name, name.where(), name.path()); }
  /// Adds a name that the program made at this place.
  int add(std::string name, const Where& where, const std::string& path);
  /// A second name of something that was added; it must not be there yet.
  void also(const std::string& name, int index);
  void reserve(std::size_t more) { names_.reserve(names_.size() + more), index_.reserve(index_.size() + more); }
  bool has(const std::string& name) const { return index_.contains(name); }
  /// Index of a name used at this place; InputError with the nearest name when it does not exist.
  int find(const std::string& name, const Where& where, const std::string& path) const;
  int find(const NameUsed& name) const { return find(name.name, name.where(), name.path()); }
  int find(const Values& table, std::string_view key) const { return find(table.text(key), table.where(key), table.path(key)); }
  const std::string& operator[](int index) const { return names_[index].first; }
  int size() const { return static_cast<int>(names_.size()); }

 private:
  std::string what_;
  std::vector<std::pair<std::string, Where>> names_;
  std::vector<std::string> also_;
  std::unordered_map<std::string, int> index_;
};

}  // namespace uplift
