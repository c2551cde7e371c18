#include "uplift/model/mechanism.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "simple_meshes.h"
#include "unit/model/model_support.h"
#include "uplift/elements/solid.h"
#include "uplift/elements/space_beam.h"
#include "uplift/model/check.h"

namespace uplift::mechanism_test {
namespace {

using support::here;
using support::loose_part;

SolidSection soft_soil() {
  SolidSection section;
  section.material = {30e6, 0.3, 1900};
  return section;
}

/// Nodes and solids of a mesh; the mesh's node k is node k.
void add_solids(ModelBuilder& builder, const Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) builder.add_node("n" + std::to_string(i), mesh.nodes[i], here);
  const auto coordinates = std::make_shared<const std::vector<Vec3>>(mesh.nodes);
  for (const CellBlock& block : mesh.blocks)
    for (int i = 0; info(block.cell).dimension == mesh.dimension && i < block.count(); ++i)
      builder.add_element(std::make_unique<Solid>(block.cell, block[i], coordinates, soft_soil()), here);
}

std::vector<double> levels(int count) {
  std::vector<double> z;
  for (int i = 0; i <= count; ++i) z.push_back(0.37 * i);
  return z;
}

/// A column one cell wide; the nodes of each level have equal displacements (tied on all pairs of sides).
std::unique_ptr<ModelBuilder> tied_column(int dimension, int cells, bool held) {
  auto builder = std::make_unique<ModelBuilder>(Space{dimension});
  const Mesh mesh = dimension == 2 ? rectangle({0.1, 1.3}, levels(cells)) : box({0.1, 1.3}, {-0.7, 0.4}, levels(cells));
  add_solids(*builder, mesh);
  const auto same_level = [&](const Vec3& a, const Vec3& b) { return a[dimension - 1] == b[dimension - 1]; };
  const int each = dimension == 2 ? 2 : 4;
  std::vector<int> first(cells + 1, -1);
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i) {
    int level = static_cast<int>(std::lround(mesh.nodes[i][dimension - 1] / 0.37));
    EXPECT_LE(level, cells);
    int& master = first[level];
    for (int k = 0; k < dimension; ++k) {
      const Dof dof = Space{dimension}.dof(k);
      if (master >= 0) {
        EXPECT_TRUE(same_level(mesh.nodes[i], mesh.nodes[master]));
        builder->tie_equal(master, i, dof, here);
      }
      if (held && level == 0) builder->fix(i, dof, here, true);
    }
    if (master < 0) master = i;
  }
  EXPECT_EQ(static_cast<int>(mesh.nodes.size()), each * (cells + 1));
  return builder;
}

TEST(Mechanism, ATiedColumnStandsHoweverLong) {
  for (const int dimension : {2, 3})
    for (const int cells : {1, 5, 25, 30, 100, 1000}) {
      SCOPED_TRACE(std::to_string(dimension) + "D, " + std::to_string(cells) + " cells");
      const Model held = tied_column(dimension, cells, true)->finish();
      EXPECT_EQ(loose_part(held), "");
      EXPECT_NO_THROW(check_static(held));
      EXPECT_NO_THROW(check_dynamic(held));
      // without the support it moves: translations alone, since the ties hold the rotations
      const Model free = tied_column(dimension, cells, false)->finish();
      EXPECT_NE(loose_part(free).find("can move along"), std::string::npos) << loose_part(free);
      EXPECT_NO_THROW(check_dynamic(free));
    }
}

