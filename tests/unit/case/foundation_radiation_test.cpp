// Radiation dashpots beside a [[foundation]]: what the ground exerts on the footing is law and dashpots together. Equilibrium with the
// structure, closed forms of harmonic motions, and the same model with dashpots that the case states.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

#include "ran_support.h"
#include "uplift/case/case.h"
#include "uplift/io/text/toml.h"
#include "uplift/verdict/motion.h"
#include "uplift/verdict/verdict.h"

namespace uplift::foundation_radiation_test {
namespace {

using Column = Request::Kind;

struct Ran : support::Ran {
  double largest(const std::string& name, double from = 0) const {
    double most = 0;
    for (std::size_t i = 0; i < rows(); ++i)
      if (result.table[0][i] >= from) most = std::max(most, std::abs((*this)[name][i]));
    return most;
  }
  double largest_of_dashpots(const std::string& force) const {
    double most = 0;
    for (std::size_t i = 0; i < rows(); ++i)
      most = std::max(most, std::abs((*this)["ground." + force][i] - (*this)["ground.law_" + force][i]));
    return most;
  }
  double verdict(QuantityName name) const {
    const VerdictNumbers numbers = numbers_of(built, result, nullptr);
    const VerdictNumber* number = find_number(numbers.interfaces.front().numbers, name);
    return number ? number->value : NAN;
  }
};

Ran run_text(const std::string& text, std::size_t which = 0) {
  Ran made{support::run_text(text, which)};
  EXPECT_EQ(made.result.status, RunStatus::completed) << made.result.reason;
  return made;
}

std::string histories(const std::string& node, std::initializer_list<const char*> quantities) {
  std::string text;
  for (const char* quantity : quantities) text += "[[output.history]]\nnode = \"" + node + "\"\nquantity = \"" + quantity + "\"\n";
  return text;
}

constexpr double top_mass = 100e3, top_inertia = 1e5, footing_mass = 30e3, footing_inertia = 60e3, gravity = 9.81, height = 10;
constexpr const char* soil = R"([foundation.soil]
embedment = 1
frequency = 3
radiation = true
layers = [{ thickness = 2, G = "60 MPa", poisson = 0.3, density = 1900 }, { G = "90 MPa", poisson = 0.35, density = 2000 }]
)";
FootingOnSoil ground() {
  FootingOnSoil made;
  made.width = 6, made.length = 9, made.frequency = 3, made.embedment = 1;
  made.layers = {{Ground{60e6, 0.3, 1900}, 2}, {Ground{90e6, 0.35, 2000}}};
  return made;
}

struct Tower {
  bool space = false;
  std::string model = "{ type = \"macro_element\" }", soil_table = soil, step = "2e-3", of_stage = {}, more = {};
  bool thrown = false;  // moves at the beginning

  /// A mass on a column over a footing, whose underside lies beside and below the node of the footing. The pulse lifts it.
  std::string text() const {
    const std::string nodes =
        space ? "base = [0, 0, 0]\ntop = [0, 0, 10]\nunder = [0.3, -0.2, -1]\n" : "base = [0, 0]\ntop = [0, 10]\nunder = [0.3, -1]\n";
    return "title = \"tower\"\n[nodes]\n" + nodes + "[[beam]]\nname = \"column\"\nnodes = [\"base\", \"top\"]\nE = 3e10\nA = 1\n" +
           (space ? "I_y = 0.2\nI_z = 0.2\nJ = 0.3\n" : "I = 0.2\n") + "[[mass]]\nnode = \"top\"\nmass = 100e3\ninertia = 1e5\n" +
           "[[rigid]]\nname = \"footing\"\nnode = \"base\"\nmass = 30e3\ninertia = 60e3\nslaves = [\"under\"]\n" +
           "[gravity]\nacceleration = " + (space ? "[0, 0, -9.81]" : "[0, -9.81]") +
           "\n[[foundation]]\nname = \"ground\"\nbody = \"base\"\nwidth = 6\nlength = 9\noffset = " +
           (space ? "[0.3, -0.2, -1]" : "[0.3, -1]") + "\nmodel = " + model + "\n" + soil_table + more + R"(
[[function]]
name = "pulse"
shape = { type = "half_sine", duration = 0.3 }
[[ground_acceleration]]
function = "pulse"
amplitude = 5
direction = )" +
           (space ? "[0.72, 0.54, 0.435889894354067]" : "[0.9, 0.435889894354067]") + R"(
[[stage]]
type = "static"
)" + (thrown ? std::string("[[initial]]\nnode = \"base\"\nvelocity = ") + (space ? "[0.02, -0.01, 0.01]\n" : "[0.02, 0.01]\n") : "") +
           "[[stage]]\ntype = \"dynamic\"\nduration = 1\nstep = " + step + "\n" + of_stage + "[output]\nframes = 0\n";
  }
};

