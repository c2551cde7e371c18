#pragma once
#include <deque>

#include "uplift/analysis/case.h"
#include "uplift/cli/commands.h"
#include "uplift/io/report.h"

namespace uplift::cli {

/// A case file, read and checked, with where it comes from.
struct Loaded {
  Case read;
  Provenance from;
};
/// `options.file` may be a folder with a case.toml. Throws InputError.
Loaded load(const Options& options);

/// Where results go: options.out, or out/NAME with the case's folder (for case.toml) or file name.
std::string result_path(const Options& options, const Case& read);

/// Everything that a command computed, ready to be written.
struct Results {
  std::vector<RunSpec> specs;
  std::deque<Built> built;
  std::vector<RunResult> runs;
  Verdict verdict;
  std::vector<std::string> warnings;
};
/// Writes report, histories, summary, resolved case and problem files; says where earlier results went. Returns the folder.
std::string write_results(const Options& options, const Loaded& loaded, const Results& results, const ComparisonSummary* compared);

/// Runs one spec of a case with the progress line.
RunResult run_one(const Built& built, const std::string& label, const Options& options);

/// How a run is reported on one line: "completed", "failed (expected): ...".
std::string status_text(const RunResult& result);

}  // namespace uplift::cli
