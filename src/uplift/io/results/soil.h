#pragma once
#include "uplift/io/results/result_writer.h"
#include "uplift/laws/soil_stiffness.h"

namespace uplift {

/// The ground under a footing as the object "soil": stiffness and dashpot against every motion, and where they come from. Motions without a
/// formula are left out.
void write_soil(ResultWriter& out, const FootingOnSoil& footing);

}  // namespace uplift
