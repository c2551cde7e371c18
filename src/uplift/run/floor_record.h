#pragma once
#include <utility>
#include <vector>

#include "uplift/run/result.h"

namespace uplift {

/// What the records of a plan take: 8 bytes for every floor and step.
double floor_record_bytes(const RunPlan& plan);

/// Accelerations are recorded at every step: of floors or as columns.
bool records_accelerations(const RunPlan& plan);

/// Keeps the absolute accelerations of the floors of a plan, at every step.
class FloorRecorder {
 public:
  /// For so many steps [s] of a dynamic stage, whose room is taken here; a later stage goes on in the same records.
  FloorRecorder(const Model& model, const RunPlan& plan, long steps, double step, Recorded& result);
  bool any() const { return !sources_.empty(); }
  /// `acceleration`: of the free unknowns, mean from one time to another (or at one time), relative to the moving frame where there is one.
  void record(const Vector& acceleration, double from, double to);

 private:
  /// Along the floor's direction: shares of the free unknowns, of moved supports and of the ground.
  struct Source {
    std::vector<std::pair<int, double>> unknowns;
    std::vector<std::pair<const TimeFunction*, double>> supports, ground;
  };
  std::vector<Source> sources_;
  Recorded& result_;
};

}  // namespace uplift
