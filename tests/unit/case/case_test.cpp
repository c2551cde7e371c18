#include "uplift/case/case.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <regex>

#include "tower_case.h"
#include "uplift/case/build/names.h"
#include "uplift/case/schema/case_input.h"
#include "uplift/case/schema/sections.h"
#include "uplift/io/text/toml.h"
#include "uplift/model/builder.h"
#include "uplift/verdict/verdict.h"

namespace uplift::case_test {
namespace {

const std::string base_text =
    "\ntitle = \"test\"" + support::Tower{.young = "\"20000 MPa\"", .mass = "tuned_frequency = \"10 Hz\""}.text() + R"([[interface]]
name = "soil"
[interface.footing]
body = "base"
width = 3
points = 11
[interface.law]
type = "springs"
K_n = 2e8
tangential = "none"
[[load]]
name = "dead"
node = "top"
force = [0, -1e6]
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 1
step = 1e-3
)";

Case read(const std::string& extra = "", const std::string& text = base_text) {
  return check_case(read_toml_text(text + extra, "case.toml"), "case.toml");
}

std::string changed(const std::string& old, const std::string& now) {
  std::string text = base_text;
  const std::size_t at = text.find(old);
  EXPECT_NE(at, text.npos) << old;
  return text.replace(at, old.size(), now);
}

/// Text of the error, empty when there is none.
template <class Action>
std::string complaint(Action action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(Case, TunesTheMassToTheFixedBaseFrequency) {
  const Case file = read();
  const BuiltCase built = build(file, runs_of_case(file).front());
  // M h^3 = 3 E I/(2 pi f)^2: 24 317.0841 kg
  const double mass = 3 * 2e10 * 0.2 / (std::pow(2 * std::numbers::pi * 10, 2) * 125);
  Vector horizontal = Vector::Zero(built.model.full_unknowns());
  horizontal[built.model.at(built.top, ux)] = 1;
  EXPECT_NEAR(horizontal.dot(assembled(built.model, &Local::mass) * horizontal), mass, 1e-9 * mass);
  EXPECT_NEAR(fixed_base_modes(built.model, 1).front().frequency, 10, 1e-9);
}

TEST(Case, FindsTopBaseAndWeight) {
  const Case file = read();
  const BuiltCase built = build(file, runs_of_case(file).front());
  EXPECT_EQ(built.model.nodes[static_cast<std::size_t>(built.top)].name, "top");
  EXPECT_EQ(built.model.nodes[static_cast<std::size_t>(built.base)].name, "base");
  EXPECT_DOUBLE_EQ(built.weight(), 1e6);
  double half_width = 0;
  for (const Place& corner : built.facts.front().corners) half_width = std::max(half_width, std::abs(corner[0]));
  EXPECT_DOUBLE_EQ(half_width, 1.5);
  EXPECT_NEAR(built.facts.front().area, 3, 1e-12);
}

TEST(Case, GravityWeighsAllMasses) {
  const Case file = read("[gravity]\nacceleration = [0, \"-10 m/s2\"]\n", changed("tuned_frequency = \"10 Hz\"", "mass = 3e4"));
  EXPECT_NEAR(build(file, runs_of_case(file).front()).weight(), 1e6 + 10 * (3e4 + 1e4), 1e-3);
}

TEST(Case, AutomaticColumnsAreThoseThatMove) {
  const Case file = read();
  const BuiltCase built = build(file, runs_of_case(file).front());
  std::vector<std::string> names;
  for (const Request& request : built.plan.requests) names.push_back(request.name);
  const auto has = [&](const char* name) { return std::find(names.begin(), names.end(), name) != names.end(); };
  EXPECT_TRUE(has("top.ux") && has("top.vx") && has("base.rz") && has("soil.moment") && has("soil.max_opening") && has("energy.residual"));
  EXPECT_FALSE(has("base.ux"));     // supported
  EXPECT_FALSE(has("soil.shear"));  // the law has no tangential part
}

TEST(Case, RequestedColumns) {
  const Case file = read(
      "[output]\nautomatic = false\nenergies = false\n[[output.history]]\nnode = \"top\"\nquantity = \"ax\"\nname = \"a\"\n"
      "[[output.history]]\ninterface = \"soil\"\npoint = 3\nquantity = \"mean_traction\"\n");
  const BuiltCase built = build(file, runs_of_case(file).front());
  ASSERT_EQ(built.plan.requests.size(), 2u);
  EXPECT_EQ(built.plan.requests[0].name, "a");
  EXPECT_EQ(built.plan.requests[0].kind, Request::Kind::acceleration);
  EXPECT_EQ(built.plan.requests[0].unit, "m/s2");
  EXPECT_EQ(built.plan.requests[1].name, "soil.3.mean_traction");
  EXPECT_EQ(built.plan.requests[1].point, 2);
  EXPECT_EQ(built.plan.requests[1].unit, "Pa");
}

TEST(Case, RayleighFromOneAndTwoPairs) {
  for (const bool two : {false, true}) {
    const Case file = read(two ? "[damping]\nrayleigh = [{frequency = 2, ratio = 0.03}, {frequency = 20, ratio = 0.05}]\n"
                               : "[damping]\nrayleigh = [{frequency = 10, ratio = 0.02}]\n");
    const Model model = build(file, runs_of_case(file).front()).model;
    // ratio(w) = alpha/(2 w) + beta w/2
    double alpha = 0, beta = 2 * 0.02 / (2 * std::numbers::pi * 10);
    if (two) {
      const double w1 = 4 * std::numbers::pi, w2 = 40 * std::numbers::pi;
      beta = 2 * (0.05 * w2 - 0.03 * w1) / (w2 * w2 - w1 * w1);
      alpha = 2 * 0.03 * w1 - beta * w1 * w1;
    }
    const Sparse expected = alpha * model.mass + beta * model.stiffness;
    EXPECT_LT((Matrix(expected) - Matrix(model.damping)).norm(), 1e-12 * Matrix(expected).norm());
  }
}

TEST(Case, BondedRunKeepsTheClosedStiffness) {
  const Case file = read();
  const std::vector<RunSpec> runs = runs_of_case(file);
  ASSERT_EQ(runs.size(), 2u);
  const BuiltCase built = build(file, runs[1]);
  EXPECT_EQ(built.behaviours.front()->type(), "elastic");
  double stiffness = 0;
  built.model.interfaces.front().law->closed_stiffness(1, &stiffness);
  EXPECT_DOUBLE_EQ(stiffness, 2e8);
}

TEST(Case, BondedRunKeepsTheDashpots) {
  const Case file = read("[[variant]]\nname = \"damped\"\nlaw = {type = \"springs\", K_n = 1e8, c = 3e5, tangential = \"none\"}\n");
  RunSpec spec = comparison_of_case(file).runs.front();
  spec.bonded = true;
  const BuiltCase built = build(file, spec);
  EXPECT_EQ(built.behaviours.front()->type(), "elastic");
  EXPECT_DOUBLE_EQ(built.behaviours.front()->number("c"), 3e5);
}

/// The bonded reference is connected as drawn: closing the gap of a stop by force would prestress it.
TEST(Case, BondedRunHasNoGaps) {
  const auto peak = [](const std::string& gap) {
    const std::string text =
        "title = \"stop\"\n[nodes]\nbase = [0, 0]\ntop = [0, 8]\n[[beam]]\nname = \"column\"\nnodes = [\"base\", \"top\"]\nE = 3e10\nA = "
        "1\n"
        "I = 0.1\n[[mass]]\nnode = \"top\"\nmass = 1e5\ninertia = 1e4\n[[rigid]]\nnode = \"base\"\nmass = 1e5\ninertia = 1e5\n[[support]]\n"
        "node = \"base\"\nfixed = [\"ux\"]\n[gravity]\nacceleration = [0, -9.81]\n[[interface]]\nname = \"soil\"\nfooting = { body = "
        "\"base\", "
        "width = 5, points = 11 }\nlaw = { type = \"springs\", K_n = 6e7, tangential = \"none\" }\n[[interface]]\nname = \"stop\"\nrole = "
        "\"wall\"\n" +
        gap +
        "pairs = { upper = [\"top\"], normal = [1, 0], area = 1 }\nlaw = { type = \"springs\", K_n = 1e8, tangential = \"none\" "
        "}\n[[function]]\n"
        "name = \"pulse\"\nshape = { type = \"half_sine\", duration = 0.1 }\n[[load]]\nname = \"push\"\nnode = \"top\"\nforce = [3e5, 0]\n"
        "function = \"pulse\"\n[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\nduration = 0.3\nstep = 1e-3\n";
    const Case file = check_case(read_toml_text(text, "case.toml"), "case.toml");
    const BuiltCase built = build(file, runs_of_case(file)[1]);
    const RunResult result = run(built.model, built.plan, built.behaviours);
    EXPECT_EQ(result.status, RunStatus::completed) << result.reason;
    return std::abs(find_peak(result, Request::Kind::displacement, built.top_sway())->value);
  };
  const double without = peak("");
  ASSERT_GT(without, 1e-5);
  EXPECT_NEAR(peak("gap = 0.05\n"), without, 1e-12 * without);
}

/// A block that is turned, or turns, on constraints: the bonded joint, a thousand times as stiff as the structure, would fling it away.
TEST(Case, BondedRunOfAConstraintLeavesOutWhatOpensIt) {
  const std::string text =
      "title = \"block\"\n[nodes]\nc = [0, 2]\n[[rigid]]\nnode = \"c\"\nmass = 1e4\ninertia = 1.4e4\n[gravity]\nacceleration = [0, "
      "-9.81]\n[[interface]]\n"
      "name = \"j\"\nfooting = { body = \"c\", width = 1, points = 2, offset = [0, -2] }\nlaw = { type = \"coulomb\", friction = 5 }\n"
      "[[initial]]\nnode = \"c\"\ndisplacement = [-0.2, 0.05]\nrotation = 0.1\nangular_velocity = 0.5\n[[stage]]\ntype = "
      "\"dynamic\"\nduration = 0.01\nstep = "
      "1e-4\n";
  const Case file = check_case(read_toml_text(text, "case.toml"), "case.toml");
  const std::vector<RunSpec> runs = runs_of_case(file);
  EXPECT_GT(build(file, runs[0]).plan.initial_displacement.norm(), 0.1);
  EXPECT_DOUBLE_EQ(build(file, runs[0]).plan.initial_velocity.norm(), 0.5);
  EXPECT_EQ(build(file, runs[1]).plan.initial_displacement.size(), 0);
  EXPECT_EQ(build(file, runs[1]).plan.initial_velocity.size(), 0);
}

TEST(Case, TractionAtTheEndOfTheStepLosesNoVelocityInASoftJoint) {
  // An impact rule is for constraints. On a linear joint average acceleration and the path average are one scheme.
  const auto top = [](const char* traction, double step) {
    std::string text = base_text;
    text += fmt::format("traction = \"{}\"\n", traction);
    text = std::regex_replace(text, std::regex("type = \"springs\""), "type = \"elastic\"");
    text = std::regex_replace(text, std::regex("step = 1e-3"), fmt::format("step = {}", step));
    text +=
        "[[function]]\nname = \"pulse\"\nshape = { type = \"half_sine\", duration = 0.1 }\n[[load]]\nname = \"push\"\nnode = \"top\"\n"
        "force = [3e4, 0]\nfunction = \"pulse\"\n";
    const Case file = check_case(read_toml_text(text, "case.toml"), "case.toml");
    const BuiltCase built = build(file, runs_of_case(file).front());
    const RunResult result = run(built.model, built.plan, built.behaviours);
    return std::abs(find_peak(result, Request::Kind::displacement, built.top_sway())->value);
  };
  ASSERT_GT(top("path", 1e-3), 1e-4);
  EXPECT_NEAR(top("end", 1e-3), top("path", 1e-3), 1e-9 * top("path", 1e-3));
}

TEST(Case, SweepReachesTheWantedStiffnessRatio) {
  const Case file = read(
      "[[variant]]\nname = \"a\"\n[compare.stiffness_sweep]\nlaw = {type = \"springs\", K_n = 1e8, tangential = \"none\"}\nratios = [0.01, "
      "100]\n");
  const Comparison comparison = comparison_of_case(file);
  ASSERT_EQ(comparison.sweep.size(), 4u);
  for (const RunSpec& spec : comparison.sweep) {
    const BuiltCase built = build(file, spec);
    const auto ratios = stiffness_ratios(built.model, *dynamic_stage(built.plan), *built.plan.solver);
    EXPECT_NEAR(ratios.front().most, *spec.stiffness_ratio, 1e-9 * *spec.stiffness_ratio);
    EXPECT_EQ(dynamic_stage(built.plan)->path_average, *spec.path_average);
  }
}

TEST(Case, VariantsAreCrossedWithDampings) {
  const Case file = read(
      "[[variant]]\nname = \"a\"\n[[variant]]\nname = \"b\"\ntraction = \"end\"\nstep = 2e-3\nexpected = \"may_fail\"\n"
      "[[compare.damping]]\nname = \"damped\"\nlabel = \"2 %\"\nbeta = 1e-3\n[[compare.damping]]\nname = \"undamped\"\n");
  const Comparison comparison = comparison_of_case(file);
  std::vector<std::string> names;
  for (const RunSpec& spec : comparison.runs) names.push_back(spec.name + "/" + spec.group);
  EXPECT_EQ(names, (std::vector<std::string>{"a-damped/2 %", "b-damped/2 %", "bonded-damped/2 %", "a-undamped/undamped",
                                             "b-undamped/undamped", "bonded-undamped/undamped"}));
  const BuiltCase built = build(file, comparison.runs[1]);
  EXPECT_FALSE(dynamic_stage(built.plan)->path_average);
  EXPECT_EQ(dynamic_stage(built.plan)->step, 2e-3);
  EXPECT_TRUE(built.plan.expected_to_fail);
  EXPECT_GT(Matrix(built.model.damping).norm(), 0);
  EXPECT_EQ(Matrix(build(file, comparison.runs[4]).model.damping).norm(), 0);
}

TEST(Case, OtherSchemesTakeTheEndOfTheStep) {
  const Case file = read("", changed("step = 1e-3", "step = 1e-3\nscheme = \"hht\""));
  EXPECT_FALSE(dynamic_stage(build(file, runs_of_case(file).front()).plan)->path_average);
}

TEST(Case, InitialConditionsReachTheFreeUnknowns) {
  const Case file = read("[[initial]]\nnode = \"top\"\ndisplacement = [0.01, 0]\nvelocity = [0.5, 0]\n");
  const BuiltCase built = build(file, runs_of_case(file).front());
  EXPECT_NEAR(built.model.full(built.top_sway(), built.plan.initial_displacement, 0, 0), 0.01, 1e-14);
  EXPECT_NEAR(built.model.full(built.top_sway(), built.plan.initial_velocity, 0, 0), 0.5, 1e-14);
}

TEST(Case, BedMakesNodesOfItsOwn) {
  const Case file = read("", changed("points = 11\n", "points = 11\nbed = { stiffness = 1e8, mass = 50 }\n"));
  const BuiltCase built = build(file, runs_of_case(file).front());
  EXPECT_EQ(built.model.nodes.size(), 2u + 11u);
  // Rigid translation of the bed against the ground: stiffness x area
  double sum = 0;
  for (std::size_t node = 2; node < built.model.nodes.size(); ++node) {
    const int row = built.model.at(static_cast<int>(node), uy);
    sum += assembled(built.model, &Local::stiffness).coeff(row, row);
  }
  EXPECT_NEAR(sum, 1e8 * 3, 1e-3);
}

TEST(Case, NamesAreCheckedWithTheirPlace) {
  Names names("node");
  names.add("top", {"f", 3}, "nodes.top");
  EXPECT_EQ(complaint([&] {
              names.add("top", {"f", 5}, "x");
            }),
            "f:5: x: expected a name that no other node has, found \"top\", which line 3 uses already");
  EXPECT_EQ(complaint([&] {
              names.find("tpo", {"f", 7}, "y");
            }),
            "f:7: y: expected the name of a node, found \"tpo\" (did you mean \"top\"?)");
}

TEST(Case, ExactlyOnePlaceOfAnInterface) {
  const std::string text = changed("[interface.law]", "[interface.pairs]\nupper = [\"base\"]\narea = 1\n[interface.law]");
  EXPECT_NE(complaint([&] { read("", text); }).find("expected exactly one of footing, pairs, line, surface and cut, found 2"),
            std::string::npos);
}

/// Structs hold what their tables say in SI units, and point to them also after the case has moved.
TEST(Case, StructsOfItsTablesMoveWithTheCase) {
  Case first =
      read("[[support]]\nnode = \"top\"\nfixed = [\"ux\"]\nstages = \"static\"\n", changed("force = [0, -1e6]", "force = [0, \"-20 kN\"]"));
  const Case file = std::move(first);
  const CaseInput& input = *file.input;
  ASSERT_EQ(input.loads.size(), 1u);
  EXPECT_EQ(*input.loads[0].force, Vec3(0, -20e3, 0));
  EXPECT_FALSE(input.loads[0].function);
  ASSERT_EQ(input.interfaces.size(), 1u);
  ASSERT_NE(input.interfaces[0].footing(), nullptr);
  EXPECT_EQ(input.interfaces[0].footing()->points, 11);
  EXPECT_EQ(input.interfaces[0].cut(), nullptr);
  const CaseSupport& support = input.supports.back();
  EXPECT_TRUE(support.statics_only);
  EXPECT_EQ(support.of.node->path(), fmt::format("support[{}].node", input.supports.size() - 1));
  EXPECT_EQ(support.where("stages").line, support.where().line + 3);
  EXPECT_EQ(input.stages[0].step, std::nullopt);
  EXPECT_EQ(input.stages[1].step, 1e-3);
}

TEST(Case, ANodeAndAGroupAreRefusedTogether) {
  EXPECT_NE(complaint([&] {
              read("[[support]]\nnode = \"top\"\ngroup = \"raft\"\nfixed = [\"ux\"]\n");
            }).find("support[1].group: expected either node or group, found both"),
            std::string::npos);
}

TEST(Case, EveryKeyOfTheDeclarationHasAMeaning) {
  const std::function<void(const Section&)> look = [&](const Section& section) {
    EXPECT_FALSE(section.meaning.empty()) << section.name;
    for (const Field& field : section.fields) {
      EXPECT_FALSE(field.meaning.empty()) << section.name << "." << field.name;
      if (field.kind == Kind::number || field.kind == Kind::numbers) EXPECT_FALSE(field.unit.empty()) << section.name << "." << field.name;
      if (field.section) look(*field.section);
    }
  };
  look(case_section());
}

}  // namespace
}  // namespace uplift::case_test
