#include "uplift/ensemble/compute.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <new>

#include "uplift/base/file.h"

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

}  // namespace

StudyResult result_without_run(const Study& study, const RunRequest& request, StudyOutcome outcome, const std::string& reason) {
  StudyResult made;
  made.outcome = outcome;
  made.reason = reason;
  identify(study, request, made);
  return made;
}

std::string run_folder(const Study& study, const std::string& id) {
  return study.folder + "/runs/" + id.substr(0, 16);
}

void write_run_case(const Study& study, const std::string& id, std::size_t sample, std::size_t motion, double factor) {
  std::filesystem::create_directories(run_folder(study, id));
  write_file_atomically(run_folder(study, id) + "/case.resolved.toml", resolved_run(study.of, sample, motion, factor));
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

StudyResult StudyComputer::compute(const RunRequest& request) {
  const Case& read = case_of(request.sample);
  const BuiltCase built = build(read, run_of_study(study_.of, read, request.motion, request.factor));
  const auto start = std::chrono::steady_clock::now();
  const std::optional<double> timeout = study_.of.plan.timeout;
  Watch watch;
  if (timeout)
    watch = [&](const Progress&) { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < *timeout; };
  const RunResult run = uplift::run(built.model, built.plan, built.behaviours, watch);
  StudyResult made = result_of(built, run, study_.of.plan.floor_spectra);
  identify(study_, request, made);
  if (made.outcome == StudyOutcome::timeout) made.reason = fmt::format("it took longer than {:g} s", *timeout);
  if (made.replay) {
    std::filesystem::create_directories(run_folder(study_, request.id));
    write_file_atomically(run_folder(study_, request.id) + "/problem.json", run.problem);
  }
  return made;
}

void StudyComputer::compute(std::span<const RunRequest> group, const std::function<void(const StudyResult&)>& done) {
  for (const RunRequest& request : group) {
    StudyResult made;
    try {
      made = compute(request);
    } catch (const std::bad_alloc&) {
      made = result_without_run(study_, request, StudyOutcome::memory, "it needed more memory than there is");
    } catch (const std::exception& error) {
      made = result_without_run(study_, request, StudyOutcome::failed, error.what());
    }
    done(made);
  }
}

}  // namespace uplift
