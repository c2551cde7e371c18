#include "uplift/cli/load.h"

#include <fmt/format.h>

#include "uplift/case/schema/case_input.h"
#include "uplift/cli/console.h"

namespace uplift::cli {

LoadedCase load(const Options& options) {
  return load_case(options.file, options.command);
}

std::string result_path(const Options& options, const Case& read) {
  return options.out.empty() ? default_result_path(read) : options.out;
}

namespace {

/// Signals are caught before there is a folder that they could leave behind.
const std::string& with_signals_caught(const std::string& path) {
  catch_interrupts();
  return path;
}

}  // namespace

OutputFolder::OutputFolder(const Options& options, const std::string& path) : ResultFolder(with_signals_caught(path)) {
  if (options.quiet) return;
  for (const std::string& folder : abandoned())
    complain(fmt::format("note: {}/ holds the files of a command that was killed; delete it when it is not needed", folder));
}

OutputFolder::~OutputFolder() {
  if (!finished() && has_files())
    complain(fmt::format("the results are not complete; the files that were written are in {}/", working_path()));
}

std::string status_text(const RunResult& result) {
  std::string text(to_string(result.status));
  if (result.expected_to_fail && result.status == RunStatus::failed) text += " (expected)";
  return text;
}

Control control_of(const Options& options, ResultFolder* folder) {
  Control control;
  const bool silent = options.quiet || options.json;
  control.watch = [silent](const std::string& label) -> Watch {
    return [line = std::make_shared<ProgressLine>(label, silent)](const Progress& progress) { return (*line)(progress); };
  };
  control.stopped = interrupt_asked;
  control.folder = folder;
  control.step_check = !options.no_step_check;
  return control;
}

void keep_checkpoints(const LoadedCase& loaded, const std::string& verb, const ResultFolder& folder, const std::string& from,
                      std::optional<Checkpoints>& checkpoints, Control& control) {
  const std::optional<double>& every = loaded.read.input->output.checkpoint;
  if (!every) return;
  checkpoints.emplace(origin_of(loaded, verb, control.step_check), *every, folder, from);
  control.checkpoints = &*checkpoints;
}

void finish_checkpoints(std::optional<Checkpoints>& checkpoints, std::vector<std::string>& warnings) {
  if (!checkpoints) return;
  if (!interrupt_asked()) checkpoints->remove();
  for (std::string& note : checkpoints->notes()) warnings.push_back(std::move(note));
}

void finish_results(const Options& options, const LoadedCase& loaded, const Results& results, ResultFolder& folder) {
  if (!write_results(loaded, results, folder) && !options.quiet)
    complain("note: this program was built without the report's page (web/dist/report.html): no report.html is written");
  const std::string moved = folder.finish();
  if (!moved.empty() && !options.quiet && !options.json) say("earlier results moved to " + moved + "/");
}

}  // namespace uplift::cli