/// Largest sum of the forces on the structure and of their moments about the underside, over the largest force and moment of the ground.
double out_of_balance_in_plane(const Ran& ran) {
  const double x_0 = -0.3, y_0 = 1;  // the footing's node from the underside
  double most = 0, force = 0, moment = 0;
  for (std::size_t i = 0; i < ran.rows(); ++i) {
    double fx = -ran["ground.shear"][i], fy = -ran["ground.axial"][i], m = -ran["ground.moment"][i];
    force = std::max({force, std::abs(fx), std::abs(fy)}), moment = std::max(moment, std::abs(m));
    const auto add = [&](const std::string& node, double mass, double inertia, double x, double y) {
      const double px = mass * ran[node + ".abs_ax"][i], py = mass * (ran[node + ".abs_ay"][i] + gravity);
      fx -= px, fy -= py, m -= x * py - y * px + inertia * ran[node + ".arz"][i];
    };
    add("top", top_mass, top_inertia, x_0, y_0 + height);
    add("base", footing_mass, footing_inertia, x_0, y_0);
    most = std::max({most, std::abs(fx), std::abs(fy), std::abs(m) / height});
  }
  EXPECT_GT(force, 1e5);
  EXPECT_GT(moment, 1e6);
  return most / force;
}

double out_of_balance_in_space(const Ran& ran) {
  const Vec3 to_base(-0.3, 0.2, 1), to_top = to_base + Vec3(0, 0, height);
  double most = 0, force = 0;
  for (std::size_t i = 0; i < ran.rows(); ++i) {
    const auto of = [&](const char* name) { return ran[std::string("ground.") + name][i]; };
    Vec3 f(-of("shear_1"), -of("shear_2"), -of("axial")), m(-of("moment_1"), -of("moment_2"), -of("torsion"));
    force = std::max(force, f.norm());
    const auto add = [&](const std::string& node, double mass, double inertia, const Vec3& arm) {
      const auto at = [&](const char* name) { return ran[node + "." + name][i]; };
      const Vec3 p = mass * Vec3(at("abs_ax"), at("abs_ay"), at("abs_az") + gravity);
      f -= p, m -= cross(arm, p) + inertia * Vec3(at("arx"), at("ary"), at("arz"));
    };
    add("top", top_mass, top_inertia, to_top);
    add("base", footing_mass, footing_inertia, to_base);
    most = std::max({most, f.norm(), m.norm() / height});
  }
  EXPECT_GT(force, 1e5);
  return most / force;
}

TEST(FoundationRadiation, TheGroundBalancesTheStructureInThePlane) {
  const std::string columns = histories("top", {"abs_ax", "abs_ay", "arz"}) + histories("base", {"abs_ax", "abs_ay", "arz"});
  for (const char* of_stage : {"", "traction = \"end\"\n", "scheme = \"energy_decay\"\n"}) {
    SCOPED_TRACE(of_stage);
    const std::string text = Tower{.of_stage = of_stage, .thrown = true}.text() + columns;
    const Ran uplifting = run_text(text), bonded = run_text(text, 1);
    EXPECT_GT(uplifting.result.max_uplifted_ratio.value, 0.1);
    EXPECT_LT(out_of_balance_in_plane(uplifting), 1e-9);
    EXPECT_LT(out_of_balance_in_plane(bonded), 1e-9);
    EXPECT_GT(std::abs(uplifting["ground.shear"][0] - uplifting["ground.law_shear"][0]), 1e5);  // the velocity at the beginning
  }
}

