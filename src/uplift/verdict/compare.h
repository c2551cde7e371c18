#pragma once
#include <deque>
#include <string>
#include <vector>

#include "uplift/case/case.h"

namespace uplift {

/// Completed, not expected to fail, and not the bonded model.
bool is_sound(const RunResult& result, const RunSpec& spec);

/// How one run compares with the others of its group (same damping, same motion).
struct Agreement {
  enum class Word { agrees, differs, failed, not_counted } word = Word::not_counted;
  double deviation = 0;  // largest |peak - median|/median over the compared columns
  std::string column;    // column or number of the verdict where it occurs
};
std::string_view to_string(Agreement::Word);

/// Compares the runs of each group that passed all checks with their median.
/// `columns`: names of the columns whose peaks are compared; empty: every number of the verdict but those that belong to the method rather
/// than to the structure (the closure of the joint). A difference is taken relative to the median, or to what the number is a part of where
/// that is larger: noise to its threshold, times to the duration, residuals to the largest motion, shares to one.
std::vector<Agreement> agreement(const std::vector<RunResult>& results, const std::vector<RunSpec>& specs,
                                 const std::deque<BuiltCase>& built, const std::vector<std::string>& columns, double band);

/// What agreement() compares, in words.
std::string compared_text(const std::vector<std::string>& columns);

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
