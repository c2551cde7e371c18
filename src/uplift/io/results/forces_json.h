#pragma once
#include "uplift/io/text/json_writer.h"
#include "uplift/run/run.h"

namespace uplift {

/// Section forces along the beams: ranges with times.
void write_envelopes(JsonWriter& json, const std::vector<BeamEnvelope>& envelopes);
/// Sums of the forces on the whole model at a few instants.
void write_equilibrium(JsonWriter& json, const Equilibrium& equilibrium);

}  // namespace uplift
