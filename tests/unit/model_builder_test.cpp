#include <gtest/gtest.h>

#include "model_support.h"
#include "uplift/math/dense.h"
#include "uplift/model/check.h"
#include "uplift/model/damping.h"
#include "uplift/model/geometric.h"
#include "uplift/model/tuned_mass.h"

namespace uplift {
namespace {

using std::numbers::pi;
using support::here;

BeamSection bending_only(double EI) {
  BeamSection section;
  section.bending = EI;
  return section;
}

BeamSection general(double EI, double EA) {
  BeamSection section;
  section.bending = EI;
  section.axial = EA;
  section.mass = BeamSection::Mass::consistent;
  section.mass_per_length = 200;
  return section;
}

Vector static_solution(const Model& model, double time = 0) {
  Vector force = Vector::Zero(model.free());
  model.add_force(time, force);
  return Matrix(model.stiffness).ldlt().solve(force);
}

// ---- elimination ----

/// A frame with everything: inclined inextensible beams, a rigid body with a chain of ties, a support on a slave, a prescribed motion.
struct Frame {
  std::vector<Vec2> x{{0, 0}, {1, 3}, {4, 3.5}, {5, 0}, {1.5, 3.2}, {2, 4}, {6, 1}};
  ModelBuilder builder;
  Matrix constraints;  // hand-written rows of the constraints on the full unknowns
  Vector values;       // their right-hand sides at t = 0 (motions have the value 1 then)

