#include "uplift/case/ground/ground.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simple_meshes.h"
#include "text_support.h"
#include "uplift/io/text/toml.h"

// The ground beside the model: supports that hold at rest alone, tied sides, free field. Against closed forms of plane waves and by what
// must be the same.
namespace uplift::ground_test {
namespace {

constexpr double width = 12, depth = 8;  // m

/// Soil in two layers (soil_1 above soil_2), `cells` over each layer; with a block on its middle third, to be opened below.
Mesh ground(Cell cell, int cells, bool block) {
  const bool space = info(cell).dimension == 3;
  const double height = block ? 4 : 0;
  std::vector<double> upright = uniform_lines(-depth, 0, 2 * cells);
  if (block)
    for (int i = 1; i <= 2; ++i) upright.push_back(height * i / 2);
  Grid lines{uniform_lines(-width / 2, width / 2, 6), space ? uniform_lines(-2, 2, 2) : upright, space ? upright : std::vector<double>()};
  const auto part_at = [&](int i, int j, int k) {
    const int level = space ? k : j;
    if (level >= 2 * cells) return i == 2 || i == 3 ? 2 : -1;
    return level < cells ? 1 : 0;
  };
  const auto face = [](int part, Direction direction, int other) -> std::string {
    if (part == 2) return other < 0 ? "block_" + std::string(name_of(direction)) : "";
    if (other == 2) return "interface";
    return other < 0 ? "soil_" + std::string(name_of(direction)) : "";
  };
  std::vector<std::string> names{"soil_1", "soil_2"};
  if (block) names.emplace_back("block");
  return with_cells(grid(lines, part_at, names, face), cell);
}

Case read_text(const std::string& text, const Mesh& mesh) {
  return check_case(read_toml_text(text, "case.toml"), "case.toml",
                    [&](const std::string&, const Where&, const std::string&) { return mesh; });
}

RunResult run_text(const std::string& text, const Mesh& mesh) {
  const Case read = read_text(text, mesh);
  const RunSpec spec = runs_of_case(read).front();
  const BuiltCase built = build(read, spec);
  RunResult result = run(built.model, built.plan, built.behaviours);
  EXPECT_EQ(to_string(result.status), "completed") << result.reason;
  return result;
}

std::string refusal(const std::string& text, const Mesh& mesh) {
  return support::refusal_of([&] {
    const Case read = read_text(text, mesh);
    build(read, runs_of_case(read).front());
  });
}

constexpr double speed = 160, density = 1800, poisson = 0.25;  // m/s, kg/m3

/// Both layers alike.
const std::string soil = R"(
title = "ground"
bonded = false
[mesh]
file = "ground.msh"
[[solid]]
group = "soil_1"
shear_wave_speed = 160
poisson = 0.25
density = 1800
[[solid]]
group = "soil_2"
shear_wave_speed = 160
poisson = 0.25
density = 1800
)";

std::string supports(bool space) {
  std::string text;
  const auto add = [&](const char* group, const char* fixed) {
    text += std::string("[[support]]\ngroup = \"") + group + "\"\nfixed = [" + fixed + "]\nstages = \"static\"\n";
  };
  add("soil_bottom", space ? "\"ux\", \"uy\", \"uz\"" : "\"ux\", \"uy\"");
  for (const char* side : {"soil_left", "soil_right"}) add(side, "\"ux\"");
  for (const char* side : {"soil_front", "soil_back"})
    if (space) add(side, "\"uy\"");
  return text;
}

std::string boundaries(bool space, const std::string& wave, bool free_field) {
  std::string text = "[[absorbing]]\ngroup = \"soil_bottom\"\n";
  if (!wave.empty()) text += "incident = { " + wave + ", kind = \"incoming\", velocity = 0.1, function = \"pulse\" }\n";
  for (const char* side : {"soil_left", "soil_right", "soil_front", "soil_back"}) {
    if (!space && (std::string(side) == "soil_front" || std::string(side) == "soil_back")) continue;
    text += std::string("[[absorbing]]\ngroup = \"") + side + "\"\nfree_field = " + (free_field ? "true\n" : "false\n");
  }
  if (!wave.empty()) text += "[[function]]\nname = \"pulse\"\nshape = { type = \"ricker\", frequency = 6 }\n";
  return text;
}

std::string building(const std::string& law) {
  return R"([[solid]]
group = "block"
E = 2e9
poisson = 0.2
density = 1500
[[interface]]
name = "base"
surface = { group = "interface", lower = ["soil_1", "soil_2"] }
law = )" +
         law + "\n";
}

