#include <gtest/gtest.h>

#include "unit/model/model_support.h"

namespace uplift::elements_test {
namespace {

struct Case {
  std::string name;
  std::unique_ptr<Element> element;
  std::vector<Vec2> positions;
  double mass;
};

constexpr double EI = 3e6, EA = 5e8, GA = 4e6, rho_a = 120, rho_i = 7;

BeamSection section(bool shear, BeamSection::Mass mass, double rotary) {
  BeamSection s;
  s.bending = EI;
  s.axial = EA;
  if (shear) s.shear = GA;
  s.mass = mass;
  s.mass_per_length = rho_a;
  s.rotary_per_length = rotary;
  return s;
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  const Vec2 a(0.3, -0.2), b(2.1, 1.7), c(-1.5, 0.4);
  const double length = (b - a).norm();
  for (const bool shear : {false, true})
    for (const auto mass : {BeamSection::Mass::none, BeamSection::Mass::consistent, BeamSection::Mass::lumped})
      for (const double rotary : {0.0, rho_i})
        cases.push_back({"beam",
                         std::make_unique<Beam>(0, 1, a, b, section(shear, mass, rotary)),
                         {a, b},
                         mass == BeamSection::Mass::none ? 0 : rho_a * length});
  BeamSection stiff = section(false, BeamSection::Mass::consistent, 0);
  stiff.axial.reset();
  cases.push_back({"inextensible beam", std::make_unique<Beam>(0, 1, a, c, stiff), {a, c}, rho_a * (c - a).norm()});
  cases.push_back({"offset mass", std::make_unique<PointMass>(0, 12.0, 3.0, Vec2(0.4, 0.7)), {a}, 12});
  // two-node springs act without moments only along their line or on coincident nodes
  cases.push_back({"spring", std::make_unique<Spring>(Connection{{0, 1}, Vec2(b - a)}, 5e4), {a, b}, 0});
  cases.push_back({"spring", std::make_unique<Spring>(Connection{{0, 1}, Vec2(1, 2)}, 5e4), {a, a}, 0});
  cases.push_back({"rotational spring", std::make_unique<Spring>(Connection{{0, 1}, std::nullopt}, 5e4), {a, b}, 0});
  cases.push_back({"dashpot", std::make_unique<Dashpot>(Connection{{0, 1}, Vec2(b - a)}, 5e4), {a, b}, 0});
  return cases;
}

/// Rigid motion of the nodes: translation, or small rotation about a point.
Vector rigid(const std::vector<Vec2>& positions, int kind) {
  Vector u(3 * static_cast<Index>(positions.size()));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec2 r = positions[i] - Vec2(0.9, -3.1);
    u.segment<3>(static_cast<Index>(3 * i)) = kind == 0 ? Vec3(1, 0, 0) : kind == 1 ? Vec3(0, 1, 0) : Vec3(-r.y(), r.x(), 1);
  }
  return u;
}

TEST(Elements, RigidMotionsMeetNoForce) {
  for (const Case& c : all_cases()) {
    Matrix k, d;
    c.element->form({&k, nullptr, &d});
    for (int kind = 0; kind < 3; ++kind) {
      const Vector u = rigid(c.positions, kind);
      EXPECT_LE((k * u).norm(), 1e-13 * k.norm() * u.norm()) << c.name;
      EXPECT_LE((d * u).norm(), 1e-13 * d.norm() * u.norm()) << c.name;
    }
  }
}

TEST(Elements, MatricesAreSymmetricAndPositive) {
  for (const Case& c : all_cases()) {
    Matrix k, m, d;
    c.element->form({&k, &m, &d});
    for (const Matrix* a : {&k, &m, &d}) {
      ASSERT_EQ(a->rows(), 3 * static_cast<Index>(c.positions.size())) << c.name;
      EXPECT_LE((*a - a->transpose()).norm(), 1e-14 * a->norm()) << c.name;
      for (int trial = 0; trial < 20; ++trial) {
        const Vector x = Vector::Random(a->rows());
        EXPECT_GE(x.dot(*a * x), -1e-12 * a->norm() * x.squaredNorm()) << c.name;
      }
    }
  }
}

TEST(Elements, KineticEnergyOfATranslationIsThatOfTheTotalMass) {
  for (const Case& c : all_cases()) {
    Matrix m;
    c.element->form({nullptr, &m, nullptr});
    for (int kind = 0; kind < 2; ++kind) {
      const Vector v = rigid(c.positions, kind);
      EXPECT_NEAR(v.dot(m * v), c.mass, 1e-12 * (1 + c.mass)) << c.name;
    }
  }
}

TEST(Elements, KineticEnergyOfARotation) {
  // about the point (0.9, -3.1): consistent beam with rotary inertia: rho A (L^3/12 + L d^2) + rho I L
  const Vec2 a(0.3, -0.2), b(2.1, 1.7), pole(0.9, -3.1);
  const double length = (b - a).norm(), distance2 = ((a + b) / 2 - pole).squaredNorm();
  for (const bool shear : {false, true}) {
    const Beam beam(0, 1, a, b, section(shear, BeamSection::Mass::consistent, rho_i));
    Matrix m;
    beam.form({nullptr, &m, nullptr});
    const Vector v = rigid({a, b}, 2);
    EXPECT_NEAR(v.dot(m * v), rho_a * (std::pow(length, 3) / 12 + length * distance2) + rho_i * length, 1e-10);
  }
  const PointMass mass(0, 12, 3, {0.4, 0.7});
  Matrix m;
  mass.form({nullptr, &m, nullptr});
  const Vector v = rigid({a}, 2);
  EXPECT_NEAR(v.dot(m * v), 12 * (a + Vec2(0.4, 0.7) - pole).squaredNorm() + 3, 1e-12);
}

TEST(Elements, GeometricStiffnessOfHermiteBeamIsTheClassicalMatrix) {
  const double l = 1.7, n = -3.0;
  const Beam beam(0, 1, {0, 0}, {l, 0}, section(false, BeamSection::Mass::none, 0));
  Matrix g;
  beam.geometric(n, g);
  Matrix expected = Matrix::Zero(6, 6);  // Przemieniecki 1968, eq 15.34 without the axial terms
  const int rows[] = {1, 2, 4, 5};
  const double e[4][4] = {
      {36, 3 * l, -36, 3 * l}, {3 * l, 4 * l * l, -3 * l, -l * l}, {-36, -3 * l, 36, -3 * l}, {3 * l, -l * l, -3 * l, 4 * l * l}};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) expected(rows[i], rows[j]) = n / (30 * l) * e[i][j];
  EXPECT_LE((g - expected).norm(), 1e-13 * expected.norm());
}