  explicit Frame(bool motion) {
    for (std::size_t i = 0; i < x.size(); ++i) builder.add_node("n" + std::to_string(i), x[i], here);
    support::add_beam(builder, 0, 1, x[0], x[1], bending_only(2e6));  // inextensible column, inclined
    support::add_beam(builder, 1, 2, x[1], x[2], general(1e6, 4e7));
    support::add_beam(builder, 2, 3, x[2], x[3], bending_only(3e6));  // inextensible
    support::add_beam(builder, 5, 6, x[5], x[6], general(1.5e6, 3e7));
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
    const Vector u = model.full(static_solution(model), 0, 0);
    EXPECT_LE((frame.constraints * u - frame.values).norm(), 1e-14);

    const Index n = 21, m = frame.constraints.rows();
    Matrix kkt = Matrix::Zero(n + m, n + m);
    const double scale = 1e6;
    kkt.topLeftCorner(n, n) = Matrix(model.assembly.stiffness);
    kkt.bottomLeftCorner(m, n) = scale * frame.constraints;
    kkt.topRightCorner(n, m) = scale * frame.constraints.transpose();
    Vector right = Vector::Zero(n + m);
    right[6] = 1e4, right[16] = -3e4, right[14] = 5e3;
    right.tail(m) = scale * frame.values;
    const Vector oracle = kkt.fullPivLu().solve(right).head(n);
    EXPECT_LE((u - oracle).norm(), 1e-11 * oracle.norm());
  }
}

TEST(Elimination, AgreesWithPenaltySprings) {
  Frame frame(true);
  const Model model = frame.builder.finish();
  const Vector u = model.full(static_solution(model), 0, 0);
  Vector errors(2);
  for (int k = 0; k < 2; ++k) {
    const double penalty = k == 0 ? 1e10 : 1e11;
    const Matrix stiff = Matrix(model.assembly.stiffness) + penalty * frame.constraints.transpose() * frame.constraints;
    Vector right = penalty * frame.constraints.transpose() * frame.values;
    right[6] += 1e4, right[16] += -3e4, right[14] += 5e3;
    errors[k] = (stiff.fullPivLu().solve(right) - u).norm() / u.norm();
  }
  EXPECT_LT(errors[1], 1e-3);
  EXPECT_NEAR(errors[0] / errors[1], 10, 0.5);  // the penalty's own error, 1/penalty
}

TEST(Elimination, MassAndDampingAreReducedWithTheSameMatrix) {
  Frame frame(false);
  frame.builder.set_damping({.alpha = 0.3, .beta = 1e-3, .modal = {}, .modal_count = 0});
  const Model model = frame.builder.finish();
  const Matrix t = model.reduction;
  EXPECT_LE((t.transpose() * Matrix(model.assembly.mass) * t - Matrix(model.mass)).norm(), 1e-12 * model.mass.norm());
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
  BeamSection bar = general(1e-3, 7);
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
  EXPECT_EQ(model.unknown_names, names);

  ModelBuilder loaded;
  loaded.add_node("mass", {0, 0}, here);
  loaded.add_element(std::make_unique<PointMass>(0, 5.0), here);
  loaded.add_load("twist", {{2, 1.0}}, nullptr, true, here);
  EXPECT_EQ(support::refusal([&] { loaded.finish(); }),
            "case.toml:7: twist: wanted a load on something that resists, found a load on mass.rz, which nothing holds");
}

TEST(Elimination, RoundOffIsNotStiffness) {
  // an inextensible bar at 60 degrees: along its axis nothing but the mass remains, and that is seen
  ModelBuilder builder;
  const Vec2 e(std::cos(pi / 3), std::sin(pi / 3));
  builder.add_node("a", {0, 0}, here);
  builder.add_node("b", 4 * e, here);
  support::add_beam(builder, 0, 1, {0, 0}, 4 * e, bending_only(3e9));
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
      for (const auto& [name, x] : {std::pair("a", Vec2(0, 0)), std::pair("b", Vec2(0, 2)), std::pair("c", Vec2(1, 2))}) builder.add_node(name, x, here);
      add(builder);
      builder.finish();
    });
  };
  const std::string tail =
      ", which follows from the other supports, rigid bodies and inextensible beams: its force would be undetermined; remove it";
  const std::string head = "case.toml:7: wanted constraints that do not repeat each other, found ";
  EXPECT_EQ(attempt([](ModelBuilder& b) { b.fix(0, ux, here), b.fix(0, ux, here); }), head + "a support of a.ux" + tail);
  EXPECT_EQ(attempt([](ModelBuilder& b) { b.tie_rigid(0, 1, here), b.tie_rigid(1, 0, here); }), head + "a rigid body that ties \"a\" to \"b\"" + tail);
  EXPECT_EQ(attempt([](ModelBuilder& b) { b.tie_rigid(0, 1, here), b.inextensible(0, 1, here); }),
            head + "an inextensible beam from \"a\" to \"b\"" + tail + ", or give the beam its area A");
  EXPECT_EQ(attempt([](ModelBuilder& b) {
              b.fix(0, uy, here), b.inextensible(0, 1, here);
              b.fix(1, uy, here);  // supports come first, so the beam is the one too many
            }),
            head + "an inextensible beam from \"a\" to \"b\"" + tail + ", or give the beam its area A");
  EXPECT_EQ(attempt([](ModelBuilder& b) {
              b.fix(0, uy, here), b.inextensible(0, 1, here);
              b.prescribe(1, uy, std::make_shared<support::Parabola>(), "jack", here);
            }),
            "case.toml:7: wanted constraints that agree, found an inextensible beam from \"a\" to \"b\", which contradicts the prescribed motion of "
            "another constraint (prescribed: jack)");
  EXPECT_EQ(attempt([](ModelBuilder& b) { b.add_node("a", {3, 3}, here); }),
            "case.toml:7: nodes.a: wanted a name that no other node has, found \"a\" twice");
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
  for (int i = 0; i < 400; ++i) support::add_beam(builder, i, i + 1, 0.1 * i * e, 0.1 * (i + 1) * e, bending_only(1e6));
  const Model model = builder.finish();
  EXPECT_EQ(model.free(), 3 * 401 - 400);
}

// ---- loads ----

