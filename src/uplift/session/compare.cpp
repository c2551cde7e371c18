#include "uplift/verdict/compare.h"

#include <fmt/format.h>

#include <algorithm>

#include "uplift/session/steps.h"

namespace uplift {
namespace {

/// The same run as its own case sees it: with its own damping, unless the comparison states one.
RunSpec in_its_case(const LoadedCase& loaded, const LoadedCase& mine, RunSpec spec) {
  if (spec.other_case.empty()) return spec;
  if (spec.damping == runs_of_case(loaded.read).front().damping) spec.damping = runs_of_case(mine.read).front().damping;
  spec.pictures = false;  // the page draws one model
  return spec;
}

void add_warnings_of_other(const Case& read, const RunSpec& spec, const BuiltCase& built, std::vector<std::string>& said) {
  for (const std::string& warning : warnings(read, spec, built)) said.push_back(spec.label + ": " + warning);
}

bool same_floors(const RunPlan& one, const RunPlan& other) {
  const auto same = [](const FloorRequest& a, const FloorRequest& b) {
    return a.name == b.name && a.frequencies == b.frequencies && a.dampings == b.dampings;
  };
  return std::ranges::equal(one.floors, other.floors, same);
}

/// Builds and runs one list of specs; stops after an interrupted run. `with_histories`: they are written.
void run_all(const LoadedCase& loaded, const Control& control, const std::vector<RunSpec>& specs, std::size_t before, std::size_t total,
             bool with_histories, bool with_fields, Results& results) {
  for (const RunSpec& spec : specs) {
    if (control.is_stopped()) return;
    const std::shared_ptr<const LoadedCase> mine = case_of(loaded, spec);
    results.others.push_back(mine);
    results.specs.push_back(spec);
    BuiltCase& built = results.built.emplace_back(build_run(*mine, in_its_case(loaded, *mine, spec)));
    if (results.runs.empty()) results.warnings = warnings(loaded.read, spec, built);
    if (results.runs.empty()) add_statement(loaded, results.warnings);
    if (!spec.other_case.empty()) add_warnings_of_other(mine->read, spec, built, results.warnings);
    const std::string label = fmt::format("[{}/{}] {}", before + results.runs.size() + 1, total, spec.name);
    RunResult& run = results.runs.emplace_back(run_built(*mine, built, label, control, false, with_fields ? &results.field_lists : nullptr,
                                                         with_histories ? "histories/" + spec.name + ".csv" : ""));
    if (!same_floors(built.plan, results.built.front().plan)) run.floors.clear();
    free_matrices(built);
  }
}

/// Those of the motions that the first run does not have.
void add_motion_warnings(Results& results) {
  std::vector<std::string> said;
  for (const BuiltCase& each : results.built) warn_motions(each.motions, each.plan.stages, said);
  for (const std::string& warning : said)
    if (std::ranges::find(results.warnings, warning) == results.warnings.end()) results.warnings.push_back(warning);
}

const RunResult* bonded_of_group(const Results& results, std::size_t place) {
  for (std::size_t i = 0; i < results.runs.size(); ++i)
    if (results.specs[i].bonded && results.runs[i].group == results.runs[place].group) return &results.runs[i];
  return nullptr;
}

/// Puts the group of a run first, because the page shows the first one. Only the runs that stood there have kept pictures: what now stands
/// there is run again.
void bring_forward(const LoadedCase& loaded, const Control& control, std::size_t place, Results& results) {
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
    if (!pictures[i] || control.is_stopped()) continue;
    results.specs[i].pictures = true;
    results.built[i] = build_run(loaded, results.specs[i]);
    RunResult again =
        run_built(loaded, results.built[i], fmt::format("[again, for its frames] {}", results.specs[i].name), control, false, nullptr);
    if (again.status != RunStatus::interrupted) results.runs[i] = std::move(again);
    free_matrices(results.built[i]);
  }
}

struct OverMotions {
  std::string headline, paragraph;  // empty without [[compare.motion]]
};
/// Judges the first variant under every motion and puts the runs of the hardest one first.
OverMotions show_hardest(const LoadedCase& loaded, const Control& control, const std::vector<MotionTable>& tables, Results& results) {
  if (tables.empty() || control.is_stopped()) return {};
  const RunSpec first = results.specs.front();
  std::vector<JudgedMotion> judged;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    if (results.specs[i].label != first.label || results.specs[i].damping != first.damping) continue;
    judged.push_back({tables.front().rows[judged.size()].motion, &results.runs[i],
                      judge(results.built[i], results.runs[i], bonded_of_group(results, i))});
    places.push_back(i);
  }
  if (judged.size() < 2) return {};
  const std::size_t worst = hardest(judged);
  OverMotions said{fmt::format(" ({}, the most demanding of {} motions)", judged[worst].motion, judged.size()),
                   said_over_motions(judged, tables.front())};
  bring_forward(loaded, control, places[worst], results);
  return said;
}

}  // namespace

Results compare_case(const LoadedCase& loaded, const Control& control) {
  const Comparison plan = comparison_of_case(loaded.read);
  const std::size_t total = plan.runs.size() + plan.sweep.size();
  Results results, sweep;
  const Values& output = loaded.read.values.table("output");
  const bool with_fields = output.has("fields") && output.table("fields").flag("variants");
  run_all(loaded, control, plan.runs, 0, total, true, with_fields, results);
  run_all(loaded, control, plan.sweep, plan.runs.size(), total, false, false, sweep);

  ComparisonSummary& compared = results.comparison.emplace();
  compared.motions = motion_tables(results.specs, results.built, results.runs);
  const OverMotions over = show_hardest(loaded, control, compared.motions, results);
  const Values* compare = loaded.read.values.has("compare") ? &loaded.read.values.table("compare") : nullptr;
  compared.band = compare ? compare->number("band") : 0.02;
  if (compare) compared.columns = compare->texts("agree_on");
  compared.agreement = agreement(results.runs, results.specs, results.built, compared.columns, compared.band);
  compared.sweep = sweep_table(sweep.specs, sweep.runs);
  results.floors = floor_answers(results.built.front().plan, results.runs, results.specs);
  results.verdict = judge(results.built.front(), results.runs.front(), bonded_of_group(results, 0), &results.floors.runs.front());
  results.verdict.step_check.reason = "a comparison has no run with twice the step; `uplift run` has";
  results.verdict.headline += over.headline;
  if (!over.paragraph.empty()) results.verdict.paragraphs.insert(results.verdict.paragraphs.begin(), over.paragraph);
  add_motion_warnings(results);
  for (const RunResult& run : results.runs)
    if (const std::string text = run.equilibrium.warning(); !text.empty() && run.status != RunStatus::failed)
      results.warnings.push_back(run.label + ": " + text);
  return results;
}

}  // namespace uplift
