#pragma once
#include <span>
#include <string>
#include <string_view>

namespace uplift {

/// A number that the verdict gives. Its name is the one in summary.json and in [[verdict.criterion]].
struct VerdictQuantity {
  std::string_view name, unit, meaning;
  std::string_view brief;    // a few words for tables
  bool of_interface = true;  // else of the run as a whole
  bool at_least = false;     // a criterion asks for at least its limit; else for at most
  bool of_base = true, of_wall = false;
  bool of_beam = false;  // of a beam with a [[output.beam_envelope]]
};
/// All of them, in the order in which they are shown.
std::span<const VerdictQuantity> verdict_quantities();
/// Whether it is a share of one or a change, which is said in per cent.
bool is_share(const VerdictQuantity&);
/// Whether it can be near zero beside what it is a number of: shares, changes, instants, residuals. A band of such a number is from ... to.
bool near_zero(const VerdictQuantity&);
/// Below this a number of the unit is nothing beside the precision of a run.
double nothing_beside(std::string_view unit);
/// A number as an engineer says it: shares and changes in per cent; what is nothing beside the precision of a run as 0.
std::string format_value(const VerdictQuantity&, double value);
/// The one of this name; null when there is none.
const VerdictQuantity* find_verdict_quantity(std::string_view name);

}  // namespace uplift
