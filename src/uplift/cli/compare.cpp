#include "uplift/verdict/compare.h"

#include <fmt/format.h>

#include <algorithm>

#include "uplift/base/file.h"
#include "uplift/base/format.h"
#include "uplift/cli/console.h"
#include "uplift/cli/load.h"
#include "uplift/model/builder.h"

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
                    bonded ? "-" : format_value(*find_verdict_quantity("max_opening"), run.max_opening.value),
                    format_quantity(std::abs(run.max_base_moment.value), "N m"), percent(created_share(run)),
                    percent(run.energy_scale > 0 ? run.energy_lost / run.energy_scale : 0), std::string(to_string(agreement.word)),
                    counted ? percent(agreement.deviation) : "-"});
  }
  flush();
}

void print_sweep(const ComparisonSummary& compared) {
  if (compared.sweep.empty()) return;
  say("\nenergy created against the stiffness of the joint");
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

/// Builds and runs one list of specs; stops after an interrupted run. Fields are written into the folder when there is one.
void run_all(const Loaded& loaded, const Options& options, const std::vector<RunSpec>& specs, std::size_t before, std::size_t total,
             ResultFolder* folder, Results& results) {
  std::vector<std::string> fields;
  for (const RunSpec& spec : specs) {
    if (interrupt_asked()) return;
    results.specs.push_back(spec);
    results.built.push_back(build(loaded.read, spec));
    if (results.runs.empty()) results.warnings = warnings(loaded.read, spec, results.built.back());
    const std::string label = fmt::format("[{}/{}] {}", before + results.runs.size() + 1, total, spec.name);
    results.runs.push_back(folder ? run_with_fields(loaded, results.built.back(), label, options, *folder, fields)
                                  : run_one(results.built.back(), label, options));
    forget_matrices(results.built.back());
  }
}

/// Those of the motions that the first run does not have.
void add_motion_warnings(Results& results) {
  std::vector<std::string> said;
  for (const BuiltCase& each : results.built) warn_motions(each.motions, each.plan.stages, said);
  for (const std::string& warning : said)
    if (std::ranges::find(results.warnings, warning) == results.warnings.end()) results.warnings.push_back(warning);
}

const RunResult* bonded_beside(const Results& results, std::size_t place) {
  for (std::size_t i = 0; i < results.runs.size(); ++i)
    if (results.specs[i].bonded && results.runs[i].group == results.runs[place].group) return &results.runs[i];
  return nullptr;
}

/// Puts the group of a run first, because the page shows the first one. Only the runs that stood there have kept pictures: what now stands
/// there is run again.
void bring_forward(const Loaded& loaded, const Options& options, std::size_t place, Results& results) {
  const std::string group = results.runs[place].group;
  const auto mine = [&](const RunResult& run) { return run.group == group; };
  const auto begin = std::ranges::find_if(results.runs, mine) - results.runs.begin(), count = std::ranges::count_if(results.runs, mine);
  if (begin == 0) return;
  const auto rotate = [&](auto& list) { std::rotate(list.begin(), list.begin() + begin, list.begin() + begin + count); };
  std::vector<bool> pictures;
  for (std::ptrdiff_t i = 0; i < count; ++i) pictures.push_back(results.specs[static_cast<std::size_t>(i)].pictures);
  rotate(results.specs);
  rotate(results.built);
  rotate(results.runs);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    results.runs[i + pictures.size()].frames.clear();
    if (!pictures[i] || interrupt_asked()) continue;
    results.specs[i].pictures = true;
    results.built[i] = build(loaded.read, results.specs[i]);
    RunResult again = run_one(results.built[i], fmt::format("[again, for its pictures] {}", results.specs[i].name), options);
    if (again.status != RunStatus::interrupted) results.runs[i] = std::move(again);
    forget_matrices(results.built[i]);
  }
}

struct OverMotions {
  std::string headline, paragraph;  // empty without [[compare.motion]]
};
/// Judges the first variant under every motion and puts the runs of the hardest one first.
OverMotions show_hardest(const Loaded& loaded, const Options& options, const std::vector<MotionTable>& tables, Results& results) {
  if (tables.empty() || interrupt_asked()) return {};
  const RunSpec first = results.specs.front();
  std::vector<JudgedMotion> judged;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    if (results.specs[i].label != first.label || results.specs[i].damping != first.damping) continue;
    judged.push_back(
        {tables.front().rows[judged.size()].motion, &results.runs[i], judge(results.built[i], results.runs[i], bonded_beside(results, i))});
    places.push_back(i);
  }
  if (judged.size() < 2) return {};
  const std::size_t worst = hardest(judged);
  OverMotions said{fmt::format(" ({}, the most demanding of {} motions)", judged[worst].motion, judged.size()),
                   said_over_motions(judged, tables.front())};
  bring_forward(loaded, options, places[worst], results);
  return said;
}

}  // namespace

int compare(const Options& options) {
  const Loaded loaded = load(options);
  const Comparison comparison = comparison_of_case(loaded.read);
  const std::size_t total = comparison.runs.size() + comparison.sweep.size();
  Results results, swept;
  OutputFolder folder(options, result_path(options, loaded.read));
  const Values& output = loaded.read.values.table("output");
  const bool with_fields = output.has("fields") && output.table("fields").flag("variants");
  run_all(loaded, options, comparison.runs, 0, total, with_fields ? &folder : nullptr, results);
  run_all(loaded, options, comparison.sweep, comparison.runs.size(), total, nullptr, swept);

  ComparisonSummary compared;
  compared.motions = motion_tables(results.specs, results.built, results.runs);
  const OverMotions over = show_hardest(loaded, options, compared.motions, results);
  const Values* compare = loaded.read.values.has("compare") ? &loaded.read.values.table("compare") : nullptr;
  compared.band = compare ? compare->number("band") : 0.02;
  const std::vector<std::string> columns = compare ? compare->texts("agree_on") : std::vector<std::string>{};
  const BuiltCase& first = results.built.front();
  compared.columns = columns;
  compared.agreement = agreement(results.runs, results.specs, results.built, columns, compared.band);
  compared.sweep = sweep_table(swept.specs, swept.runs);
  results.floors = floor_answers(first.plan, results.runs, results.specs);
  results.verdict = judge(results.built.front(), results.runs.front(), bonded_beside(results, 0), &results.floors.runs.front());
  results.verdict.headline += over.headline;
  if (!over.paragraph.empty()) results.verdict.paragraphs.insert(results.verdict.paragraphs.begin(), over.paragraph);
  add_motion_warnings(results);
  for (const RunResult& run : results.runs)
    if (const std::string text = run.equilibrium.warning(); !text.empty() && run.status != RunStatus::failed)
      results.warnings.push_back(run.label + ": " + text);
  write_results(options, loaded, results, &compared, folder);

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
      complain(fmt::format("{}: the files hold the {} runs that were begun", interrupt_text(), results.runs.size() + swept.runs.size()));
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
