#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "uplift/base/archive.h"
#include "uplift/statistics/capacity_search.h"
#include "uplift/study/schema/study_plan.h"
#include "uplift/verdict/floor_spectra.h"
#include "uplift/verdict/numbers.h"

// What is kept of one run of a study.
namespace uplift {

/// How a run ended. The first three say something of the structure.
enum class StudyOutcome { completed, overturned, separated, failed, energy, timeout, memory, crashed };
inline constexpr std::string_view study_outcomes[] = {"completed", "overturned", "separated", "failed",
                                                      "energy",    "timeout",    "memory",    "crashed"};
inline std::string_view to_string(StudyOutcome outcome) {
  return study_outcomes[static_cast<std::size_t>(outcome)];
}
inline bool says_something(StudyOutcome outcome) {
  return outcome <= StudyOutcome::separated;
}

/// A number of the verdict of a run.
struct StudyNumber {
  std::string quantity, of;  // of: interface or beam, empty: the run
  double value = 0;
};

/// Raw floor spectrum [m/s2].
struct StudySpectrum {
  std::string floor;
  double damping = 0;
  std::vector<double> frequencies, values;  // Hz, m/s2
};

struct StudyResult {
  std::string id, motion;
  long sample = 0;
  double factor = 1, intensity = 1;
  StudyOutcome outcome = StudyOutcome::completed;
  std::string reason;
  std::optional<StudyOutcome> bonded;  // of the bonded run beside it, where there is one
  long attempt = 1;
  std::vector<StudyNumber> numbers;  // of a run that did not complete: up to its end
  std::vector<StudySpectrum> spectra;
  double end_time = 0;  // s reached
  double created = 0;   // share of the energy put in that the run created
  long steps = 0, retries = 0;
  bool replay = false;  // there is a stored interface problem
  double wall = 0;      // s
};

template <class Archive, SameAs<StudyNumber> T>
void list_parts(Archive& archive, T& number) {
  archive(number.quantity, number.of, number.value);
}
template <class Archive, SameAs<StudySpectrum> T>
void list_parts(Archive& archive, T& spectrum) {
  archive(spectrum.floor, spectrum.damping, spectrum.frequencies, spectrum.values);
}
template <class Archive, SameAs<StudyResult> T>
void list_parts(Archive& archive, T& run) {
  archive(run.id, run.motion, run.sample, run.factor, run.intensity, run.outcome, run.reason, run.bonded, run.attempt, run.numbers,
          run.spectra, run.end_time, run.created, run.steps, run.retries, run.replay, run.wall);
}

/// From a run that is over; identity, attempt and intensity are left to the caller. `spectra`: floor spectra are kept. `bonded`: the bonded
/// run that numbers are compared with, or null.
StudyResult result_of(const BuiltCase& built, const RunResult& run, bool spectra, const RunResult* bonded = nullptr);

/// The number of a run that a limit is for: the one that is farthest beyond it; nothing where the run has none.
std::optional<double> demand_of(const StudyLimit& limit, const StudyResult& run);
/// Runs that overturned or separated exceed every limit. Runs that did not complete exceed a limit when their peak did before they ended;
/// else their outcome is unknown, also where the energy balance is violated.
RunOutcome outcome_of(const StudyLimit& limit, const StudyResult& run);

}  // namespace uplift
