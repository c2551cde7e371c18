#include "uplift/cli/load.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <filesystem>
#include <future>

#include "uplift/base/file.h"
#include "uplift/case/decided.h"
#include "uplift/cli/console.h"
#include "uplift/io/fields/run.h"
#include "uplift/io/mesh/file.h"
#include "uplift/io/report/motions.h"
#include "uplift/io/results/floors.h"
#include "uplift/io/results/histories.h"
#include "uplift/io/text/toml.h"

namespace uplift::cli {
namespace fs = std::filesystem;

MeshReader mesh_reader() {
  return [](const std::string& path, const Where& where, const std::string& name) { return read_mesh(path, where, name); };
}

Loaded load(const Options& options) {
  std::string file = options.file;
  std::error_code error;
  if (fs::is_directory(file, error) && fs::exists(fs::path(file) / "case.toml", error)) file = (fs::path(file) / "case.toml").string();
  Loaded loaded;
  loaded.raw = read_toml_file(file);
  loaded.read = check_case(loaded.raw, file, mesh_reader());
  Provenance& from = loaded.from;
  from.title = loaded.read.values.text("title");
  if (loaded.read.values.has("description")) from.subtitle = loaded.read.values.text("description");
  from.command = options.command;
  from.version = UPLIFT_VERSION;
#if defined(__clang__)
  from.built_with = "Clang " __clang_version__;
#else
  from.built_with = "GCC " __VERSION__;
#endif
  from.created = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  from.case_file = file;
  from.case_hash = sha256(read_file(file));
  for (const std::string& input : input_files(loaded.read)) from.inputs.emplace_back(input, sha256(read_file(input)));
  from.resolved = to_toml(loaded.read.values, decided_texts(loaded.read));
  return loaded;
}

std::string result_path(const Options& options, const Case& read) {
  if (!options.out.empty()) return options.out;
  const fs::path file = fs::absolute(read.file).lexically_normal();
  const std::string name = file.filename() == "case.toml" ? file.parent_path().filename().string() : file.stem().string();
  return (fs::path("out") / name).string();
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

RunResult run_one(const BuiltCase& built, const std::string& label, const Options& options) {
  ProgressLine line(label, options.quiet || options.json);
  return uplift::run(built.model, built.plan, built.behaviours, [&line](const Progress& progress) { return line(progress); });
}

void forget_matrices(BuiltCase& built) {
  Model& model = built.model;
  for (Sparse* matrix : {&model.stiffness, &model.mass, &model.damping}) Sparse().swap(*matrix);  // an assignment would keep the memory
  built.plan.rest.reset();
}

RunResult run_with_fields(const Loaded& loaded, const BuiltCase& built, const std::string& label, const Options& options,
                          ResultFolder& folder, std::vector<std::string>& lists) {
  if (!loaded.read.values.table("output").has("fields")) return run_one(built, label, options);
  FieldRun fields(loaded.read, built, folder);
  ProgressLine line(label, options.quiet || options.json);
  RunResult result = uplift::run(
      built.model, built.plan, built.behaviours, [&line](const Progress& progress) { return line(progress); },
      [&fields](const Snapshot& snapshot) { fields.see(snapshot); });
  fields.finish(result);
  lists.push_back(fields.list());
  return result;
}

void write_results(const Options& options, const Loaded& loaded, const Results& results, const ComparisonSummary* compared,
                   ResultFolder& folder) {
  ReportInput input{&loaded.read, &loaded.from, &results.verdict, {}, compared, results.warnings, &results.floors, results.trust};
  // Beside the report, which takes as long: half of the time of a small run goes into its files. After it where there is no second thread.
  std::future<void> histories = std::async(std::launch::async | std::launch::deferred, [&] {
    for (std::size_t i = 0; i < (compared ? results.runs.size() : 1); ++i) {
      const RunResult& run = results.runs[i];
      const RunPlan& plan = results.built[i].plan;
      const auto file = [&](const std::string& name) { return name + (compared ? "/" + run.name : "") + ".csv"; };
      folder.write(file("histories"), histories_csv(run, statics_alone(plan) ? load_factor_column : time_column));
      if (!run.load_steps.empty()) folder.write(file("load_steps"), load_steps_csv(run, plan.requests));
    }
  });
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    const RunResult& run = results.runs[i];
    input.runs.push_back({&results.specs[i], &results.built[i], &run});
    if (!run.problem.empty()) folder.write("problem_" + run.name + ".json", run.problem);
  }
  if (results.floors.any()) folder.write("floor_spectra.csv", floor_spectra_csv(results.runs, results.floors));
  folder.write("summary.json", summary_json({loaded.from, results.runs, results.verdict, motions_of(input.runs), compared, &results.floors,
                                             results.built.empty() ? nullptr : &results.built.front()}));
  folder.write("case.resolved.toml", loaded.from.resolved);
  const std::string page = report_page(report_json(input));
  if (!page.empty())
    folder.write("report.html", page);
  else if (!options.quiet)
    complain("note: this program was built without the report's page (web/dist/report.html): no report.html is written");
  histories.get();
  const std::string moved = folder.finish();
  if (!moved.empty() && !options.quiet && !options.json) say("earlier results moved to " + moved + "/");
}

}  // namespace uplift::cli
