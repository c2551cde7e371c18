#include "uplift/elements/space_beam.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <tuple>
#include <vector>

#include "uplift/math/dense.h"

namespace uplift::space_beam_test {
namespace {

using std::numbers::pi;

constexpr double EIy = 3e6, EIz = 1.1e6, GJ = 5e5, EA = 5e8, GAy = 4e6, GAz = 7e6;
constexpr double rho_a = 120, rho_iy = 7, rho_iz = 2.5, rho_ip = 11;

SpaceBeamSection section(bool shear, BeamSection::Mass mass) {
  SpaceBeamSection s;
  s.bending_y = EIy;
  s.bending_z = EIz;
  s.torsion = GJ;
  s.axial = EA;
  if (shear) s.shear_y = GAy, s.shear_z = GAz;
  s.mass_per_length = rho_a;
  s.rotary_y = rho_iy;
  s.rotary_z = rho_iz;
  s.polar = rho_ip;
  s.mass = mass;
  return s;
}

/// Without rotary inertia in bending: closed forms of frequencies are then those of Euler and Bernoulli.
SpaceBeamSection slender(BeamSection::Mass mass) {
  SpaceBeamSection s = section(false, mass);
  s.rotary_y = s.rotary_z = 0;
  return s;
}

class SpaceBeams : public testing::TestWithParam<unsigned> {
 protected:
  Vec3 vector() { return {uniform_(random_), uniform_(random_), uniform_(random_)}; }
  /// Rows are a right-handed orthonormal base.
  Mat3 rotation() {
    const Vec3 x = vector().normalized(), y = cross(vector(), x).normalized();
    Mat3 r;
    r.row(0) = x;
    r.row(1) = y;
    r.row(2) = cross(x, y);
    return r;
  }
  std::mt19937 random_{GetParam()};
  std::uniform_real_distribution<double> uniform_{-1, 1};
};
INSTANTIATE_TEST_SUITE_P(Seed, SpaceBeams, testing::Range(1u, 7u));

/// `r` in every block of three unknowns.
Matrix blocks(const Mat3& r, Index size) {
  Matrix t = Matrix::Zero(size, size);
  for (Index i = 0; i < size; i += 3) t.block<3, 3>(i, i) = r;
  return t;
}

struct Matrices {
  Matrix k, m, g;  // g: of a unit tension
};

Matrices matrices_of(const Element& beam) {
  Matrices a;
  beam.form({&a.k, &a.m, nullptr});
  beam.geometric(1, a.g);
  return a;
}

/// A straight line of beams in the axes of `axes` (rows x, y, z), the unknowns turned into these axes.
Matrices line(const Mat3& axes, double length, int elements, const SpaceBeamSection& section) {
  const Index n = 6 * (elements + 1);
  Matrices sum{Matrix::Zero(n, n), Matrix::Zero(n, n), Matrix::Zero(n, n)};
  for (int e = 0; e < elements; ++e) {
    const Vec3 along = axes.row(0).transpose() * length / elements;
    const Matrices beam = matrices_of(SpaceBeam(e, e + 1, e * along, (e + 1) * along, section, Vec3(axes.row(2))));
    sum.k.block(6 * e, 6 * e, 12, 12) += beam.k;
    sum.m.block(6 * e, 6 * e, 12, 12) += beam.m;
    sum.g.block(6 * e, 6 * e, 12, 12) += beam.g;
  }
  const Matrix t = blocks(axes, n);
  return {t * sum.k * t.transpose(), t * sum.m * t.transpose(), t * sum.g * t.transpose()};
}

/// The given unknowns of each of the nodes without the fixed ones.
std::vector<int> free_rows(int nodes, int unknowns, const std::vector<int>& kept, const std::vector<int>& fixed) {
  std::vector<int> rows;
  for (int node = 0; node < nodes; ++node)
    for (const int k : kept)
      if (const int row = unknowns * node + k; std::find(fixed.begin(), fixed.end(), row) == fixed.end()) rows.push_back(row);
  return rows;
}

/// Eigenvalues of A x = lambda B x in the given rows, ascending.
Vector eigenvalues(const Matrix& a, const Matrix& b, const std::vector<int>& rows) {
  return GeneralisedEigen(Matrix(a(rows, rows)), Matrix(b(rows, rows))).eigenvalues();
}

/// Unknowns of the three motions of a straight line, which do not couple.
const std::vector<int> in_xy{1, 5}, in_xz{2, 4}, twist{3};

/// Small rigid motion: a translation, or a rotation about an axis through a pole.
Vector rigid(const std::vector<Vec3>& positions, const Vec3& pole, int mode) {
  Vector u(6 * static_cast<Index>(positions.size()));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3 unit = Vec3::Unit(mode % 3);
    u.segment<3>(6 * static_cast<Index>(i)) = mode < 3 ? unit : cross(unit, positions[i] - pole);
    u.segment<3>(6 * static_cast<Index>(i) + 3) = mode < 3 ? Vec3(Vec3::Zero()) : unit;
  }
  return u;
}

// ---- axes ----

TEST_P(SpaceBeams, AxesFollowTheVectorUp) {
  const Vec3 along = 3 * vector(), up = 0.1 * vector();
  const Mat3 axes = beam_axes(along, up).value();
  EXPECT_LE((axes * axes.transpose() - Mat3::Identity()).norm(), 1e-14);
  EXPECT_NEAR(axes.row(0).dot(along), along.norm(), 1e-14);
  EXPECT_LE((cross(axes.row(0), axes.row(1)) - Vec3(axes.row(2))).norm(), 1e-14);
  EXPECT_NEAR(axes.row(1).dot(up), 0, 1e-15);  // up lies in the plane of x and z,
  EXPECT_GT(axes.row(2).dot(up), 0);           // on the side of z
}

TEST(SpaceBeam, DefaultAxes) {
  Mat3 axes = beam_axes({2, 0, 0}, {}).value();
  EXPECT_LE((axes - Mat3::Identity()).norm(), 1e-15);
  axes = beam_axes({0, 3, 0}, {}).value();
  EXPECT_LE((Vec3(axes.row(2)) - Vec3::UnitZ()).norm(), 1e-15);
  EXPECT_LE((Vec3(axes.row(1)) + Vec3::UnitX()).norm(), 1e-15);
  for (const double sign : {1.0, -1.0}) {  // columns
    axes = beam_axes({0, 0, sign * 4}, {}).value();
    EXPECT_LE((Vec3(axes.row(2)) - Vec3::UnitX()).norm(), 1e-15);
    EXPECT_LE((Vec3(axes.row(1)) + sign * Vec3::UnitY()).norm(), 1e-15);
  }
  EXPECT_FALSE(beam_axes({0, 0, 0}, {}));
  EXPECT_FALSE(beam_axes({1, 2, 3}, Vec3(-2, -4, -6)));
  EXPECT_FALSE(beam_axes({1, 2, 3}, Vec3(0, 0, 0)));
}

// ---- matrices ----

TEST_P(SpaceBeams, RigidMotionsMeetNoForce) {
  const Vec3 a = vector(), b = a + 2 * vector(), pole = vector();
  for (const bool shear : {false, true}) {
    const SpaceBeam beam(0, 1, a, b, section(shear, BeamSection::Mass::consistent), vector());
    const Matrices of = matrices_of(beam);
    for (const Matrix* matrix : {&of.k, &of.m, &of.g}) {
      ASSERT_EQ(matrix->rows(), 12);
      EXPECT_LE((*matrix - matrix->transpose()).norm(), 1e-14 * matrix->norm());
    }
    for (int mode = 0; mode < 6; ++mode) {
      const Vector u = rigid({a, b}, pole, mode);
      EXPECT_LE((of.k * u).norm(), 1e-13 * of.k.norm() * u.norm()) << mode;
      EXPECT_LE(beam.end_forces(u).norm(), 1e-13 * of.k.norm() * u.norm()) << mode;
    }
    const Vector lambda = SymmetricEigen(of.k).eigenvalues();
    EXPECT_GT(lambda[6], 1e-4 * lambda[11]);  // nothing else is free
    EXPECT_GT(SymmetricEigen(of.m).eigenvalues()[0], 0);
  }
}

TEST_P(SpaceBeams, TurnWithTheirAxes) {
  const Vec3 a = vector(), b = a + 2 * vector(), up = vector();
  const Mat3 r = rotation();
  const Matrix t = blocks(r, 12);
  for (const bool shear : {false, true})
    for (const auto mass : {BeamSection::Mass::consistent, BeamSection::Mass::lumped}) {
      const SpaceBeam here(0, 1, a, b, section(shear, mass), up), there(0, 1, r * a, r * b, section(shear, mass), Vec3(r * up));
      const Matrices first = matrices_of(here), turned = matrices_of(there);
      EXPECT_LE((turned.k - t * first.k * t.transpose()).norm(), 1e-12 * first.k.norm());
      EXPECT_LE((turned.m - t * first.m * t.transpose()).norm(), 1e-12 * first.m.norm());
      EXPECT_LE((turned.g - t * first.g * t.transpose()).norm(), 1e-12 * first.g.norm());
      Vector u(12);
      for (Index i = 0; i < 12; i += 3) u.segment<3>(i) = vector();
      EXPECT_LE((there.end_forces(t * u) - here.end_forces(u)).norm(), 1e-12 * here.end_forces(u).norm());
      EXPECT_NEAR(there.axial_force(t * u), here.axial_force(u), 1e-12 * EA);
    }
}

TEST_P(SpaceBeams, InThePlaneAreThePlaneBeam) {
  const std::vector<int> in_plane{0, 1, 5, 6, 7, 11}, others{2, 3, 4, 8, 9, 10};
  const Vec3 a = vector();
  for (const Vec3& along : {Vec3(vector().x(), vector().y(), 0), Vec3(0, 2, 0), Vec3(-1, 0, 0)})
    for (const bool shear : {false, true})
      for (const auto mass : {BeamSection::Mass::none, BeamSection::Mass::consistent, BeamSection::Mass::lumped}) {
        BeamSection plane{.bending = EIz, .axial = EA, .mass_per_length = rho_a, .rotary_per_length = rho_iz, .mass = mass};
        if (shear) plane.shear = GAy;
        const SpaceBeam beam(0, 1, a, a + along, section(shear, mass));
        const Beam flat(0, 1, a.head<2>(), (a + along).head<2>(), plane);
        const Matrices space = matrices_of(beam), expected = matrices_of(flat);
        for (auto matrix : {&Matrices::k, &Matrices::m, &Matrices::g}) {
          const Matrix &s = space.*matrix, &e = expected.*matrix;
          EXPECT_LE((s(in_plane, in_plane) - e).norm(), 1e-14 * e.norm());
          EXPECT_EQ(s(in_plane, others).norm(), 0);
        }
        Vector u(6), spread = Vector::Zero(12);
        for (int i = 0; i < 6; ++i) u[i] = spread[in_plane[i]] = uniform_(random_);
        EXPECT_LE((beam.end_forces(spread)(in_plane) - flat.end_forces(u)).norm(), 1e-14 * expected.k.norm());
        EXPECT_NEAR(beam.axial_force(spread), flat.axial_force(u), 1e-14 * EA);
      }
}

TEST(SpaceBeam, InextensibleOnesHaveNoAxialStiffness) {
  SpaceBeamSection stiff = section(false, BeamSection::Mass::consistent);
  stiff.axial.reset();
  stiff.polar.reset();
  const SpaceBeam beam(0, 1, Vec3::Zero(), {2, 0, 0}, stiff);
  const Matrices of = matrices_of(beam);
  EXPECT_EQ(of.k.row(0).norm(), 0);
  EXPECT_EQ(beam.axial_force(Vector::Ones(12)), 0);
  EXPECT_DOUBLE_EQ(of.m(3, 3), (rho_iy + rho_iz) * 2 / 3);  // perpendicular axes
}

// ---- statics ----

TEST_P(SpaceBeams, CantileverUnderEveryTipLoad) {
  const Mat3 axes = rotation();
  const double l = 2.3;
  const Vec3 a = vector(), b = a + l * axes.row(0).transpose();
  for (const bool shear : {false, true}) {
    const SpaceBeam beam(0, 1, a, b, section(shear, BeamSection::Mass::none), Vec3(axes.row(2)));
    const Matrix t = blocks(axes, 12), k = t * matrices_of(beam).k * t.transpose();
    const double sy = shear ? l / GAy : 0, sz = shear ? l / GAz : 0, l2 = l * l / 2, l3 = l * l * l / 3;
    Matrix flexibility = Matrix::Zero(6, 6);  // tip displacements of unit tip loads: Timoshenko, Strength of Materials
    flexibility(0, 0) = l / EA;
    flexibility(1, 1) = l3 / EIz + sy;
    flexibility(1, 5) = flexibility(5, 1) = l2 / EIz;
    flexibility(5, 5) = l / EIz;
    flexibility(2, 2) = l3 / EIy + sz;
    flexibility(2, 4) = flexibility(4, 2) = -l2 / EIy;  // a lift of the tip turns it from z to x: against r_y
    flexibility(4, 4) = l / EIy;
    flexibility(3, 3) = l / GJ;
    for (int load = 0; load < 6; ++load) {
      const Vector f = Vector::Unit(6, load), u = PartialLu(Matrix(k.bottomRightCorner(6, 6))).solve(f);
      EXPECT_LE((u - flexibility.col(load)).norm(), 1e-10 * u.norm()) << load;
      Vector local = Vector::Zero(12);
      local.tail(6) = u;
      const Vector end = beam.end_forces(t.transpose() * local);
      EXPECT_LE((end.tail(6) - f).norm(), 1e-9);
      EXPECT_LE((end.head<3>() + f.head<3>()).norm(), 1e-9);  // forces and moments about a are in balance
      EXPECT_LE((end.segment<3>(3) + f.tail<3>() + cross({l, 0, 0}, f.head<3>())).norm(), 1e-9);
      EXPECT_NEAR(beam.axial_force(t.transpose() * local), f[0], 1e-9);
    }
  }
}

// ---- inertia ----

TEST_P(SpaceBeams, ConsistentMassOfRigidMotionsIsExact) {
  const Mat3 axes = rotation();
  const double l = 1.9;
  const Vec3 a = vector(), b = a + l * axes.row(0).transpose(), pole = vector();
  const Mat3 rotary = axes.transpose() * Vec3(rho_ip, rho_iy, rho_iz).asDiagonal() * axes;
  for (const bool shear : {false, true}) {
    const SpaceBeam beam(0, 1, a, b, section(shear, BeamSection::Mass::consistent), Vec3(axes.row(2)));
    const Matrix m = matrices_of(beam).m;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        const Vector u = rigid({a, (a + b) / 2, b}, pole, i), v = rigid({a, (a + b) / 2, b}, pole, j);
        double expected = i < 3 || j < 3 ? 0 : l * rotary(i - 3, j - 3);
        for (int p = 0; p < 3; ++p)  // Simpson's rule is exact: the velocities are linear
          expected += rho_a * l * (p == 1 ? 4 : 1) / 6.0 * u.segment<3>(6 * p).dot(v.segment<3>(6 * p));
        EXPECT_NEAR(rigid({a, b}, pole, i).dot(m * rigid({a, b}, pole, j)), expected, 1e-11) << i << j;
      }
  }
}

