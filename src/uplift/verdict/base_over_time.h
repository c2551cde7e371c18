#pragma once
#include <array>
#include <vector>

#include "uplift/verdict/base_shape.h"

namespace uplift {

/// One base of a run: what it carries at every step, and what it is at rest. Eccentricities and safeties are NaN where they have no meaning
/// (see BaseHistory).
class BaseOverTime {
 public:
  BaseOverTime(const BuiltCase& built, const RunResult& result, std::size_t number);

  const StepRecord::Instant& at(std::size_t step) const { return run.steps.at(step, index); }
  const StepRecord::Extremes& extremes() const { return run.steps.extremes[index]; }
  bool pressed() const { return rest.force > 0; }
  double shear(std::size_t step) const;                           // N
  double moment(std::size_t step) const;                          // N m
  double eccentricity(std::size_t step) const;                    // BaseShape::eccentricity
  double eccentricity(std::size_t step, std::size_t axis) const;  // e/B along t1 or t2
  double overturning(std::size_t step) const;                     // safety against overturning
  double sliding(std::size_t step) const;                         // safety against sliding

  const RunResult& run;
  std::size_t index;
  const Interface& interface;
  const InterfaceFacts& facts;
  BaseShape shape;
  Thrust rest;
  Thrust stabilises;             // of the weight, else as at rest
  double counted_as_weight = 0;  // N m: moment of constant loads other than the weight that is in `stabilises`, because it is the rest
  double least_force = 0;        // N: less is noise
  double largest_force = 0;      // N

 private:
  void find_what_stabilises(const BuiltCase& built);
  Thrust thrust(std::size_t step) const { return thrust_of(interface.space, at(step).axial, at(step).moment_1, at(step).moment_2); }
  bool carries(std::size_t step) const;
  double cohesive_share(std::size_t step) const;
};

/// What the verdict follows over time, for every instant of run.steps. NaN where it has no meaning: eccentricity and safeties while the
/// base carries less than a thousandth of its static force, safeties that are infinite.
enum class BaseHistory { uplifted_ratio, eccentricity_1, eccentricity_2, overturning_safety, sliding_safety };
std::vector<double> base_history(const BuiltCase& built, const RunResult& run, std::size_t interface, BaseHistory which);

}  // namespace uplift
