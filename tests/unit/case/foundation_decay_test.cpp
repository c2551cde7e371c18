// [[foundation]] with the scheme of filtered energy decay, in whole runs (docs/theory/macro_element.md, "Energy decay").
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "ran_support.h"
#include "text_support.h"
#include "uplift/run/run_state.h"

namespace uplift::foundation_decay_test {
namespace {

using support::Ran;

constexpr const char* uplifting = "{ type = \"macro_element\", shape_number = 6, K_v = 6e8, K_h = 3e8, K_r = 1.8e9 }";
constexpr const char* yielding =
    "{ type = \"macro_element\", shape_number = 6, K_v = 6e8, K_h = 3e8, K_r = 1.8e9, V_s = 4e6, V_u = 6e6, w_ref = "
    "0.02, friction_angle = \"30 deg\" }";

/// A mass on a column over a footing on the ground that a pulse lifts: 1.28 MN.
struct Pier {
  bool space = false;
  std::string model = uplifting, amplitude = "4", damping = "alpha = 0.1", more = {}, stages = stage("2e-3", "1"), in_space = ", K_t = 1e9";

  static std::string stage(const std::string& step, const std::string& duration, const std::string& scheme = "energy_decay") {
    return "[[stage]]\ntype = \"dynamic\"\nduration = " + duration + "\nstep = " + step + "\nscheme = \"" + scheme + "\"\n";
  }