/// Two bars of beams, side by side; nothing holds them, or both are clamped at their feet.
std::unique_ptr<ModelBuilder> two_bars(int dimension, int elements, bool clamped) {
  auto builder = std::make_unique<ModelBuilder>(Space{dimension});
  for (int bar = 0; bar < 2; ++bar) {
    const int first = bar * (elements + 1);
    const auto at = [&](int i) { return dimension == 2 ? Place(3 * bar, 0.1 * i) : Place(3 * bar, 0.02 * i, 0.1 * i); };
    for (int i = 0; i <= elements; ++i) builder->add_node("b" + std::to_string(bar) + "." + std::to_string(i), at(i), here);
    for (int i = 0; i < elements; ++i) {
      if (dimension == 2) {
        support::add_beam(*builder, first + i, first + i + 1, at(i).head<2>(), at(i + 1).head<2>(), support::general(1e3, 1e9));
      } else {
        SpaceBeamSection section;
        section.bending_y = section.bending_z = section.torsion = 1e3;
        section.axial = 1e9;
        section.mass = BeamSection::Mass::consistent;
        section.mass_per_length = 200;
        section.polar = 20;
        builder->add_element(std::make_unique<SpaceBeam>(first + i, first + i + 1, at(i), at(i + 1), section), here);
      }
    }
    for (int k = 0; clamped && k < Space{dimension}.unknowns(); ++k) builder->fix(first, Space{dimension}.dof(k), here);
  }
  return builder;
}

TEST(Mechanism, FreeBarsAreLooseHoweverLong) {
  for (const int dimension : {2, 3})
    for (const int elements : {1, 5, 30, 50, 200, 1000}) {
      SCOPED_TRACE(std::to_string(dimension) + "D, " + std::to_string(elements) + " elements");
      const Model free = two_bars(dimension, elements, false)->finish();
      EXPECT_NE(loose_part(free), "");
      EXPECT_THROW(check_static(free), InputError);
      EXPECT_NO_THROW(check_dynamic(free));  // they may move: they have mass
      const Model clamped = two_bars(dimension, elements, true)->finish();
      EXPECT_EQ(loose_part(clamped), "");
    }
}

TEST(Mechanism, SolidsThatTouchInOneNodeAreHinged) {
  // two squares that share a corner: the upper one turns about it
  ModelBuilder builder(Space{2});
  Mesh mesh = rectangle({0, 1}, {0, 1});
  const int shared = 3;
  ASSERT_EQ(mesh.nodes[shared], Vec3(1, 1, 0));
  for (const Vec3& x : {Vec3(2, 1, 0), Vec3(2, 2, 0), Vec3(1, 2, 0)}) mesh.nodes.push_back(x);
  mesh.block(Cell::quad4).nodes.insert(mesh.block(Cell::quad4).nodes.end(), {shared, 4, 5, 6});
  add_solids(builder, mesh);
  for (const int node : {0, 1})
    for (const Dof dof : {ux, uy}) builder.fix(node, dof, here);
  EXPECT_NE(loose_part(builder.finish()).find("can turn about the point (1, 1) m"), std::string::npos);
}

TEST(Mechanism, WhatHasNeitherMassNorStiffnessIsRefusedInDynamics) {
  ModelBuilder builder;
  builder.add_node("a", {0, 0}, here);
  builder.add_node("b", {1, 0}, here);
  builder.add_element(std::make_unique<PointMass>(0, 5.0, 1.0), here);
  builder.add_element(std::make_unique<Spring>(Connection{{0, 1}, Place{1, 0}, Space{2}, false}, 1e3), here);
  const Model model = builder.finish();
  EXPECT_EQ(loose_part(model, Resistance::dynamic), "");
  EXPECT_NE(loose_part(model), "");
  EXPECT_NO_THROW(check_dynamic(model));
  ModelBuilder pair;  // the middle of two springs in a row is held along them only
  pair.add_node("a", {0, 0}, here);
  pair.add_node("b", {1, 1}, here);
  pair.add_element(std::make_unique<PointMass>(0, 5.0, 1.0), here);
  pair.add_element(std::make_unique<Spring>(Connection{{0, 1}, Place{1, 1}, Space{2}, false}, 1e3), here);
  const Model skew = pair.finish();
  EXPECT_NE(support::refusal([&] {
              check_dynamic(skew);
            }).find("expected a stiffness, a mass, a dashpot or an interface against every motion, found \"b\" can move"),
            std::string::npos)
      << support::refusal([&] { check_dynamic(skew); });
}

