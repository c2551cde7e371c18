#include <gtest/gtest.h>

#include <cmath>

#include "unit/elements/solid_support.h"
#include "uplift/math/dense.h"

namespace uplift::solid_element_test {
namespace {

/// Symmetric strain of a displacement gradient, engineering shears.
Strain strain_of(const Mat3& g) {
  Strain e;
  e << g(0, 0), g(1, 1), g(2, 2), g(0, 1) + g(1, 0), g(1, 2) + g(2, 1), g(2, 0) + g(0, 2);
  return e;
}

/// Stress by Hooke's law in compliance form, solved for the stress: e_xx = (s_xx - nu (s_yy + s_zz))/E ...
Stress hooke(const ElasticMaterial& m, const Strain& strain) {
  Matrix compliance = Matrix::Zero(6, 6);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) compliance(i, j) = (i == j ? 1 : -m.poisson) / m.young;
    compliance(i + 3, i + 3) = 2 * (1 + m.poisson) / m.young;
  }
  return PartialLu(compliance).solve(Matrix(strain));
}

Mat3 random_gradient(int dimension, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1e-3, 1e-3);
  Mat3 g = Mat3::Zero();
  for (int i = 0; i < dimension; ++i)
    for (int j = 0; j < dimension; ++j) g(i, j) = uniform(random);
  return g;
}

/// Expected stress of a constant gradient in the state of the kind.
Stress expected_stress(const SolidKind& kind, const Mat3& g) {
  const ElasticMaterial m = section_of(kind).material;
  Mat3 full = g;
  if (info(kind.cell).dimension == 2 && kind.plane == PlaneState::stress) full(2, 2) = -m.poisson / (1 - m.poisson) * (g(0, 0) + g(1, 1));
  return hooke(m, strain_of(full));
}

/// Volume by the divergence theorem: sum over the sides of int x . n dA / dimension.
double volume_by_sides(Cell cell, const std::vector<Vec3>& positions) {
  double sum = 0;
  std::size_t first = 0;
  for (const Cell side : info(cell).sides) {
    std::vector<Vec3> on_side;
    for (int i = 0; i < info(side).nodes; ++i) on_side.push_back(positions[static_cast<std::size_t>(info(cell).side_nodes[first++])]);
    const CellRule rule = cell_rule(side, 6);
    for (std::size_t i = 0; i < rule.point.size(); ++i) {
      const CellShape shape = cell_shape(side, rule.point[i]);
      sum += rule.weight[i] * cell_position(shape, on_side).dot(cell_area_vector(shape, on_side, side));
    }
  }
  return sum / info(cell).dimension;
}

TEST(SolidElement, StiffnessIsSymmetricWithExactlyTheRigidMotionsFree) {
  std::mt19937 random(11);
  for (const SolidKind& kind : solid_kinds())
    for (int trial = 0; trial < 5; ++trial) {
      const auto positions = distorted_nodes(kind.cell, 0.15, random);
      Matrix k;
      single(kind.cell, positions, section_of(kind)).form({&k, nullptr, nullptr});
      EXPECT_EQ((k - k.transpose()).norm(), 0) << kind.name;
      const Vector values = SymmetricEigen(k).eigenvalues();
      const double largest = values[values.size() - 1];
      const int rigid = info(kind.cell).dimension == 2 ? 3 : 6;
      for (int i = 0; i < rigid; ++i) EXPECT_LE(std::abs(values[i]), 1e-13 * largest) << kind.name;
      EXPECT_GE(values[rigid], 1e-4 * largest) << kind.name;
    }
}

TEST(SolidElement, RigidRotationsMeetNoForce) {
  std::mt19937 random(12);
  for (const SolidKind& kind : solid_kinds()) {
    const int dimension = info(kind.cell).dimension;
    const auto positions = distorted_nodes(kind.cell, 0.15, random);
    Matrix k;
    single(kind.cell, positions, section_of(kind)).form({&k, nullptr, nullptr});
    Mat3 spin = random_gradient(dimension, random);
    spin = (spin - spin.transpose()).eval();
    const Vector u = linear_field(positions, dimension, spin);
    EXPECT_LE((k * u).norm(), 1e-13 * k.norm() * u.norm()) << kind.name;
  }
}

