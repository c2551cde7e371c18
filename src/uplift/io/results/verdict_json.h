#pragma once
#include "uplift/io/text/json_writer.h"
#include "uplift/verdict/floor_spectra.h"
#include "uplift/verdict/verdict.h"

namespace uplift {

/// The object `verdict` of summary.json: level, headline, every number with its unit (and its time, and the bonded run's), criteria, and
/// what becomes of the floor spectra of the first run. `floors` may be null; without `built`, the first run's, nothing is said over time.
void write_verdict_numbers(JsonWriter& json, const Verdict& verdict, const std::vector<RunResult>& runs, const FloorAnswers* floors,
                           const BuiltCase* built);
/// The object `step_check`: how far the numbers depend on the step.
void write_step_check(JsonWriter& json, const StepCheck& check);
/// Change of every floor spectrum of the first run against the bonded one in each frequency band, in per cent; an empty array without.
void write_floor_changes(JsonWriter& json, const FloorAnswers* floors);

}  // namespace uplift
