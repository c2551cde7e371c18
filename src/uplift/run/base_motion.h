#pragma once
#include <array>
#include <utility>
#include <vector>

#include "uplift/model/model.h"
#include "uplift/run/step_record.h"

namespace uplift {

/// How a base moves as a whole: settlement and tilt of the plane that fits the vertical motion of its nodes best, as sums over the
/// unknowns. The settlement is that of the point of the interface to which moments refer. A single node with rotations is a rigid body.
class BaseMotion {
 public:
  /// Nothing moves when there are no nodes.
  BaseMotion(const Model& model, const Interface& interface, const std::vector<int>& nodes);
  /// Sets settlement and tilt.
  void look(const State& state, BasePose& pose) const;

 private:
  struct Sum {
    std::vector<std::pair<int, double>> terms;                      // of the free unknowns
    std::vector<std::pair<const TimeFunction*, double>> functions;  // of the prescribed motions
  };
  static double value(const Sum& sum, const State& state);
  std::array<Sum, 3> sums_;  // settlement, tilts
};

}  // namespace uplift
