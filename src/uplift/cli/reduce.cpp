#include "uplift/cli/reduce.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <utility>

#include "uplift/base/file.h"
#include "uplift/cli/console.h"
#include "uplift/cli/load.h"

namespace uplift::cli {
namespace fs = std::filesystem;

namespace {

/// What stood at a path goes to PATH.1, PATH.2, ...
void move_away(const std::string& path, bool quiet) {
  if (!fs::exists(path)) return;
  int number = 1;
  while (fs::exists(fmt::format("{}.{}", path, number))) ++number;
  const std::string to = fmt::format("{}.{}", path, number);
  fs::rename(path, to);
  if (!quiet) say(fmt::format("the earlier file was moved to {}", to));
}

/// Where a reduced model is written, which may be done twice: before the control runs and after them.
class ModelFile {
 public:
  /// What cannot be written there is told before anything is computed.
  ModelFile(std::string path, bool quiet) : path_(std::move(path)), quiet_(quiet) {
    if (fs::exists(path_) && !fs::is_regular_file(path_)) throw OutputError(path_ + ": this is not a file that can be replaced");
  }
  const std::string& path() const { return path_; }
  void write(const ReducedModel& reduced) {
    try {
      if (const fs::path folder = fs::path(path_).parent_path(); !folder.empty()) fs::create_directories(folder);
      const std::string text = write_reduced_model(reduced);
      if (!std::exchange(written_, true)) move_away(path_, quiet_);
      write_file_durably(path_, text);
    } catch (const fs::filesystem_error& problem) {
      throw OutputError(fmt::format("{}: {}", path_, problem.code().message()));
    }
  }

 private:
  const std::string path_;
  const bool quiet_;
  bool written_ = false;
};

void print_errors(const ControlErrors& errors) {
  print_table({{"largest error of", "over the control runs"},
               {"largest opening", fmt::format("{:.2g} %", 100 * errors.opening)},
               {"largest base moment", fmt::format("{:.2g} %", 100 * errors.moment)},
               {"openings over time", fmt::format("{:.2g} %", 100 * errors.history)},
               {"slips over time", errors.slip > 0 ? fmt::format("{:.2g} %", 100 * errors.slip) : "nothing slips"},
               {"floor spectra", errors.floor_spectrum > 0 ? fmt::format("{:.2g} %", 100 * errors.floor_spectrum) : "none asked for"}});
  say(errors.statement());
}

/// `chosen`: the number of coordinates followed from the target.
void print(const ReducedModel& reduced, double target, bool chosen, const std::string& path) {
  say(fmt::format("{} coordinates for {} unknowns, up to {:g} Hz, transfer error {:.1e}", reduced.vectors.cols(), reduced.vectors.rows(),
                  reduced.frequency, reduced.transfer_error));
  if (chosen && reduced.transfer_error > target)
    say(fmt::format(
        "The target of {:g} is not reached with all the coordinates that a basis gets. Control runs (--controls) state what that "
        "costs; a lower frequency (--frequency) or fewer points of the interface need fewer coordinates.",
        target));
  if (reduced.controls)
    print_errors(*reduced.controls);
  else
    say("no control runs: the error of runs with it is not known (--controls)");
  say(fmt::format("written to {}; a case uses it with reduced_model = \"{}\"", path, fs::path(path).filename().string()));
}

}  // namespace

int reduce(const Options& options, const std::string& model, const ReduceOptions& asked) {
  const Where words{"uplift reduce", 0};
  if (!(asked.least_scale <= asked.most_scale))
    throw InputError(words, "--scale", "the smaller factor before the larger one",
                     fmt::format("{:g},{:g}", asked.least_scale, asked.most_scale));
  if (!model.empty() && asked.controls < 1) throw InputError(words, "--controls", "at least one run for --model", "0");
  ReduceOptions wanted = asked;
  if (!model.empty()) wanted.model = std::make_shared<const ReducedModel>(read_reduced_model_file(model, words, "--model"));
  catch_interrupts();
  const LoadedCase loaded = load(options);
  const fs::path results = default_result_path(loaded.read);
  ModelFile file(options.out.empty() ? (fs::path(loaded.read.file).parent_path() / results.filename()).string() + ".rom" : options.out,
                 options.quiet);
  if (!wanted.model) {
    wanted.controls = 0;
    std::optional<ReducedModel> made = reduce_case(loaded, wanted, control_of(options, nullptr));
    if (!made) {
      if (!options.quiet) complain(interrupt_text() + ": no reduced model was written");
      return interrupt_exit_code();
    }
    file.write(*made);  // the control runs take long, and may be ended by anything
    wanted.model = std::make_shared<const ReducedModel>(std::move(*made));
  }
  std::shared_ptr<const ReducedModel> reduced = wanted.model;
  if (asked.controls > 0) {
    wanted.controls = asked.controls;
    std::optional<ReducedModel> stated = reduce_case(loaded, wanted, control_of(options, nullptr));
    file.write(*stated);
    reduced = std::make_shared<const ReducedModel>(std::move(*stated));
  }
  if (interrupt_asked() && !options.quiet)
    complain(fmt::format("{}: {} states {} control runs; uplift reduce {} --model {} --controls {} makes all of them", interrupt_text(),
                         file.path(), reduced->controls ? reduced->controls->runs : 0, in_shell(options.file), in_shell(file.path()),
                         asked.controls));
  if (!options.quiet) print(*reduced, asked.target, model.empty() && asked.size == 0, file.path());
  return interrupt_asked() ? interrupt_exit_code() : Exit::done;
}

}  // namespace uplift::cli
