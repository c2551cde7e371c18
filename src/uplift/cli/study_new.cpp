#include <fmt/format.h>

#include <filesystem>

#include "uplift/base/error.h"
#include "uplift/base/file.h"
#include "uplift/cli/console.h"
#include "uplift/cli/study.h"
#include "uplift/io/files.h"

namespace uplift::cli {
namespace {

constexpr const char* study_template =
    R"TOML(# A study for uplift: one case under many motions, at many intensities. `uplift describe section study` explains every key.
#     uplift study check {0}; uplift study run {0}; uplift study report {0}
# Files are relative to this plan. Numbers may carry units; a bare number is SI.
case = "../{1}/case.toml"
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
replace = ["quake"]                   # the record or function of the case that they take the place of
count = 20
generate = [{{ target = {{ type = "rg_1_60", pga = "0.3 g_n" }}, duration = 20, seed = 1 }}]

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

}  // namespace

int new_study(const std::string& name) {
  namespace fs = std::filesystem;
  const fs::path given(name);
  if (given.filename().empty() || given.stem() == "." || given.stem() == "..")
    throw InputError({name, 0}, "", "the name of a new study", in_quotes(name));
  const fs::path folder = given.extension() == ".study" ? given : fs::path(name + ".study"), file = folder / "plan.toml";
  std::error_code error;
  if (fs::exists(file, error)) throw InputError({file.string(), 0}, "", "the name of a new study", "a study that exists already");
  fs::create_directories(folder, error);
  if (error) throw InputError({folder.string(), 0}, "", "a folder that can be created", error.message());
  try {
    write_file_atomically(file, fmt::format(study_template, folder.string(), folder.stem().string()));
  } catch (const fs::filesystem_error& failed) {
    throw OutputError(failed.what());
  }
  say(fmt::format("{0} written; next: uplift study check {1}", file.string(), folder.string()));
  return Exit::done;
}

}  // namespace uplift::cli
