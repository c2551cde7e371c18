#pragma once
#include <memory>
#include <optional>

#include "uplift/case/schema/interface_sections.h"
#include "uplift/laws/soil_bed.h"

// [interface.footing.soil]: the ground under a footing gives stiffnesses to its joint.
namespace uplift {

/// Null without it.
std::unique_ptr<const FootingOnSoil> soil_of(const CaseFooting& footing);
/// Makes the bed stiffer towards the edges. Throws InputError where the points cannot have the rocking stiffness of the ground.
void spread_soil(const Values& soil, const FootingOnSoil& ground, Footing& footing);
/// The law with numbers where it says "soil"; null where it does not. Throws InputError where there is no soil.
std::unique_ptr<const Values> law_on_soil(const Values& law, const FootingOnSoil* soil, int dimension);

}  // namespace uplift