TEST(FoundationRadiation, TheGroundBalancesTheStructureInSpace) {
  const std::string columns = histories("top", {"abs_ax", "abs_ay", "abs_az", "arx", "ary", "arz"}) +
                              histories("base", {"abs_ax", "abs_ay", "abs_az", "arx", "ary", "arz"});
  for (const char* of_stage : {"", "traction = \"end\"\n", "scheme = \"energy_decay\"\n"}) {
    SCOPED_TRACE(of_stage);
    const Ran ran = run_text(Tower{.space = true, .of_stage = of_stage, .thrown = true}.text() + columns);
    EXPECT_GT(ran.result.max_uplifted_ratio.value, 0.1);
    EXPECT_LT(out_of_balance_in_space(ran), 1e-9);
    for (std::size_t i = 0; i < ran.rows(); ++i) {
      ASSERT_DOUBLE_EQ(ran["ground.shear"][i], std::hypot(ran["ground.shear_1"][i], ran["ground.shear_2"][i]));
      ASSERT_DOUBLE_EQ(ran["ground.law_moment"][i], std::hypot(ran["ground.law_moment_1"][i], ran["ground.law_moment_2"][i]));
    }
  }
}

// The same structure with [[dashpot]]s: their forces are none of the foundation's.
TEST(FoundationRadiation, DashpotsOfTheCaseMakeTheSameMotionsAndAreNoGroundForces) {
  using enum SoilMotion;
  const SoilSprings k = soil_springs(ground());
  const auto dashpot = [](const char* direction, const char* kind, double value) {
    return fmt::format("[[dashpot]]\nnodes = [\"under\"]\n{}{} = {:.17g}\n", direction, kind, value);
  };
  const Ran radiating = run_text(Tower{}.text());
  const std::string model = fmt::format("{{ type = \"macro_element\", K_v = {:.17g}, K_h = {:.17g}, K_r = {:.17g} }}",
                                        k[vertical].stiffness(), k[along_width].stiffness(), k[tilting_width].stiffness());
  const Ran beside = run_text(Tower{.model = model,
                                    .soil_table = "",
                                    .more = dashpot("direction = [1, 0]\n", "damping", k[along_width].damping) +
                                            dashpot("direction = [0, 1]\n", "damping", k[vertical].damping) +
                                            dashpot("", "rotational_damping", k[tilting_width].damping)}
                                  .text());
  EXPECT_GT(radiating.result.max_uplifted_ratio.value, 0.1);
  ASSERT_EQ(find_column(beside.result, Column::law_moment, 0), nullptr);
  for (const auto& [one, other] : {std::pair{"top.ux", "top.ux"},
                                   {"base.rz", "base.rz"},
                                   {"ground.max_opening", "ground.max_opening"},
                                   {"ground.law_axial", "ground.axial"},
                                   {"ground.law_shear", "ground.shear"},
                                   {"ground.law_moment", "ground.moment"}}) {
    const double most = beside.largest(other);
    ASSERT_GT(most, 1e-5) << other;
    for (std::size_t i = 0; i < beside.rows(); ++i) ASSERT_NEAR(radiating[one][i], beside[other][i], 1e-9 * most) << one << " " << i;
  }
  EXPECT_GT(radiating.largest_of_dashpots("shear"), 0.1 * radiating.largest("ground.shear"));
}

// ---- closed forms ----