TEST(Elements, GeometricStiffnessWithShearIsKosmatkas) {
  // Kosmatka, Computers & Structures 57 (1995): N/(L (1 + phi)^2) [6/5 + 2 phi + phi^2, L/10; ., L^2 (2/15 + phi/6 + phi^2/12)], coupling
  // -L^2 (1/30 + phi/6 + phi^2/12)
  const double l = 1.7, phi = 12 * EI / (GA * l * l), f = 1 / (l * (1 + phi) * (1 + phi));
  const Beam beam(0, 1, {0, 0}, {l, 0}, section(true, BeamSection::Mass::none, 0));
  Matrix g;
  beam.geometric(1, g);
  EXPECT_NEAR(g(1, 1), f * (1.2 + 2 * phi + phi * phi), 1e-12);
  EXPECT_NEAR(g(1, 2), f * l / 10, 1e-12);
  EXPECT_NEAR(g(2, 2), f * l * l * (2.0 / 15 + phi / 6 + phi * phi / 12), 1e-12);
  EXPECT_NEAR(g(2, 5), -f * l * l * (1.0 / 30 + phi / 6 + phi * phi / 12), 1e-12);
}

TEST(Elements, RigidRotationOfAPulledBeamCostsNTimesL) {
  // turning a string of length L with the force N by theta takes N L theta^2 / 2
  for (const bool shear : {false, true}) {
    const Vec2 a(0.3, -0.2), b(2.1, 1.7);
    const Beam beam(0, 1, a, b, section(shear, BeamSection::Mass::none, 0));
    Matrix g;
    beam.geometric(5e3, g);
    const Vector u = rigid({a, b}, 2);
    EXPECT_NEAR(u.dot(g * u), 5e3 * (b - a).norm(), 1e-8);
  }
}

TEST(Elements, AxialForceAndEndForces) {
  const Vec2 a(0, 0), b(3, 4);
  const Beam beam(0, 1, a, b, section(false, BeamSection::Mass::none, 0));
  Vector u = Vector::Zero(6);
  u.segment<2>(3) = 1e-3 * Vec2(0.6, 0.8);  // stretched by 1 mm
  EXPECT_NEAR(beam.axial_force(u), EA / 5 * 1e-3, 1e-6);
  const Vector f = beam.end_forces(u);
  EXPECT_NEAR(f[0], -EA / 5 * 1e-3, 1e-6);
  EXPECT_NEAR(f[3], EA / 5 * 1e-3, 1e-6);
  EXPECT_NEAR(f[1], 0, 1e-6);
}

TEST(Elements, SpringToGround) {
  const Spring spring({{0}, Vec2(0, 3)}, 7e3);
  Matrix k;
  spring.form({&k, nullptr, nullptr});
  Matrix expected = Matrix::Zero(3, 3);
  expected(1, 1) = 7e3;
  EXPECT_EQ((k - expected).norm(), 0);
  const Dashpot dashpot({{0, 1}, std::nullopt}, 11);
  Matrix c, m;
  dashpot.form({&k, &m, &c});
  EXPECT_EQ(c(2, 2), 11);
  EXPECT_EQ(c(2, 5), -11);
  EXPECT_EQ(c.cwiseAbs().sum(), 44);
  EXPECT_EQ(k.norm() + m.norm(), 0);
}

}  // namespace
}  // namespace uplift::elements_test
