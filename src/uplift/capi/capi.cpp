#include <cxxabi.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <stdexcept>

#include "uplift.h"
#include "uplift/base/file.h"
#include "uplift/case/schema/sections.h"
#include "uplift/io/results/trust_json.h"
#include "uplift/io/text/json_reader.h"
#include "uplift/io/text/toml.h"
#include "uplift/linear/blas.h"
#include "uplift/motion/spectrum.h"
#include "uplift/session/check.h"
#include "uplift/session/replay.h"
#include "uplift/session/session.h"

// The C interface: translates handles, texts and exceptions, and computes nothing.

struct uplift_case {
  std::shared_ptr<uplift::LoadedCase> loaded;
};

struct uplift_results {
  std::shared_ptr<const uplift::LoadedCase> loaded;
  uplift::Results results;
  std::string folder;        // of the fields, with all results
  mutable std::mutex mutex;  // of the texts that are made when they are asked for
  mutable std::optional<std::string> json, page;
};

namespace {

using namespace uplift;

char* copy_of(const std::string& text) {
  auto* made = static_cast<char*>(std::malloc(text.size() + 1));
  if (made == nullptr) throw std::bad_alloc();
  std::memcpy(made, text.c_str(), text.size() + 1);
  return made;
}

int report(uplift_error* error, int status, const char* message, const Where& where = {}, const std::string& path = {}) noexcept {
  if (error == nullptr) return status;
  uplift_error_clear(error);
  error->status = status;
  error->line = where.line;
  error->column = where.column;
  try {
    error->message = copy_of(message);
    if (!where.file.empty()) error->file = copy_of(where.file);
    if (!path.empty()) error->path = copy_of(path);
  } catch (const std::bad_alloc&) {
    // the status has to do
  }
  return status;
}

/// An argument that must not be null, or is out of range.
class BadArgument : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
template <class Pointer>
Pointer needed(Pointer pointer, const char* name) {
  if (pointer == nullptr) throw BadArgument(fmt::format("the argument \"{}\" is null", name));
  return pointer;
}

/// Calls what may throw and turns exceptions into a status.
template <class Work>
int guarded(uplift_error* error, const Work& work) {
  try {
    work();
    return UPLIFT_OK;
  } catch (const InputError& bad) {
    return report(error, UPLIFT_BAD_INPUT, bad.what(), bad.where(), bad.path());
  } catch (const BadArgument& bad) {
    return report(error, UPLIFT_BAD_INPUT, bad.what());
  } catch (const OutputError& bad) {
    return report(error, UPLIFT_OUTPUT_ERROR, bad.what());
  } catch (const std::bad_alloc&) {
    return report(error, UPLIFT_NO_MEMORY, "not enough memory");
  } catch (const std::exception& bad) {
    return report(error, UPLIFT_INTERNAL_ERROR, bad.what());
  } catch (const abi::__forced_unwind&) {
    throw;  // the thread is cancelled: it must unwind to its end
  } catch (...) {
    return report(error, UPLIFT_INTERNAL_ERROR, "unknown exception");
  }
}

using Analysis = Results (*)(const LoadedCase&, const Control&);

/// What the options of the caller mean, for one analysis.
class Caller {
 public:
  explicit Caller(const uplift_options* options) {
    if (options != nullptr) {
      if (options->size != sizeof(uplift_options))
        throw BadArgument(fmt::format("uplift_options.size is {}, expected {} (uplift_options_init was not called, or another version)",
                                      options->size, sizeof(uplift_options)));
      options_ = *options;
    } else {
      uplift_options_init(&options_);
    }
    if (options_.fields_folder != nullptr) folder_.emplace(options_.fields_folder);
  }

