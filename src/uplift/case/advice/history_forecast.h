#pragma once
#include "uplift/case/case.h"

namespace uplift {

/// What the histories of one run take.
struct HistoryForecast {
  double steps = 0, rows = 0, columns = 0;
  double memory = 0;  // bytes, until the results are written: the table, and what is kept of every step for the verdict
  double disk = 0;    // bytes of histories.csv, about
};
HistoryForecast forecast_histories(const RunPlan& plan, std::size_t interfaces);

/// Throws InputError when one run alone keeps more than the memory that is available.
void check_history_memory(const Case& read, const BuiltCase& built);

}  // namespace uplift