TEST(Mechanism, AMasslessFootIsFineUnderATractionLawWhereTheStructureHoldsIt) {
  const auto mast = [](std::unique_ptr<const Cone> cone) {
    ModelBuilder builder;
    builder.add_node("base", {0, 0}, here);
    builder.add_node("top", {0, 5}, here);
    support::add_beam(builder, 0, 1, {0, 0}, {0, 5}, support::bending_only(1e8));
    builder.add_element(std::make_unique<PointMass>(1, 2000.0, 50.0), here);
    InterfaceSpec spec = support::linear_interface("soil", footing_points({.body = 0, .width = 3, .points = 4}, here), {1e6, 1e7});
    if (cone) spec.law.reset(), spec.cone = std::move(cone);
    builder.add_interface(std::move(spec), here);
    return builder.finish();
  };
  EXPECT_NO_THROW(check_dynamic(mast(nullptr)));  // the rotation of the foot is massless, the column holds it
  EXPECT_NE(support::refusal([&] { check_impulses(mast(nullptr)); }).find("has none"), std::string::npos);
  EXPECT_NE(support::refusal([&] { check_dynamic(mast(std::make_unique<support::HardCone>(0.5))); }).find("has none"), std::string::npos);
}

/// Independent of the program's search: the eigenvalues of the dense stiffness, scaled by the sizes of the terms that its diagonal is
/// summed of (the sum itself may be round-off).
int dense_nullity(const Model& model) {
  if (model.free() == 0) return 0;
  const Matrix t(model.reduction()), full(assembled(model, &Local::stiffness));
  Matrix k = t.transpose() * full * t, size = t.cwiseAbs().transpose() * full.cwiseAbs() * t.cwiseAbs();
  for (const Interface& face : model.interfaces) {
    const int points = face.batch.points;
    Vector closed(face.rows());
    std::vector<double> stiffness(face.batch.components);
    face.law->closed_stiffness(face.batch.components, stiffness.data());
    for (int r = 0; r < face.rows(); ++r) closed[r] = stiffness[r / points] * face.area[r % points];
    const Matrix b(face.b);
    k += b.transpose() * closed.asDiagonal() * b;
    size += b.cwiseAbs().transpose() * closed.asDiagonal() * b.cwiseAbs();
  }
  const Vector scale = size.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 1.0; });
  const SymmetricEigen eigen(scale.asDiagonal() * k * scale.asDiagonal());
  return static_cast<int>((eigen.eigenvalues().array() < 1e-11).count());
}