  std::string text() const {
    std::string ground =
        model.empty() ? "" : "[[foundation]]\nname = \"soil\"\nbody = \"base\"\nwidth = 6\nlength = 5\nmodel = " + model + "\n";
    if (space && !model.empty()) ground.insert(ground.rfind(" }"), in_space);
    return std::string("title = \"pier\"\n[nodes]\n") +
           (space ? "base = [0, 0, 0]\ntop = [0, 0, 10]\n" : "base = [0, 0]\ntop = [0, 10]\n") +
           "[[mass]]\nnode = \"top\"\nmass = 100e3\ninertia = 1e5\n[[beam]]\nname = \"column\"\nnodes = [\"base\", \"top\"]\nE = 3e10\nA = "
           "1\n" +
           (space ? "I_y = 0.2\nI_z = 0.2\nJ = 0.3\n" : "I = 0.2\n") + "[[rigid]]\nname = \"footing\"\nnode = \"base\"\nmass = 30e3\n" +
           (space ? "inertias = [60e3, 60e3, 100e3]\n" : "inertia = 60e3\n") + ground + more + "[gravity]\n" +
           (damping.empty() ? "" : "[damping]\n" + damping + "\n") +
           "[[function]]\nname = \"pulse\"\nshape = { type = \"half_sine\", duration = 0.4 }\n[[ground_acceleration]]\nfunction = "
           "\"pulse\"\n" +
           "amplitude = " + amplitude + "\n" + (space ? "direction = [0.8, 0.6, 0]\n" : "") + "[[stage]]\ntype = \"static\"\n" + stages +
           "[output]\nframes = 0\nenergies = true\n" + history("top", "ux") + history("base", "ux") + history("base", space ? "uz" : "uy") +
           history("base", space ? "ry" : "rz") + (space ? history("top", "uy") + history("base", "rx") : "");
  }
  static std::string history(const std::string& node, const std::string& quantity) {
    return "[[output.history]]\nnode = \"" + node + "\"\nquantity = \"" + quantity + "\"\n";
  }
};

Ran run_text(const std::string& text) {
  Ran made = support::run_text(text);
  EXPECT_EQ(made.result.status, RunStatus::completed) << made.result.reason;
  return made;
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

/// The ledger closes at every row; neither the filters nor the ground give energy back.
void expect_closed(const Ran& ran) {
  const double size = ran.result.energy_scale;
  EXPECT_LT(largest(ran["energy.residual"]), 1e-10 * size);
  for (const char* name : {"energy.algorithmic", "energy.interface_dissipated"}) {
    const std::vector<double>& lost = ran[name];
    for (std::size_t i = 1; i < lost.size(); ++i) ASSERT_GE(lost[i] - lost[i - 1], -1e-13 * size) << name << ' ' << i;
  }
  for (const double stored : ran["energy.filter"]) ASSERT_GE(stored, 0);
  EXPECT_GT(ran["energy.algorithmic"].back(), 0);
}

TEST(FoundationDecay, TheLedgerClosesWithUpliftAndYieldingAtAnyStep) {
  for (const bool space : {false, true})
    for (const char* model : {uplifting, yielding})
      for (const char* step : {"1e-3", "5e-3", "20e-3"}) {
        SCOPED_TRACE(std::string(space ? "space " : "plane ") + model + " " + step);
        const Ran ran = run_text(Pier{.space = space, .model = model, .amplitude = "6", .stages = Pier::stage(step, "1")}.text());
        expect_closed(ran);
        EXPECT_GT(ran.result.max_uplifted_ratio.value, model == yielding ? 0.05 : 0.2);
        if (model == yielding) EXPECT_GT(ran.result.final_energy.interface_dissipated, 0.02 * ran.result.energy_scale);
      }
}

TEST(FoundationDecay, TheLedgerClosesForEverySurfaceAndFlow) {
  const std::string elastic = "{ type = \"macro_element\", K_v = 6e8, K_h = 3e8, K_r = 1.8e9, V_s = 3e6, ";
  for (const char* more : {"flow = \"associated\" }", "surface = \"power_law\", a = 0.5, b = 0.5, c = 0.9, d = 0.9, e = 0.9, f = 0.9 }",
                           "surface = \"en_1998_5\", soil_type = \"cohesive\" }", "friction_angle = 0.0, cohesion = 20e3 }"}) {
    SCOPED_TRACE(more);
    const Ran ran = run_text(Pier{.model = elastic + more, .amplitude = "5", .stages = Pier::stage("5e-3", "1")}.text());
    expect_closed(ran);
    EXPECT_GT(ran.result.final_energy.interface_dissipated, 0.01 * ran.result.energy_scale);
  }
}

/// Stiffness-proportional damping acts in springs, not in foundations: alpha alone. Springs are elements of the structure, whose filter is
/// that of the bulk.
TEST(FoundationDecay, WhileNothingLiftsItIsThatOfLinearSprings) {
  const auto spring = [](const std::string& direction, const std::string& kind, const std::string& value) {
    return "[[spring]]\nnodes = [\"base\"]\n" + direction + kind + " = " + value + "\n";
  };
  for (const bool space : {false, true}) {
    Pier pier{.space = space, .amplitude = "0.3"};
    pier.in_space = ", K_h2 = 2e8, K_r2 = 1e9, K_t = 3e9";
    const Ran element = run_text(pier.text());
    pier.model = "{ type = \"elastic\", K_v = 6e8, K_h = 3e8, K_r = 1.8e9 }";
    const Ran elastic = run_text(pier.text());
    pier.model.clear();
    pier.more = space ? spring("direction = [1, 0, 0]\n", "stiffness", "3e8") + spring("direction = [0, 1, 0]\n", "stiffness", "2e8") +
                            spring("direction = [0, 0, 1]\n", "stiffness", "6e8") +
                            spring("direction = [1, 0, 0]\n", "rotational_stiffness", "1e9") +
                            spring("direction = [0, 1, 0]\n", "rotational_stiffness", "1.8e9") +
                            spring("direction = [0, 0, 1]\n", "rotational_stiffness", "3e9")
                      : spring("direction = [1, 0]\n", "stiffness", "3e8") + spring("direction = [0, 1]\n", "stiffness", "6e8") +
                            spring("", "rotational_stiffness", "1.8e9");
    const Ran springs = run_text(pier.text());
    EXPECT_EQ(element.result.max_uplifted_ratio.value, 0);
    for (const std::string name : {"top.ux", "base.ux", space ? "base.uz" : "base.uy", space ? "base.ry" : "base.rz"}) {
      const double size = largest(springs[name]);
      EXPECT_GT(size, 1e-5);
      for (std::size_t i = 0; i < springs.rows(); ++i) {
        ASSERT_NEAR(element[name][i], springs[name][i], 1e-8 * size) << name << i;
        ASSERT_NEAR(elastic[name][i], springs[name][i], 1e-8 * size) << name << i;
      }
    }
    for (const char* name : {"energy.algorithmic", "energy.filter"})
      EXPECT_NEAR(element[name].back(), springs[name].back(), 1e-6 * springs["energy.algorithmic"].back()) << name;
  }
}

/// Energy and storage never grow once the load is over; there is no other damping.
TEST(FoundationDecay, FreeRockingDecays) {
  for (const char* step : {"2e-3", "20e-3"}) {
    const Ran ran = run_text(Pier{.damping = {}, .stages = Pier::stage(step, "2")}.text());
    EXPECT_GT(ran.result.max_uplifted_ratio.value, 0.2);
    double before = HUGE_VAL;
    for (std::size_t i = 0; i < ran.rows(); ++i) {
      if (ran.result.table[0][i] < 0.42) continue;
      // gravity works on; external is what it and the pulse have put in
      const double kept = ran["energy.kinetic"][i] + ran["energy.strain"][i] + ran["energy.stored"][i] + ran["energy.filter"][i] -
                          ran["energy.external"][i];
      ASSERT_LE(kept, before + 1e-11 * ran.result.energy_scale) << i;
      before = kept;
    }
  }
}

/// Against the trapezoidal rule with a fine step: the error falls with the square of the step through uplift.
TEST(FoundationDecay, IsOfSecondOrder) {
  const auto rotation = [](const char* step, const char* scheme) {
    Ran ran = run_text(Pier{.stages = Pier::stage(step, "0.8", scheme)}.text());
    EXPECT_GT(ran.result.max_uplifted_ratio.value, 0.2);
    return ran;
  };
  const Ran exact = rotation("0.025e-3", "average_acceleration");
  const auto error = [&](const char* step, std::size_t every) {
    const Ran ran = rotation(step, "energy_decay");
    const std::size_t first = ran.rows() - static_cast<std::size_t>(std::lround(0.8 / std::stod(step)));  // rows of the load steps
    const std::size_t same = exact.rows() - 32000;
    double most = 0;
    for (std::size_t i = first; i < ran.rows(); ++i)
      most = std::max(most, std::abs(ran["base.rz"][i] - exact["base.rz"][same + (i - first + 1) * every - 1]));
    return most / largest(exact["base.rz"]);
  };
  const double coarse = error("1e-3", 40), fine = error("0.5e-3", 20), finer = error("0.25e-3", 10);
  EXPECT_LT(fine, 5e-3);
  EXPECT_NEAR(coarse / fine, 4, 0.8) << coarse << ' ' << fine;
  EXPECT_NEAR(fine / finer, 4, 0.8) << finer;
}

/// A block that is dropped, lands on its edge, leaves the ground again and yields.
TEST(FoundationDecay, LandingAfterFullSeparation) {
  const auto block = [](const char* step, const char* scheme) {
    return std::string(R"(title = "drop"
[nodes]
base = [0, 0]
[[rigid]]
name = "block"
node = "base"
mass = 130e3
inertia = 1.5e6
centre = [0, 3]
[[foundation]]
name = "soil"
body = "base"
width = 6
length = 6
model = { type = "macro_element", K_v = 6e8, K_h = 3e8, K_r = 1.8e9, V_s = 8e6 }
[gravity]
[[initial]]
node = "base"
displacement = [0, 0.05]
rotation = 0.001
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 1
)") +
           "step = " + step + "\nscheme = \"" + scheme + "\"\n[output]\nframes = 0\nenergies = true\n";
  };
  const Ran kept = run_text(block("2e-3", "average_acceleration"));
  for (const char* step : {"4e-3", "2e-3", "0.5e-3"}) {
    const Ran ran = run_text(block(step, "energy_decay"));
    expect_closed(ran);
    EXPECT_GT(ran.result.full_loss, 0.1);
    if (std::string(step) == "2e-3") EXPECT_LT(ran.result.full_loss, 1.05 * kept.result.full_loss);
  }
}

/// Stages with another step and another scheme: what the filters hold is handed over, or booked as dissipated.
TEST(FoundationDecay, StagesAreHandedOver) {
  for (const char* model : {uplifting, yielding}) {
    Pier pier{.model = model};
    pier.stages = Pier::stage("2e-3", "0.3") + Pier::stage("4e-3", "0.3") + Pier::stage("1e-3", "0.2") +
                  Pier::stage("2e-3", "0.2", "average_acceleration") + Pier::stage("2e-3", "0.2");
    expect_closed(run_text(pier.text()));
  }
  // two stages with one step are one stage
  Pier pier{.model = yielding, .stages = Pier::stage("2e-3", "0.6")};
  const Ran whole = run_text(pier.text());
  pier.stages = Pier::stage("2e-3", "0.3") + Pier::stage("2e-3", "0.3");
  const Ran parts = run_text(pier.text());
  EXPECT_NEAR(parts["base.rz"].back(), whole["base.rz"].back(), 1e-9 * largest(whole["base.rz"]));
  EXPECT_NEAR(parts["energy.algorithmic"].back(), whole["energy.algorithmic"].back(), 1e-9 * whole.result.energy_scale);
}

/// A run that is kept in the middle goes on to the last bit, with what the filters remember.
TEST(FoundationDecay, ARunGoesOn) {
  for (const bool space : {false, true}) {
    const Case read = check_case(
        read_toml_text(Pier{.space = space, .model = yielding, .stages = Pier::stage("1e-3", "1.5")}.text(), "case.toml"), "case.toml");
    const BuiltCase built = build(read, runs_of_case(read).front());
    std::vector<std::string> states;
    Keeping keeping;
    keeping.keep = [&](const RunState& state) { states.push_back(write_run_state(state)); };
    const RunResult straight = run(built.model, built.plan, built.behaviours, {}, {}, &keeping);
    std::string why;
    const std::optional<RunState> middle = read_run_state(states.at(states.size() / 2), why);
    ASSERT_TRUE(middle) << why;
    keeping.from = &*middle;
    EXPECT_EQ(run(built.model, built.plan, built.behaviours, {}, {}, &keeping).table, straight.table);
  }
}

/// The condensed step is Newton's method on all unknowns.
TEST(FoundationDecay, CondensedStepIsTheMonolithicStep) {
  for (const bool space : {false, true}) {
    const Case read = check_case(
        read_toml_text(Pier{.space = space, .model = yielding, .amplitude = "6", .stages = Pier::stage("5e-3", "0.6")}.text(), "case.toml"),
        "case.toml");
    BuiltCase built = build(read, runs_of_case(read).front());
    built.plan.oracle_tolerance = 1e-8;
    const RunResult result = run(built.model, built.plan, built.behaviours);
    EXPECT_EQ(result.status, RunStatus::completed) << result.reason;
    EXPECT_GT(result.max_uplifted_ratio.value, 0.05);
    EXPECT_GT(result.final_energy.interface_dissipated, 0.02 * result.energy_scale);
  }
}

constexpr const char* stiff =
    "{ type = \"macro_element\", shape_number = 6, K_v = 6e11, K_h = 3e11, K_r = 1.8e12 }";  // a thousand times as stiff

/// The largest alternation of the vertical force, |N_0 - 2 N_1 + N_2|, behind 60 % of a run.
double alternation(const std::vector<double>& force) {
  double most = 0;
  for (std::size_t i = force.size() * 3 / 5; i < force.size(); ++i)
    most = std::max(most, std::abs(force[i] - 2 * force[i - 1] + force[i - 2]));
  return most;
}

/// A footing that is struck: sqrt(K_v/m) h = 9, so that the filters leave next to nothing of its vibration.
TEST(FoundationDecay, AStruckFootingOnStiffGroundComesToRest) {
  const auto alternates = [&](const char* scheme) {
    Pier pier{.model = stiff, .amplitude = "1e-6", .damping = {}, .more = "[[initial]]\nnode = \"base\"\nvelocity = [0, -1e-3]\n"};
    pier.stages = Pier::stage("2e-3", "0.2", scheme);
    return alternation(run_text(pier.text())["soil.axial"]);
  };
  const double struck = 30e3 * 1e-3 / 2e-3;  // N: its momentum over a step
  EXPECT_GT(alternates("average_acceleration"), struck);
  EXPECT_LT(alternates("energy_decay"), 1e-2 * struck);
}

/// Rocking on stiff ground: the peak forces of the trapezoidal rule are those of its vibration.
TEST(FoundationDecay, StiffGroundDoesNotRing) {
  const auto run_with = [&](const char* scheme) {
    return run_text(Pier{.model = stiff, .stages = Pier::stage("2e-3", "1.5", scheme)}.text());
  };
  const Ran kept = run_with("average_acceleration"), filtered = run_with("energy_decay");
  EXPECT_GT(filtered.result.max_uplifted_ratio.value, 0.2);
  EXPECT_LT(largest(filtered["soil.shear"]), 0.2 * largest(kept["soil.shear"]));
  EXPECT_LT(largest(filtered["soil.moment"]), 0.7 * largest(kept["soil.moment"]));
  EXPECT_NEAR(largest(filtered["base.rz"]), largest(kept["base.rz"]), 0.05 * largest(kept["base.rz"]));
}

}  // namespace
}  // namespace uplift::foundation_decay_test
