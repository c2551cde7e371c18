#pragma once
#include <string>

#include "uplift/analysis/run.h"

namespace uplift {

/// The table of a run as CSV: head "time [s],top.ux [m],...", ten significant digits. Rows with a value that is not finite are left out (a
/// run that met one has failed; its last rows mean nothing).
std::string histories_csv(const RunResult& result);

/// True when every number of the row is finite.
bool finite_row(const RunResult& result, std::size_t row);

}  // namespace uplift
