#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "uplift/base/error.h"
#include "uplift/base/file.h"
#include "uplift/base/text.h"
#include "uplift/case/build/records.h"
#include "uplift/cli/console.h"
#include "uplift/cli/study.h"
#include "uplift/io/files.h"
#include "uplift/session/load.h"

namespace uplift::cli {
namespace {

constexpr const char* study_template =
    R"TOML(# A study for uplift: one case under many motions, at many intensities. `uplift describe section study` explains every key.
#     uplift study check {0}; uplift study run {0}; uplift study report {0}
# Files are relative to this plan. Numbers may carry units; a bare number is SI.
case = {1}
seed = 1                              # of the samples of [[variable]]

[intensity]                           # every intensity below and in the results is in `unit`
measure = "pga"                       # or pgv, factor, or sa with a period: measure = "sa", period = "0.5 s", damping = 0.05
unit = "g_n"

[method]                              # or type = "stripes", levels = [0.2, 0.4, 0.8]; "cloud"; "truncated_ida"
type = "ida"                          # the capacity of every motion is searched
start = 0.2
largest = 3

[[motions]]                           # generated for a target spectrum; or files = ["a.at2", "b.at2"] instead of count and generate
name = "m"
replace = [{2}]                   # the record or function of the case that they take the place of
count = 20
generate = [{3}]

[[limit]]                             # a limit state; runs that overturn or separate exceed every one
name = "uplift of 30 mm"
quantity = "max_opening"              # numbers of the verdict: `uplift describe quantity`
limit = "30 mm"
source = "judgement"

# ---- what the site asks for ----
#
# [design]                            # probabilities at the design motion and at 1.5 times it (ASCE/SEI 43)
# intensity = 0.3
#
# [hazard]                            # annual rate with which each limit is exceeded
# intensities = [0.1, 0.3, 1.0]
# rates = [2e-3, 2e-4, 5e-6]          # a year
#
# [[factor]]                          # a factor of safety that the runs do not vary: capacity and HCLPF of every limit
# name = "strength of the anchors"
# median = 1.2
# beta_u = 0.15

# ---- uncertain numbers of the case: a Latin hypercube ----

# samples = 20                        # at the top of this file
#
# [[variable]]
# name = "soil stiffness"
# paths = ["interface[0].law.K_n"]
# distribution = {{ type = "lognormal", median = 1, beta = 0.4 }}    # a factor on the case's value

[run]
timeout = "10 min"                    # of one run
)TOML";

constexpr const char* generated = R"({ target = { type = "rg_1_60", pga = "0.3 g_n" }, duration = 20, seed = 1 })";

/// The functions and records that drive a case, each once; one called "quake" where no ground acceleration, prescribed motion or
/// incident wave has one, or there is no case that can be read.
std::vector<std::string> driving(const std::filesystem::path& case_file) {
  std::vector<std::string> names;
  try {
    for (const DrivenBy& each : motions_wanted(load_case(case_file.string(), "study new").read))
      if (std::ranges::find(names, each.function.name) == names.end()) names.push_back(each.function.name);
  } catch (const InputError&) {
    names.clear();  // `study check` says what is wrong with it
  }
  return names.empty() ? std::vector<std::string>{"quake"} : names;
}

}  // namespace

int new_study(const std::string& name) {
  namespace fs = std::filesystem;
  const fs::path whole(name), given = whole.has_filename() ? whole : whole.parent_path();  // a shell completes tower/
  if (given.filename().empty() || given.stem() == "." || given.stem() == "..")
    throw InputError({name, 0}, "", "the name of a new study", in_quotes(name));
  const bool of_file = given.extension() == ".toml";  // tower.toml: the study of this case, as tower: that of tower/case.toml
  const fs::path folder =
      given.extension() == ".study" ? given : fs::path((of_file ? fs::path(given).replace_extension() : given).string() + ".study");
  const fs::path file = folder / "plan.toml", case_file = of_file ? given.filename() : folder.stem() / "case.toml";
  std::error_code error;
  if (fs::exists(file, error)) throw InputError({file.string(), 0}, "", "the name of a new study", "a study that exists already");
  fs::create_directories(folder, error);
  if (error) throw InputError({folder.string(), 0}, "", "a folder that can be created", error.message());
  std::string replaced, components;
  for (const std::string& each : driving(folder.parent_path() / case_file)) {
    replaced += (replaced.empty() ? "" : ", ") + escaped(each);
    components += (components.empty() ? "" : ", ") + std::string(generated);
  }
  try {
    write_file_atomically(
        file, fmt::format(study_template, in_shell(folder.string()), escaped((".." / case_file).string()), replaced, components));
  } catch (const fs::filesystem_error& failed) {
    throw OutputError(failed.what());
  }
  say(fmt::format("{0} written; next: uplift study check {1}", file.string(), in_shell(folder.string())));
  return Exit::done;
}

}  // namespace uplift::cli
