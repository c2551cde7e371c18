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
  /// The memory at a state before which no step was filtered: by the slopes of the laws there. `memory` is zero, and has its sizes.
  void begin_anew(const State& now, FilterMemory& memory) const;
  /// Goes on from what this state remembers.
  void take_over(const State& now);
  /// Writes what take_over() needs.
  void give(FilterMemory& memory) const;
  /// Scales what is remembered, before a shorter step: `shrink` < 1.
  void shorten(double shrink);
  /// Coefficients and lags of the step to come, for whoever solves it.
  void begin(JointFilterInput& input);
  /// Takes over the step that was just solved; `input` goes on to the next one.
  void end(const InterfaceProblem& problem, const InterfaceSolution& solution, const State& now, const State& next,
           JointFilterInput& input);
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
    double filtered[most_components] = {}, stored = 0;  // increments [m, rad], and d_f . C d_f at the end of the step before [J]
    // of the step to come: elastic openings at its start, d_f [m, rad] and C [N/m, N m/rad]; zero without contact
    double elastic[most_components] = {}, lag[most_components] = {}, coefficient[most_components * most_components] = {};
  };
  void look(Footing& footing, const State& now) const;
  static void begin_footing(Footing& footing, JointFilterInput& input);
  double end_footing(Footing& footing, const InterfaceSolution& solution, double to_mean, const State& now, const State& next,
                     JointFilterInput& input) const;
  template <int N>
  static void begin_rows(Footing& footing, JointFilterInput& input);
  template <int N>
  double end_rows(Footing& footing, const InterfaceSolution& solution, double to_mean, const State& now, const State& next,
                  JointFilterInput& input) const;

  std::vector<Block> blocks_;
  std::vector<Part> parts_;
  std::vector<Footing> footings_;
  double pole_, gain_;
  JointFilterInput taken_over_;
  JointFilterInput* ready_ = nullptr;  // of the step to come: that, or that of the last solver
  double storage_ = 0, dissipated_ = 0;
};

}  // namespace uplift
