// [foundation.soil]: stiffness and dashpots from the ground, in whole runs.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "text_support.h"
#include "uplift/case/case.h"
#include "uplift/contact/method.h"
#include "uplift/io/text/toml.h"
#include "uplift/laws/foundation.h"
#include "uplift/verdict/verdict.h"

namespace uplift::foundation_soil_test {
namespace {

using support::refusal_of;
using support::replaced;

/// A tower of two storeys on a pulse; in space a stick with all inertias.
std::string tower(bool space, const std::string& ground, const std::string& more_nodes = "", const std::string& slaves = "") {
  const std::string nodes = space ? "base = [0, 0, 0]\ntop = [0, 0, 10]\n" : "base = [0, 0]\ntop = [0, 10]\n";
  return "title = \"tower\"\n[nodes]\n" + nodes + more_nodes +
         "[[beam]]\nname = \"column\"\nnodes = [\"base\", \"top\"]\nE = 3e10\nA = 1\n" +
         (space ? "I_y = 0.2\nI_z = 0.2\nJ = 0.3\n" : "I = 0.2\n") + "[[mass]]\nnode = \"top\"\nmass = 100e3\ninertia = 1e5\n" +
         "[[rigid]]\nname = \"footing\"\nnode = \"base\"\nmass = 30e3\ninertia = 60e3\n" + slaves + ground + R"(
[[function]]
name = "pulse"
shape = { type = "half_sine", duration = 0.2 }
[[ground_acceleration]]
function = "pulse"
amplitude = 4
direction = )" +
         (space ? "[0.64, 0.48, 0.6]" : "[0.8, 0.6]") + R"(
[[stage]]
type = "dynamic"
duration = 1
step = 2e-3
[output]
frames = 0
automatic = false
)";
}

std::string histories(std::initializer_list<const char*> quantities) {
  std::string text;
  for (const char* quantity : quantities) text += std::string("[[output.history]]\nnode = \"base\"\nquantity = \"") + quantity + "\"\n";
  return text;
}

RunResult run_text(const std::string& text) {
  const Case read = check_case(read_toml_text(text, "case.toml"), "case.toml");
  const BuiltCase built = build(read, runs_of_case(read).front());
  RunResult result = run(built.model, built.plan, built.behaviours);
  EXPECT_EQ(result.status, RunStatus::completed) << result.reason;
  EXPECT_LT(std::abs(result.final_energy.residual), 1e-10 * result.energy_scale);
  return result;
}

void expect_same(const RunResult& one, const RunResult& other) {
  ASSERT_EQ(one.table.size(), other.table.size());
  for (std::size_t k = 1; k < one.table.size(); ++k) {
    if (one.columns[k - 1].name.substr(0, 5) != "base.") continue;
    double most = 0;
    for (const double value : other.table[k]) most = std::max(most, std::abs(value));
    ASSERT_GT(most, 1e-6) << other.columns[k - 1].name;
    for (std::size_t i = 0; i < one.table[k].size(); ++i) ASSERT_NEAR(one.table[k][i], other.table[k][i], 1e-9 * most) << k << " " << i;
  }
}

FootingOnSoil ground_of(double width, double length, double frequency) {
  FootingOnSoil made;
  made.width = width, made.length = length, made.frequency = frequency, made.embedment = 1;
  made.layers = {{Ground{60e6, 0.3, 1900}, 2}, {Ground{90e6, 0.35, 2000}}};
  return made;
}

constexpr const char* layers = R"(embedment = 1
frequency = 3
radiation = true
layers = [{ thickness = 2, G = "60 MPa", poisson = 0.3, density = 1900 }, { G = "90 MPa", poisson = 0.35, density = 2000 }]
)";

std::string dashpot(const char* node, const char* direction, const char* kind, double value) {
  return fmt::format("[[dashpot]]\nnodes = [\"{}\"]\n{}{} = {:.17g}\n", node, direction, kind, value);
}

