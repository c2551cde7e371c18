#pragma once
#include <memory>
#include <vector>

#include "uplift/io/results/result_writer.h"
#include "uplift/motion/motion_function.h"
#include "uplift/verdict/compare_motions.h"

namespace uplift {

using Histories = std::vector<std::shared_ptr<const MotionHistory>>;

/// The member "motions" of a summary: one object each.
void write_motions(ResultWriter& out, const Histories& motions);
/// The member "over_motions" of summary.json: largest magnitudes of every variant over the motions.
void write_over_motions(ResultWriter& out, const std::vector<MotionTable>& tables);

}  // namespace uplift
