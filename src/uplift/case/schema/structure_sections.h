#pragma once
#include "uplift/elements/element_entry.h"

// The declarations of the structure, its supports, motions and loads; used by case/schema/sections.cpp alone.
namespace uplift {

const Section& node_section();
const Section& mass_section();
/// A table [[name]] for each element of the catalog that stands at one kind of place.
const std::vector<Section>& element_sections(ElementPlace place);
const Section& rigid_section();
const Section& support_section();
const Section& motion_section();
const Section& ground_section();
const Section& gravity_section();
const Section& function_section();
const Section& load_section();
const Section& initial_section();

}  // namespace uplift
