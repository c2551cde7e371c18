#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "unit/case/cut_support.h"

// Units that are powers of two of metre, kilogram and second change no digit of the input: a result that changes with them compares
// something with a length, a force or a time of the program's own, or adds what has other units, as translations and rotations. With other
// units, and for a model of another size with the same gravity, the input is rounded anew.
namespace uplift::unit_symmetry_test {
namespace {

using namespace support;

/// How many units make a metre, a kilogram, a second.
struct Units {
  double length = 1, mass = 1, time = 1;

  double of(int metres, int kilograms, int seconds) const {
    return std::pow(length, metres) * std::pow(mass, kilograms) * std::pow(time, seconds);
  }
  double force() const { return of(1, 1, -2); }
  double moment() const { return of(2, 1, -2); }
  double pressure() const { return of(-1, 1, -2); }
  /// Of a column by the quantity that its name ends with.
  double of_column(const std::string& name) const {
    const std::string quantity = name.substr(name.find('.') + 1);
    const auto is = [&](const char* what) { return quantity.starts_with(what); };
    if (name.starts_with("energy.")) return moment();
    if (is("ux") || is("uy") || is("uz") || is("max_opening")) return length;
    if (is("vx") || is("vy") || is("vz")) return length / time;
    if (is("vr")) return 1 / time;
    if (is("r") || is("uplifted_ratio")) return 1;
    if (is("axial") || is("shear")) return force();
    if (is("moment") || is("torsion")) return moment();
    if (is("max_pressure")) return pressure();
    ADD_FAILURE() << "no unit of " << name;
    return 1;
  }
};

/// A block that rocks and slides on a rigid ground, or a tower on a rigid footing on springs.
enum class Structure { block, block_in_space, tower };

std::string structure(Structure kind, const Units& u, const std::string& law) {
  const std::string interface = "[[interface]]\nname = \"base\"\nlaw = " + law + "\n[interface.footing]\n";
  switch (kind) {
    case Structure::block:
      return fmt::format(
                 "[nodes]\ntop = [0, {}]\n[[rigid]]\nname = \"body\"\nnode = \"top\"\nmass = {}\ninertia = {}\n[gravity]\nacceleration = "
                 "[0, {}]\n",
                 3 * u.length, 5e4 * u.mass, 4e4 * u.of(2, 1, 0), -9.81 * u.of(1, 0, -2)) +
             interface +
             fmt::format("body = \"top\"\nwidth = {}\nthickness = {}\npoints = 11\noffset = [0, {}]\n", 2 * u.length, u.length,
                         -3 * u.length);
    case Structure::block_in_space:
      return fmt::format(
                 "[nodes]\ntop = [0, 0, {}]\n[[rigid]]\nname = \"body\"\nnode = \"top\"\nmass = {}\ninertias = [{}, {}, {}]\n[gravity]\n"
                 "acceleration = [0, 0, {}]\n",
                 3 * u.length, 5e4 * u.mass, 4e4 * u.of(2, 1, 0), 5e4 * u.of(2, 1, 0), 2e4 * u.of(2, 1, 0), -9.81 * u.of(1, 0, -2)) +
             interface +
             fmt::format("body = \"top\"\nwidth = {}\nlength = {}\npoints = 5\npoints_across = 5\noffset = [0, 0, {}]\n", 2 * u.length,
                         2.5 * u.length, -3 * u.length);
    case Structure::tower:
      return fmt::format(
                 "[nodes]\nbase = [0, 0]\ntop = [0, {}]\n[[beam]]\nname = \"shaft\"\nnodes = [\"base\", \"top\"]\nE = {}\nA = {}\nI = {}\n"
                 "density = {}\nelements = 4\n[[mass]]\nnode = \"top\"\nmass = {}\ninertia = {}\n[[rigid]]\nname = \"body\"\nnode = "
                 "\"base\"\nmass = {}\ninertia = {}\n[gravity]\nacceleration = [0, {}]\n",
                 8 * u.length, 3e10 * u.pressure(), u.of(2, 0, 0), 0.12 * u.of(4, 0, 0), 2500 * u.of(-3, 1, 0), 6e4 * u.mass,
                 2e4 * u.of(2, 1, 0), 2e4 * u.mass, 9e3 * u.of(2, 1, 0), -9.81 * u.of(1, 0, -2)) +
             interface +
             fmt::format("body = \"base\"\nwidth = {}\nthickness = {}\npoints = 11\nbed = {{ stiffness = {}, damping = {}, mass = {} }}\n",
                         3 * u.length, u.length, 2e8 * u.of(-2, 1, -2), 1e5 * u.of(-2, 1, -1), 50 * u.of(-2, 1, 0));
  }
  return {};
}

/// What is computed, in any units.
struct Shaking {
  Structure kind;
  const char* method;
  const char* impact;   // empty: that of the law
  bool damped = false;  // by Rayleigh's damping and HHT-alpha; else undamped, by the trapezoidal rule
  bool lifts = true;
};

RunResult shaken(const Shaking& of, const Units& u, const std::string& law) {
  const Structure kind = of.kind;
  const std::string impact = of.impact;
  const bool space = kind == Structure::block_in_space;
  std::string text = "title = \"in other units\"\n";
  if (!impact.empty()) text += "impact = \"" + impact + "\"\n";
  text += structure(kind, u, law) + "[method]\ntype = \"" + of.method + "\"\n";
  if (of.damped) text += fmt::format("[damping]\nalpha = {}\nbeta = {}\n", 0.5 / u.time, 1e-3 * u.time);
  text += fmt::format("[[function]]\nname = \"pulse\"\nshape = {{ type = \"half_sine\", duration = {} }}\n", 0.4 * u.time);
  text += fmt::format("[[ground_acceleration]]\nfunction = \"pulse\"\ndirection = {}\namplitude = {}\n", space ? "[0.8, 0.6, 0]" : "[1, 0]",
                      6 * u.of(1, 0, -2));
  text += fmt::format("[[ground_acceleration]]\nname = \"vertical\"\nfunction = \"pulse\"\ndirection = {}\namplitude = {}\n",
                      space ? "[0, 0, 1]" : "[0, 1]", u.of(1, 0, -2));
  text +=
      fmt::format("[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\nduration = {}\nstep = {}\n", 0.8 * u.time, 2e-3 * u.time);
  if (of.damped) text += "scheme = { type = \"hht\", alpha = -0.1 }\n";
  const Case read = read_on(text, {});
  BuiltCase built = build(read, RunSpec{});
  return run(built.model, built.plan, built.behaviours);
}

const std::vector<Units> powers_of_two{{0x1p10, 1, 1}, {0x1p-10, 1, 1}, {1, 0x1p10, 1}, {1, 1, 0x1p-8}};

/// Histories in other units, each column up to round-off of the largest value of its kind.
void expect_same(const Shaking& of, const std::string& law, const std::function<std::string(const Units&)>& law_text,
                 const std::vector<Units>& all = powers_of_two) {
  constexpr double round_off = 1e-9;
  const RunResult metres = shaken(of, {}, law_text({}));
  const Units two{0x1p1, 0x1p-3, 0x1p7};  // tells kinds of quantities apart
  std::map<double, double> largest;       // of a kind of quantity
  double opening = 0;                     // m
  for (std::size_t k = 0; k < metres.columns.size(); ++k) {
    const std::string& name = metres.columns[k].name;
    double& size = largest[two.of_column(name)];
    for (const double value : metres.table[k + 1]) {
      size = std::max(size, std::abs(value));
      if (name.ends_with(".max_opening")) opening = std::max(opening, value);
    }
  }
  EXPECT_EQ(opening > 1e-3, of.lifts) << law;
  if (!of.lifts)  // what turns is but round-off: beside a rotation and its rate that move the corners as far and as fast as the block
    for (const char* rotation : {"top.rz", "top.vrz"})
      largest[two.of_column(rotation)] = largest[two.of_column(rotation[4] == 'v' ? "top.vx" : "top.ux")];
  for (const Units& units : all) {
    const std::string what = fmt::format("{}, {}, {}, structure {}, units {} {} {}", law, of.method, of.impact, static_cast<int>(of.kind),
                                         units.length, units.mass, units.time);
    const RunResult other = shaken(of, units, law_text(units));
    ASSERT_EQ(metres.table.front().size(), other.table.front().size()) << what << ": " << other.reason;
    for (std::size_t k = 0; k < metres.columns.size(); ++k) {
      const std::string& name = metres.columns[k].name;
      const double unit = units.of_column(name);
      double apart = 0;
      for (std::size_t i = 0; i < metres.table[k + 1].size(); ++i)
        apart = std::max(apart, std::abs(metres.table[k + 1][i] - other.table[k + 1][i] / unit));
      EXPECT_LE(apart, round_off * largest[two.of_column(name)]) << what << ": " << name;
    }
  }
}

constexpr Structure structures[] = {Structure::block, Structure::block_in_space, Structure::tower};

std::function<std::string(const Units&)> coulomb(double friction) {
  return [friction](const Units&) { return fmt::format("{{ type = \"coulomb\", friction = {} }}", friction); };
}

TEST(UnitSymmetry, Constraints) {
  for (const Structure kind : structures)
    for (const char* method : {"lagrange", "augmented_lagrangian"})
      for (const char* impact : {"project_hold", "propagate"}) expect_same({kind, method, impact}, "coulomb", coulomb(0.5));
}

/// With damping, whose force changes at impacts.
TEST(UnitSymmetry, DampedConstraints) {
  for (const char* method : {"lagrange", "augmented_lagrangian"}) {
    expect_same({Structure::block, method, "project_hold", true}, "coulomb", coulomb(0.5));
    expect_same({Structure::block_in_space, method, "project_hold", true, false}, "coulomb", coulomb(0.2));
  }
}

/// Millimetres and tonnes; a block a hundred times as large, in ten times the time, with the same gravity.
TEST(UnitSymmetry, MillimetresAndLargerBlocks) {
  const std::vector<Units> others{{1e3, 1e-3, 1}, {100, 1e6, 10}};
  for (const Structure kind : {Structure::block, Structure::block_in_space})
    for (const char* method : {"lagrange", "augmented_lagrangian"})
      for (const bool damped : {false, true})
        for (const double friction : {0.5, 0.9}) expect_same({kind, method, "project_hold", damped}, "coulomb", coulomb(friction), others);
}

TEST(UnitSymmetry, TractionLaws) {
  const auto with_strength = [](const char* type) {
    return [type](const Units& u) {
      return fmt::format("{{ type = \"{}\", K_n = {}, K_t = {}, tangential = \"bonded\", F_u = {}, G_f = {}{} }}", type,
                         5e8 * u.of(-2, 1, -2), 4e8 * u.of(-2, 1, -2), 1e4 * u.pressure(), u.of(0, 1, -2),
                         std::string(type) == "sdm" ? fmt::format(", F_c = {}", -1e4 * u.pressure()) : "");
    };
  };
  const auto springs = [](const Units& u) {
    return fmt::format("{{ type = \"springs\", K_n = {}, K_t = {}, tangential = \"coulomb\", friction = 0.5 }}", 5e8 * u.of(-2, 1, -2),
                       4e8 * u.of(-2, 1, -2));
  };
  for (const Structure kind : structures) {
    expect_same({kind, "newton", ""}, "springs", springs);
    for (const char* law : {"sdm", "exponential", "bilinear"}) expect_same({kind, "newton", ""}, law, with_strength(law));
  }
}

}  // namespace
}  // namespace uplift::unit_symmetry_test