std::string stages(double duration, double step) {
  return "[[stage]]\ntype = \"static\"\nsteps = 2\n[[stage]]\ntype = \"dynamic\"\nduration = " + std::to_string(duration) +
         "\nstep = " + std::to_string(step) + "\n[output]\nframes = 5000\n";
}

const std::string elastic = "{ type = \"elastic\", K_n = 1e9, tangential = \"bonded\" }";

/// Largest motion away from the first picture, of all unknowns and pictures.
double motion(const RunResult& result) {
  double most = 0;
  for (const Frame& frame : result.frames)
    most = std::max(most, (frame.displacement - result.frames.front().displacement).cwiseAbs().maxCoeff());
  return most;
}

TEST(CaseGround, NothingMovesWhenTheSupportsGoAndNothingShakes) {
  for (const Cell cell : {Cell::quad4, Cell::hex8})
    for (const std::string& law : {elastic, std::string("{ type = \"coulomb\", friction = 0.6 }")}) {
      const bool space = cell == Cell::hex8;
      const std::string weight = space ? "[gravity]\nacceleration = [0, 0, -10]\n" : "[gravity]\nacceleration = [0, -10]\n";
      const RunResult result = run_text(soil + building(law) + supports(space) + boundaries(space, "", false) + weight + stages(0.4, 2e-3),
                                        ground(cell, 2, true));
      ASSERT_EQ(result.frames.size(), 201u);
      const double settlement = result.frames.front().displacement.cwiseAbs().maxCoeff();
      EXPECT_GT(settlement, 1e-4);
      EXPECT_LT(motion(result), 1e-9 * settlement) << law;
      const double stored = result.final_energy.strain + result.final_energy.stored;
      EXPECT_GT(stored, 0);
      EXPECT_LT(std::max(result.energy_created, result.energy_lost), 1e-12 * stored);
    }
}

TEST(CaseGround, WaveOnGroundUnderItsWeightIsTheWaveAlone) {
  // All is linear: what the wave does is the same with and without weight, released supports and constant reactions.
  const std::string rest = soil + building(elastic) + supports(false) + boundaries(false, "wave = \"SV\"", false) + stages(0.6, 2e-3);
  const RunResult alone = run_text(rest, ground(Cell::quad4, 2, true));
  const RunResult both = run_text(rest + "[gravity]\nacceleration = [0, -10]\n", ground(Cell::quad4, 2, true));
  ASSERT_EQ(alone.frames.size(), both.frames.size());
  const double size = motion(alone);
  EXPECT_GT(size, 1e-3);
  EXPECT_EQ(alone.frames.front().displacement.norm(), 0);
  for (std::size_t i = 0; i < alone.frames.size(); ++i)
    EXPECT_LT((both.frames[i].displacement - both.frames.front().displacement - alone.frames[i].displacement).cwiseAbs().maxCoeff(),
              1e-9 * size);
}

/// A tower on a rigid cap of the block, pushed aside for good.
std::string tower(const Mesh& mesh, bool p_delta) {
  std::string slaves;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    if (mesh.nodes[i].y() > 4 - 1e-9) slaves += (slaves.empty() ? "\"mesh." : ", \"mesh.") + std::to_string(i + 1) + "\"";
  std::string text = R"(
[nodes]
cap = [0, 4]
head = [0, 16]
[[rigid]]
name = "cap"
node = "cap"
slaves = [)" + slaves +
                     R"(]
[[beam]]
name = "tower"
nodes = ["cap", "head"]
E = 2e11
I = 1e-4
elements = 4
[[mass]]
node = "head"
mass = 1e4
[[load]]
node = "head"
force = [1e4, 0]
[gravity]
acceleration = [0, -10]
)" + stages(0.2, 2e-3);
  if (p_delta) text = support::replaced(text, "type = \"dynamic\"", "type = \"dynamic\"\np_delta = true");
  return soil + building(elastic) + supports(false) + boundaries(false, "", false) + text;
}

