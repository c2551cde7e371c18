// Floor spectra through whole runs: what is recorded is the absolute acceleration, at every step, whatever is
// written.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <fstream>
#include <numbers>
#include <sstream>

#include "data_support.h"
#include "manual.h"
#include "support.h"
#include "tower_case.h"
#include "uplift/base/format.h"
#include "uplift/case/advice/step_suggestion.h"
#include "uplift/io/text/toml.h"
#include "uplift/verdict/floor_spectra.h"

namespace uplift::verification::floor_test {
namespace {

using std::numbers::pi;

struct Answer {
  RunResult result;
  std::vector<FloorSpectra> floors;

  const std::vector<double>& column(const std::string& name) const {
    for (std::size_t k = 0; k < result.columns.size(); ++k)
      if (result.columns[k].name == name) return result.table[k + 1];
    throw std::out_of_range(name);
  }
};

Answer run_floors(const std::string& text, bool bonded = false, bool spectra = true) {
  const Case read = check_case(read_toml_text(text, "case.toml"), "case.toml");
  RunSpec spec;
  spec.bonded = bonded;
  spec.pictures = false;
  const BuiltCase built = build(read, spec);
  Answer answer{run(built.model, built.plan, built.behaviours), {}};
  EXPECT_EQ(answer.result.status, RunStatus::completed) << answer.result.reason;
  if (spectra) answer.floors = floor_spectra(built.plan, answer.result);
  return answer;
}

/// A mass on a spring and a dashpot in the frame of the ground, whose acceleration has values at equal steps.
std::string oscillator(double frequency, double damping, const std::vector<double>& ground, double spacing, double step,
                       const std::string& floor) {
  const double omega = 2 * pi * frequency, mass = 1000;
  std::vector<double> times(ground.size());
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = static_cast<double>(i) * spacing;
  return fmt::format(
      "title = \"floor\"\n[nodes]\nfloor = [0, 1]\n[[mass]]\nnode = \"floor\"\nmass = {}\n"
      "[[spring]]\nnodes = [\"floor\"]\ndirection = [1, 0]\nstiffness = {}\n"
      "[[dashpot]]\nnodes = [\"floor\"]\ndirection = [1, 0]\ndamping = {}\n"
      "[[support]]\nnode = \"floor\"\nfixed = [\"uy\", \"rz\"]\n"
      "[[function]]\nname = \"quake\"\nshape = {{ type = \"table\", times = [{}], values = [{}] }}\n"
      "[[ground_acceleration]]\ndirection = [1, 0]\nfunction = \"quake\"\n"
      "[[stage]]\ntype = \"dynamic\"\nduration = {}\nstep = {}\n"
      "[output]\nautomatic = false\nenergies = false\n[[output.floor_spectrum]]\nname = \"floor\"\nnode = \"floor\"\ndirection = [1, "
      "0]\n{}\n",
      mass, mass * omega * omega, 2 * damping * omega * mass, fmt::join(times, ", "), fmt::join(ground, ", "), times.back(), step, floor);
}

std::vector<double> el_centro() {
  std::ifstream in(support::data_file("records/elcentro.dat"));
  std::vector<double> values{0};  // the record begins one step after rest
  for (std::string line; std::getline(in, line);) {
    std::istringstream numbers(line[0] == '#' ? "" : line);
    for (double value; numbers >> value && values.size() < 1560;) values.push_back(value);
  }
  return values;
}

/// Every n-th value.
std::vector<double> thinned(const std::vector<double>& values, std::size_t n) {
  std::vector<double> kept;
  for (std::size_t i = 0; i < values.size(); i += n) kept.push_back(values[i]);
  return kept;
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  EXPECT_EQ(a.size(), b.size());
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

// Claim: the floor of El Centro on an oscillator of 5 Hz and 5 %, 2 % equipment, raw, and its flat top when broadened. The reference takes
// the exact floor every 2.5 ms. The trapezoidal rule is of order 2: the period is longer by (w h)^2/12, which floor and resonant equipment
// feel through 1/(2 damping), 10 and 25 times; two steps extrapolated leave an error of order 4: 1e-6.
TEST(FloorSpectrum, ElCentro) {
  VERIFIES({"Floor spectra", "Floor spectrum of an oscillator under El Centro",
            "Exact oscillators for straight lines (Nigam & Jennings, BSSA 59 (1969) 909-922), tables of tests/data/reference"});
  const Reference reference_curve = reference("floor_spectrum_elcentro_5Hz.csv");
  const std::vector<double> quake = el_centro();
  ASSERT_EQ(quake.size(), 1560U);
  const std::vector<double>&f = reference_curve["f_Hz"], &raw = reference_curve["PSA2_g"];
  const std::string floor = fmt::format("damping = [0.02]\nfrequencies = [{}]", fmt::join(f, ", "));
  const double step = 0.0025, h = step / 8;
  const Answer coarse = run_floors(oscillator(5, 0.05, quake, 0.02, 2 * h, floor), false, false),
               fine = run_floors(oscillator(5, 0.05, quake, 0.02, h, floor));
  const std::vector<double> at_4 = thinned(coarse.result.floors[0].acceleration, 4), at_8 = thinned(fine.result.floors[0].acceleration, 8);
  ASSERT_EQ(at_8.size(), 1559U * 8 + 1);
  std::vector<double> exact;
  for (std::size_t i = 0; i < at_8.size(); ++i) exact.push_back(at_8[i] + (at_8[i] - at_4[i]) / 3);
  VERIFY_NEAR("ratio of the errors of two steps (order 2: 4)", "1", distance(at_4, exact) / distance(at_8, exact), 4, 0.02);
  VERIFY_NEAR("zero-period acceleration of the reference", "g", largest(exact), 0.823915, 1e-6);

  const Spectrum known = response_spectra(exact, step, f, {0.02}, Spectrum::Kind::psa).front(), wide = broadened(known, 0.15);
  const Spectrum seen = response_spectra(at_8, step, f, {0.02}, Spectrum::Kind::psa).front();
  const double omega = 2 * pi * 5, felt = std::pow(omega * h, 2) / 12 * (10 + 25);
  for (std::size_t i = 0; i < f.size(); ++i) {
    VERIFY_NEAR("spectrum extrapolated over the step, over the exact one", "1", known.values[i] / raw[i], 1, 1e-6) << f[i];
    if (f[i] > 0.86 * 5.0907 && f[i] < 1.14 * 5.0907)
      VERIFY_NEAR("broadened spectrum on its plateau", "g", value_at(wide, f[i]), 7.892547, 7.9e-6) << f[i];
    VERIFY_NEAR("spectrum with the step of the run, over the exact one", "1", seen.values[i] / raw[i], 1, felt) << f[i];
    // the answer of the program also finds the peaks between the points, by which the reference is at most 1.3 % too small
    VERIFY_GT("spectrum with peaks between the points, lower bound", "m/s2", fine.floors[0].raw[0].values[i], (1 - felt) * raw[i]) << f[i];
    VERIFY_LT("spectrum with peaks between the points, upper bound", "m/s2", fine.floors[0].raw[0].values[i], (1.013 + felt) * raw[i])
        << f[i];
    VERIFY_GE("broadened spectrum, at least the raw one", "m/s2", value_at(fine.floors[0].broadened[0], f[i]),
              fine.floors[0].raw[0].values[i] * (1 - 1e-12))
        << f[i];
  }
}

// Claim: harmonic ground of 8 Hz, floor of 10 Hz and 5 %, equipment of 12 Hz and 2 %: steady factors 2.72029410 and 4.89089831. The
// trapezoidal rule answers a harmonic exactly as if it were of the frequency tan(w h/2)/(h/2): the ground gets the frequency that is 8 Hz
// then. The equipment stands on straight lines between the steps, whose harmonic is smaller by (sin(w h/2)/(w h/2))^2. The amplitude grows
// so smoothly (five derivatives) that the beginning is not felt.
TEST(FloorSpectrum, HarmonicFactors) {
  VERIFIES({"Floor spectra", "Floor and equipment under harmonic ground",
            "Steady-state amplification of two oscillators in series, closed form"});
  const auto dynamic_factor = [](double r, double damping) { return 1 / std::abs(std::complex<double>(1 - r * r, 2 * damping * r)); };
  const double floor_factor = std::abs(std::complex<double>(1, 2 * 0.05 * 0.8)) * dynamic_factor(0.8, 0.05);
  VERIFY_NEAR("amplification of the floor", "1", floor_factor, 2.72029410, 1e-8);
  VERIFY_NEAR("amplification of the equipment", "1", floor_factor * dynamic_factor(8.0 / 12, 0.02), 4.89089831, 1e-8);

  const double h = 1e-3, grows = 14, frequency = std::atan(8 * pi * h) / (pi * h);
  std::vector<double> ground;
  for (int i = 0; i <= 20000; ++i) {
    const double t = i * h, x = std::min(1.0, t / grows);
    const double share = std::pow(x, 5) * (126 + x * (-420 + x * (540 + x * (-315 + x * 70))));
    ground.push_back(share * std::sin(2 * pi * frequency * t));
  }
  const Answer answer = run_floors(oscillator(10, 0.05, ground, h, h, "damping = [0.02]\nfrequencies = [12]\nbroadening = 0"));
  VERIFY_NEAR("zero-period acceleration of the floor over its closed form", "1",
              std::abs(answer.floors[0].zero_period.value) / floor_factor, 1, 1e-6);
  const double half = pi * frequency * h, straight = std::pow(std::sin(half) / half, 2);
  VERIFY_NEAR("spectral value of the equipment over its closed form", "1",
              answer.floors[0].raw[0].values[0] / (floor_factor * straight * dynamic_factor(frequency / 12, 0.02)), 1, 1e-6);
  EXPECT_TRUE(answer.floors[0].broadened.empty());
}

/// Spectrum of equipment with the damping `felt` on a floor under a triangular pulse of 20 ms and 1 m/s2: both equations of motion by the
/// classical Runge-Kutta method with steps of 20 us, until 0.5 s.
std::vector<double> exact_spectrum(double frequency, double damping, const std::vector<double>& equipment, double felt) {
  using State = std::array<double, 4>;  // of floor and equipment: displacement, velocity
  const double floor_omega = 2 * pi * frequency, h = 2e-5;
  std::vector<double> largest_values;
  for (const double each : equipment) {
    const double omega = 2 * pi * each;
    const auto rate = [&](double t, const State& x) {
      const double ground = std::max(0.0, 1 - std::abs(t - 0.01) / 0.01);
      const double floor = -floor_omega * floor_omega * x[0] - 2 * damping * floor_omega * x[1];  // absolute
      return State{x[1], floor - ground, x[3], -floor - omega * omega * x[2] - 2 * felt * omega * x[3]};
    };
    const auto moved = [](const State& x, double by, const State& v) {
      return State{x[0] + by * v[0], x[1] + by * v[1], x[2] + by * v[2], x[3] + by * v[3]};
    };
    State x{};
    double most = 0;
    for (int i = 0; i < 25000; ++i) {
      const double t = i * h;
      const State a = rate(t, x), b = rate(t + h / 2, moved(x, h / 2, a)), c = rate(t + h / 2, moved(x, h / 2, b)),
                  d = rate(t + h, moved(x, h, c));
      for (std::size_t k = 0; k < x.size(); ++k) x[k] += h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
      most = std::max(most, std::abs(x[2]));
    }
    largest_values.push_back(omega * omega * most);
  }
  return largest_values;
}

// Claim: at the suggested step the spectrum of a floor with a mode that is damped by 2 % is within 1 % of the exact one; forty steps a
// period of the highest frequency are not enough, because the peak is narrow. Half the width of the peak is the sum of both dampings.
TEST(FloorSpectrum, SuggestedStepOfANarrowPeak) {
  VERIFIES({"Floor spectra", "Floor spectrum of a lightly damped mode at the suggested step",
            "Equations of motion of two oscillators in series by the classical Runge-Kutta method"});
  const double mode = 22.7, damping = 0.02;
  const std::vector<double> equipment{20, 21, 22, 22.5, 23, 23.5, 24, 24.5, 25};
  std::vector<double> ground(51, 0.0);
  ground[1] = 1;
  const std::vector<double> exact = exact_spectrum(mode, damping, equipment, damping);
  const auto error_at = [&](double step) {
    const Answer answer = run_floors(oscillator(mode, damping, ground, 0.01, step,
                                                fmt::format("damping = [{}]\nfrequencies = [{}]", damping, fmt::join(equipment, ", "))));
    double most = 0;
    for (std::size_t i = 0; i < equipment.size(); ++i) most = std::max(most, std::abs(answer.floors[0].raw[0].values[i] / exact[i] - 1));
    return most;
  };
  const Case read =
      check_case(read_toml_text(oscillator(mode, damping, ground, 0.01, 1e-3,
                                           fmt::format("damping = [{}]\nfrequencies = [{}]", damping, fmt::join(equipment, ", "))),
                                "case.toml"),
                 "case.toml");
  const std::vector<StepBound> bounds = step_bounds(read, build(read, {}), {{{mode, damping}}, {}, {}, {}});
  ASSERT_FALSE(bounds.empty());
  const double suggested = rounded_down(bounds.front().step);
  VERIFY_NEAR("suggested step", "s", suggested, 5e-4, 1e-12);
  VERIFY_LT("largest error of the spectrum at this step", "1", error_at(suggested), 0.01);
  VERIFY_GT("the same with forty steps a period of 25 Hz", "1", error_at(1e-3), 0.012);
}

/// A column on a footing that lifts off, shaken by A sin(w t): as inertia forces in the frame of the ground, or by moving its base.
struct Column {
  double shaking = 6, frequency = 2, step = 5e-4, duration = 1;  // m/s2, Hz, s
  bool absolute = false;
  int every = 1;
  std::string law = "{ type = \"springs\", K_n = 2e8, tangential = \"none\" }", options;

  std::string text() const {
    // With average acceleration a harmonic acceleration has velocities and displacements of this frequency, in the discrete run exactly.
    const double omega = std::tan(pi * frequency * step) * 2 / step;
    std::string text = fmt::format(
        "title = \"column\"\nimpact = \"none\"\n{}{}"
        "[[interface]]\nname = \"soil\"\nlaw = {}\n[interface.footing]\nbody = \"base\"\nwidth = 3\npoints = 40\n"
        "[[load]]\nnode = \"top\"\nforce = [0, -1e6]\n"
        "[[function]]\nname = \"quake\"\nshape = {{ type = \"harmonic\", frequency = {} }}\n[[stage]]\ntype = \"static\"\n"
        "[[stage]]\ntype = \"dynamic\"\nduration = {}\nstep = {}\n",
        options, support::Tower{.mass = "mass = 24317", .held = false}.text(), law, frequency, duration, step);
    if (absolute)
      text += fmt::format(
          "[[motion]]\nnode = \"base\"\ndirection = \"ux\"\namplitude = {}\nfunction = \"quake\"\n"
          "[[initial]]\nnode = \"top\"\nvelocity = [{}, 0]\n",
          -shaking / (omega * omega), -shaking / omega);
    else
      text += fmt::format(
          "[[support]]\nnode = \"base\"\nfixed = [\"ux\"]\n"
          "[[ground_acceleration]]\ndirection = [1, 0]\namplitude = {}\nfunction = \"quake\"\n",
          shaking);
    text += fmt::format("[output]\nevery = {}\n", every);
    for (const char* quantity : {"ax", "abs_ax", "abs_ay"})
      text += fmt::format("[[output.history]]\nnode = \"top\"\nquantity = \"{}\"\n", quantity);
    for (const auto& [name, node, direction] :
         {std::array{"top", "top", "[1, 0]"}, {"slanting", "top", "[3, 4]"}, {"base", "base", "[1, 0]"}})
      text += fmt::format("[[output.floor_spectrum]]\nname = \"{}\"\nnode = \"{}\"\ndirection = {}\n", name, node, direction);
    return text;
  }
};

// Claim: the absolute acceleration of a run in the frame of the ground is that of a run in the absolute frame, bonded and uplifting, to
// 1e-9 of its peak.
TEST(FloorSpectrum, RelativeFrameIsAbsoluteFrame) {
  VERIFIES({"Floor spectra", "Absolute acceleration in the moving frame and in the frame at rest",
            "Equivalence of both frames; the same structure on a base that moves"});
  for (const bool bonded : {true, false}) {
    Column relative, absolute;
    absolute.absolute = true;
    const Answer a = run_floors(relative.text(), bonded, false), b = run_floors(absolute.text(), bonded, false);
    if (!bonded) VERIFY_GT("uplifted share (the case uplifts)", "1", a.result.max_uplifted_ratio.value, 0.2);
    for (const std::size_t floor : {0, 1}) {
      const std::vector<double>&one = a.result.floors[floor].acceleration, &other = b.result.floors[floor].acceleration;
      VERIFY_GT("largest acceleration", "m/s2", largest(one), 4);
      VERIFY_LT("largest difference of the accelerations of both frames", "m/s2", distance(one, other), 1e-9 * largest(one)) << bonded;
    }
    VERIFY_LT("difference of relative and absolute acceleration in the frame at rest", "m/s2",
              distance(b.column("top.ax"), b.column("top.abs_ax")), 1e-15);
  }
}

// Claim: the record is relative + ground along its direction, both as their mean over the step (there is an interface: docs/theory, section
// 3), and what does not move in the frame has the ground's acceleration.
TEST(FloorSpectrum, RelativeAndGround) {
  VERIFIES({"Floor spectra", "Record of a floor: relative acceleration plus ground", "docs/theory, eq (F1)"});
  const Column column;
  const Answer answer = run_floors(column.text(), false, false);
  const std::vector<double>&time = answer.result.table[0], &ax = answer.column("top.ax"), &ay = answer.column("top.abs_ay");
  ASSERT_EQ(answer.result.floors[0].acceleration.size(), time.size());
  for (std::size_t i = 0; i < time.size(); ++i) {
    const auto ground_at = [&](double t) { return column.shaking * std::sin(2 * pi * column.frequency * t); };
    const double ground = 0.5 * (ground_at(time[i > 0 ? i - 1 : 0]) + ground_at(time[i])), sum = ax[i] + ground;
    VERIFY_NEAR("recorded acceleration of the top", "m/s2", answer.result.floors[0].acceleration[i], sum, 1e-12);
    VERIFY_NEAR("output column of the absolute acceleration", "m/s2", answer.column("top.abs_ax")[i], sum, 1e-12);
    VERIFY_NEAR("acceleration along an inclined direction", "m/s2", answer.result.floors[1].acceleration[i], 0.6 * sum + 0.8 * ay[i],
                1e-12);
    VERIFY_NEAR("acceleration of a held node", "m/s2", answer.result.floors[2].acceleration[i], ground, 1e-12);
  }
}

// Claim: the record has all steps, equal ones, whatever output.every is and however often steps are halved.
TEST(FloorSpectrum, EveryStepOfTheRun) {
  VERIFIES({"Floor spectra", "The record contains every step", "docs/theory, floor spectra: equal steps whatever is written and halved"});
  Column all;
  all.law = "{ type = \"sdm\", K_n = 5e9, F_u = 5e4, G_f = 50, F_c = -1e3, tangential = \"none\" }";
  all.options = "method = { type = \"newton\", most_iterations = 4 }";
  all.step = 5e-3;
  all.shaking = 10;
  Column few = all;
  few.every = 7;
  const Answer a = run_floors(all.text()), b = run_floors(few.text());
  ASSERT_GT(a.result.counts.retries, 0);
  ASSERT_EQ(a.result.floors[0].acceleration.size(), 201U);
  VERIFY_EQ("step of the record", "s", a.result.floors[0].step, 5e-3);
  VERIFY_LT("rows of the written table", "1", b.result.table[0].size(), 35U);
  for (std::size_t floor = 0; floor < 3; ++floor) EXPECT_EQ(a.result.floors[floor].acceleration, b.result.floors[floor].acceleration);
  VERIFY_LT("difference of record and output column", "m/s2", distance(a.result.floors[0].acceleration, a.column("top.abs_ax")), 1e-12);
}

}  // namespace
}  // namespace uplift::verification::floor_test
