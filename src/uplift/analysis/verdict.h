#pragma once
#include <string>
#include <vector>

#include "uplift/analysis/floor_spectra.h"
#include "uplift/analysis/verdict_numbers.h"

namespace uplift {

/// What a run says, in numbers and in words: does it uplift, how much, when, for how long, and what that does beside the bonded base.
struct Verdict {
  enum class Level { none, uplift, overturned, separated, failed } level = Level::none;
  std::string headline;     // does it uplift?
  std::string consequence;  // and so what? Beside the bonded run and the user's limits; empty when there is neither
  struct Fact {
    std::string label, value, detail;
    bool tile = true;  // shown large on the report's first page; else it stands in a table there
  };
  std::vector<Fact> facts;
  std::vector<std::string> paragraphs;
  VerdictNumbers numbers;
};
std::string_view to_string(Verdict::Level);

/// `bonded`: the same model with interfaces that never open, or null. `floors`: those of the run, or null. Limits are those of the case:
/// none is built in.
Verdict judge(const Built& built, const RunResult& run, const RunResult* bonded, const FloorRun* floors = nullptr);

/// Column of a result: by kind and by unknown or interface. Null when it was not recorded.
const std::vector<double>* find_column(const RunResult& result, Request::Kind kind, int unknown_or_interface);
/// The largest horizontal motion of the top: in space that of the direction in which it is larger. Null when it was not recorded.
const Peak* top_motion(const Built&, const RunResult&);
/// Peak of a column of a result; null like find_column.
const Peak* find_peak(const RunResult& result, Request::Kind kind, int unknown_or_interface);

}  // namespace uplift
