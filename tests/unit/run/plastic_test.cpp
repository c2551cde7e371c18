// Solids that yield, in whole runs: closed forms of strength, the two outer iterations against each other, the energy ledger, the oracle.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simple_meshes.h"
#include "text_support.h"
#include "unit/elements/solid_support.h"
#include "unit/run/plastic_support.h"
#include "uplift/case/case.h"
#include "uplift/dynamics/statics.h"
#include "uplift/elements/bulk_laws/drucker_prager.h"
#include "uplift/elements/solid_nonlinear.h"
#include "uplift/io/fields/run_frames.h"
#include "uplift/io/text/toml.h"
#include "uplift/run/run_state.h"

namespace uplift::plastic_test {
using namespace plastic_test;
namespace {

using Newton = PlasticOptions::Newton;

struct Rest {
  StaticOutcome outcome;
  State state;
  LinearCounts counts;
};

/// The dead loads of a case in equal steps.
Rest rest_of(const BuiltCase& built, int steps, const PlasticOptions& options) {
  const Bulk bulk(built.model, nullptr);
  const Sparse b = stack_interfaces(built.model);
  const Behaviours behaviours(built.model, *built.plan.method, nullptr);
  const Vector gap = Vector::Zero(b.rows());
  Rest rest;
  State& state = rest.state;
  state.displacement = state.velocity = state.acceleration = Vector::Zero(built.model.free());
  state.opening = state.force = state.mean_force = gap;
  state.history.setZero(behaviours.history);
  rest.outcome = solve_statics({built.model, bulk, b, gap}, {behaviours, *built.plan.method}, *built.plan.solver,
                               {.steps = steps, .plastic = options}, state, rest.counts);
  return rest;
}

/// A specimen 1 m wide and high (in space also deep) on rollers, pressed from above.
Prepared specimen(bool space, const std::string& plasticity, double pressure) {
  Grid lines{uniform_lines(0, 1, 2), uniform_lines(0, 1, 2), {}};
  if (space) lines.z = uniform_lines(0, 1, 2);
  const Mesh cube = grid(
      lines, [](int, int, int) { return 0; }, {"soil"},
      [](int, Direction direction, int) { return "soil_" + std::string(name_of(direction)); });
  std::string text = R"(title = "specimen"
[mesh]
file = "specimen.msh"
[[solid]]
group = "soil"
E = 5e7
poisson = 0.3
density = 1900
)";
  text += "plasticity = { " + plasticity + " }\n";
  text += "[[support]]\ngroup = \"soil_bottom\"\nfixed = [\"" + std::string(space ? "uz" : "uy") + "\"]\n";
  text += "[[support]]\ngroup = \"soil_left\"\nfixed = [\"ux\"]\n";
  if (space) text += "[[support]]\ngroup = \"soil_front\"\nfixed = [\"uy\"]\n";
  text += "[[load]]\nname = \"press\"\ngroup = \"soil_top\"\ntraction = [" + std::string(space ? "0, 0, " : "0, ") +
          std::to_string(-pressure) +
          "]\n[[stage]]\ntype = \"static\"\n[output.fields]\nformat = \"vtu\"\nquantities = [\"stress\", \"plastic_strain\"]\n";
  return prepared(text, &cube);
}

/// Lowest displacement of any node along the load [m].
double settlement(const BuiltCase& built, const State& state) {
  const Vector full = built.model.full(state.displacement, 0, 0);
  double lowest = 0;
  for (int node = 0; node < static_cast<int>(built.model.nodes.size()); ++node)
    lowest = std::min(lowest, full[built.model.at(node, built.model.space.dof(built.model.space.up()))]);
  return lowest;
}

TEST(PlasticRun, PlaneStrainCompressionFailsAtTheStrengthOfMohrCoulomb) {
  // Fitted to the same collapse in plane strain, with associated flow: 2 c cos(phi)/(1 - sin(phi)) (Terzaghi).
  const double phi = 30 * std::numbers::pi / 180, cohesion = 5e3, strength = 2 * cohesion * std::cos(phi) / (1 - std::sin(phi));
  const std::string law =
      "type = \"drucker_prager\", cohesion = \"5 kPa\", friction_angle = \"30 deg\", dilatancy_angle = \"30 deg\", "
      "fit = \"plane_strain\"";
  for (const Newton newton : {Newton::automatic, Newton::full}) {
    const Prepared below = specimen(false, law, 0.999 * strength), above = specimen(false, law, 1.001 * strength);
    const Rest rest = rest_of(below.built, 10, {.newton = newton});
    EXPECT_TRUE(rest.outcome.converged) << rest.outcome.why;
    // it has yielded: more than the elastic settlement, (1 - nu^2) p / E
    EXPECT_LT(settlement(below.built, rest.state), -1.05 * 0.91 * strength / 5e7);
    const Rest failed = rest_of(above.built, 10, {.newton = newton});
    EXPECT_FALSE(failed.outcome.converged);
    EXPECT_NE(failed.outcome.why.find("yielding solid"), std::string::npos) << failed.outcome.why;
  }
}

TEST(PlasticRun, UniaxialCompressionHardensByTheClosedForm) {
  // q = E (e - plastic), q/sqrt(3) - eta q/3 = xi (c + H e_bar), plastic = (e_bar/xi) (1/sqrt(3) - eta_bar/3)
  const double phi = 0.5, cohesion = 1e4, hardening = 1e6, young = 5e7;
  const auto slope = [](double angle) { return 6 * std::sin(angle) / (std::numbers::sqrt3 * (3 - std::sin(angle))); };
  const double xi = 6 * std::cos(phi) / (std::numbers::sqrt3 * (3 - std::sin(phi)));
  for (const double psi : {0.2, 0.5}) {
    const double drive = 1 / std::numbers::sqrt3 - slope(phi) / 3, flow = 1 / std::numbers::sqrt3 - slope(psi) / 3;
    const double q = 1.7 * xi * cohesion / drive;
    const double accumulated = (drive * q / xi - cohesion) / hardening;
    const double expected = -(q / young + accumulated / xi * flow);
    const Prepared made = specimen(
        true, "type = \"drucker_prager\", cohesion = 1e4, friction_angle = 0.5, hardening = 1e6, dilatancy_angle = " + std::to_string(psi),
        q);
    for (const Newton newton : {Newton::automatic, Newton::modified, Newton::full}) {
      if (newton == Newton::full && psi < phi) continue;  // half a tangent at every step may go round in circles
      const Rest rest = rest_of(made.built, 5, {.newton = newton});
      ASSERT_TRUE(rest.outcome.converged) << rest.outcome.why;
      EXPECT_LE(rest.counts.analyses, 2);
      EXPECT_NEAR(settlement(made.built, rest.state), expected, 1e-8 * -expected) << psi;
      const RunFrames frames(*made.read->input->output.fields, *made.read, made.built);
      const std::vector<FieldValues> fields = frames.of(rest.state, nullptr, {}, 0).blocks.front().points;
      const std::vector<double>& stress = fields.front().values;
      ASSERT_EQ(fields.back().name, "plastic_strain");
      for (const double value : fields.back().values) EXPECT_NEAR(value, accumulated, 1e-7 * accumulated);
      for (std::size_t i = 0; i < stress.size(); ++i) EXPECT_NEAR(stress[i], i % 6 == 2 ? -q : 0, 1e-8 * q);
    }
  }
}

std::string soil(double friction, double dilation, double cohesion = 2e4, double hardening = 0) {
  return "plasticity = { type = \"drucker_prager\", cohesion = " + std::to_string(cohesion) +
         ", friction_angle = " + std::to_string(friction) + ", dilatancy_angle = " + std::to_string(dilation) +
         ", hardening = " + std::to_string(hardening) + ", fit = \"plane_strain\" }\n";
}

TEST(PlasticRun, ModifiedAndFullNewtonMeetTheSameState) {
  for (const double dilation : {0.4, 0.1}) {
    const Prepared made = prepared(block_on_soil(soil(0.4, dilation), springs, static_push));
    const Rest modified = rest_of(made.built, 5, {.newton = Newton::modified, .iterations = 400}),
               full = rest_of(made.built, 5, {.newton = Newton::full}), automatic = rest_of(made.built, 5, {});
    ASSERT_TRUE(modified.outcome.converged) << modified.outcome.why;
    ASSERT_TRUE(full.outcome.converged) << full.outcome.why;
    ASSERT_TRUE(automatic.outcome.converged) << automatic.outcome.why;
    const double size = full.state.displacement.norm();
    EXPECT_LE((modified.state.displacement - full.state.displacement).norm(), 1e-8 * size) << dilation;
    EXPECT_LE((automatic.state.displacement - full.state.displacement).norm(), 1e-8 * size) << dilation;
    EXPECT_LE((modified.state.force - full.state.force).norm(), 1e-8 * full.state.force.norm()) << dilation;
    EXPECT_EQ(modified.counts.factorisations, 1);
    EXPECT_GT(full.counts.factorisations, 1);
    EXPECT_GT(full.counts.factorisations, 4);
    EXPECT_LE(full.counts.analyses, 2);  // of the elastic matrix, and one of all tangents
    // the soil matters: without yielding the block settles less
    const Prepared elastic = prepared(block_on_soil("", springs, static_push));
    EXPECT_LT(settlement(made.built, full.state), 1.02 * settlement(elastic.built, rest_of(elastic.built, 5, {}).state));
  }
}

TEST(PlasticRun, FullNewtonConvergesQuadratically) {
  const Prepared made = prepared(block_on_soil(soil(0.4, 0.4), springs, static_push));
  const Rest rest = rest_of(made.built, 5, {.newton = Newton::full});
  ASSERT_TRUE(rest.outcome.converged) << rest.outcome.why;
  const std::vector<double>& r = rest.outcome.newton;
  ASSERT_GE(r.size(), 3u);
  ASSERT_LE(r.size(), 9u);
  // near the solution the exponent log(r[k+1]/r[k]) / log(r[k]/r[k-1]) is 2; round-off ends it
  double exponent = 0;
  for (std::size_t k = 1; k + 1 < r.size(); ++k)
    if (r[k] < 0.3 * r[k - 1]) exponent = std::max(exponent, std::log(r[k + 1] / r[k]) / std::log(r[k] / r[k - 1]));
  EXPECT_GT(exponent, 1.7);
}

TEST(PlasticRun, EnergyClosesWithUpliftSlidingAndYielding) {
  for (const double dilation : {0.4, 0.1}) {
    const Prepared made = prepared(block_on_soil(soil(0.4, dilation), springs, shaken(180e3)));
    const RunResult result = run(made.built.model, made.built.plan, made.built.behaviours);
    ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
    EXPECT_GT(result.max_uplifted_ratio.value, 0.2);
    const std::vector<double>& plastic = column(result, "energy.plastic");
    EXPECT_GT(plastic.back(), 0.01 * result.energy_scale);
    EXPECT_LE(std::max(result.energy_created, result.energy_lost), 1e-9 * result.energy_scale);
    EXPECT_GT(result.final_energy.interface_dissipated, 0);
  }
}

const std::string bottom = "[[support]]\ngroup = \"soil_bottom\"\nfixed = [\"ux\", \"uy\"]\n";

TEST(PlasticRun, EnergyClosesUnderAMovingBase) {
  const std::string moved =
      "[[support]]\ngroup = \"soil_bottom\"\nfixed = [\"uy\"]\n[[motion]]\nname = \"base\"\ngroup = "
      "\"soil_bottom\"\ndirection = \"ux\"\namplitude = 0.01\nfunction = \"pulse\"\n";
  const Prepared made = prepared(support::replaced(block_on_soil(soil(0.4, 0.1), springs, shaken(1e3, 0.3)), bottom, moved));
  const RunResult result = run(made.built.model, made.built.plan, made.built.behaviours);
  ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
  EXPECT_GT(result.final_energy.plastic, 0.01 * result.energy_scale);
  EXPECT_LE(std::max(result.energy_created, result.energy_lost), 1e-9 * result.energy_scale);
}

TEST(PlasticRun, WithCohesionWithoutEndItIsTheLinearRun) {
  const Prepared strong = prepared(block_on_soil(soil(0.4, 0.1, 1e12), springs, shaken(100e3, 0.2))),
                 linear = prepared(block_on_soil("", springs, shaken(100e3, 0.2)));
  const RunResult a = run(strong.built.model, strong.built.plan, strong.built.behaviours),
                  b = run(linear.built.model, linear.built.plan, linear.built.behaviours);
  ASSERT_EQ(a.status, RunStatus::completed) << a.reason;
  EXPECT_EQ(a.final_energy.plastic, 0);
  for (const char* name : {"top.ux", "base.moment", "energy.strain"}) {
    const std::vector<double>&x = column(a, name), &y = column(b, name);
    ASSERT_EQ(x.size(), y.size());
    double size = 0;
    for (const double value : y) size = std::max(size, std::abs(value));
    for (std::size_t i = 0; i < x.size(); ++i) ASSERT_NEAR(x[i], y[i], 1e-12 * size) << name << ' ' << i;
  }
  for (const Request& each : b.columns) EXPECT_NE(each.name, "energy.plastic");
}

TEST(PlasticRun, StepsBeginWithTheYieldingOfThoseBefore) {
  // A run that drops this guess at every step solves for the same answer, and solves more.
  const Prepared made = prepared(block_on_soil(soil(0.4, 0.1), springs, shaken(180e3)));
  const RunResult usual = run(made.built.model, made.built.plan, made.built.behaviours);
  Keeping keeping;
  keeping.every = 1;
  keeping.keep = [](const RunState&) {};
  const RunResult dropped = run(made.built.model, made.built.plan, made.built.behaviours, {}, {}, &keeping);
  ASSERT_EQ(usual.status, RunStatus::completed) << usual.reason;
  ASSERT_EQ(dropped.status, RunStatus::completed) << dropped.reason;
  EXPECT_LT(static_cast<double>(usual.counts.back_solves), 0.97 * static_cast<double>(dropped.counts.back_solves));
  for (const char* name : {"top.ux", "energy.plastic"}) {
    const std::vector<double>&x = column(usual, name), &y = column(dropped, name);
    ASSERT_EQ(x.size(), y.size());
    const double size = std::abs(*std::max_element(y.begin(), y.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
    for (std::size_t i = 0; i < x.size(); ++i) ASSERT_NEAR(x[i], y[i], 1e-7 * size) << name << ' ' << i;
  }
}

TEST(PlasticRun, CondensedStepIsTheMonolithicOne) {
  for (const std::string& behaviour : {springs, std::string("law = { type = \"coulomb\", friction = 0.5 }\n")}) {
    Prepared made = prepared(block_on_soil(soil(0.4, 0.1), behaviour, shaken(180e3, 0.04)));
    made.built.plan.oracle_tolerance = 1e-8;
    const RunResult result = run(made.built.model, made.built.plan, made.built.behaviours);
    EXPECT_EQ(result.status, RunStatus::completed) << result.reason;
  }
}

TEST(PlasticRun, YieldedSoilAtRestStaysAtRest) {
  // Also with Hilber, Hughes and Taylor's rule, which takes both ends of the step, and where supports are released.
  const std::string still = R"([[stage]]
type = "static"
[[stage]]
type = "dynamic"
step = 2e-3
duration = 0.02
)";
  const std::string yielding = block_on_soil(soil(0.3, 0.1, 1.2e4), springs, still);
  const std::string released = bottom + "stages = \"static\"\n[[absorbing]]\ngroup = \"soil_bottom\"\n";
  for (const std::string& text : {yielding, yielding + "scheme = { type = \"hht\" }\n", support::replaced(yielding, bottom, released)}) {
    const Prepared made = prepared(text);
    const RunResult result = run(made.built.model, made.built.plan, made.built.behaviours);
    ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
    const std::vector<double>& top = column(result, "top.uy");
    EXPECT_LT(top.front(), 0);
    for (const double value : top) EXPECT_NEAR(value, top.front(), 1e-9 * -top.front());
  }
}

TEST(PlasticRun, RefusesWhatTheLawCannotBe) {
  const auto refused = [](const std::string& plasticity) { return refusal(block_on_soil(plasticity, springs, static_push)); };
  EXPECT_NE(refused(soil(0.2, 0.4)).find("friction angle"), std::string::npos) << refused(soil(0.2, 0.4));
  EXPECT_NE(refused(soil(0, 0, 0)).find("above 0 Pa"), std::string::npos);
  EXPECT_NE(refused("plane = \"stress\"\n" + soil(0.4, 0)).find("plane = \"strain\""), std::string::npos);
  EXPECT_NE(refused("plasticity = { type = \"cam_clay\" }").find("drucker_prager"), std::string::npos);
  EXPECT_NE(refused("law = { type = \"druker_prager\" }").find("did you mean \"drucker_prager\""), std::string::npos);
  EXPECT_NE(refused("law = { cohesion = 1e4, friction_angle = 0.5 }").find("law.type"), std::string::npos);
  EXPECT_NE(refused("law = \"elastic\"\n" + soil(0.4, 0)).find("either law or plasticity"), std::string::npos);
}

TEST(PlasticRun, LawAndItsOlderNameAreTheSame) {
  const std::string parameters = "cohesion = 2e4, friction_angle = 0.4, dilatancy_angle = 0.1 }\n";
  const auto pushed = [](const std::string& law) {
    const Prepared made = prepared(block_on_soil(law, springs, static_push));
    return rest_of(made.built, 5, {});
  };
  const Rest named = pushed("law = { type = \"drucker_prager\", " + parameters), older = pushed("plasticity = { " + parameters),
             elastic = pushed("law = \"elastic\"\n"), absent = pushed("");
  ASSERT_TRUE(named.outcome.converged && older.outcome.converged && elastic.outcome.converged && absent.outcome.converged);
  EXPECT_EQ(named.state.displacement, older.state.displacement);
  EXPECT_EQ(elastic.state.displacement, absent.state.displacement);
  EXPECT_FALSE(named.state.bulk_history.empty());
  EXPECT_TRUE(elastic.state.bulk_history.empty());
}

TEST(PlasticSolid, YieldedForceAndEnergyAreWhatTheLinearSolidLacks) {
  std::mt19937 random(5);
  DruckerPragerParameters law;
  law.elastic = {3e9, 0.3, 2000};
  law.cohesion = 2e5;
  law.friction = 0.5;
  law.dilation = 0.2;
  law.hardening = 2e7;
  for (const SolidKind& kind : solid_kinds()) {
    if (kind.plane != PlaneState::strain) continue;
    const auto positions = distorted_nodes(kind.cell, 0.1, random);
    const NonlinearSolid solid(kind.cell, first_numbers(info(kind.cell).nodes), std::make_shared<const std::vector<Vec3>>(positions),
                               section_of(kind), std::make_shared<const DruckerPrager>(law));
    std::uniform_real_distribution<double> uniform(-1e-3, 1e-3);
    NonlinearSolid::Scratch scratch;
    Vector u0(solid.unknowns()), u1(solid.unknowns()), f0, f1;
    const std::vector<double> natural(static_cast<std::size_t>(solid.num_history()), 0.0);
    std::vector<double> old = natural, now = natural;
    for (int draw = 0; draw < 20 && !(solid.has_yielded(old) && solid.yields(old, now)); ++draw) {  // one that yields twice
      for (double& x : u0) x = uniform(random);
      for (double& x : u1) x = 3 * uniform(random);
      ASSERT_TRUE(solid.respond(u0, natural, old, scratch, &f0, nullptr).converged);
      ASSERT_TRUE(solid.respond(u1, old, now, scratch, &f1, nullptr).converged);
    }
    ASSERT_TRUE(solid.yields(old, now)) << kind.name;
    EXPECT_FALSE(solid.has_yielded(natural));
    Matrix k;
    solid.form({&k, nullptr, nullptr});
    Inelastic part;
    solid.find_inelastic(now, scratch, part);
    EXPECT_LE((k * u1 + part.force - f1).norm(), 1e-10 * f1.norm()) << kind.name;
    const double stored = solid.stored_energy(u1, now);
    EXPECT_NEAR(u1.dot(k * u1) / 2 + u1.dot(part.force) + part.energy, stored, 1e-10 * stored) << kind.name;
    // work of the mean force = change of the recoverable energy + dissipation
    const double work = (f0 + f1).dot(u1 - u0) / 2, gained = stored - solid.stored_energy(u0, old);
    EXPECT_NEAR(solid.dissipated(u0, old, u1, now), work - gained, 1e-9 * std::abs(work)) << kind.name;
  }
}

}  // namespace
}  // namespace uplift::plastic_test
