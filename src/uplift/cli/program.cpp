#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>

#include "uplift/base/error.h"
#include "uplift/base/text.h"
#include "uplift/cli/commands.h"
#include "uplift/cli/console.h"
#include "uplift/cli/reduce.h"
#include "uplift/io/files.h"
#include "uplift/linear/memory.h"

// The one file that knows CLI11: declares the commands and turns errors into exit codes.
namespace {

using uplift::cli::Declared;
using uplift::cli::Options;

constexpr const char* exit_codes =
    "Exit codes: 0 success, 2 bad input, 3 numerical failure (a run failed or exceeded its limit of spurious energy, or a generated "
    "motion\n"
    "does not fit its spectrum; results are kept and marked), 4 the output could not be written (a full disk; what was written is kept),\n"
    "128 + n ended by signal n, as 130 by Ctrl-C or 143 by SIGTERM (the files contain what was computed), 1 a bug.";

struct Choices {
  Options options;
  std::string name, family, method = "lagrange", shell = "bash", document = "case";
  uplift::cli::MotionOptions motion;
  uplift::cli::StudyOptions study;
  uplift::ReduceOptions reduce;
  std::string model;                    // that gets control runs
  std::vector<double> scale{0.5, 1.5};  // of `reduce`
  std::vector<std::string> words;       // of `soil`
  int modes = 6;
  bool all = false;
};

CLI::App* add(CLI::App& app, const char* name, const char* summary, const char* examples) {
  CLI::App* command = app.add_subcommand(name, summary);
  command->footer(fmt::format("Examples:\n{}\n\n{}", examples, exit_codes));
  return command;
}

void take_case(CLI::App* command, Options& options) {
  command->add_option("case", options.file, "case file (TOML), or folder that contains case.toml")->required();
}
/// Such as that of a variable of the shell that is not set.
std::string refuse_empty(const std::string& name) {
  if (name.empty()) throw uplift::InputError({}, "--out", "a name", "an empty one");
  return {};
}
void take_output(CLI::App* command, Options& options) {
  command
      ->add_option("-o,--out", options.out, "folder for the results (default out/NAME); earlier results are moved to NAME.1, NAME.2, ...")
      ->check(refuse_empty);
  command->add_flag("-q,--quiet", options.quiet, "print errors only");
}
void take_json(CLI::App* command, Options& options) {
  command->add_flag("--json", options.json, "print the result as JSON");
}

void declare_motion(CLI::App& app, Choices& given) {
  uplift::cli::MotionOptions& motion = given.motion;
  CLI::App* command =
      add(app, "motion", "analyse ground motions (peaks, intensities, spectra), process them, or generate them for a target spectrum",
          "  uplift motion RSN8883.AT2 --damping 0.02,0.05 --frequencies rg_1_122\n"
          "  uplift motion quake.csv --unit cm/s2 --process \"baseline\" --process \"bandpass low=0.1 high=25\"\n"
          "  uplift motion --generate rg_1_60 pga=\"0.3 g_n\" duration=20 seed=7\n"
          "  uplift motion --generate eurocode_8 --generate eurocode_8 --generate \"eurocode_8 direction=vertical\" a_g=2 ground=C");
  command->add_option("words", motion.files,
                      "files of recorded motions; with --generate: parameters KEY=VALUE of the target and of the generation "
                      "(uplift describe target; uplift describe section generate)");
  command->add_option("--unit", motion.record.unit, "unit of the values if the file does not state it (g, cm/s2, m/s, ...)");
  command->add_option("--step", motion.record.step, "time step [s] of a file without times, or of the generated motion");
  command->add_option("--format", motion.record.format, "format of the file; by default it is recognised by the content");
  command->add_option("--column", motion.record.column, "name or number of the column in a table");
  command->add_option("--process", motion.process, "processing step \"NAME KEY=VALUE ...\"; can be repeated (see uplift describe process)")
      ->allow_extra_args(false)
      ->take_all();
  command
      ->add_option("--generate", motion.generate,
                   "target spectrum \"NAME KEY=VALUE ...\"; repeat it for statistically independent components")
      ->allow_extra_args(false)
      ->take_all();
  command->add_option("--damping", motion.dampings, "damping ratios of the response spectra, separated by commas")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(0.0, 0.99));
  command->add_option("--frequencies", motion.frequencies,
                      "frequencies [Hz] of the response spectra: a list separated by commas, FROM:TO:COUNT (logarithmic spacing), or "
                      "rg_1_122 (the 75 frequencies of Regulatory Guide 1.122); default 0.1:100:300");
  take_output(command, given.options);
  take_json(command, given.options);
}

