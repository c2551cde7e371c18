#include "uplift/dynamics/statics.h"

#include <cmath>

#include "property/oracle_models.h"
#include "unit/contact/contact_support.h"

// The static stage of a rigid block without structure: nothing but the contact holds it. Below the load that slides it or turns it over it
// rests, by every method; beyond there is no equilibrium, and the stage says so.
namespace uplift::contact_test::statics_test {
namespace {

constexpr double width = 2, weight = 1e5, friction = 0.4;
constexpr int points = 21;

struct Rest {
  StaticOutcome outcome;
  State state;
  double pressure = 0, shear = 0, moment = 0;  // resultants on the block: N, N, N m about the middle
};

/// A horizontal force at a height above the base.
Rest rest(const std::string& name, bool rubs, double push, double height) {
  whole::Whole whole;
  ModelBuilder builder;
  const int base = builder.add_node("base", {0, 0}, whole::here);
  builder.add_element(std::make_unique<PointMass>(base, 1e4, 1e4), whole::here);
  if (!rubs) builder.fix(base, ux, whole::here);
  builder.add_load("weight", {{3 * base + 1, -weight}}, nullptr, true, whole::here);
  builder.add_load("push", {{3 * base, push}, {3 * base + 2, -push * height}}, nullptr, true, whole::here);
  InterfaceSpec spec;
  spec.name = "footing";
  whole::Whole unused;
  uplift::Footing plan;
  plan.body = base;
  plan.width = width;
  plan.points = points;
  spec.points = footing_points(plan, whole::here);
  whole::Part behaviour = rubs ? whole::Part{"coulomb", {{"friction", friction}}} : whole::Part{"unilateral"};
  if (name == "newton") behaviour = {"springs", {{"K_n", 1e9}, {"tangential", std::string("none")}}};
  if (name == "newton" && rubs) behaviour = {"springs", {{"K_n", 1e9}, {"tangential", std::string("coulomb")}, {"friction", friction}}};
  whole::behave(behaviour, spec, whole);
  builder.add_interface(std::move(spec), whole::here);
  whole.model = builder.finish();
  const auto chosen = method(name, name == "penalty" ? Numbers{{"stiffness", 1e9}} : Numbers{});
  const auto solver = make_part(solver_catalog(), whole::checked({"cholmod"}, linear_solvers()));
  const Bulk bulk(whole.model, nullptr);
  const Sparse b = stack_interfaces(whole.model);
  const Vector gap = Vector::Zero(b.rows());
  const Behaviours none(whole.model, *method("lagrange"), nullptr);
  ContactModel probe = blocks_of(whole.model, none);
  probe.factor = Matrix::Zero(b.rows(), 1);
  const Behaviours behaviours(whole.model, *chosen, &probe);
  LinearCounts counts;
  Rest result;
  State& state = result.state;
  state.displacement = state.velocity = state.acceleration = Vector::Zero(whole.model.free());
  state.opening = state.force = state.mean_force = gap;
  state.history.setZero(behaviours.history);
  result.outcome = solve_statics({whole.model, bulk, b, gap}, {behaviours, *chosen}, *solver, {.steps = 4}, state, counts);
  const int normal = rubs ? points : 0;
  for (int i = 0; i < points; ++i) {
    result.pressure -= state.force[normal + i];
    result.moment -= state.force[normal + i] * width * (static_cast<double>(i) / (points - 1) - 0.5);
    if (rubs) result.shear -= state.force[i];
  }
  return result;
}

const std::vector<std::string> all_methods = {"newton", "penalty", "augmented_lagrangian", "lagrange"};

/// The reaction balances weight and push, whatever the law; on springs the block settles and tilts like a beam on elastic ground.
TEST(BlockAtRest, below_the_limit) {
  for (const std::string& name : all_methods)
    for (const bool rubs : {false, true})
      for (const double push : {0.1 * weight, 0.39 * weight})
        for (const double height : {0.0, 0.3 * width * weight / push}) {  // full contact up to width / 6
          if (!rubs && height == 0) continue;
          const Rest found = rest(name, rubs, push, height);
          SCOPED_TRACE(name + (rubs ? ", rubs" : ", smooth") + ", push " + std::to_string(push) + ", height " + std::to_string(height));
          ASSERT_TRUE(found.outcome.converged) << found.outcome.why;
          EXPECT_NEAR(found.pressure, weight, 1e-9 * weight);
          EXPECT_NEAR(found.moment, push * height, 1e-9 * weight * width);
          if (rubs) EXPECT_NEAR(found.shear, -push, 1e-9 * weight);
          const double settlement = found.state.displacement[rubs ? 1 : 0];
          if (name == "lagrange" || name == "augmented_lagrangian") {
            EXPECT_LE(found.state.displacement.cwiseAbs().maxCoeff(), 1e-11);
          } else if (height == 0) {
            EXPECT_NEAR(settlement, -weight / (1e9 * width), 1e-12);
            EXPECT_NEAR(found.state.displacement[0], push / (1e9 * width), 1e-12);
          }
        }
}

TEST(BlockAtRest, beyond_the_limit_there_is_no_equilibrium) {
  for (const std::string& name : all_methods) {
    for (const double share : {1.02, 1.5, 10.0}) {
      const Rest sliding = rest(name, true, share * friction * weight, 0);
      EXPECT_FALSE(sliding.outcome.converged) << name << " x " << share << ": " << sliding.state.displacement.transpose();
      EXPECT_NE(sliding.outcome.why.find("slides"), std::string::npos) << name << " x " << share << ": " << sliding.outcome.why;
      ASSERT_TRUE(sliding.outcome.failed.has_value());
      EXPECT_EQ(sliding.outcome.failed->rows(), 2 * points);
      for (const bool rubs : {false, true}) {
        // the pressure's resultant leaves the base at width / 2
        const double push = 0.5 * friction * weight, height = share * 0.5 * width * weight / push;
        const Rest turning = rest(name, rubs, push, height);
        EXPECT_FALSE(turning.outcome.converged) << name << rubs << " x " << share << ": " << turning.state.displacement.transpose();
        EXPECT_NE(turning.outcome.why.find("overturns"), std::string::npos)
            << name << rubs << " x " << share << ": " << turning.outcome.why;
      }
    }
  }
}

}  // namespace
}  // namespace uplift::contact_test::statics_test
