#include <fmt/format.h>

#include <filesystem>

#include "uplift/base/error.h"
#include "uplift/base/file.h"
#include "uplift/cli/commands.h"
#include "uplift/cli/console.h"
#include "uplift/io/files.h"

namespace uplift::cli {
namespace {

constexpr const char* template_text =
    R"TOML(# A case for uplift. Numbers may carry units ("5 m", "20000 MPa"); a bare number is SI (m, kg, s, N, Pa, rad).
# x points right, y points up, rotations are counter-clockwise. An opening is positive, a tension is positive.
# `uplift describe section beam`, `uplift describe law sdm`, ... explain every key.
title = "{0}"
description = "A slender tower on a footing that may uplift."

# ---- the structure ----

[nodes]                               # name = [x, y]
top = ["0 m", "10 m"]
base = ["0 m", "0 m"]

[[beam]]
name = "shaft"
nodes = ["base", "top"]
E = "30 GPa"
I = "0.5 m4"                          # without A the beam is inextensible

[[mass]]
node = "top"
mass = "40 t"

[[rigid]]                             # the footing: a rigid body on the node "base"
name = "footing"
node = "base"
mass = "60 t"
inertia = "80 t m2"

[[support]]                           # the footing does not slide
node = "base"
fixed = ["ux"]

[gravity]
acceleration = [0, "-9.81 m/s2"]      # weight of all masses

# ---- the interface ----

[[interface]]
name = "soil"

[interface.footing]                   # joint points under a rigid footing
body = "base"
width = "4 m"
thickness = "4 m"                     # perpendicular to the plane of the model
points = 41

[interface.law]                       # other laws: `uplift describe law`
type = "sdm"                          # strong discontinuity method: opens and closes again
K_n = "50 MPa/m"                      # stiffness per area of the joint in contact (subgrade modulus)
F_u = "1 kPa"                         # tensile strength
G_f = "0.1 J/m2"                      # fracture energy per area
F_c = "-0.5 kPa"                      # closure stress: small compared with the bearing pressure
tangential = "none"

# ---- the loads ----

[[function]]
name = "pulse"
shape = {{ type = "half_sine", duration = "0.3 s" }}

[[load]]
name = "wind gust"
node = "top"
force = ["300 kN", 0]
function = "pulse"                    # a load without a function is constant and acts from the static stage on

# An earthquake instead of the gust: a recorded motion, used as a function by its name.
# [[record]]
# name = "quake"
# file = "quake.at2"                  # unit and step are read from the file; if it does not state them, see `uplift describe section record`
#                                     # or generated for a spectrum: generate = {{ target = {{ type = "rg_1_60", pga = "2 m/s2" }}, seed = 1 }}
#
# [[ground_acceleration]]
# direction = [1, 0]
# function = "quake"

# ---- the analysis ----

[damping]                             # of the structure; it does not act across an open interface
rayleigh = [{{ frequency = "1 Hz", ratio = 0.02 }}, {{ frequency = "10 Hz", ratio = 0.02 }}]

[[stage]]                             # first the weight ...
type = "static"

[[stage]]                             # ... then the gust
type = "dynamic"
duration = "5 s"
step = "1 ms"

[output]
every = 1                             # record every step; motion of top and base, forces and energies are included automatically

[[output.history]]                    # further quantities
interface = "soil"
point = 1
quantity = "opening"

# ---- variants, for `uplift compare` ----

[[variant]]
name = "sdm"
label = "SDM"

[[variant]]
name = "springs"
label = "tensionless springs"
law = {{ type = "springs", K_n = "50 MPa/m" }}

[compare]
band = 0.02                           # runs agree when their peaks lie within 2 % of the median
)TOML";

}  // namespace

int new_case(const std::string& name) {
  namespace fs = std::filesystem;
  if (name.empty()) throw InputError({"uplift new", 0}, "", "the name of a folder", "an empty one");
  const fs::path folder(name), file = folder / "case.toml";
  std::error_code error;
  if (fs::exists(file, error)) throw InputError({file.string(), 0}, "", "the name of a new case", "a case that exists already");
  fs::create_directories(folder, error);
  if (error) throw InputError({folder.string(), 0}, "", "a folder that can be created", error.message());
  std::string title = folder.filename().empty() ? folder.parent_path().filename().string() : folder.filename().string();
  for (char& c : title)
    if (c == '"' || c == '\\') c = '_';
  try {
    write_file_atomically(file, fmt::format(template_text, title));
  } catch (const fs::filesystem_error& refusal) {
    throw OutputError(fmt::format("{}: cannot write the file: {}", file.string(), refusal.code().message()));
  }
  say(fmt::format("{} written; next: uplift check {}", file.string(), in_shell(folder.string())));
  return Exit::done;
}

}  // namespace uplift::cli
