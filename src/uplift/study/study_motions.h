#pragma once
#include "uplift/case/case.h"
#include "uplift/study/schema/study_plan.h"

// Motions of a study as tables of its case.
namespace uplift {

/// The case with the records and motions of a plan; those of its own [[compare.motion]] are left out where the plan has any. `many`: its
/// [[motions]]; `plan`: as read.
Raw with_motions(const Raw& raw, const std::vector<StudyManyMotions>& many, const Raw& plan);

/// The case under one motion alone, times a factor, as `uplift run` takes it: names are replaced, records get the process "scale", paths
/// of files are absolute. `read`: the checked case; `motion`: of [[compare.motion]], or null for the case's own.
Raw with_one_motion(const Raw& raw, const Case& read, const CaseOtherMotion* motion, double factor);

}  // namespace uplift
