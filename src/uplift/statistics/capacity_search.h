#pragma once
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "uplift/statistics/fragility.h"

namespace uplift {

/// How the capacity of one record is searched. Intensities in any unit.
struct SearchPlan {
  double start = 0;         // first intensity
  double smallest = 0;      // the search goes no lower; > 0
  double largest = 0;       // and no higher
  double factor = 1.37;     // first step of the hunt; 16 tolerances of 2 %, so that four bisections are enough
  double tolerance = 0.02;  // of the capacity, relative
  int fill = 0;             // intensities in all, when the capacity has been found: the largest gaps below it are filled up to this number
  int most = 30;            // runs in all
};

enum class RunOutcome { survived, exceeded, unknown };

/// The search of one record in an incremental dynamic analysis, as a value: hunt with steps ln(factor) * 1, 1, 1, 2, 3, 5 ... from the
/// start upwards or downwards, bisection in ln im between the last survival and the first exceedance, then the largest gaps. The state
/// depends on the set of results only: told in any order they give the same next intensity and the same capacity. Runs without outcome are
/// not repeated: the search goes around them, and the capacity has two ends.
class CapacitySearch {
 public:
  /// A plan with 0 < smallest <= start <= largest, factor > 1, tolerance > 0 (asserted).
  explicit CapacitySearch(SearchPlan);
  /// The next intensity to run; nothing when the search is complete.
  std::optional<double> next() const;
  /// The result at an intensity. Told twice, a known outcome replaces `unknown`, and `exceeded` replaces `survived`.
  void tell(double im, RunOutcome);

  /// All intensities with their outcomes, ascending.
  const std::map<double, RunOutcome>& results() const { return results_; }
  /// The first exceedance, `at_least` the largest survival when nothing exceeds up to the largest intensity, `at_most` the smallest when it
  /// exceeds already. Runs without outcome count as said (`left_out`: as if they had not been run). Nothing without a result that counts.
  std::optional<RecordCapacity> capacity(Unknown) const;
  /// True when the first exceedance and the last survival below it are within the tolerance, or the capacity is beyond an end of the range.
  bool found() const;
  /// Survivals above the first exceedance, ascending.
  std::vector<double> resurrections() const;
  const SearchPlan& plan() const { return plan_; }

 private:
  std::optional<double> hunt() const;
  std::optional<double> bisect() const;
  std::optional<double> fill() const;

  SearchPlan plan_;
  std::map<double, RunOutcome> results_;
};

}  // namespace uplift
