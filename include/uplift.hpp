// uplift: uplift of foundations in earthquakes. C++ interface of the library libuplift: objects that own the handles of uplift.h.
//
// Needs C++17 and nothing but uplift.h. All quantities are in SI units; an opening > 0 separates the faces of an interface, a traction > 0
// is tension. Refusals and failures of the library are thrown as Error; exceptions of the caller's functions pass through an analysis.
// Objects may be used by different threads, one thread at a time each.
#ifndef UPLIFT_HPP
#define UPLIFT_HPP

#include <uplift.h>

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace uplift {

/// A refusal or failure of the library. `line` and `column` count from 1 and are 0 where they are not known; `path` is the key as in
/// "interface[0].law.K_n".
class Error : public std::runtime_error {
 public:
  explicit Error(const uplift_error& from)
      : std::runtime_error(from.message != nullptr ? from.message : "unknown error"),
        status(from.status),
        line(from.line),
        column(from.column),
        file(from.file != nullptr ? from.file : ""),
        path(from.path != nullptr ? from.path : "") {}
  int status, line, column;
  std::string file, path;
};

namespace detail {

/// Calls a function of the C interface with its arguments and an error, and throws what it reports.
template <typename Function, typename... Arguments>
void call(Function function, Arguments... arguments) {
  uplift_error error{};
  if (function(arguments..., &error) == UPLIFT_OK) return;
  const Error thrown(error);
  uplift_error_clear(&error);
  throw thrown;
}

/// The text that a function returns through its last argument before the error.
template <typename Function, typename... Arguments>
std::string text_of(Function function, Arguments... arguments) {
  char* text = nullptr;
  call(function, arguments..., &text);
  const std::unique_ptr<char, void (*)(char*)> owner(text, uplift_text_free);
  return text != nullptr ? std::string(text) : std::string();
}

}  // namespace detail

inline std::string version() {
  return uplift_version();
}
/// JSON Schema of the case file.
inline std::string schema() {
  return detail::text_of(uplift_schema);
}

/// Numbers of the library, valid as long as the results they come from.
class Numbers {
 public:
  Numbers(const double* values, std::size_t count) : values_(values), count_(count) {}
  const double* begin() const { return values_; }
  const double* end() const { return values_ + count_; }
  const double* data() const { return values_; }
  std::size_t size() const { return count_; }
  double operator[](std::size_t i) const { return values_[i]; }

 private:
  const double* values_;
  std::size_t count_;
};

/// One step of all points of an interface, for a law of the caller; the energies and the layout are those of uplift_law_function.
struct LawStep {
  int points, components;  // the normal component is the last one
  double step;             // s; 0 in statics
  const double *from, *to, *old_memory;
  double *traction, *slope, *memory, *stored, *dissipated;

  /// Place of component c of point i in openings and tractions.
  std::size_t at(int c, int i) const {
    return static_cast<std::size_t>(c) * static_cast<std::size_t>(points) + static_cast<std::size_t>(i);
  }
  /// Place of d traction_r / d opening_c of point i in the slope, which is zero on entry.
  std::size_t at(int r, int c, int i) const { return at(r * components + c, i); }
};
using Law = std::function<void(const LawStep&)>;

/// A step of the case's own run. The arrays belong to the library and are valid until the function returns or the march goes on.
struct Step {
  double time;  // s
  long number;  // in its stage
  int stage;
  Numbers displacement;  // free unknowns [m, rad]
  Numbers velocity;      // the same; empty in static stages
  Numbers opening;       // rows of all interfaces [m]
  Numbers force;         // the same at the end of the step [N], tension > 0
};

/// How an analysis is followed. Functions return whether it shall go on.
struct Options {
  bool step_check = true;     // with the companion run with twice the step
  std::string fields_folder;  // results folder with the fields and everything else that the program writes; empty: no fields
  std::function<bool(const uplift_progress&)> progress;
  std::function<bool(const Step&)> step;
};

struct Column {
  std::string name, unit;
  Numbers values;
};

/// What an analysis computed. Run 0 is the case's own.
class Results {
 public:
  explicit Results(std::shared_ptr<uplift_results> handle) : handle_(std::move(handle)) {}

  /// The results document (summary.json).
  std::string json() const { return lent(uplift_results_json); }
  /// The report as one HTML page.
  std::string report() const { return lent(uplift_results_report); }
  /// Writes what the program writes. Returns where earlier results were moved; empty when there were none.
  std::string write(const std::string& folder) const { return detail::text_of(uplift_results_write, handle_.get(), folder.c_str()); }
  /// The bands of Case::trust (trust.json).
  std::string bands() const { return detail::text_of(uplift_results_trust, handle_.get()); }

  std::size_t runs() const { return uplift_results_runs(handle_.get()); }
  std::string run_name(std::size_t run) const {
    const char* name = uplift_results_run_name(handle_.get(), run);
    if (name == nullptr) throw std::out_of_range("no run " + std::to_string(run));
    return name;
  }
  /// All histories of a run; the first is the time [s], or the load factor of a static case.
  std::vector<Column> histories(std::size_t run = 0) const {
    std::vector<Column> made;
    uplift_column column{};
    for (std::size_t k = 0; uplift_results_column(handle_.get(), run, k, &column) != 0; ++k)
      made.push_back({column.name, column.unit, {column.values, column.count}});
    return made;
  }
  /// A history by its name, as "underside.moment". Throws std::out_of_range.
  Numbers operator[](const std::string& name) const { return history(name); }
  Numbers history(const std::string& name, std::size_t run = 0) const {
    for (const Column& column : histories(run))
      if (column.name == name) return column.values;
    throw std::out_of_range("no history \"" + name + "\"");
  }
  Numbers time(std::size_t run = 0) const {
    uplift_column column{};
    if (uplift_results_column(handle_.get(), run, 0, &column) == 0) return {nullptr, 0};  // a run that failed before its first instant
    return {column.values, column.count};
  }
  /// Absolute acceleration [m/s2] of a floor at every step, and the step [s]. Throws std::out_of_range.
  std::pair<Numbers, double> floor(const std::string& name, std::size_t run = 0) const {
    double step = 0;
    uplift_column column{};
    for (std::size_t k = 0; uplift_results_floor(handle_.get(), run, k, &step, &column) != 0; ++k)
      if (name == column.name) return {{column.values, column.count}, step};
    throw std::out_of_range("no floor \"" + name + "\"");
  }

 private:
  template <typename Function>
  std::string lent(Function function) const {
    const char* text = nullptr;
    detail::call(function, handle_.get(), &text);
    return text;
  }
  std::shared_ptr<uplift_results> handle_;
};

/// A case: model, loads and analysis, read and checked.
class Case {
 public:
  /// A case file, or the case.toml of a folder.
  static Case load(const std::string& path) {
    uplift_case* made = nullptr;
    detail::call(uplift_case_load, path.c_str(), &made);
    return Case(made);
  }
  /// A text in TOML or JSON. `file` is its name in messages; relative paths of the case start from its folder.
  static Case parse(const std::string& text, const std::string& file = "case.toml") {
    uplift_case* made = nullptr;
    detail::call(uplift_case_parse, text.c_str(), file.c_str(), &made);
    return Case(made);
  }

  /// The case with all default values.
  std::string toml() const { return detail::text_of(uplift_case_toml, handle_.get()); }
  /// What a run would compute, as JSON.
  std::string check() const { return detail::text_of(uplift_case_check, handle_.get()); }
  /// Natural modes, as JSON.
  std::string modes(int count = 6) const { return detail::text_of(uplift_case_modes, handle_.get(), count); }

  /// Connects a law of the caller to the laws of type "external" with this name. What it throws fails the step and leaves the analysis.
  void set_law(const std::string& name, Law law) {
    laws_->push_back({std::move(law), nullptr, {}});
    detail::call(uplift_case_set_law, handle_.get(), name.c_str(), uplift_law_function(respond), static_cast<void*>(&laws_->back()));
  }

  Results run(const Options& options = {}) const { return analyse(uplift_run, options); }
  Results compare(const Options& options = {}) const { return analyse(uplift_compare, options); }
  Results trust(const Options& options = {}) const { return analyse(uplift_trust, options); }

 private:
  struct Connected {
    Law law;
    std::exception_ptr thrown;
    std::unique_ptr<std::mutex> mutex = std::make_unique<std::mutex>();
  };
  using Laws = std::list<Connected>;  // the library keeps pointers to them

  explicit Case(uplift_case* made) : handle_(made, uplift_case_free) {}

  static int respond(void* user, int points, int components, double step, const double* from, const double* to, const double* old_memory,
                     double* traction, double* slope, double* memory, double* stored, double* dissipated) {
    Connected& mine = *static_cast<Connected*>(user);
    try {
      mine.law({points, components, step, from, to, old_memory, traction, slope, memory, stored, dissipated});
      return 0;
    } catch (...) {
      const std::lock_guard<std::mutex> lock(*mine.mutex);
      if (!mine.thrown) mine.thrown = std::current_exception();
      return 1;
    }
  }

  /// The functions of the caller during one analysis.
  struct Watched {
    const Options& options;
    std::exception_ptr thrown;

    template <typename Function>
    int go_on(Function function) {
      try {
        return function() ? 0 : 1;
      } catch (...) {
        thrown = std::current_exception();
        return 1;
      }
    }
    static int on_progress(void* user, const uplift_progress* progress) {
      Watched& me = *static_cast<Watched*>(user);
      return me.go_on([&] { return me.options.progress(*progress); });
    }
    static int on_step(void* user, const uplift_step* s) {
      Watched& me = *static_cast<Watched*>(user);
      const std::size_t moving = s->velocity != nullptr ? s->unknowns : 0;
      return me.go_on([&] {
        return me.options.step({s->time,
                                s->number,
                                s->stage,
                                {s->displacement, s->unknowns},
                                {s->velocity, moving},
                                {s->opening, s->rows},
                                {s->force, s->rows}});
      });
    }
  };

  template <typename Analysis>
  Results analyse(Analysis analysis, const Options& options) const {
    Watched watched{options, {}};
    uplift_options given;
    uplift_options_init(&given);
    given.step_check = options.step_check ? 1 : 0;
    if (!options.fields_folder.empty()) given.fields_folder = options.fields_folder.c_str();
    if (options.progress) given.progress = Watched::on_progress;
    if (options.step) given.step = Watched::on_step;
    given.user = &watched;
    for (Connected& law : *laws_) law.thrown = nullptr;
    uplift_results* made = nullptr;
    detail::call(analysis, static_cast<const uplift_case*>(handle_.get()), static_cast<const uplift_options*>(&given), &made);
    // the model of the results refers to the laws
    const std::shared_ptr<uplift_results> owner(made, [laws = laws_](uplift_results* results) { uplift_results_free(results); });
    if (watched.thrown) std::rethrow_exception(watched.thrown);
    for (const Connected& law : *laws_)
      if (law.thrown) std::rethrow_exception(law.thrown);
    return Results(owner);
  }

  std::shared_ptr<Laws> laws_ = std::make_shared<Laws>();
  std::shared_ptr<uplift_case> handle_;
};

/// A run that is made step by step: `while (const Step* step = march.next()) ...`. The analysis waits in a thread of its own meanwhile.
class March {
 public:
  explicit March(Case each, Options options = {}) : each_(std::move(each)), options_(std::move(options)) {
    options_.step = [this](const Step& step) { return see(step); };
    thread_ = std::thread([this] { work(); });
  }
  March(const March&) = delete;
  March& operator=(const March&) = delete;
  ~March() { stop(); }

  /// The next step; null at the end. Throws what the analysis threw.
  const Step* next() {
    std::unique_lock<std::mutex> lock(mutex_);
    if (done_ || stopping_) return nullptr;
    step_ = nullptr;
    turn_ = Turn::analysis;
    changed_.notify_all();
    changed_.wait(lock, [this] { return turn_ == Turn::caller; });
    if (error_) std::rethrow_exception(error_);
    return step_;
  }
  /// Ends the run in order and returns its results up to here. Throws what the analysis threw.
  Results results() {
    stop();
    if (error_) std::rethrow_exception(error_);
    if (!results_) throw std::logic_error("the march has no step yet");
    return *results_;
  }

 private:
  enum class Turn { caller, analysis };

  void stop() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      stopping_ = true;
      turn_ = Turn::analysis;
      changed_.notify_all();
    }
    if (thread_.joinable()) thread_.join();
  }
  void work() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return turn_ == Turn::analysis; });
    if (!stopping_) {
      lock.unlock();
      try {
        auto made = std::make_unique<Results>(each_.run(options_));
        lock.lock();
        results_ = std::move(made);
      } catch (...) {
        lock.lock();
        error_ = std::current_exception();
      }
    }
    done_ = true;
    step_ = nullptr;
    turn_ = Turn::caller;
    changed_.notify_all();
  }
  bool see(const Step& step) {
    std::unique_lock<std::mutex> lock(mutex_);
    if (stopping_) return false;
    step_ = &step;
    turn_ = Turn::caller;
    changed_.notify_all();
    changed_.wait(lock, [this] { return turn_ == Turn::analysis; });
    return !stopping_;
  }

  Case each_;
  Options options_;
  std::mutex mutex_;
  std::condition_variable changed_;
  Turn turn_ = Turn::caller;
  bool stopping_ = false, done_ = false;
  const Step* step_ = nullptr;
  std::unique_ptr<Results> results_;
  std::exception_ptr error_;
  std::thread thread_;
};

/// Solves the interface problem of one step alone (the file problem_NAME.json of a failed step, or a text of one's own) by a method, or
/// by all of them with an empty name: convergence, residual, openings and forces as JSON.
inline std::string solve_problem(const std::string& problem, const std::string& method = {}) {
  return detail::text_of(uplift_problem_solve, problem.c_str(), method.empty() ? nullptr : method.c_str());
}

/// Pseudo-acceleration response spectrum [m/s2] of an acceleration [m/s2] with equal steps [s] at frequencies [Hz].
inline std::vector<double> spectrum(const std::vector<double>& acceleration, double step, double damping,
                                    const std::vector<double>& frequencies) {
  std::vector<double> psa(frequencies.size());
  detail::call(uplift_spectrum, acceleration.data(), acceleration.size(), step, damping, frequencies.data(), frequencies.size(),
               psa.data());
  return psa;
}

}  // namespace uplift

#endif
