#pragma once
#include <deque>

#include "uplift/case/case.h"
#include "uplift/cli/commands.h"
#include "uplift/io/files.h"
#include "uplift/io/report/report.h"

namespace uplift::cli {

/// A case file, read and checked, with where it comes from.
struct Loaded {
  Raw raw;  // the file as it stands
  Case read;
  Provenance from;
};
/// `options.file` may be a folder with a case.toml. Throws InputError.
Loaded load(const Options& options);
/// Reads meshes of files.
MeshReader mesh_reader();

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

/// Everything that a command computed, ready to be written.
struct Results {
  std::vector<RunSpec> specs;
  std::deque<BuiltCase> built;
  std::vector<RunResult> runs;
  FloorAnswers floors;  // of the runs
  Verdict verdict;
  std::vector<std::string> warnings;
  const TrustAnswer* trust = nullptr;  // of `uplift trust`
};
/// Writes report, histories, summary, resolved case and problem files and puts the folder into place; says where earlier results went.
void write_results(const Options& options, const Loaded& loaded, const Results& results, const ComparisonSummary* compared,
                   ResultFolder& folder);

/// Gives back the matrices of a model whose run is over: results are written without them.
void forget_matrices(BuiltCase& built);

/// Runs one spec of a case with the progress line.
RunResult run_one(const BuiltCase& built, const std::string& label, const Options& options);
/// The same; writes its fields, when the case asks for them, and adds the name of their list to `lists`.
RunResult run_with_fields(const Loaded& loaded, const BuiltCase& built, const std::string& label, const Options& options,
                          ResultFolder& folder, std::vector<std::string>& lists);

/// How a run is reported on one line: "completed", "failed (expected): ...".
std::string status_text(const RunResult& result);

}  // namespace uplift::cli
