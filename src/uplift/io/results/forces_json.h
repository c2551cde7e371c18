#pragma once
#include "uplift/io/results/result_writer.h"
#include "uplift/run/result.h"

namespace uplift {

/// The member "beam_envelopes": ranges of the section forces along the beams, with times. `up`: the axis that points upwards.
void write_envelopes(ResultWriter& out, const std::vector<BeamEnvelope>& envelopes, int up);
/// The member "equilibrium": sums of the forces on the whole model at a few instants.
void write_equilibrium(ResultWriter& out, const Equilibrium& equilibrium);

}  // namespace uplift
