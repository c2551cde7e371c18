#pragma once
#include "uplift/base/declare.h"

// Declarations of what a case says of its mesh; parts of case_section().
namespace uplift {

const Section& mesh_section();
const Section& surface_section();
const Section& cut_section();
const Section& tie_section();

}  // namespace uplift