TEST(CaseGround, NothingMovesWithTheSecondOrderEither) {
  const Mesh mesh = ground(Cell::quad4, 2, true);
  const RunResult first = run_text(tower(mesh, false), mesh), second = run_text(tower(mesh, true), mesh);
  for (const RunResult* result : {&first, &second}) {
    const double size = result->frames.front().displacement.cwiseAbs().maxCoeff();
    EXPECT_GT(size, 1e-2);
    EXPECT_LT(motion(*result), 1e-9 * size);
  }
  // the weight of 1e5 N at 12 m leans on a tower whose sideways stiffness is 3 EI/L^3: about 1/(1 - W/(k L)) farther
  const double stiffness = 3 * 2e11 * 1e-4 / (12.0 * 12 * 12);
  const auto sway = [](const RunResult& result) { return result.frames.front().displacement[3]; };
  EXPECT_GT(sway(second) / sway(first), 1 / (1 - 1e5 / (stiffness * 12)));
  EXPECT_LT(sway(second) / sway(first), 1.2 / (1 - 1.2 * 1e5 / (stiffness * 12)));
}

TEST(CaseGround, ReleasedSupportsDoNotComeBack) {
  const Mesh mesh = ground(Cell::quad4, 2, true);
  const std::string text = soil + building(elastic) + supports(false) + boundaries(false, "", false) + stages(0.2, 2e-3);
  EXPECT_EQ(refusal(text, mesh), "accepted");
  EXPECT_NE(refusal(text + "[[stage]]\ntype = \"static\"\n", mesh).find("expected no static stage after a dynamic one"), std::string::npos);
  EXPECT_NE(refusal(text + "[[stage]]\ntype = \"dynamic\"\nduration = 1\nstep = 0.1\np_delta = true\n", mesh).find("p_delta later"),
            std::string::npos);
}

// ---- free field ----

/// Velocity of level ground of one kind under a pulse that comes up from the foot: up and down again (d'Alembert).
double exact(double height, double time, double c) {
  const auto pulse = [](double t) {
    const double x = std::numbers::pi * 6 * (t - 1.5 / 6);
    return 0.1 * (1 - 2 * x * x) * std::exp(-x * x);
  };
  return pulse(time - (height + depth) / c) + pulse(time - (depth - height) / c);
}

/// The side nodes move together, whatever they are along.
std::string tied(bool space) {
  const std::string unknowns = space ? "[\"ux\", \"uy\", \"uz\"]\n" : "[\"ux\", \"uy\"]\n";
  std::string text = "[[tie]]\ngroup = \"soil_left\"\nto = \"soil_right\"\nunknowns = " + unknowns;
  if (space) text += "[[tie]]\ngroup = \"soil_front\"\nto = \"soil_back\"\nunknowns = " + unknowns;
  return text;
}

std::string bottom_only(const std::string& text) {
  return text.substr(0, text.find("[[absorbing]]\ngroup = \"soil_left\"")) + text.substr(text.find("[[function]]"));
}

/// Largest error of the velocity at the surface and at half the depth, beside the amplitude of the pulse.
double error(const std::string& text, const Mesh& mesh, bool space, const std::string& along, double c) {
  std::string wanted = text;
  const std::vector<double> heights{0, -depth / 2};
  for (const double height : heights)
    wanted += "[[output.history]]\nname = \"at" + std::to_string(height) + "\"\nat = [0, " + (space ? "0, " : "") + std::to_string(height) +
              "]\nquantity = \"" + along + "\"\n";
  const RunResult result = run_text(wanted, mesh);
  double most = 0;
  for (const double height : heights) {
    const auto column = std::ranges::find(result.columns, "at" + std::to_string(height), &Request::name);
    const std::vector<double>& values = result.table[1 + static_cast<std::size_t>(column - result.columns.begin())];
    for (std::size_t i = 0; i < values.size(); ++i) most = std::max(most, std::abs(values[i] - exact(height, result.table[0][i], c)) / 0.1);
  }
  return most;
}

/// Errors with 4, 8 and 16 elements over the depth and the step in proportion.
void expect_free_field(const std::string& boundary, Cell cell, const std::string& along, double c, double order, double finest) {
  const bool space = info(cell).dimension == 3;
  std::vector<double> errors;
  for (const int cells : {4, 8, 16})
    errors.push_back(error(soil + supports(space) + boundary + stages(0.55, 0.016 / cells), ground(cell, cells, false), space, along, c));
  EXPECT_LT(errors.back(), finest) << info(cell).name << along;
  EXPECT_NEAR(std::log2(errors[1] / errors[2]), order, 0.25)
      << info(cell).name << along << " " << errors[0] << " " << errors[1] << " " << errors[2];
}

