#pragma once
#include <string>

#include "uplift/verdict/floor_spectra.h"
#include "uplift/verdict/numbers.h"

namespace uplift {

/// The same case with twice the step: what the numbers of the verdict are compared with.
struct Companion {
  const BuiltCase* built = nullptr;
  double step = 0;  // s: longest of the dynamic stages
  const RunResult* run = nullptr;
  const RunResult* bonded = nullptr;  // null where the verdict has no bonded reference run
};

/// Longest step of the dynamic stages [s].
double longest_step(const RunPlan& plan);

/// By how much the numbers of the verdict still depend on the step. The difference between the run and its companion bounds the error of
/// the run where the error is proportional to the step or to a power of it.
struct StepCheck {
  enum class State {
    not_made,       // the numbers were not compared with another step
    converged,      // no number moves by more than what is accepted
    not_converged,  // at least one does, the scheme loses energy, or the companion ended differently
  } state = State::not_made;
  double step = 0, coarse_step = 0;           // s: longest of the dynamic stages, of the run and of the companion
  double largest = 0;                         // change of the number that changes most, relative to its reference
  const VerdictQuantity* quantity = nullptr;  // that number, null: none changes, or a floor spectrum changes most
  std::string of;                             // its interface, beam or floor; empty: of the whole run
  double floors = 0, floors_to = 0;           // largest change of a floor spectrum, up to this frequency [Hz]; 0 Hz: there is none
  double sufficient_step = 0;                 // s: where errors proportional to the step are the accepted ones; 0 where unknown
  /// The number that changes most beside what is accepted for it (accepted_force_change for forces and pressures of bases, else
  /// accepted_step_change): above an excess of 1 the run is not converged.
  struct Decisive {
    double change = 0, accepted = 1;
    const VerdictQuantity* quantity = nullptr;  // null: a floor spectrum
    std::string of;
    double excess() const { return change / accepted; }
  } decisive;
  /// The largest change of a peak of the forces on a base within a part of the time, relative to the peak of all of it. Where impacts make
  /// two runs go different ways, their overall peaks may still agree by chance; those of every part do not.
  struct Part {
    double change = 0;
    const VerdictQuantity* quantity = nullptr;
    std::string of;           // the base
    double from = 0, to = 0;  // s
  } part;
  // Share of the energy put in that the scheme lost in the run. A scheme that damps what no step near this one resolves gives both runs the
  // same wrong peak.
  double lost = 0;
  double no_contact = 0;  // s: the longest time of the run without contact of any base
  std::string reason;     // why it was not made, or how the companion ended
  /// One sentence for the terminal and the first page.
  std::string sentence() const;

 private:
  std::string after_loss() const;
  std::string why_not(const std::string& steps) const;
};
std::string_view to_string(StepCheck::State);

/// Share of its reference by which a number may change when the step is doubled.
inline constexpr double accepted_step_change = 0.05;
/// The same of the forces and pressures of a base, and of their peaks in every part of the time, relative to the peak of all of it: the
/// suggested step is meant to give forces within 3 %, and at impacts and slips, of first order, the change is about the error.
inline constexpr double accepted_force_change = 0.03;
/// Share of the energy put in that the time scheme may lose before the verdict marks it and a warning tells it.
inline constexpr double accepted_energy_loss = 0.05;
/// Parts of the time whose peaks are compared.
inline constexpr int parts_of_time = 20;

/// Adds to every number its value and its change with twice the step; numbers that one of the two runs lacks have none. A change is
/// relative to the larger of the two values; of shares of an area to at least 0.1 (to the whole area for the residual one), of
/// eccentricities to at least 0.01, of residual values to at least a twentieth of the largest motion and to their remaining variation, of
/// the least compression to the largest; safeties are compared by their inverse, with at least 0.1, and changes beside the bonded run by 1
/// + change. Durations, instants and the compression of the joint are stated but decide nothing; numbers that are noise in both runs
/// have no change.
/// `floors`: the spectra of the run, or null; they are compared up to the frequency with twenty steps of the companion a period, relative
/// to the larger value, which counts as at least a tenth of the peak of the spectrum.
StepCheck check_step(const BuiltCase& built, const RunResult& run, const FloorRun* floors, const Companion& companion,
                     VerdictNumbers& numbers);
/// Marks the criteria whose number, once compared, changes by at least its distance from the limit; where one of the runs has no such
/// number, those that the other run decides otherwise.
void mark_criteria(VerdictNumbers& numbers, const VerdictNumbers& coarse);
/// The comparison alone: fills the rest of a check whose steps are known.
void compare_steps(VerdictNumbers& numbers, const VerdictNumbers& coarse, StepCheck& check);
/// The peaks of moment, compression and pressure of every base in twentieths of the time. One that the other run reaches a tenth of a part
/// earlier or later, in the part beside it, counts as reached. `numbers`: of the run; its bases come first.
void compare_parts(const StepRecord& steps, const StepRecord& coarse, const VerdictNumbers& numbers, StepCheck& check);
/// The same for the spectra of floors, in the same order. Floors whose spectrum nowhere exceeds `least` [m/s2], or noise_share of the
/// largest acceleration of all floors, are not excited: they decide nothing.
void compare_floors(const std::vector<FloorSpectra>& floors, const std::vector<FloorSpectra>& coarse, StepCheck& check, double least = 0);

/// "±0.3 %", of instants "±0.02 s"; empty without a companion.
std::string format_step_change(const VerdictNumber&);

}  // namespace uplift
