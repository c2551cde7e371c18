#pragma once
#include <functional>
#include <span>
#include <vector>

#include "uplift/linear/lockstep.h"
#include "uplift/run/run.h"

namespace uplift {

/// From so many free unknowns on the time of a run goes into back-solves, and runs are best marched in lockstep.
inline constexpr int large_model = 5000;
/// So many at once: docs/decisions/0008-runs-in-lockstep.md.
inline constexpr std::size_t most_in_lockstep = 16;

/// What run() is given, for one run among several. All of it stays alive until they are over.
struct LockstepRun {
  const Model* model = nullptr;
  const RunPlan* plan = nullptr;
  const std::vector<const Values*>* behaviours = nullptr;
  const Model* matrices = nullptr;  // that has the matrices of the model, which gave its own away (share_matrices); null: the model itself
  Watch watch = {};
  Observe observe = {};
  const Keeping* keeping = nullptr;  // null: none
};

/// Where stiffness, mass and damping of a model are those of another one, number for number, the model gives its own away, which take most
/// of its memory; nothing but run_in_lockstep can use it then. False: they are not, and it keeps them.
bool share_matrices(Model& model, const Model& with);

struct LockstepOptions {
  int threads = 1;  // that compute at the same time
  /// Told of every run that ends, with its number and its result, which it may take: then what is returned of this run is empty.
  std::function<void(std::size_t, RunResult&)> ended = {};
  LockstepCounts* counts = nullptr;  // filled at the end; null: not wanted
};

/// run() for several runs that have the same matrices and step sizes, and differ in loads, motions and interfaces. They march side by side:
/// one factor, and back-solves for all of them at once (Lockstep). Sixteen of a large model take about a third of the time of
/// as many single runs, and one factor. A step that fails is halved by its run alone; a run that ends, in whatever way, leaves the
/// others.
///
/// Each result is that of run() but for round-off, because sums are made in another order. It does not depend on the other runs, to the
/// last bit. Its wall time is that of all of them.
///
/// Runs with other matrices come one after another. Yielding solids and the monolithic oracle, whose matrices change from step to step,
/// are run on their own. Functions of a run are called in a thread of its own, with one thread never two at the same time. What they throw
/// ends their run alone; it is thrown again, that of the first of these runs, when all have ended.
std::vector<RunResult> run_in_lockstep(std::span<const LockstepRun> runs, const LockstepOptions& options = {});

}  // namespace uplift