const double p_speed = speed * std::sqrt((2 - 2 * poisson) / (1 - 2 * poisson));

TEST(CaseGround, TiedSidesGiveTheFreeFieldWithOrderTwo) {
  for (const auto& [wave, along, c] : {std::tuple{"wave = \"SV\"", "vx", speed}, std::tuple{"wave = \"P\"", "vy", p_speed}})
    for (const Cell cell : {Cell::quad4, Cell::tri3})
      expect_free_field(bottom_only(boundaries(false, wave, false)) + tied(false), cell, along, c, 2, 0.01);
  expect_free_field(bottom_only(boundaries(true, "wave = \"SH\"", false)) + tied(true), Cell::hex8, "vy", speed, 2, 0.01);
}

TEST(CaseGround, FreeFieldColumnsGiveTheFreeFieldWithOrderTwo) {
  for (const auto& [wave, along, c] : {std::tuple{"wave = \"SV\"", "vx", speed}, std::tuple{"wave = \"P\"", "vy", p_speed}})
    for (const Cell cell : {Cell::quad4, Cell::tri3}) expect_free_field(boundaries(false, wave, true), cell, along, c, 2, 0.01);
  expect_free_field(boundaries(true, "wave = \"SV\"", true), Cell::hex8, "vx", speed, 2, 0.01);
}

/// The boundaries under several waves, each in a table of its own on the bottom.
std::string under_waves(bool space, const std::vector<std::string>& waves, bool free_field) {
  std::string text = boundaries(space, "wave = \"" + waves.front() + "\"", free_field);
  for (std::size_t i = 1; i < waves.size(); ++i)
    text += "[[absorbing]]\ngroup = \"soil_bottom\"\nincident = { wave = \"" + waves[i] +
            "\", kind = \"incoming\", velocity = 0.1, function = \"pulse\" }\n";
  return free_field ? text : support::replaced(text, "[[absorbing]]\ngroup = \"soil_left\"\nfree_field = false\n", tied(space));
}

TEST(CaseGround, SeveralWavesOnOneFaceAddUp) {
  // In every direction the motion of its own wave alone, 2 v_in at the surface: the dashpots of the bottom are there once.
  for (const bool space : {false, true})
    for (const bool free_field : {true, false}) {
      const Mesh mesh = ground(space ? Cell::hex8 : Cell::quad4, 8, false);
      const auto text = [&](const std::vector<std::string>& waves) {
        std::string made = soil + supports(space) + under_waves(space, waves, free_field) + stages(0.55, 0.002);
        for (const char* side : {"soil_right", "soil_front", "soil_back"})  // tied
          if (const std::string table = std::string("[[absorbing]]\ngroup = \"") + side + "\"\nfree_field = false\n";
              made.find(table) != std::string::npos)
            made = support::replaced(made, table, "");
        return made;
      };
      const std::vector<std::string> all = space ? std::vector<std::string>{"SV", "SH", "P"} : std::vector<std::string>{"SV", "P"};
      const std::vector<std::string> along = space ? std::vector<std::string>{"vx", "vy", "vz"} : std::vector<std::string>{"vx", "vy"};
      for (std::size_t k = 0; k < all.size(); ++k) {
        const double c = all[k] == "P" ? p_speed : speed;
        const double alone = error(text({all[k]}), mesh, space, along[k], c), together = error(text(all), mesh, space, along[k], c);
        EXPECT_LT(together, 0.02) << all[k] << space << free_field;
        EXPECT_NEAR(together, alone, 1e-8) << all[k] << space << free_field;
      }
    }
}

TEST(CaseGround, TablesOnTheSameFacesAreRefusedUnlessEachAddsAWave) {
  const Mesh mesh = ground(Cell::quad4, 2, false);
  const std::string rest = soil + supports(false) + boundaries(false, "wave = \"SV\"", true) + stages(0.1, 2e-3) + "[[absorbing]]\n";
  const std::string wave = "incident = { wave = \"P\", kind = \"incoming\", function = \"pulse\" }\n";
  EXPECT_EQ(refusal(rest + "group = \"soil_bottom\"\n" + wave, mesh), "accepted");
  const std::string idle = refusal(rest + "group = \"soil_bottom\"\n", mesh);
  EXPECT_NE(idle.find("found the faces of the [[absorbing]] of case.toml:"), std::string::npos) << idle;
  EXPECT_NE(idle.find("group \"soil_bottom\", and no incident"), std::string::npos) << idle;
  const std::string lumped = refusal(rest + "group = \"soil_bottom\"\nlumped = true\n" + wave, mesh);
  EXPECT_NE(lumped.find("lumped: expected false, as on the faces of the [[absorbing]] of case.toml:"), std::string::npos) << lumped;
  Mesh more = mesh;  // half of the bottom has a name of its own
  Group half = more.groups.at("soil_bottom");
  half.cells.resize(3);
  more.groups.emplace("half", half);
  const std::string part = refusal(rest + "group = \"half\"\n" + wave, more);
  EXPECT_NE(part.find("found 3 of its 3 faces among the 6 of the [[absorbing]] of case.toml:"), std::string::npos) << part;
}

