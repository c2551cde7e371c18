#include "uplift/ensemble/compute.h"

#include <fmt/format.h>

#include <chrono>
#include <deque>
#include <filesystem>
#include <new>
#include <numeric>
#include <set>
#include <utility>

#include "uplift/base/file.h"
#include "uplift/model/model_matrices.h"
#include "uplift/run/lockstep.h"
#include "uplift/verdict/numbers.h"

namespace uplift {
namespace {

constexpr std::size_t most_cases = 4;

void identify(const Study& study, const RunRequest& request, StudyResult& result) {
  result.id = request.id;
  result.motion = study.of.motions[request.motion].name;
  result.sample = static_cast<long>(request.sample);
  result.factor = request.factor;
  result.intensity = request.intensity;
  result.attempt = request.attempt;
}

/// The memory of what ReducedStart has in other coordinates.
void forget_matrices(Model& model) {
  ModelMatrices().swap(model);
  Sparse().swap(model.expansion);
  for (Interface& interface : model.interfaces) Sparse().swap(interface.b);
}

}  // namespace

StudyResult result_without_run(const Study& study, const RunRequest& request, StudyOutcome outcome, const std::string& reason) {
  StudyResult made;
  made.outcome = outcome;
  made.reason = reason;
  identify(study, request, made);
  return made;
}

std::string run_folder(const std::string& folder, const std::string& id) {
  return folder + "/runs/" + id.substr(0, 16);
}

void write_run_case(const Study& study, const std::string& id, std::size_t sample, std::size_t motion, double factor) {
  std::filesystem::create_directories(run_folder(study.folder, id));
  write_file_atomically(run_folder(study.folder, id) + "/case.resolved.toml", resolved_run(study.of, sample, motion, factor));
}

const Case& StudyComputer::case_of(std::size_t sample) {
  const auto found = std::ranges::find(cases_, sample, [](const auto& entry) { return entry.first; });
  if (found != cases_.end()) {
    cases_.splice(cases_.begin(), cases_, found);
  } else {
    cases_.emplace_front(sample, std::make_unique<const Case>(case_of_sample(study_.of, sample)));
    if (cases_.size() > most_cases) cases_.pop_back();
  }
  return *cases_.front().second;
}

RunSpec StudyComputer::spec_of(const RunRequest& request, const Case& read) const {
  return run_of_study(study_.of, read, request.motion, request.factor);
}

BuiltCase StudyComputer::build_run(const RunRequest& request) {
  const Case& read = case_of(request.sample);
  BuiltCase built = build(read, spec_of(request, read));
  std::erase_if(built.plan.requests, [](const Request& column) { return !numbers_need(column); });  // histories are not kept
  return built;
}

/// Where a run has a limit of time or memory of its own, it is computed alone.
bool StudyComputer::marches_in_lockstep(const BuiltCase& built) const {
  return built.model.free() >= large_model && !study_.reduced && !study_.of.plan.timeout && !study_.of.plan.memory;
}

void StudyComputer::check_reduced() {
  if (!study_.reduced) return;
  RunRequest request;
  for (; request.sample < study_.of.samples.size(); ++request.sample)
    refuse_reduced(*study_.reduced, study_.of.read.values.where("reduced_model"), build_run(request));
}

std::size_t StudyComputer::best_together(const RunRequest& one) try {
  return marches_in_lockstep(build_run(one)) ? most_in_lockstep : 1;
} catch (const std::exception&) {
  return 1;  // the run itself will say why
}

StudyResult StudyComputer::finish(const RunRequest& request, const BuiltCase& built, RunResult run) const {
  if (ended_ && run.status == RunStatus::interrupted) run.status = RunStatus::completed;
  StudyResult made = result_of(built, run, study_.of.plan.floor_spectra);
  identify(study_, request, made);
  if (made.outcome == StudyOutcome::timeout) made.reason = fmt::format("it took longer than {:g} s", study_.of.plan.timeout.value_or(0));
  if (made.replay) {
    std::filesystem::create_directories(run_folder(study_.folder, request.id));
    write_file_atomically(run_folder(study_.folder, request.id) + "/problem.json", run.problem);
  }
  return made;
}

/// The static stages with the whole model, once for all motions of a sample, the rest with the reduced one.
RunResult StudyComputer::run_reduced(BuiltCase& built, const Watch& watch, std::optional<ReducedStart>& shared) const {
  const Values& root = study_.of.read.values;
  RunResult resting;
  const std::optional<RunState> begin = begin_reduced(*study_.reduced, root.where("reduced_model"), built, watch, resting, &shared);
  if (!begin) return resting;
  Keeping keeping;
  keeping.from = &*begin;
  return run(built.model, built.plan, built.behaviours, watch, {}, &keeping);
}

bool StudyComputer::goes_on(double marched) {
  if (!ended_ && watch_ && !watch_(marched)) ended_ = true;
  return !ended_;
}

/// Tells how far a run is that is computed alone, and stops what takes longer, from now on, than a run may.
Watch StudyComputer::watch_of_run() {
  ended_ = false;
  return [this, start = std::chrono::steady_clock::now(), timeout = study_.of.plan.timeout](const Progress& progress) {
    if (!goes_on(progress.fraction)) return false;
    return !timeout || std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < *timeout;
  };
}

/// Another run of the sample that ran last with the reduced model, where its motions are all that is new: no whole model is made.
std::optional<StudyResult> StudyComputer::compute_again(const RunRequest& request) {
  std::optional<BuiltCase> built = std::exchange(ran_, {});  // kept again by a run that goes through; it names parts of the sample's case
  if (!built || !start_ || start_sample_ != request.sample) return {};
  const Case& read = case_of(request.sample);
  if (!change_motion(read, spec_of(request, read), *built)) return {};
  try {
    start_->swap_matrices(built->model);
    Keeping keeping;
    keeping.from = &start_->state;
    StudyResult made = finish(request, *built, run(built->model, built->plan, built->behaviours, watch_of_run(), {}, &keeping));
    start_->swap_matrices(built->model);
    ran_ = std::move(built);
    return made;
  } catch (...) {
    start_.reset();
    throw;
  }
}

StudyResult StudyComputer::compute(const RunRequest& request, BuiltCase& built) {
  const Watch watch = watch_of_run();
  if (!study_.reduced) return finish(request, built, run(built.model, built.plan, built.behaviours, watch));
  // what the runs share is kept again by a run that goes through
  std::optional<ReducedStart> shared = start_sample_ == request.sample ? std::exchange(start_, {}) : std::nullopt;
  StudyResult made = finish(request, built, run_reduced(built, watch, shared));
  ran_.reset();
  if (shared) {
    shared->swap_matrices(built.model);
    forget_matrices(built.model);
    ran_ = std::move(built);
  }
  start_ = std::move(shared), start_sample_ = request.sample;
  return made;
}

/// A run of a large model is always marched in this way, with others or not: its result does not depend on them, to the last bit.
void StudyComputer::compute_in_lockstep(std::span<const RunRequest> group, BuiltCase first,
                                        const std::function<void(const StudyResult&)>& done) {
  ended_ = false;
  std::deque<BuiltCase> built;
  std::vector<LockstepRun> runs;
  std::vector<double> marched(group.size(), 0);  // of each run; 0: it has ended
  const auto watch_of = [&](std::size_t number) -> Watch {
    return [&, number](const Progress& progress) {
      marched[number] = progress.fraction;
      return goes_on(std::accumulate(marched.begin(), marched.end(), 0.0));
    };
  };
  for (const RunRequest& request : group) {
    built.push_back(runs.empty() ? std::move(first) : build_run(request));
    const bool shares = !runs.empty() && share_matrices(built.back().model, built.front().model);
    runs.push_back({&built.back().model, &built.back().plan, &built.back().behaviours, shares ? &built.front().model : nullptr,
                    watch_of(runs.size())});
  }
  LockstepOptions options;
  options.ended = [&](std::size_t number, RunResult& run) {
    run.wall /= static_cast<double>(group.size());
    marched[number] = 0;
    done(finish(group[number], built[number], std::move(run)));
  };
  run_in_lockstep(runs, options);
}

StudyResult StudyComputer::compute(const RunRequest& request) {
  if (std::optional<StudyResult> again = compute_again(request)) return *again;
  BuiltCase built = build_run(request);
  if (!marches_in_lockstep(built)) return compute(request, built);
  StudyResult made;
  compute_in_lockstep({&request, 1}, std::move(built), [&](const StudyResult& result) { made = result; });
  return made;
}

void StudyComputer::compute(std::span<const RunRequest> group, const std::function<void(const StudyResult&)>& done,
                            const WatchRuns& watch) {
  watch_ = watch;
  std::set<std::string> told;
  const auto tell = [&](const StudyResult& result) {
    told.insert(result.id);
    done(result);
  };
  for (const RunRequest& request : group) {
    if (told.contains(request.id)) continue;
    const auto not_computed = [&](StudyOutcome outcome, const char* why) {
      if (!told.contains(request.id)) tell(result_without_run(study_, request, outcome, why));
    };
    try {
      if (const std::optional<StudyResult> again = compute_again(request)) {
        tell(*again);
        continue;
      }
      BuiltCase built = build_run(request);
      if (marches_in_lockstep(built))
        compute_in_lockstep(group.subspan(static_cast<std::size_t>(&request - group.data())), std::move(built), tell);
      else
        tell(compute(request, built));
    } catch (const std::bad_alloc&) {
      not_computed(StudyOutcome::memory, "it needed more memory than there is");
    } catch (const std::exception& error) {
      not_computed(StudyOutcome::failed, error.what());
    }
  }
  watch_ = {};
}

}  // namespace uplift
