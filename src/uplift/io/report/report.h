#pragma once
#include <string>
#include <vector>

#include "uplift/io/results/summary.h"
#include "uplift/verdict/floor_spectra.h"
#include "uplift/verdict/verdict.h"

// The report: one self-contained page. The program writes its data (format "uplift-report-2", declared in web/src/types.ts): the documents
// summary.json and trust.json, and what they do not contain (histories, frames, geometry). The page makes captions, tables and figures.
namespace uplift {

/// One run as the report sees it.
struct ReportRun {
  const RunSpec* spec = nullptr;
  const BuiltCase* built = nullptr;
  const RunResult* result = nullptr;
  bool say_group = false;  // its curves are named with its damping and motion
};

struct ReportInput {
  const Case* read = nullptr;
  const Provenance* from = nullptr;
  const Verdict* verdict = nullptr;
  std::vector<ReportRun> runs;                  // the first one is the one that the verdict is about
  const ComparisonSummary* compared = nullptr;  // null for a single run
  std::vector<std::string> warnings;
  const FloorAnswers* floors = nullptr;  // as many runs; null: none are asked for
  std::string summary, trust;            // the documents, the summary compact; trust.json of `uplift trust` alone, else empty
};

/// The data of the report as JSON text.
std::string report_json(const ReportInput& input);

/// The page with these data; empty when the page was not built into this program.
std::string report_page(const std::string& json);

/// The page's template as it was built in; empty when it was not.
std::string_view report_template();

}  // namespace uplift