TEST(Loads, GravityGivesWeightAndFixedEndMoments) {
  ModelBuilder builder;
  builder.add_node("a", {0, 0}, here);
  builder.add_node("b", {2, 0}, here);
  support::add_beam(builder, 0, 1, {0, 0}, {2, 0}, general(1e6, 1e8));
  builder.add_element(std::make_unique<PointMass>(1, 30.0, 1.0, Vec2(0.5, 0.2)), here);
  builder.set_gravity({0, -9.81}, here);
  const Model model = builder.finish();
  ASSERT_EQ(model.drives.size(), 1u);
  EXPECT_TRUE(model.drives[0].dead);
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

// ---- interfaces ----

std::unique_ptr<ModelBuilder> block_on_ground(double height, Vec2 normal, bool with_gravity) {
  auto builder = std::make_unique<ModelBuilder>();
  builder->add_node("block", {0, height}, here);
  builder->add_element(std::make_unique<PointMass>(0, 2000.0, 700.0), here);
  builder->add_interface(support::linear_interface("base", footing_points({.body = 0, .normal = normal, .width = 3, .points = 7}, here), {4e6, 1e7}), here);
  if (with_gravity) builder->set_gravity({0, -10}, here);
  return builder;
}

TEST(Interfaces, FootingSeesTheRigidMotion) {
  const Model model = block_on_ground(2, {0, 1}, false)->finish();
  const Interface& face = model.interfaces[0];
  EXPECT_NEAR(face.area.sum(), 3, 1e-14);
  Vector q(3);
  q << 0.1, 0.2, 0.03;
  const Vector opening = face.b * q;
  for (int i = 0; i < 7; ++i) {
    EXPECT_NEAR(face.position[i].x(), -1.5 + 0.5 * i, 1e-14);
    EXPECT_NEAR(opening[7 + i], 0.2 + 0.03 * face.position[i].x(), 1e-15);  // n = y
    EXPECT_NEAR(opening[i], 0.1 + 0.03 * 2, 1e-15);                         // t = x: 2 m below the centre the base goes right
  }
}

TEST(Interfaces, PrescribedGroundMotionOpensTheJoint) {
  ModelBuilder builder;
  builder.add_node("up", {0, 1}, here);
  builder.add_node("down", {0, 0}, here);
  builder.add_element(std::make_unique<PointMass>(0, 5.0), here);
  for (const Dof dof : {ux, rz}) builder.fix(1, dof, here);
  builder.prescribe(1, uy, std::make_shared<support::Parabola>(), "ground", here);
  auto points = pair_points({{0, {0, 1}}}, {{1, {0, 0}}}, {0, 1}, 2.0, 1e-3, here);
  builder.add_interface(support::linear_interface("joint", points, {1e6}), here);
  const Model model = builder.finish();
  Vector opening = model.interfaces[0].b * Vector::Constant(model.free(), 0.0) + model.interfaces[0].gap;
  model.add_prescribed_opening(1, opening);
  EXPECT_NEAR(opening[0], 1e-3 - 6, 1e-15);
}

TEST(Interfaces, InsideOutIsRefused) {
  const std::string wanted = "wanted a normal from the lower side (soil) to the upper side (structure), found an interface inside out: ";
  EXPECT_EQ(support::refusal([] { block_on_ground(2, {0, -1}, false)->finish(); }),
            "case.toml:7: interface.base: " + wanted + "with the normal (0, -1) the whole upper side, which holds \"block\", lies on the wrong side of it");
  EXPECT_EQ(support::refusal([] { block_on_ground(0, {0, -1}, false)->finish(); }), "");  // the geometry does not tell

  const auto mast = [](Vec2 normal) {  // the master lies on the interface; the mast above it, and the centre of a mass, tell
    ModelBuilder builder;
    builder.add_node("base", {0, 0}, here);
    builder.add_node("top", {0, 5}, here);
    support::add_beam(builder, 0, 1, {0, 0}, {0, 5}, bending_only(1e6));
    builder.add_interface(support::linear_interface("soil", footing_points({.body = 0, .normal = normal, .width = 3, .points = 4}, here), {1e7}), here);
    builder.finish();
  };
  EXPECT_EQ(support::refusal([&] { mast({0, 1}); }), "");
  EXPECT_NE(support::refusal([&] { mast({0, -1}); }).find("interface.soil: " + wanted), std::string::npos);
  const auto offset = [](Vec2 normal) {
    ModelBuilder builder;
    builder.add_node("base", {0, 0}, here);
    builder.add_element(std::make_unique<PointMass>(0, 10.0, 1.0, Vec2(0, 1)), here);
    builder.add_interface(support::linear_interface("soil", footing_points({.body = 0, .normal = normal, .width = 3, .points = 4}, here), {1e7}), here);
    builder.finish();
  };
  EXPECT_EQ(support::refusal([&] { offset({0, 1}); }), "");
  EXPECT_NE(support::refusal([&] { offset({0, -1}); }).find("inside out"), std::string::npos);

  const auto blocks = [](bool exchanged) {  // soil column below, structure above; the sides exchanged
    ModelBuilder builder;
    for (const auto& [name, y] : {std::pair("rock", -4.0), std::pair("soil", 0.0), std::pair("foot", 0.0), std::pair("roof", 3.0)})
      builder.add_node(name, {0, y}, here);
    support::add_beam(builder, 0, 1, {0, -4}, {0, 0}, general(1e6, 1e8));
    support::add_beam(builder, 2, 3, {0, 0}, {0, 3}, general(1e6, 1e8));
    const SideNode soil{1, {0, 0}}, foot{2, {0, 0}};
    auto points = exchanged ? pair_points({soil}, {foot}, {0, 1}, 1, 0, here) : pair_points({foot}, {soil}, {0, 1}, 1, 0, here);
    builder.add_interface(support::linear_interface("joint", points, {1e7}), here);
    builder.finish();
  };
  EXPECT_EQ(support::refusal([&] { blocks(false); }), "");
  EXPECT_NE(support::refusal([&] { blocks(true); }).find("the whole upper side, which holds \"soil\", lies on the wrong side"), std::string::npos);
}

// ---- checks ----

TEST(Checks, LoosePartsAreNamed) {
  EXPECT_EQ(loose_part(block_on_ground(2, {0, 1}, false)->finish()), "");
  const auto free_sliding = [] {
    auto builder = std::make_unique<ModelBuilder>();
    builder->add_node("base", {0, 0}, here);
    builder->add_node("top", {0, 5}, here);
    builder->add_element(std::make_unique<PointMass>(0, 2000.0, 700.0), here);
    builder->add_element(std::make_unique<PointMass>(1, 2000.0), here);
    support::add_beam(*builder, 0, 1, {0, 0}, {0, 5}, bending_only(1e8));
    builder->add_interface(support::linear_interface("base", footing_points({.body = 0, .width = 3, .points = 7}, here), {1e7}), here);
    return builder;
  };
  EXPECT_EQ(support::refusal([&] { check_static(free_sliding()->finish()); }),
            "case.toml:7: wanted a structure that stands when all its interfaces are closed, found a mechanism: \"base\", \"top\" can move along (1, 0) "
            "without resistance");
  auto held = free_sliding();
  held->fix(0, ux, here);
  EXPECT_NO_THROW(check_static(held->finish()));

  ModelBuilder hinge;  // a body on one point joint can turn about it
  hinge.add_node("body", {1, 2}, here);
  hinge.add_element(std::make_unique<PointMass>(0, 2000.0, 700.0), here);
  JointPoint point;
  point.position = {1, 0};
  point.area = 1;
  point.upper = {{0, 1.0}};
  point.rigid_upper = true;
  hinge.add_interface(support::linear_interface("pin", {point}, {1e7, 1e7}), here);
  EXPECT_EQ(loose_part(hinge.finish()), "\"body\" can turn about the point (1, 0) m");
}

TEST(Checks, ConesHoldInTheirDirections) {
  const auto block = [](double friction, int components) {
    ModelBuilder builder;
    builder.add_node("block", {0, 2}, here);
    builder.add_element(std::make_unique<PointMass>(0, 2000.0, 700.0), here);
    InterfaceSpec spec;
    spec.name = "base";
    spec.components = components;
    spec.points = footing_points({.body = 0, .width = 1, .points = 2}, here);
    spec.cone = std::make_unique<support::HardCone>(friction);
    builder.add_interface(std::move(spec), here);
    return builder.finish();
  };
  EXPECT_EQ(loose_part(block(0.5, 2)), "");
  EXPECT_EQ(loose_part(block(0, 1)), "\"block\" can move along (1, 0)");
}

TEST(Checks, SoftIsNotLoose) {
  // slender: bending stiffness 1e-9 of the axial one, 200 elements
  ModelBuilder builder;
  for (int i = 0; i <= 200; ++i) builder.add_node("n" + std::to_string(i), {0.05 * i, 0}, here);
  for (int i = 0; i < 200; ++i) support::add_beam(builder, i, i + 1, {0.05 * i, 0}, {0.05 * (i + 1), 0}, general(1.0, 1e9));
  for (const Dof dof : {ux, uy, rz}) builder.fix(0, dof, here);
  EXPECT_EQ(loose_part(builder.finish()), "");
}

TEST(Checks, MassWhereItIsNeeded) {
  const auto oscillator = [](double inertia, Vec2 offset) {
    ModelBuilder builder;
    builder.add_node("base", {0, 0}, here);
    builder.add_element(std::make_unique<PointMass>(0, 2000.0, inertia, offset), here);
    builder.fix(0, ux, here);
    builder.add_interface(support::linear_interface("soil", footing_points({.body = 0, .width = 3, .points = 4}, here), {1e7}), here);
    check_dynamic(builder.finish());
  };
  EXPECT_EQ(support::refusal([&] { oscillator(10, {0, 0}); }), "");
  EXPECT_EQ(support::refusal([&] { oscillator(0, {0, 0}); }),
            "case.toml:7: interface.soil: wanted a mass on everything that the interface touches, found zero mass where mass is needed: base.rz has none");
  EXPECT_NE(support::refusal([&] { oscillator(0, {1, 0}); }).find("a motion of base.uy, base.rz without kinetic energy"), std::string::npos);

  ModelBuilder builder;  // massless rotation of the top with stiffness: fine
  builder.add_node("base", {0, 0}, here);
  builder.add_node("top", {0, 5}, here);
  support::add_beam(builder, 0, 1, {0, 0}, {0, 5}, bending_only(1e8));
  builder.add_element(std::make_unique<PointMass>(0, 2000.0, 10.0), here);
  builder.add_element(std::make_unique<PointMass>(1, 2000.0), here);
  builder.add_interface(support::linear_interface("soil", footing_points({.body = 0, .width = 3, .points = 4}, here), {1e6, 1e7}), here);
  EXPECT_NO_THROW(check_dynamic(builder.finish()));
}

// ---- P-Delta of rigid bodies ----

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
    state.displacement = static_solution(model);
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
    state.displacement = static_solution(model);
    EXPECT_NEAR(Matrix(geometric_stiffness(model, state))(0, 0), -w * h + 500 * 0.4 - 800 * 0.5, 1e-9);
  }
  {  // the master is the centre of mass: the forces of the interface below it do the work
    const Model model = block_on_ground(h, {0, 1}, true)->finish();
    State state;
    Vector force = Vector::Zero(3);
    model.add_force(0, force);
    state.displacement = Matrix(bonded_stiffness(model)).ldlt().solve(force);
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
  state.displacement = static_solution(model);
  EXPECT_NEAR(Matrix(geometric_stiffness(model, state))(0, 0), -2e4 / 4, 1e-9);
  // reaction of the foot: carries the weight
  const Vector forces = constraint_forces(model, state);
  EXPECT_NEAR(forces.cwiseAbs().maxCoeff(), 2e4, 1e-8);
}

