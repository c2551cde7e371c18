#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "uplift/dynamics/bulk.h"
#include "uplift/dynamics/step.h"
#include "uplift/model/geometric.h"
#include "uplift/run/result.h"

namespace uplift {

/// Everything that a run remembers between two steps: a value, which can be copied, written and read. Factors, work space and first guesses
/// are not part of it: they are made again from the model.
struct RunState {
  // the place in the plan
  std::size_t stage = 0;  // the present one
  long step = 0;          // steps of the present dynamic stage that are done; 0: it has not begun
  MarchState march;       // inside a dynamic stage

  // what a stage hands on to the next one
  State state;
  std::optional<StageHandover> handover;    // of the dynamic stages; empty before the first one
  std::optional<std::size_t> marched;       // the dynamic stage before, as long as nothing came in between
  Vector held;                              // what they have borne, on the free unknowns [N, N m]
  std::optional<SecondOrder> second_order;  // of P-delta, before elimination
  Energies static_energies;                 // at the end of the static stages before the first dynamic one
  int static_stages = 0;                    // that are over
  double unloaded_energy = 0;               // J: Energies::sum of the unloaded structure
  double initial_scale = 0;                 // J
  double round_off_energy = 0;              // J: the least scale of what the gate compares

  // what was recorded
  RunResult result;
  Recorded load_steps;        // of the static stages
  long next_check = 1;        // of the equilibrium in the present stage
  double recorded_until = 0;  // s: accelerations are means from here to the next instant
  Frame peak_frame;           // at the largest uplift of the present stage; empty when that of an earlier stage is larger
  double peak_uplift = 0;     // largest share over all interfaces and steps
  LinearCounts linear;
};

/// Gives the free unknowns new numbers (model/numbering.h). States are handed out and taken over in the order of the full unknowns: that of
/// a distributed model depends on the number of processes.
void renumber(const std::vector<int>& number, RunState& state);

/// The state as bytes, with a checksum. Doubles keep every bit.
std::string write_run_state(const RunState& state);
/// The state that such bytes hold. Bytes that are cut off or changed are refused: then `why` says so, and nothing is returned.
std::optional<RunState> read_run_state(const std::string& bytes, std::string& why);

/// How a run is kept, so that another one can go on from where it was, and what there is of it while it goes on.
struct Keeping {
  /// Told now and then of the results so far. The table lacks the rows of the last steps, up to 64.
  std::function<void(const RunResult&)> follow;
  /// Called after every `every` steps of a dynamic stage. There the run drops its first guesses: from there it depends on this state alone,
  /// and a run that begins with it takes the same steps to the last bit.
  std::function<void(const RunState&)> keep;
  long every = 256;
  /// Called where the first dynamic stage begins, with the static stages and the initial state behind it; the run ends there. Another run
  /// of the same stages can begin with this state, also one of a reduced model with the state in its coordinates. Empty: the run goes on.
  std::function<void(const RunState&)> begin;
  const RunState* from = nullptr;  // where the run begins: a state of a run with the same model, plan and `every`; null: at the beginning
};

}  // namespace uplift
