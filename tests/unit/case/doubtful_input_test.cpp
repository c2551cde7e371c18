// Input that is accepted by its form and hardly meant: factors hidden in directions and units, functions that end before the run.
#include <gtest/gtest.h>

#include "tower_case.h"
#include "unit/case/record_support.h"

namespace uplift::doubtful_input_test {
namespace {

using support::Tower;

std::string case_with(const std::string& more, const std::string& law = "type = \"springs\", K_n = 1e9, K_t = 1e8", const Tower& tower = {},
                      const std::string& weight = support::weight) {
  return "title = \"tower\"\n" + tower.text() + weight +
         "[[interface]]\nname = \"soil\"\nfooting = { body = \"base\", width = 3, points = 5 }\nlaw = { " + law + " }\n" +
         "[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\nduration = 1\nstep = 0.01\n" + more;
}

std::string refusal(const std::string& text) {
  return support::refusal_of([&] {
    const Case read = check_case(read_toml_text(text, "case.toml"), "case.toml");
    build(read, runs_of_case(read).front());
  });
}

/// The warnings with a word.
int warned(const std::string& text, const std::string& word) {
  const Case read = check_case(read_toml_text(text, "case.toml"), "case.toml");
  const RunSpec spec = runs_of_case(read).front();
  const BuiltCase built = build(read, spec);
  return static_cast<int>(
      std::ranges::count_if(warnings(read, spec, built), [&](const std::string& each) { return each.find(word) != each.npos; }));
}

std::string shaken(const std::string& keys) {
  return "[[function]]\nname = \"f\"\nshape = { type = \"half_sine\", duration = 1 }\n[[ground_acceleration]]\nfunction = \"f\"\n" + keys;
}

TEST(DoubtfulInput, TheDirectionOfTheGroundIsNoFactor) {
  EXPECT_NE(refusal(case_with(shaken("direction = [2, 0]\n")))
                .find("a direction of length 1 (the amplitude is the factor), found one of length 2"),
            std::string::npos)
      << refusal(case_with(shaken("direction = [2, 0]\n")));
  EXPECT_NE(refusal(case_with(shaken("direction = [0, 0]\n"))).find("length 0"), std::string::npos);
  for (const char* direction : {"[1, 0]", "[-1, 0]", "[0.6, 0.8]", "[0.71, 0.71]"})
    EXPECT_EQ(refusal(case_with(shaken(std::string("direction = ") + direction + "\n"))), "accepted") << direction;
}

/// Without friction the cone through the edges of compression bears 2/sqrt(3) times the cohesion's strength in plane strain.
TEST(DoubtfulInput, ClayIsFittedInPlaneStrain) {
  const auto clay = [](const std::string& friction, const std::string& fit) {
    return "title = \"clay\"\n[mesh.soil_box.soil]\nwidth = 4\nsize = 1\nlayers = [{ thickness = 2, size = 1 "
           "}]\n[mesh.soil_box.block]\nwidth = "
           "2\nheight = 1\nsize = 1\n[[solid]]\ngroup = \"soil_1\"\nE = 6e7\npoisson = 0.4\ndensity = 1800\nlaw = { type = "
           "\"drucker_prager\", "
           "cohesion = 2e4, friction_angle = " +
           friction + fit +
           " }\n[[solid]]\ngroup = \"block\"\nE = 3e10\npoisson = 0.2\ndensity = 2400\n[[support]]\ngroup = \"soil_bottom\"\nfixed = "
           "[\"ux\", "
           "\"uy\"]\n[[interface]]\nname = \"base\"\nsurface = { group = \"interface\", lower = [\"soil_1\"] }\nlaw = { type = "
           "\"springs\", K_n = "
           "1e9, K_t = 1e9 }\n[gravity]\nacceleration = [0, -9.81]\n[[stage]]\ntype = \"static\"\n";
  };
  const std::string word = "plane strain";
  EXPECT_EQ(warned(clay("0", ""), word), 1);
  EXPECT_EQ(warned(clay("0", ", fit = \"extension\""), word), 1);
  EXPECT_EQ(warned(clay("0", ", fit = \"plane_strain\""), word), 0);
  EXPECT_EQ(warned(clay("0.3", ""), word), 0);
}

class DoubtfulRecord : public RecordCase {};

/// 9.81 m/s2 as the factor of a record, which is an acceleration, would make it 9.81 times as large.
TEST_F(DoubtfulRecord, HasNoUnitInItsFactor) {
  write_record("a.txt", 0.02, 51, 1);
  const auto text = [&](const std::string& amplitude, const std::string& function) {
    return case_with(
        "[[record]]\nname = \"quake\"\nfile = \"a.txt\"\nunit = \"m/s2\"\n[[function]]\nname = \"f\"\nshape = { type = \"half_sine\", "
        "duration = 1 "
        "}\n[[ground_acceleration]]\nfunction = \"" +
        function + "\"\namplitude = " + amplitude + "\n");
  };
  EXPECT_NE(RecordCase::refusal(text("\"9.81 m/s2\"", "quake")).find("a factor without unit"), std::string::npos)
      << RecordCase::refusal(text("\"9.81 m/s2\"", "quake"));
  for (const char* amplitude : {"9.81", "\"1 m/s2\"", "\"0.5\""})
    EXPECT_EQ(RecordCase::refusal(text(amplitude, "quake")), "accepted") << amplitude;
  EXPECT_EQ(RecordCase::refusal(text("\"9.81 m/s2\"", "f")), "accepted") << "a function has no unit";
}

TEST(DoubtfulInput, FunctionsThatJumpBeforeTheRunEnds) {
  const auto with = [](const std::string& shape) {
    return case_with("[[function]]\nname = \"f\"\nshape = { type = \"table\", " + shape +
                     " }\n[[load]]\nnode = \"top\"\nforce = [1, 0]\nfunction = \"f\"\n");
  };
  EXPECT_EQ(warned(with("times = [0, 0.5], values = [0, 2], outside = \"zero\""), "jumps from 2 to 0 at 0.500 s"), 1);
  EXPECT_EQ(warned(with("times = [0.25, 1], values = [3, 2], outside = \"zero\""), "jumps from 0 to 3 at 0.250 s"), 1);
  EXPECT_EQ(warned(with("times = [0, 1], values = [0, 2], outside = \"zero\""), "jumps"), 0) << "it ends with the run";
  EXPECT_EQ(warned(with("times = [0, 0.5], values = [0, 2]"), "jumps"), 0) << "it holds";
  EXPECT_EQ(warned(with("times = [0, 0.2, 0.5], values = [0, 2, 0], outside = \"zero\""), "jumps"), 0);
}

TEST(DoubtfulInput, UnitsAndMagnitudes) {
  const std::string coulomb = "type = \"springs\", K_n = 1e9, K_t = 1e8, tangential = \"coulomb\", friction = ";
  EXPECT_EQ(warned(case_with("", coulomb + "35"), "not an angle"), 1);
  EXPECT_EQ(warned(case_with("", coulomb + "0.7"), "not an angle"), 0);
  const std::string elastic = "type = \"springs\", K_n = 1e9, K_t = 1e8";
  EXPECT_EQ(warned(case_with("", elastic, {}, "[gravity]\nacceleration = [0, -981]\n"), "on Earth it is 9.81"), 1);
  EXPECT_EQ(warned(case_with("", elastic), "on Earth"), 0);
  EXPECT_EQ(warned(case_with("[damping]\nmodal = [5]\n", elastic), "critical damping"), 1);
  EXPECT_EQ(warned(case_with("[damping]\nmodal = [0.05]\n", elastic), "critical damping"), 0);
  Tower small;
  small.height = "0.005";
  EXPECT_EQ(warned(case_with("", elastic, small), "extends over 0.005 m"), 1);
  Tower light;
  light.mass = "mass = 24", light.footing = "mass = 10\ninertia = 7.5";  // 34 kg x 9.81 over 3 m2: 111 Pa
  EXPECT_EQ(warned(case_with("", elastic, light), "111 Pa"), 1);
  EXPECT_EQ(warned(case_with("", elastic), "floor slab"), 0);
}

TEST(DoubtfulInput, AStageHasAtMostATrillionSteps) {
  std::string text = case_with("");
  text.replace(text.find("step = 0.01"), 11, "step = 1e-13");
  EXPECT_NE(refusal(text).find("at most 1e+12 steps"), std::string::npos) << refusal(text);
}

}  // namespace
}  // namespace uplift::doubtful_input_test
