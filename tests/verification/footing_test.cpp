// Uplifting footings: half width b, vertical load W, rotation imposed on the body in statics, moment at its
// middle. Two springs k at +-b: M_u = W b, theta_u = W/(2 k b). Winkler strip k_w: M_u = W b/3, theta_u = W/(2 k_w b^2), beyond it M/M_u =
// 3 - 2 sqrt(theta_u/theta), contact ratio sqrt(theta_u/theta), heel jump 2 b theta (1 - sqrt(theta_u/theta)).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "manual.h"
#include "support.h"
#include "tower_case.h"

namespace uplift::verification::footing_test {
namespace {

using std::numbers::pi;

constexpr double b = 1.5, weight = 1e6, bed = 2e8;

struct Footing {
  std::string law = "{ type = \"springs\", K_n = 2e8, tangential = \"none\" }", method, rule = "nodal", bed;
  int points = 101;
  double thickness = 1, rotation = 0;

  /// The rotation is imposed, the settlement is free; the first row of the dynamic stage is the static answer.
  std::string text() const {
    char out[2000];
    std::snprintf(
        out, sizeof out,
        "title = \"Footing\"\n%s\n[nodes]\nbase = [0, 0]\n[[rigid]]\nname = \"footing\"\nnode = \"base\"\nmass = 1e4\ninertia = 7500\n"
        "[[support]]\nnode = \"base\"\nfixed = [\"ux\"]\n[[function]]\nname = \"held\"\nshape = { type = \"constant\" }\n"
        "[[motion]]\nnode = \"base\"\ndirection = \"rz\"\namplitude = %.17g\nfunction = \"held\"\n"
        "[[interface]]\nname = \"soil\"\nlaw = %s\nfooting = { body = \"base\", width = 3, points = %d, rule = \"%s\", thickness = %.17g "
        "%s}\n"
        "[[load]]\nnode = \"base\"\nforce = [0, -1e6]\n[[stage]]\ntype = \"static\"\nsteps = 1\n"
        "[[stage]]\ntype = \"dynamic\"\nduration = 1e-6\nstep = 1e-6\n[energy]\ncreated_limit = 1e9\n[limits]\nrotation = "
        "1\n[output]\nframes = 0\n",
        method.c_str(), rotation, law.c_str(), points, rule.c_str(), thickness, bed.c_str());
    return out;
  }
};

struct Answer {
  double moment = 0, uplifted = 0, jump = 0, toe = 0, axial = 0;
};
Answer answer(const Footing& footing) {
  const History run = run_text(footing.text());
  return {run["soil.moment"][0], run["soil.uplifted_ratio"][0], run["soil.max_opening"][0], run["soil.max_pressure"][0],
          run["soil.axial"][0]};
}

// Claim: two springs: linear up to theta_u = W/(2 k b) and M_u = W b, constant beyond; exact (1e-12).
TEST(Footing, TwoSprings) {
  VERIFIES({"Footings", "Footing on two springs", "Closed form: M = W b min(θ/θ_u, 1), θ_u = W/(2kb)"});
  const double k = bed * 1.5, theta_u = weight / (2 * k * b);  // nodal rule: half of the width each
  for (const double x : {0.25, 0.9, 1.5, 4.0}) {
    Footing footing;
    footing.points = 2;
    footing.rotation = x * theta_u;
    const Answer a = answer(footing);
    VERIFY_NEAR("moment", "N m", std::abs(a.moment), weight * b * std::min(x, 1.0), 1e-9 * weight) << x;
    VERIFY_NEAR("vertical force", "N", a.axial, -weight, 1e-9 * weight);
    VERIFY_NEAR("gap at the heel", "m", a.jump, x > 1 ? 2 * b * (x - 1) * theta_u : 0, 1e-12) << x;
    // the opening is linear between the springs: 2 b (x - 1) theta_u on one side, -2 b theta_u on the other
    VERIFY_NEAR("uplifted share", "1", a.uplifted, x > 1 ? 1 - 1 / x : 0, 1e-6);
  }
}

// Claim: Winkler strip against the closed forms (and the CSV), moment, contact ratio, heel jump and toe pressure p_toe/p_mean = 2
// sqrt(theta/theta_u); 1601 nodal points: 1e-5 for the moment, one point for the ratio. The settled footing is first bonded: M = theta 2
// k_w b^3/3.
TEST(Footing, WinklerStrip) {
  VERIFIES(
      {"Footings", "Rigid strip on a Winkler bed",
       "Closed form: M/M_u = 3 − 2 √(θ_u/θ), contact √(θ_u/θ), toe pressure 2 √(θ/θ_u); table tests/data/reference/winkler_strip.csv"});
  const double theta_u = weight / (2 * bed * b * b), m_u = weight * b / 3, mean = weight / (2 * b);
  const Reference table = reference("winkler_strip.csv");
  for (const double x : {0.5, 0.99, 1.2, 2.040816326530612, 3.0, 6.0, 10.0}) {
    Footing footing;
    footing.points = 1601;
    footing.rotation = x * theta_u;
    const Answer a = answer(footing);
    const double root = x > 1 ? std::sqrt(1 / x) : 1, moment = x > 1 ? 3 - 2 * root : x;
    VERIFY_NEAR("moment over M_u", "1", std::abs(a.moment) / m_u, moment, 1e-5) << x;
    VERIFY_NEAR("vertical force", "N", a.axial, -weight, 1e-9 * weight);
    VERIFY_NEAR("share in contact", "1", 1 - a.uplifted, root, 1.0 / 1600) << x;
    VERIFY_NEAR("gap at the heel", "m", a.jump, x > 1 ? 2 * b * x * theta_u * (1 - root) : 0, 1e-5 * b * x * theta_u) << x;
    VERIFY_NEAR("toe pressure over mean pressure", "1", a.toe / mean, x > 1 ? 2 / root : 1 + x, 1e-4) << x;
    VERIFY_NEAR("moment over M_u, table of the reference", "1", interpolate(table["theta/theta_u"], table["M/Mu"], x), moment, 2e-3);
    VERIFY_NEAR("toe pressure over mean pressure, table of the reference", "1",
                interpolate(table["theta/theta_u"], table["p_toe/p_mean"], x), x > 1 ? 2 / root : 1 + x, 2e-2);
  }
}

// Claim: nodal joints: error of M at theta = 2.6 theta_u is of order 2, 2.7e-2, 6.4e-3, 1.4e-3, 3.0e-4 of M for 8, 16, 32, 64 joints
// (counted as cells of the trapezoidal rule): as printed, 4 %. Midpoints: order 2.
TEST(Footing, OrderOfTheQuadrature) {
  VERIFIES({"Footings", "Order of the quadrature of a footing",
            "Closed form of the Winkler strip at θ = 2.6 θ_u; errors of the trapezoidal rule"});
  const double theta_u = weight / (2 * bed * b * b), m_u = weight * b / 3, exact = m_u * (3 - 2 * std::sqrt(1 / 2.6));
  for (const char* rule : {"nodal", "midpoint"}) {
    std::vector<double> size, error;
    for (const int cells : {8, 16, 32, 64}) {
      Footing footing;
      footing.rule = rule;
      footing.points = cells + (footing.rule == "nodal");
      footing.rotation = 2.6 * theta_u;
      size.push_back(1.0 / cells);
      error.push_back(std::abs(std::abs(answer(footing).moment) / exact - 1));
    }
    verified_case.curve(std::string("moment, ") + rule, size, error);
    VERIFY_NEAR("order of convergence", "1", order(size, error), 2, 0.35) << rule;
    const double stated[] = {2.7e-2, 6.4e-3, 1.4e-3, 3.0e-4};
    for (int i = 0; i < 4 && std::string(rule) == "nodal"; ++i)
      VERIFY_NEAR("relative error of the moment, nodal rule", "1", error[static_cast<std::size_t>(i)], stated[i], 0.04 * stated[i]);
  }
}

// Claim: uplifted share 1 - sqrt(theta_u/theta) and toe pressure 2 W/(2 b) sqrt(theta/theta_u) on tensionless springs, with every rule and
// several numbers of points: order 2, less than 0.6/n^2 and 1/n^2; with 21 nodal points and the edge of the contact at one of them 0.30.
TEST(Footing, UpliftedShareAndToePressure) {
  VERIFIES({"Footings", "Uplifted share and toe pressure, three quadrature rules",
            "Closed form of the Winkler strip: 1 − √(θ_u/θ), 2 W/B √(θ/θ_u)"});
  const double theta_u = weight / (2 * bed * b * b), mean = weight / (2 * b);
  for (const char* rule : {"nodal", "midpoint", "gauss"})
    for (const double x : {1.2, 1 / 0.49, 3.7})
      for (const int cells : {10, 20, 40, 80}) {
        Footing footing;
        footing.rule = rule;
        footing.points = cells + (footing.rule == "nodal");
        footing.rotation = x * theta_u;
        const Answer a = answer(footing);
        const double share = 1 - std::sqrt(1 / x), toe = 2 * mean * std::sqrt(x);
        VERIFY_LT("error of the uplifted share", "1", std::abs(a.uplifted - share), 0.6 / (cells * cells))
            << rule << " " << cells << " " << x << ": " << a.uplifted;
        VERIFY_LT("relative error of the toe pressure", "1", std::abs(a.toe / toe - 1), 1.0 / (cells * cells))
            << rule << " " << cells << " " << x << ": " << a.toe / toe;
        if (footing.points == 21 && share > 0.29 && share < 0.31)
          VERIFY_NEAR("uplifted share with 21 nodal points", "1", a.uplifted, 0.3, 1e-4);
      }
}

// Claim: the same share where the bed lies under constraints, whose openings never get below zero: 3/n^2.
TEST(Footing, UpliftedShareOfConstraintsOnABed) {
  VERIFIES({"Footings", "Uplifted share of constraints on a bed of springs", "Closed form of the Winkler strip: 1 − √(θ_u/θ)"});
  const double theta_u = weight / (2 * bed * b * b);
  for (const double x : {1.2, 1 / 0.49, 3.7})
    for (const int cells : {10, 20, 40, 80}) {
      Footing footing;
      footing.law = "\"unilateral\"";
      footing.bed = ", bed = { stiffness = 2e8, mass = 1 }";
      footing.points = cells + 1;
      footing.rotation = x * theta_u;
      const Answer a = answer(footing);
      VERIFY_LT("error of the uplifted share", "1", std::abs(a.uplifted - (1 - std::sqrt(1 / x))), 3.0 / (cells * cells))
          << cells << " " << x << ": " << a.uplifted;
    }
}

// Claim: penalty with k_w per area gives the springs' answer (1e-9); so does the SDM with F_u = 0 and a vanishing closure stress, 1e-9 of
// the mean pressure (1e-6: the rotation is imposed before the load, so the gap closes in part).
TEST(Footing, LawsAgree) {
  VERIFIES({"Footings", "Springs, penalty method and SDM without strength agree",
            "Equivalence of the laws for K_n = penalty stiffness and F_u = 0"});
  const double theta_u = weight / (2 * bed * b * b);
  Footing springs;
  springs.rotation = 3 * theta_u;
  const Answer expected = answer(springs);
  Footing penalty = springs;
  penalty.law = "\"unilateral\"";
  penalty.method = "method = { type = \"penalty\", stiffness = 2e8 }";
  VERIFY_NEAR("moment, penalty method", "N m", answer(penalty).moment, expected.moment, 1e-9 * weight);
  Footing sdm = springs;
  sdm.law = "{ type = \"sdm\", K_n = 2e8, F_u = 0, G_f = 1, F_c = -3e-4, tangential = \"none\" }";
  VERIFY_NEAR("moment, SDM without strength", "N m", answer(sdm).moment, expected.moment, 1e-6 * weight);
  VERIFY_NEAR("gap at the heel, SDM without strength", "m", answer(sdm).jump, expected.jump, 1e-6 * expected.jump);
}

/// Rows of a run where a column crosses zero, as times by straight lines.
std::vector<double> crossings(const History& run, const std::string& name) {
  const std::vector<double>& y = run[name];
  std::vector<double> times;
  for (std::size_t i = 1; i < run.rows(); ++i)
    if (y[i - 1] * y[i] < 0) times.push_back(run.time()[i - 1] + y[i - 1] / (y[i - 1] - y[i]) * (run.time()[i] - run.time()[i - 1]));
  return times;
}

// Claim: rocking oscillator on two springs, released at theta0 = x theta_u: T/T0 = (2/pi)(asin(1/sqrt(2x - 1)) + sqrt(2(x - 1))), T0 = 2 pi
// sqrt(J/(2 k b^2)). The closed form has no vertical inertia: the footing's mass is so small that it bounces 300 times as fast as it rocks.
// 1e-3 for two quarter and one half periods.
TEST(Footing, PeriodOfRockingOnTwoSprings) {
  VERIFIES({"Footings", "Period of rocking on two springs", "Closed form: T/T₀ = (2/π)(asin(1/√(2x − 1)) + √(2(x − 1)))"});
  const double k = bed * 1.5, theta_u = weight / (2 * k * b), inertia = 1e7, w0 = std::sqrt(2 * k * b * b / inertia),
               mass = 2 * k / std::pow(300 * w0, 2);
  for (const double x : {2.0, 5.0}) {
    const double ratio = 2 / pi * (std::asin(1 / std::sqrt(2 * x - 1)) + std::sqrt(2 * (x - 1)));
    VERIFY_NEAR("closed form of the period ratio", "1", ratio, x == 2 ? 1.292142868 : 2.016979528, 1e-9);
    const double period = ratio * 2 * pi / w0;
    char text[2500];
    std::snprintf(
        text, sizeof text,
        "title = \"Rocking\"\n[nodes]\nbase = [0, 0]\n[[rigid]]\nname = \"footing\"\nnode = \"base\"\nmass = %.17g\ninertia = %.17g\n"
        "[[support]]\nnode = \"base\"\nfixed = [\"ux\"]\n[[interface]]\nname = \"soil\"\nlaw = { type = \"springs\", K_n = 2e8, tangential "
        "= "
        "\"none\" }\nfooting = { body = \"base\", width = 3, points = 2 }\n[[load]]\nnode = \"base\"\nforce = [0, -1e6]\n"
        // on one spring the middle of the footing is higher than under the static load
        "[[initial]]\nnode = \"base\"\nrotation = %.17g\ndisplacement = [0, %.17g]\n[[stage]]\ntype = \"static\"\nsteps = 1\n"
        "[[stage]]\ntype = \"dynamic\"\nduration = %.17g\nstep = %.17g\n[limits]\nrotation = 1\n[output]\nframes = 0\n",
        mass, inertia, x * theta_u, (x - 1) * theta_u * b, 1.1 * period, period / 50000);
    const History run = run_text(text);
    ASSERT_EQ(run.status, "completed") << run.reason;
    const std::vector<double> times = crossings(run, "base.rz");
    ASSERT_EQ(times.size(), 2U);
    VERIFY_NEAR("first quarter period over its closed form", "1", times[0] / (period / 4), 1, 1e-3) << x;
    VERIFY_NEAR("half period over its closed form", "1", (times[1] - times[0]) / (period / 2), 1, 1e-3) << x;
    RecordProperty("period_ratio_" + std::to_string(x), std::to_string((times[1] - times[0]) * w0 / pi));
  }
}

// Claim: frequency of a mass on a column on a bonded footing, f = f0/sqrt(1 + w0^2 m h^2/k_theta), k_theta = 2/3 k_w b^3 (strip) and 2 k
// b^2 (two springs): 1e-3 (a footing with almost no mass; 20 half periods of a free vibration that never lifts).
TEST(Footing, BondedFrequency) {
  VERIFIES({"Footings", "Frequency of a mass on a column on a bonded footing", "Closed form: f = f₀/√(1 + ω₀² m h²/k_θ)"});
  const double height = 5, mass = 2e4, f0 = 10, w0 = 2 * pi * f0, EI = mass * w0 * w0 * std::pow(height, 3) / 3;
  for (const int points : {2, 401}) {
    const double k_theta = points == 2 ? 2 * (bed * b) * b * b : 2.0 / 3 * bed * b * b * b;
    const double exact = f0 / std::sqrt(1 + w0 * w0 * mass * height * height / k_theta);
    const support::Tower column{
        .young = fmt::format("{:.17g}", EI), .inertia = "1", .mass = "mass = 2e4", .footing = "mass = 1\ninertia = 1"};
    const History run =
        run_text("title = \"Bonded\"" + column.text() +
                 fmt::format("[[interface]]\nname = \"soil\"\nlaw = {{ type = \"springs\", K_n = 2e8, tangential = \"none\" }}\n"
                             "footing = {{ body = \"base\", width = 3, points = {} }}\n[[load]]\nnode = \"base\"\nforce = [0, -1e6]\n"
                             "[[initial]]\nnode = \"top\"\nvelocity = [1e-3, 0]\n[[stage]]\ntype = \"static\"\nsteps = 1\n"
                             "[[stage]]\ntype = \"dynamic\"\nduration = {:.17g}\nstep = {:.17g}\n[output]\nframes = 0\n",
                             points, 10.6 / exact, 1 / exact / 2000));
    ASSERT_EQ(run.status, "completed") << run.reason;
    VERIFY_EQ("uplifted share", "1", run.peak("soil.uplifted_ratio"), 0);
    const std::vector<double> times = crossings(run, "top.ux");
    ASSERT_GT(times.size(), 20U);
    VERIFY_NEAR("frequency over its closed form", "1", 20 / (2 * (times[20] - times[0])) / exact, 1, 1e-3) << points;
  }
}

}  // namespace
}  // namespace uplift::verification::footing_test
