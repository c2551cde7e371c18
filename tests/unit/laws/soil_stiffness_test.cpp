// Stiffness and radiation of the ground under a footing: published values, limits and invariants of the formulas, finite elements.
#include "uplift/laws/soil_stiffness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace uplift::soil_stiffness_test {
namespace {

using enum SoilMotion;
constexpr double pi = std::numbers::pi;
constexpr Ground site{80e6, 0.3, 1900};

FootingOnSoil footing(SoilFormulas formulas, double width, double length, const Ground& ground = site) {
  FootingOnSoil made;
  made.formulas = formulas;
  made.width = width, made.length = length;
  made.layers = {{ground}};
  return made;
}

struct Expected {
  SoilFormulas formulas;
  double width, length;
  Ground ground;
  double z, x, y, tilting_short, tilting_long, t;  // x: along the long side, which is the width
};

// Computed from the printed formulas outside of the program.
TEST(SoilStiffness, RectanglesOfBothSources) {
  const Ground stiff{120e6, 0.35, 0};
  using enum SoilFormulas;
  for (const Expected& e :
       {Expected{pais_kausel, 10, 10, site, 2685714285.71, 2164705882.35, 2164705882.35, 57142857142.9, 57142857142.9, 83100000000},
        {gazetas, 10, 10, site, 2594285714.29, 2117647058.82, 2117647058.82, 51404839836.1, 53177420520.1, 83471177603.9},
        {pais_kausel, 30, 10, site, 4952269643.75, 3832455693.47, 4208926281.7, 148571428571, 748077941662, 667698849660},
        {gazetas, 30, 10, site, 4819147405.65, 3855206380.54, 4210761936.1, 136488712668, 742708301997, 666557247509},
        {pais_kausel, 12, 8, stiff, 4284368726.24, 3272875244.94, 3389238881.31, 66166153846.2, 119810873461, 119320939750},
        {gazetas, 12, 8, stiff, 4134336230.9, 3171210707.14, 3291210707.14, 60108483699.3, 116383708681, 125062312284}}) {
    const SoilSprings k = soil_springs(footing(e.formulas, e.width, e.length, e.ground));
    const SoilSprings turned = soil_springs(footing(e.formulas, e.length, e.width, e.ground));
    const auto near = [&](SoilMotion motion, SoilMotion other, double value) {
      EXPECT_NEAR(k[motion].stiffness() / value, 1, 1e-11) << e.width << " " << to_string(motion);
      EXPECT_NEAR(turned[other].stiffness() / value, 1, 1e-11) << e.width << " turned, " << to_string(other);
    };
    near(vertical, vertical, e.z), near(along_width, along_length, e.x), near(along_length, along_width, e.y), near(torsion, torsion, e.t);
    if (e.width == e.length && e.formulas == gazetas) continue;  // this source gives a square two rocking stiffnesses
    near(tilting_width, tilting_length, e.tilting_long), near(tilting_length, tilting_width, e.tilting_short);
  }
}

TEST(SoilStiffness, DiscIsThatOfTheHalfSpace) {
  const SoilSprings k = soil_springs(footing(SoilFormulas::disc, 20, 20));
  const double g = 80e6, nu = 0.3, r = 10;
  EXPECT_DOUBLE_EQ(k[vertical].stiffness(), 4 * g * r / (1 - nu));
  EXPECT_DOUBLE_EQ(k[along_width].stiffness(), 8 * g * r / (2 - nu));
  EXPECT_NEAR(k[tilting_width].stiffness() * 3 * (1 - nu) / (8 * g * r * r * r), 1, 1e-14);
  EXPECT_NEAR(k[torsion].stiffness() * 3 / (16 * g * r * r * r), 1, 1e-14);
  EXPECT_NEAR(share_of_uniform_bed(footing(SoilFormulas::disc, 20, 20), k, tilting_width), 0.375, 1e-14);
  EXPECT_NEAR(k[vertical].damping / (3.4 / (1 - nu) * r * r * std::sqrt(1900 * g)), 1, 1e-14);  // Lysmer & Richart
  EXPECT_NEAR(k[along_width].damping / (4.608 / (2 - nu) * r * r * std::sqrt(1900 * g)), 1, 1e-14);
}

// A square of the area of the disc has its stiffness within the accuracy of the fits.
TEST(SoilStiffness, SquareAndDiscOfOneAreaAgree) {
  const double side = std::sqrt(pi) * 10;
  for (const SoilFormulas formulas : {SoilFormulas::pais_kausel, SoilFormulas::gazetas}) {
    const SoilSprings square = soil_springs(footing(formulas, side, side)), disc = soil_springs(footing(SoilFormulas::disc, 20, 20));
    for (const SoilMotion motion : soil_motions)
      EXPECT_NEAR(square[motion].stiffness() / disc[motion].stiffness(), 1, 0.13) << to_string(motion);
  }
}

// Plane strain finite elements (bonded rigid strip of half width 1 m, length 1 m, G = 1 Pa): docs/theory/soil_stiffness.md.
TEST(SoilStiffness, StripOnALayerAgainstFiniteElements) {
  struct Case {
    double poisson, depth, z, x, r;
  };
  for (const Case& c : {Case{0.3, 2, 4.5069, 2.4106, 2.7134}, {0.3, 4, 2.8646, 1.8032, 2.4523}, {0.45, 4, 4.3179, 2.1055, 3.0382}}) {
    FootingOnSoil strip = footing(SoilFormulas::strip, 2, 1, {1, c.poisson, 0});
    strip.rock_depth = c.depth;
    const SoilSprings k = soil_springs(strip);
    EXPECT_NEAR(k[vertical].stiffness() / c.z, 1, 0.16);
    EXPECT_NEAR(k[along_width].stiffness() / c.x, 1, 0.04);
    EXPECT_NEAR(k[tilting_width].stiffness() / c.r, 1, 0.10);
  }
}

// (H6), (H7) at high frequency: power per squared velocity of all faces that touch the ground, psi along the normal, 1 in the plane.
TEST(SoilStiffness, DashpotsAreThoseOfTheFacesAtHighFrequency) {
  const double a = 7, b = 3, depth = 0.8, psi = std::sqrt(2 * 0.7 / 0.4), impedance = std::sqrt(80e6 * 1900.0);
  FootingOnSoil made = footing(SoilFormulas::pais_kausel, 2 * a, 2 * b);
  made.embedment = depth;
  made.frequency = 1e7;
  const SoilSprings springs = soil_springs(made);
  std::array<double, 6> power{};
  constexpr int n = 400;
  // without the horizontal motion of rocking walls: terms in the third power of the embedment, which the theory page leaves out
  const auto add = [&](double x, double y, double area, int normal) {
    const double speeds[6][3] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, x}, {0, 0, y}, {-y, x, 0}};
    for (std::size_t m = 0; m < 6; ++m)
      for (int axis = 0; axis < 3; ++axis) power[m] += impedance * area * std::pow(speeds[m][axis], 2) * (axis == normal ? psi : 1);
  };
  for (int i = 0; i < n; ++i) {
    const double s = -1 + (2 * i + 1.0) / n;
    for (int j = 0; j < n; ++j) add(a * s, b * (-1 + (2 * j + 1.0) / n), 4 * a * b / n / n, 2);
    for (const double side : {-1.0, 1.0}) add(a * s, side * b, 2 * a / n * depth, 1), add(side * a, b * s, 2 * b / n * depth, 0);
  }
  for (const SoilMotion motion : soil_motions)
    EXPECT_NEAR(springs[motion].damping / power[static_cast<std::size_t>(motion)], 1, 1e-4) << to_string(motion);
}