TEST(FoundationSoil, IsStiffnessAndDashpotsOfThePlane) {
  using enum SoilMotion;
  const SoilSprings k = soil_springs(ground_of(6, 9, 3));
  const std::string more = "under = [0, -1]\n", slaves = "slaves = [\"under\"]\n";
  const std::string head = "[[foundation]]\nname = \"ground\"\nbody = \"base\"\nwidth = 6\nlength = 9\noffset = [0, -1]\n";
  const std::string columns = histories({"ux", "uy", "rz"});
  const RunResult soil =
      run_text(tower(false, head + "model = { type = \"macro_element\" }\n[foundation.soil]\n" + layers, more, slaves) + columns);
  const RunResult stated =
      run_text(tower(false,
                     head +
                         fmt::format("model = {{ type = \"macro_element\", K_v = {:.17g}, K_h = {:.17g}, K_r = {:.17g} }}\n",
                                     k[vertical].stiffness(), k[along_width].stiffness(), k[tilting_width].stiffness()) +
                         dashpot("under", "direction = [1, 0]\n", "damping", k[along_width].damping) +
                         dashpot("under", "direction = [0, 1]\n", "damping", k[vertical].damping) +
                         dashpot("under", "", "rotational_damping", k[tilting_width].damping),
                     more, slaves) +
               columns);
  EXPECT_GT(soil.max_uplifted_ratio.value, 0.1);
  expect_same(soil, stated);
}

TEST(FoundationSoil, IsStiffnessAndDashpotsOfSpace) {
  using enum SoilMotion;
  const SoilSprings k = soil_springs(ground_of(6, 9, 3));
  const std::string head = "[[foundation]]\nname = \"ground\"\nbody = \"base\"\nwidth = 6\nlength = 9\n";
  const std::string columns = histories({"ux", "uy", "uz", "rx", "ry"});
  const RunResult soil = run_text(tower(true, head + "model = \"elastic\"\n[foundation.soil]\n" + layers) + columns);
  const RunResult stated = run_text(
      tower(true, head +
                      fmt::format("model = {{ type = \"elastic\", K_v = {:.17g}, K_h = {:.17g}, K_h2 = {:.17g}, K_r = {:.17g}, K_r2 = "
                                  "{:.17g}, K_t = {:.17g} }}\n",
                                  k[vertical].stiffness(), k[along_width].stiffness(), k[along_length].stiffness(),
                                  k[tilting_width].stiffness(), k[tilting_length].stiffness(), k[torsion].stiffness()) +
                      dashpot("base", "direction = [1, 0, 0]\n", "damping", k[along_width].damping) +
                      dashpot("base", "direction = [0, 1, 0]\n", "damping", k[along_length].damping) +
                      dashpot("base", "direction = [0, 0, 1]\n", "damping", k[vertical].damping) +
                      dashpot("base", "direction = [0, 1, 0]\n", "rotational_damping", k[tilting_width].damping) +
                      dashpot("base", "direction = [1, 0, 0]\n", "rotational_damping", k[tilting_length].damping) +
                      dashpot("base", "direction = [0, 0, 1]\n", "rotational_damping", k[torsion].damping)) +
      columns);
  expect_same(soil, stated);
}

// A block on a disc, pushed down and let go: w(t) = exp(-z w0 t) of an oscillator with K = 4GR/(1 - nu), c = 0.85 K R/V.
TEST(FoundationSoil, ADiscRadiatesAsAnOscillatorDecays) {
  const double g = 80e6, nu = 0.3, density = 1900, radius = 3, mass = 2e6;
  const double stiffness = 4 * g * radius / (1 - nu), damping = 0.85 * stiffness * radius / std::sqrt(g / density);
  const RunResult result = run_text(R"(title = "disc"
[nodes]
base = [0, 0]
[[rigid]]
name = "block"
node = "base"
mass = 2e6
inertia = 1e7
[[support]]
node = "base"
fixed = ["ux", "rz"]
[[foundation]]
name = "ground"
body = "base"
shape = "disc"
width = 6
model = "elastic"
[foundation.soil]
G = "80 MPa"
poisson = 0.3
density = 1900
radiation = true
[[initial]]
node = "base"
displacement = [0, 0.01]
[[stage]]
type = "dynamic"
duration = 0.5
step = 2e-4
[output]
frames = 0
automatic = false
)" + histories({"uy"}));
  const double w0 = std::sqrt(stiffness / mass), share = damping / (2 * std::sqrt(stiffness * mass)),
               wd = w0 * std::sqrt(1 - share * share);
  EXPECT_GT(share, 0.1);
  for (std::size_t i = 0; i < result.table[0].size(); ++i) {
    const double t = result.table[0][i];
    ASSERT_NEAR(result.table[1][i], 0.01 * std::exp(-share * w0 * t) * (std::cos(wd * t) + share * w0 / wd * std::sin(wd * t)), 2e-6) << t;
  }
}

