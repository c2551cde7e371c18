// How much of its strength the ground under a [[foundation]] uses: columns and verdict against the formulas of
// docs/theory/macro_element.md, eqs (M5), (M6), (M15) to (M22), evaluated with the loads of the case.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "ran_support.h"
#include "text_support.h"
#include "uplift/case/case.h"
#include "uplift/io/text/toml.h"
#include "uplift/verdict/edge_warnings.h"
#include "uplift/verdict/motion.h"
#include "uplift/verdict/numbers.h"
#include "uplift/verdict/verdict.h"

namespace uplift::foundation_strength_test {
namespace {

using support::refusal_of;
using support::replaced;
using Column = Request::Kind;

constexpr const char* plane = R"(
title = "loads on a footing"
[nodes]
base = [0, 0]
[[rigid]]
name = "footing"
node = "base"
mass = 1e5
inertia = 3e5
[[foundation]]
name = "soil"
body = "base"
width = 6
length = 5
model = { type = "macro_element", K_v = 6e8, K_h = 3e8, K_r = 1.8e9, V_s = 4e6, friction_angle = "30 deg" }
[[load]]
node = "base"
force = [1e5, -1e6]
moment = -1.2e6
[[stage]]
type = "static"
# more
)";

constexpr const char* space = R"(
title = "loads on a footing"
[nodes]
base = [0, 0, 0]
[[rigid]]
name = "footing"
node = "base"
mass = 1e5
inertias = [3e5, 3e5, 3e5]
[[foundation]]
name = "soil"
body = "base"
width = 6
length = 5
model = { type = "macro_element", K_v = 6e8, K_h = 3e8, K_r = 1.8e9, K_t = 1e9, V_s = 4e6, friction_angle = "30 deg" }
[[load]]
node = "base"
force = [1e5, 0.5e5, -1e6]
moments = [0.5e6, 0.9e6, 0]
[[stage]]
type = "static"
)";

struct Ran : support::Ran {
  double last(Column kind) const {
    const std::vector<double>* column = find_column(result, kind, 0);
    return column ? column->back() : NAN;
  }
  double verdict(QuantityName name) const {
    const VerdictNumbers numbers = numbers_of(built, result, nullptr);
    const VerdictNumber* number = find_number(numbers.interfaces.front().numbers, name);
    return number ? number->value : NAN;
  }
};

Ran run_text(const std::string& text, std::size_t which = 0) {
  Ran made{support::run_text(text, which)};
  EXPECT_EQ(made.result.status, RunStatus::completed) << made.result.reason;
  return made;
}

/// (1 - |H|/N)^3
double shear_share(double h, double n) {
  return std::pow(1 - std::abs(h) / n, 3);
}

TEST(FoundationStrength, UtilisationsOfGivenLoads) {
  const Ran ran = run_text(plane);
  const double n = 1e6, h = 1e5, m = 1.2e6, bearing = n / (4e6 * shear_share(h, n) * (1 - 2 * m / (n * 6))),
               sliding = h / (n * std::tan(std::numbers::pi / 6));
  EXPECT_NEAR(ran.last(Column::bearing_utilisation), bearing, 1e-9);
  EXPECT_NEAR(ran.last(Column::sliding_utilisation), sliding, 1e-9);
  EXPECT_NEAR(ran.verdict("max_bearing_utilisation"), bearing, 1e-9);
  EXPECT_NEAR(ran.verdict("max_sliding_utilisation"), sliding, 1e-9);
  EXPECT_NEAR(ran.verdict("min_sliding_safety"), 1 / sliding, 1e-7);
  EXPECT_EQ(find_column(ran.result, Column::bearing_capacity, 0), nullptr);  // it does not grow
}

/// e/D = M/(N D).
TEST(FoundationStrength, BeyondADiscOnSpringsIsWarnedOf) {
  const auto warned = [](const std::string& moment, const std::string& shape) {
    const Ran ran = run_text(replaced(replaced(plane, "moment = -1.2e6", "moment = -" + moment), "V_s = 4e6, friction_angle = \"30 deg\"",
                                      "shape_number = " + shape));
    const std::vector<std::string> said = edge_warnings(ran.built, numbers_of(ran.built, ran.result, nullptr));
    return std::ranges::any_of(said,
                               [](const std::string& each) { return each.find("beyond what shape_number = 8 is meant for") != each.npos; });
  };
  EXPECT_TRUE(warned("2.1e6", "8"));   // 0.35
  EXPECT_FALSE(warned("1.5e6", "8"));  // 0.25
  EXPECT_FALSE(warned("2.1e6", "6"));
}

