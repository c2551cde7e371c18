#pragma once
#include <span>
#include <string_view>

namespace uplift {

/// A number that the verdict gives. Its name is the one in summary.json and in [[verdict.criterion]].
struct VerdictQuantity {
  std::string_view name, unit, meaning;
  bool of_interface = true;  // else of the run as a whole
  bool at_least = false;     // a criterion asks for at least its limit; else for at most
};
/// All of them, in the order in which they are shown.
std::span<const VerdictQuantity> verdict_quantities();
/// The one of this name; null when there is none.
const VerdictQuantity* find_verdict_quantity(std::string_view name);

}  // namespace uplift
