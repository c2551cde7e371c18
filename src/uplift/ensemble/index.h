#pragma once
#include <string>

#include "uplift/ensemble/store.h"
#include "uplift/ensemble/study.h"

namespace uplift {

/// Writes study.db (SQLite 3) beside the parts: tables meta, motion, sample, run, number and spectrum. It is made from the parts and takes
/// the place of an older one in one step. Throws OutputError.
void write_index(const Study& study, const StudyStore& store, const std::vector<StudyCurve>& curves);

}  // namespace uplift