void declare_study(CLI::App& app, Choices& given) {
  uplift::cli::StudyOptions& study = given.study;
  CLI::App* command =
      add(app, "study", "run one case under many motions, at many intensities, with sampled variables, and fit fragility curves",
          "  uplift study new pier        writes pier.study/plan.toml\n"
          "  uplift study check pier.study; uplift study run pier.study; uplift study report pier.study\n"
          "  uplift study tasks pier.study --count 200 | parallel --joblog log --resume-failed\n"
          "  uplift study work pier.study --shard $SLURM_ARRAY_TASK_ID/200");
  command
      ->add_option("verb", study.verb,
                   "new: write a commented plan; check: estimate runs, time, memory and disk; run: compute what is missing (again: go on), "
                   "then fit and report; "
                   "status: how far it is; fit: write study.json and fits.csv; report: write report.html as well; export: write runs.csv "
                   "and curves.csv; tasks: a command line for "
                   "every shard; work: compute one shard; index: make study.db again from the parts")
      ->required()
      ->check([](const std::string& verb) {  // before CLI11 would report that the folder is missing
        uplift::cli::check_study_verb(verb);
        return std::string();
      });
  command->add_option("study", given.options.file, "folder of the study, with plan.toml; of `new` its name")->required();
  command->add_option("-j,--workers", study.workers, "processes at the same time; default: as in the plan, else one for every core")
      ->check(CLI::Range(1, 4096));
  command->add_option("--shard", study.shard, "of `work`: the share K/N of the curves");
  command->add_option("--count", study.count, "of `tasks`: the number of shards")->check(CLI::Range(1, 1000000));
  command->add_option("--run", study.run, "of `export`: write the case of this run alone, by the beginning of its identity in runs.csv");
  command->add_flag("--retry", study.retry, "of `run` and `work`: also compute again what failed or ran out of time or memory");
  command->add_flag("-q,--quiet", given.options.quiet, "print errors only");
  take_json(command, given.options);
}

