// Ground that yields without hardening, driven past its strength: the outer Newton, its line search, and the balance of the incompatible
// modes.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "unit/elements/solid_support.h"
#include "unit/run/plastic_support.h"
#include "uplift/elements/bulk_laws/drucker_prager.h"
#include "uplift/elements/solid_nonlinear.h"

namespace uplift::plastic_collapse_test {
using namespace plastic_test;
namespace {

constexpr double cohesion = 20e3, width = 2, prandtl = 2 + std::numbers::pi;

/// A rigid strip that is pushed 0.1 m into clay, about ten times the settlement of its collapse.
std::string strip(double cell, int steps, const std::string& fit = "plane_strain") {
  const std::string size = std::to_string(cell);
  return R"(title = "strip on clay"
bonded = false
[mesh.soil_box]
cell = "quad4"
growth = 1.4
[mesh.soil_box.soil]
width = 10
size = )" +
         size + "\nlayers = [{ thickness = 3, size = " + size + " }]\n[mesh.soil_box.raft]\nwidth = 2\nheight = " + size +
         "\nsize = " + size +
         R"(
[[solid]]
group = "soil_1"
E = 6e7
poisson = 0.49
density = 1800
law = { type = "drucker_prager", cohesion = 20e3, friction_angle = 0, fit = ")" +
         fit + R"(" }
[[solid]]
group = "raft"
E = 3e10
poisson = 0.2
mass = "none"
[[support]]
group = "soil_bottom"
fixed = ["ux", "uy"]
[[support]]
group = "soil_left"
fixed = ["ux"]
[[support]]
group = "soil_right"
fixed = ["ux"]
[nodes]
m = [0, )" +
         size + R"(]
[[rigid]]
node = "m"
group = "raft"
[[support]]
node = "m"
fixed = ["ux", "rz"]
[[motion]]
node = "m"
direction = "uy"
amplitude = -0.1
[[interface]]
name = "i"
surface = { group = "interface", lower = ["soil_1"] }
law = { type = "springs", K_n = 1e11, K_t = 1e11 }
[[stage]]
type = "static"
steps = )" +
         std::to_string(steps) + R"(
[[output.history]]
name = "reaction"
node = "m"
quantity = "reaction_y"
)";
}

/// N/(c B) at the end of all load steps.
double bearing_factor(const RunResult& result) {
  return std::abs(column(result, "reaction").back()) / (cohesion * width);
}

TEST(PlasticCollapse, LoadStepsAfterTheLimitNeedNoHalving) {
  // Every number of load steps ends at the same limit load: perfectly plastic ground remembers no path there.
  const Prepared few = prepared(strip(0.5, 5)), many = prepared(strip(0.5, 20));
  const RunResult a = run(few.built.model, few.built.plan, few.built.behaviours),
                  b = run(many.built.model, many.built.plan, many.built.behaviours);
  ASSERT_EQ(a.status, RunStatus::completed) << a.reason;
  ASSERT_EQ(b.status, RunStatus::completed) << b.reason;
  EXPECT_EQ(a.counts.load_steps, 5);
  EXPECT_EQ(b.counts.load_steps, 20);
  EXPECT_EQ(a.counts.retries + b.counts.retries, 0);
  EXPECT_LE(b.counts.factorisations, 20 * 10);  // one a tangent
  EXPECT_NEAR(bearing_factor(a), bearing_factor(b), 1e-3 * prandtl);
}

TEST(PlasticCollapse, StripBearsWhatPrandtlFound) {
  // (2 + pi) c B. Cells of a rigid punch bear more, by a share that goes with their size to first order: the extrapolated strength is it.
  double bears[2];
  for (int k = 0; k < 2; ++k) {
    const Prepared made = prepared(strip(k == 0 ? 0.5 : 0.25, 10));
    const RunResult result = run(made.built.model, made.built.plan, made.built.behaviours);
    ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
    EXPECT_EQ(result.counts.retries, 0);
    bears[k] = bearing_factor(result);
  }
  EXPECT_GT(bears[0], bears[1]);
  EXPECT_GT(bears[1], prandtl);
  EXPECT_NEAR(2 * bears[1] - bears[0], prandtl, 0.02 * prandtl);
}

TEST(PlasticCollapse, IncompatibleModesBalanceFarBeyondYield) {
  // From the yield strain to a hundred times as much in one step. No force works on the modes, so the work of the mean nodal forces is what
  // the element stores and dissipates.
  std::mt19937 random(11);
  int yielded = 0;
  for (const double friction : {0.0, 0.5}) {
    DruckerPragerParameters law;
    law.elastic = {6e7, 0.49, 1800};
    law.cohesion = cohesion;
    law.friction = law.dilation = friction;
    for (const SolidKind& kind : solid_kinds()) {
      if (kind.plane != PlaneState::strain) continue;
      const auto positions = distorted_nodes(kind.cell, 0.1, random);
      const NonlinearSolid solid(kind.cell, first_numbers(info(kind.cell).nodes), std::make_shared<const std::vector<Vec3>>(positions),
                                 section_of(kind), std::make_shared<const DruckerPrager>(law));
      NonlinearSolid::Scratch scratch;
      Vector u(solid.unknowns()), force;
      const Vector still = Vector::Zero(solid.unknowns());
      const std::vector<double> natural(static_cast<std::size_t>(solid.num_history()), 0.0);
      for (int draw = 0; draw < 300; ++draw) {
        const double size = std::pow(10, std::uniform_real_distribution<double>(-3, -1)(random));
        for (double& x : u) x = size * std::uniform_real_distribution<double>(-1, 1)(random);
        std::vector<double> now = natural;
        const BulkResponse response = solid.respond(u, natural, now, scratch, &force, nullptr);
        ASSERT_TRUE(response.converged) << kind.name << ' ' << size << ": " << response.why;
        if (!solid.yields(natural, now)) continue;
        ++yielded;
        const double work = force.dot(u) / 2;
        EXPECT_NEAR(solid.stored_energy(u, now) + solid.dissipated(still, natural, u, now), work, 1e-8 * std::abs(work)) << kind.name;
      }
    }
  }
  EXPECT_GT(yielded, 1000);
}

}  // namespace
}  // namespace uplift::plastic_collapse_test
