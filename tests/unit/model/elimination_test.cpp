#include <gtest/gtest.h>

#include "unit/model/model_support.h"
#include "uplift/math/dense.h"

namespace uplift::elimination_test {
namespace {

using std::numbers::pi;
using support::here;

/// A frame with everything: inclined inextensible beams, a rigid body with a chain of ties, a support on a slave, a prescribed motion.
struct Frame {
  std::vector<Vec2> x{{0, 0}, {1, 3}, {4, 3.5}, {5, 0}, {1.5, 3.2}, {2, 4}, {6, 1}};
  ModelBuilder builder;
  Matrix constraints;  // hand-written rows of the constraints on the full unknowns
  Vector values;       // their right-hand sides at t = 0 (motions have the value 1 then)

  explicit Frame(bool motion) {
    for (std::size_t i = 0; i < x.size(); ++i) builder.add_node("n" + std::to_string(i), x[i], here);
    support::add_beam(builder, 0, 1, x[0], x[1], support::bending_only(2e6));  // inextensible column, inclined
    support::add_beam(builder, 1, 2, x[1], x[2], support::general(1e6, 4e7));
    support::add_beam(builder, 2, 3, x[2], x[3], support::bending_only(3e6));  // inextensible
    support::add_beam(builder, 5, 6, x[5], x[6], support::general(1.5e6, 3e7));
    builder.add_element(std::make_unique<Spring>(Connection{{4, 6}, Vec2(1, 1)}, 2e5), here);
    builder.tie_rigid(1, 4, here);
    builder.tie_rigid(4, 5, here);  // a chain
    for (const Dof dof : {ux, uy, rz}) builder.fix(0, dof, here);
    builder.fix(3, ux, here);
    if (motion)
      builder.prescribe(3, uy, std::make_shared<support::Steady>(), "settlement", here);
    else
      builder.fix(3, uy, here);
    builder.fix(6, uy, here);
    builder.add_load("wind", {{3 * 2, 1e4}, {3 * 5 + 1, -3e4}, {3 * 4 + 2, 5e3}}, nullptr, true, here);

    std::vector<Vector> rows;
    std::vector<double> right;
    const auto row = [&](std::vector<std::pair<int, double>> entries, double value) {
      Vector r = Vector::Zero(21);
      for (const auto& [i, v] : entries) r[i] = v;
      rows.push_back(r);
      right.push_back(value);
    };
    for (const int i : {0, 1, 2, 9, 19}) row({{i, 1}}, 0);
    row({{10, 1}}, motion ? 1 : 0);
    for (const auto& [a, b] : {std::pair(0, 1), std::pair(2, 3)}) {
      const Vec2 e = (x[b] - x[a]).normalized();
      row({{3 * a, -e.x()}, {3 * a + 1, -e.y()}, {3 * b, e.x()}, {3 * b + 1, e.y()}}, 0);
    }
    for (const auto& [m, s] : {std::pair(1, 4), std::pair(1, 5)}) {
      const Vec2 r = x[s] - x[m];
      row({{3 * s, 1}, {3 * m, -1}, {3 * m + 2, r.y()}}, 0);
      row({{3 * s + 1, 1}, {3 * m + 1, -1}, {3 * m + 2, -r.x()}}, 0);
      row({{3 * s + 2, 1}, {3 * m + 2, -1}}, 0);
    }
    constraints.resize(static_cast<Index>(rows.size()), 21);
    values.resize(constraints.rows());
    for (Index i = 0; i < constraints.rows(); ++i) {
      constraints.row(i) = rows[i];
      values[i] = right[i];
    }
  }
};

TEST(Elimination, AgreesWithLagrangeMultipliersOnTheFullSystem) {
  for (const bool motion : {false, true}) {
    Frame frame(motion);
    const Model model = frame.builder.finish();
    EXPECT_EQ(model.free(), 21 - static_cast<int>(frame.constraints.rows()));
    const Vector u = model.full(support::static_solution(model), 0, 0);
    EXPECT_LE((frame.constraints * u - frame.values).norm(), 1e-14);

    const Index n = 21, m = frame.constraints.rows();
    Matrix kkt = Matrix::Zero(n + m, n + m);
    const double scale = 1e6;
    kkt.topLeftCorner(n, n) = Matrix(assembled(model, &Local::stiffness));
    kkt.bottomLeftCorner(m, n) = scale * frame.constraints;
    kkt.topRightCorner(n, m) = scale * frame.constraints.transpose();
    Vector right = Vector::Zero(n + m);
    right[6] = 1e4, right[16] = -3e4, right[14] = 5e3;
    right.tail(m) = scale * frame.values;
    const Vector oracle = PartialLu(kkt).solve(right).head(n);
    EXPECT_LE((u - oracle).norm(), 1e-11 * oracle.norm());
  }
}

TEST(Elimination, AgreesWithPenaltySprings) {
  Frame frame(true);
  const Model model = frame.builder.finish();
  const Vector u = model.full(support::static_solution(model), 0, 0);
  Vector errors(2);
  for (int k = 0; k < 2; ++k) {
    const double penalty = k == 0 ? 1e10 : 1e11;
    const Matrix stiff = Matrix(assembled(model, &Local::stiffness)) + penalty * frame.constraints.transpose() * frame.constraints;
    Vector right = penalty * frame.constraints.transpose() * frame.values;
    right[6] += 1e4, right[16] += -3e4, right[14] += 5e3;
    errors[k] = (PartialLu(stiff).solve(right) - u).norm() / u.norm();
  }
  EXPECT_LT(errors[1], 1e-3);
  EXPECT_NEAR(errors[0] / errors[1], 10, 0.5);  // the penalty's own error, 1/penalty
}

TEST(Elimination, MassAndDampingAreReducedWithTheSameMatrix) {
  Frame frame(false);
  frame.builder.set_damping({.alpha = 0.3, .beta = 1e-3, .modal = {}, .modal_count = 0});
  const Model model = frame.builder.finish();
  const Matrix t = model.reduction();
  EXPECT_LE((t.transpose() * Matrix(assembled(model, &Local::mass)) * t - Matrix(model.mass)).norm(), 1e-12 * model.mass.norm());
  EXPECT_LE((0.3 * Matrix(model.mass) + 1e-3 * Matrix(model.stiffness) - Matrix(model.damping)).norm(), 1e-12 * model.damping.norm());
  for (int i = 0; i < model.free(); ++i) {  // a free unknown is one of the full ones
    Vector q = Vector::Zero(model.free());
    q[i] = 1;
    EXPECT_DOUBLE_EQ(model.full(model.kept[i], q, 1, 0), 1);
  }
}

TEST(Elimination, PrescribedMotionDrives) {
  // two springs in line, the far end moves: q'' and q' come from -T^T (K s f + C s f' + M s f'')
  ModelBuilder builder;
  builder.add_node("a", {0, 0}, here);
  builder.add_node("b", {1, 0}, here);
  const Connection line{{0, 1}, Vec2(1, 0)};
  builder.add_element(std::make_unique<Spring>(line, 50.0), here);
  builder.add_element(std::make_unique<Dashpot>(line, 3.0), here);
  BeamSection bar = support::general(1e-3, 7);
  builder.add_element(std::make_unique<Beam>(0, 1, Vec2(0, 0), Vec2(1, 0), bar), here);
  for (const Dof dof : {uy, rz}) builder.fix(0, dof, here), builder.fix(1, dof, here);
  builder.prescribe(1, ux, std::make_shared<support::Parabola>(), "shaker", here);
  builder.set_damping({.alpha = 0.5, .beta = 0, .modal = {}, .modal_count = 0});
  const Model model = builder.finish();
  ASSERT_EQ(model.free(), 1);
  Vector force = Vector::Zero(1);
  model.add_force(2, force);  // f = 17, f' = 14, f'' = 6; beam mass 200 kg, coupling 200/6
  EXPECT_NEAR(force[0], 57 * 17 + (3 - 0.5 * 200 / 6) * 14 - 200.0 / 6 * 6, 1e-9);
  EXPECT_DOUBLE_EQ(model.full(3, Vector::Constant(1, 5.0), 0, 2), 17);
  EXPECT_DOUBLE_EQ(model.full(3, Vector::Constant(1, 5.0), 1, 2), 14);
  EXPECT_DOUBLE_EQ(model.full(3, Vector::Constant(1, 5.0), 2, 2), 6);
}

TEST(Elimination, UnknownsThatNothingResistsAreDropped) {
  ModelBuilder builder;
  builder.add_node("mass", {0, 0}, here);
  builder.add_node("eye", {0, 0}, here);
  builder.add_element(std::make_unique<PointMass>(0, 5.0), here);
  builder.add_element(std::make_unique<Spring>(Connection{{0, 1}, Vec2(1, 0)}, 3.0), here);
  builder.add_element(std::make_unique<Spring>(Connection{{1}, Vec2(1, 0)}, 6.0), here);
  const Model model = builder.finish();
  const std::vector<std::string> names{"mass.ux", "mass.uy", "eye.ux"};
  ASSERT_EQ(model.free(), std::ssize(names));
  for (Index i = 0; i < model.free(); ++i) EXPECT_EQ(model.unknown_name(i), names[static_cast<std::size_t>(i)]);

  ModelBuilder loaded;
  loaded.add_node("mass", {0, 0}, here);
  loaded.add_element(std::make_unique<PointMass>(0, 5.0), here);
  loaded.add_load("twist", {{2, 1.0}}, nullptr, true, here);
  EXPECT_EQ(support::refusal([&] { loaded.finish(); }),
            "case.toml:7: twist: expected a load on something that resists, found a load on mass.rz, which nothing holds");
}

TEST(Elimination, RoundOffIsNotStiffness) {
  // an inextensible bar at 60 degrees: along its axis nothing but the mass remains, and that is seen
  ModelBuilder builder;
  const Vec2 e(std::cos(pi / 3), std::sin(pi / 3));
  builder.add_node("a", {0, 0}, here);
  builder.add_node("b", 4 * e, here);
  support::add_beam(builder, 0, 1, {0, 0}, 4 * e, support::bending_only(3e9));
  for (const int node : {0, 1}) builder.add_element(std::make_unique<PointMass>(node, 10.0, 2.0), here);
  const Model model = builder.finish();
  EXPECT_EQ(model.free(), 5);
  Vector along = free_values(model, {{0, e.x()}, {1, e.y()}, {3, e.x()}, {4, e.y()}, {2, 0}, {5, 0}}, here);
  EXPECT_LE((model.stiffness * along).norm(), 1e-5);  // of 3e9
}

TEST(Elimination, RepeatedAndContradictingConstraintsAreRefused) {
  const auto attempt = [](auto add) {
    return support::refusal([&] {
      ModelBuilder builder;
      for (const auto& [name, x] : {std::pair("a", Vec2(0, 0)), std::pair("b", Vec2(0, 2)), std::pair("c", Vec2(1, 2))})
        builder.add_node(name, x, here);
      add(builder);
      builder.finish();
    });
  };
  const std::string tail =
      ", which follows from the other supports, rigid bodies and inextensible beams: its force would be undetermined; remove it";
  const std::string head = "case.toml:7: expected constraints that do not repeat each other, found ";
  EXPECT_EQ(attempt([](ModelBuilder& b) { b.fix(0, ux, here), b.fix(0, ux, here); }), head + "a support of a.ux" + tail);
  EXPECT_EQ(attempt([](ModelBuilder& b) { b.tie_rigid(0, 1, here), b.tie_rigid(1, 0, here); }),
            head + "a rigid body that ties \"a\" to \"b\"" + tail);
  EXPECT_EQ(attempt([](ModelBuilder& b) { b.tie_rigid(0, 1, here), b.inextensible(0, 1, here); }),
            head + "an inextensible beam from \"a\" to \"b\"" + tail + ", or give the beam its area A");
  EXPECT_EQ(attempt([](ModelBuilder& b) {
              b.fix(0, uy, here), b.inextensible(0, 1, here);
              b.fix(1, uy, here);  // supports come first, so the beam is the one too many
            }),
            head + "an inextensible beam from \"a\" to \"b\"" + tail + ", or give the beam its area A");
  EXPECT_EQ(
      attempt([](ModelBuilder& b) {
        b.fix(0, uy, here), b.inextensible(0, 1, here);
        b.prescribe(1, uy, std::make_shared<support::Parabola>(), "jack", here);
      }),
      "case.toml:7: expected constraints that agree, found an inextensible beam from \"a\" to \"b\", which contradicts the prescribed "
      "motion of "
      "another constraint (prescribed: jack)");
  EXPECT_EQ(attempt([](ModelBuilder& b) {
              b.add_node("a", {3, 3}, here);
            }),
            "case.toml:7: nodes.a: expected a name that no other node has, found \"a\" twice");
  // the same motion on both ends of the beam does not stretch it: one too many, but no contradiction
  EXPECT_EQ(attempt([](ModelBuilder& b) {
              b.tie_rigid(0, 1, here);
              b.fix(0, ux, here), b.fix(0, uy, here), b.fix(0, rz, here);
            }),
            "");
}

TEST(Elimination, LongInextensibleChain) {
  // 400 beams in a row share one axial unknown
  ModelBuilder builder;
  const Vec2 e = Vec2(3, 1).normalized();
  for (int i = 0; i <= 400; ++i) builder.add_node("n" + std::to_string(i), 0.1 * i * e, here);
  for (int i = 0; i < 400; ++i) support::add_beam(builder, i, i + 1, 0.1 * i * e, 0.1 * (i + 1) * e, support::bending_only(1e6));
  const Model model = builder.finish();
  EXPECT_EQ(model.free(), 3 * 401 - 400);
}

// ---- loads ----

TEST(Loads, GravityGivesWeightAndFixedEndMoments) {
  ModelBuilder builder;
  builder.add_node("a", {0, 0}, here);
  builder.add_node("b", {2, 0}, here);
  support::add_beam(builder, 0, 1, {0, 0}, {2, 0}, support::general(1e6, 1e8));
  builder.add_element(std::make_unique<PointMass>(1, 30.0, 1.0, Vec2(0.5, 0.2)), here);
  builder.set_gravity({0, -9.81}, here);
  const Model model = builder.finish();
  ASSERT_EQ(model.time_loads.size(), 1u);
  EXPECT_TRUE(model.time_loads[0].dead);
  Vector force = Vector::Zero(6);
  model.add_force(3, force);
  const double w = 200 * 9.81, l = 2;
  EXPECT_NEAR(force[1], -w * l / 2, 1e-9);
  EXPECT_NEAR(force[2], -w * l * l / 12, 1e-9);
  EXPECT_NEAR(force[4], -w * l / 2 - 30 * 9.81, 1e-9);
  EXPECT_NEAR(force[5], w * l * l / 12 - 30 * 9.81 * 0.5, 1e-9);
}

TEST(Loads, GroundAcceleration) {
  ModelBuilder builder;
  builder.add_node("a", {0, 0}, here);
  builder.add_node("b", {0, 2}, here);
  builder.tie_rigid(0, 1, here);
  builder.add_element(std::make_unique<PointMass>(1, 30.0), here);
  builder.add_element(std::make_unique<Spring>(Connection{{0}, std::nullopt}, 1e4), here);
  builder.fix(0, ux, here);
  builder.fix(0, uy, here);
  builder.add_ground_acceleration({1, 0}, std::make_shared<support::Parabola>(), "quake", here);
  const Model model = builder.finish();
  ASSERT_EQ(model.free(), 1);
  Vector force = Vector::Zero(1);
  model.add_force(1, force);
  EXPECT_NEAR(force[0], 30 * 2 * 6, 1e-10);  // -m a at height 2 turns the rod counter-clockwise
}

TEST(InitialValues, AreMetOrRefused) {
  ModelBuilder builder;
  builder.add_node("base", {0, 0}, here);
  builder.add_node("top", {0, 5}, here);
  builder.tie_rigid(0, 1, here);
  builder.add_element(std::make_unique<PointMass>(0, 1e4, 7500.0), here);
  builder.fix(0, ux, here);
  const Model model = builder.finish();
  const Vector q = free_values(model, {{3, -0.5}, {1, 0.2}}, here);
  EXPECT_NEAR(model.full(2, q, 0, 0), 0.1, 1e-15);
  EXPECT_NEAR(model.full(1, q, 0, 0), 0.2, 1e-15);
  EXPECT_NE(support::refusal([&] {
              free_values(model, {{3, -0.5}, {5, 0.2}}, here);
            }).find("case.toml:7: initial: expected values that supports"),
            std::string::npos);
}

}  // namespace
}  // namespace uplift::elimination_test