/// How much the motion differs across the ground, beside the largest motion.
double unevenness(const RunResult& result, const Mesh& mesh, bool space) {
  const int each = space ? 6 : 3, up = space ? 2 : 1, translations = space ? 3 : 2;
  std::vector<std::size_t> order(mesh.nodes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, {}, [&](std::size_t i) { return mesh.nodes[i][up]; });
  double most = 0, size = 0;
  for (const Frame& frame : result.frames)
    for (std::size_t i = 1; i < order.size(); ++i)
      for (int k = 0; k < translations; ++k) {
        const double here = frame.displacement[each * static_cast<Index>(order[i]) + k];
        size = std::max(size, std::abs(here));
        if (mesh.nodes[order[i]][up] - mesh.nodes[order[i - 1]][up] < 1e-9)
          most = std::max(most, std::abs(here - frame.displacement[each * static_cast<Index>(order[i - 1]) + k]));
      }
  EXPECT_GT(size, 1e-4);
  return most / size;
}

TEST(CaseGround, FreeFieldOfLayersIsEvenToRoundOff) {
  // The column has the elements of the ground beside it: nothing is left of the sides, with layers and Rayleigh damping too.
  for (const Cell cell : {Cell::quad4, Cell::quad8, Cell::quad9, Cell::hex8, Cell::hex20}) {
    const bool space = info(cell).dimension == 3;
    for (const std::string& wave : {std::string("wave = \"P\""), std::string(space ? "wave = \"SH\", azimuth = 0.5" : "wave = \"SV\"")}) {
      const Mesh mesh = ground(cell, 2, false);
      const std::string text =
          support::replaced(soil, "group = \"soil_1\"\nshear_wave_speed = 160", "group = \"soil_1\"\nshear_wave_speed = 90") +
          supports(space) + boundaries(space, wave, true) + "[damping]\nalpha = 0.4\nbeta = 1e-3\n" + stages(0.5, 4e-3);
      const RunResult result = run_text(text, mesh);
      EXPECT_LT(unevenness(result, mesh, space), 1e-10) << info(cell).name << " " << wave;
      EXPECT_LT(std::max(result.energy_created, result.energy_lost), 1e-9 * result.energy_scale);
    }
  }
}

TEST(CaseGround, MotionWithinTheGroundMovesItsGroupAsOne) {
  const Mesh mesh = ground(Cell::quad4, 2, false);
  const std::string text = soil + support::replaced(supports(false), "fixed = [\"ux\", \"uy\"]\nstages = \"static\"", "fixed = [\"uy\"]") +
                           "[[motion]]\ngroup = \"soil_bottom\"\ndirection = \"ux\"\namplitude = 0.02\nfunction = \"pulse\"\n"
                           "[[function]]\nname = \"pulse\"\nshape = { type = \"ricker\", frequency = 6 }\n" +
                           stages(0.5, 4e-3);
  const Case read = read_text(text, mesh);
  EXPECT_EQ(build(read, runs_of_case(read).front()).model.motions.size(), 1u);
  const RunResult result = run_text(text, mesh);
  for (const Frame& frame : result.frames) {
    const double x = std::numbers::pi * 6 * (frame.time - 1.5 / 6), wanted = 0.02 * (1 - 2 * x * x) * std::exp(-x * x);
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
      if (mesh.nodes[i].y() < -depth + 1e-9) EXPECT_NEAR(frame.displacement[3 * static_cast<Index>(i)], wanted, 1e-15);
  }
}

