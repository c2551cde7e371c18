#include <future>

#include "uplift/io/report/motions.h"
#include "uplift/io/results/floors.h"
#include "uplift/io/results/histories.h"
#include "uplift/io/results/trust_json.h"
#include "uplift/session/session.h"

namespace uplift {
namespace {

ReportInput report_input(const LoadedCase& loaded, const Results& results) {
  ReportInput input{&loaded.read,
                    &loaded.from,
                    &results.verdict,
                    {},
                    results.comparison ? &*results.comparison : nullptr,
                    results.warnings,
                    &results.floors,
                    results.trust ? &*results.trust : nullptr};
  for (std::size_t i = 0; i < results.runs.size(); ++i) input.runs.push_back({&results.specs[i], &results.built[i], &results.runs[i]});
  return input;
}

}  // namespace

std::string results_json(const LoadedCase& loaded, const Results& results) {
  const ReportInput input = report_input(loaded, results);
  return summary_json({loaded.from, results.runs, results.verdict, motions_of(input.runs), input.compared, &results.floors, &results.built,
                       &results.specs});
}

std::string results_page(const LoadedCase& loaded, const Results& results) {
  return report_template().empty() ? std::string() : report_page(report_json(report_input(loaded, results)));
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