TEST(SoilStiffness, StaticLimitOfTheFrequency) {
  FootingOnSoil made = footing(SoilFormulas::pais_kausel, 12, 8);
  const SoilSprings none = soil_springs(made);
  made.frequency = 1e-4;
  const SoilSprings low = soil_springs(made);
  made.frequency = 3;
  const SoilSprings dynamic = soil_springs(made);
  for (const SoilMotion motion : soil_motions) {
    EXPECT_NEAR(low[motion].stiffness() / none[motion].stiffness(), 1, 1e-8);
    EXPECT_LE(dynamic[motion].stiffness(), none[motion].stiffness());
    if (motion >= tilting_width) {
      EXPECT_EQ(none[motion].damping, 0);
    }
  }
  EXPECT_EQ(none[vertical].damping, dynamic[vertical].damping);
}

TEST(SoilStiffness, EmbedmentStiffensAndWallsWithoutContactAddNothingToRocking) {
  for (const SoilFormulas formulas : {SoilFormulas::pais_kausel, SoilFormulas::gazetas, SoilFormulas::disc}) {
    FootingOnSoil made = footing(formulas, 12, formulas == SoilFormulas::disc ? 12 : 8);
    const SoilSprings flat = soil_springs(made);
    made.embedment = made.sidewall = 2;
    const SoilSprings deep = soil_springs(made);
    for (const SoilMotion motion : soil_motions) {
      EXPECT_EQ(flat[motion].embedment, 1);
      EXPECT_GT(deep[motion].embedment, 1.05) << to_string(motion);
      EXPECT_LT(deep[motion].embedment, 3);
    }
  }
  FootingOnSoil open = footing(SoilFormulas::gazetas, 12, 8);
  open.embedment = 2;
  const SoilSprings springs = soil_springs(open);
  for (const SoilMotion motion : {tilting_width, tilting_length, torsion}) EXPECT_EQ(springs[motion].embedment, 1);
}