TEST(SolidElement, ConstantStrainGivesHookesStressAndEnergy) {
  std::mt19937 random(13);
  for (const SolidKind& kind : solid_kinds())
    for (int trial = 0; trial < 5; ++trial) {
      const int dimension = info(kind.cell).dimension;
      const auto positions = distorted_nodes(kind.cell, 0.15, random);
      const SolidSection section = section_of(kind);
      const Solid solid = single(kind.cell, positions, section);
      const Mat3 g = random_gradient(dimension, random);
      const Vector u = linear_field(positions, dimension, g);
      const Stress expected = expected_stress(kind, g);
      for (const Stress& s : solid.point_stress(u)) EXPECT_LE((s - expected).norm(), 1e-12 * expected.norm()) << kind.name;
      for (const Stress& s : solid.node_stress(u)) EXPECT_LE((s - expected).norm(), 1e-12 * expected.norm()) << kind.name;
      Matrix k;
      solid.form({&k, nullptr, nullptr});
      const double volume = volume_by_sides(kind.cell, positions) * (dimension == 2 ? section.thickness : 1);
      EXPECT_NEAR(solid.volume(), volume, 1e-13 * volume) << kind.name;
      const double energy = expected.dot(strain_of(g)) * volume;
      EXPECT_NEAR(u.dot(k * u), energy, 1e-12 * energy) << kind.name;
    }
}

TEST(SolidElement, NodalStressOfALinearFieldIsExactOnAnAffineCell) {
  // the fit to the corners' functions reproduces a linear stress; cells with one point know a constant only
  std::mt19937 random(14);
  for (const CellInfo& cell : all_cells()) {
    if (cell.dimension < 2 || cell.nodes == cell.corners) continue;  // second-order cells can carry a linear strain exactly
    Mat3 affine = 3 * random_gradient(cell.dimension, random) * 100 + Mat3::Identity();
    std::vector<Vec3> positions;
    for (int a = 0; a < cell.nodes; ++a) positions.push_back(affine * local_node(cell.cell, a));
    const SolidKind kind{"", cell.cell, false, PlaneState::strain};
    const Mat3 g = random_gradient(cell.dimension, random), bend = random_gradient(cell.dimension, random);
    const Vec3 along(0.3, -0.8, cell.dimension == 3 ? 0.5 : 0);
    // u = G x + (a . x) B x, grad u = G + (a . x) B + B x (x) a
    Vector u(cell.dimension * cell.nodes);
    for (int a = 0; a < cell.nodes; ++a) {
      const Vec3& x = positions[static_cast<std::size_t>(a)];
      u.segment(cell.dimension * a, cell.dimension) = (g * x + along.dot(x) * (bend * x)).head(cell.dimension);
    }
    const auto at_nodes = single(cell.cell, positions, section_of(kind)).node_stress(u);
    for (int a = 0; a < cell.nodes; ++a) {
      const Vec3& x = positions[static_cast<std::size_t>(a)];
      const Mat3 gradient = g + along.dot(x) * bend + (bend * x) * along.transpose();
      const Stress expected = expected_stress(kind, gradient);
      EXPECT_LE((at_nodes[static_cast<std::size_t>(a)] - expected).norm(), 1e-11 * expected.norm()) << cell.name;
    }
  }
}