TEST_P(SpaceBeams, LumpedMassTotals) {
  const Vec3 a = vector(), b = a + 2 * vector();
  const double l = (b - a).norm();
  const Matrix m = matrices_of(SpaceBeam(0, 1, a, b, section(true, BeamSection::Mass::lumped), vector())).m;
  for (int node = 0; node < 2; ++node) {
    EXPECT_LE((m.block<3, 3>(6 * node, 6 * node) - rho_a * l / 2 * Mat3::Identity()).norm(), 1e-12);
    EXPECT_NEAR(m.block(6 * node + 3, 6 * node + 3, 3, 3).trace(), (rho_ip + rho_iy + rho_iz) * l / 2, 1e-12);
  }
  EXPECT_EQ(m.block(0, 6, 6, 6).norm(), 0);
  EXPECT_EQ(matrices_of(SpaceBeam(0, 1, a, b, section(true, BeamSection::Mass::none), vector())).m.norm(), 0);
}

TEST_P(SpaceBeams, SimplySupportedFrequenciesConvergeWithFourthOrder) {
  const Mat3 axes = rotation();
  const double l = 5;
  for (const auto& [EI, plane] : {std::pair(EIz, in_xy), std::pair(EIy, in_xz)})
    for (const int mode : {1, 2}) {
      const double exact = std::pow(mode * pi / l, 4) * EI / rho_a;
      double last = 0;
      for (const int n : {2, 4, 8, 16}) {
        const Matrices a = line(axes, l, n, slender(BeamSection::Mass::consistent));
        const double error = eigenvalues(a.k, a.m, free_rows(n + 1, 6, plane, {1, 2, 6 * n + 1, 6 * n + 2}))[mode - 1] / exact - 1;
        EXPECT_GT(error, 0);  // from above
        if (n > 4) EXPECT_NEAR(std::log2(last / error), 4, 0.1) << n;
        last = error;
      }
      EXPECT_LT(last, 4e-5);
    }
}

