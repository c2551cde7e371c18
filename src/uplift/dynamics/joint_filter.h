#pragma once
#include <vector>

#include "uplift/dynamics/condensed.h"
#include "uplift/dynamics/scheme.h"

namespace uplift {

/// The interfaces' part of the scheme of filtered energy decay from step to step (laws/filter.h, docs/theory, section 3): which rows are
/// filtered in a step, what the filter remembers, and what it stores and dissipates.
class JointFilter {
 public:
  JointFilter(const Model& model, const Behaviours& behaviours, const Scheme& scheme);
  /// Slopes of the laws at the present opening, where the step before does not tell them.
  void look(const State& now, Vector& tangent) const;
  /// Coefficients and lags of the step of this length [s] that begins at `now`. `shrink` <= 1 scales what is remembered, after a change of
  /// the step.
  const JointFilterInput& begin(const State& now, double shrink);
  /// Takes over the step that was just solved: memory and slopes at its end.
  void end(const InterfaceProblem& problem, const InterfaceSolution& solution, const State& now, State& next);
  double storage() const { return storage_; }        // J, at the end of the step
  double dissipated() const { return dissipated_; }  // J, in the step

 private:
  struct Part {  // of one interface
    int first = 0, first_slope = 0, points = 0, components = 0;
    double stiffness[3] = {};   // of a point without rotations: closed joint [Pa/m]
    Vector area, inverse_area;  // m2, 1/m2
  };
  std::vector<Block> blocks_;
  std::vector<Part> parts_;
  double pole_, gain_;
  JointFilterInput input_;
  double storage_ = 0, dissipated_ = 0;
};

}  // namespace uplift
