#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "unit/elements/solid_support.h"
#include "uplift/elements/bulk_laws/drucker_prager.h"
#include "uplift/math/dense.h"

namespace uplift::solid_plastic_test {
namespace {

using Fit = DruckerPragerParameters::Fit;
using History = std::array<double, DruckerPrager::history_size>;
constexpr double degree = std::numbers::pi / 180;
constexpr std::array<Fit, 3> fits{Fit::compression, Fit::extension, Fit::plane_strain};

DruckerPragerParameters soil(Fit fit = Fit::compression) {
  return {{50e6, 0.3, 1900}, 20e3, 30 * degree, 10 * degree, 0, fit};
}

double uniform(double least, double most) {
  return least + (most - least) * *rc::gen::resize(100, rc::gen::inRange(0, 1'000'001)) / 1e6;
}

DruckerPragerParameters any_soil() {
  DruckerPragerParameters p;
  p.elastic = {uniform(10e6, 500e6), uniform(0, 0.45), 1900};
  p.friction = uniform(5, 45) * degree;
  p.dilation = p.friction * *rc::gen::element(0.0, 0.4, 1.0);
  p.cohesion = *rc::gen::element(0.0, 5e3, 100e3);
  p.hardening = *rc::gen::element(0.0, 1e5, 2e7);
  p.fit = *rc::gen::elementOf(fits);
  return p;
}

Strain any_strain(double size) {
  Strain e;
  for (int i = 0; i < 6; ++i) e[i] = uniform(-size, size);
  return e;
}

enum class Regime { elastic, cone, apex };

Regime regime(const DruckerPrager& law, const Strain& strain, const History& old) {
  History now{};
  const Stress s = law.respond(strain, old, now, nullptr);
  if (now[6] == old[6]) return Regime::elastic;
  const double spread = (s.head<3>().array() - s.head<3>().mean()).matrix().norm() + s.tail<3>().norm();
  // a stress at the apex differs from p I by round-off of the trial stress
  return spread <= 1e-12 * law.parameters().elastic.constrained() * (strain - ConstMap(old.data(), 6)).norm() ? Regime::apex : Regime::cone;
}

RC_GTEST_PROP(SolidPlasticProperty, YieldSurfaceIsMetToRoundOffAndPlasticWorkIsPositive, ()) {
  const DruckerPragerParameters p = any_soil();
  const DruckerPrager law(p);
  History old{}, now{};
  Strain strain = Strain::Zero();
  for (int step = 0; step < 8; ++step) {
    strain += any_strain(2e-3);
    const Stress stress = law.respond(strain, old, now, nullptr);
    const Stress trial = elastic_matrix(p.elastic) * (strain - ConstMap(old.data(), 6));
    const double over = law.yield(stress, now[6]), round_off = 1e-13 * (trial.norm() + p.cohesion + p.hardening * now[6]);
    RC_ASSERT(over <= round_off);
    if (now[6] > old[6]) RC_ASSERT(over >= -round_off);
    // stress and remembered plastic strain belong together
    RC_ASSERT((elastic_matrix(p.elastic) * (strain - ConstMap(now.data(), 6)) - stress).norm() <= 10 * round_off);
    RC_ASSERT(stress.dot(ConstMap(now.data(), 6) - ConstMap(old.data(), 6)) >= -1e-12 * trial.norm() * strain.norm());
    // the accepted state answers the same again
    History again{};
    RC_ASSERT((law.respond(strain, now, again, nullptr) - stress).norm() <= 10 * round_off);
    old = now;
  }
}

RC_GTEST_PROP(SolidPlasticProperty, TangentIsTheFiniteDifference, ()) {
  const DruckerPragerParameters p = any_soil();
  const DruckerPrager law(p);
  History old{}, now{};
  law.respond(any_strain(2e-3), old, now, nullptr);
  old = now;
  const Strain strain = any_strain(4e-3);
  Mat6 tangent;
  law.respond(strain, old, now, &tangent);
  const double h = 1e-8, stiffness = p.elastic.constrained();
  const Regime here = regime(law, strain, old);
  RC_CLASSIFY(here == Regime::cone, "cone");
  RC_CLASSIFY(here == Regime::apex, "apex");
  for (int k = 0; k < 6; ++k) {
    const Strain up = strain + h * Strain::Unit(k), down = strain - h * Strain::Unit(k);
    if (regime(law, up, old) != here || regime(law, down, old) != here) continue;  // a kink lies between
    const Stress slope = (law.respond(up, old, now, nullptr) - law.respond(down, old, now, nullptr)) / (2 * h);
    RC_ASSERT((slope - tangent.col(k)).norm() <= 1e-6 * stiffness);
  }
  if (p.dilation == p.friction) RC_ASSERT((tangent - tangent.transpose()).norm() <= 1e-13 * stiffness);
}

/// Strains until the stresses marked in `held` have the wanted values, the other strains given: the end of a laboratory test.
Stress load(const DruckerPrager& law, Strain& strain, History& history, const std::array<bool, 6>& held, const Stress& wanted) {
  History now{};
  Mat6 tangent;
  Stress stress;
  for (int iteration = 0; iteration < 60; ++iteration) {
    stress = law.respond(strain, history, now, &tangent);
    Matrix k = Matrix::Identity(6, 6);
    Vector rest = Vector::Zero(6);
    for (int i = 0; i < 6; ++i)
      if (held[static_cast<std::size_t>(i)]) {
        k.row(i) = tangent.row(i);
        rest[i] = wanted[i] - stress[i];
        for (int j = 0; j < 6; ++j)
          if (!held[static_cast<std::size_t>(j)]) k(i, j) = 0;
      }
    if (rest.norm() < 1e-9 * (1 + stress.norm())) break;
    strain += PartialLu(k).solve(rest);
  }
  history = now;
  return stress;
}

/// Strength along y under the lateral stress -cell; direction -1 presses, +1 pulls; `plane`: no strain along z.
double strength(const DruckerPrager& law, double cell, double direction, bool plane) {
  Strain strain = Strain::Zero();
  History history{};
  Stress wanted = Stress::Zero(), stress;
  wanted.head<3>().setConstant(-cell);
  load(law, strain, history, {true, true, !plane, false, false, false}, wanted);
  for (int step = 0; step < 400; ++step) {
    strain[1] += direction * 1e-4;
    stress = load(law, strain, history, {true, false, !plane, false, false, false}, wanted);
  }
  return stress[1];
}

TEST(SolidPlastic, TriaxialStrengthsAreMohrCoulombs) {
  // sigma_1 = N sigma_3 + 2 c sqrt(N), N = tan^2(45 + phi/2), on the edges where the cone touches
  for (const double cell : {0.0, 50e3, 300e3}) {
    DruckerPragerParameters p = soil(Fit::compression);
    const double s = std::sin(p.friction), n = (1 + s) / (1 - s), least = n * cell + 2 * p.cohesion * std::sqrt(n);
    EXPECT_NEAR(strength(DruckerPrager(p), cell, -1, false), -least, 1e-8 * least) << cell;
    if (cell == 0) continue;
    // extension: the lateral pressure is the largest principal stress
    p.fit = Fit::extension;
    const double axial = (cell - 2 * p.cohesion * std::sqrt(n)) / n;
    EXPECT_NEAR(strength(DruckerPrager(p), cell, 1, false), -axial, 1e-8 * cell) << cell;
  }
}

TEST(SolidPlastic, PlaneStrainCollapseIsMohrCoulombs) {
  // with associated flow the plane-strain fit collapses at Mohr-Coulomb's load
  DruckerPragerParameters p = soil(Fit::plane_strain);
  p.dilation = p.friction;
  const double s = std::sin(p.friction), n = (1 + s) / (1 - s);
  for (const double cell : {20e3, 100e3}) {
    const double expected = n * cell + 2 * p.cohesion * std::sqrt(n);
    EXPECT_NEAR(strength(DruckerPrager(p), cell, -1, true), -expected, 1e-6 * expected);
  }
}

TEST(SolidPlastic, SimpleShearWithHardening) {
  // p stays zero when the flow keeps the volume: tau = xi c at yield, then the slope G xi^2 H/(G + xi^2 H)
  for (const Fit fit : fits) {
    DruckerPragerParameters p = soil(fit);
    p.dilation = 0;
    p.hardening = 3e6;
    const DruckerPrager law(p);
    const double s = std::sin(p.friction), c = std::cos(p.friction), t = std::tan(p.friction);
    const double xi = fit == Fit::compression ? 6 * c / (std::sqrt(3.0) * (3 - s))
                      : fit == Fit::extension ? 6 * c / (std::sqrt(3.0) * (3 + s))
                                              : 3 / std::sqrt(9 + 12 * t * t);
    const double g = p.elastic.shear(), first = xi * p.cohesion / g, gamma = 5 * first;
    History old{}, now{};
    const Stress stress = law.respond(gamma * Strain::Unit(3), old, now, nullptr);
    const double expected = xi * p.cohesion + g * xi * xi * p.hardening / (g + xi * xi * p.hardening) * (gamma - first);
    EXPECT_NEAR(stress[3], expected, 1e-12 * expected);
    EXPECT_NEAR(stress.head<3>().norm(), 0, 1e-12 * expected);
  }
}

TEST(SolidPlastic, DilationAngleGivesThePlasticVolume) {
  // plastic volume over accumulated strain = eta_bar/xi, here in the associated case eta/xi = tan(phi) for every fit
  for (const Fit fit : fits) {
    DruckerPragerParameters p = soil(fit);
    p.dilation = p.friction;
    History old{}, now{};
    Strain strain = 4e-3 * Strain::Unit(3);
    strain[1] = -5e-4;
    DruckerPrager(p).respond(strain, old, now, nullptr);
    ASSERT_GT(now[6], 0);
    EXPECT_NEAR((now[0] + now[1] + now[2]) / now[6], std::tan(p.friction), 1e-12);
  }
}

TEST(SolidPlastic, ApexIsTheCotangentOfFriction) {
  // hydrostatic tension ends at p = c cot(phi) for every fit; with hardening K (theta - v) = cot(phi) (c + H v xi/eta_bar)
  for (const Fit fit : fits)
    for (const double h : {0.0, 2e6}) {
      DruckerPragerParameters p = soil(fit);
      p.dilation = p.friction;
      p.hardening = h;
      const double cot = 1 / std::tan(p.friction), bulk = p.elastic.bulk();
      const double theta = 3 * p.cohesion * cot / bulk, v = (bulk * theta - p.cohesion * cot) / (bulk + cot * cot * h);
      const DruckerPrager law(p);
      Strain strain = Strain::Zero();
      strain.head<3>().setConstant(theta / 3);
      History old{}, now{};
      const Stress stress = law.respond(strain, old, now, nullptr);
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(stress[i], bulk * (theta - v), 1e-12 * bulk * theta);
      EXPECT_NEAR(stress[0], law.apex(now[6]), 1e-12 * bulk * theta);
      // a little shear does not matter there: the return still ends at the apex
      strain[3] = 1e-2 * theta;
      const Stress beside = law.respond(strain, old, now, nullptr);
      EXPECT_LE((beside - stress).norm(), 1e-11 * stress.norm());
    }
}

/// Mean stress and accumulated strain at a volume strain theta by the equation of the apex alone, solved by bisection:
/// p_trial - K v = (xi/eta) (c + H e), e = xi v/eta_bar, in the unknown e so that a flow without volume change needs no case of its own.
std::array<double, 2> apex_by_bisection(const DruckerPragerParameters& p, double theta) {
  const auto slope = [](double angle) { return 6 * std::sin(angle) / (std::sqrt(3.0) * (3 - std::sin(angle))); };
  const double eta = slope(p.friction), eta_bar = slope(p.dilation), bulk = p.elastic.bulk();
  const double xi = 6 * std::cos(p.friction) / (std::sqrt(3.0) * (3 - std::sin(p.friction)));
  const auto over = [&](double e) { return bulk * theta - bulk * eta_bar / xi * e - xi / eta * (p.cohesion + p.hardening * e); };
  double low = 0, high = 1;
  for (int i = 0; i < 200; ++i) (over(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
  return {bulk * (theta - eta_bar / xi * low), low};
}

TEST(SolidPlastic, ApexWithHardeningIsContinuousInTheDilatancyAngle) {
  DruckerPragerParameters p = soil();
  p.hardening = 2e6;
  const double theta = 4 * p.cohesion / std::tan(p.friction) / p.elastic.bulk();
  Strain strain = Strain::Zero();
  strain.head<3>().setConstant(theta / 3);
  double last = 0, last_angle = 0;
  for (const double angle : {0.0, 1e-6, 1e-3, 0.1, 1.0}) {
    p.dilation = angle * degree;
    History old{}, now{};
    Mat6 tangent;
    const Stress stress = DruckerPrager(p).respond(strain, old, now, &tangent);
    const auto [mean, accumulated] = apex_by_bisection(p, theta);
    EXPECT_NEAR(stress[0], mean, 1e-10 * mean) << angle;
    EXPECT_NEAR(now[6], accumulated, 1e-10 * accumulated) << angle;
    EXPECT_NEAR(stress[0], DruckerPrager(p).apex(now[6]), 1e-10 * mean) << angle;
    if (angle == 0) {  // the volume stays elastic, and so does its stiffness
      EXPECT_NEAR(stress[0], p.elastic.bulk() * theta, 1e-12 * stress[0]);
      EXPECT_NEAR(now[0], 0, 1e-15);
      EXPECT_NEAR(tangent(0, 0), p.elastic.bulk(), 1e-12 * p.elastic.bulk());
    } else {  // |dp/d eta_bar| <= K eta (p_trial - p_apex)/(xi^2 H), and eta_bar <= 1.16 angle
      const double xi = 6 * std::cos(p.friction) / (std::sqrt(3.0) * (3 - std::sin(p.friction)));
      const double eta = 6 * std::sin(p.friction) / (std::sqrt(3.0) * (3 - std::sin(p.friction)));
      const double rate = p.elastic.bulk() * eta * p.elastic.bulk() * theta / (xi * xi * p.hardening);
      EXPECT_LE(std::abs(stress[0] - last), rate * 1.2 * (p.dilation - last_angle)) << angle;
    }
    last = stress[0], last_angle = p.dilation;
  }
  p.hardening = 0;  // without hardening the apex stays, whatever the angle
  for (const double angle : {0.0, 1e-6, 1.0}) {
    p.dilation = angle * degree;
    History old{}, now{};
    EXPECT_NEAR(DruckerPrager(p).respond(strain, old, now, nullptr)[0], p.cohesion / std::tan(p.friction), 1e-10 * p.cohesion) << angle;
  }
}

TEST(SolidPlastic, FrictionlessSoilIsVonMises) {
  DruckerPragerParameters p = soil();
  p.friction = p.dilation = 0;
  const DruckerPrager law(p);
  EXPECT_TRUE(std::isinf(law.apex(0)));
  // xi = 2/sqrt(3) on the compression edges: uniaxial strength 2 c in tension and compression, whatever the pressure
  for (const double cell : {0.0, 1e6})
    for (const double direction : {-1.0, 1.0}) {
      EXPECT_NEAR(strength(law, cell, direction, false), -cell + direction * 2 * p.cohesion, 1e-6 * p.cohesion);
    }
}

TEST(SolidPlastic, RefusesWhatCannotBe) {
  const Where where{"case.toml", 3};
  EXPECT_NO_THROW(check_drucker_prager(soil(), where, "soil"));
  const auto refused = [&](auto change) {
    DruckerPragerParameters p = soil();
    change(p);
    EXPECT_THROW(check_drucker_prager(p, where, "soil"), InputError);
  };
  refused([](auto& p) { p.friction = 90 * degree; });
  refused([](auto& p) { p.friction = -0.1; });
  refused([](auto& p) { p.dilation = p.friction + 0.01; });
  refused([](auto& p) { p.cohesion = -1; });
  refused([](auto& p) { p.cohesion = p.friction = p.dilation = 0; });
  refused([](auto& p) { p.hardening = -1; });
  refused([](auto& p) { p.elastic.young = 0; });
}

}  // namespace
}  // namespace uplift::solid_plastic_test