void declare(CLI::App& app, Choices& given) {
  Options& options = given.options;
  CLI::App* command = add(app, "new", "write a commented case as a starting point", "  uplift new tower          writes tower/case.toml");
  command->add_option("name", given.name, "folder to create")->required();

  command = add(app, "check", "validate a case and print what a run would compute",
                "  uplift check tower/case.toml\n  uplift check examples/01_oscillator --json");
  take_case(command, options);
  take_json(command, options);

  command =
      add(app, "run", "run a case and, for comparison, the same model with a bonded base",
          "  uplift run tower/case.toml\n  uplift run tower --out results/tower --quiet\n  uplift run tower --json | python3 -m json.tool");
  take_case(command, options);
  take_output(command, options);
  command->add_flag("--no-step-check", options.no_step_check, "do not run the case with twice the step to estimate the error of the step");
  take_json(command, options);

  command = add(app, "resume", "go on with a run of a case with [output] checkpoint that was interrupted or killed",
                "  uplift resume out/tower\n  uplift resume out/tower --out out/tower_complete");
  command->add_option("results", options.file, "folder of the results of the run, as it was given to `uplift run`")->required();
  take_output(command, options);
  take_json(command, options);

  command = add(app, "compare", "run all variants of a case and compare them", "  uplift compare examples/01_oscillator/case.toml");
  take_case(command, options);
  take_output(command, options);
  take_json(command, options);

  command = add(app, "trust",
                "estimate the reliability of the results: repeat a run with half the step, other stiffness, tolerance, method and mesh",
                "  uplift trust tower/case.toml\n  uplift trust examples/05_bridge_pier --json");
  take_case(command, options);
  take_output(command, options);
  take_json(command, options);

  command = add(app, "reduce", "make a reduced model of a case, with which runs of the case take a fraction of the time",
                "  uplift reduce tower --controls 19\n  uplift reduce tower --size 120 --out tower/coarse.rom\n"
                "  uplift reduce tower --model tower/coarse.rom --controls 59 --out tower/coarse.rom\n"
                "Then reduced_model = \"tower.rom\" in the case file makes its runs use it.");
  take_case(command, options);
  command
      ->add_option("-o,--out", options.out, "the file (default NAME.rom beside the case file); an earlier one is moved to NAME.rom.1, ...")
      ->check(refuse_empty);
  CLI::Option* model = command->add_option(
      "--model", given.model, "a reduced model of the same structure: control runs are made for it (--controls) instead of a new one");
  command->add_option("-f,--frequency", given.reduce.frequency, "motions up to about this frequency [Hz] are represented (default 25)")
      ->check(CLI::Range(0.01, 1e4))
      ->excludes(model);
  command->add_option("--size", given.reduce.size, "number of coordinates; default: as many as the target asks for")
      ->check(CLI::Range(1, 400))
      ->excludes(model);
  command->add_option("--target", given.reduce.target, "largest transfer error where --size is not given (default 0.0002)")
      ->check(CLI::Range(1e-9, 0.5))
      ->excludes(model);
  CLI::Option* controls =
      command
          ->add_option("--controls", given.reduce.controls,
                       "control runs, full and reduced, that state the error (59: 95 % of all runs with 95 % confidence)")
          ->check(CLI::Range(0, 10000));
  model->needs(controls);
  command
      ->add_option("--scale", given.scale,
                   "FROM,TO: the motions of the control runs are multiplied by factors between these (default 0.5,1.5)")
      ->delimiter(',')
      ->expected(2)
      ->check(CLI::Range(0.0, 1e6));
  command->add_option("--seed", given.reduce.seed, "of the random numbers of the control runs (default 1)");
  command->add_flag("-q,--quiet", options.quiet, "print errors only");

  command = add(app, "modes", "compute natural frequencies and mode shapes, with the base bonded and with the base free",
                "  uplift modes tower\n  uplift modes tower --count 10 --json");
  take_case(command, options);
  command->add_option("-n,--count", given.modes, "number of modes")->check(CLI::Range(1, 1000));
  take_json(command, options);

  command = add(app, "soil", "stiffness and radiation damping of the ground under a rigid footing, from published formulas",
                "  uplift soil width=\"12 m\" length=\"8 m\" G=\"80 MPa\" poisson=0.3 density=\"1900 kg/m3\"\n"
                "  uplift soil shape=disc width=\"40 m\" shear_wave_velocity=600 poisson=0.35 density=2100 embedment=5\n"
                "  uplift soil tower/case.toml");
  command
      ->add_option("words", given.words,
                   "KEY=VALUE words: shape, width, length and the keys of uplift describe section foundation.soil; or a case with "
                   "[foundation.soil]")
      ->required();
  take_json(command, options);

  command = add(app, "describe", "print equations, parameters, units and sources of every part, and the tables of a case file",
                "  uplift describe\n  uplift describe law\n  uplift describe law sdm\n  uplift describe sdm\n  uplift describe section "
                "interface.footing");
  command->add_option(
      "family", given.family,
      "law, foundation, bulk_law, element, method, impact, scheme, function, record, process, target, study_method, distribution, solver, "
      "section or quantity; or the name of a part, table or quantity alone");
  command->add_option("name", given.name, "name of the part or table");

  command = add(app, "schema", "print the JSON Schema of the case file or of a results document",
                "  uplift schema > case.schema.json\n  uplift schema results > summary.schema.json");
  command->add_option(
      "document", given.document,
      "case (default), results (summary.json), trust (trust.json), study (study.json) or motion (summary.json of uplift motion)");

  command = add(app, "replay", "solve a stored interface problem alone, with any method",
                "  uplift replay out/tower/problem_run.json --method lagrange\n  uplift replay out/tower/problem_run.json --all");
  command->add_option("file", options.file, "file problem_*.json, which a run writes when a step fails")->required();
  command->add_option("-m,--method", given.method, "contact method, see uplift describe method");
  command->add_flag("--all", given.all, "compare all methods");
  take_json(command, options);

  declare_motion(app, given);
  declare_study(app, given);

  command = add(app, "completion", "print a completion script for the shell",
                "  source <(uplift completion bash)\n  source <(uplift completion zsh)");
  command->add_option("shell", given.shell, "bash or zsh");
}

std::vector<Declared> declared(const CLI::App& app) {
  std::vector<Declared> all;
  for (const CLI::App* command : app.get_subcommands({})) {
    Declared one{command->get_name(), command->get_description(), {}, false};
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option->get_lnames()) one.options.emplace_back("--" + name, option->get_description());
      one.takes_file = one.takes_file || option->get_positional();
    }
    all.push_back(std::move(one));
  }
  return all;
}

