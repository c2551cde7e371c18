#include "uplift/verdict/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>

#include "uplift/case/schema/case_input.h"
#include "uplift/run/lockstep.h"
#include "uplift/session/history_file.h"
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

/// Whether runs of this model are best marched side by side: what a run does beside its march (fields, checkpoints, laws of the caller) is
/// done alone.
bool marches_in_lockstep(const LoadedCase& loaded, const RunSpec& spec, const BuiltCase& built, bool with_fields) {
  return !loaded.read.input->output.checkpoint && built.model.free() >= large_model && spec.other_case.empty() &&
         loaded.from.reduced == nullptr && loaded.external_laws.empty() && built.model.distributed == nullptr &&
         !(with_fields && loaded.read.input->output.fields);
}

/// Where its matrices are those of an earlier run of the group, the model takes them from there.
LockstepRun in_lockstep(BuiltCase& built, const std::vector<LockstepRun>& before) {
  LockstepRun made{&built.model, &built.plan, &built.behaviours};
  const auto same = [&](const LockstepRun& each) { return each.matrices == nullptr && share_matrices(built.model, *each.model); };
  if (const auto found = std::ranges::find_if(before, same); found != before.end()) made.matrices = found->model;
  return made;
}

/// Runs that are made one after another.
struct RunList {
  const std::vector<RunSpec>& specs;
  std::size_t before, total;  // runs of lists before this one, and of all lists: for the progress
  bool with_histories, with_fields;
};

/// Builds and makes the runs of a list, large ones side by side.
class ListOfRuns {
 public:
  ListOfRuns(const LoadedCase& loaded, const Control& control, const RunList& list, Results& results)
      : loaded_(loaded), control_(control), list_(list), specs_(list.specs), results_(results) {}

  /// Stops after an interrupted run.
  void run() {
    while (results_.built.size() < specs_.size() && !control_.is_stopped()) {
      const std::size_t first = results_.built.size();
      if (marches_in_lockstep(loaded_, specs_[first], next(), list_.with_fields))
        march_from(first);
      else
        results_.runs.push_back(run_built(*results_.others.back(), results_.built.back(), label(first, first), control_, false,
                                          list_.with_fields ? &results_.field_lists : nullptr, histories(first)));
      for (std::size_t i = first; i < results_.runs.size(); ++i) {
        if (!same_floors(results_.built[i].plan, results_.built.front().plan)) results_.runs[i].floors.clear();
        free_matrices(results_.built[i]);
      }
    }
  }

 private:
  /// Builds the next run.
  BuiltCase& next() {
    const RunSpec& spec = specs_[results_.built.size()];
    const std::shared_ptr<const LoadedCase> mine = case_of(loaded_, spec);
    results_.others.push_back(mine);
    results_.specs.push_back(spec);
    BuiltCase& built = results_.built.emplace_back(build_run(*mine, in_its_case(loaded_, *mine, spec)));
    if (results_.built.size() == 1) results_.warnings = warnings(loaded_.read, spec, built);
    if (results_.built.size() == 1) add_statement(loaded_, results_.warnings);
    if (!spec.other_case.empty()) add_warnings_of_other(mine->read, spec, built, results_.warnings);
    return built;
  }

  /// The run that was built, and those after it.
  void march_from(std::size_t first) {
    std::vector<LockstepRun> group{in_lockstep(results_.built.back(), {})};
    while (group.size() < most_in_lockstep && results_.built.size() < specs_.size() && specs_[results_.built.size()].other_case.empty())
      group.push_back(in_lockstep(next(), group));
    const std::size_t last = first + group.size() - 1;
    Watch watch;
    if (control_.watch) watch = control_.watch(label(first, last));
    if (!watch && control_.stopped) watch = [this](const Progress&) { return !control_.stopped(); };
    std::deque<HistoryFile> files;
    std::deque<Keeping> keeping(group.size());
    for (std::size_t k = 0; k < group.size(); ++k) {
      group[k].watch = watch;
      group[k].keeping = &keeping[k];
      if (control_.folder == nullptr || !list_.with_histories) continue;
      HistoryFile& file = files.emplace_back(*control_.folder, histories(first + k));
      keeping[k].follow = [&file](const RunResult& so_far) { file.follow(so_far); };
    }
    for (RunResult& each : run_in_lockstep(group)) {
      each.wall /= static_cast<double>(group.size());
      results_.runs.push_back(std::move(each));
    }
  }

  std::string label(std::size_t first, std::size_t last) const {
    const std::size_t one = list_.before + first + 1, other = list_.before + last + 1;
    if (first == last) return fmt::format("[{}/{}] {}", one, list_.total, specs_[first].name);
    return fmt::format("[{} to {}/{}] {} to {}", one, other, list_.total, specs_[first].name, specs_[last].name);
  }
  std::string histories(std::size_t number) const { return list_.with_histories ? "histories/" + specs_[number].name + ".csv" : ""; }

  const LoadedCase& loaded_;
  const Control& control_;
  const RunList list_;
  const std::vector<RunSpec>& specs_;
  Results& results_;
};

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
  const std::optional<CaseFields>& fields = loaded.read.input->output.fields;
  const bool with_fields = fields && fields->variants;
  ListOfRuns(loaded, control, {plan.runs, 0, total, true, with_fields}, results).run();
  ListOfRuns(loaded, control, {plan.sweep, plan.runs.size(), total, false, false}, sweep).run();

  ComparisonSummary& compared = results.comparison.emplace();
  compared.motions = motion_tables(results.specs, results.built, results.runs);
  const OverMotions over = show_hardest(loaded, control, compared.motions, results);
  const CaseComparison asked = loaded.read.input->compare.value_or(CaseComparison{});
  compared.band = asked.band;
  for (const NameUsed& column : asked.agree_on) compared.columns.push_back(column.name);
  compared.agreement = agreement(results.runs, results.specs, results.built, compared.columns, compared.band);
  compared.sweep = sweep_table(sweep.specs, sweep.runs);
  results.floors = floor_answers(results.built.front().plan, results.runs, results.specs);
  results.verdict = judge(results.built.front(), results.runs.front(), bonded_of_group(results, 0), &results.floors.runs.front());
  results.verdict.step_check.reason = "uplift compare makes no run with twice the step, uplift run does";
  results.verdict.headline += over.headline;
  if (!over.paragraph.empty()) results.verdict.paragraphs.insert(results.verdict.paragraphs.begin(), over.paragraph);
  add_motion_warnings(results);
  for (const RunResult& run : results.runs)
    if (const std::string text = run.equilibrium.warning(); !text.empty() && run.status != RunStatus::failed)
      results.warnings.push_back(run.label + ": " + text);
  return results;
}

}  // namespace uplift
