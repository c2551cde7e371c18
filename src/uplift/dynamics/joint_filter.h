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
  /// Goes on from what this state remembers.
  void take_over(const State& now);
  /// Coefficients and lags of the step that begins at `now`. `shrink` <= 1 scales what is remembered, after a change of the step.
  void begin(const State& now, double shrink, JointFilterInput& input);
  /// Takes over the step that was just solved: memory and slopes at its end. `input` goes on to the next step of the same length.
  void end(const InterfaceProblem& problem, const InterfaceSolution& solution, const State& now, State& next, JointFilterInput& input);
  double storage() const { return storage_; }        // J, at the end of the step
  double dissipated() const { return dissipated_; }  // J, in the step

 private:
  struct Part {  // of one interface
    int first = 0, first_slope = 0, points = 0, components = 0;
    double stiffness[3] = {};  // of a point without rotations: closed joint [Pa/m]
    Vector area;               // m2
  };
  struct Footing {  // a point with rotations, filtered as a whole
    const InterfaceLaw* law = nullptr;
    int first = 0, first_history = 0, components = 0;
    // of the step: elastic openings at its start, d_f [m, rad] and C [N/m, N m/rad]; zero without contact
    double elastic[most_components] = {}, lag[most_components] = {}, coefficient[most_components * most_components] = {};
  };
  void look(Footing& footing, const State& now) const;
  /// Seldom, and out of line: its registers would be saved in every step.
  [[gnu::noinline]] void begin_anew(const State& now, double shrink, JointFilterInput& input);
  void begin_footing(Footing& footing, const State& now, double shrink, JointFilterInput& input) const;
  double end_footing(Footing& footing, const InterfaceSolution& solution, double to_mean, const State& now, State& next,
                     JointFilterInput& input) const;
  template <int N>
  void begin_rows(Footing& footing, const State& now, double shrink, JointFilterInput& input) const;
  template <int N>
  double end_rows(Footing& footing, const InterfaceSolution& solution, double to_mean, const State& now, State& next,
                  JointFilterInput& input) const;

  std::vector<Block> blocks_;
  std::vector<Part> parts_;
  std::vector<Footing> footings_;
  double pole_, gain_;
  const JointFilterInput* ready_ = nullptr;  // `end` has made it for the next step already
  double storage_ = 0, dissipated_ = 0;
};

}  // namespace uplift
