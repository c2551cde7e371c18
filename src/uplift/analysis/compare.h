#pragma once
#include <string>
#include <vector>

#include "uplift/analysis/case.h"

namespace uplift {

/// Completed, not expected to fail, and not the bonded model.
bool is_sound(const RunResult& result, const RunSpec& spec);

/// How one run stands beside the others of its group (same damping).
struct Agreement {
  enum class Word { agrees, differs, failed, not_counted } word = Word::not_counted;
  double deviation = 0;  // largest |peak - median|/median over the compared columns
  std::string column;    // where it occurs
};
std::string_view to_string(Agreement::Word);

/// Compares the peaks of all sound runs of each group with their median.
/// `columns`: names of the compared columns; empty: motion `sway` (full unknown) of the top, rotation `turn` of the base and largest
/// opening of the first interface.
std::vector<Agreement> agreement(const std::vector<RunResult>& results, const std::vector<RunSpec>& specs,
                                 const std::vector<std::string>& columns, double band, int sway, int turn);

/// Names of the compared columns, as agreement() chooses them.
std::vector<std::string> compared_names(const RunResult& result, const std::vector<std::string>& columns, int sway, int turn);

/// One row of the stiffness sweep: energy created relative to the energy put in.
struct SweepRow {
  double ratio = 0;                     // k F_ii
  double path = 0, end = 0;             // share created
  std::string path_status, end_status;  // an end-of-step run may fail
};
/// `results`: pairs (path, end), as comparison_of_case lists them.
std::vector<SweepRow> sweep_table(const std::vector<RunSpec>& specs, const std::vector<RunResult>& results);

/// Share of the energy put in that a run created.
double created_share(const RunResult& result);

}  // namespace uplift
