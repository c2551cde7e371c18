#include <future>

#include "uplift/io/report/motions.h"
#include "uplift/io/results/floors.h"
#include "uplift/io/results/histories.h"
#include "uplift/io/results/trust_json.h"
#include "uplift/session/session.h"

namespace uplift {
namespace {

std::vector<ReportRun> report_runs(const Results& results) {
  std::vector<ReportRun> runs;
  for (std::size_t i = 0; i < results.runs.size(); ++i) runs.push_back({&results.specs[i], &results.built[i], &results.runs[i]});
  return runs;
}

std::string summary_of(const LoadedCase& loaded, const Results& results, bool compact) {
  return summary_json({loaded.from, results.runs, results.verdict, motions_of(report_runs(results)),
                       results.comparison ? &*results.comparison : nullptr, &results.floors, &results.built, &results.specs, compact});
}

}  // namespace

std::string results_json(const LoadedCase& loaded, const Results& results) {
  return summary_of(loaded, results, false);
}

std::string results_page(const LoadedCase& loaded, const Results& results) {
  if (report_template().empty()) return {};
  return report_page(
      report_json({&loaded.read, &loaded.from, &results.verdict, report_runs(results), results.comparison ? &*results.comparison : nullptr,
                   results.warnings, &results.floors, summary_of(loaded, results, true), results.trust ? trust_json(*results.trust) : ""}));
}

bool write_results(const LoadedCase& loaded, const Results& results, ResultFolder& folder) {
  // Together with the report, which takes as long: half of the time of a small run goes into its files. After it where there is no second
  // thread.
  std::future<void> histories = std::async(std::launch::async | std::launch::deferred, [&] {
    for (std::size_t i = 0; i < (results.comparison ? results.runs.size() : 1); ++i) {
      const RunResult& run = results.runs[i];
      const RunPlan& plan = results.built[i].plan;
      const auto file = [&](const std::string& name) { return name + (results.comparison ? "/" + run.name : "") + ".csv"; };
      folder.write(file("histories"), histories_csv(run, statics_alone(plan) ? load_factor_column : time_column));
      if (!run.load_steps.empty()) folder.write(file("load_steps"), load_steps_csv(run, plan.requests));
    }
  });
  for (const RunResult& run : results.runs)
    if (!run.problem.empty()) folder.write("problem_" + run.name + ".json", run.problem);
  if (results.trust) folder.write("trust.json", trust_json(*results.trust));
  if (results.floors.any()) folder.write("floor_spectra.csv", floor_spectra_csv(results.runs, results.floors));
  folder.write("summary.json", results_json(loaded, results));
  folder.write("case.resolved.toml", loaded.from.resolved);
  const std::string page = results_page(loaded, results);
  if (!page.empty()) folder.write("report.html", page);
  histories.get();
  return !page.empty();
}

}  // namespace uplift
