// Bases without mass that the law of their interface alone holds: in a dynamic stage they follow the loads in static balance.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "text_support.h"
#include "uplift/case/case.h"
#include "uplift/io/text/toml.h"

namespace uplift::massless_base_test {
namespace {

constexpr double width = 4, depth = 2, stiffness = 5e7, weight = 8e5, frequency = 2;

RunResult run_text(const std::string& text) {
  const Case read = check_case(read_toml_text(text, "case.toml"), "case.toml");
  const BuiltCase built = build(read, runs_of_case(read).front());
  return run(built.model, built.plan, built.behaviours);
}

const std::vector<double>& column(const RunResult& result, const std::string& name) {
  for (std::size_t k = 0; k < result.columns.size(); ++k)
    if (result.columns[k].name == name) return result.table[k + 1];
  ADD_FAILURE() << "no column " << name;
  return result.table[0];
}

/// A rigid strip without mass on springs, pressed by its load of 800 kN; then a vertical force and a moment swing with 2 Hz.
std::string strip(const std::string& law, double force, double moment, const std::string& scheme) {
  const auto number = [](double value) { return std::to_string(value); };
  return "title = \"strip\"\n[nodes]\nbody = [0, 0]\n[[rigid]]\nname = \"strip\"\nnode = \"body\"\n"
         "[[interface]]\nname = \"soil\"\nfooting = { body = \"body\", width = 4, thickness = 2, points = 400, rule = \"midpoint\" }\n"
         "law = { type = \"" +
         law +
         "\", K_n = 5e7, K_t = 1e7, tangential = \"bonded\" }\n[[load]]\nname = \"weight\"\nnode = \"body\"\nforce = [0, -8e5]\n"
         "[[function]]\nname = \"f\"\nshape = { type = \"harmonic\", frequency = 2 }\n"
         "[[load]]\nname = \"swing\"\nnode = \"body\"\nforce = [0, " +
         number(force) + "]\nmoment = " + number(moment) +
         "\nfunction = \"f\"\n[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\nduration = 0.5\nstep = 1e-3\n" + scheme + "\n";
}

TEST(MasslessBase, FollowsTheLoadInStaticBalance) {
  // u = -(W - P(t))/(K A), theta = M(t)/(K I): pressed everywhere
  const double force = 3e5, moment = 3e5;
  for (const char* law : {"springs", "elastic"})
    for (const char* scheme : {"", "traction = \"end\"", "scheme = { type = \"hht\", alpha = -0.1 }", "scheme = \"energy_decay\""}) {
      SCOPED_TRACE(std::string(law) + " " + scheme);
      const RunResult result = run_text(strip(law, force, moment, scheme));
      ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
      ASSERT_EQ(result.table.front().size(), 501u);
      for (std::size_t i = 0; i < 501; i += 10) {
        const double swing = std::sin(2 * std::numbers::pi * frequency * result.table[0][i]);
        const double settled = (weight - force * swing) / (stiffness * width * depth);
        const double inertia = stiffness * depth * std::pow(width, 3) / 12;
        // energy_decay and HHT balance means over the step
        EXPECT_NEAR(column(result, "body.uy")[i], -settled, 2e-3 * settled) << i;
        EXPECT_NEAR(column(result, "body.rz")[i], moment * swing / inertia, 2e-3 * moment / inertia) << i;
      }
    }
}

TEST(MasslessBase, LiftsOffAsInStatics) {
  // beyond the kern the pressure is a triangle over c = 3 (B/2 - M/W): theta = 2 W/(K t c^2)
  const double moment = 1.1 * weight;  // e = 1.1 m of 2 m
  const RunResult result = run_text(strip("springs", 0, moment, "traction = \"end\""));
  ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
  for (std::size_t i = 0; i < 501; i += 10) {
    const double e = moment / weight * std::sin(2 * std::numbers::pi * frequency * result.table[0][i]);
    const double pressed = 3 * (width / 2 - std::abs(e));
    const double rotation = std::abs(e) > width / 6 ? 2 * weight / (stiffness * depth * pressed * pressed)
                                                    : 12 * weight * std::abs(e) / (stiffness * depth * std::pow(width, 3));
    EXPECT_NEAR(std::abs(column(result, "body.rz")[i]), rotation, 1e-3 * 2e-3) << i;
  }
  EXPECT_GT(result.max_uplifted_ratio.value, 0.3);
}

TEST(MasslessBase, ThatNothingPressesHasNoBalance) {
  const RunResult result = run_text(strip("springs", 1.5 * weight, 0, ""));
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_NEAR(result.end_time, std::asin(1 / 1.5) / (2 * std::numbers::pi * frequency), 2e-3);
}

TEST(MasslessBase, UnderConstraintsItIsRefused) {
  const std::string text =
      support::replaced(strip("springs", 0, 0, ""), "{ type = \"springs\", K_n = 5e7, K_t = 1e7, tangential = \"bonded\" }",
                        "{ type = \"coulomb\", friction = 0.5 }");
  const std::string refusal = support::refusal_of([&] { run_text(text); });
  EXPECT_NE(refusal.find("zero mass where mass is needed"), std::string::npos) << refusal;
}

}  // namespace
}  // namespace uplift::massless_base_test
