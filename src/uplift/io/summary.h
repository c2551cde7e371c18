#pragma once
#include <string>
#include <utility>
#include <vector>

#include "uplift/analysis/compare.h"
#include "uplift/analysis/floor_spectra.h"

namespace uplift {

/// Where results come from.
struct Provenance {
  std::string title, subtitle, command, version, created;   // created: date and time, ISO 8601
  std::string case_file, case_hash;                         // SHA-256 of the case file
  std::vector<std::pair<std::string, std::string>> inputs;  // other input files with their SHA-256
  std::string resolved;                                     // the case with all defaults, TOML
};

/// What `uplift compare` adds.
struct ComparisonSummary {
  std::vector<Agreement> agreement;  // one per run
  double band = 0;
  std::vector<std::string> columns;  // whose peaks are compared
  std::vector<SweepRow> sweep;
};

/// summary.json: an object with the provenance and the array `runs`. `compared` and `floors` may be null.
std::string summary_json(const Provenance&, const std::vector<RunResult>& runs, const ComparisonSummary* compared,
                         const FloorAnswers* floors = nullptr);

}  // namespace uplift
