#pragma once
#include <optional>
#include <string>
#include <vector>

#include "uplift/case/advice/history_forecast.h"
#include "uplift/case/advice/step_suggestion.h"
#include "uplift/dynamics/cost.h"
#include "uplift/io/fields/run.h"
#include "uplift/mesh/quality.h"
#include "uplift/session/load.h"

namespace uplift {

/// What is known of a case without running it to the end.
struct CaseFindings {
  std::vector<double> fixed, bonded, base_free;  // Hz
  std::vector<StiffnessRatio> ratios;
  double suggested_step = 0;      // s
  std::vector<StepBound> bounds;  // of the step, the smallest first
  double seconds_per_step = 0;    // measured over the first steps
  long steps = 0;                 // of one run
  InterfaceSystems systems;       // of the first steps
  std::string trial_failure;      // why the first steps failed; empty when they did not
  std::vector<std::string> warnings;
  struct Solid {
    GroupQuality quality;
    double speed = 0;              // m/s: of shear waves; 0 without mass
    double highest_frequency = 0;  // Hz: with ten nodes per wavelength
  };
  std::vector<Solid> solids;        // of a mesh
  std::vector<GroupQuality> beams;  // groups of the mesh that are beams
  int pieces = 0;                   // of the opened mesh
  std::optional<FieldForecast> fields;
  std::optional<BulkCost> bulk;  // of a large bulk
  HistoryForecast histories;     // of one run
  double record_bytes = 0;       // floors at every step
};

/// Examines a case: builds its runs, estimates time, memory and disk, tries the first steps (at most five seconds; not those of a
/// large model on several processes). Throws InputError.
struct CheckedCase {
  BuiltCase built;                // of the case's own run
  std::vector<std::string> runs;  // what the commands would compute, a line for each run
  CaseFindings found;
};
CheckedCase examine(const LoadedCase& loaded);
/// The same as JSON text, which `uplift check --json` prints.
std::string check_json(const LoadedCase& loaded, const CheckedCase& checked);

/// Natural modes with every interface closed and bonded, and with all interfaces open, as JSON text (`uplift modes --json`).
std::string modes_json(const LoadedCase& loaded, int count);

/// Share of the model's mass that moves with a mode in a direction: (phi^T M r)^2 / (r^T M r), phi^T M phi = 1. `mass` is the full mass
/// matrix, `full_shape` the mode on the full unknowns.
double mass_share(const Model& model, const Sparse& mass, const Vector& full_shape, Dof direction);

}  // namespace uplift
