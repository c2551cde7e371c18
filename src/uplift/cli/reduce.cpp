#include "uplift/cli/reduce.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "uplift/base/file.h"
#include "uplift/cli/console.h"
#include "uplift/cli/load.h"

namespace uplift::cli {
namespace fs = std::filesystem;

namespace {

/// What stood at a path goes to PATH.1, PATH.2, ...; returns where, empty where nothing stood there.
std::string move_away(const std::string& path) {
  if (!fs::exists(path)) return {};
  int number = 1;
  while (fs::exists(fmt::format("{}.{}", path, number))) ++number;
  const std::string to = fmt::format("{}.{}", path, number);
  fs::rename(path, to);
  return to;
}

void write(const Options& options, const std::string& path, const ReducedModel& reduced) {
  try {
    if (const fs::path folder = fs::path(path).parent_path(); !folder.empty()) fs::create_directories(folder);
    const std::string text = write_reduced_model(reduced), moved = move_away(path);
    write_file_durably(path, text);
    if (!moved.empty() && !options.quiet) say(fmt::format("the earlier file was moved to {}", moved));
  } catch (const fs::filesystem_error& problem) {
    throw OutputError(fmt::format("{}: {}", path, problem.code().message()));
  }
}

}  // namespace

int reduce(const Options& options, const std::string& model, const ReduceOptions& asked) {
  ReduceOptions wanted = asked;
  if (!(wanted.least_scale <= wanted.most_scale))
    throw InputError({"uplift reduce", 0}, "--scale", "the smaller factor before the larger one",
                     fmt::format("{:g},{:g}", wanted.least_scale, wanted.most_scale));
  if (!model.empty()) wanted.model = std::make_shared<const ReducedModel>(read_reduced_model_file(model, {"uplift reduce", 0}, "--model"));
  catch_interrupts();
  const LoadedCase loaded = load(options);
  const fs::path results = default_result_path(loaded.read);
  const std::string path =
      options.out.empty() ? (fs::path(loaded.read.file).parent_path() / results.filename()).string() + ".rom" : options.out;
  const std::optional<ReducedModel> reduced = reduce_case(loaded, wanted, control_of(options, nullptr));
  if (!reduced) {
    if (!options.quiet) complain(interrupt_text() + ": no reduced model was written");
    return interrupt_exit_code();
  }
  write(options, path, *reduced);
  if (interrupt_asked() && !options.quiet)
    complain(fmt::format("{}: {} of {} control runs were made; uplift reduce --model {} makes others", interrupt_text(),
                         reduced->controls ? reduced->controls->runs : 0, wanted.controls, path));
  if (options.quiet) return interrupt_asked() ? interrupt_exit_code() : Exit::done;
  say(fmt::format("{} coordinates for {} unknowns, up to {:g} Hz, transfer error {:.1e}", reduced->vectors.cols(), reduced->vectors.rows(),
                  reduced->frequency, reduced->transfer_error));
  if (!wanted.model && wanted.size == 0 && reduced->transfer_error > wanted.target)
    say(fmt::format(
        "The target of {:g} is not reached with all the coordinates that a basis gets. Control runs (--controls) state what that "
        "costs; a lower frequency (--frequency) or fewer points of the interface need fewer coordinates.",
        wanted.target));
  if (const auto& errors = reduced->controls) {
    print_table({{"largest error of", "over the control runs"},
                 {"largest opening", fmt::format("{:.2g} %", 100 * errors->opening)},
                 {"largest base moment", fmt::format("{:.2g} %", 100 * errors->moment)},
                 {"openings over time", fmt::format("{:.2g} %", 100 * errors->history)},
                 {"slips over time", errors->slip > 0 ? fmt::format("{:.2g} %", 100 * errors->slip) : "nothing slips"},
                 {"floor spectra", errors->floor_spectrum > 0 ? fmt::format("{:.2g} %", 100 * errors->floor_spectrum) : "none asked for"}});
    say(errors->statement());
  } else {
    say("no control runs: the error of runs with it is not known (--controls)");
  }
  say(fmt::format("written to {}; a case uses it with reduced_model = \"{}\"", path, fs::path(path).filename().string()));
  return interrupt_asked() ? interrupt_exit_code() : Exit::done;
}

}  // namespace uplift::cli