// A rigid block with its centre h above the underside, shaken along x; K* = K + i w c. With (u, theta) of the centre and the motion
// u + h theta of the underside
//   -w2 m u + Kh* (u + h theta) = -m a        -w2 J theta + h Kh* (u + h theta) + Kr* theta = 0
TEST(FoundationRadiation, HarmonicBaseForcesAreThoseOfTheComplexStiffness) {
  using enum SoilMotion;
  using Complex = std::complex<double>;
  const SoilSprings k = soil_springs(ground());
  const double w = 2 * std::numbers::pi * 3, m = 4e5, inertia = 2e6, h = 2, a = 1.5;
  const auto complex_of = [&](SoilMotion motion) { return Complex(k[motion].stiffness(), w * k[motion].damping); };
  const Complex kh = complex_of(along_width), kr = complex_of(tilting_width), kv = complex_of(vertical);
  const Complex a11 = kh - w * w * m, a12 = h * kh, a22 = h * h * kh + kr - w * w * inertia, det = a11 * a22 - a12 * a12;
  const double along = 0.8, up = 0.6;
  const Complex u = -m * a * along * a22 / det, theta = m * a * along * a12 / det, under = u + h * theta;
  const Complex lift = -m * a * up / (kv - w * w * m);
  const Ran ran = run_text(R"(title = "block"
[nodes]
centre = [0, 0]
[[rigid]]
name = "block"
node = "centre"
mass = 4e5
inertia = 2e6
[[foundation]]
name = "ground"
body = "centre"
width = 6
length = 9
offset = [0, -2]
model = "elastic"
)" + std::string(soil) + R"([[function]]
name = "wave"
shape = { type = "harmonic", frequency = 3 }
[[ground_acceleration]]
function = "wave"
amplitude = 1.5
direction = [0.8, 0.6]
[[stage]]
type = "dynamic"
duration = 8
step = 5e-4
[output]
frames = 0
)");
  const auto expect = [&](const char* column, double amplitude) {
    EXPECT_NEAR(ran.largest(column, 7), amplitude, 1e-4 * amplitude) << column;
  };
  expect("ground.shear", std::abs(kh * under));
  expect("ground.moment", std::abs(kr * theta));
  expect("ground.axial", std::abs(kv * lift));
  expect("ground.law_shear", std::abs(kh.real() * under));
  expect("ground.law_moment", std::abs(kr.real() * theta));
  expect("ground.law_axial", std::abs(kv.real() * lift));
  EXPECT_GT(std::abs(kh), 1.05 * kh.real());
  EXPECT_GT(std::abs(kv), 1.05 * kv.real());
}

// The body moves as the case says, w = A sin(2 pi f t): N = K w + c dw/dt.
TEST(FoundationRadiation, APrescribedMotionIsAVelocityOfTheDashpotsToo) {
  using enum SoilMotion;
  const SoilSpring k = soil_springs(ground())[vertical];
  const double frequency = 2, rate = 2 * std::numbers::pi * frequency, amplitude = 1e-3;
  const auto text = [](const char* of_stage) {
    return R"(title = "piston"
[nodes]
base = [0, 0]
[[rigid]]
name = "block"
node = "base"
mass = 4e5
inertia = 2e6
[[support]]
node = "base"
fixed = ["ux"]
[[function]]
name = "wave"
shape = { type = "harmonic", frequency = 2 }
[[motion]]
node = "base"
direction = "uy"
amplitude = 1e-3
function = "wave"
[[foundation]]
name = "ground"
body = "base"
width = 6
length = 9
model = "elastic"
)" + std::string(soil) +
           "[[stage]]\ntype = \"dynamic\"\nduration = 0.5\nstep = 1e-3\n" + of_stage + "[output]\nframes = 0\n";
  };
  const auto wanted = [&](double t) { return amplitude * (k.stiffness() * std::sin(rate * t) + rate * k.damping * std::cos(rate * t)); };
  for (const bool mean : {true, false}) {
    const Ran ran = run_text(text(mean ? "" : "traction = \"end\"\n"));
    const double most = ran.largest("ground.axial");
    for (std::size_t i = 1; i < ran.rows(); ++i) {
      const double t = ran.result.table[0][i], before = ran.result.table[0][i - 1];
      ASSERT_NEAR(ran["ground.axial"][i], mean ? 0.5 * (wanted(t) + wanted(before)) : wanted(t), 1e-9 * most) << t;
    }
  }
}

// ---- the verdict ----