// Sides 12 x 8 m, embedment 2 m, at the frequency with a = 2 pi f B/V = 1: factors computed from (H3), (H4) outside of the program.
TEST(SoilStiffness, FactorsOfPaisAndKausel) {
  FootingOnSoil made = footing(SoilFormulas::pais_kausel, 12, 8);
  made.embedment = 2;
  made.frequency = site.wave_velocity() / (2 * pi * 4);
  const SoilSprings k = soil_springs(made);
  const auto expect = [&](SoilMotion motion, double embedment, double dynamic) {
    EXPECT_NEAR(k[motion].embedment, embedment, 1e-6) << to_string(motion);
    EXPECT_NEAR(k[motion].dynamic, dynamic, 1e-6) << to_string(motion);
  };
  expect(vertical, 1.2393122, 0.8933333);
  expect(along_width, 1.4973864, 1.0000000);
  expect(along_length, 1.4973864, 1.0000000);
  expect(tilting_width, 1.5739030, 0.7270221);
  expect(tilting_length, 1.7162162, 0.8302379);
  expect(torsion, 2.1682331, 0.8169279);
}

// FEMA 356 (2000), figure 4-4, writes the factors of Gazetas with the whole sides.
TEST(SoilStiffness, EmbedmentOfRockingAfterGazetas) {
  FootingOnSoil made = footing(SoilFormulas::gazetas, 20, 8);
  made.embedment = 3, made.sidewall = 2;
  const SoilSprings k = soil_springs(made);
  const double wall = 2, depth = 3, length = 20, width = 8;
  EXPECT_NEAR(k[tilting_width].embedment,
              1 + 1.4 * std::pow(wall / length, 0.6) * (1.5 + 3.7 * std::pow(wall / length, 1.9) * std::pow(wall / depth, -0.6)), 0.01);
  EXPECT_NEAR(k[tilting_length].embedment,
              1 + 2.5 * wall / width * (1 + 2 * wall / width * std::pow(wall / depth, -0.2) * std::sqrt(width / length)), 0.01);
}

TEST(SoilStiffness, LayersOfOneGroundAreThisGround) {
  for (const SoilFormulas formulas : {SoilFormulas::pais_kausel, SoilFormulas::gazetas, SoilFormulas::disc}) {
    FootingOnSoil made = footing(formulas, 9, 9);
    made.embedment = made.sidewall = 1;
    const SoilSprings one = soil_springs(made);
    made.layers = {{site, 0.4}, {site, 1.7}, {site, 1.1}, {site}};
    const SoilSprings many = soil_springs(made);
    for (const SoilMotion motion : soil_motions) EXPECT_NEAR(many[motion].stiffness() / one[motion].stiffness(), 1, 1e-14);
  }
}

// (H1): 2 m of 100 m/s over 200 m/s under a square of 8 m: translations reach 4 m, half of it in each layer.
TEST(SoilStiffness, LayersByTimeOfTravel) {
  FootingOnSoil made = footing(SoilFormulas::pais_kausel, 8, 8);
  const Ground soft{1800 * 100.0 * 100, 0.2, 1800}, stiff{2000 * 200.0 * 200, 0.4, 2000};
  made.layers = {{soft, 2}, {stiff}};
  const SoilSprings k = soil_springs(made);
  const double velocity = 4 / (2 / 100.0 + 2 / 200.0), g = 1900 * velocity * velocity;
  EXPECT_NEAR(k[vertical].depth, 4, 1e-14);
  EXPECT_NEAR(k[tilting_width].depth, 4, 1e-14);
  EXPECT_NEAR(k[vertical].ground.shear_modulus / g, 1, 1e-14);
  EXPECT_NEAR(k[vertical].ground.poisson, 0.3, 1e-15);
  EXPECT_NEAR(k[vertical].stiffness() / (g * 4 / 0.7 * 4.7), 1, 1e-14);
  made.embedment = 2;  // the underside stands on the stiff layer
  EXPECT_NEAR(soil_springs(made)[vertical].ground.shear_modulus / stiff.shear_modulus, 1, 1e-14);
}

TEST(SoilStiffness, ScalesWithLengthAndModulus) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> length(2, 20), factor(0.1, 10);
  for (int i = 0; i < 200; ++i) {
    const auto formulas = static_cast<SoilFormulas>(i % 3);
    const double a = length(random), b = formulas == SoilFormulas::disc ? a : length(random), s = factor(random), m = factor(random);
    FootingOnSoil one = footing(formulas, a, b), other = footing(formulas, s * a, s * b, {m * 80e6, 0.3, 1900});
    one.embedment = one.sidewall = 1, other.embedment = other.sidewall = s;
    if (formulas == SoilFormulas::pais_kausel) one.frequency = 2, other.frequency = 2 * std::sqrt(m) / s;
    const SoilSprings k = soil_springs(one), scaled = soil_springs(other);
    for (const SoilMotion motion : soil_motions) {
      const double of_length = motion >= tilting_width ? s * s * s : s;
      EXPECT_NEAR(scaled[motion].stiffness() / k[motion].stiffness(), m * of_length, 1e-12 * m * of_length);
      EXPECT_NEAR(scaled[motion].damping, k[motion].damping * std::sqrt(m) * of_length * s, 1e-12 * scaled[motion].damping);
    }
  }
}

}  // namespace
}  // namespace uplift::soil_stiffness_test