  Control control() {
    Control made;
    made.step_check = options_.step_check != 0;
    made.folder = folder_ ? &*folder_ : nullptr;
    made.stopped = [this] { return stopped(); };
    if (options_.progress != nullptr)
      made.watch = [this](const std::string& label) -> Watch {
        return [this, label](const Progress& progress) { return !stopped() && told(label, progress); };
      };
    if (options_.step != nullptr) made.observe = [this](const Snapshot& snapshot) { show(snapshot); };
    return made;
  }
  /// With the other results beside them, fields are results like those of the program: a later run moves them aside.
  void finish(uplift_results& made) {
    if (!folder_) return;
    write_results(*made.loaded, made.results, *folder_);
    folder_->finish();
    made.folder = std::filesystem::absolute(folder_->path()).string();
  }

 private:
  bool stopped() const { return stop_ || (options_.cancel != nullptr && *options_.cancel != 0); }
  bool told(const std::string& label, const Progress& progress) {
    const uplift_progress given{label.c_str(), progress.fraction, progress.time, progress.open_fraction};
    if (options_.progress(options_.user, &given) != 0) stop_ = true;
    return !stop_;
  }
  void show(const Snapshot& snapshot) {
    if (stop_) return;
    const State& state = snapshot.state;
    const uplift_step given{state.time,
                            snapshot.step,
                            static_cast<int>(snapshot.stage),
                            static_cast<std::size_t>(state.displacement.size()),
                            static_cast<std::size_t>(state.opening.size()),
                            state.displacement.data(),
                            snapshot.stepper != nullptr ? state.velocity.data() : nullptr,
                            state.opening.data(),
                            state.force.data()};
    if (options_.step(options_.user, &given) != 0) stop_ = true;
  }

  uplift_options options_{};
  std::optional<ResultFolder> folder_;
  std::atomic<bool> stop_ = false;
};

int analyse(Analysis analysis, const uplift_case* each, const uplift_options* options, uplift_results** made, uplift_error* error) {
  return guarded(error, [&] {
    *needed(made, "made") = nullptr;
    needed(each, "each");
    const SingleThreadBlas blas;
    Caller caller(options);
    auto results = std::make_unique<uplift_results>();
    results->loaded = each->loaded;
    results->results = analysis(*each->loaded, caller.control());
    caller.finish(*results);
    *made = results.release();
  });
}

/// Whether the results are in this folder already, because their fields are.
bool stand_there(const uplift_results& results, const char* folder) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path summary = fs::path(results.folder) / "summary.json";
  return !results.folder.empty() && fs::equivalent(folder, results.folder, error) && fs::exists(summary, error) &&
         read_file(summary) == results_json(*results.loaded, results.results);
}

const RunResult* run_of(const uplift_results* results, std::size_t run) noexcept {
  return results != nullptr && run < results->results.runs.size() ? &results->results.runs[run] : nullptr;
}

}  // namespace

