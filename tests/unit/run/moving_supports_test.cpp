// Points under constraints on supports that move by themselves: their velocities and accelerations are those relative to the support.
// Closed forms of a mass on a shaking table.
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>

#include "unit/verdict/verdict_support.h"

namespace uplift::moving_supports_test {
namespace {

using namespace support;
using std::numbers::pi;

constexpr double mass = 1000, g = 9.81, frequency = 2, omega = 2 * pi * frequency, friction = 0.4;

/// A mass on a table that moves by -A cos(omega t), along `axis`.
struct Table {
  std::string axis = "uy", fixed = R"(["ux", "rz"])", law = R"({ type = "unilateral" })", method = "lagrange",
              scheme = "average_acceleration";
  std::string phase = "-90 deg";
  double acceleration = 1;  // A omega^2 over g
  double duration = 0.5, step = 2e-4;
  std::string shape = {};  // instead of the harmonic one
  double push = 0;         // N, sideways
  double amplitude() const { return acceleration * g / (omega * omega); }

  RunResult run() const {
    return run_of(
        built_of(fmt::format(R"(title = "table"
bonded = false
method = "{}"
[nodes]
b = [0, 0]
table = [0, 0]
[[rigid]]
node = "b"
mass = 1000
inertia = 300
[[support]]
node = "b"
fixed = {}
[[support]]
node = "table"
fixed = ["{}"]
[[motion]]
node = "table"
direction = "{}"
amplitude = {}
function = "shake"
[[function]]
name = "shake"
shape = {}
{}
[gravity]
[[interface]]
name = "f"
pairs = {{ upper = ["b"], lower = ["table"], area = 1 }}
law = {}
[limits]
separation = 100
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = {}
step = {}
scheme = {}
)",
                             method, fixed, axis == "uy" ? "ux" : "uy", axis, amplitude(),
                             shape.empty() ? fmt::format(R"({{ type = "harmonic", frequency = 2, phase = "{}" }})", phase) : shape,
                             push > 0 ? fmt::format("[[load]]\nnode = \"b\"\nforce = [{}, 0]", push) : "", law, duration, step,
                             scheme.front() == '{' ? scheme : '"' + scheme + '"')));
  }
};

const std::vector<double>& column(const RunResult& run, const std::string& name) {
  for (std::size_t k = 0; k < run.columns.size(); ++k)
    if (run.columns[k].name == name) return run.table[k + 1];
  ADD_FAILURE() << "no column " << name;
  return run.table.front();
}

/// While A omega^2 < g the mass stays on the table and presses it with m (g + A omega^2 cos(omega t)). It takes the velocity of the table.
TEST(MovingSupport, AMassThatStaysPressesWithItsInertia) {
  for (const char* method : {"lagrange", "augmented_lagrangian"})
    for (const char* law : {R"({ type = "unilateral" })", R"({ type = "coulomb", friction = 0.4 })"})
      for (const char* scheme : {"average_acceleration", "hht"}) {
        const Table table{.law = law, .method = method, .scheme = scheme, .acceleration = 0.5, .duration = 0.4};
        const RunResult run = table.run();
        const std::string trace = fmt::format("{} {} {}", method, law, scheme);
        ASSERT_EQ(run.status, RunStatus::completed) << trace << run.reason;
        const std::vector<double>&axial = column(run, "f.axial"), &time = run.table.front();
        for (std::size_t i = 1; i < axial.size(); i += 7)
          EXPECT_NEAR(axial[i], -mass * g * (1 + 0.5 * std::cos(omega * time[i])), 5e-4 * mass * g) << trace << " " << time[i];
        const double speed = table.amplitude() * omega * std::sin(omega * table.duration);
        EXPECT_NEAR(run.final_energy.kinetic, 0.5 * mass * speed * speed, 1e-3 * mass * g * table.amplitude()) << trace;
        EXPECT_NEAR(run.final_energy.impact, 0, 1e-3 * mass * g * table.amplitude()) << trace;
      }
}

/// Beyond it the mass leaves the table where A omega^2 cos(omega t) = -g, flies, and lands: the highest gap, and the energy of the impact,
/// that of the velocity relative to the table.
TEST(MovingSupport, AMassThatIsThrownLandsOnTheMovingTable) {
  for (const char* law : {R"({ type = "unilateral" })", R"({ type = "coulomb", friction = 0.4 })"}) {
    const Table table{.law = law, .acceleration = 1.5, .duration = 0.55, .step = 1e-4};
    const double a = table.amplitude(), leaves = std::acos(-1 / 1.5) / omega;
    const auto gap = [&](double t) {
      const double s = t - leaves;
      return -a * std::cos(omega * leaves) + a * omega * std::sin(omega * leaves) * s - 0.5 * g * s * s + a * std::cos(omega * t);
    };
    double lands = leaves + 0.05, highest = 0;
    for (; gap(lands) > 0; lands += 1e-6) highest = std::max(highest, gap(lands));
    const double rate = a * omega * std::sin(omega * leaves) - g * (lands - leaves) - a * omega * std::sin(omega * lands);
    ASSERT_LT(lands, table.duration);
    ASSERT_GT(std::cos(omega * table.duration), -1 / 1.5);  // it has not left again
    const RunResult run = table.run();
    ASSERT_EQ(run.status, RunStatus::completed) << law << run.reason;
    EXPECT_NEAR(run.max_opening.value, highest, 2e-3 * highest) << law;
    EXPECT_NEAR(run.final_energy.impact, 0.5 * mass * rate * rate, 5e-3 * 0.5 * mass * rate * rate) << law;
    EXPECT_NEAR(column(run, "f.axial").back(), -mass * g * (1 + 1.5 * std::cos(omega * table.duration)), 1e-3 * mass * g) << law;
    EXPECT_LT(run.energy_created, 1e-3 * mass * rate * rate) << law;
  }
}

/// The same under schemes with numerical damping: what they take from the step of a landing belongs to the impact, wherever in the step the
/// gap closes, but for 4 (gamma - 1/2)^2 of it. The displacement solve sends a mass of speed v back with up to -v, so that the change of
/// acceleration is at most 4 v/dt.
TEST(MovingSupport, DampedSchemesLoseLittleAtALanding) {
  struct Damped {
    const char* scheme;
    double gamma;
  };
  for (const double push : {0.0, 0.3 * mass * g}) {  // with friction: it slides in the air, and when it lands
    Table table{.acceleration = 1.5, .duration = 0.55, .step = 1e-4, .push = push};
    if (push > 0) table.fixed = R"(["rz"])", table.law = R"({ type = "coulomb", friction = 0.4 })";
    const double impact = table.run().final_energy.impact;
    for (const Damped& damped : {Damped{"hht", 0.55}, Damped{R"({ type = "hht", alpha = -0.1 })", 0.6},
                                 Damped{R"({ type = "generalised_alpha", rho = 0.8 })", 0.5 + 1 / 9.0}})
      for (const double step : {1e-3, 7e-4, 5e-4, 3e-4, 1e-4}) {
        table.scheme = damped.scheme, table.step = step;
        const RunResult run = table.run();
        const std::string trace = fmt::format("{} {} {}", push, damped.scheme, step);
        ASSERT_EQ(run.status, RunStatus::completed) << trace << run.reason;
        const double left = (4 * std::pow(damped.gamma - 0.5, 2) + 1e-3) * impact;
        EXPECT_NEAR(run.final_energy.impact, impact, left) << trace;
        EXPECT_LT(run.energy_lost, left) << trace;
        EXPECT_LT(run.energy_created, 2e-3 * impact) << trace;
      }
  }
}

/// Under a mass at rest a table that begins to move upwards, A sin(omega t), strikes it at once: the mass takes the velocity of the table,
/// and the impact m (A omega)^2/2; the support puts twice as much in.
TEST(MovingSupport, ATableThatStartsStrikesTheMass) {
  for (const char* law : {R"({ type = "unilateral" })", R"({ type = "coulomb", friction = 0.4 })"}) {
    const Table table{.law = law, .phase = "0 deg", .acceleration = 0.5, .duration = 0.2};
    const RunResult run = table.run();
    ASSERT_EQ(run.status, RunStatus::completed) << law << run.reason;
    const double a = table.amplitude(), struck = 0.5 * mass * std::pow(a * omega, 2), x = omega * table.duration;
    EXPECT_NEAR(run.final_energy.impact, struck, 1e-4 * struck) << law;
    EXPECT_NEAR(run.final_energy.kinetic, struck * std::pow(std::cos(x), 2), 1e-3 * struck) << law;
    EXPECT_NEAR(column(run, "f.axial").back(), -mass * g * (1 - 0.5 * std::sin(x)), 1e-4 * mass * g) << law;
    EXPECT_LT(run.energy_created, 2e-3 * struck) << law;
    EXPECT_LT(run.energy_lost, 2e-3 * struck) << law;
  }
}

/// A table that begins to rise at a constant speed V strikes the mass. Within which part of a step it begins is of no concern afterwards:
/// the mass has the speed of the table and presses with its weight. The support puts m V^2 in where the ramp begins with a step, and at
/// least the kinetic energy where the step spreads the strike over its length.
TEST(MovingSupport, ARampMayBeginWithinAStep) {
  constexpr double rise = 0.02, lasts = 0.1, struck = 0.5 * mass * (rise / lasts) * (rise / lasts);
  for (const char* law : {R"({ type = "unilateral" })", R"({ type = "coulomb", friction = 0.4 })"})
    for (const double start : {0.1, 0.1001, 0.10025, 0.1004}) {
      const Table table{.law = law,
                        .acceleration = omega * omega / g,  // amplitude 1
                        .duration = start + 0.8 * lasts,
                        .step = 5e-4,
                        .shape = fmt::format(R"({{ type = "ramp", from = 0, to = {}, start = {}, duration = {} }})", rise, start, lasts)};
      const RunResult run = table.run();
      const std::string trace = fmt::format("{} {}", law, start);
      ASSERT_EQ(run.status, RunStatus::completed) << trace << run.reason;
      EXPECT_NEAR(run.final_energy.kinetic, struck, 1e-6 * struck) << trace;
      EXPECT_NEAR(column(run, "f.axial").back(), -mass * g, 1e-6 * mass * g) << trace;
      EXPECT_LT(run.max_opening.value, 1e-12) << trace;
      if (start == 0.1)
        EXPECT_NEAR(run.final_energy.impact, struck, 1e-6 * struck) << trace;
      else
        EXPECT_GT(run.final_energy.impact, -1e-9 * struck) << trace;
      EXPECT_LT(run.energy_created, 1e-9 * struck) << trace;
    }
}

/// `reflect` and `propagate` turn the relative velocity of a point round in every step and would hold tension: they are refused.
TEST(MovingSupport, RefusesRulesThatHoldTension) {
  for (const char* rule : {"reflect", "propagate"})
    for (const auto& [method, law] :
         {std::pair{"lagrange", R"({ type = "unilateral" })"}, std::pair{"newton", R"({ type = "springs", K_n = 1e9, K_t = 1e9 })"}}) {
      Table table{.law = law, .method = fmt::format("{}\"\nimpact = \"{}", method, rule)};
      try {
        table.run();
        ADD_FAILURE() << rule << law;
      } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("on a support that motion"), std::string::npos) << error.what();
      }
    }
}

