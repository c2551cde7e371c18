#include <fmt/format.h>

#include <algorithm>

#include "uplift/base/format.h"
#include "uplift/base/text.h"
#include "uplift/case/schema/case_input.h"
#include "uplift/cli/console.h"
#include "uplift/cli/study.h"
#include "uplift/cli/study_trials.h"
#include "uplift/ensemble/part_file.h"
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

/// Share of the motion that the first run was computed for: trial runs that take long are ended.
double computed_share(const BuiltCase& built, const StudyResult& trial) {
  double planned = 0;
  for (const Stage& stage : built.plan.stages)
    if (stage.type == Stage::Type::dynamics) planned += stage.duration;
  return trial.outcome == StudyOutcome::completed && trial.end_time < (1 - 1e-6) * planned ? trial.end_time / planned : 1;
}

/// What should be known before anything is computed.
std::vector<std::string> warnings_of(const Study& study, const BuiltCase& built, const RunSpec& spec, const Case& read,
                                     const StudyResult& trial) {
  std::vector<std::string> said = warnings(read, spec, built);
  if (study.reduced) said.insert(said.begin(), study.reduced_statement());
  const bool is_cut = computed_share(built, trial) < 1;  // it has not come to rest
  for (const StudyLimit& limit : study.of.plan.limits)
    if (limit.quantity && !demand_of(limit, trial) && !(is_cut && limit.quantity->name.starts_with("residual")))
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
  Trials trials;
  double share = 1;  // of the first run, that was computed
  double line = 0;   // bytes of a run's results
  std::size_t samples = 1;
  double left() const {
    const auto missing = static_cast<double>(status.expected - status.runs);
    return trials.seconds * missing + trials.before * std::min(missing, static_cast<double>(samples));
  }
  double disk() const { return line * static_cast<double>(status.expected); }
};

std::string json_of(const Forecast& forecast, const std::vector<std::string>& warnings) {
  JsonWriter json(0, 2);
  json.begin_object().member("runs", static_cast<long>(forecast.status.expected)).member("done", static_cast<long>(forecast.status.runs));
  json.member("seconds_of_a_run", forecast.trials.seconds)
      .member("seconds_before_a_sample", forecast.trials.before)
      .member("seconds_on_one_core", forecast.left())
      .member("bytes_of_memory", forecast.trials.memory)
      .member("runs_in_lockstep", static_cast<long>(forecast.trials.together));
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
      forecast.trials.before > 0 ? fmt::format(", {} before the first one of a sample", format_quantity(forecast.trials.before, "s")) : "";
  const std::string from = forecast.share < 1 ? fmt::format(" (from its first {})", percent(forecast.share)) : "";
  line("time", fmt::format("{} a run{}{}; {} on one core for all that are missing", format_quantity(forecast.trials.seconds, "s"), from,
                           once, format_quantity(forecast.left(), "s")));
  line("memory", fmt::format("{} a worker{}", format_bytes(forecast.trials.memory),
                             forecast.trials.together > 1 ? fmt::format(", with {} runs in lockstep", forecast.trials.together) : ""));
  line("disk", format_bytes(forecast.disk()));
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
  const Trials trials = run_trials(study, computer, request, status, options.quiet);
  const Case read = case_of_sample(study.of, 0);
  const RunSpec spec = run_of_study(study.of, read, 0, 1);
  const BuiltCase built = build(read, spec);
  const Forecast forecast{status, trials, computed_share(built, trials.first), static_cast<double>(line_of(trials.first).size()),
                          study.of.samples.size()};
  const std::vector<std::string> said = warnings_of(study, built, spec, read, trials.first);
  if (options.json) {
    print_text(json_of(forecast, said));
    return Exit::done;
  }
  print(study, forecast);
  for (const std::string& warning : said) complain("warning: " + warning);
  return Exit::done;
}

}  // namespace uplift::cli