TEST_P(SpaceBeams, TorsionalFrequenciesConvergeWithSecondOrder) {
  const Mat3 axes = rotation();
  const double l = 5, exact = std::pow(pi / (2 * l), 2) * GJ / rho_ip;
  for (const auto mass : {BeamSection::Mass::consistent, BeamSection::Mass::lumped}) {
    const double side = mass == BeamSection::Mass::consistent ? 1 : -1;  // from above, from below
    double last = 0;
    for (const int n : {2, 4, 8, 16}) {
      const Matrices a = line(axes, l, n, slender(mass));
      const double error = side * (eigenvalues(a.k, a.m, free_rows(n + 1, 6, twist, {3}))[0] / exact - 1);
      EXPECT_GT(error, 0);
      if (n > 2) EXPECT_NEAR(std::log2(last / error), 2, 0.05) << n;
      last = error;
    }
  }
}

// ---- buckling ----

/// The lowest buckling load of a cantilever of plane beams.
double plane_buckling(double length, int elements, double bending, double shear) {
  const Index n = 3 * (elements + 1);
  Matrix k = Matrix::Zero(n, n), g = Matrix::Zero(n, n);
  for (int e = 0; e < elements; ++e) {
    const double h = length / elements;
    const Matrices a = matrices_of(Beam(e, e + 1, {e * h, 0}, {(e + 1) * h, 0}, {.bending = bending, .axial = EA, .shear = shear}));
    k.block(3 * e, 3 * e, 6, 6) += a.k;
    g.block(3 * e, 3 * e, 6, 6) += a.g;
  }
  return 1 / eigenvalues(g, k, free_rows(elements + 1, 3, {1, 2}, {1, 2})).maxCoeff();
}

