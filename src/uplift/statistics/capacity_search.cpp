#include "uplift/statistics/capacity_search.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <utility>

namespace uplift {

namespace {

using Results = std::map<double, RunOutcome>;

/// The first exceedance and the last survival below it; without an exceedance the largest survival.
struct Bracket {
  std::optional<double> survival, exceedance;
};

Bracket bracket(const Results& results, Unknown unknown) {
  Bracket found;
  for (const auto& [im, outcome] : results) {
    if (outcome == RunOutcome::unknown && unknown == Unknown::left_out) continue;
    const bool exceeds = outcome == RunOutcome::exceeded || (outcome == RunOutcome::unknown && unknown == Unknown::exceeded);
    if (exceeds) {
      found.exceedance = im;
      break;
    }
    found.survival = im;
  }
  return found;
}

/// Step `number` (from 0) of the hunt, as ratio of intensities: factor^1, 1, 1, 2, 3, 5, 8 ...
double hunting_step(int number, double factor) {
  double exponent = 1, next = 1;
  for (int i = 1; i < number; ++i) {
    const double after = exponent + next;
    exponent = next;
    next = after;
  }
  return std::pow(factor, exponent);
}

/// The middle of the largest gap between ascending numbers, the lowest of equal ones; nothing where none exceeds `least`.
std::optional<std::pair<double, double>> largest_gap(const std::vector<double>& numbers, double least) {
  std::optional<std::pair<double, double>> found;
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    const double gap = numbers[i] - numbers[i - 1];
    if (gap <= least * (1 + 1e-9)) continue;
    least = gap;
    found = {numbers[i - 1], numbers[i]};
  }
  return found;
}

}  // namespace

CapacitySearch::CapacitySearch(SearchPlan plan) : plan_(plan) {
  assert(plan.smallest > 0 && plan.smallest <= plan.start && plan.start <= plan.largest && std::isfinite(plan.largest));
  assert(plan.factor > 1 && plan.tolerance > 0);
}

void CapacitySearch::tell(double im, RunOutcome outcome) {
  const auto [place, fresh] = results_.emplace(im, outcome);
  if (!fresh && (place->second == RunOutcome::unknown || outcome == RunOutcome::exceeded) && outcome != RunOutcome::unknown)
    place->second = outcome;
}

std::optional<double> CapacitySearch::hunt() const {
  const Bracket known = bracket(results_, Unknown::left_out);
  const double lowest = results_.begin()->first, highest = results_.rbegin()->first;
  const auto below = static_cast<int>(std::distance(results_.begin(), results_.lower_bound(plan_.start)));
  const auto above = static_cast<int>(std::distance(results_.upper_bound(plan_.start), results_.end()));
  if (!known.survival && lowest > plan_.smallest) return std::max(plan_.smallest, lowest / hunting_step(below, plan_.factor));
  if (!known.exceedance && highest < plan_.largest) return std::min(plan_.largest, highest * hunting_step(above, plan_.factor));
  return std::nullopt;
}

std::optional<double> CapacitySearch::bisect() const {
  const Bracket known = bracket(results_, Unknown::left_out);
  if (!known.survival || !known.exceedance) return std::nullopt;
  std::vector<double> logarithms;  // of runs without outcome between the two, and of the two
  for (auto at = results_.find(*known.survival); at != results_.end() && at->first <= *known.exceedance; ++at)
    logarithms.push_back(std::log(at->first));
  const auto gap = largest_gap(logarithms, std::log1p(plan_.tolerance));
  return gap ? std::optional(std::exp((gap->first + gap->second) / 2)) : std::nullopt;
}

std::optional<double> CapacitySearch::fill() const {
  if (static_cast<int>(results_.size()) >= plan_.fill) return std::nullopt;
  const auto exceedance = bracket(results_, Unknown::left_out).exceedance;
  std::vector<double> intensities{0};
  for (const auto& [im, outcome] : results_)
    if (!exceedance || im <= *exceedance) intensities.push_back(im);
  if (intensities.size() > 1 && intensities[1] / 2 < plan_.smallest) intensities.erase(intensities.begin());
  const auto gap = largest_gap(intensities, 1e-9 * intensities.back());
  return gap ? std::optional((gap->first + gap->second) / 2) : std::nullopt;
}

std::optional<double> CapacitySearch::next() const {
  if (results_.empty()) return plan_.start;
  if (static_cast<int>(results_.size()) >= plan_.most) return std::nullopt;
  if (const auto im = hunt()) return im;
  if (const auto im = bisect()) return im;
  return fill();
}

std::optional<RecordCapacity> CapacitySearch::capacity(Unknown unknown) const {
  const Bracket counted = bracket(results_, unknown);
  if (counted.exceedance) return RecordCapacity{*counted.exceedance, counted.survival ? Known::exact : Known::at_most, plan_.largest};
  if (counted.survival) return RecordCapacity{*counted.survival, Known::at_least};
  return std::nullopt;
}

bool CapacitySearch::found() const {
  const Bracket known = bracket(results_, Unknown::left_out);
  if (known.survival && known.exceedance) return !bisect();
  return (known.survival && *known.survival >= plan_.largest) || (known.exceedance && *known.exceedance <= plan_.smallest);
}

std::vector<double> CapacitySearch::resurrections() const {
  std::vector<double> found;
  const auto first = bracket(results_, Unknown::left_out).exceedance;
  for (const auto& [im, outcome] : results_)
    if (first && im > *first && outcome == RunOutcome::survived) found.push_back(im);
  return found;
}

}  // namespace uplift
