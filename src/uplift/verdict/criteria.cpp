#include "uplift/verdict/criteria.h"

#include <cmath>

namespace uplift {
namespace {

using Result = CriterionResult::State;

/// The absence of a number says that nothing was asked of the base: no gap opened, no interval is without contact, nothing hit.
bool met_where_absent(const VerdictQuantity& quantity, const std::vector<VerdictNumber>& numbers) {
  const VerdictNumber* open = find_number(numbers, "max_uplifted_ratio");  // of bases, whose run got to an instant
  return open && (quantity.is("longest_full_loss") || quantity.is("max_impulse") || (quantity.is("first_uplift") && !(open->value > 0)));
}

/// Any other number that there is not leaves the criterion open.
CriterionResult result_of(const Criterion& criterion, const std::vector<VerdictNumber>& numbers, const std::string& interface) {
  CriterionResult result{criterion, interface};
  const VerdictNumber* number = find_number(numbers, *criterion.quantity);
  if (!number) {
    if (met_where_absent(*criterion.quantity, numbers)) result.state = Result::met;
    return result;
  }
  result.value = number->value;
  result.time = number->time;
  const double size = criterion.quantity->name.starts_with("change_of") ? number->value : std::abs(number->value);
  const bool met = criterion.quantity->at_least ? number->value >= criterion.limit : size <= criterion.limit;
  result.state = met ? Result::met : Result::not_met;
  return result;
}

}  // namespace

std::string_view to_string(CriterionResult::State state) {
  switch (state) {
    case CriterionResult::State::met:
      return "met";
    case CriterionResult::State::not_met:
      return "not met";
    case CriterionResult::State::undetermined:
      return "undetermined";
  }
  return "";
}

void add_results(const Criterion& criterion, VerdictNumbers& numbers) {
  if (criterion.quantity->of_beam()) {
    for (const BeamVerdict& beam : numbers.beams)
      if (criterion.beam.empty() || beam.name == criterion.beam || beam.name.starts_with(criterion.beam + ", line "))
        numbers.criteria.push_back(result_of(criterion, beam.numbers, beam.name));
    return;
  }
  if (!criterion.quantity->of_interface()) {
    numbers.criteria.push_back(result_of(criterion, numbers.whole, ""));
    return;
  }
  // Without an interface a criterion is for all bases; for all walls where its quantity is one of walls alone.
  const auto concerned = [&](std::size_t k) {
    if (criterion.interface >= 0) return criterion.interface == static_cast<int>(k);
    return numbers.interfaces[k].role == Role::base ? criterion.quantity->of_base() : !criterion.quantity->of_base();
  };
  for (std::size_t k = 0; k < numbers.interfaces.size(); ++k)
    if (concerned(k)) numbers.criteria.push_back(result_of(criterion, numbers.interfaces[k].numbers, numbers.interfaces[k].name));
}

}  // namespace uplift
