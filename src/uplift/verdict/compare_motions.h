#pragma once
#include <deque>
#include <string>
#include <vector>

#include "uplift/case/case.h"
#include "uplift/verdict/verdict.h"

namespace uplift {

/// Largest magnitudes of one variant (with one damping) under every motion of the comparison.
struct MotionTable {
  struct Quantity {
    std::string key, label, unit;
  };
  struct Row {
    std::string motion;  // as shown
    RunStatus status = RunStatus::completed;
    std::vector<double> peaks;
  };
  std::string run, damping;          // labels; damping is empty when there is but one
  std::vector<Quantity> quantities;  // columns
  std::vector<Row> rows;             // one per motion
  int counted = 0;                   // completed runs: those of the three rows below
  std::vector<double> envelope;      // the largest
  std::vector<double> mean, spread;  // spread: standard deviation of the sample (over n - 1); zero for one run
};

/// The quantities that a table can have.
std::vector<MotionTable::Quantity> motion_quantities();

/// One table per variant and damping, the bonded model among them; none without [[compare.motion]]. Quantities that a model does not have
/// (no top, no interface) are left out; a bonded base stretches instead of opening.
std::vector<MotionTable> motion_tables(const std::vector<RunSpec>& specs, const std::deque<BuiltCase>& built,
                                       const std::vector<RunResult>& results);

/// One variant under one motion, with its verdict.
struct JudgedMotion {
  std::string motion;  // as shown
  const RunResult* run = nullptr;
  Verdict verdict;
};
/// Place of the hardest motion, the first of equals: by what becomes of the structure, the number of criteria that are not met, the
/// uplifted share, the gap, the base moment. One motion at least.
std::size_t hardest(const std::vector<JudgedMotion>& judged);
/// What a page on the hardest motion has to say of all: which one it shows, mean and largest of the table's quantities, criteria.
std::string said_over_motions(const std::vector<JudgedMotion>& judged, const MotionTable& table);

}  // namespace uplift
