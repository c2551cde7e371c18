#pragma once
#include <optional>

#include "uplift/cli/commands.h"
#include "uplift/session/checkpoint.h"
#include "uplift/session/session.h"

namespace uplift::cli {

/// The case of the command line. Throws InputError.
LoadedCase load(const Options& options);

/// Where results go: options.out, or out/NAME with the case's folder (for case.toml) or file name.
std::string result_path(const Options& options, const Case& read);

/// The folder of the results of a command, and what the user is told of it. From its making on, signals end the command in order.
class OutputFolder : public ResultFolder {
 public:
  OutputFolder(const Options& options, const std::string& path);
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  /// Says where the files are that were written before the command had to end.
  ~OutputFolder();
};

/// An analysis with a progress line, which signals end in order.
Control control_of(const Options& options, ResultFolder* folder);
/// Keeps checkpoints of the runs where the case asks for them. `verb`: of the command; `from`: folder of earlier ones, or empty. Throws
/// InputError as Checkpoints().
void keep_checkpoints(const LoadedCase& loaded, const std::string& verb, const ResultFolder& folder, const std::string& from,
                      std::optional<Checkpoints>& checkpoints, Control& control);
/// When the runs are over: checkpoints of complete results are removed, and what the user should know is added.
void finish_checkpoints(std::optional<Checkpoints>& checkpoints, std::vector<std::string>& warnings);
/// Writes the results, puts the folder into place and says where earlier results went.
void finish_results(const Options& options, const LoadedCase& loaded, const Results& results, ResultFolder& folder);

/// How a run is reported on one line: "completed", "failed (expected): ...".
std::string status_text(const RunResult& result);

}  // namespace uplift::cli