extern "C" {

void uplift_error_clear(uplift_error* error) {
  if (error == nullptr) return;
  std::free(error->file);
  std::free(error->path);
  std::free(error->message);
  *error = uplift_error{};
}

void uplift_text_free(char* text) {
  std::free(text);
}

const char* uplift_version(void) {
  return UPLIFT_VERSION;
}

int uplift_abi_version(void) {
  return UPLIFT_ABI_VERSION;
}

int uplift_schema(char** text, uplift_error* error) {
  return guarded(error, [&] { *needed(text, "text") = copy_of(to_json_schema(case_section())); });
}

int uplift_toml_to_json(const char* text, const char* file, char** json, uplift_error* error) {
  return guarded(error, [&] { *needed(json, "json") = copy_of(json_text(read_toml_text(needed(text, "text"), needed(file, "file")))); });
}

int uplift_case_load(const char* path, uplift_case** made, uplift_error* error) {
  return guarded(error, [&] {
    *needed(made, "made") = nullptr;
    auto each = std::make_unique<uplift_case>();
    each->loaded = std::make_shared<LoadedCase>(load_case(needed(path, "path"), "libuplift", MeshFiles::in_process));
    *made = each.release();
  });
}

int uplift_case_parse(const char* text, const char* file, uplift_case** made, uplift_error* error) {
  return guarded(error, [&] {
    *needed(made, "made") = nullptr;
    auto each = std::make_unique<uplift_case>();
    each->loaded =
        std::make_shared<LoadedCase>(load_case_text(needed(text, "text"), needed(file, "file"), "libuplift", MeshFiles::in_process));
    *made = each.release();
  });
}

void uplift_case_free(uplift_case* each) {
  delete each;
}

int uplift_case_toml(const uplift_case* each, char** text, uplift_error* error) {
  return guarded(error, [&] { *needed(text, "text") = copy_of(needed(each, "each")->loaded->from.resolved); });
}

int uplift_case_check(const uplift_case* each, char** json, uplift_error* error) {
  return guarded(error, [&] {
    const SingleThreadBlas blas;
    const LoadedCase& loaded = *needed(each, "each")->loaded;
    *needed(json, "json") = copy_of(check_json(loaded, examine(loaded)));
  });
}

int uplift_case_modes(const uplift_case* each, int count, char** json, uplift_error* error) {
  return guarded(error, [&] {
    const SingleThreadBlas blas;
    if (count < 1 || count > 1000) throw BadArgument(fmt::format("\"count\" is {}, expected 1 to 1000", count));
    *needed(json, "json") = copy_of(modes_json(*needed(each, "each")->loaded, count));
  });
}

int uplift_case_set_law(uplift_case* each, const char* name, uplift_law_function function, void* user, uplift_error* error) {
  return guarded(error, [&] {
    needed(function, "function");
    needed(each, "each")->loaded->external_laws[needed(name, "name")] = [function, user](const ExternalStep& s) {
      return function(user, s.points, s.components, s.step, s.from, s.to, s.old, s.traction, s.slope, s.memory, s.stored, s.dissipated) ==
             0;
    };
  });
}

void uplift_options_init(uplift_options* options) {
  if (options == nullptr) return;
  *options = uplift_options{};
  options->size = sizeof(uplift_options);
  options->step_check = 1;
}

int uplift_run(const uplift_case* each, const uplift_options* options, uplift_results** made, uplift_error* error) {
  return analyse(run_case, each, options, made, error);
}
int uplift_compare(const uplift_case* each, const uplift_options* options, uplift_results** made, uplift_error* error) {
  return analyse(compare_case, each, options, made, error);
}
int uplift_trust(const uplift_case* each, const uplift_options* options, uplift_results** made, uplift_error* error) {
  return analyse([](const LoadedCase& loaded, const Control& control) { return trust_case(loaded, control); }, each, options, made, error);
}

void uplift_results_free(uplift_results* results) {
  delete results;
}

int uplift_results_json(const uplift_results* results, const char** json, uplift_error* error) {
  return guarded(error, [&] {
    const std::lock_guard lock(needed(results, "results")->mutex);
    if (!results->json) results->json = results_json(*results->loaded, results->results);
    *needed(json, "json") = results->json->c_str();
  });
}

int uplift_results_trust(const uplift_results* results, char** json, uplift_error* error) {
  return guarded(error, [&] {
    const std::optional<TrustAnswer>& answer = needed(results, "results")->results.trust;
    if (!answer) throw BadArgument("these are not the results of uplift_trust");
    *needed(json, "json") = copy_of(trust_json(*answer));
  });
}

int uplift_results_report(const uplift_results* results, const char** page, uplift_error* error) {
  return guarded(error, [&] {
    const std::lock_guard lock(needed(results, "results")->mutex);
    if (!results->page) results->page = results_page(*results->loaded, results->results);
    *needed(page, "page") = results->page->c_str();
  });
}

int uplift_results_write(const uplift_results* results, const char* folder, char** moved, uplift_error* error) {
  return guarded(error, [&] {
    if (moved != nullptr) *moved = nullptr;
    if (stand_there(*needed(results, "results"), needed(folder, "folder"))) return;
    ResultFolder target(folder);
    write_results(*results->loaded, results->results, target);
    const std::string earlier = target.finish();
    if (moved != nullptr && !earlier.empty()) *moved = copy_of(earlier);
  });
}

size_t uplift_results_runs(const uplift_results* results) {
  return results != nullptr ? results->results.runs.size() : 0;
}

const char* uplift_results_run_name(const uplift_results* results, size_t run) {
  const RunResult* found = run_of(results, run);
  return found != nullptr ? found->name.c_str() : nullptr;
}

size_t uplift_results_columns(const uplift_results* results, size_t run) {
  const RunResult* found = run_of(results, run);
  return found != nullptr ? found->table.size() : 0;
}

int uplift_results_column(const uplift_results* results, size_t run, size_t index, uplift_column* column) {
  const RunResult* found = run_of(results, run);
  if (found == nullptr || column == nullptr || index >= found->table.size()) return 0;
  const std::vector<double>& values = found->table[index];
  const bool is_static = statics_alone(results->results.built[run].plan);
  *column = {is_static ? "load_factor" : "time", is_static ? "1" : "s", values.data(), values.size()};
  if (index > 0) column->name = found->columns[index - 1].name.c_str(), column->unit = found->columns[index - 1].unit.c_str();
  return 1;
}

int uplift_results_floor(const uplift_results* results, size_t run, size_t index, double* step, uplift_column* column) {
  const RunResult* found = run_of(results, run);
  if (found == nullptr || column == nullptr || step == nullptr || index >= found->floors.size()) return 0;
  const FloorRecord& floor = found->floors[index];
  *step = floor.step;
  *column = {results->results.built[run].plan.floors[index].name.c_str(), "m/s2", floor.acceleration.data(), floor.acceleration.size()};
  return 1;
}

int uplift_results_frame(const uplift_results* results, size_t run, size_t index, double* time, uplift_column* column) {
  const RunResult* found = run_of(results, run);
  if (found == nullptr || column == nullptr || time == nullptr || index >= found->frames.size()) return 0;
  const Frame& frame = found->frames[index];
  *time = frame.time;
  *column = {"displacement", "m, rad", frame.displacement.data(), static_cast<size_t>(frame.displacement.size())};
  return 1;
}

int uplift_problem_solve(const char* problem, const char* method, char** json, uplift_error* error) {
  return guarded(error, [&] {
    const SingleThreadBlas blas;
    const StoredProblem stored = load_problem(needed(problem, "problem"), "interface problem");
    if (method != nullptr && *method == '\0') throw BadArgument("\"method\" is empty, expected the name of a contact method or null");
    const std::vector<Replay> answers = replay_problem(stored.problem, method != nullptr ? method : "", {"method", 0});
    *needed(json, "json") = copy_of(replay_json(stored.reason, answers));
  });
}

int uplift_spectrum(const double* acceleration, size_t length, double step, double damping, const double* frequencies, size_t count,
                    double* psa, uplift_error* error) {
  return guarded(error, [&] {
    if (length < 2) throw BadArgument("\"length\" must be at least 2");
    if (!(step > 0 && step < 1e6)) throw BadArgument(fmt::format("\"step\" is {} s, expected a positive number", step));
    if (!(damping >= 0 && damping < 1)) throw BadArgument(fmt::format("\"damping\" is {}, expected 0 <= damping < 1", damping));
    const std::span<const double> values(needed(acceleration, "acceleration"), length);
    const std::vector<double> at(needed(frequencies, "frequencies"), frequencies + count);
    for (const double each : values)
      if (!std::isfinite(each)) throw BadArgument("\"acceleration\" has a value that is not finite");
    for (const double each : at)
      if (!(each > 0 && std::isfinite(each))) throw BadArgument(fmt::format("\"frequencies\" has {} Hz, expected positive numbers", each));
    const std::vector<Spectrum> made = response_spectra(values, step, at, {damping}, Spectrum::Kind::psa, 1, Peaks::between);
    std::ranges::copy(made.front().values, needed(psa, "psa"));
  });
}

}  // extern "C"
