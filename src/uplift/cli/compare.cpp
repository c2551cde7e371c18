#include "uplift/verdict/compare.h"

#include <fmt/format.h>

#include <algorithm>

#include "uplift/base/file.h"
#include "uplift/base/format.h"
#include "uplift/cli/console.h"
#include "uplift/cli/load.h"

namespace uplift::cli {
namespace {

void print_runs(const Results& results, const ComparisonSummary& compared) {
  std::string group = "\n";
  std::vector<std::vector<std::string>> rows;
  const std::vector<std::string> head{"run",         "status",         "top motion",  "uplifted",  "gap",
                                      "base moment", "energy created", "energy lost", "agreement", "deviation"};
  const auto flush = [&] {
    if (rows.size() > 1) print_table(rows);
    rows = {head};
  };
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    const RunResult& run = results.runs[i];
    if (run.group != group) {
      flush();
      group = run.group;
      if (!group.empty()) say((i > 0 ? "\n" : "") + group);
    }
    const std::optional<Peak> motion = top_motion(results.built[i], run);
    const Agreement& agreement = compared.agreement[i];
    const bool counted = agreement.word == Agreement::Word::agrees || agreement.word == Agreement::Word::differs;
    const bool bonded = results.specs[i].bonded;  // it stretches instead of opening
    rows.push_back({run.label, status_text(run), motion ? format_quantity(std::abs(motion->value), "m") : "-",
                    bonded ? "-" : percent(run.max_uplifted_ratio.value),
                    bonded ? "-" : format_value(*QuantityName("max_opening"), run.max_opening.value),
                    format_quantity(std::abs(run.max_base_moment.value), "N m"), percent(created_share(run)),
                    percent(run.energy_scale > 0 ? run.energy_lost / run.energy_scale : 0), std::string(to_string(agreement.word)),
                    counted ? percent(agreement.deviation) : "-"});
  }
  flush();
}

void print_sweep(const ComparisonSummary& compared) {
  if (compared.sweep.empty()) return;
  say("\nenergy created, a share of the energy put in, against the stiffness of the joint");
  std::vector<std::vector<std::string>> rows{{"k F", "path average", "end of step"}};
  for (const SweepRow& row : compared.sweep)
    rows.push_back({fmt::format("{:g}", row.ratio), fmt::format("{:.2e}", row.path), fmt::format("{:.2e}", row.end)});
  print_table(rows);
}

/// A value as the table shows it: shares in per cent.
std::string shown(double value, const std::string& unit) {
  return unit == "1" ? percent(value) : format_quantity(value, unit);
}

void print_over_motions(const ComparisonSummary& compared) {
  for (const MotionTable& table : compared.motions) {
    say(fmt::format("\nover the motions: {}{}", table.run, table.damping.empty() ? "" : ", " + table.damping));
    std::vector<std::vector<std::string>> rows{{"motion", "status"}};
    for (const MotionTable::Quantity& quantity : table.quantities) rows.front().push_back(quantity.label);
    const auto add = [&](const std::string& name, std::string_view status, const std::vector<double>& values) {
      std::vector<std::string>& row = rows.emplace_back(std::vector<std::string>{name, std::string(status)});
      for (std::size_t k = 0; k < values.size(); ++k) row.push_back(shown(values[k], table.quantities[k].unit));
    };
    for (const MotionTable::Row& row : table.rows) add(row.motion, to_string(row.status), row.peaks);
    if (table.counted > 0) {
      add("envelope", "", table.envelope);
      add("mean", "", table.mean);
      add("spread", "", table.spread);
    }
    print_table(rows);
  }
}

}  // namespace

int compare(const Options& options) {
  return compare_from(options, "");
}

int compare_from(const Options& options, const std::string& from) {
  const LoadedCase loaded = load(options);
  comparison_of_case(loaded.read);  // a case with nothing to compare is refused before there is a folder
  OutputFolder folder(options, result_path(options, loaded.read));
  Control control = control_of(options, &folder);
  std::optional<Checkpoints> checkpoints;
  keep_checkpoints(loaded, "compare", folder, from, checkpoints, control);
  Results results = compare_case(loaded, control);
  finish_checkpoints(checkpoints, results.warnings);
  const ComparisonSummary& compared = *results.comparison;
  finish_results(options, loaded, results, folder);

  if (options.json) {
    print_text(read_file(folder.path() + "/summary.json"));
  } else if (!options.quiet) {
    for (const std::string& warning : results.warnings) complain("warning: " + warning);
    print_runs(results, compared);
    print_over_motions(compared);
    print_sweep(compared);
    say(fmt::format("\nruns that passed all checks agree when {} lie within {} of the median of their group",
                    compared_text(compared.columns), percent(compared.band)));
    say(fmt::format("verdict ({}): {}", results.runs.front().label, results.verdict.headline));
    if (!results.verdict.consequence.empty()) say(results.verdict.consequence);
    say(fmt::format("results: {}/report.html", folder.path()));
  }
  if (interrupt_asked()) {
    if (!options.quiet)
      complain(
          fmt::format("{}: the files hold the {} runs that were begun", interrupt_text(), results.runs.size() + 2 * compared.sweep.size()));
    if (checkpoints && !options.quiet) complain(fmt::format("uplift resume {} goes on from there", folder.path()));
    return interrupt_exit_code();
  }
  bool failed = false;
  for (const RunResult& run : results.runs)
    if (run.status == RunStatus::failed && !run.expected_to_fail) {
      complain(fmt::format("failed: {}: {}", run.name, run.reason));
      failed = true;
    }
  return failed ? Exit::numerical_failure : Exit::done;
}

}  // namespace uplift::cli
