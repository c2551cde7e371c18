#pragma once
#include "uplift/analysis/verdict.h"
#include "uplift/io/json_writer.h"

namespace uplift {

/// The object `verdict` of summary.json: level, headline, every number with its unit (and its time, and the bonded run's), criteria.
void write_verdict_numbers(JsonWriter& json, const Verdict& verdict, const std::vector<RunResult>& runs);

}  // namespace uplift
