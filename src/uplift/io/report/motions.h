#pragma once
#include <memory>
#include <vector>

#include "uplift/io/report/parts.h"
#include "uplift/io/results/motions_json.h"

// What the results say of the ground motions: where they come from, what they are, and the comparison over them.
namespace uplift {

/// The motions that some runs use, each once.
Histories motions_of(const std::vector<ReportRun>& runs);

/// The tables "motions" (what one number can say of each) and "motion_origins" (file, repairs, processing).
void write_motion_numbers(JsonWriter& json, const Histories& motions, std::string_view caption);
void write_motion_origins(JsonWriter& json, const Histories& motions);

/// Tables and charts of the report; nothing without motions.
void write_motion_tables(JsonWriter& json, const ReportInput& input);
void write_motion_charts(JsonWriter& json, const ReportInput& input);

}  // namespace uplift
