#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "uplift/analysis/case.h"

namespace uplift {

/// One number of the verdict. Forces, eccentricities and rotations are magnitudes; a settlement is positive downwards.
struct VerdictNumber {
  const VerdictQuantity* quantity = nullptr;
  double value = 0;
  std::optional<double> time = {};    // s, where it is reached
  std::optional<double> bonded = {};  // the same number of the bonded run
  std::optional<double> swing = {};   // half of the range in which a residual still moves
};

/// What is said of one interface.
struct InterfaceVerdict {
  std::string name;
  double weight = 0, mean_pressure = 0;  // N, Pa: of the static state; 0 when nothing presses
  std::array<double, 2> width{};         // m, along t1 and t2
  std::vector<VerdictNumber> numbers;    // those that there are, in the order of verdict_quantities()
  struct Above {
    double threshold = 0, duration = 0;  // 1, s
  };
  std::vector<Above> above;
  std::vector<Interval> full_loss;  // without any contact
};

struct CriterionResult {
  Criterion criterion;
  std::string interface;  // empty: of the run
  enum class State { met, not_met, undetermined } state = State::undetermined;
  std::optional<double> value = {};
  std::optional<double> time = {};
};
std::string_view to_string(CriterionResult::State);

/// The largest section forces of a beam whose envelope was asked for.
struct BeamVerdict {
  std::string name;
  std::vector<VerdictNumber> numbers;
};

struct VerdictNumbers {
  std::vector<VerdictNumber> whole;  // of the run
  std::vector<InterfaceVerdict> interfaces;
  std::vector<BeamVerdict> beams;
  std::vector<CriterionResult> criteria;
};

/// From what the run kept of every step. `bonded`: the same model with interfaces that never open, or null.
VerdictNumbers numbers_of(const Built& built, const RunResult& run, const RunResult* bonded);

/// The number of this name; null when there is none.
const VerdictNumber* find_number(const std::vector<VerdictNumber>& numbers, std::string_view name);

/// What the verdict follows over time, for every instant of run.steps. NaN where it has no meaning: eccentricity and safeties while the
/// base carries less than a thousandth of its static force, safeties that are infinite.
enum class BaseHistory { uplifted_ratio, eccentricity_1, eccentricity_2, overturning_safety, sliding_safety };
std::vector<double> base_history(const Built& built, const RunResult& run, std::size_t interface, BaseHistory which);

/// Share of a Winkler strip that really uplifts where a linear analysis has tension on the share t: M_lin/M_u = 1/(1 - 2t), and equal
/// energies (docs/theory, eq 31). Nothing for t >= 1/2, where the linear moment has no bound.
std::optional<double> uplift_of_tension(double t);

}  // namespace uplift