TEST(FoundationRadiation, TheVerdictStatesTheGroundForcesAndTheStrengthThatTheLawUses) {
  const std::string text = Tower{.model = "{ type = \"macro_element\", V_s = 8e6, friction_angle = \"40 deg\" }",
                                 .of_stage = "traction = \"end\"\n",
                                 .more = "[verdict]\nwindow = 1e-6\n"}
                               .text();
  const Ran ran = run_text(text);
  const double weight = (top_mass + footing_mass) * gravity;
  double eccentricity = 0, sliding = 0, bearing = 0, safety = HUGE_VAL;
  for (std::size_t i = 0; i < ran.rows(); ++i) {
    const double n = -ran["ground.axial"][i], h = ran["ground.shear"][i], m = ran["ground.moment"][i];
    const double law_n = -ran["ground.law_axial"][i], law_h = ran["ground.law_shear"][i], law_m = ran["ground.law_moment"][i];
    if (n > 1e-3 * weight) eccentricity = std::max(eccentricity, std::abs(m / n) / 6);
    if (n > 1e-3 * weight) safety = std::min(safety, std::tan(40 * std::numbers::pi / 180) * n / std::abs(h));
    if (!(law_n > 1e-3 * weight)) continue;
    sliding = std::max(sliding, std::abs(law_h) / (law_n * std::tan(40 * std::numbers::pi / 180)));
    bearing = std::max(bearing, law_n / (8e6 * std::pow(1 - std::abs(law_h) / law_n, 3) * (1 - 2 * std::abs(law_m) / (law_n * 6))));
  }
  EXPECT_DOUBLE_EQ(ran.verdict("max_shear"), ran.largest("ground.shear"));
  EXPECT_DOUBLE_EQ(ran.verdict("max_moment"), ran.largest("ground.moment"));
  EXPECT_NEAR(ran.verdict("max_eccentricity"), eccentricity, 1e-12);
  EXPECT_NEAR(ran.verdict("min_sliding_safety"), safety, 1e-12 * safety);
  EXPECT_NEAR(ran.verdict("max_bearing_utilisation"), std::min(1.0, bearing), 1e-9);
  EXPECT_NEAR(ran.verdict("max_sliding_utilisation"), std::min(1.0, sliding), 1e-9);
  const std::vector<std::string> said = judge(ran.built, ran.result, nullptr).paragraphs;
  EXPECT_TRUE(std::ranges::any_of(said, [](const std::string& each) { return each.find("radiation dashpots") != each.npos; }));
  EXPECT_GT(ran.largest("ground.moment"), 1.02 * ran.largest("ground.law_moment"));
  EXPECT_EQ(ran.result.max_base_moment.value * ran.result.max_base_moment.value, std::pow(ran.largest("ground.moment"), 2));
}

// The base loses all contact and lands: there the largest force of the horizontal dashpot is reached.
TEST(FoundationRadiation, PeaksConvergeWithTheStep) {
  const auto peaks = [](const char* step) {
    const Ran ran = run_text(Tower{.step = step}.text());
    EXPECT_GT(ran.result.full_loss, 0.05);
    return std::array{ran.largest("ground.moment"), ran.verdict("max_moment"), ran.largest_of_dashpots("moment"),
                      ran.largest_of_dashpots("shear")};
  };
  const auto fine = peaks("6.25e-5"), coarse = peaks("2e-3"), half = peaks("1e-3"), quarter = peaks("5e-4");
  for (std::size_t k = 0; k < fine.size(); ++k) {
    const auto error = [&](const auto& of) { return std::abs(of[k] / fine[k] - 1); };
    const bool at_landing = k == 3;
    EXPECT_LT(error(half), (at_landing ? 1.0 : 0.5) * error(coarse)) << k;
    EXPECT_LT(error(quarter), (at_landing ? 1.0 : 0.5) * error(half)) << k;
    EXPECT_LT(error(quarter), at_landing ? 0.01 : 1e-3) << k;
  }
}

}  // namespace
}  // namespace uplift::foundation_radiation_test
