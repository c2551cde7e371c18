#pragma once
#include <deque>
#include <string>
#include <vector>

#include "uplift/analysis/case.h"

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

/// One table per variant and damping, the bonded model among them; none without [[compare.motion]]. Quantities that a model does not have
/// (no top, no interface) are left out; a bonded base stretches instead of opening.
std::vector<MotionTable> motion_tables(const std::vector<RunSpec>& specs, const std::deque<Built>& built,
                                       const std::vector<RunResult>& results);

}  // namespace uplift
