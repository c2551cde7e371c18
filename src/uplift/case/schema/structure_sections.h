#pragma once
#include "uplift/base/declare.h"

// The declarations of the structure, its supports, motions and loads; used by case/schema/sections.cpp alone.
namespace uplift {

const Section& node_section();
const Section& beam_section();
const Section& mass_section();
/// One for each element of the catalog: a table [[name]].
const std::vector<Section>& element_sections();
const Section& rigid_section();
const Section& support_section();
const Section& motion_section();
const Section& ground_section();
const Section& gravity_section();
const Section& function_section();
const Section& load_section();
const Section& initial_section();

}  // namespace uplift
