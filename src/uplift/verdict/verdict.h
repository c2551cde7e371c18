#pragma once
#include <string>
#include <vector>

#include "uplift/verdict/floor_spectra.h"
#include "uplift/verdict/motion.h"
#include "uplift/verdict/numbers.h"
#include "uplift/verdict/step_check.h"

namespace uplift {

/// The result of a run in numbers and in words: whether the base uplifts, how much, when, for how long, and what that changes compared with
/// the bonded model.
struct Verdict {
  enum class Level { none, uplift, overturned, separated, failed } level = Level::none;
  std::string headline;     // does it uplift?
  std::string consequence;  // what that changes: compared with the bonded run and the user's limits; empty when there is neither
  struct Fact {
    std::string label, value, detail;
    bool tile = true;              // shown large on the report's first page; else it stands in a table there
    std::string step_change = {};  // "±0.3 %": how far the step still moves it; empty: unknown
  };
  std::vector<Fact> facts;
  std::vector<std::string> paragraphs;
  VerdictNumbers numbers;
  StepCheck step_check;
};
std::string_view to_string(Verdict::Level);

/// `bonded`: the same model with interfaces that never open, or null. `floors`: those of the run, or null. `companion`: the case with twice
/// the step, or null. Limits are those of the case: none is built in.
Verdict judge(const BuiltCase& built, const RunResult& run, const RunResult* bonded, const FloorRun* floors = nullptr,
              const Companion* companion = nullptr);

}  // namespace uplift