TEST(SolidElement, MassOfRigidMotions) {
  // translation: total mass; consistent masses also have the exact moment of inertia on an affine cell
  std::mt19937 random(15);
  for (const SolidKind& kind : solid_kinds())
    for (const auto mass : {SolidSection::Mass::consistent, SolidSection::Mass::lumped}) {
      const int dimension = info(kind.cell).dimension;
      const auto positions = distorted_nodes(kind.cell, 0.15, random);
      SolidSection section = section_of(kind);
      section.mass = mass;
      Matrix m;
      single(kind.cell, positions, section).form({nullptr, &m, nullptr});
      EXPECT_EQ((m - m.transpose()).norm(), 0) << kind.name;
      const double total = section.material.density * volume_by_sides(kind.cell, positions) * (dimension == 2 ? section.thickness : 1);
      for (int i = 0; i < dimension; ++i) {
        Vector v = Vector::Zero(m.rows());
        for (Index a = i; a < v.size(); a += dimension) v[a] = 1;
        EXPECT_NEAR(v.dot(m * v), total, 1e-13 * total) << kind.name;
      }
      EXPECT_GT(SymmetricEigen(m).eigenvalues()[0], 0) << kind.name;
      if (mass == SolidSection::Mass::lumped) {
        EXPECT_EQ((m - Matrix(m.diagonal().asDiagonal())).norm(), 0) << kind.name;
        continue;
      }
      std::vector<Vec3> affine;
      const Mat3 map = Mat3::Identity() + 100 * random_gradient(dimension, random);
      for (int a = 0; a < info(kind.cell).nodes; ++a) affine.push_back(map * local_node(kind.cell, a));
      single(kind.cell, affine, section).form({nullptr, &m, nullptr});
      // int |G x|^2 dV with a rule that is exact for squares
      const Mat3 g = random_gradient(dimension, random);
      const Vector v = linear_field(affine, dimension, g);
      double expected = 0;
      const CellRule rule = cell_rule(kind.cell, 4);
      for (std::size_t p = 0; p < rule.point.size(); ++p)
        expected += rule.weight[p] * (g * map * rule.point[p]).squaredNorm() * map.determinant() * section.material.density *
                    (dimension == 2 ? section.thickness : 1);
      EXPECT_NEAR(v.dot(m * v), expected, 1e-12 * expected) << kind.name;
    }
}

TEST(SolidElement, ConsistentMassOfStraightCellsIsTheTextbookMatrix) {
  // Zienkiewicz & Taylor: tri3 m/12 (1 + d_ab), tet4 m/20 (1 + d_ab); rectangle m/36 [4 2 1 2]
  std::mt19937 random(16);
  for (const Cell cell : {Cell::tri3, Cell::tet4}) {
    const int d = info(cell).dimension;
    const Solid solid = single(cell, distorted_nodes(cell, 0.2, random), section_of({"", cell, false, PlaneState::strain}));
    Matrix m;
    solid.form({nullptr, &m, nullptr});
    const double total = 2000 * solid.volume();
    for (int a = 0; a <= d; ++a)
      for (int b = 0; b <= d; ++b) EXPECT_NEAR(m(d * a, d * b), total * (a == b ? 2 : 1) / (d == 2 ? 12 : 20), 1e-13 * total);
  }
  Matrix m;
  single(Cell::quad4, {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}}, section_of({"", Cell::quad4, true, PlaneState::strain}))
      .form({nullptr, &m, nullptr});
  const double total = 2000 * 6 * 0.7, expected[] = {4, 2, 1, 2};
  for (int b = 0; b < 4; ++b) EXPECT_NEAR(m(1, 2 * b + 1), total / 36 * expected[b], 1e-13 * total);
}

TEST(SolidElement, TurnedAxesTurnTheMatrices) {
  // K of the turned element is R K R^T, 37 degrees in plan
  const double angle = 37 * 3.14159265358979323846 / 180;
  Mat3 turn = Mat3::Identity();
  turn.topLeftCorner<2, 2>() << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  std::mt19937 random(17);
  for (const SolidKind& kind : solid_kinds()) {
    const int d = info(kind.cell).dimension;
    const auto positions = distorted_nodes(kind.cell, 0.15, random);
    auto turned = positions;
    for (Vec3& x : turned) x = (turn * x).eval();
    Matrix k, of_turned, m, m_of_turned;
    single(kind.cell, positions, section_of(kind)).form({&k, &m, nullptr});
    single(kind.cell, turned, section_of(kind)).form({&of_turned, &m_of_turned, nullptr});
    Matrix r = Matrix::Zero(k.rows(), k.rows());
    for (Index a = 0; a < k.rows(); a += d) r.block(a, a, d, d) = turn.topLeftCorner(d, d);
    EXPECT_LE((of_turned - r * k * r.transpose()).norm(), 1e-13 * k.norm()) << kind.name;
    EXPECT_LE((m_of_turned - r * m * r.transpose()).norm(), 1e-13 * m.norm()) << kind.name;
  }
}

