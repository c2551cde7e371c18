#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "uplift/reduction/reduced_model.h"
#include "uplift/verdict/compare.h"
#include "uplift/verdict/compare_motions.h"
#include "uplift/verdict/floor_spectra.h"
#include "uplift/verdict/verdict.h"

namespace uplift {

/// Where results come from.
struct Provenance {
  std::string title, subtitle, command, version, created;   // created: date and time, ISO 8601
  std::string built_with;                                   // compiler
  std::string case_file, case_hash;                         // SHA-256 of the case file
  std::vector<std::pair<std::string, std::string>> inputs;  // other input files with their SHA-256
  std::string resolved;                                     // the case with all defaults, TOML
  std::shared_ptr<const ReducedModel> reduced;              // with which dynamic stages are computed; null: with the whole model
  std::string reduced_file;                                 // as the case names it
};

/// What `uplift compare` adds.
struct ComparisonSummary {
  std::vector<Agreement> agreement;  // one per run
  double band = 0;
  std::vector<std::string> columns;  // whose peaks are compared
  std::vector<SweepRow> sweep;
  std::vector<MotionTable> motions;  // one per variant and damping; empty without [[compare.motion]]
};

/// What stands in summary.json.
struct SummaryInput {
  const Provenance& from;
  const std::vector<RunResult>& runs;
  const Verdict& verdict;                                     // on the first run
  std::vector<std::shared_ptr<const MotionHistory>> motions;  // those that drive the runs
  const ComparisonSummary* compared = nullptr;                // null for a single run
  const FloorAnswers* floors = nullptr;
  const std::deque<BuiltCase>* built = nullptr;  // of the runs; null: nothing is written that needs the models
  const std::vector<RunSpec>* specs = nullptr;   // of the runs
  bool compact = false;  // for the report: on one line, without what the page does not show (peaks of columns, equilibrium, histories)
};

/// summary.json: an object with the provenance, the arrays `motions` and `runs`, and the `verdict`.
std::string summary_json(const SummaryInput&);
/// Its JSON Schema.
std::string summary_schema();

}  // namespace uplift