TEST(Mechanism, RandomModelsAgreeWithTheDenseEigenvalues) {
  int loose = 0, firm = 0;
  for (int seed = 0; seed < 300; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    const auto up_to = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    ModelBuilder builder;
    const int count = 3 + up_to(6);
    std::vector<Place> at;
    for (int i = 0; i < count; ++i) {
      at.emplace_back(2.0 * i + 0.1 * up_to(9), up_to(4) + 0.1 * up_to(9));
      builder.add_node("n" + std::to_string(i), at.back(), here);
      builder.add_element(std::make_unique<PointMass>(i, 5.0, 1.0), here);
    }
    for (int i = 1; i < count; ++i) {
      const int other = up_to(i);
      switch (up_to(5)) {
        case 0:
        case 1:
          support::add_beam(builder, other, i, at[other].head<2>(), at[i].head<2>(),
                            up_to(2) ? support::bending_only(2e3) : support::general(1e3, 1e6));
          break;
        case 2:
          builder.add_element(std::make_unique<Spring>(Connection{{other, i}, Place(at[i] - at[other]), Space{2}, false}, 1e4), here);
          break;
        case 3:
          builder.tie_rigid(other, i, here);
          break;
        default:
          for (const Place& direction : {Place(1, 0), Place(0, 1)})
            builder.add_element(std::make_unique<Spring>(Connection{{other, i}, direction, Space{2}, false}, 1e4), here);
      }
    }
    for (int k = up_to(7); k > 0; --k) builder.fix(up_to(count), std::array{ux, uy, rz}[static_cast<std::size_t>(up_to(3))], here, true);
    if (up_to(2)) {
      auto points = footing_points({.body = 0, .centre = {at[0].x(), at[0].y() - 1}, .width = 2, .points = 3}, here);
      builder.add_interface(support::linear_interface("base", points, up_to(2) ? std::vector<double>{1e5, 1e6} : std::vector<double>{1e6}),
                            here);
    }
    const Model model = builder.finish();
    const bool expected = dense_nullity(model) > 0;
    const std::string found = loose_part(model);
    EXPECT_EQ(!found.empty(), expected) << "seed " << seed << " " << found << " " << dense_nullity(model);
    if (const Vector motion = unresisted_motion(model, Resistance::stiffness); motion.size() > 0)
      EXPECT_LE((model.stiffness * motion).norm(), 1e-10 * Matrix(model.stiffness).norm() * motion.norm()) << seed;
    ++(expected ? loose : firm);
  }
  EXPECT_GT(loose, 50);
  EXPECT_GT(firm, 30);
}

TEST(Mechanism, RandomSolidsAgreeWithTheDenseEigenvalues) {
  int loose = 0, firm = 0;
  for (int seed = 0; seed < 60; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    const auto up_to = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    const int dimension = 2 + up_to(2);
    ModelBuilder builder(Space{dimension});
    const Mesh mesh = dimension == 2 ? rectangle({0, 1, 2.2}, {0, 1, 1.7}, std::array{Cell::quad4, Cell::tri3, Cell::quad8}[seed % 3])
                                     : box({0, 1}, {0, 1.2}, {0, 1, 1.7}, std::array{Cell::hex8, Cell::tet4, Cell::wedge6}[seed % 3]);
    add_solids(builder, mesh);
    const int nodes = static_cast<int>(mesh.nodes.size());
    for (int k = up_to(8); k > 0; --k) builder.fix(up_to(nodes), Space{dimension}.dof(up_to(dimension)), here, true);
    for (int k = up_to(5); k > 0; --k) {
      const int a = up_to(nodes), b = up_to(nodes);
      if (a != b) builder.tie_equal(a, b, Space{dimension}.dof(up_to(dimension)), here);
    }
    const Model model = builder.finish();
    const bool expected = dense_nullity(model) > 0;
    const std::string found = loose_part(model);
    EXPECT_EQ(!found.empty(), expected) << "seed " << seed << " " << found;
    ++(expected ? loose : firm);
  }
  EXPECT_GT(loose, 10);
  EXPECT_GT(firm, 10);
}

TEST(Supports, APlaneOfSymmetryMayHoldARigidBody) {
  // a rigid cap of four nodes over two planes of symmetry: each plane holds two of them
  ModelBuilder builder(Space{3});
  const std::vector<Vec3> corners{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
  for (std::size_t i = 0; i < corners.size(); ++i) builder.add_node("c" + std::to_string(i), corners[i], here);
  for (int i = 1; i < 4; ++i) builder.tie_rigid(0, i, here);
  builder.add_element(std::make_unique<PointMass>(Space{3}, 0, 5.0, Vec3(1, 1, 1)), here);
  for (const int node : {0, 2}) builder.fix(node, ux, here, true);
  for (const int node : {0, 1}) builder.fix(node, uy, here, true);
  const Model model = builder.finish();
  EXPECT_EQ(model.free(), 3);  // uz, rx, ry
}

}  // namespace
}  // namespace uplift::mechanism_test
