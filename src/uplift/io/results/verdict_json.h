#pragma once
#include "uplift/io/results/result_writer.h"
#include "uplift/verdict/floor_spectra.h"
#include "uplift/verdict/verdict.h"

namespace uplift {

/// The member `verdict` of summary.json: level, headline, every number with its unit (and its time, and the bonded run's), criteria, and
/// what becomes of the floor spectra of the first run. `floors` may be null; without `built`, the first run's, nothing is said over time.
void write_verdict_numbers(ResultWriter& out, const Verdict& verdict, const std::vector<RunResult>& runs, const FloorAnswers* floors,
                           const BuiltCase* built);

/// How far the numbers depend on the step.
void write_step_check(ResultWriter& out, std::string_view key, const StepCheck& check);
/// Change of every floor spectrum of the first run compared with the bonded one in each frequency band; an empty list without.
void write_floor_changes(ResultWriter& out, std::string_view key, const FloorAnswers* floors);

}  // namespace uplift
