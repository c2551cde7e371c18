// Inputs that would do nothing, or something else than what is meant, without a word: refused or warned of.
#include <algorithm>

#include "text_support.h"
#include "unit/verdict/verdict_support.h"
#include "uplift/verdict/verdict.h"

namespace uplift::idle_input_test {
namespace {

const std::string footing =
    "title = \"footing\"\n[nodes]\nbase = [0, 0]\n[[rigid]]\nname = \"footing\"\nnode = \"base\"\nmass = 1e4\ninertia = 7500\n"
    "[[interface]]\nname = \"soil\"\nfooting = { body = \"base\", width = 3, points = 21 }\n"
    "law = { type = \"springs\", K_n = 2e8, K_t = 1e8, tangential = \"bonded\" }\n";
const std::string weight = "[gravity]\nacceleration = [0, -9.81]\n", statics = "[[stage]]\ntype = \"static\"\n";
const std::string dynamics = "[[stage]]\ntype = \"dynamic\"\nduration = 0.1\nstep = 0.01\n";

/// All warnings of a case, one per line.
std::string warnings_of(const std::string& text) {
  const Case file = check_case(read_toml_text(text, "case.toml"), "case.toml");
  const RunSpec spec = runs_of_case(file).front();
  std::string all;
  for (const std::string& warning : warnings(file, spec, build(file, spec))) all += warning + "\n";
  return all;
}

bool warns(const std::string& text, const std::string& of) {
  return warnings_of(text).find(of) != std::string::npos;
}

TEST(IdleInput, AGapProfileBesideTheFooting) {
  const auto with = [](const std::string& positions) {
    return support::refusal_of([&] {
      support::built_of(
          support::replaced(footing, "law = ", "gap_profile = { along = \"x\", positions = " + positions + ", gaps = [0, 1e-3] }\nlaw = ") +
          weight + statics);
    });
  };
  EXPECT_EQ(with("[0, 1]"), "accepted");
  EXPECT_EQ(with("[1.5, 4]"), "accepted");  // touches the edge
  EXPECT_NE(with("[1.6, 4]").find("positions that reach the surface, which lies from x = -1.5 to 1.5 m"), std::string::npos)
      << with("[1.6, 4]");
  EXPECT_NE(with("[1.6, 4]").find("1.6 to 4 m"), std::string::npos);
  EXPECT_NE(with("[-3000, -1500]").find("case.toml:"), std::string::npos);
}

TEST(IdleInput, LoadsWithAFunctionInStaticStagesAlone) {
  const std::string push =
      "[[function]]\nname = \"pulse\"\nshape = { type = \"harmonic\", frequency = 2 }\n"
      "[[load]]\nnode = \"base\"\nforce = [1e4, 0]\nfunction = \"pulse\"\n";
  EXPECT_TRUE(warns(footing + weight + push + statics, "this [[load]] has no effect"));
  EXPECT_FALSE(warns(footing + weight + push + statics + dynamics, "has no effect"));
  EXPECT_FALSE(warns(footing + weight + "[[load]]\nnode = \"base\"\nforce = [1e4, 0]\n" + statics, "has no effect"));
}

TEST(IdleInput, SecondOrderWhereNothingMakesIt) {
  const std::string second_order = "p_delta = true\n";
  EXPECT_FALSE(warns(footing + weight + statics + second_order, "p_delta has no effect"));
  EXPECT_TRUE(warns(footing + weight + dynamics + second_order, "p_delta has no effect here: no static stage comes before"));
  EXPECT_FALSE(warns(footing + weight + statics + dynamics + second_order, "p_delta has no effect"));
}

const std::string shaking =
    "[[function]]\nname = \"r\"\nshape = { type = \"ricker\", frequency = 20 }\n[[ground_acceleration]]\nfunction = \"r\"\n";

TEST(IdleInput, NothingDrivesADynamicStage) {
  const std::string word = "nothing drives the dynamic stage";
  EXPECT_TRUE(warns(footing + weight + statics + dynamics, word));
  EXPECT_FALSE(warns(footing + weight + shaking + statics + dynamics, word));
  EXPECT_FALSE(warns(footing + weight + dynamics, word)) << "the weight acts suddenly";
  EXPECT_FALSE(warns(footing + weight + "[[initial]]\nnode = \"base\"\nvelocity = [0, 0.1]\n" + statics + dynamics, word));
}

TEST(IdleInput, ABodyThatASupportHolds) {
  const auto held = [](const std::string& fixed) {
    return footing + weight + shaking + "[[support]]\nnode = \"base\"\nfixed = [" + fixed + "]\n" + statics + dynamics;
  };
  EXPECT_TRUE(warns(held("\"ux\", \"uy\", \"rz\""), "the body base of the base \"soil\" is held (uy, rz)"));
  EXPECT_TRUE(warns(held("\"rz\""), "is held (rz)"));
  EXPECT_FALSE(warns(held("\"ux\""), "is held"));
  EXPECT_FALSE(warns(footing + weight + shaking + statics + dynamics, "is held"));
}

/// Half of a symmetric model and a plane motion hold one rocking axis, and the base rocks about the other.
TEST(IdleInput, ABodyInSpaceThatASupportHolds) {
  const auto held = [](const std::string& fixed) {
    return "title = \"raft\"\n[nodes]\nbase = [0, 0, 0]\n[[rigid]]\nname = \"raft\"\nnode = \"base\"\nmass = 2e4\ninertias = [5e4, 8e4, "
           "1.2e5]\n[[interface]]\nname = \"soil\"\nfooting = { body = \"base\", width = 6, length = 4, points = 7, points_across = 5 }\n"
           "law = { type = \"springs\", K_n = 5e7, K_t = 2e7, tangential = \"bonded\" }\n[gravity]\nacceleration = [0, 0, -9.81]\n"
           "[[support]]\nnode = \"base\"\nfixed = [" +
           fixed + "]\n" + statics;
  };
  EXPECT_FALSE(warns(held("\"uy\", \"rx\", \"rz\""), "is held"));
  EXPECT_FALSE(warns(held("\"ux\", \"ry\", \"rz\""), "is held"));
  EXPECT_TRUE(warns(held("\"ux\", \"rx\", \"ry\", \"rz\""), "is held (rx, ry)"));
  EXPECT_TRUE(warns(held("\"ux\", \"uz\", \"rx\""), "is held (uz)"));
}

TEST(IdleInput, TheSameTwice) {
  const std::string second =
      "[[interface]]\nname = \"again\"\nfooting = { body = \"base\", width = 3, points = 21 }\nlaw = { type = \"springs\", K_n = 1e8 }\n";
  const std::string place = "stand at the same place under the body base", load = "[[load]]\nnode = \"base\"\nforce = [1e3, 0]\n",
                    mass = "[[mass]]\nnode = \"base\"\nmass = 1e3\n", rest = footing + weight + shaking + statics + dynamics;
  EXPECT_TRUE(warns(rest + second, place));
  EXPECT_FALSE(warns(rest + support::replaced(second, "points = 21", "points = 21, offset = [5, 0]"), place));
  EXPECT_FALSE(warns(rest + support::replaced(second, "width = 3", "width = 1"), place)) << "a pad inside a wider one";
  EXPECT_FALSE(warns(rest + support::replaced(second, "points = 21", "points = 11"), place));
  EXPECT_FALSE(warns(rest + load + mass, "both act"));
  EXPECT_TRUE(warns(rest + load + load, "this [[load]] is the same as that of line"));
  EXPECT_FALSE(warns(rest + load + support::replaced(load, "1e3", "2e3"), "both act"));
  EXPECT_TRUE(warns(rest + mass + mass, "this [[mass]] is the same as that of line"));
  EXPECT_TRUE(warns(rest + "[[ground_acceleration]]\nfunction = \"r\"\n", "this [[ground_acceleration]] is the same as"));
}

TEST(IdleInput, ANegativeGap) {
  EXPECT_TRUE(warns(support::replaced(footing, "law = ", "gap = -2e-3\nlaw = ") + weight + statics, "its sides overlap by up to 2.00 mm"));
  EXPECT_FALSE(warns(support::replaced(footing, "law = ", "gap = 2e-3\nlaw = ") + weight + statics, "overlap"));
}

/// W = 1: under n points at the ends and evenly between them, of B/(n - 1) and half of it, the second moment of area is B^2/12 (1 + 2/(n -
/// 1)^2) and the farthest point stands at B/2; a base opens at W I/x, a strip on springs at W B/6. Midpoints: 1 - 1/n^2 at (n - 1) B/(2 n).
TEST(IdleInput, TwoOrThreePoints) {
  const auto with = [](const std::string& points, const std::string& law = "type = \"springs\", K_n = 2e8, K_t = 1e8") {
    return support::replaced(support::replaced(footing, "points = 21", "points = " + points),
                             "type = \"springs\", K_n = 2e8, K_t = 1e8, tangential = \"bonded\"", law) +
           weight + statics;
  };
  const std::string opens = "on springs the moment at which a rectangle opens comes out ";
  EXPECT_TRUE(warns(with("2"), opens + "200 % too large, its rocking stiffness 200 % too large"));
  EXPECT_TRUE(warns(with("3"), opens + "50 % too large, its rocking stiffness 50 % too large"));
  EXPECT_TRUE(warns(with("3, rule = \"midpoint\""), opens + "33 % too large, its rocking stiffness 11 % too small"));
  EXPECT_TRUE(warns(with("2, rule = \"gauss\""), opens + "73 % too large, and"));  // sqrt 3 - 1
  EXPECT_FALSE(warns(with("4"), opens));
  EXPECT_FALSE(warns(with("2", "type = \"coulomb\", friction = 0.6"), "2 points")) << "a rigid block on its two corners";
  EXPECT_TRUE(warns(with("2, rule = \"gauss\"", "type = \"coulomb\", friction = 0.6"), "the moment that overturns it is 42 % too small"));
}

TEST(IdleInput, AMotionOfNoSize) {
  const std::string still = "[[motion]]\nnode = \"base\"\ndirection = \"uy\"\namplitude = 0\n";
  EXPECT_TRUE(warns(footing + still + statics, "has no effect: its amplitude is 0"));
  EXPECT_FALSE(warns(footing + still + statics, "its function"));
}

TEST(IdleInput, ABaseThatAMotionPresses) {
  const std::string pressed = "[[motion]]\nnode = \"base\"\ndirection = \"uy\"\namplitude = -1e-3\n";
  EXPECT_FALSE(warns(footing + pressed + statics, "[gravity] is missing"));
  EXPECT_TRUE(warns(footing + shaking + statics + dynamics, "[gravity] is missing"));
}

TEST(IdleInput, AMotionThatIsZeroInStaticStages) {
  const auto moved = [](const std::string& shape) {
    return "[[function]]\nname = \"f\"\nshape = { type = \"harmonic\", frequency = 2" + shape +
           " }\n[[motion]]\nnode = \"base\"\ndirection = \"uy\"\namplitude = -1e-3\nfunction = \"f\"\n";
  };
  EXPECT_TRUE(warns(footing + moved("") + statics, "has no effect: static stages apply the value that its function has at t = 0"));
  EXPECT_FALSE(warns(footing + moved("") + statics + dynamics, "has no effect"));
  EXPECT_FALSE(warns(footing + "[[motion]]\nnode = \"base\"\ndirection = \"uy\"\namplitude = -1e-3\n" + statics, "has no effect"));
}

TEST(IdleInput, AFunctionWhoseTimeIsOutsideTheRun) {
  const auto shaken = [](const std::string& shape) {
    return footing + weight + "[[function]]\nname = \"f\"\nshape = { " + shape +
           " }\n[[ground_acceleration]]\nname = \"quake\"\ndirection = [1, 0]\namplitude = 3\nfunction = \"f\"\n" + statics + dynamics;
  };
  const std::string word = "the load \"quake\" is zero during all 0.100 s of the dynamic stages";
  EXPECT_TRUE(warns(shaken("type = \"ricker\", frequency = 2, delay = 1000"), word));
  EXPECT_TRUE(warns(shaken("type = \"half_sine\", duration = 0.1, start = -0.2"), word));
  EXPECT_TRUE(warns(shaken("type = \"table\", times = [100, 101, 102], values = [0, 1, 0]"), word));
  EXPECT_TRUE(warns(shaken("type = \"harmonic\", frequency = 2, start = 0.1"), word)) << "it begins when the run ends";
  EXPECT_FALSE(warns(shaken("type = \"harmonic\", frequency = 2, start = 0.09"), "is zero during"));
  EXPECT_FALSE(warns(shaken("type = \"half_sine\", duration = 0.1, start = -0.05"), "is zero during"));
  EXPECT_FALSE(warns(shaken("type = \"half_sine\", duration = 3e-4, start = 0.04985"), "is zero during")) << "it acts on one step alone";
  EXPECT_FALSE(warns(shaken("type = \"harmonic\", frequency = 50"), "is zero during")) << "it is zero at every step of 0.01 s";
}

TEST(IdleInput, WeightThatComesSuddenly) {
  EXPECT_TRUE(warns(footing + weight + dynamics, "the weight acts suddenly at t = 0"));
  EXPECT_FALSE(warns(footing + weight + statics + dynamics, "suddenly"));
  EXPECT_FALSE(warns(footing + "[[load]]\nnode = \"base\"\nforce = [1e4, 0]\n" + dynamics, "suddenly"));
}

TEST(IdleInput, ADurationThatIsNoWholeNumberOfSteps) {
  const auto stage = [](const char* duration, const char* step) {
    return std::string("[[stage]]\ntype = \"dynamic\"\nduration = ") + duration + "\nstep = " + step + "\n";
  };
  EXPECT_TRUE(
      warns(footing + weight + statics + stage("0.1", "0.03"),
            "stage 2: the duration of 0.1 s is not a whole number of steps of 0.03 s; the stage has 3 steps and ends after 0.09 s"));
  for (const auto& [duration, step] : {std::pair{"0.1", "0.01"}, {"20", "1e-3"}, {"0.3", "0.1"}, {"53.74", "0.02"}})
    EXPECT_FALSE(warns(footing + weight + statics + stage(duration, step), "whole number")) << duration;
}

TEST(IdleInput, SuspiciousMagnitudes) {
  const auto water = [](const std::string& more) {
    return support::replaced(footing, "law = ", "water = { head = 1" + more + " }\nlaw = ") + weight + statics;
  };
  EXPECT_TRUE(warns(water(", unit_weight = 9.81"), "unit_weight = 9.81 N/m3 is unusual for a structure (water has 9810 N/m3"));
  EXPECT_FALSE(warns(water(", unit_weight = 10000"), "unit_weight"));
  EXPECT_FALSE(warns(water(", unit_weight = \"9.81 kN/m3\""), "unit_weight"));
  EXPECT_FALSE(warns(water(""), "unit_weight"));
  const auto gap = [](const std::string& value) { return support::replaced(footing, "law = ", "gap = " + value + "\nlaw = ") + dynamics; };
  EXPECT_TRUE(warns(gap("100"), "interface \"soil\": an initial gap of 100 m in a model of 3.00 m"));
  EXPECT_FALSE(warns(gap("\"100 mm\""), "initial gap"));
}

TEST(IdleInput, AStepCheckThatIsNotMadeSaysWhy) {
  const auto sentence = [](const std::string& text) {
    const BuiltCase built = support::built_of(text);
    return judge(built, support::run_of(built), nullptr).step_check.sentence();
  };
  const std::string three = "[[stage]]\ntype = \"dynamic\"\nduration = 0.03\nstep = 0.01\n";
  EXPECT_EQ(sentence(footing + weight + statics + three), "Error of the time step: not examined (a dynamic stage has fewer than 4 steps).");
  EXPECT_EQ(sentence(footing + weight + statics + dynamics), "Error of the time step: not examined.");
}

}  // namespace
}  // namespace uplift::idle_input_test
