#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "ran_support.h"
#include "text_support.h"

// A structure on a macro-element that lifts off, yields and slides: mirrored, turned about the vertical and in other units it does the
// same. Everything is measured from a run in the axes x (y, z) and in SI units.
namespace uplift::foundation_symmetry_test {
namespace {

using support::Ran;

/// What a case is written in: lengths and forces in these units of metres and newtons, the axes x and y turned by `angle`, x times
/// `side` (-1: mirrored). Seconds stay.
struct Frame {
  double length = 1, force = 1, angle = 0, side = 1;
  double mass() const { return force / length; }
  double x(double along, double across) const { return side * (std::cos(angle) * along - std::sin(angle) * across); }
  double y(double along, double across) const { return std::sin(angle) * along + std::cos(angle) * across; }
};

std::string number(double value) {
  return fmt::format("{:.17g}", value);
}

enum class Loading { pulse, force_at_rest };

std::string structure(const Frame& frame, bool space, const std::string& ground, Loading loading = Loading::pulse) {
  const double l = frame.length, f = frame.force, m = frame.mass();
  const auto vector = [&](double along, double across, double up) {
    return space ? fmt::format("[{:.17g}, {:.17g}, {:.17g}]", frame.x(along, across), frame.y(along, across), up)
                 : fmt::format("[{:.17g}, {:.17g}]", frame.side * along, up);
  };
  std::string text = "title = \"foundation\"\n[nodes]\nbase = " + vector(0, 0, 0) + "\ntop = " + vector(0.3 * l, 0.2 * l, 10 * l) +
                     fmt::format("\n[[mass]]\nnode = \"top\"\nmass = {:.17g}\n", 100e3 * m);
  text += space ? fmt::format("inertia = {:.17g}\n", 1e5 * m * l * l) : "";
  text += fmt::format("[[beam]]\nname = \"column\"\nnodes = [\"base\", \"top\"]\nE = {:.17g}\nA = {:.17g}\n", 3e10 * f / (l * l), l * l);
  const double i = 0.2 * std::pow(l, 4);
  text += space ? fmt::format("I_y = {0:.17g}\nI_z = {0:.17g}\nJ = {1:.17g}\n", i, 1.5 * i) : fmt::format("I = {:.17g}\n", i);
  text += fmt::format("[[rigid]]\nname = \"footing\"\nnode = \"base\"\nmass = {:.17g}\n", 30e3 * m);
  text += space ? fmt::format("inertias = [{0:.17g}, {0:.17g}, {1:.17g}]\n", 60e3 * m * l * l, 100e3 * m * l * l)
                : fmt::format("inertia = {:.17g}\n", 60e3 * m * l * l);
  text += ground + "[gravity]\nacceleration = " + (space ? "[0, 0, " : "[0, ") + number(-9.81 * l) + "]\n[damping]\nalpha = 0.3\n";
  if (loading == Loading::pulse)
    text += "[[function]]\nname = \"pulse\"\nshape = { type = \"half_sine\", duration = 0.4 }\n[[ground_acceleration]]\ndirection = " +
            vector(space ? 0.8 : 1, 0.6, 0) + fmt::format("\nfunction = \"pulse\"\namplitude = {:.17g}\n", 4.3 * l) +
            "[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\nduration = 1.2\nstep = 4e-3\n";
  else
    text += "[[load]]\nnode = \"top\"\nforce = " + vector(150e3 * f, 112.5e3 * f, 0) + "\n[[stage]]\ntype = \"static\"\n";
  text += "[output]\nframes = 0\nautomatic = false\n";
  for (const char* node : {"top", "base"})
    for (const char* quantity : {"ux", "uy", "uz", "rx", "ry", "rz"})
      if (space || std::string(quantity) == "ux" || std::string(quantity) == "uy" || std::string(quantity) == "rz")
        text += fmt::format("[[output.history]]\nnode = \"{}\"\nquantity = \"{}\"\n", node, quantity);
  return text;
}

/// A footing of width along x and length along y that yields and slides.
std::string footing(const Frame& frame, const std::string& shape, double width, double length, bool space) {
  const double l = frame.length, f = frame.force;
  std::string text = fmt::format("[[foundation]]\nname = \"soil\"\nbody = \"base\"\nshape = \"{}\"\nwidth = {:.17g}\n", shape, width * l);
  if (space && shape == "rectangle") text += fmt::format("length = {:.17g}\n", length * l);
  const auto rocking = [&](double side) { return 6e8 * side * side / 12 * f * l; };
  text += fmt::format(
      "model = {{ type = \"macro_element\", shape_number = 6, K_v = {:.17g}, K_h = {:.17g}, K_r = {:.17g}, V_s = {:.17g}, V_u = {:.17g}, "
      "w_ref = {:.17g}, friction_angle = 0.25, cohesion = {:.17g}",
      6e8 * f / l, 3e8 * f / l, rocking(width), 5e6 * f, 8e6 * f, 0.02 * l, 2e3 * f / (l * l));
  if (space) text += fmt::format(", K_t = {:.17g}", 1e9 * f * l);
  if (space && shape == "rectangle") text += fmt::format(", K_r2 = {:.17g}", rocking(length));
  return text + " }\n";
}

/// The same one in space with its width along x of the frame; its horizontal stiffnesses differ.
std::string turned_footing(const Frame& frame) {
  const std::string width = fmt::format("width = {:.17g}\n", 6 * frame.length);
  const double azimuth = std::atan2(frame.y(1, 0), frame.x(1, 0));
  const std::string text =
      support::replaced(footing(frame, "rectangle", 6, 5, true), width, width + fmt::format("azimuth = {:.17g}\n", azimuth));
  return support::replaced(text, ", K_t", fmt::format(", K_h2 = {:.17g}, K_t", 2e8 * frame.force / frame.length));
}

/// Dashpots for the waves that the footing radiates.
std::string radiation(const Frame& frame) {
  const double l = frame.length;
  return fmt::format("[foundation.soil]\nradiation = true\nfrequency = 2\nlayers = [{{ G = {:.17g}, poisson = 0.3, density = {:.17g} }}]\n",
                     60e6 * frame.force / (l * l), 1900 * frame.mass() / std::pow(l, 3));
}

/// Horizontal vectors of the ground: shear, moment or rotation.
std::vector<Vec3> of_ground(const Ran& ran, const std::string& quantity) {
  std::vector<Vec3> made;
  for (std::size_t i = 0; i < ran.rows(); ++i) made.push_back({ran["soil." + quantity + "_1"][i], ran["soil." + quantity + "_2"][i], 0});
  return made;
}

/// Translation and rotation of a node in the frame of the case, in metres, and the largest of each.
struct Motion {
  std::vector<Vec3> moved, turned;
};
Motion motion(const Ran& ran, const std::string& node, bool space) {
  Motion made;
  for (std::size_t i = 0; i < ran.rows(); ++i) {
    const auto at = [&](const char* quantity) { return ran[node + "." + quantity][i]; };
    made.moved.push_back(space ? Vec3(at("ux"), at("uy"), at("uz")) : Vec3(at("ux"), at("uy"), 0));
    made.turned.push_back(space ? Vec3(at("rx"), at("ry"), at("rz")) : Vec3(0, 0, at("rz")));
  }
  return made;
}

/// The same motion in another frame; a rotation changes its sign in a mirror but about the axis across it.
Motion seen(const Motion& from, const Frame& frame, bool space) {
  Motion made = from;
  for (Vec3& u : made.moved)
    u = frame.length * (space ? Vec3(frame.x(u[0], u[1]), frame.y(u[0], u[1]), u[2]) : Vec3(frame.side * u[0], u[1], 0));
  for (Vec3& r : made.turned)
    r = space ? Vec3(frame.side * frame.x(r[0], r[1]), frame.side * frame.y(r[0], r[1]), frame.side * r[2]) : Vec3(0, 0, frame.side * r[2]);
  return made;
}

double largest(const std::vector<Vec3>& values) {
  double size = 0;
  for (const Vec3& value : values) size = std::max(size, value.norm());
  return size;
}

/// Largest distance over all rows, relative to the largest vector.
double distance(const std::vector<Vec3>& one, const std::vector<Vec3>& other) {
  double off = 0;
  for (std::size_t i = 0; i < one.size(); ++i) off = std::max(off, (one[i] - other[i]).norm());
  return off / largest(one);
}

void expect_same(const Ran& original, const Ran& other, const Frame& frame, bool space, const std::string& what) {
  ASSERT_EQ(original.rows(), other.rows()) << what;
  for (const char* node : {"top", "base"}) {
    const Motion expected = seen(motion(original, node, space), frame, space), found = motion(other, node, space);
    EXPECT_GT(largest(expected.moved), 1e-3 * frame.length);
    EXPECT_LT(distance(expected.moved, found.moved), 1e-9) << what << ", displacement of " << node;
    EXPECT_LT(distance(expected.turned, found.turned), 1e-9) << what << ", rotation of " << node;
  }
  EXPECT_NEAR(other.result.max_uplifted_ratio.value, original.result.max_uplifted_ratio.value, 1e-9) << what;
  const double lost = original.result.final_energy.interface_dissipated;
  EXPECT_NEAR(other.result.final_energy.interface_dissipated / (frame.force * frame.length), lost, 1e-9 * lost) << what;
}

void expect_activity(const Ran& ran) {
  EXPECT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
  EXPECT_GT(ran.result.max_uplifted_ratio.value, 0.2);
  EXPECT_GT(ran.result.final_energy.interface_dissipated, 0.02 * ran.result.energy_scale);
}

constexpr double turn = 37 * std::numbers::pi / 180;

TEST(FoundationSymmetry, InThePlane) {
  const auto ran = [](const Frame& frame) { return support::run_text(structure(frame, false, footing(frame, "rectangle", 6, 1, false))); };
  const Ran original = ran({});
  expect_activity(original);
  for (const auto& [what, frame] : std::vector<std::pair<std::string, Frame>>{
           {"mirrored", {.side = -1}}, {"mm, kN", {1e3, 1e-3}}, {"inches, pounds, mirrored", {39.37, 0.2248, 0, -1}}})
    expect_same(original, ran(frame), frame, false, what);
}

TEST(FoundationSymmetry, InSpace) {
  for (const std::string shape : {"rectangle", "disc"}) {
    const auto ran = [&](const Frame& frame, bool swapped = false) {
      return support::run_text(structure(frame, true, footing(frame, shape, swapped ? 5 : 6, swapped ? 6 : 5, true)));
    };
    const Ran original = ran({});
    expect_activity(original);
    std::vector<std::pair<std::string, Frame>> frames{
        {"mirrored", {.side = -1}}, {"mm, kN", {1e3, 1e-3}}, {"turned by 180 degrees", {1, 1, std::numbers::pi}}};
    if (shape == "disc") frames.push_back({"turned by 37 degrees, feet", {3.2808, 1, turn}});
    for (const auto& [what, frame] : frames) expect_same(original, ran(frame), frame, true, shape + " " + what);
    const Frame quarter{1, 1, std::numbers::pi / 2};
    if (shape == "rectangle") expect_same(original, ran(quarter, true), quarter, true, "rectangle turned by 90 degrees");
  }
}

// A rectangle of unequal sides whose azimuth is that of the frame. Shear, moments and rotations are along and about the axes of the model.
TEST(FoundationSymmetry, RectangleTurnedByItsAzimuth) {
  for (const std::string what : {"at rest", "pulse", "second order", "radiation"}) {
    const auto ran = [&](const Frame& frame) {
      const std::string ground = turned_footing(frame) + (what == "radiation" ? radiation(frame) : "");
      std::string text = structure(frame, true, ground, what == "at rest" ? Loading::force_at_rest : Loading::pulse);
      if (what == "second order") text = support::replaced(text, "step = 4e-3\n", "step = 4e-3\np_delta = true\n");
      for (const char* quantity : {"shear_1", "shear_2", "moment_1", "moment_2", "rotation_1", "rotation_2"})
        text += fmt::format("[[output.history]]\ninterface = \"soil\"\nquantity = \"{}\"\n", quantity);
      return support::run_text(text);
    };
    const Ran original = ran({});
    EXPECT_EQ(original.result.status, RunStatus::completed) << what << ": " << original.result.reason;
    EXPECT_GT(original.result.max_uplifted_ratio.value, 0.1) << what;
    EXPECT_GT(original.result.final_energy.interface_dissipated, 0.01 * original.result.energy_scale) << what;
    for (const auto& [how, frame] :
         std::vector<std::pair<std::string, Frame>>{{"turned by 37 degrees", {1, 1, turn}},
                                                    {"turned by 37 degrees and mirrored, mm, kN", {1e3, 1e-3, turn, -1}},
                                                    {"turned by -111 degrees", {1, 1, -3 * turn}}}) {
      const Ran other = ran(frame);
      expect_same(original, other, frame, true, what + ", " + how);
      for (const std::string quantity : {"shear", "moment", "rotation"}) {
        const double unit = quantity == "shear" ? frame.force : quantity == "moment" ? frame.side * frame.force * frame.length : frame.side;
        std::vector<Vec3> expected = of_ground(original, quantity);
        for (Vec3& v : expected) v = unit * Vec3(frame.x(v[0], v[1]), frame.y(v[0], v[1]), 0);
        EXPECT_LT(distance(expected, of_ground(other, quantity)), 1e-9) << what << ", " << how << ", " << quantity;
      }
    }
  }
}

// The same case with units in its text.
TEST(FoundationSymmetry, UnitsInTheText) {
  const std::string text = structure({}, false, footing({}, "rectangle", 6, 1, false));
  std::string other = text;
  for (const auto& [si, unit] : std::vector<std::pair<std::string, std::string>>{{"mass = 100000\n", "mass = \"100 t\"\n"},
                                                                                 {"mass = 30000\n", "mass = \"30 t\"\n"},
                                                                                 {"E = 30000000000\n", "E = \"30 kN/mm2\"\n"},
                                                                                 {"width = 6\n", "width = \"6000 mm\"\n"},
                                                                                 {"K_v = 600000000", "K_v = \"600 kN/mm\""},
                                                                                 {"K_r = 1800000000", "K_r = \"1800 MN m/rad\""},
                                                                                 {"V_s = 5000000", "V_s = \"5000 kN\""},
                                                                                 {"V_u = 8000000", "V_u = \"8 MN\""},
                                                                                 {"w_ref = 0.02", "w_ref = \"20 mm\""}})
    other = support::replaced(other, si, unit);
  expect_same(support::run_text(text), support::run_text(other), {}, false, "kN, mm, t");
}

}  // namespace
}  // namespace uplift::foundation_symmetry_test
