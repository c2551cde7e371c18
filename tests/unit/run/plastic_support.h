#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "text_support.h"
#include "uplift/case/case.h"
#include "uplift/io/text/toml.h"

// Cases with solids that yield, for whole runs.
namespace uplift::plastic_test {

struct Prepared {
  std::unique_ptr<Case> read;
  BuiltCase built;
};

/// `cube`: the mesh of a case that reads a file.
inline Prepared prepared(const std::string& text, const Mesh* cube = nullptr) {
  Prepared made;
  made.read = std::make_unique<Case>(check_case(read_toml_text(text, "case.toml"), "case.toml",
                                                [&](const std::string&, const Where&, const std::string&) { return *cube; }));
  made.built = build(*made.read, RunSpec{});
  return made;
}

inline std::string refusal(const std::string& text) {
  return support::refusal_of([&] { prepared(text); });
}

/// A block 3 x 6 m on 12 x 4 m of soil, free to lift off and to slide, pushed at its top.
inline std::string block_on_soil(const std::string& plasticity, const std::string& behaviour, const std::string& rest = {}) {
  return R"(title = "block on soil"
[mesh.soil_box.soil]
width = 12
size = 1.5
[[mesh.soil_box.soil.layers]]
thickness = 4
size = 1
[mesh.soil_box.block]
width = 3
height = 6
size = 1
[[solid]]
group = "soil_1"
E = 5e7
poisson = 0.3
density = 1900
)" + plasticity +
         R"(
[[solid]]
group = "block"
E = 2e9
poisson = 0.2
density = 1500
[[support]]
group = "soil_bottom"
fixed = ["ux", "uy"]
[[support]]
group = "soil_left"
fixed = ["ux"]
[[support]]
group = "soil_right"
fixed = ["ux"]
[[interface]]
name = "base"
surface = { group = "interface", lower = ["soil_1"] }
)" + behaviour +
         R"(
[gravity]
acceleration = [0, -9.81]
)" + rest;
}

inline const std::string springs = "law = { type = \"springs\", K_n = 2e9, K_t = 1e9, tangential = \"coulomb\", friction = 0.5 }\n";
inline const std::string static_push =
    "[[load]]\nname = \"push\"\ngroup = \"block_top\"\nforce = [40e3, 0]\n[[stage]]\ntype = \"static\"\n";

inline std::string shaken(double push, double duration = 0.4, double step = 2e-3) {
  return "[[function]]\nname = \"pulse\"\nshape = { type = \"half_sine\", duration = 0.15 }\n[[load]]\nname = \"push\"\ngroup = "
         "\"block_top\"\nforce = [" +
         std::to_string(push) +
         ", 0]\nfunction = \"pulse\"\n[[stage]]\ntype = \"static\"\nsteps = 4\n[[stage]]\ntype = "
         "\"dynamic\"\nstep = " +
         std::to_string(step) + "\nduration = " + std::to_string(duration) + "\n";
}

inline const std::vector<double>& column(const RunResult& result, const std::string& name) {
  for (std::size_t k = 0; k < result.columns.size(); ++k)
    if (result.columns[k].name == name) return result.table[k + 1];
  ADD_FAILURE() << "no column " << name;
  return result.table[0];
}

}  // namespace uplift::plastic_test
