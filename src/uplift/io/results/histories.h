#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "uplift/run/result.h"

namespace uplift {

/// What the first column of histories.csv is.
inline constexpr std::string_view time_column = "time [s]", load_factor_column = "load_factor [1]";

/// The table of a run as CSV: head "time [s],top.ux [m],...", ten significant digits. Rows with a value that is not finite are left out (a
/// run that met one has failed; its last rows mean nothing). Of static stages alone the first column is the load factor.
std::string histories_csv(const RunResult& result, std::string_view first_column = time_column);
/// The head of that file, and its rows from one on.
std::string histories_head(const RunResult& result);
std::string histories_rows(const RunResult& result, std::size_t from);
/// The same for the load steps of the static stages that come with dynamic ones.
std::string load_steps_csv(const RunResult& result, const std::vector<Request>& columns);

/// True when every number of the row is finite.
bool finite_row(const RunResult& result, std::size_t row);

}  // namespace uplift
