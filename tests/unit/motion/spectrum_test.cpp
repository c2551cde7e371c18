#include "uplift/motion/spectrum.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "unit/motion/motion_support.h"
#include "uplift/motion/formats/convert.h"
#include "uplift/motion/oscillator.h"

namespace uplift::spectrum_test {
namespace {

using std::numbers::pi;
using Kind = Spectrum::Kind;

double one(const std::vector<double>& a, double step, double frequency, double damping, Kind kind, Peaks peaks = Peaks::at_points) {
  return response_spectra(a, step, {frequency}, {damping}, kind, 1, peaks)[0].values[0];
}

/// Straight between the points, `parts` sub-steps.
std::vector<double> refined(const std::vector<double>& a, int parts) {
  std::vector<double> fine{a[0]};
  for (std::size_t i = 1; i < a.size(); ++i)
    for (int k = 1; k <= parts; ++k) fine.push_back(a[i - 1] + (a[i] - a[i - 1]) * k / parts);
  return fine;
}

// ---- one oscillator ----

TEST(Oscillator, TheStepIsExactForAnyLength) {
  // Free vibration and the response to a ramp in closed form (any textbook), relative to the size of the state.
  const double frequency = 1.7, omega = 2 * pi * frequency, zeta = 0.07, omega_d = omega * std::sqrt(1 - zeta * zeta);
  for (const double h : {1e-5, 1e-3, 0.02, 0.3, 5.0}) {
    const OscillatorStep s = oscillator_step(frequency, zeta, h);
    const double decay = std::exp(-zeta * omega * h), c = std::cos(omega_d * h), d = std::sin(omega_d * h) * omega / omega_d;
    EXPECT_NEAR(s.pp, decay * (c + zeta * d), 2e-14) << h;
    EXPECT_NEAR(s.pq, decay * d, 2e-14) << h;
    EXPECT_NEAR(s.qp, -decay * d, 2e-14) << h;
    EXPECT_NEAR(s.qq, decay * (c - zeta * d), 2e-14) << h;
    // constant acceleration 1: p = -(1 - free vibration from p = 1)
    EXPECT_NEAR(s.p0 + s.p1, decay * (c + zeta * d) - 1, 2e-14) << h;
    EXPECT_NEAR(s.q0 + s.q1, -decay * d, 2e-14) << h;
    // ramp a = t/h: p = -(t - 2 zeta/omega)/h + free vibration with p(0) = -2 zeta/(omega h), q(0) = 1/(omega h)
    const double p0 = -2 * zeta / (omega * h), q0 = 1 / (omega * h), round_off = 1e-15 * (2 + 2 / (omega * h));
    EXPECT_NEAR(s.p1, -1 - p0 + s.pp * p0 + s.pq * q0, 20 * round_off) << h;
    EXPECT_NEAR(s.q1, -q0 + s.qp * p0 + s.qq * q0, 20 * round_off) << h;
  }
}

TEST(Oscillator, ShortStepsLoseNoDigits) {
  // p1 = -(w h)^2/6 + ... : the closed form has no digit left here
  const double tau = 1e-6;
  const OscillatorStep s = oscillator_step(1, 0.05, tau / (2 * pi));
  EXPECT_NEAR(s.p1 / (-tau * tau / 6), 1, 1e-6);
  EXPECT_NEAR(s.p0 / (-tau * tau / 3), 1, 1e-6);
}

/// Amplitude at frequency f of a steady history that ends with a whole cycle of `cycle` points.
double amplitude(const std::vector<double>& y, std::size_t cycle) {
  double sine = 0, cosine = 0;
  for (std::size_t i = 0; i < cycle; ++i) {
    const double angle = 2 * pi * static_cast<double>(i) / static_cast<double>(cycle);
    sine += y[y.size() - cycle + i] * std::sin(angle);
    cosine += y[y.size() - cycle + i] * std::cos(angle);
  }
  return 2 / static_cast<double>(cycle) * std::hypot(sine, cosine);
}

TEST(Oscillator, HarmonicFloorOfVerification7) {
  // Base 8 Hz, primary 10 Hz/5 % (absolute acceleration), secondary 12 Hz/2 % (pseudo-acceleration): steady state.
  // straight pieces take (pi f h)^2/3 of the amplitude, twice: 3e-7 in all
  const double h = 1 / 40000.0;
  const std::size_t cycle = 5000, count = 100 * cycle;
  const OscillatorStep primary = oscillator_step(10, 0.05, h), secondary = oscillator_step(12, 0.02, h);
  double p = 0, q = 0, r = 0, s = 0, base = 0, floor = 0;
  std::vector<double> floors, seconds;
  for (std::size_t i = 1; i < count; ++i) {
    const double next_base = std::sin(2 * pi * 8 * h * static_cast<double>(i));
    const double next_p = primary.pp * p + primary.pq * q + primary.p0 * base + primary.p1 * next_base;
    q = primary.qp * p + primary.qq * q + primary.q0 * base + primary.q1 * next_base;
    p = next_p;
    base = next_base;
    const double next_floor = -(p + 2 * 0.05 * q);
    const double next_r = secondary.pp * r + secondary.pq * s + secondary.p0 * floor + secondary.p1 * next_floor;
    s = secondary.qp * r + secondary.qq * s + secondary.q0 * floor + secondary.q1 * next_floor;
    r = next_r;
    floor = next_floor;
    floors.push_back(floor);
    seconds.push_back(r);
  }
  EXPECT_NEAR(amplitude(floors, cycle) / 2.72029410, 1, 1e-6);
  EXPECT_NEAR(amplitude(seconds, cycle) / 4.89089831, 1, 1e-6);
}

// ---- spectra ----

TEST(ResponseSpectrum, ElCentroOfTheReference) {
  const std::vector<double> record = el_centro();
  ASSERT_GE(record.size(), 1559U);
  EXPECT_NEAR(largest(record), 0.31882, 1e-12);
  const auto rows = rows_of(support::data_file("reference/elcentro_spectrum.csv"));
  ASSERT_EQ(rows.size(), 61U);
  std::vector<double> frequencies;
  for (const auto& row : rows) frequencies.push_back(1 / row[0]);
  const auto psa = response_spectra(record, 0.02, frequencies, {0.02, 0.05}, Kind::psa);
  const auto sa = response_spectra(record, 0.02, frequencies, {0.02, 0.05}, Kind::sa);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_NEAR(psa[0].values[i] / rows[i][1], 1, 1e-6) << rows[i][0];
    EXPECT_NEAR(sa[0].values[i] / rows[i][2], 1, 1e-6) << rows[i][0];
    EXPECT_NEAR(psa[1].values[i] / rows[i][3], 1, 1e-6) << rows[i][0];
    EXPECT_NEAR(sa[1].values[i] / rows[i][4], 1, 1e-6) << rows[i][0];
  }
}

TEST(ResponseSpectrum, ElCentroDisplacementsOfChopra) {
  std::vector<double> record = el_centro();
  const double g_in_inches = 386.0886;
  for (double& a : record) a *= g_in_inches;
  const auto sd = response_spectra(record, 0.02, {2, 1, 0.5}, {0.02, 0.05}, Kind::sd);
  EXPECT_NEAR(sd[0].values[0], 2.674, 0.006);  // Chopra's own integration; printed to three digits
  EXPECT_NEAR(sd[0].values[1], 5.966, 0.006);
  EXPECT_NEAR(sd[0].values[2], 7.465, 0.006);
  EXPECT_NEAR(sd[1].values[2], 5.371, 0.006);
}

TEST(ResponseSpectrum, ConstantAccelerationInClosedForm) {
  const std::vector<double> constant(400, 2.0);  // suddenly applied, 4 s
  for (const double frequency : {0.7, 3.0, 11.0, 60.0}) {
    const double omega = 2 * pi * frequency;
    for (const double zeta : {0.0, 0.02, 0.3, 0.9}) {
      const double overshoot = 1 + std::exp(-pi * zeta / std::sqrt(1 - zeta * zeta));
      EXPECT_NEAR(one(constant, 0.01, frequency, zeta, Kind::psa, Peaks::between) / (2 * overshoot), 1, 4e-5) << frequency << " " << zeta;
      EXPECT_NEAR(one(constant, 0.01, frequency, zeta, Kind::sd, Peaks::between) * omega * omega / (2 * overshoot), 1, 4e-5);
      // velocity: largest at tan(w_d t) = w_d/(zeta w), there v = exp(-zeta phi/sqrt(1 - zeta^2)) a/w with cos phi = zeta
      const double velocity = std::exp(-zeta * std::acos(zeta) / std::sqrt(1 - zeta * zeta)) * 2 / omega;
      EXPECT_NEAR(one(constant, 0.01, frequency, zeta, Kind::sv, Peaks::between) / velocity, 1, 2e-4) << frequency << " " << zeta;
      const double at_points = one(constant, 0.01, frequency, zeta, Kind::psa);
      EXPECT_LE(at_points, 2 * overshoot * (1 + 1e-12));
      EXPECT_GE(at_points, 2 * (overshoot - 2 * (1 - std::cos(pi / 20)))) << frequency << " " << zeta;
    }
    EXPECT_NEAR(one(constant, 0.01, frequency, 0, Kind::sa, Peaks::between) / 4, 1, 4e-5);
  }
}

TEST(ResponseSpectrum, AbsoluteAccelerationIsThatOfTheEquationOfMotion) {
  // x'' + a = -(w2 x + 2 zeta w v): with damping, sa of a suddenly applied acceleration is at t = 0+ at rest 0, later within psa's size.
  const std::vector<double> a = noise(300);
  for (const double zeta : {0.0, 0.05, 0.4}) {
    const OscillatorStep s = oscillator_step(4, zeta, 0.005);
    double p = 0, q = 0, most = 0;
    for (std::size_t i = 1; i < a.size(); ++i) {
      const double next = s.pp * p + s.pq * q + s.p0 * a[i - 1] + s.p1 * a[i];
      q = s.qp * p + s.qq * q + s.q0 * a[i - 1] + s.q1 * a[i];
      p = next;
      most = std::max(most, std::abs(p + 2 * zeta * q));
    }
    EXPECT_NEAR(one(a, 0.005, 4, zeta, Kind::sa), most, 1e-13);
  }
}

TEST(ResponseSpectrum, TheSameForAnyNumberOfThreadsOrderAndCompany) {
  const std::vector<double> a = noise(700), frequencies = log_spaced(0.1, 90, 61);
  const auto reference = response_spectra(a, 0.005, frequencies, {0, 0.02, 0.05}, Kind::psa, 1);
  for (const int threads : {0, 2, 5}) {
    const auto again = response_spectra(a, 0.005, frequencies, {0, 0.02, 0.05}, Kind::psa, threads);
    for (std::size_t d = 0; d < 3; ++d) EXPECT_EQ(again[d].values, reference[d].values) << threads;
  }
  for (const std::size_t i : {0UL, 30UL, 60UL}) EXPECT_EQ(one(a, 0.005, frequencies[i], 0.05, Kind::psa), reference[2].values[i]);
}

TEST(ResponseSpectrum, StiffOscillatorsFollowTheGroundSoftOnesStay) {
  const std::vector<double> a = noise(500);
  for (const Kind kind : {Kind::psa, Kind::sa}) {
    EXPECT_NEAR(one(a, 0.01, 2e4, 0.05, kind) / largest(a), 1, 2e-3);
    EXPECT_NEAR(one(a, 0.01, 2e6, 0.05, kind) / largest(a), 1, 2e-5);
  }
  // relative displacement and velocity become those of the ground
  const Integrals ground = integrals_of(a, 0.01);
  EXPECT_NEAR(one(a, 0.01, 1e-4, 0, Kind::sd) / largest(ground.displacement), 1, 1e-4);
  EXPECT_NEAR(one(a, 0.01, 1e-4, 0, Kind::sv) / largest(ground.velocity), 1, 1e-4);
}

TEST(ResponseSpectrum, PeaksBetweenThePointsDoNotDependOnTheStep) {
  const std::vector<double> coarse = noise(200), fine = refined(coarse, 7);
  const std::vector<double> frequencies = log_spaced(0.3, 150, 40);
  for (const Kind kind : {Kind::psa, Kind::sa, Kind::sv}) {
    const auto a = response_spectra(coarse, 0.02, frequencies, {0, 0.05}, kind, 1, Peaks::between);
    const auto b = response_spectra(fine, 0.02 / 7, frequencies, {0, 0.05}, kind, 1, Peaks::between);
    const auto points = response_spectra(coarse, 0.02, frequencies, {0, 0.05}, kind, 1);
    for (std::size_t d = 0; d < 2; ++d)
      for (std::size_t i = 0; i < frequencies.size(); ++i) {
        // white noise turns a slow oscillator's velocity twice within some steps: that cubic is not looked at
        EXPECT_NEAR(a[d].values[i] / b[d].values[i], 1, frequencies[i] > 1 ? 6e-5 : 5e-4) << frequencies[i];
        EXPECT_LE(points[d].values[i], a[d].values[i]);
        if (kind == Kind::psa && frequencies[i] > 2.5) {
          EXPECT_GE(points[d].values[i], std::cos(pi / 20) * a[d].values[i] * (1 - 6e-5)) << frequencies[i];
        }
      }
  }
}

TEST(ResponseSpectrum, ScalesWithTheMotionAndWithTime) {
  const std::vector<double> a = noise(300);
  std::vector<double> twice = a;
  for (double& value : twice) value *= -2;
  EXPECT_EQ(one(twice, 0.01, 3, 0.05, Kind::psa), 2 * one(a, 0.01, 3, 0.05, Kind::psa));
  EXPECT_NEAR(one(a, 0.02, 1.5, 0.05, Kind::psa), one(a, 0.01, 3, 0.05, Kind::psa), 1e-12);
}

TEST(ResponseSpectrum, ShortMotions) {
  EXPECT_EQ(one({}, 0.01, 3, 0.05, Kind::psa), 0);
  EXPECT_EQ(one({4}, 0.01, 3, 0.05, Kind::psa), 0);
  EXPECT_EQ(one({0, 0, 0}, 0.01, 3, 0.05, Kind::sa), 0);
  EXPECT_TRUE(response_spectra(std::vector<double>{1, 2}, 0.01, {}, {0.05}, Kind::psa)[0].values.empty());
}

// ---- two components ----

TEST(RotatedSpectra, MotionAlongOneLine) {
  const std::vector<double> a = noise(400);
  std::vector<double> x = a, y = a;
  for (double& value : x) value *= std::cos(pi / 6);
  for (double& value : y) value *= std::sin(pi / 6);
  const std::vector<double> frequencies{0.4, 2, 9, 40};
  for (const Kind kind : {Kind::psa, Kind::sa, Kind::sv, Kind::sd}) {
    const RotatedSpectra rotated = rotated_spectra(x, y, 0.01, frequencies, 0.05, kind);
    const Spectrum along = response_spectra(a, 0.01, frequencies, {0.05}, kind)[0];
    for (std::size_t i = 0; i < frequencies.size(); ++i) {
      EXPECT_NEAR(rotated.largest.values[i] / along.values[i], 1, 1e-12);
      EXPECT_NEAR(rotated.median.values[i] / along.values[i], std::sqrt(0.5), 1e-12);  // median of |cos|
      EXPECT_NEAR(rotated.largest_direction[i], pi / 6, 1e-12);
    }
  }
}

TEST(RotatedSpectra, DirectionsMatterToNeither) {
  const std::vector<double> x = noise(400, 1), y = noise(400, 2);
  std::vector<double> u(400), v(400);
  const double angle = 50 * pi / 180;
  for (std::size_t i = 0; i < 400; ++i) {
    u[i] = std::cos(angle) * x[i] + std::sin(angle) * y[i];
    v[i] = -std::sin(angle) * x[i] + std::cos(angle) * y[i];
  }
  const std::vector<double> frequencies{0.4, 2, 9, 40};
  const RotatedSpectra a = rotated_spectra(x, y, 0.01, frequencies, 0.05, Kind::psa, 1);
  const RotatedSpectra b = rotated_spectra(u, v, 0.01, frequencies, 0.05, Kind::psa, 2);
  const Spectrum first = response_spectra(x, 0.01, frequencies, {0.05}, Kind::psa)[0];
  const Spectrum second = response_spectra(y, 0.01, frequencies, {0.05}, Kind::psa)[0];
  for (std::size_t i = 0; i < frequencies.size(); ++i) {
    EXPECT_NEAR(a.largest.values[i] / b.largest.values[i], 1, 1e-12);
    EXPECT_NEAR(a.median.values[i] / b.median.values[i], 1, 1e-12);
    EXPECT_GE(a.largest.values[i], (1 - 1e-12) * std::max(first.values[i], second.values[i]));
    EXPECT_LE(a.largest.values[i], (1 + 1e-12) * std::hypot(first.values[i], second.values[i]));
    EXPECT_LT(a.median.values[i], a.largest.values[i]);
  }
}

// ---- curves ----

TEST(SpectrumCurve, FrequenciesOfRegulatoryGuide1122) {
  const std::vector<double> f = rg_1_122_frequencies();
  ASSERT_EQ(f.size(), 75U);
  EXPECT_EQ(f.front(), 0.2);
  EXPECT_EQ(f.back(), 34);
  EXPECT_TRUE(std::ranges::is_sorted(f));
  for (const double end : {3.0, 3.6, 5.0, 8.0, 15.0, 18.0, 22.0}) EXPECT_TRUE(std::ranges::count(f, end) == 1) << end;
}

TEST(SpectrumCurve, LogSpaced) {
  const std::vector<double> f = log_spaced(0.5, 32, 7);
  for (std::size_t i = 0; i < 7; ++i) EXPECT_NEAR(f[i], std::ldexp(0.5, static_cast<int>(i)), 1e-13 * f[i]);
  EXPECT_EQ(f.back(), 32);
}

TEST(SpectrumCurve, StraightInLogarithms) {
  const Spectrum s{Kind::psa, 0.05, {1, 2, 8}, {3, 12, 0}};  // slope 2
  EXPECT_NEAR(value_at(s, 1.5), 3 * 2.25, 1e-13);
  EXPECT_EQ(value_at(s, 0.2), 3);
  EXPECT_EQ(value_at(s, 2), 12);
  EXPECT_EQ(value_at(s, 80), 0);
  EXPECT_NEAR(value_at(s, 4), 6, 1e-13);  // towards zero: straight in the value
}

TEST(SpectrumCurve, Envelope) {
  const Spectrum a{Kind::psa, 0.05, {1, 2, 3}, {1, 5, 2}}, b{Kind::psa, 0.05, {1, 2, 3}, {2, 4, 2}};
  const std::vector<Spectrum> both{a, b};
  EXPECT_EQ(envelope(both).values, (std::vector<double>{2, 5, 2}));
}

/// The largest raw value in the window of f, by trying.
double by_trying(const Spectrum& raw, double f, double share) {
  double most = 0;
  const double from = f / (1 + share), to = f / (1 - share);
  for (int k = 0; k <= 2000; ++k) most = std::max(most, value_at(raw, from * std::pow(to / from, k / 2000.0)));
  return most;
}

TEST(Broadening, OnePeakBecomesAFlatTopWithParallelSides) {
  const Spectrum raw{Kind::psa, 0.05, {1, 4, 20}, {1, 16, 0.64}};  // slopes +2 and -2 in logarithms
  const Spectrum wide = broadened(raw, 0.15);
  for (const double f : {3.4, 3.7, 4.0, 4.3, 4.6}) EXPECT_NEAR(value_at(wide, f), 16, 1e-12) << f;
  for (const double f : {1.2, 2.0, 3.0, 3.39}) EXPECT_NEAR(value_at(wide, f), std::pow(f / 0.85, 2), 1e-11) << f;
  for (const double f : {4.61, 7.0, 15.0, 19.9}) EXPECT_NEAR(value_at(wide, f), 16 * std::pow(4 * 1.15 / f, 2), 1e-11) << f;
  EXPECT_EQ(std::ranges::count(wide.frequencies, 4 * 0.85), 1);
  EXPECT_EQ(std::ranges::count(wide.frequencies, 4 * 1.15), 1);
  EXPECT_LE(wide.frequencies.size(), 5U);
}

TEST(Broadening, IsTheLargestValueOfItsWindow) {
  Spectrum raw{Kind::psa, 0.02, log_spaced(0.2, 34, 40), {}};
  const std::vector<double> values = noise(40);
  for (const double value : values) raw.values.push_back(1 + value);
  for (const double share : {0.0, 0.05, 0.15, 0.4}) {
    const Spectrum wide = broadened(raw, share);
    EXPECT_TRUE(std::ranges::is_sorted(wide.frequencies));
    for (const double f : log_spaced(0.2, 34, 60)) {
      EXPECT_GE(value_at(wide, f), value_at(raw, f) * (1 - 1e-12));
      EXPECT_NEAR(value_at(wide, f) / by_trying(raw, f, share), 1, share == 0 ? 1e-12 : 2e-3) << f << " " << share;
    }
  }
}

TEST(Broadening, OfZeros) {
  const Spectrum raw{Kind::psa, 0.05, {1, 4, 20}, {0, 0, 0}};
  for (const double value : broadened(raw, 0.15).values) EXPECT_EQ(value, 0);
}

TEST(FloorSpectrum, ElCentroOnAnOscillatorOf5Hz) {
  const int parts = 8;  // of a step of the record: the floor's motion between its points
  const double step = 0.02 / parts;
  const std::vector<double> record = refined(el_centro(), parts);
  const OscillatorStep s = oscillator_step(5, 0.05, step);
  std::vector<double> floor{0};
  double p = 0, q = 0;
  for (std::size_t i = 1; i < record.size(); ++i) {
    const double next = s.pp * p + s.pq * q + s.p0 * record[i - 1] + s.p1 * record[i];
    q = s.qp * p + s.qq * q + s.q0 * record[i - 1] + s.q1 * record[i];
    p = next;
    floor.push_back(-(p + 2 * 0.05 * q));
  }
  EXPECT_NEAR(largest(floor), 0.823915, 1e-6);

  const auto rows = rows_of(support::data_file("reference/floor_spectrum_elcentro_5Hz.csv"));
  std::vector<double> frequencies;
  for (const auto& row : rows) frequencies.push_back(row[0]);
  const Spectrum raw = response_spectra(floor, step, frequencies, {0.02}, Kind::psa)[0];
  const Spectrum wide = broadened(raw, 0.15);
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_NEAR(raw.values[i] / rows[i][1], 1, 1e-6) << frequencies[i];
  const auto top = std::ranges::max_element(raw.values);
  EXPECT_NEAR(*top, 7.892547, 1e-6);
  EXPECT_NEAR(frequencies[static_cast<std::size_t>(top - raw.values.begin())], 5.09, 0.005);
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (frequencies[i] > 0.86 * 5.0907 && frequencies[i] < 1.14 * 5.0907) EXPECT_EQ(value_at(wide, frequencies[i]), *top) << frequencies[i];
  // The file's raw curve is straight in f and not in log f, up to 3 % apart: 20 points between leave 1/400 of that. Its broadening takes
  // the largest of 201 places in the window only, and is short of a peak by what lies between two of them.
  Spectrum dense{raw.kind, raw.damping, refined(frequencies, 20), refined(raw.values, 20)};
  const Spectrum denser = broadened(dense, 0.15);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_GE(value_at(denser, frequencies[i]) / rows[i][2], 1 - 1e-4) << frequencies[i];
    EXPECT_LE(value_at(denser, frequencies[i]) / rows[i][2], 1 + 3e-3) << frequencies[i];
  }
}

}  // namespace
}  // namespace uplift::spectrum_test
