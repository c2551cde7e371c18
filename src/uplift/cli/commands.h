#pragma once
#include <string>
#include <vector>

#include "uplift/motion/formats/read.h"

// The commands of the program: one function and one file each. program.cpp declares their options and calls them.
namespace uplift::cli {

/// Exit codes, as documented by `uplift --help`.
/// A command that a signal ended returns 128 + the number of the signal instead.
enum Exit { done = 0, internal_error = 1, bad_input = 2, numerical_failure = 3, output_error = 4 };

/// The whole program on a command line; its exit code. Errors are reported on standard error. `name`: what it is called in reports.
int program(int count, char** words, const std::string& name);

struct Options {
  std::string file;            // case file, or stored problem
  std::string out;             // folder of the results; empty: out/NAME
  bool json = false;           // for machines
  bool quiet = false;          // nothing but errors
  bool no_step_check = false;  // `run`: without the companion with twice the step
  std::string command;         // the command line, for the report
};

int new_case(const std::string& name);
int check(const Options& options);
int run(const Options& options);
/// Goes on with a run that was interrupted; options.file is the folder of its results.
int resume(const Options& options);
int compare(const Options& options);
/// The same from earlier checkpoints; `from`: their folder, empty: from the beginning.
int compare_from(const Options& options, const std::string& from);
/// Repeats the run with every choice of the computation changed.
int trust(const Options& options);
int modes(const Options& options, int count);
/// `family` and `name` may be empty: lists.
int describe(const std::string& family, const std::string& name);
/// The JSON Schema of a document: "case", "results" (summary.json), "trust" (trust.json), "study" (study.json) or "motion" (summary.json of
/// `motion`).
int schema(const std::string& document);
/// Stiffness and dashpots of the ground under a footing: of KEY=VALUE words, or of the foundations of a case.
int soil(const Options& options, const std::vector<std::string>& words);
int replay(const Options& options, const std::string& method, bool all);

struct MotionOptions {
  std::vector<std::string> files;                 // of records; with `generate` KEY=VALUE words
  std::vector<std::string> generate;              // "TARGET KEY=VALUE ...", one for each component
  std::vector<std::string> process;               // "STEP KEY=VALUE ...", in order
  std::vector<double> dampings{0.05, 0.02, 0.1};  // of the spectra
  std::string frequencies = "0.1:100:300";        // of the spectra: a list, FROM:TO:COUNT or rg_1_122
  RecordOptions record;
};
int motion(const Options& options, const MotionOptions& given);

struct StudyOptions {
  std::string verb;        // new, check, run, status, fit, report, export, tasks, work or index
  std::string shard, run;  // of `work`: "17/200"; of `export`: the beginning of an identity
  int workers = 0;         // 0: as in the plan
  int count = 100;         // of `tasks`
  bool retry = false;      // of `run` and `work`
};
/// options.file: the folder of the study.
int study(const Options& options, const StudyOptions& given);
/// InputError with the nearest verb for one that is none.
void check_study_verb(const std::string& verb);

/// A command as it was declared, for completion.
struct Declared {
  std::string name, summary;
  std::vector<std::pair<std::string, std::string>> options;  // "--json", what it does
  bool takes_file = false;
};
/// Prints a completion script for `shell` ("bash" or "zsh").
int completion(const std::string& shell, const std::vector<Declared>& commands);

}  // namespace uplift::cli
