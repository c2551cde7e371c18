#include "uplift/cli/study.h"

#include <fmt/format.h>
#include <sched.h>

#include <algorithm>
#include <filesystem>

#include "uplift/base/error.h"
#include "uplift/base/file.h"
#include "uplift/base/text.h"
#include "uplift/cli/console.h"
#include "uplift/ensemble/compute.h"
#include "uplift/ensemble/coordinator.h"
#include "uplift/ensemble/index.h"
#include "uplift/io/files.h"
#include "uplift/io/results/study_json.h"
#include "uplift/io/text/json_writer.h"

namespace uplift::cli {
namespace {

std::string time_text(double seconds) {
  if (seconds < 90) return fmt::format("{:.0f} s", seconds);
  if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

/// "312 completed, 4 overturned, 2 failed".
std::string outcomes_text(const StudyStatus& status) {
  std::vector<std::string> words;
  for (std::size_t k = 0; k < status.outcomes.size(); ++k)
    if (status.outcomes[k] > 0) words.push_back(fmt::format("{} {}", status.outcomes[k], study_outcomes[k]));
  return words.empty() ? "no runs" : fmt::format("{}", fmt::join(words, ", "));
}

/// One line that tells how far a study is.
std::string status_text(const StudyStatus& status) {
  std::string text = fmt::format("{}/{} runs, {}/{} curves complete: {}", status.runs, std::max(status.runs, status.expected),
                                 status.complete, status.curves, outcomes_text(status));
  constexpr double long_run = 5;  // s: shorter ones need no progress of their own
  if (status.in_progress > 0 && status.rate() > 0 && static_cast<double>(status.in_progress) > long_run * status.rate())
    text += fmt::format("; {} in progress, {} done", status.in_progress, percent(status.marched / static_cast<double>(status.in_progress)));
  if (status.rate() > 0)
    text += status.rate() < 0.02 ? fmt::format("; {:.3g} runs an hour", 3600 * status.rate())
                                 : fmt::format("; {:.3g} runs a second", status.rate());
  if (const std::optional<double> left = status.left(); left && *left > 0) text += fmt::format(", {} left", time_text(*left));
  return text;
}

std::string status_json(const StudyStatus& status, const StudyStore& store, bool running) {
  JsonWriter json(0, 2);
  json.begin_object().member("runs", static_cast<long>(status.runs)).member("expected", static_cast<long>(status.expected));
  json.member("curves", static_cast<long>(status.curves)).member("complete", static_cast<long>(status.complete)).member("running", running);
  json.member("damaged_lines", static_cast<long>(store.damaged())).member("repeated_lines", static_cast<long>(store.repeated()));
  json.key("outcomes").begin_object();
  for (std::size_t k = 0; k < status.outcomes.size(); ++k) json.member(study_outcomes[k], static_cast<long>(status.outcomes[k]));
  return json.end_object().end_object().take() + "\n";
}

/// What a command tells of itself to `status` in another terminal, every two seconds; removed when it ends.
class LiveStatus {
 public:
  explicit LiveStatus(const Study& study) : path_(file_of(study)) {}
  LiveStatus(const LiveStatus&) = delete;
  LiveStatus& operator=(const LiveStatus&) = delete;
  ~LiveStatus() {
    std::error_code error;
    std::filesystem::remove(path_, error);
  }
  void operator()(const StudyStatus& status) {
    const Clock::time_point now = Clock::now();
    if (now - last_ < std::chrono::seconds(2)) return;
    last_ = now;
    try {
      write_file_atomically(path_, status_text(status) + "\n");
    } catch (const std::filesystem::filesystem_error&) {  // a full disk is told by the results
    }
  }
  static std::string file_of(const Study& study) { return study.folder + "/status.txt"; }

 private:
  using Clock = std::chrono::steady_clock;
  std::string path_;
  Clock::time_point last_ = Clock::now();
};

Shard shard_of(const std::string& text) {
  Shard shard;
  const auto refuse = [&] { throw InputError({"uplift study work", 0}, "--shard", "K/N with 1 <= K <= N, as 17/200", in_quotes(text)); };
  const LeadingNumber first = leading_number(text);
  if (first.length == 0 || first.length >= text.size() || text[first.length] != '/') refuse();
  const std::string_view rest = std::string_view(text).substr(first.length + 1);
  const LeadingNumber second = leading_number(rest);
  if (second.length != rest.size() || !(first.value >= 1 && first.value <= second.value && second.value <= 1e9)) refuse();
  shard.number = static_cast<std::size_t>(first.value);
  shard.of = static_cast<std::size_t>(second.value);
  if (static_cast<double>(shard.number) != first.value || static_cast<double>(shard.of) != second.value) refuse();
  return shard;
}

/// What stands in study.json, and on the page where it is asked for.
int evaluate(const Options& options, bool with_page) {
  const Study study = open_study(options.file);
  const StudyStore store(study.folder);
  tell_damage(store);
  write_results(study, curves_with_results(study, store), options, with_page);
  return Exit::done;
}

int finish(const StudyStatus& status, const StudyStore& store, const Options& options, const Study& study) {
  if (options.json) {
    print_text(status_json(status, store, false));
  } else if (!options.quiet) {
    say(status_text(status));
    if (interrupt_asked())
      complain(fmt::format("{}: every result is kept; the same command goes on from there", interrupt_text()));
    else if (status.complete < status.curves)
      say(fmt::format("uplift study report {} evaluates what is there", study.folder));
  }
  return interrupt_asked() ? interrupt_exit_code() : Exit::done;
}

int run_or_work(const Options& options, const StudyOptions& given, const std::optional<Shard>& shard) {
  const Study study = open_study(options.file);
  std::optional<FolderLock> lock;
  if (!shard && lock.emplace(study.folder).is_taken())
    throw InputError({study.folder, 0}, "", "a study that no other process computes",
                     "one that does (uplift study status shows how far it is)");
  catch_interrupts();
  StudyStore store(study.folder);
  tell_damage(store);
  if (given.retry) store.forget_failed();
  const int wanted = given.workers > 0 ? given.workers : study.of.plan.workers;
  StudyRunControl control;
  control.workers = wanted > 0 ? wanted : shard ? 1 : cores();
  if (shard) control.shard = *shard;
  control.stopped = interrupt_asked;
  StatusLine line(options.quiet || options.json);
  std::optional<LiveStatus> live;
  if (!shard) live.emplace(study);
  control.follow = [&](const StudyStatus& status) {
    line(status_text(status));
    if (live) (*live)(status);
  };
  StudyComputer(study).check_reduced();
  StudyStatus status;
  writing([&] { status = run_study(study, store, control); });
  const int code = finish(status, store, options, study);
  if (shard) return code;
  const std::vector<StudyCurve> curves = curves_with_results(study, store);
  writing([&] { write_index(study, store, curves); });
  if (status.complete == status.curves) {
    Options after = options;  // the status was printed already
    after.quiet = options.quiet || options.json;
    after.json = false;
    write_results(study, curves, after, true);
  }
  return code;
}

int status(const Options& options) {
  const Study study = open_study(options.file);
  const StudyStore store(study.folder);
  const StudyStatus status = status_of(curves_with_results(study, store), {});
  const bool busy = FolderLock(study.folder).is_taken();
  if (options.json) {
    print_text(status_json(status, store, busy));
    return Exit::done;
  }
  std::error_code error;
  const std::string live = LiveStatus::file_of(study);
  say(busy && std::filesystem::exists(live, error) ? std::string(trim(read_file(live))) : status_text(status));
  say(busy                               ? "a process computes it"
      : status.complete == status.curves ? "complete"
                                         : fmt::format("uplift study run {} computes what is missing", study.folder));
  if (store.repeated() > 0) say(fmt::format("lines of the parts that repeat a run, which counts once: {}", store.repeated()));
  tell_damage(store);
  return Exit::done;
}

int export_tables(const Options& options, const std::string& id) {
  const Study study = open_study(options.file);
  const StudyStore store(study.folder);
  tell_damage(store);
  const std::vector<StudyCurve> curves = curves_with_results(study, store);
  if (!id.empty()) {
    for (const StudyCurve& curve : curves)
      for (const auto& [intensity, run] : curve.runs())
        if (run.point.id.starts_with(id)) {
          writing([&] { write_run_case(study, run.point.id, curve.sample(), curve.motion(), run.point.factor); });
          say(run_folder(study.folder, run.point.id) + "/case.resolved.toml");
          return Exit::done;
        }
    throw InputError({study.folder, 0}, "--run", "the identity of a run, or its beginning (runs.csv lists them)", in_quotes(id));
  }
  const StudyDocument document = document_of(study, curves);
  write_in(study, "runs.csv", study_runs_csv(document));
  write_in(study, "curves.csv", study_curves_csv(document));
  if (!options.quiet) say(fmt::format("results: {0}/runs.csv, {0}/curves.csv", study.folder));
  return Exit::done;
}

int tasks(const Options& options, int count) {
  const Study study = open_study(options.file);
  const auto shards = std::min(static_cast<std::size_t>(count), study_curves(study.of).size());
  const std::string folder = in_shell(study.folder);
  for (std::size_t k = 1; k <= shards; ++k) {
    say(fmt::format("uplift study work {} --shard {}/{}", folder, k, shards));
  }
  return Exit::done;
}

int index(const Options& options) {
  const Study study = open_study(options.file);
  const StudyStore store(study.folder);
  tell_damage(store);
  writing([&] { write_index(study, store, curves_with_results(study, store)); });
  if (!options.quiet) say(fmt::format("{}/study.db: {} runs", study.folder, store.size()));
  return Exit::done;
}

}  // namespace

int cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  return ::sched_getaffinity(0, sizeof set, &set) == 0 ? std::max(1, CPU_COUNT(&set)) : 1;
}

void tell_damage(const StudyStore& store) {
  if (store.damaged() > 0)
    complain(fmt::format("warning: damaged lines of the parts, whose runs count as not computed: {}", store.damaged()));
}

void write_in(const Study& study, const std::string& name, const std::string& text) {
  writing([&] { write_file_atomically(study.folder + "/" + name, text); });
}

int study(const Options& options, const StudyOptions& given) {
  const std::string& verb = given.verb;
  if (verb == "new") return new_study(options.file);
  if (verb == "check") return check_study(options);
  if (verb == "run") return run_or_work(options, given, std::nullopt);
  if (verb == "work") return run_or_work(options, given, shard_of(given.shard));
  if (verb == "status") return status(options);
  if (verb == "fit") return evaluate(options, false);
  if (verb == "report") return evaluate(options, true);
  if (verb == "export") return export_tables(options, given.run);
  if (verb == "tasks") return tasks(options, given.count);
  return index(options);
}

void check_study_verb(const std::string& verb) {
  const std::vector<std::string> verbs{"new", "check", "run", "status", "fit", "report", "export", "tasks", "work", "index"};
  if (std::ranges::find(verbs, verb) == verbs.end())
    throw InputError({"uplift study", 0}, "", listed(verbs), in_quotes(verb), nearest_name(verb, verbs));
}

}  // namespace uplift::cli
