#pragma once
#include "uplift/case/build/names.h"
#include "uplift/study/schema/study_plan.h"

// The tables of a plan: declarations, and what they are read into; used by study/schema/study_plan.cpp alone. All throw InputError.
namespace uplift {

/// A number in a unit that depends on another key: bare in SI, or a text with its unit.
Field quantity(std::string_view name, std::string_view meaning);

const Section& plan_motion_section();
const Section& motions_section();
StudyManyMotions many_motions_of(const Values&);

const Section& intensity_section();
IntensityMeasure intensity_of(const Values&);
/// Of the part `method`.
StudyMethod method_of(const Values&);

const Section& variable_section();
StudyVariable variable_of(const Values&);
const Section& correlation_section();
std::vector<StudyCorrelation> correlations_of(const Values& root, const Names& variables);

}  // namespace uplift
