#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "uplift/case/case.h"
#include "uplift/motion/spectrum.h"

// Floor spectra: what equipment on a floor feels (docs/theory/floor_spectra.md). Pseudo-accelerations [m/s2].
namespace uplift {

/// The spectra of one floor, one per damping of the request.
struct FloorSpectra {
  std::string name;
  Peak zero_period;                 // largest absolute acceleration of the floor itself
  std::vector<Spectrum> raw;        // at the frequencies of the request
  std::vector<Spectrum> broadened;  // with corners between these frequencies too; empty when not asked for
};

/// A band of frequencies [Hz], `to` not included; the last one has no end.
struct FrequencyBand {
  double from = 0;
  std::optional<double> to;
};
/// "below 2 Hz", "2 to 5 Hz", "above 20 Hz".
std::string to_string(const FrequencyBand&);
/// The bands that frequencies part, ascending [Hz]: one more than these.
std::vector<FrequencyBand> frequency_bands(const std::vector<double>& edges);

/// A floor compared with that of the bonded run, for one damping. Empty where neither floor is excited.
struct FloorChange {
  double damping = 0;
  std::vector<double> frequencies;    // Hz: those at which either floor is excited
  std::vector<double> bonded, ratio;  // m/s2; raw over bonded
  struct Band {
    FrequencyBand band;
    double change = 0;           // of the largest value in the band, as a share: 0.1 is 10 % more than bonded
    double least = 1, most = 1;  // ratio at the band's frequencies
    double largest = 0;          // m/s2, in the band
    bool arises = false;         // the bonded floor is not excited there: a change would be that of noise
  };
  std::vector<Band> bands;  // those that hold frequencies
};

/// The floors of one run.
struct FloorRun {
  std::vector<FloorSpectra> floors;              // empty when the run failed
  std::vector<std::vector<FloorChange>> beside;  // per floor and damping; empty without a completed bonded run of its group
};

/// Largest values over all sound runs with the same damping of the structure: variants and motions.
struct FloorEnvelope {
  std::string damping;  // its label; empty when there is only one
  int runs = 0;
  std::vector<FloorSpectra> floors;
  std::vector<std::vector<FloorChange>> beside;  // the envelope of the completed bonded runs, as in FloorRun
};

struct FloorAnswers {
  std::vector<FloorRun> runs;            // one per run
  std::vector<FloorEnvelope> envelopes;  // of two sound runs at least
  bool any() const;
};

/// Spectra of the floors that a run has recorded; none of a failed run.
std::vector<FloorSpectra> floor_spectra(const RunPlan& plan, const RunResult& result);
/// One floor compared with the same floor of another run, per damping. `bands`: frequencies that part them, ascending [Hz]. Values are
/// compared where one of the two exceeds `least` [m/s2]; a smaller bonded value then counts as `least`.
std::vector<FloorChange> floor_change(const FloorSpectra& floor, const FloorSpectra& bonded, const std::vector<double>& bands,
                                      double least);
/// That threshold for two runs: noise_share of the largest acceleration of all their floors, in all directions, and more than
/// round-off beside gravity [m/s2].
double least_excitation(const std::vector<FloorSpectra>& floors, const std::vector<FloorSpectra>& bonded);
/// "-1.5 to +2.1 %": how far the bands of all floors and dampings change compared with the bonded run, where that is excited; empty:
/// nowhere.
std::string range_of_bands(const FloorRun& floors);
/// "accelerations of roof up to 12.7 m/s2 where the bonded model has none": the bands that it does not excite; empty: there are none.
std::string arising_floors(const FloorRun& floors);
/// The same floor of several runs, one at least; broadened by this share where it is > 0.
FloorSpectra floor_envelope(const std::vector<const FloorSpectra*>& floors, double broadening);
/// All of this for the runs of a command. The plan is that of any of them: they ask for the same floors, or have recorded none.
FloorAnswers floor_answers(const RunPlan& plan, const std::vector<RunResult>& results, const std::vector<RunSpec>& specs);

}  // namespace uplift
