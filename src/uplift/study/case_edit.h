#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "uplift/base/declare.h"

namespace uplift {

/// One value of a case file to be replaced. `path`: keys and places from the root, as in "stage[1].step"; numbers in SI. A word where a
/// table is wanted (law = "unilateral") becomes the table that it stands for.
struct CaseEdit {
  std::string path;
  std::variant<double, std::int64_t, std::string> value;
};

/// A copy of the tree with these values; tables that are missing are made. The tree itself is left as it is.
Raw edited(const Raw& raw, const std::vector<CaseEdit>& edits);

/// A number of a checked case and its declaration.
struct NumberAt {
  double value = 0;  // SI
  const Field* field = nullptr;
};
/// The number at a path of the form of CaseEdit; nothing where there is none. Tables under free keys are found by key: "nodes.top[1]".
/// `nearest` becomes the path with the nearest name in place of a key that its table does not have; empty where none is near.
std::optional<NumberAt> number_at(const Values& root, std::string_view path, std::string* nearest = nullptr);

}  // namespace uplift
