#include <gtest/gtest.h>

#include "unit/model/model_support.h"
#include "uplift/math/dense.h"
#include "uplift/model/check.h"

namespace uplift::checks_test {
namespace {

using support::here;
using support::loose_part;

TEST(Interfaces, FootingSeesTheRigidMotion) {
  const Model model = support::block_on_ground(2, {0, 1}, false)->finish();
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
  auto points = pair_points({{0, {0, 1}}}, {{1, {0, 0}}}, {0, 1}, 2.0, 1e-3, Space{2}, here);
  builder.add_interface(support::linear_interface("joint", points, {1e6}), here);
  const Model model = builder.finish();
  Vector opening = model.interfaces[0].b * Vector::Constant(model.free(), 0.0) + model.interfaces[0].gap;
  model.add_prescribed_opening(1, opening);
  EXPECT_NEAR(opening[0], 1e-3 - 6, 1e-15);
}

TEST(Interfaces, InsideOutIsRefused) {
  const std::string wanted = "expected a normal from the lower side (soil) to the upper side (structure), found an interface inside out: ";
  EXPECT_EQ(support::refusal([] {
              support::block_on_ground(2, {0, -1}, false)->finish();
            }),
            "case.toml:7: interface.base: " + wanted +
                "with the normal (0, -1) the whole upper side, which holds \"block\", lies on the wrong side of it");
  EXPECT_EQ(support::refusal([] { support::block_on_ground(0, {0, -1}, false)->finish(); }), "");  // the geometry does not tell

  const auto mast = [](Vec2 normal) {  // the master lies on the interface; the mast above it, and the centre of a mass, tell
    ModelBuilder builder;
    builder.add_node("base", {0, 0}, here);
    builder.add_node("top", {0, 5}, here);
    support::add_beam(builder, 0, 1, {0, 0}, {0, 5}, support::bending_only(1e6));
    builder.add_interface(
        support::linear_interface("soil", footing_points({.body = 0, .normal = normal, .width = 3, .points = 4}, here), {1e7}), here);
    builder.finish();
  };
  EXPECT_EQ(support::refusal([&] { mast({0, 1}); }), "");
  EXPECT_NE(support::refusal([&] { mast({0, -1}); }).find("interface.soil: " + wanted), std::string::npos);
  const auto offset = [](Vec2 normal) {
    ModelBuilder builder;
    builder.add_node("base", {0, 0}, here);
    builder.add_element(std::make_unique<PointMass>(0, 10.0, 1.0, Vec2(0, 1)), here);
    builder.add_interface(
        support::linear_interface("soil", footing_points({.body = 0, .normal = normal, .width = 3, .points = 4}, here), {1e7}), here);
    builder.finish();
  };
  EXPECT_EQ(support::refusal([&] { offset({0, 1}); }), "");
  EXPECT_NE(support::refusal([&] { offset({0, -1}); }).find("inside out"), std::string::npos);

  const auto blocks = [](bool exchanged) {  // soil column below, structure above; the sides exchanged
    ModelBuilder builder;
    for (const auto& [name, y] : {std::pair("rock", -4.0), std::pair("soil", 0.0), std::pair("foot", 0.0), std::pair("roof", 3.0)})
      builder.add_node(name, {0, y}, here);
    support::add_beam(builder, 0, 1, {0, -4}, {0, 0}, support::general(1e6, 1e8));
    support::add_beam(builder, 2, 3, {0, 0}, {0, 3}, support::general(1e6, 1e8));
    const SideNode soil{1, {0, 0}}, foot{2, {0, 0}};
    auto points =
        exchanged ? pair_points({soil}, {foot}, {0, 1}, 1, 0, Space{2}, here) : pair_points({foot}, {soil}, {0, 1}, 1, 0, Space{2}, here);
    builder.add_interface(support::linear_interface("joint", points, {1e7}), here);
    builder.finish();
  };
  EXPECT_EQ(support::refusal([&] { blocks(false); }), "");
  EXPECT_NE(support::refusal([&] { blocks(true); }).find("the whole upper side, which holds \"soil\", lies on the wrong side"),
            std::string::npos);
}

// ---- checks ----

TEST(Checks, LoosePartsAreNamed) {
  EXPECT_EQ(loose_part(support::block_on_ground(2, {0, 1}, false)->finish()), "");
  const auto free_sliding = [] {
    auto builder = std::make_unique<ModelBuilder>();
    builder->add_node("base", {0, 0}, here);
    builder->add_node("top", {0, 5}, here);
    builder->add_element(std::make_unique<PointMass>(0, 2000.0, 700.0), here);
    builder->add_element(std::make_unique<PointMass>(1, 2000.0), here);
    support::add_beam(*builder, 0, 1, {0, 0}, {0, 5}, support::bending_only(1e8));
    builder->add_interface(support::linear_interface("base", footing_points({.body = 0, .width = 3, .points = 7}, here), {1e7}), here);
    return builder;
  };
  EXPECT_EQ(
      support::refusal([&] { check_static(free_sliding()->finish()); }),
      "case.toml:7: expected a structure that stands when all its interfaces are closed, found a mechanism: \"base\", \"top\" can move "
      "along (1, 0) "
      "without resistance; hold it by a [[support]], a [[spring]] or K_t of an interface");
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
  for (int i = 0; i < 200; ++i) support::add_beam(builder, i, i + 1, {0.05 * i, 0}, {0.05 * (i + 1), 0}, support::general(1.0, 1e9));
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
  EXPECT_EQ(support::refusal([&] { oscillator(0, {0, 0}); }), "");  // the law of the interface holds the rotation
  EXPECT_NE(support::refusal([&] {
              oscillator(0, {1, 0});
            }).find("a motion of base.uy, base.rz without kinetic energy"),
            std::string::npos);

  ModelBuilder builder;  // massless rotation of the top with stiffness: fine
  builder.add_node("base", {0, 0}, here);
  builder.add_node("top", {0, 5}, here);
  support::add_beam(builder, 0, 1, {0, 0}, {0, 5}, support::bending_only(1e8));
  builder.add_element(std::make_unique<PointMass>(0, 2000.0, 10.0), here);
  builder.add_element(std::make_unique<PointMass>(1, 2000.0), here);
  builder.add_interface(support::linear_interface("soil", footing_points({.body = 0, .width = 3, .points = 4}, here), {1e6, 1e7}), here);
  EXPECT_NO_THROW(check_dynamic(builder.finish()));
}

}  // namespace
}  // namespace uplift::checks_test
