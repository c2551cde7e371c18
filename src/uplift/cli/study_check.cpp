#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <ctime>
#include <numeric>

#include "uplift/base/format.h"
#include "uplift/base/text.h"
#include "uplift/case/schema/case_input.h"
#include "uplift/cli/console.h"
#include "uplift/cli/study.h"
#include "uplift/ensemble/compute.h"
#include "uplift/ensemble/coordinator.h"
#include "uplift/ensemble/part_file.h"
#include "uplift/ensemble/workers.h"
#include "uplift/io/text/json_writer.h"

namespace uplift::cli {
namespace {

void line(std::string_view what, const std::string& value) {
  say(fmt::format("  {:<16} {}", what, value));
}

std::string intensities(const StudyPlan& plan) {
  const StudyMethod& method = plan.method;
  const std::string unit = plan.intensity.unit == "1" ? "" : " " + plan.intensity.unit;
  if (method.searches())
    return fmt::format("{}: {} from {:g} to at most {:g}{}, to {}", to_string(method.type), plan.intensity.label(), method.search.start,
                       method.search.largest, unit, percent(method.search.tolerance));
  return fmt::format("{}: {} {:g}{}", to_string(method.type), method.type == StudyMethod::Type::cloud ? "factors" : plan.intensity.label(),
                     fmt::join(method.levels, ", "), method.type == StudyMethod::Type::cloud ? "" : unit);
}

/// What should be known before anything is computed.
std::vector<std::string> warnings_of(const Study& study, const BuiltCase& built, const RunSpec& spec, const Case& read,
                                     const StudyResult& trial) {
  std::vector<std::string> said = warnings(read, spec, built);
  if (study.reduced) said.insert(said.begin(), study.reduced_statement());
  for (const StudyLimit& limit : study.of.plan.limits)
    if (limit.quantity && !demand_of(limit, trial))
      said.push_back(fmt::format("the limit {}: the first run has no {}{}", in_quotes(limit.name), limit.quantity->name,
                                 limit.of.empty() ? "" : " of " + in_quotes(limit.of)));
  for (const CaseGround& ground : read.input->grounds)
    if (ground.amplitude != 1)
      said.push_back(fmt::format("{} multiplies its record by {:g}: the intensities are those of the records", ground.path("amplitude"),
                                 ground.amplitude));
  if (!says_something(trial.outcome))
    said.push_back(fmt::format("the first run ends as \"{}\": {}", to_string(trial.outcome), trial.reason));
  if (study.of.plan.floor_spectra && trial.spectra.empty()) said.emplace_back("floor_spectra: the case has no [[output.floor_spectrum]]");
  if (study.of.motions.size() < 3) said.push_back(fmt::format("{} motions: their scatter is hardly known", study.of.motions.size()));
  for (const StudyMotion& motion : study.of.motions)
    if (!motion.record.empty() && !study.of.plan.method.searches())
      for (const double level : study.of.plan.method.levels)
        if (const double factor = study.of.plan.method.type == StudyMethod::Type::cloud ? level : level / motion.intensity;
            factor > 5 || factor < 0.2) {
          said.push_back(fmt::format("the motion {} is scaled by {:.3g}: far from what was recorded", in_quotes(motion.name), factor));
          break;
        }
  return said;
}

/// What a study will take, from its first runs.
struct Forecast {
  StudyStatus status;
  double seconds = 0, memory = 0, line = 0;  // s of a run; bytes of a worker; bytes of a run's results
  double before = 0;                         // s before the first run of a sample with a reduced model, for all its motions
  std::size_t samples = 1, together = 1;     // runs of a worker that march in lockstep
  double left() const {
    const auto missing = static_cast<double>(status.expected - status.runs);
    return seconds * missing + before * std::min(missing, static_cast<double>(samples));
  }
  double disk() const { return line * static_cast<double>(status.expected); }
};

std::string json_of(const Forecast& forecast, const std::vector<std::string>& warnings) {
  JsonWriter json(0, 2);
  json.begin_object().member("runs", static_cast<long>(forecast.status.expected)).member("done", static_cast<long>(forecast.status.runs));
  json.member("seconds_of_a_run", forecast.seconds)
      .member("seconds_before_a_sample", forecast.before)
      .member("seconds_on_one_core", forecast.left())
      .member("bytes_of_memory", forecast.memory)
      .member("runs_in_lockstep", static_cast<long>(forecast.together));
  return json.member("bytes_on_disk", forecast.disk()).key("warnings").texts(warnings).end_object().take() + "\n";
}

void print(const Study& study, const Forecast& forecast) {
  const StudyPlan& plan = study.of.plan;
  say(fmt::format("{}: {}", study.name, study.of.read.input->title));
  line("motions", fmt::format("{}", study.of.motions.size()));
  line("samples",
       fmt::format("{} of {} variables, {}", study.of.samples.size(), plan.variables.size(), plan.crossed ? "crossed" : "paired"));
  line("intensities", intensities(plan));
  for (const StudyLimit& limit : plan.limits)
    line("limit", limit.name + ": " +
                      (limit.quantity ? fmt::format("{} {} {}", limit.quantity->name, limit.quantity->at_least ? "at least" : "at most",
                                                    format_value(*limit.quantity, limit.limit))
                                      : std::string("overturned or separated")));
  line("runs",
       fmt::format("{}{}, of which {} are done", plan.method.searches() ? "about " : "", forecast.status.expected, forecast.status.runs));
  const std::string once =
      forecast.before > 0 ? fmt::format(", {} before the first one of a sample", format_quantity(forecast.before, "s")) : "";
  line("time", fmt::format("{} a run{}; {} on one core for all that are missing", format_quantity(forecast.seconds, "s"), once,
                           format_quantity(forecast.left(), "s")));
  line("memory", fmt::format("{} a worker{}", format_bytes(forecast.memory),
                             forecast.together > 1 ? fmt::format(", with {} runs in lockstep", forecast.together) : ""));
  line("disk", format_bytes(forecast.disk()));
}

/// Processor time [s] of this process: unlike the elapsed time it does not depend on what else the machine does. getrusage() counts it in
/// ticks of some milliseconds.
double processor_time() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Runs as a worker of the study computes them, in a process of its own; the results of those before it ended. Their times are what each
/// took of the processor.
std::vector<StudyResult> compute_in_worker(const Study& study, StudyComputer& computer, const std::vector<RunRequest>& runs) {
  WorkerPool pool(1, {std::nullopt, study.of.plan.memory}, [&](const std::vector<RunRequest>& batch, const auto& done) {
    double last = processor_time();
    computer.compute(batch, [&](StudyResult result) {
      const double now = processor_time();
      result.wall = now - std::exchange(last, now);
      done(result);
    });
  });
  pool.send(0, runs);
  std::vector<StudyResult> results;
  while (results.size() < runs.size()) {
    const WorkerPool::Events events = pool.wait(std::chrono::milliseconds(200));
    results.insert(results.end(), events.results.begin(), events.results.end());
    for (const WorkerPool::Death& death : events.deaths) {
      results.push_back(result_without_run(study, death.lost.front(), StudyOutcome::crashed, "its process ended with " + death.how));
      return results;
    }
  }
  return results;
}

/// Most memory that a worker has held so far [bytes].
double largest_memory() {
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

std::vector<RunRequest> group_of(const Study& study, const RunRequest& trial, std::size_t runs) {
  std::vector<RunRequest> group(runs, trial);
  for (std::size_t i = 0; i < runs; ++i) {
    group[i].id = fmt::format("trial {}", i);
    group[i].motion = i % study.of.motions.size();
  }
  return group;
}

/// Most memory of a worker that has computed such a group [bytes].
double memory_of(const Study& study, StudyComputer& computer, const RunRequest& trial, std::size_t runs) {
  compute_in_worker(study, computer, group_of(study, trial, runs));
  return largest_memory();
}

/// A worker's memory with a group of runs in lockstep. The second run costs more than those behind it: until it shares the matrices of the
/// first one, it has its own, and what it gives back serves the next ones. So a run more is what four take more than two.
double memory_of_group(const Study& study, StudyComputer& computer, const RunRequest& trial, std::size_t together) {
  constexpr std::size_t few = 2, more = 4;
  if (together <= more) return memory_of(study, computer, trial, together);
  const double with_few = memory_of(study, computer, trial, few), with_more = memory_of(study, computer, trial, more);
  return with_more + static_cast<double>(together - more) * (with_more - with_few) / (more - few);
}

/// Time of a run on one core [s], from that of the first one of a worker. Where that is short, most of it is code and memory that are
/// touched for the first time: then it is what further runs take.
double seconds_of(const Study& study, StudyComputer& computer, const RunRequest& trial, double alone) {
  constexpr double short_run = 0.1;  // s
  constexpr std::size_t further = 10;
  if (alone > short_run) return alone;
  const std::vector<StudyResult> runs = compute_in_worker(study, computer, group_of(study, trial, further + 1));
  if (runs.size() <= further) return alone;  // the process has died
  return std::accumulate(runs.begin() + 1, runs.end(), 0.0, [](double sum, const StudyResult& run) { return sum + run.wall; }) / further;
}

/// Runs of a worker's group: as many as it would be given.
std::size_t group_size(const Study& study, StudyComputer& computer, const RunRequest& trial, const StudyStatus& status) {
  const auto workers = static_cast<std::size_t>(study.of.plan.workers > 0 ? study.of.plan.workers : cores());
  const std::size_t runs = std::max(study.of.plan.method.searches() ? status.curves : status.expected, std::size_t{1});
  const std::size_t of_sample = (runs + study.of.samples.size() - 1) / study.of.samples.size();
  return std::min({computer.best_together(trial), (runs + workers - 1) / workers, of_sample});
}

}  // namespace

int check_study(const Options& options) {
  const Study study = open_study(options.file);
  const StudyStore store(study.folder);
  std::vector<StudyCurve> curves = curves_with_results(study, store);
  const StudyStatus status = status_of(curves, {});
  for (std::size_t i = 0; i < study.of.samples.size(); ++i) case_of_sample(study.of, i);  // every one is checked
  StudyComputer computer(study);
  computer.check_reduced();
  if (study.of.samples.size() == 1) computer.prepare(0);  // as the study does, for all workers
  const double start = study.of.plan.method.searches() ? study.of.plan.method.search.start : study.of.plan.method.levels.front();
  const bool cloud = study.of.plan.method.type == StudyMethod::Type::cloud;
  RunRequest request{"trial", 0, curves.front().sample(), curves.front().motion(), 1, start, 1};
  request.factor = cloud ? start : start / study.of.motions[request.motion].intensity;
  const std::size_t together = group_size(study, computer, request, status);
  const std::vector<StudyResult> trials =
      compute_in_worker(study, computer, study.reduced ? group_of(study, request, 2) : std::vector{request});
  const StudyResult& trial = trials.front();
  // a reduced model is begun once for all motions of a sample: the second run tells what the others take
  const bool told = study.reduced && trials.size() == 2;
  const double seconds = told ? trials.back().wall : seconds_of(study, computer, request, trial.wall);
  const double memory = together == 1 ? largest_memory() : memory_of_group(study, computer, request, together);
  const Case read = case_of_sample(study.of, 0);
  const RunSpec spec = run_of_study(study.of, read, 0, 1);
  const BuiltCase built = build(read, spec);
  const Forecast forecast{status,
                          seconds,
                          memory,
                          static_cast<double>(line_of(trial).size()),
                          told ? std::max(0.0, trials.front().wall - seconds) : 0,
                          study.of.samples.size(),
                          together};
  const std::vector<std::string> said = warnings_of(study, built, spec, read, trial);
  if (options.json) {
    print_text(json_of(forecast, said));
    return Exit::done;
  }
  print(study, forecast);
  for (const std::string& warning : said) complain("warning: " + warning);
  return Exit::done;
}

}  // namespace uplift::cli