// ---- damping, tuned mass, initial values ----

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
    support::add_beam(builder, 0, 1, {0, 0}, {0, 5}, bending_only(4e9));
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
    const Matrix held = cones_held(model), k = held.transpose() * Matrix(bonded_stiffness(model)) * held, m = held.transpose() * Matrix(model.mass) * held,
                 c = held.transpose() * Matrix(model.damping) * held;
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
  support::add_beam(builder, 0, 1, {0, 0}, {0, 5}, bending_only(4e9));
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
    for (int i = 0; i < 4; ++i) support::add_beam(builder, i, i + 1, {0.3 * i, 1.0 * i}, {0.3 * (i + 1), 1.0 * (i + 1)}, general(1e7, 1e9));
    builder.add_element(std::make_unique<PointMass>(2, other), here);
    if (tuned > 0) builder.add_element(std::make_unique<PointMass>(4, tuned), here);
    for (const Dof dof : {ux, uy, rz}) builder.fix(0, dof, here);
    return builder.finish();
  };
  const double mass = tuned_mass(mast(0, 50), 4, 3, here);
  const Model tuned = mast(mass, 50);
  const GeneralisedEigen eigen(Matrix(tuned.stiffness), Matrix(tuned.mass));
  EXPECT_NEAR(std::sqrt(eigen.eigenvalues()[0]) / (2 * pi), 3, 1e-9);
  EXPECT_EQ(support::refusal([&] { tuned_mass(mast(0, 1e6), 4, 3, here); }),
            "case.toml:7: mass.tuned_frequency: wanted a first fixed-base frequency of 3 Hz by the mass on \"n4\", found a structure that is loose or has its "
            "first frequency below already without this mass");
  EXPECT_NE(support::refusal([&] { tuned_mass(mast(0, 50), 0, 3, here); }).find("a node that cannot move when the base is held"), std::string::npos);
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
  EXPECT_NE(support::refusal([&] { free_values(model, {{3, -0.5}, {5, 0.2}}, here); }).find("case.toml:7: initial: wanted values that supports"),
            std::string::npos);
}

}  // namespace
}  // namespace uplift