TEST(FoundationSoil, WhatTheModelLeavesOutIsThatOfTheSoil) {
  using enum SoilMotion;
  const SoilSprings k = soil_springs(ground_of(6, 9, 3));
  const std::string text = tower(true, std::string("[[foundation]]\nname = \"ground\"\nbody = \"base\"\nwidth = 6\nlength = 9\n") +
                                           "model = { type = \"elastic\", K_h = 1e9, K_r = 1e10 }\n[foundation.soil]\n" + layers);
  const Case read = check_case(read_toml_text(text, "case.toml"), "case.toml");
  const BuiltCase built = build(read, runs_of_case(read).front());
  std::array<double, 6> rows{};
  built.model.interfaces.front().law->closed_stiffness(6, rows.data());
  const std::array<double, 6> wanted{1e9,  k[along_length].stiffness(), k[vertical].stiffness(), k[tilting_length].stiffness(),
                                     1e10, k[torsion].stiffness()};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_DOUBLE_EQ(rows[i], wanted[i]) << i;
}

// On the compliance F = 1/K of every row the opening of an elastic foundation, g = g_free - F K g, is half of what it would be free.
TEST(FoundationSoil, AStoredProblemIsReplayedWithTheStiffnessesOfTheSoil) {
  using enum SoilMotion;
  const SoilSprings k = soil_springs(ground_of(6, 9, 3));
  const auto newton = make_part(method_catalog(), check_part(Raw{std::string("newton"), {"test", 0}, ""}, contact_methods()));
  for (const bool space : {false, true})
    for (const std::string model : {"elastic", "macro_element"})
      for (const std::string stated : {"", ", K_h = 1.5e9, K_r = 1e10"}) {
        SCOPED_TRACE(fmt::format("{} {} {}", space ? "space" : "plane", model, stated));
        const std::string foundation = "[[foundation]]\nname = \"ground\"\nbody = \"base\"\nwidth = 6\nlength = 9\nmodel = { type = \"" +
                                       model + "\"" + stated + " }\n[foundation.soil]\n";
        const Case read = check_case(read_toml_text(tower(space, foundation + layers), "case.toml"), "case.toml");
        const BuiltCase built = build(read, runs_of_case(read).front());
        const Interface& ground = built.model.interfaces.front();
        std::vector<double> wanted{k[along_width].stiffness(), k[vertical].stiffness(), k[tilting_width].stiffness()};
        if (space)
          wanted = {wanted[0], k[along_length].stiffness(), wanted[1], k[tilting_length].stiffness(), wanted[2], k[torsion].stiffness()};
        if (!stated.empty()) wanted[0] = 1.5e9, wanted[space ? 4 : 2] = 1e10;

        const auto rows = static_cast<Index>(wanted.size());
        auto contact = std::make_shared<ContactModel>();
        Block block;
        block.name = ground.name, block.batch = ground.batch, block.area = ground.area, block.footprint = ground.footprint;
        block.law = ground.law.get();
        contact->blocks.push_back(block);
        contact->factor = Matrix::Zero(rows, rows);
        for (Index r = 0; r < rows; ++r) contact->factor(r, r) = 1 / std::sqrt(wanted[static_cast<std::size_t>(r)]);
        InterfaceProblem problem = problem_of(contact);
        problem.free_opening = Vector::Constant(rows, 1e-4);
        problem.free_opening[ground.batch.normal()] = -4e-3;
        problem.from = Vector::Zero(rows);
        problem.old = Vector::Zero(block.law->num_history(ground.batch.components));

        const std::string text = save_problem(problem, built.behaviours, "a reason");
        EXPECT_EQ(text.find("\"soil\""), std::string::npos);
        const StoredProblem stored = load_problem(text, "problem.json");
        std::vector<double> found(wanted.size());
        stored.problem.model->blocks.front().law->closed_stiffness(ground.batch.components, found.data());
        for (std::size_t r = 0; r < wanted.size(); ++r) EXPECT_DOUBLE_EQ(found[r], wanted[r]) << r;
        InterfaceSolution first, replayed;
        ASSERT_TRUE(newton->solve(problem, first).converged);
        ASSERT_TRUE(newton->solve(stored.problem, replayed).converged);
        for (Index r = 0; r < rows; ++r) {
          EXPECT_EQ(replayed.opening[r], first.opening[r]) << r;
          EXPECT_EQ(replayed.force[r], first.force[r]) << r;
          const double half = 0.5 * problem.free_opening[r];
          EXPECT_NEAR(replayed.opening[r], half, 1e-9 * std::abs(half)) << r;  // closed: both models are linear
        }
      }
}

