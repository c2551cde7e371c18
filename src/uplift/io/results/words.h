#pragma once
#include <string_view>
#include <vector>

#include "uplift/io/results/result_writer.h"
#include "uplift/run/result.h"

// What several result documents write in the same way.
namespace uplift {

/// All that to_string(RunStatus) can return.
std::vector<std::string_view> run_status_words();
/// An object with value, time and unit. `unit` is for the schema: empty where the case chooses the quantity.
void write_peak(ResultWriter& out, std::string_view key, const Peak& peak, std::string_view unit, std::string_view meaning);
/// The members of such an object.
void write_peak(ResultWriter& out, const Peak& peak, std::string_view unit);
/// A list of intervals of time.
void write_intervals(ResultWriter& out, std::string_view key, const std::vector<Interval>& intervals, std::string_view meaning);

}  // namespace uplift
