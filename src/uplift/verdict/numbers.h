#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "uplift/case/case.h"

namespace uplift {

/// One number of the verdict. Forces and eccentricities are magnitudes; a settlement is positive downwards. The rotation
/// (counter-clockwise) and the slip that are left have their sign in the plane and are magnitudes in space.
struct VerdictNumber {
  const VerdictQuantity* quantity = nullptr;
  double value = 0;
  std::optional<double> time = {};    // s, where it is reached
  std::optional<double> bonded = {};  // the same number of the bonded reference run
  std::optional<double> swing = {};   // half of the range in which a residual still moves; of a vector the largest distance from its mean
  std::optional<double> change = {};  // relative to it: 0.1 is 10 % more; nothing where both are noise
  std::optional<double> step_peak = {};  // largest mean over one step, of numbers that are means over the window
  // With twice the step, and by how much that changes the number, relative to what check_step() compares it with
  std::optional<double> coarse = {}, step_change = {};
  double least = 0;  // in the unit of the quantity: a value below it is noise
};

/// What is said of one interface.
struct InterfaceVerdict {
  std::string name;
  Role role = Role::base;
  double weight = 0, mean_pressure = 0;  // N, Pa: of the static state; 0 when nothing presses
  std::array<double, 2> width{};         // m, along t1 and t2
  bool round = false;                    // BaseShape::Outline
  bool springs = false;                  // points on a joint, neither constraints nor a whole foundation
  double counted_as_weight = 0;          // N m, see BaseOverTime
  std::vector<VerdictNumber> numbers;    // those that there are, in the order of verdict_quantities
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
  bool within_step_change = false;  // doubling the step changes the value by at least its distance from the limit
};
std::string_view to_string(CriterionResult::State);

/// The largest section forces of a beam whose envelope was asked for.
struct BeamVerdict {
  std::string name;
  std::vector<VerdictNumber> numbers;
};

/// In space: the largest shears or drift ratios of a storey, along both axes and together.
struct StoreyVerdict {
  std::string name;
  std::vector<VerdictNumber> numbers;
};

struct VerdictNumbers {
  std::vector<VerdictNumber> whole;          // of the run
  std::vector<InterfaceVerdict> interfaces;  // bases first
  std::vector<Interval> full_loss;           // no base has any contact
  std::size_t bases() const { return static_cast<std::size_t>(std::ranges::count(interfaces, Role::base, &InterfaceVerdict::role)); }
  std::vector<BeamVerdict> beams;
  std::vector<StoreyVerdict> storeys;
  std::vector<CriterionResult> criteria;
};

/// From what the run kept of every step. `bonded`: the same model with interfaces that never open, or null.
VerdictNumbers numbers_of(const BuiltCase& built, const RunResult& run, const RunResult* bonded);
/// Whether any of them is found from this column, if it is there. What interfaces carry at every step stands in RunResult::steps.
bool numbers_need(const Request& column);

/// Numbers are compared with those of the bonded reference run only where one of the two exceeds this share of the excitation: of the
/// largest change of the force on the base since rest (times its width for moments), of the largest motion of the top in any direction, of
/// the largest floor acceleration in any direction. Below, a ratio would be that of coupling by round-off and asymmetric meshes, which was
/// found up to some 1e-6 of the excitation, and it is far below what an engineer resolves (docs/theory, section 10).
inline constexpr double noise_share = 1e-3;
/// A force below this share of the largest force on the same interface is round-off.
inline constexpr double round_off_share = 1e-9;
/// The relative change of a number: nothing where both are below `least`. A reference below it counts as `least`.
std::optional<double> change_of(double value, double reference, double least);
/// The same, and nothing either where the reference alone is below `least`: there is nothing that changes.
std::optional<double> change_beside(double value, double reference, double least);

/// "Eccentricity e/B", of a round base e/D, and what max_eccentricity of the base is made of.
std::string label_of_eccentricity(const InterfaceVerdict&);
std::string words_of_eccentricity(const InterfaceVerdict&);

/// A number as it is printed wherever it appears: rounded once, here. A residual has no more decimals than its remaining variation.
std::string text_of(const VerdictNumber&);
/// The remaining variation (VerdictNumber::swing): "0.012 mm"; empty when it is at rest.
std::string swing_text(const VerdictNumber&);

/// The number of this quantity; null when there is none.
const VerdictNumber* find_number(const std::vector<VerdictNumber>& numbers, QuantityName);

/// Share of a Winkler strip that really uplifts where a linear analysis has tension on the share t: M_lin/M_u = 1/(1 - 2t), and equal
/// energies (docs/theory, eq 31). Nothing for t >= 1/2, where the linear moment has no bound.
std::optional<double> uplift_of_tension(double t);

}  // namespace uplift
