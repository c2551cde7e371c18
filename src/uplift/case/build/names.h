#pragma once
#include <functional>
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
  /// Adds as many numbered names that the program makes, prefix + number(0), prefix + number(1), ... with ascending numbers: of a large
  /// mesh its nodes. They take no memory. Once at most.
  void add_numbered(std::string prefix, int count, std::function<int(int)> number, const Where& where, const std::string& path);
  /// A second name of something that was added; it must not be there yet.
  void also(const std::string& name, int index);
  bool has(const std::string& name) const { return index_of(name) >= 0; }
  /// Index of a name used at this place; InputError with the nearest name when it does not exist.
  int find(const std::string& name, const Where& where, const std::string& path) const;
  int find(const NameUsed& name) const { return find(name.name, name.where(), name.path()); }
  int find(const Values& table, std::string_view key) const { return find(table.text(key), table.where(key), table.path(key)); }
  std::string operator[](int index) const;
  int size() const { return static_cast<int>(names_.size()) + numbered_.count; }

 private:
  struct Numbered {
    std::string prefix;
    int first = 0, count = 0, line = 0;  // first: index; line: of where they are made
    std::function<int(int)> number;
    std::string operator[](int i) const { return prefix + std::to_string(number(i)); }
    int find(const std::string& name) const;  // from 0 on; -1: it is none of them
  };
  int index_of(const std::string& name) const;  // -1: it is not there
  bool is_numbered(int index) const { return index >= numbered_.first && index < numbered_.first + numbered_.count; }
  /// Of an index that is not numbered.
  const std::pair<std::string, int>& given(int index) const {
    return names_[static_cast<std::size_t>(index < numbered_.first ? index : index - numbered_.count)];
  }
  [[noreturn]] void refuse_second(const std::string& name, int line, const Where& where, const std::string& path) const;

  std::string what_;
  std::vector<std::pair<std::string, int>> names_;  // of all but the numbered ones, each with its line; 0: none
  Numbered numbered_;
  std::vector<std::string> also_;
  std::unordered_map<std::string, int> index_;
};

}  // namespace uplift
