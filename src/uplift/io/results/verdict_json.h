#pragma once
#include "uplift/io/results/result_writer.h"
#include "uplift/verdict/floor_spectra.h"
#include "uplift/verdict/verdict.h"

namespace uplift {

/// The member `verdict` of summary.json: level, headline, every number with its unit (and its time, and the bonded run's), criteria, and
/// what becomes of the floor spectra of the first run. `floors` may be null; without `built`, the first run's, there are no histories.
void write_verdict_numbers(ResultWriter& out, const Verdict& verdict, const std::vector<RunResult>& runs, const FloorAnswers* floors,
                           const BuiltCase* built, bool histories);

}  // namespace uplift
