#include "uplift/study/trust.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "uplift/analysis/wording.h"
#include "uplift/base/file.h"
#include "uplift/cli/console.h"
#include "uplift/cli/load.h"
#include "uplift/io/trust_json.h"

namespace uplift::cli {
namespace {

void print_answer(const TrustAnswer& answer) {
  std::vector<std::vector<std::string>> rows{{"number", "of", "value", "least", "most", "band", "moved most by"}};
  for (const TrustBand& band : answer.bands) {
    const std::optional<double> share = band.share();
    rows.push_back({std::string(band.quantity->meaning), band.interface, said(*band.quantity, band.value), said(*band.quantity, band.least),
                    said(*band.quantity, band.most), share ? "+-" + percent(*share) : "-", band.dominant});
  }
  print_table(rows);
  for (const TrustSpectrum& each : answer.spectra)
    say(fmt::format("floor {}, {} damping: speaks to {:.3g} Hz{}", each.floor, percent(each.damping), each.speaks_to,
                    each.limited_by.empty() ? ", the last frequency" : ", limited by " + each.limited_by));
  for (const TrustRun& run : answer.runs)
    if (!run.counts()) say(fmt::format("{} is left out: {}: {}", run.label, to_string(run.status), run.reason));
  for (const TrustPlan::LeftOut& each : answer.left_out) say(fmt::format("not changed: {}: {}", each.choice, each.reason));
}

}  // namespace

int trust(const Options& options) {
  const Loaded loaded = load(options);
  Results results;
  ResultFolder folder(result_path(options, loaded.read));
  catch_interrupts();
  for (const RunSpec& spec : runs_of_case(loaded.read)) {
    results.specs.push_back(spec);
    results.built.push_back(build(loaded.read, spec));
    if (results.runs.empty()) results.warnings = warnings(loaded.read, spec, results.built.front());
    results.runs.push_back(run_one(results.built.back(), spec.label, options));
  }
  const RunResult* bonded = results.runs.size() > 1 ? &results.runs[1] : nullptr;
  TrustAnswer answer;
  {
    ProgressLine line("trust", options.quiet || options.json);
    const int threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    answer = uplift::trust(loaded.raw, loaded.read, mesh_reader(), {results.built.front(), results.runs.front(), bonded}, threads,
                           [&line](const Progress& progress) { return line(progress); });
  }
  results.trust = &answer;
  results.floors = floor_answers(results.built.front().plan, results.runs, results.specs);
  results.verdict = judge(results.built.front(), results.runs.front(), bonded);
  results.verdict.paragraphs.push_back(trust_sentence(answer));
  folder.write("trust.json", trust_json(answer));
  write_results(options, loaded, results, nullptr, folder);

  if (options.json) {
    fmt::print("{}", read_file(folder.path() + "/trust.json"));
  } else if (!options.quiet) {
    for (const std::string& warning : results.warnings) complain("warning: " + warning);
    say(results.verdict.headline);
    print_answer(answer);
    say(trust_sentence(answer));
    say(fmt::format("results: {}/report.html", folder.path()));
  }
  if (!answer.complete) {
    if (!options.quiet) complain("interrupted: runs that were not finished are left out");
    return Exit::interrupted;
  }
  if (!answer.base.counts()) {
    complain("failed: " + answer.base.reason);
    return Exit::numerical_failure;
  }
  return Exit::done;
}

}  // namespace uplift::cli
