#pragma once
#include "uplift/ensemble/compute.h"
#include "uplift/ensemble/coordinator.h"

namespace uplift::cli {

/// What trial runs of a study say of all others.
struct Trials {
  StudyResult first;         // of the first run; of its beginning where it takes long
  double seconds = 0;        // processor time of a run [s]
  double before = 0;         // processor time before the first run of a sample with a reduced model, for all its motions [s]
  double memory = 0;         // of a worker [bytes]
  std::size_t together = 1;  // runs of a worker that march in lockstep
};

/// Computes some runs as the workers of a study do, in processes of their own. Long ones are ended after some seconds, and their time
/// follows from their pace.
Trials run_trials(const Study& study, StudyComputer& computer, const RunRequest& trial, const StudyStatus& status, bool quiet);

}  // namespace uplift::cli