TEST(FoundationStrength, CohesionActsOnTheEffectiveArea) {
  const Ran ran = run_text(replaced(plane, "friction_angle = \"30 deg\"", "friction_angle = \"20 deg\", cohesion = 10e3"));
  const double n = 1e6, effective = 6 * 5 * (1 - 2 * 1.2e6 / (n * 6));
  EXPECT_NEAR(ran.last(Column::sliding_utilisation), 1e5 / (n * std::tan(std::numbers::pi / 9) + 10e3 * effective), 1e-9);
}

TEST(FoundationStrength, InSpaceBothAxesReduceTheCapacity) {
  const double n = 1e6, h = std::hypot(1e5, 0.5e5), sliding = h / (n * std::tan(std::numbers::pi / 6));
  const Ran rectangle = run_text(space);  // the moment about x tilts the length
  EXPECT_NEAR(rectangle.last(Column::bearing_utilisation),
              n / (4e6 * shear_share(h, n) * (1 - 2 * 0.9e6 / (n * 6)) * (1 - 2 * 0.5e6 / (n * 5))), 1e-9);
  EXPECT_NEAR(rectangle.last(Column::sliding_utilisation), sliding, 1e-9);
  const Ran disc = run_text(replaced(space, "length = 5", "shape = \"disc\""));
  EXPECT_NEAR(disc.last(Column::bearing_utilisation), n / (4e6 * shear_share(h, n) * (1 - 2 * std::hypot(0.9e6, 0.5e6) / (n * 6))), 1e-9);
  EXPECT_NEAR(disc.last(Column::sliding_utilisation), sliding, 1e-9);
}

/// y with (H/(a V n^c y^d))^2 + (M/(b D V n^e y^f))^2 = 1, by halving.
double left_of_n(double a, double b, double c, double d, double e, double f, double n, double h, double m) {
  double low = 0, high = 10;
  for (int i = 0; i < 100; ++i) {
    const double y = 0.5 * (low + high);
    (std::hypot(h / (a * std::pow(n, c) * std::pow(y, d)), m / (b * std::pow(n, e) * std::pow(y, f))) > 1 ? low : high) = y;
  }
  return low;
}

TEST(FoundationStrength, PowerLawUsesTheResultants) {
  const std::string keys = "V_s = 4e6, surface = \"power_law\", a = 0.5, b = 0.45, c = 0.3, d = 0.6, e = 0.8, f = 0.9";
  const double n = 1e6 / 4e6;
  const auto expected = [&](double h, double m) { return n / (1 - left_of_n(0.5, 0.45, 0.3, 0.6, 0.8, 0.9, n, h / 4e6, m / 4e6)); };
  EXPECT_NEAR(run_text(replaced(plane, "V_s = 4e6", keys)).verdict("max_bearing_utilisation"), expected(1e5, 1.2e6 / 6), 1e-9);
  const std::string deep = replaced(space, "V_s = 4e6", keys);  // the moment about x tilts the length
  EXPECT_NEAR(run_text(deep).last(Column::bearing_utilisation), expected(std::hypot(1e5, 0.5e5), std::hypot(0.9e6 / 6, 0.5e6 / 5)), 1e-9);
  EXPECT_NEAR(run_text(replaced(deep, "length = 5", "shape = \"disc\"")).last(Column::bearing_utilisation),
              expected(std::hypot(1e5, 0.5e5), std::hypot(0.9e6, 0.5e6) / 6), 1e-9);
}

// Annex F for cohesive soil: the soil's inertia F and the model factor reduce the vertical capacity to N_max (1 - 0.21 F^1.22)/gamma_Rd.
TEST(FoundationStrength, AnnexFUnderVerticalLoad) {
  std::string text = replaced(plane, "V_s = 4e6", "V_s = 4e6, surface = \"en_1998_5\", soil_type = \"cohesive\"");
  text = replaced(replaced(text, "force = [1e5, -1e6]", "force = [0, -1e6]"), "moment = -1.2e6\n", "");
  EXPECT_NEAR(run_text(text).last(Column::bearing_utilisation), 0.25, 1e-12);
  const std::string reduced = replaced(text, "\"cohesive\"", "\"cohesive\", soil_inertia = 0.7, model_factor = 1.15");
  EXPECT_NEAR(run_text(reduced).last(Column::bearing_utilisation), 0.25 * 1.15 / (1 - 0.21 * std::pow(0.7, 1.22)), 1e-12);
}

