#pragma once
#include "uplift/io/results/result_writer.h"
#include "uplift/laws/soil_stiffness.h"

namespace uplift {

/// The ground under a footing as the object "soil": stiffness and dashpot against every motion, and where they come from. Motions without a
/// formula are left out.
void write_soil(ResultWriter& out, const FootingOnSoil& footing);

/// What a joint of points can have of it, as the object "bed": a uniform bed with the vertical stiffness, and the bed that is stiffer
/// towards the edges. See docs/theory/soil_stiffness.md, eqs (H13) to (H17).
void write_bed(ResultWriter& out, const FootingOnSoil& footing);

}  // namespace uplift
