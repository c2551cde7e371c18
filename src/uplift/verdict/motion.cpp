#include "uplift/verdict/motion.h"

#include <algorithm>
#include <cmath>

#include "uplift/case/build/output.h"

namespace uplift {
namespace {

using Column = Request::Kind;

const CombinedPeak* find_combined(const BuiltCase& built, const RunResult& result, std::string_view name) {
  const std::vector<CombinedRequest>& asked = built.plan.combined;
  for (std::size_t k = 0; k < asked.size() && k < result.combined.size(); ++k)
    if (asked[k].name == name && result.combined[k].known) return &result.combined[k];
  return nullptr;
}

std::optional<Peak> peak_of(const CombinedPeak* found) {
  return found == nullptr ? std::nullopt : std::optional(Peak{"", "m", found->value, found->time});
}

}  // namespace

const std::vector<double>* find_column(const RunResult& result, Column kind, int of) {
  const int index = find_request(result.columns, kind, of);
  return index < 0 || static_cast<std::size_t>(index) + 1 >= result.table.size() ? nullptr
                                                                                 : &result.table[static_cast<std::size_t>(index) + 1];
}

const Peak* find_peak(const RunResult& result, Column kind, int of) {
  const int index = find_request(result.columns, kind, of);
  return index < 0 || static_cast<std::size_t>(index) >= result.peaks.size() ? nullptr : &result.peaks[static_cast<std::size_t>(index)];
}

std::optional<Peak> top_motion(const BuiltCase& built, const RunResult& result) {
  return peak_of(find_combined(built, result, combined_top));
}

std::optional<Peak> largest_drift(const BuiltCase& built, const RunResult& result, Drift rotation) {
  return peak_of(find_combined(built, result, rotation == Drift::with_rotation ? combined_drift : combined_bending));
}

double range_of_top(const BuiltCase& built, const RunResult& result) {
  double range = 0;
  for (const std::string_view name : {combined_top, combined_top_up})
    if (const CombinedPeak* found = find_combined(built, result, name))
      for (std::size_t c = 0; c < found->least.size(); ++c) range = std::max(range, (found->most[c] - found->least[c]) / 2);
  return range;
}

}  // namespace uplift