double space_buckling(const Mat3& axes, double length, int elements, const std::vector<int>& unknowns, const SpaceBeamSection& section) {
  const Matrices a = line(axes, length, elements, section);
  return 1 / eigenvalues(a.g, a.k, free_rows(elements + 1, 6, unknowns, {0, 1, 2, 3, 4, 5})).maxCoeff();
}

TEST_P(SpaceBeams, EulerLoadOfACantilever) {
  const Mat3 axes = rotation();
  const double l = 5, infinite = std::numeric_limits<double>::infinity();
  const SpaceBeamSection stiff = section(false, BeamSection::Mass::none), soft = section(true, BeamSection::Mass::none);
  for (const auto& [EI, GA, plane] : {std::tuple(EIz, GAy, in_xy), std::tuple(EIy, GAz, in_xz)}) {
    const double exact = pi * pi * EI / (4 * l * l);
    double last = 0;
    for (const int n : {1, 2, 4, 8}) {
      const double load = space_buckling(axes, l, n, plane, stiff), error = load / exact - 1;
      EXPECT_GT(error, 0);  // from above
      if (n > 2) EXPECT_NEAR(std::log2(last / error), 4, 0.1) << n;
      last = error;
      EXPECT_NEAR(load, plane_buckling(l, n, EI, infinite), 1e-9 * exact) << n;
      EXPECT_NEAR(space_buckling(axes, l, n, plane, soft), plane_buckling(l, n, EI, GA), 1e-9 * exact) << n;
    }
  }
  // of all motions together the weaker plane goes first
  EXPECT_NEAR(space_buckling(axes, l, 4, {0, 1, 2, 3, 4, 5}, stiff), plane_buckling(l, 4, std::min(EIy, EIz), infinite), 1e-5);
}

}  // namespace
}  // namespace uplift::space_beam_test