TEST(FoundationSoil, WhatTheFormulasDoNotKnowIsRefused) {
  const auto refusal = [](const std::string& keys, const std::string& soil, const std::string& model = "\"elastic\"") {
    return refusal_of([&] {
      const std::string text =
          tower(false, "[[foundation]]\nname = \"ground\"\nbody = \"base\"\n" + keys + "model = " + model + "\n[foundation.soil]\n" + soil);
      const Case read = check_case(read_toml_text(text, "case.toml"), "case.toml");
      build(read, runs_of_case(read).front());
    });
  };
  const auto expect = [](const std::string& said, std::initializer_list<const char*> parts) {
    EXPECT_EQ(said.substr(0, 10), "case.toml:") << said;
    for (const char* part : parts) EXPECT_NE(said.find(part), std::string::npos) << part << " in: " << said;
  };
  const std::string plan = "width = 6\nlength = 8\n", ground = "G = 8e7\npoisson = 0.3\n";
  EXPECT_EQ(refusal(plan, ground), "accepted");
  expect(refusal("width = 6\n", ground), {"the length of a rectangle"});
  expect(refusal(plan, "poisson = 0.3\n"), {"G", "shear_wave_velocity"});
  expect(refusal(plan, "G = 8e7\n"), {"poisson"});
  expect(refusal(plan, "G = 8e7\npoison = 0.3\n"), {"did you mean \"poisson\""});
  expect(refusal(plan, "G = 8e7\npoisson = 0.6\n"), {"soil.poisson", "0.5"});
  expect(refusal(plan, "G = \"8 m\"\npoisson = 0.3\n"), {"soil.G", "a pressure"});
  expect(refusal(plan, "shear_wave_velocity = 200\npoisson = 0.3\n"), {"density"});
  expect(refusal(plan, ground + "radiation = true\n"), {"density"});
  expect(refusal(plan, ground + "formulas = \"gazetas\"\nfrequency = 2\n"), {"soil.frequency", "pais_kausel"});
  expect(refusal(plan, ground + "embedment = 1\nsidewall = 1\n"), {"soil.sidewall", "gazetas"});
  expect(refusal(plan, ground + "formulas = \"gazetas\"\nembedment = 1\nsidewall = 2\n"), {"soil.sidewall", "embedment"});
  expect(refusal(plan, ground + "embedment = 13\n"), {"soil.embedment", "twice the width"});
  expect(refusal(plan, "layers = []\n"), {"soil.layers", "at least one"});
  expect(refusal(plan, ground + "rock_depth = 20\n"), {"soil.rock_depth", "strip"});
  expect(refusal("width = 6\nlength = 150\n", ground), {"1 to 20", "1 to 25"});
  expect(refusal("width = 6\nshape = \"strip\"\n", ground), {"rock_depth"});
  expect(refusal("width = 6\nshape = \"strip\"\n", ground + "rock_depth = 2\n"), {"rock_depth", "half of the width"});
  expect(refusal("width = 6\nshape = \"disc\"\n", ground + "formulas = \"gazetas\"\n"), {"soil.formulas", "rectangle"});
  expect(refusal(plan, ground + "layers = [{ G = 8e7, poisson = 0.3, density = 1900 }]\n"), {"soil.G", "both"});
  expect(refusal(plan, "layers = [{ G = 8e7, poisson = 0.3, density = 1900, thickness = 2 }]\n"), {"soil.layers", "3.722 m", "2 m"});
  expect(refusal(plan, "layers = [{ G = 8e7, poisson = 0.3, density = 1900 }, { G = 8e7, poisson = 0.3, density = 1900 }]\n"),
         {"layers[0]", "thickness"});
  const std::string bare = refusal_of([&] {
    const Case read = check_case(
        read_toml_text(
            tower(false, "[[foundation]]\nname = \"ground\"\nbody = \"base\"\nwidth = 6\nmodel = { type = \"elastic\", K_v = 1e9 }"),
            "case.toml"),
        "case.toml");
    build(read, runs_of_case(read).front());
  });
  expect(bare, {"K_h, or [foundation.soil]"});
}

}  // namespace
}  // namespace uplift::foundation_soil_test