// A building on ground of the standard that rocks and yields: the energy balance closes at any step.
TEST(FoundationStrength, TheLedgerClosesOnYieldingPowerLawGround) {
  for (const char* surface : {"surface = \"en_1998_5\", soil_type = \"cohesive\"", "surface = \"en_1998_5\", soil_type = \"cohesionless\"",
                              "surface = \"power_law\", a = 0.5, b = 0.45, c = 1, d = 1, e = 1, f = 1"})
    for (const char* step : {"2e-3", "10e-3"}) {
      std::string text = replaced(plane, "V_s = 4e6", std::string("V_s = 2.5e6, V_u = 4e6, w_ref = 0.02, ") + surface);
      text = replaced(text, "# more", std::string(R"([[function]]
name = "pulse"
shape = { type = "half_sine", duration = 0.4 }
[[load]]
node = "base"
force = [3e5, 0]
moment = -1.6e6
function = "pulse"
[[stage]]
type = "dynamic"
duration = 1
step = )") + step);
      const Ran ran = run_text(replaced(text, "moment = -1.2e6\n", ""));
      EXPECT_LT(std::abs(ran.result.final_energy.residual), 1e-10 * ran.result.energy_scale) << surface << step;
      EXPECT_GT(ran.result.final_energy.interface_dissipated, 0.01 * ran.result.energy_scale) << surface << step;
      EXPECT_NEAR(ran.verdict("max_bearing_utilisation"), 1, 1e-9) << surface << step;
    }
}

// N (1 - 2 M/(N B)) = V_s: the ground under N = 1 MN carries M = (N B/2)(1 - N/V_s) = 2.25 MN m and no more. A moment that grows to 2.5 MN
// m in 1 s turns the footing until the small displacements end; one of 2 MN m does not.
TEST(FoundationStrength, ABearingFailureStandsInTheHeadline) {
  std::string text = replaced(plane, "friction_angle = \"30 deg\"", "friction_angle = \"40 deg\"");
  text = replaced(replaced(text, "force = [1e5, -1e6]", "force = [0, -1e6]"), "moment = -1.2e6\n", "");
  text = replaced(text, "# more", R"([[function]]
name = "ramp"
shape = { type = "ramp", duration = 1 }
[[load]]
node = "base"
moment = -2.5e6
function = "ramp"
[[stage]]
type = "dynamic"
duration = 10
step = 1e-3
)");
  const support::Ran fails = support::run_text(text);
  ASSERT_EQ(fails.result.status, RunStatus::overturned) << fails.result.reason;
  const Verdict verdict = judge(fails.built, fails.result, nullptr);
  EXPECT_EQ(verdict.level, Verdict::Level::overturned);
  EXPECT_TRUE(verdict.headline.starts_with("Bearing failure under soil: the rotation exceeds 0.150 rad at ")) << verdict.headline;
  EXPECT_NE(verdict.paragraphs.front().find("the ground uses its whole bearing capacity, and the foundation tilts"), std::string::npos)
      << verdict.paragraphs.front();
  EXPECT_GT(fails.result.end_time, 0.9);  // the capacity is reached at 0.9 s

  const Ran stands = run_text(replaced(text, "moment = -2.5e6", "moment = -2e6"));
  EXPECT_TRUE(judge(stands.built, stands.result, nullptr).headline.starts_with("The base uplifts"));
}

// V = V_s + (V_u - V_s) p/(p + w_ref) grows until it carries the load, N = V: p = w_ref (N - V_s)/(V_u - N).
TEST(FoundationStrength, CapacityThatGrowsReachesTheLoad) {
  std::string text = replaced(plane, "V_s = 4e6", "V_s = 0.8e6, V_u = 2e6, w_ref = 0.01");
  text = replaced(replaced(text, "force = [1e5, -1e6]", "force = [0, -1e6]"), "moment = -1.2e6\n", "");
  const Ran ran = run_text(text + "\n[output]\n[[output.history]]\nnode = \"base\"\nquantity = \"uy\"\n");
  EXPECT_NEAR(ran.last(Column::bearing_capacity), 1e6, 1e-9 * 1e6);
  EXPECT_NEAR(ran.last(Column::bearing_utilisation), 1, 1e-9);
  const auto settlement = std::ranges::find(ran.result.columns, "base.uy", &Request::name) - ran.result.columns.begin();
  const double plastic = 0.01 * (1e6 - 0.8e6) / (2e6 - 1e6);
  EXPECT_NEAR(ran.result.table[static_cast<std::size_t>(settlement) + 1].back(), -(1e6 / 6e8 + plastic), 1e-9 * plastic);
}

const std::string shaken = replaced(plane, "# more", R"([[function]]
name = "pulse"
shape = { type = "half_sine", duration = 0.4 }
[[load]]
node = "base"
force = [0.5e5, 0]
moment = -0.3e6
function = "pulse"
[[stage]]
type = "dynamic"
duration = 1
step = 1e-3
traction = "end"
[energy]
created_limit = 1)");

// With end-of-step tractions all force columns belong to the same instants as the utilisations.
TEST(FoundationStrength, OverTimeItFollowsTheForces) {
  const Ran ran = run_text(replaced(shaken, "V_s = 4e6", "V_s = 2.5e6, V_u = 3e6, w_ref = 0.01"));
  const auto column = [&](Column kind) { return *find_column(ran.result, kind, 0); };
  const std::vector<double> axial = column(Column::axial), shear = column(Column::shear), moment = column(Column::moment);
  const std::vector<double> bearing = column(Column::bearing_utilisation), sliding = column(Column::sliding_utilisation);
  const std::vector<double> capacity = column(Column::bearing_capacity);
  double most_bearing = 0, most_sliding = 0;
  for (std::size_t i = 0; i < axial.size(); ++i) {
    const double n = -axial[i];
    ASSERT_GT(n, 0);
    ASSERT_NEAR(bearing[i], n / (capacity[i] * shear_share(shear[i], n) * (1 - 2 * std::abs(moment[i]) / (n * 6))), 1e-9) << i;
    ASSERT_NEAR(sliding[i], std::abs(shear[i]) / (n * std::tan(std::numbers::pi / 6)), 1e-9) << i;
    if (i > 0) ASSERT_GE(capacity[i], capacity[i - 1]);
    most_bearing = std::max(most_bearing, bearing[i]), most_sliding = std::max(most_sliding, sliding[i]);
  }
  EXPECT_NEAR(most_bearing, 1, 1e-9);  // it yields
  EXPECT_GT(capacity.back(), capacity.front() * 1.001);
  EXPECT_LT(capacity.back(), 3e6);
  EXPECT_EQ(ran.verdict("max_bearing_utilisation"), most_bearing);
  EXPECT_EQ(ran.verdict("max_sliding_utilisation"), most_sliding);
}

// The numbers of the verdict are those of all steps, whatever the output records.
TEST(FoundationStrength, VerdictDoesNotDependOnTheOutput) {
  const Ran all = run_text(shaken), few = run_text(shaken + "\n[output]\nevery = 7\nautomatic = false\n");
  EXPECT_EQ(all.verdict("max_bearing_utilisation"), few.verdict("max_bearing_utilisation"));
  EXPECT_EQ(all.verdict("max_sliding_utilisation"), few.verdict("max_sliding_utilisation"));
}

TEST(FoundationStrength, OnlyGroundWithAStrengthHasTheColumns) {
  const Ran uplifting = run_text(replaced(plane, ", V_s = 4e6, friction_angle = \"30 deg\"", ""));
  for (const Column kind : {Column::bearing_utilisation, Column::sliding_utilisation, Column::bearing_capacity})
    EXPECT_EQ(find_column(uplifting.result, kind, 0), nullptr);
  EXPECT_TRUE(std::isnan(uplifting.verdict("max_bearing_utilisation")));
  EXPECT_TRUE(std::isnan(uplifting.verdict("max_sliding_utilisation")));
}

// A history that the case asks for is none of the bonded run, whose ground does not yield.
TEST(FoundationStrength, ABondedRunHasNoStrength) {
  const std::string text =
      shaken + "\n[output]\nautomatic = false\n[[output.history]]\ninterface = \"soil\"\nquantity = \"bearing_utilisation\"\n";
  EXPECT_NE(find_column(run_text(text).result, Column::bearing_utilisation, 0), nullptr);
  EXPECT_EQ(find_column(run_text(text, 1).result, Column::bearing_utilisation, 0), nullptr);
}

TEST(FoundationStrength, AFoundationHasForcesAndNoPressure) {
  const std::string history = "\n[output]\n[[output.history]]\ninterface = \"soil\"\n";
  const Ran ran = run_text(plane + history + "point = 1\nquantity = \"traction\"\n");
  EXPECT_EQ(find_column(ran.result, Column::max_pressure, 0), nullptr);
  const std::vector<double>* force = find_column(ran.result, Column::traction, 0);
  ASSERT_NE(force, nullptr);
  EXPECT_NEAR(force->back(), -1e6, 1e-3);
  EXPECT_EQ(std::ranges::find(ran.result.columns, Column::traction, &Request::kind)->unit, "N");
  const auto refusal = [&](const std::string& text) {
    return refusal_of([&] {
      const Case read = check_case(read_toml_text(text, "case.toml"), "case.toml");
      build(read, runs_of_case(read).front());
    });
  };
  EXPECT_NE(refusal(plane + history + "quantity = \"max_pressure\"\n").find("a quantity of the foundation \"soil\""), std::string::npos);
  EXPECT_NE(refusal(plane + history + "quantity = \"bearing_capacity\"\n").find("bearing_utilisation"), std::string::npos);
}

}  // namespace
}  // namespace uplift::foundation_strength_test
