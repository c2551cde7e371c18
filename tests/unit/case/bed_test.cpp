// [interface.footing.soil]: a bed that is stiffer towards the edges, in built models and whole runs.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "ran_support.h"
#include "text_support.h"
#include "uplift/laws/soil_bed.h"
#include "uplift/model/damping.h"

namespace uplift::bed_test {
namespace {

using support::replaced;

constexpr double G = 80e6, nu = 0.3;

/// Static stiffnesses of Pais & Kausel for sides a along x, b along y; and of a strip, per metre of length b.
struct Stiffness {
  double vertical, along, across, tilting_a, tilting_b;
};
Stiffness pais_kausel(double a, double b) {
  const double L = std::max(a, b) / 2, B = std::min(a, b) / 2, r = L / B, v = 1 - nu, h = 2 - nu;
  const double long_way = G * B / h * (6.8 * std::pow(r, 0.65) + 2.4), short_way = G * B / h * (6.8 * std::pow(r, 0.65) + 0.8 * r + 1.6);
  const double tilts_long = G * B * B * B / v * (3.73 * std::pow(r, 2.4) + 0.27), tilts_short = G * B * B * B / v * (3.2 * r + 0.8);
  const double vertical = G * B / v * (3.1 * std::pow(r, 0.75) + 1.6);
  if (a >= b) return {vertical, long_way, short_way, tilts_long, tilts_short};
  return {vertical, short_way, long_way, tilts_short, tilts_long};
}
Stiffness strip(double width, double length, double rock) {
  const double b = width / 2, h = b / rock;
  return {length * 1.23 * G / (1 - nu) * (1 + 3.5 * h), length * 2.1 * G / (2 - nu) * (1 + 2 * h), 0,
          length * std::acos(-1.0) * G * b * b / (2 * (1 - nu)) * (1 + 0.2 * h), 0};
}

std::string refusal_of(const std::string& text) {
  return support::refusal_of([&] {
    const Case read = check_case(read_toml_text(text, "case.toml"), "case.toml");
    build(read, runs_of_case(read).front());
  });
}

constexpr double mass = 400e3, inertia = 8e6;

std::string block(bool space, const std::string& footing, const std::string& law, const std::string& soil = "") {
  return fmt::format("title = \"block\"\n[nodes]\nbase = [0, 0{}]\n", space ? ", 0" : "") +
         fmt::format("[[rigid]]\nname = \"block\"\nnode = \"base\"\nmass = {}\n", mass) +
         (space ? fmt::format("inertias = [{0}, {0}, {0}]\n", inertia) : fmt::format("inertia = {}\n", inertia)) +
         "[[interface]]\nname = \"soil\"\n[interface.footing]\nbody = \"base\"\n" + footing +
         fmt::format("\n[interface.footing.soil]\nG = {}\npoisson = {}\n{}\n[interface.law]\n", G, nu, soil) + law +
         "\n[[stage]]\ntype = \"dynamic\"\nduration = 1\nstep = 1e-3\n[output]\nframes = 0\nautomatic = false\n";
}

constexpr const char* springs = "type = \"springs\"\nK_n = \"soil\"\nK_t = \"soil\"\n";

/// Stiffness of the closed bed on (ux, uy, rz), in space (ux, uy, uz, rx, ry, rz).
Matrix stiffness_of(const std::string& text) {
  const Case read = check_case(read_toml_text(text, "case.toml"), "case.toml");
  const BuiltCase built = build(read, runs_of_case(read).front());
  EXPECT_NEAR(built.model.interfaces[0].weight.sum(), built.facts[0].area, 1e-12 * built.facts[0].area);
  return Matrix(bonded_stiffness(built.model));
}

void expect_diagonal(const Matrix& k, const std::vector<double>& wanted, const std::string& what) {
  ASSERT_EQ(k.rows(), static_cast<Index>(wanted.size()));
  for (Index i = 0; i < k.rows(); ++i) {
    if (wanted[static_cast<std::size_t>(i)] > 0) EXPECT_NEAR(k(i, i) / wanted[static_cast<std::size_t>(i)], 1, 1e-9) << what << i;
    for (Index j = 0; j < k.cols(); ++j)
      if (i != j) EXPECT_LT(std::abs(k(i, j)), 1e-9 * std::sqrt(k(i, i) * k(j, j))) << what << i << j;
  }
}

TEST(Bed, HasTheStiffnessesOfTheGroundInThePlane) {
  const std::array<std::pair<const char*, int>, 3> rules{{{"nodal", 3}, {"midpoint", 18}, {"gauss", 7}}};
  for (const auto& [rule, least] : rules)
    for (int points = least; points <= 41; points += points < 9 ? 1 : 4) {
      const auto footing = [&](double width, double length) {
        return fmt::format("width = {}\nthickness = {}\npoints = {}\nrule = \"{}\"", width, length, points, rule);
      };
      const std::string what = fmt::format("{} {} ", rule, points);
      for (const auto& [a, b] : {std::pair{10.0, 10.0}, {10.0, 8.0}, {12.0, 6.0}, {30.0, 10.0}, {10.0, 10.5}}) {
        const Stiffness k = pais_kausel(a, b);
        expect_diagonal(stiffness_of(block(false, footing(a, b), springs)), {k.along, k.vertical, k.tilting_a}, what);
      }
      for (const double rock : {6.0, 10.0, 20.0}) {
        const Stiffness k = strip(8, 1.5, rock);
        expect_diagonal(stiffness_of(block(false, footing(8, 1.5), springs, fmt::format("rock_depth = {}", rock))),
                        {k.along, k.vertical, k.tilting_a}, what);
      }
    }
}

TEST(Bed, HasTheStiffnessesOfTheGroundInSpace) {
  for (const auto& [a, b] : {std::pair{10.0, 10.0}, {10.0, 8.0}, {7.0, 8.0}})
    for (const auto& [n, m] : {std::pair{3, 3}, {15, 12}, {4, 21}}) {
      const Stiffness k = pais_kausel(a, b);
      const double h = (k.along + k.across) / 2;
      const std::string footing = fmt::format("width = {}\nlength = {}\npoints = {}\npoints_across = {}", a, b, n, m);
      // torsion is not of the table
      expect_diagonal(stiffness_of(block(true, footing, springs)), {h, h, k.vertical, k.tilting_b, k.tilting_a, 0}, footing);
    }
  // turned by a quarter: x is along the length
  const Stiffness k = pais_kausel(10, 8);
  const double h = (k.along + k.across) / 2;
  expect_diagonal(stiffness_of(block(true, "width = 10\nlength = 8\npoints = 9\npoints_across = 9\nazimuth = \"90 deg\"", springs)),
                  {h, h, k.vertical, k.tilting_a, k.tilting_b, 0}, "turned");
}

/// Every law keeps its shape: stiffnesses and the dashpot of the ground, strengths times the same distribution.
TEST(Bed, CarriesEveryLaw) {
  const Stiffness k = pais_kausel(10, 10);
  const std::string footing = "width = 10\nthickness = 10\npoints = 11";
  for (const char* law : {"type = \"sdm\"\nF_u = 1e4\nG_f = 100\nF_c = -100\n", "type = \"elastic\"\n",
                          "type = \"exponential\"\nF_u = 1e4\nG_f = 100\n", "type = \"bilinear\"\nF_u = 1e4\nG_f = 100\n"})
    expect_diagonal(stiffness_of(block(false, footing, std::string(law) + "K_n = \"soil\"\nK_t = \"soil\"\n")),
                    {k.along, k.vertical, k.tilting_a}, law);
  // pulled straight up, all points reach their strength together: F_u times the area
  const std::string text =
      block(false, footing, "type = \"sdm\"\nK_n = \"soil\"\nF_u = 1e4\nG_f = 100\nF_c = -100\ntangential = \"bonded\"\n");
  const Case read = check_case(read_toml_text(text, "case.toml"), "case.toml");
  const BuiltCase built = build(read, runs_of_case(read).front());
  const Interface& face = built.model.interfaces[0];
  EXPECT_NEAR(face.weight.sum() * built.facts[0].tension, 1e6, 1e-3);
  EXPECT_GT(face.weight[0] / face.area[0], 5);
}

/// Dashpot of the wave that the footing radiates, over the area: rho psi V with the longitudinal velocity.
TEST(Bed, TakesTheDashpotOfTheGround) {
  const std::string text =
      block(false, "width = 10\nthickness = 10\npoints = 11", "type = \"springs\"\nK_n = \"soil\"\nc = \"soil\"\n", "density = 2000");
  const Case read = check_case(read_toml_text(text, "case.toml"), "case.toml");
  const BuiltCase built = build(read, runs_of_case(read).front());
  const double psi = std::sqrt(2 * (1 - nu) / (1 - 2 * nu));
  EXPECT_NEAR(built.behaviours[0]->number("c"), 2000 * std::sqrt(G / 2000) * psi, 1e-6);
}

/// The distribution by its definition: exp(c xi^2) at the points of the trapezoidal rule, c by bisection.
std::vector<double> stiffness_by_bisection(const std::vector<double>& xi, const std::vector<double>& weight, double ratio) {
  double low = -20, high = 20;
  std::vector<double> made(xi.size());
  for (int i = 0; i < 200; ++i) {
    const double c = 0.5 * (low + high);
    double sum = 0, second = 0;
    for (std::size_t p = 0; p < xi.size(); ++p) {
      made[p] = weight[p] * std::exp(c * (xi[p] * xi[p] - 1));
      sum += made[p], second += made[p] * xi[p] * xi[p];
    }
    for (double& each : made) each /= sum;
    (3 * second / sum < ratio ? low : high) = c;
  }
  return made;
}

/// A block that rocks until it lifts off, against an integration of its two equations of motion with the classical rule of fourth order.
TEST(Bed, RocksAsItsEquationsOfMotion) {
  constexpr int points = 11;
  constexpr double width = 10, spin = 0.12, weight = mass * 10, step = 1e-3;
  const Stiffness k = pais_kausel(width, width);
  std::vector<double> xi, share;
  for (int i = 0; i < points; ++i) xi.push_back(-1 + 2.0 * i / (points - 1)), share.push_back(i == 0 || i == points - 1 ? 0.5 : 1);
  const std::vector<double> f = stiffness_by_bisection(xi, share, k.tilting_a / (k.vertical * width * width / 12));
  using State = std::array<double, 4>;  // v, theta and their rates
  const auto rate = [&](const State& s) {
    double force = 0, moment = 0;
    for (std::size_t p = 0; p < xi.size(); ++p) {
      const double x = xi[p] * width / 2, push = -k.vertical * f[p] * std::min(s[0] + s[1] * x, 0.0);
      force += push, moment += push * x;
    }
    return State{s[2], s[3], (force - weight) / mass, moment / inertia};
  };
  const auto ahead = [](const State& s, const State& r, double h) {
    State made = s;
    for (std::size_t i = 0; i < 4; ++i) made[i] += h * r[i];
    return made;
  };
  State s{-weight / k.vertical, 0, 0, spin};
  std::vector<double> v{0}, theta{0};
  for (int i = 0; i < 400; ++i) {
    for (int j = 0; j < 20; ++j) {
      const double h = step / 20;
      const State a = rate(s), b = rate(ahead(s, a, h / 2)), c = rate(ahead(s, b, h / 2)), d = rate(ahead(s, c, h));
      for (std::size_t m = 0; m < 4; ++m) s[m] += h / 6 * (a[m] + 2 * b[m] + 2 * c[m] + d[m]);
    }
    v.push_back(s[0] + weight / k.vertical), theta.push_back(s[1]);
  }
  for (const char* law : {"type = \"springs\"\nK_n = \"soil\"\n",
                          "type = \"sdm\"\nK_n = \"soil\"\nF_u = 0\nG_f = 0.1\nF_c = -1e-3\ntangential = \"none\"\n"}) {
    std::string text = block(false, fmt::format("width = {0}\nthickness = {0}\npoints = {1}", width, points), law);
    text = replaced(text, "[[stage]]\n",
                    "[[support]]\nnode = \"base\"\nfixed = [\"ux\"]\n[gravity]\nacceleration = [0, -10]\n[[initial]]\nnode = \"base\"\n"
                    "angular_velocity = 0.12\n[[stage]]\ntype = \"static\"\n[[stage]]\n");
    text = replaced(text, "duration = 1\nstep = 1e-3\n[output]\n", "duration = 0.4\nstep = 2.5e-4\n[output]\nevery = 4\n") +
           "[[output.history]]\nnode = \"base\"\nquantity = \"uy\"\n[[output.history]]\nnode = \"base\"\nquantity = \"rz\"\n";
    const support::Ran ran = support::run_text(text);
    ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
    EXPECT_LT(std::abs(ran.result.final_energy.residual), 1e-10 * ran.result.energy_scale);
    EXPECT_GT(ran.result.max_uplifted_ratio.value, 0.3);
    const auto &lift = ran["base.uy"], &turn = ran["base.rz"];
    ASSERT_EQ(lift.size(), v.size());
    double most = 0, off = 0, most_lift = 0, lift_off = 0;
    for (std::size_t i = 0; i < v.size(); ++i) {
      most = std::max(most, std::abs(theta[i])), off = std::max(off, std::abs(turn[i] - theta[i]));
      most_lift = std::max(most_lift, std::abs(v[i])), lift_off = std::max(lift_off, std::abs(lift[i] - lift[0] - v[i]));
    }
    EXPECT_LT(off, 2e-4 * most) << law;
    EXPECT_LT(lift_off, 5e-4 * most_lift) << law;
  }
}

TEST(Bed, RefusesWhatItCannotBe) {
  const std::string plain = "width = 10\nthickness = 10\npoints = 11";
  const auto refusal = [&](const std::string& footing, const std::string& law, const std::string& soil = "", bool space = false) {
    return refusal_of(block(space, footing, law, soil));
  };
  const auto expect = [](const std::string& found, const std::string& part) { EXPECT_NE(found.find(part), std::string::npos) << found; };
  expect(refusal("width = 10\nthickness = 10\npoints = 2", springs), "(what the 2 points along the width can have");
  expect(refusal("width = 10\nthickness = 10\npoints = 5\nrule = \"midpoint\"", springs), "2.553 times");
  expect(refusal("width = 5\nthickness = 10\npoints = 11", springs), "no bed has more than 3");
  expect(refusal("width = 10\nlength = 20\npoints = 11\npoints_across = 21", springs, "", true), "along the width");
  expect(refusal("width = 20\nlength = 10\npoints = 11\npoints_across = 21", springs, "", true), "along the length");
  expect(refusal(plain, "type = \"unilateral\"\n"), "constraints know no stiffness");
  expect(refusal(plain, springs, "radiation = true\ndensity = 2000"), "c = \"soil\"");
  expect(refusal(plain, "type = \"springs\"\nK_n = \"soil\"\nc = \"soil\"\n"), "needs its density");
  expect(refusal(plain, "type = \"springs\"\nK_n = \"ground\"\n"), "soil");
  expect(refusal(plain + "\nbed = { stiffness = 1e8 }", springs), "either soil");
  expect(refusal(plain, springs, "embedment = 30"), "embedment");
  std::string without = block(false, plain, springs);
  without.replace(without.find("[interface.footing.soil]"), std::string("[interface.footing.soil]\nG = 80000000\npoisson = 0.3\n").size(),
                  "");
  expect(refusal_of(without), "[interface.footing.soil], which gives it");
}

}  // namespace
}  // namespace uplift::bed_test