/// Shaken sideways with A omega^2 = 2 mu g it slides with mu g from the first instant on, until it is as fast as the table, 2 sin x = x
/// with x = omega t, and then sticks until cos x = -1/2.
TEST(MovingSupport, AMassSlidesOnATableThatMovesSideways) {
  double meets = 1.5;
  for (int i = 0; i < 100; ++i) meets = 2 * std::sin(meets);  // contracts: |2 cos x| < 1
  const double until = 2.05;
  ASSERT_LT(meets, until);
  for (const char* method : {"lagrange", "augmented_lagrangian"}) {
    const Table table{.axis = "ux",
                      .fixed = R"(["rz"])",
                      .law = R"({ type = "coulomb", friction = 0.4 })",
                      .method = method,
                      .acceleration = 2 * friction,
                      .duration = until / omega,
                      .step = until / omega / 1000};
    const RunResult run = table.run();
    ASSERT_EQ(run.status, RunStatus::completed) << method << run.reason;
    const std::vector<double>&ux = column(run, "b.ux"), &time = run.table.front();
    const double a = table.amplitude(), sliding = 0.5 * friction * g * std::pow(meets / omega, 2);
    for (std::size_t i = 0; i < 10; ++i) EXPECT_LE(std::abs(column(run, "f.shear")[i]), (1 + 1e-9) * friction * mass * g) << method << i;
    for (std::size_t i = 10; i < ux.size(); i += 10) {
      const double x = omega * time[i],
                   exact = x < meets ? 0.5 * friction * g * time[i] * time[i] : sliding + a * (std::cos(meets) - std::cos(x));
      EXPECT_NEAR(ux[i], ux[0] + exact, 5e-3 * a) << method << " " << time[i];
    }
    const double slip = a * (1 - std::cos(meets)) - sliding, force = friction * mass * g;
    EXPECT_NEAR(run.final_energy.interface_dissipated, force * slip, 5e-3 * force * slip) << method;
    EXPECT_NEAR(std::abs(column(run, "f.shear").back()), mass * 2 * friction * g * std::abs(std::cos(until)), 1e-2 * force) << method;
  }
}

}  // namespace
}  // namespace uplift::moving_supports_test
