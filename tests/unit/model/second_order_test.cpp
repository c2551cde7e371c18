#include <gtest/gtest.h>

#include "unit/model/model_support.h"
#include "uplift/math/dense.h"
#include "uplift/model/damping.h"
#include "uplift/model/geometric.h"
#include "uplift/model/tuned_mass.h"

namespace uplift::second_order_test {
namespace {

using std::numbers::pi;
using support::here;

TEST(PDelta, WeightAboveTheMasterGivesMinusWH) {
  const double w = 2000 * 10.0, h = 2;
  {  // the mass has an offset centre
    ModelBuilder builder;
    builder.add_node("base", {0, 0}, here);
    builder.add_element(std::make_unique<PointMass>(0, 2000.0, 700.0, Vec2(0.3, h)), here);
    builder.add_element(std::make_unique<Spring>(Connection{{0}, std::nullopt}, 1e6), here);
    builder.fix(0, ux, here);
    builder.fix(0, uy, here);
    builder.set_gravity({0, -10}, here);
    const Model model = builder.finish();
    State state;
    state.displacement = support::static_solution(model);
    EXPECT_NEAR(Matrix(geometric_stiffness(model, state))(0, 0), -w * h, 1e-9);
  }
  {  // the mass is a slave, through a chain; a dead load beside it
    ModelBuilder builder;
    builder.add_node("base", {0, 0}, here);
    builder.add_node("middle", {0.4, 0.5}, here);
    builder.add_node("top", {0.3, h}, here);
    builder.tie_rigid(0, 1, here);
    builder.tie_rigid(1, 2, here);
    builder.add_element(std::make_unique<PointMass>(2, 2000.0, 700.0), here);
    builder.add_element(std::make_unique<Spring>(Connection{{0}, std::nullopt}, 1e6), here);
    builder.fix(0, ux, here);
    builder.fix(0, uy, here);
    builder.set_gravity({0, -10}, here);
    builder.add_load("pull", {{3, 500.0}, {4, -800.0}}, nullptr, true, here);
    const Model model = builder.finish();
    State state;
    state.displacement = support::static_solution(model);
    EXPECT_NEAR(Matrix(geometric_stiffness(model, state))(0, 0), -w * h + 500 * 0.4 - 800 * 0.5, 1e-9);
  }
  {  // the master is the centre of mass: the forces of the interface below it do the work
    const Model model = support::block_on_ground(h, {0, 1}, true)->finish();
    State state;
    Vector force = Vector::Zero(3);
    model.add_force(0, force);
    state.displacement = PivotedLdlt(Matrix(bonded_stiffness(model))).solve(force);
    const Interface& face = model.interfaces[0];
    state.opening = face.b * state.displacement;
    state.force = Vector::Zero(face.rows());
    state.force.tail(7) = 1e7 * face.area.cwiseProduct(state.opening.tail(7));
    EXPECT_NEAR(state.force.sum(), -w, 1e-8);
    Matrix expected = Matrix::Zero(3, 3);
    expected(2, 2) = -w * h;
    EXPECT_LE((Matrix(geometric_stiffness(model, state)) - expected).norm(), 1e-8);
  }
}

TEST(PDelta, MastWithInextensibleRodAndRigidFoot) {
  // pendulum: weight on a hinged inextensible string without a beam element, held sideways by a spring: stiffness k - W/L
  ModelBuilder builder;
  builder.add_node("foot", {0, 0}, here);
  builder.add_node("top", {0, 4}, here);
  builder.inextensible(0, 1, here);
  builder.add_element(std::make_unique<PointMass>(1, 2000.0), here);
  builder.add_element(std::make_unique<Spring>(Connection{{1}, Vec2(1, 0)}, 3e4), here);
  builder.fix(0, ux, here);
  builder.fix(0, uy, here);
  builder.set_gravity({0, -10}, here);
  const Model model = builder.finish();
  ASSERT_EQ(model.free(), 1);
  State state;
  state.displacement = support::static_solution(model);
  EXPECT_NEAR(Matrix(geometric_stiffness(model, state))(0, 0), -2e4 / 4, 1e-9);
  // reaction of the foot: carries the weight
  const Vector forces = constraint_forces(model, state);
  EXPECT_NEAR(forces.cwiseAbs().maxCoeff(), 2e4, 1e-8);
}

// ---- damping and tuned mass ----

TEST(Damping, Rayleigh) {
  const BulkDamping damping = rayleigh(2, 0.03, 11, 0.05);
  for (const auto& [f, ratio] : {std::pair(2.0, 0.03), std::pair(11.0, 0.05)}) {
    const double w = 2 * pi * f;
    EXPECT_NEAR(damping.alpha / (2 * w) + damping.beta * w / 2, ratio, 1e-15);
  }
}

TEST(Damping, StiffnessDampingPerPart) {
  ModelBuilder builder;
  builder.add_node("a", {0, 0}, here);
  auto first = std::make_unique<Spring>(Connection{{0}, Vec2(1, 0)}, 100.0);
  first->beta = 0.02;
  builder.add_element(std::move(first), here);
  builder.add_element(std::make_unique<Spring>(Connection{{0}, Vec2(1, 0)}, 300.0), here);
  builder.add_element(std::make_unique<Spring>(Connection{{0}, Vec2(0, 1)}, 300.0), here);
  builder.set_damping({.alpha = 0, .beta = 0.001, .modal = {}, .modal_count = 0});
  const Model model = builder.finish();
  EXPECT_NEAR(model.damping.coeff(0, 0), 100 * 0.021 + 300 * 0.001, 1e-14);
  EXPECT_NEAR(model.damping.coeff(1, 1), 0.3, 1e-14);
}

TEST(Damping, ModalRatiosOfTheBondedModel) {
  for (const bool cone : {false, true}) {
    ModelBuilder builder;
    builder.add_node("base", {0, 0}, here);
    builder.add_node("top", {0, 5}, here);
    support::add_beam(builder, 0, 1, {0, 0}, {0, 5}, support::bending_only(4e9));
    builder.add_element(std::make_unique<PointMass>(0, 1e4, 7500.0), here);
    builder.add_element(std::make_unique<PointMass>(1, 24317.0), here);
    InterfaceSpec spec = support::linear_interface("soil", footing_points({.body = 0, .width = 3, .points = 11}, here), {1e8, 2e8});
    if (cone) {
      spec.law.reset();
      spec.cone = std::make_unique<support::HardCone>(0.5);
    }
    builder.add_interface(std::move(spec), here);
    builder.set_damping({.alpha = 0, .beta = 0, .modal = {0.02, 0.07}, .modal_count = 9});
    const Model model = builder.finish();
    const Matrix held = cones_held(model), k = held.transpose() * Matrix(bonded_stiffness(model)) * held,
                 m = held.transpose() * Matrix(model.mass) * held, c = held.transpose() * Matrix(model.damping) * held;
    EXPECT_EQ(held.cols(), cone ? 2 : 5);  // with the cone the base is held in all three unknowns
    // independent eigenvalues: massless rotation of the top condensed by hand (the last unknown)
    const Index n = k.rows() - 1;
    const Matrix kc = k.topLeftCorner(n, n) - k.topRightCorner(n, 1) * k.bottomLeftCorner(1, n) / k(n, n), mc = m.topLeftCorner(n, n);
    const GeneralisedEigen eigen(kc, mc);
    EXPECT_LE(c.rightCols(1).norm(), 1e-9 * c.norm());
    for (Index i = 0; i < n; ++i) {
      const Vector phi = eigen.eigenvectors().col(i);
      const double w = std::sqrt(eigen.eigenvalues()[i]);
      EXPECT_NEAR(phi.dot(c.topLeftCorner(n, n) * phi) / (2 * w), i == 0 ? 0.02 : 0.07, 1e-10) << cone << i;
    }
  }
}

TEST(TunedMass, ReferenceOscillator) {
  // M h^3 = 3 E I/(2 pi f)^2 with E I = 4e9 N m2, h = 5 m, f = 10 Hz
  ModelBuilder builder;
  builder.add_node("base", {0, 0}, here);
  builder.add_node("top", {0, 5}, here);
  support::add_beam(builder, 0, 1, {0, 0}, {0, 5}, support::bending_only(4e9));
  builder.add_element(std::make_unique<PointMass>(0, 1e4, 7500.0), here);
  builder.add_interface(support::linear_interface("soil", footing_points({.body = 0, .width = 3, .points = 11}, here), {2e8}), here);
  builder.fix(0, ux, here);
  const Model model = builder.finish();
  const double mass = tuned_mass(model, 1, 10, here);
  EXPECT_NEAR(mass, 3 * 4e9 / std::pow(2 * pi * 10, 2) / 125, 1e-9 * mass);
  EXPECT_NEAR(mass, 24317.0841, 1e-4);
}

TEST(TunedMass, WithOtherMassesAndRefusals) {
  const auto mast = [](double tuned, double other) {
    ModelBuilder builder;
    for (int i = 0; i <= 4; ++i) builder.add_node("n" + std::to_string(i), {0.3 * i, 1.0 * i}, here);
    for (int i = 0; i < 4; ++i)
      support::add_beam(builder, i, i + 1, {0.3 * i, 1.0 * i}, {0.3 * (i + 1), 1.0 * (i + 1)}, support::general(1e7, 1e9));
    builder.add_element(std::make_unique<PointMass>(2, other), here);
    if (tuned > 0) builder.add_element(std::make_unique<PointMass>(4, tuned), here);
    for (const Dof dof : {ux, uy, rz}) builder.fix(0, dof, here);
    return builder.finish();
  };
  const double mass = tuned_mass(mast(0, 50), 4, 3, here);
  const Model tuned = mast(mass, 50);
  const GeneralisedEigen eigen(Matrix(tuned.stiffness), Matrix(tuned.mass));
  EXPECT_NEAR(std::sqrt(eigen.eigenvalues()[0]) / (2 * pi), 3, 1e-9);
  EXPECT_EQ(
      support::refusal([&] { tuned_mass(mast(0, 1e6), 4, 3, here); }),
      "case.toml:7: mass.tuned_frequency: expected a first fixed-base frequency of 3 Hz by the mass on \"n4\", found a structure that "
      "is loose or has its "
      "first frequency below already without this mass");
  EXPECT_NE(support::refusal([&] { tuned_mass(mast(0, 50), 0, 3, here); }).find("a node that cannot move when the base is held"),
            std::string::npos);
}

}  // namespace
}  // namespace uplift::second_order_test
