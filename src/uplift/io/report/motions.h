#pragma once
#include <memory>
#include <vector>

#include "uplift/io/report/parts.h"
#include "uplift/motion/motion_function.h"

// What the results say of the ground motions: where they come from, what they are, and the comparison over them.
namespace uplift {

using Histories = std::vector<std::shared_ptr<const MotionHistory>>;

/// The motions that some runs use, each once.
Histories motions_of(const std::vector<ReportRun>& runs);

/// The member "motions" of summary.json: one object each.
void write_motions(JsonWriter& json, const Histories& motions);
/// The member "over_motions" of summary.json.
void write_over_motions(JsonWriter& json, const std::vector<MotionTable>& tables);

/// The tables "motions" (what one number can say of each) and "motion_origins" (file, repairs, processing).
void write_motion_numbers(JsonWriter& json, const Histories& motions, std::string_view caption);
void write_motion_origins(JsonWriter& json, const Histories& motions);

/// Tables and charts of the report; nothing without motions.
void write_motion_tables(JsonWriter& json, const ReportInput& input);
void write_motion_charts(JsonWriter& json, const ReportInput& input);

}  // namespace uplift