TEST(SolidElement, PlaneStrainIsASliceOfTheSolid) {
  // quad4 against hex8, tri3 against wedge6: extruded over the thickness, uz = 0, motions the same on both faces
  std::mt19937 random(18);
  struct Pair {
    Cell flat, solid;
  };
  for (const auto& [flat, solid] : {Pair{Cell::quad4, Cell::hex8}, Pair{Cell::tri3, Cell::wedge6}})
    for (const bool modes : {false, true}) {
      const SolidKind kind{"", flat, modes, PlaneState::strain};
      SolidSection section = section_of(kind);
      const auto base = distorted_nodes(flat, 0.15, random);
      auto both = base;
      for (const Vec3& x : base) both.push_back(x + Vec3(0, 0, section.thickness));
      Matrix k2, k3;
      single(flat, base, section).form({&k2, nullptr, nullptr});
      single(solid, both, section).form({&k3, nullptr, nullptr});
      const Index n = static_cast<Index>(base.size());
      Matrix slice = Matrix::Zero(6 * n, 2 * n);
      for (Index a = 0; a < n; ++a)
        for (Index i = 0; i < 2; ++i) slice(3 * a + i, 2 * a + i) = slice(3 * (a + n) + i, 2 * a + i) = 1;
      EXPECT_LE((slice.transpose() * k3 * slice - k2).norm(), 1e-13 * k2.norm()) << info(flat).name << modes;
    }
}

TEST(SolidMaterial, ConstantsAgree) {
  const ElasticMaterial m{20e9, 0.2, 2500};
  EXPECT_NEAR(m.bulk(), m.lame() + 2.0 / 3 * m.shear(), 1e-4);
  EXPECT_NEAR(m.young, m.shear() * (3 * m.lame() + 2 * m.shear()) / (m.lame() + m.shear()), 1e-4);
  EXPECT_NEAR(m.constrained(), m.young * (1 - m.poisson) / ((1 + m.poisson) * (1 - 2 * m.poisson)), 1e-4);
  EXPECT_NEAR(m.p_wave_speed() / m.s_wave_speed(), std::sqrt((2 - 2 * m.poisson) / (1 - 2 * m.poisson)), 1e-14);
  EXPECT_NEAR(m.plane_lame(PlaneState::stress), 2 * m.lame() * m.shear() / m.constrained(), 1e-4);
  const ElasticMaterial soil = material_of_wave_speed(200, 0.3, 1900);
  EXPECT_NEAR(soil.s_wave_speed(), 200, 1e-12);
  std::mt19937 random(19);
  const Strain strain = strain_of(random_gradient(3, random));
  EXPECT_LE((elastic_matrix(m) * strain - hooke(m, strain)).norm(), 1e-13 * hooke(m, strain).norm());
}

TEST(SolidMaterial, RefusesWhatCannotBe) {
  const Where where{"case.toml", 7};
  EXPECT_NO_THROW(check_material({1e9, 0, 0}, where, "soil"));
  for (const ElasticMaterial& bad :
       {ElasticMaterial{0, 0.3, 1}, ElasticMaterial{-1, 0.3, 1}, ElasticMaterial{1e9, 0.5, 1}, ElasticMaterial{1e9, -1, 1},
        ElasticMaterial{1e9, 0.3, -1}, ElasticMaterial{NAN, 0.3, 1}, ElasticMaterial{INFINITY, 0.3, 1}})
    EXPECT_THROW(check_material(bad, where, "soil"), InputError);
  try {
    check_material({1e9, 0.5, 1}, where, "soil[1]");
  } catch (const InputError& error) {
    EXPECT_EQ(error.path(), "soil[1].poisson");
    EXPECT_EQ(error.where().line, 7);
  }
}

}  // namespace
}  // namespace uplift::solid_element_test
