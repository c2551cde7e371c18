#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "uplift/study/study_run.h"
#include "uplift/study/trust_plan.h"
#include "uplift/verdict/floor_spectra.h"
#include "uplift/verdict/numbers.h"

namespace uplift {

/// One repetition of the case with one changed choice, beside its own bonded run.
struct TrustRun {
  std::string name, choice, label;
  RunStatus status = RunStatus::completed, bonded_status = RunStatus::completed;
  std::string reason;  // why it failed or stopped
  double wall = 0;     // s, both runs
  bool counts() const { return status != RunStatus::failed && status != RunStatus::interrupted; }
};

/// A number of the verdict with its band.
struct TrustBand {
  const VerdictQuantity* quantity = nullptr;
  std::string interface;                      // or beam; empty: of the run
  double value = 0;                           // of the case as it stands
  double least = 0, most = 0;                 // over all runs that count, the case's own included
  double swing = 0;                           // half of the range in which a residual of the case still moves; 0 for other numbers
  std::string dominant;                       // choice that moves it most; empty when nothing does
  std::vector<std::optional<double>> values;  // per run; nothing where the run has no such number
  /// Half the band as a share of the value; nothing where the value does not move or can be near zero (shares, changes, residuals).
  std::optional<double> share() const;
  /// One of its values in words: a residual no finer than it still moves.
  std::string format_value(double number) const;
};

/// A floor spectrum with its band, for one damping.
struct TrustSpectrum {
  std::string floor;
  double damping = 0;
  std::vector<double> frequencies, value, least, most;  // Hz, m/s2
  double speaks_to = 0;                                 // Hz: up to here all runs lie within the band that the case accepts; 0: nowhere
  std::string limited_by;                               // choice that ends it; empty when it speaks everywhere
  /// How far each choice alone lets it speak [Hz], and what the mesh and the step can carry, the shortest first.
  struct Reach {
    std::string choice;
    double to = 0;
  };
  std::vector<Reach> reaches;
  /// Where the raw curves of the repetitions rise most above the broadened one of the case: as a share of it (0: nowhere), and the
  /// frequency [Hz]. Nothing without broadening.
  std::optional<double> above_broadened;
  double above_at = 0;
};

struct TrustAnswer {
  TrustRun base;
  std::vector<TrustRun> runs;  // in the order of the plan
  std::vector<TrustPlan::LeftOut> left_out;
  std::vector<TrustBand> bands;
  std::vector<TrustSpectrum> spectra;
  double accepted = 0;          // the share that a spectrum may differ by
  int interior = 0;             // stiffnesses that were computed between the case and each end
  std::size_t counted() const;  // repetitions that count; without any there are no bands
  std::string dominant;         // the choice that is dominant most often; empty when there is none
  bool complete = false;        // not interrupted
};

/// The run of the case as it stands.
struct TrustBase {
  const BuiltCase& built;
  const RunResult& run;
  const RunResult* bonded = nullptr;  // where the case has a bonded run
};

/// A repetition that is to be computed: the case with one changed choice.
struct TrustSample {
  TrustChange change;
  Case read;
  std::string id;  // SHA-256 of what it computes and of the version of the program
};
struct TrustSamples {
  std::vector<TrustSample> samples;
  std::vector<TrustPlan::LeftOut> left_out;
};
/// The repetitions of a case. `raw`: its file as read. A changed case that does not pass the checks is left out, with the reason.
TrustSamples trust_samples(const Raw& raw, const Case& read, const MeshReader& read_mesh);

/// A sample and its bonded run. `problem`: where a step failed, the interface problem of that step. May throw InputError.
StudyResult compute_sample(const TrustSample& sample, const Watch& watch, std::string& problem);
/// All samples in this process, `threads` at a time; the results do not depend on them. Nothing for a sample that was not finished.
/// `watch` is called from these threads, one at a time. What a sample throws is thrown here, the first of the list first.
using TrustResults = std::vector<std::optional<StudyResult>>;
TrustResults compute_samples(const TrustSamples& samples, int threads, const Watch& watch = {});

/// What the results say of the case; one for each sample.
TrustAnswer trust_answer(const Case& read, const TrustSamples& samples, const TrustResults& results, const TrustBase& base);

}  // namespace uplift
