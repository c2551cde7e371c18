#pragma once
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "uplift/io/files.h"
#include "uplift/io/report/report.h"
#include "uplift/session/load.h"
#include "uplift/study/trust.h"

// What a user asks for: a run with everything that belongs to it, a comparison, a statement of reliability. The command line and the C
// interface only differ in how they show progress and hand over the results.
namespace uplift {

class Checkpoints;

/// How the caller follows and stops an analysis. Every member may be empty.
struct Control {
  std::function<Watch(const std::string& label)> watch;  // makes what is told of the progress of one run
  std::function<bool()> stopped;                         // asked between runs, and during runs that are not watched
  Observe observe;                                       // sees the steps of the case's own run
  ResultFolder* folder = nullptr;                        // where fields are written; null: none are written
  Checkpoints* checkpoints = nullptr;                    // run_case, compare_case: states of the runs are kept there; null: none are
  bool step_check = true;                                // run_case: the companion run with twice the step
  bool is_stopped() const { return stopped && stopped(); }
};

/// Everything that an analysis computed, ready to be written.
struct Results {
  std::vector<std::shared_ptr<const LoadedCase>> others;  // cases beside the given one, into which the models point
  std::vector<RunSpec> specs;
  std::deque<BuiltCase> built;
  std::vector<RunResult> runs;
  FloorAnswers floors;  // of the runs
  Verdict verdict;      // on the first run
  std::vector<std::string> warnings;
  std::vector<std::string> field_lists;         // files that list the fields of a run, in the result folder
  std::optional<ComparisonSummary> comparison;  // of compare_case
  std::optional<TrustAnswer> trust;             // of trust_case
};

/// The case itself, the bonded run, and the same runs with twice the step for the error of the step. Throws InputError; numerical failure
/// is a status of the run.
Results run_case(const LoadedCase& loaded, const Control& control);
/// All variants, dampings, motions and the stiffness sweep of a case.
Results compare_case(const LoadedCase& loaded, const Control& control);
/// The case with every choice of the computation changed, one at a time. `compute`: how the changed cases are computed; without it in this
/// process, in threads.
using ComputeSamples = std::function<TrustResults(const TrustSamples& samples)>;
Results trust_case(const LoadedCase& loaded, const Control& control, const ComputeSamples& compute);
Results trust_case(const LoadedCase& loaded, const Control& control);

/// Report, histories, summary, resolved case and problem files as files of the folder, which still has to be finished. False when the
/// program was built without the page of the report: everything else is written then.
bool write_results(const LoadedCase& loaded, const Results& results, ResultFolder& folder);
/// The results document (summary.json) alone.
std::string results_json(const LoadedCase& loaded, const Results& results);
/// The page of the report alone; empty when the program was built without it.
std::string results_page(const LoadedCase& loaded, const Results& results);

}  // namespace uplift