TEST(CaseGround, FreeFieldSaysWhatItNeeds) {
  const Mesh mesh = ground(Cell::quad4, 2, false);
  const std::string rest = soil + supports(false) + stages(0.1, 2e-3);
  EXPECT_EQ(refusal(rest + boundaries(false, "wave = \"P\"", true), mesh), "accepted");
  EXPECT_NE(
      refusal(rest + boundaries(false, "", true), mesh).find("expected an absorbing face with an incident wave at its foot, found none"),
      std::string::npos);
  EXPECT_NE(
      refusal(rest + boundaries(false, "wave = \"P\"", true) + "[damping]\nmodal = [0.05]\nmodes = 2\n", mesh).find("found modal damping"),
      std::string::npos);
  EXPECT_NE(refusal(support::replaced(rest + boundaries(false, "wave = \"P\"", true), "group = \"soil_left\"\nfree",
                                      "group = \"soil_top\"\nfree"),
                    mesh)
                .find("found a level one"),
            std::string::npos);
}

TEST(CaseGround, SidesThatHoldTheWaveBackAreWarnedOf) {
  for (const bool free_field : {true, false}) {
    const std::string text = soil + supports(false) + boundaries(false, "wave = \"SV\"", free_field) + stages(0.1, 2e-3);
    const Case read = read_text(text, ground(Cell::quad4, 2, false));
    const RunSpec spec = runs_of_case(read).front();
    const std::vector<std::string> said = warnings(read, spec, build(read, spec));
    const auto of_sides =
        std::ranges::count_if(said, [](const std::string& each) { return each.find("holds the incident wave back") != each.npos; });
    EXPECT_EQ(of_sides, free_field ? 0 : 2);
  }
}

/// A name that another wave has already is not given again.
TEST(CaseGround, WavesOfOneNameAreNumbered) {
  std::string text = soil + supports(false) + boundaries(false, "name = \"a\", wave = \"SV\"", true);
  for (const char* name : {"a", "a 2", "a"})
    text += std::string("[[absorbing]]\ngroup = \"soil_bottom\"\nincident = { name = \"") + name +
            "\", wave = \"P\", kind = \"incoming\", velocity = 0.1, function = \"pulse\" }\n";
  const Case read = read_text(text + stages(0.1, 2e-3), ground(Cell::quad4, 2, false));
  std::vector<std::string> names;
  for (const CaseAbsorbing& each : read.input->absorbing)
    if (each.incident) names.push_back(each.incident->name);
  EXPECT_EQ(names, (std::vector<std::string>{"a", "a 3", "a 2", "a 4"}));
}

TEST(CaseGround, HeldAbsorbingFacesAreWarnedOf) {
  const std::string text = soil + supports(false) + boundaries(false, "wave = \"SV\"", true) + stages(0.1, 2e-3);
  for (const bool everywhere : {true, false}) {
    std::string held = text;
    if (everywhere)
      for (std::size_t at = 0; (at = held.find("stages = \"static\"")) != held.npos;) held.replace(at, 17, "");
    const Case read = read_text(held, ground(Cell::quad4, 2, false));
    const RunSpec spec = runs_of_case(read).front();
    const std::vector<std::string> said = warnings(read, spec, build(read, spec));
    const auto of_faces =
        std::ranges::count_if(said, [](const std::string& each) { return each.find("in the dynamic stages too") != each.npos; });
    EXPECT_EQ(of_faces, everywhere ? 1 : 0);  // the base; rollers at the sides leave a direction free
  }
}

TEST(CaseGround, TiesNeedAnOppositeSide) {
  Mesh mesh = ground(Cell::quad4, 2, false);
  const std::string rest = soil + supports(false) + bottom_only(boundaries(false, "wave = \"P\"", false)) + stages(0.1, 2e-3);
  EXPECT_EQ(refusal(rest + tied(false), mesh), "accepted");
  EXPECT_NE(
      refusal(rest + support::replaced(tied(false), "soil_right", "soil_left"), mesh).find("expected the opposite side of the ground"),
      std::string::npos);
  EXPECT_NE(refusal(rest + support::replaced(tied(false), "\"uy\"", "\"rz\""), mesh).find("expected ux or uy, found \"rz\""),
            std::string::npos);
  for (Vec3& place : mesh.nodes)
    if (place.x() > width / 2 - 1e-9 && std::abs(place.y() + 2) < 1e-9) place.y() -= 0.1;
  EXPECT_NE(refusal(rest + tied(false), mesh).find("at (-6, -2, 0) without one in \"soil_right\""), std::string::npos);
}

}  // namespace
}  // namespace uplift::ground_test