int dispatch(const CLI::App& app, const Choices& given) {
  using namespace uplift;
  const std::string name = app.get_subcommands().front()->get_name();
  if (name == "new") return cli::new_case(given.name);
  if (name == "check") return cli::check(given.options);
  if (name == "run") return cli::run(given.options);
  if (name == "resume") return cli::resume(given.options);
  if (name == "compare") return cli::compare(given.options);
  if (name == "trust") return cli::trust(given.options);
  if (name == "reduce") {
    ReduceOptions wanted = given.reduce;
    wanted.least_scale = given.scale.front(), wanted.most_scale = given.scale.back();
    return cli::reduce(given.options, given.model, wanted);
  }
  if (name == "modes") return cli::modes(given.options, given.modes);
  if (name == "soil") return cli::soil(given.options, given.words);
  if (name == "describe") return cli::describe(given.family, given.name);
  if (name == "schema") return cli::schema(given.document);
  if (name == "motion") return cli::motion(given.options, given.motion);
  if (name == "study") return cli::study(given.options, given.study);
  if (name == "replay") return cli::replay(given.options, given.method, given.all);
  return cli::completion(given.shell, declared(app));
}

/// A word of the command line as it can be typed again: in quotes when it contains a blank.
std::string as_typed(const std::string& word) {
  return word.find(' ') == std::string::npos ? word : fmt::format("\"{}\"", word);
}

/// Reports an unknown command by its name; CLI11 would only report that a command is missing.
void check_command(const CLI::App& app, const std::string& word) {
  if (word.empty() || word.front() == '-') return;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  if (std::ranges::find(names, word) != names.end()) return;
  throw uplift::InputError({"uplift", 0}, "", fmt::format("a command: {}", fmt::join(names, ", ")), uplift::in_quotes(word),
                           uplift::nearest_name(word, names));
}

/// Reports an unknown option with the nearest one; CLI11 would name neither the place nor what was perhaps meant.
void check_options(const CLI::App& command, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    const std::string option = word.substr(0, word.find('='));
    if (option.size() < 2 || option.front() != '-' || command.get_option_no_throw(option) != nullptr) continue;
    std::vector<std::string> names;
    for (const CLI::Option* each : command.get_options())
      for (const std::string& name : each->get_lnames()) names.push_back("--" + name);
    throw uplift::InputError({"uplift " + command.get_name(), 0}, "", "one of its options (--help lists them)", uplift::in_quotes(option),
                             uplift::nearest_name(option, names));
  }
}

/// Parses the command line and runs the command; its exceptions are reported below. `name`: of the program, for the report.
int parse_and_run(int count, char** words, const std::string& name) {
  CLI::App app{"uplift: analysis of the uplift of foundations in earthquakes and of its consequences for the structure", name};
  app.require_subcommand(1);
  app.set_version_flag("--version", UPLIFT_VERSION);
  app.footer(
      fmt::format("Examples:\n  uplift new tower; uplift check tower; uplift run tower\n  uplift compare "
                  "examples/01_oscillator/case.toml\n  uplift run --help\n\n{}",
                  exit_codes));
  Choices given;
  declare(app, given);
  given.options.command = name;
  for (int i = 1; i < count; ++i) given.options.command += " " + as_typed(words[i]);
  check_command(app, count > 1 ? words[1] : "");
  try {
    app.parse(count, words);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError) && count > 2)
      check_options(*app.get_subcommand(words[1]), {words + 2, words + count});
    std::ostringstream text, complaint;
    const int code = app.exit(error, text, complaint);
    uplift::cli::print_text(text.str());
    constexpr std::size_t most = 600;  // an argument may be of any length
    std::string line = complaint.str();
    if (line.size() > most) line = line.substr(0, most) + "...";
    while (line.ends_with('\n')) line.pop_back();
    if (!line.empty()) uplift::cli::complain(line);
    return code == 0 ? uplift::cli::Exit::done : uplift::cli::Exit::bad_input;
  }
  return dispatch(app, given);
}

int output_failed(const std::string& message) {
  uplift::cli::complain("error: " + message);
  return uplift::cli::interrupt_asked() ? uplift::cli::interrupt_exit_code() : uplift::cli::Exit::output_error;
}

}  // namespace

namespace uplift::cli {

int program(int count, char** words, const std::string& name) {
  prepare_heap();
  try {
    const int code = parse_and_run(count, words, name);
    finish_output();
    return code;
  } catch (const InputError& error) {
    complain(fmt::format("error: {}", error.what()));
    return Exit::bad_input;
  } catch (const OutputError& error) {
    return output_failed(error.what());
  } catch (const std::bad_alloc&) {
    complain("error: not enough memory. Coarsen the mesh, reduce the model, or use a machine with more memory.");
    return Exit::numerical_failure;
  } catch (const std::exception& error) {
    complain(fmt::format("internal error: {}", error.what()));
    return Exit::internal_error;
  }
}

}  // namespace uplift::cli
