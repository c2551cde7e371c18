#include "uplift/motion/processing/processing.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "unit/motion/motion_support.h"
#include "uplift/math/fourier.h"
#include "uplift/motion/formats/convert.h"
#include "uplift/motion/intensity.h"
#include "uplift/motion/spectrum.h"

namespace uplift::processing_test {
namespace {

using std::numbers::pi;

Raw raw(decltype(Raw::data) data) {
  return {std::move(data), {"case.toml", 7}, ""};
}

Raw list(const std::vector<double>& values) {
  RawList items;
  for (const double value : values) items.push_back(raw(value));
  return raw(std::move(items));
}

/// The motion after one step, given as in a case file.
Motion after(const Motion& motion, const std::string& type, std::vector<std::pair<std::string, Raw>> entries = {}) {
  entries.insert(entries.begin(), {"type", raw(type)});
  for (auto& [key, value] : entries) value.path = "process[0]." + key;
  Raw table = raw(std::make_shared<RawTable>(RawTable{std::move(entries)}));
  table.path = "process[0]";
  return make_part(process_catalog(), check_part(table, motion_processes()))->apply(motion);
}

/// A target of points, 5 % damping.
Raw target_of(const std::vector<double>& frequencies, const std::vector<double>& accelerations) {
  return raw(std::make_shared<RawTable>(
      RawTable{{{"type", raw(std::string("table"))}, {"frequencies", list(frequencies)}, {"accelerations", list(accelerations)}}}));
}

std::string refusal(const Motion& motion, const std::string& type, std::vector<std::pair<std::string, Raw>> entries = {}) {
  try {
    after(motion, type, std::move(entries));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

Motion random_motion(std::size_t count = 1000, double step = 0.01) {
  Motion motion;
  motion.step = step;
  motion.values = noise(count);
  motion.name = "noise";
  return motion;
}

double final_of(const Motion& motion, MotionKind kind) {
  return converted(motion, kind).values.back();
}

TEST(Processing, EveryStepWritesOneSentenceAndKeepsTheRest) {
  Motion motion = random_motion();
  motion.station = "here";
  motion.processing = {"before"};
  const std::vector<std::pair<std::string, std::vector<std::pair<std::string, Raw>>>> steps{
      {"baseline", {}},
      {"bandpass", {{"low", raw(0.5)}, {"high", raw(20.0)}}},
      {"taper", {}},
      {"trim", {{"to", raw(5.0)}}},
      {"resample", {{"step", raw(0.005)}}},
      {"scale", {{"pga", raw(1.0)}}},
      {"scale_to_spectrum", {{"target", target_of({0.1, 50}, {1, 1})}, {"from", raw(0.1)}, {"to", raw(2.0)}}}};
  ASSERT_EQ(steps.size(), process_catalog().size());  // a new step is to be added here
  for (const auto& [type, entries] : steps) {
    const Motion done = after(motion, type, entries);
    ASSERT_EQ(done.processing.size(), 2U) << type;
    EXPECT_EQ(done.processing[0], "before");
    EXPECT_EQ(done.processing[1].back(), '.') << done.processing[1];
    EXPECT_EQ(done.name, "noise");
    EXPECT_EQ(done.station, "here");
    EXPECT_NE(done.values, motion.values) << type;
    for (const double value : done.values) ASSERT_TRUE(std::isfinite(value)) << type;
  }
}

// ---- baseline ----

TEST(Baseline, TakesAwayAPolynomialOfItsOrder) {
  const Motion motion = motion_of(300, 0.01, [](double t) { return 0.3 - 0.2 * t + 0.5 * t * t - 0.1 * t * t * t; });
  EXPECT_LT(largest(after(motion, "baseline", {{"order", raw(std::int64_t{3})}}).values), 1e-13);
  EXPECT_GT(largest(after(motion, "baseline", {{"order", raw(std::int64_t{2})}}).values), 1e-3);
  // what is left is orthogonal to the lower powers
  const Motion left = after(random_motion(), "baseline", {{"order", raw(std::int64_t{1})}});
  double sum = 0, moment = 0;
  for (std::size_t i = 0; i < left.values.size(); ++i) {
    sum += left.values[i];
    moment += static_cast<double>(i) * left.values[i];
  }
  EXPECT_NEAR(sum, 0, 1e-11);
  EXPECT_NEAR(moment, 0, 1e-8);
}

TEST(Baseline, TheMotionEndsAtRest) {
  const Motion motion = random_motion(1500);
  for (std::int64_t order = 0; order <= 3; ++order) {
    const Motion stopped = after(motion, "baseline", {{"order", raw(order)}, {"end", raw(std::string("velocity"))}});
    EXPECT_NEAR(final_of(stopped, MotionKind::velocity), 0, 1e-13) << order;
    if (order == 0) continue;
    const Motion back = after(motion, "baseline", {{"order", raw(order)}, {"end", raw(std::string("displacement"))}});
    EXPECT_NEAR(final_of(back, MotionKind::velocity), 0, 1e-13) << order;
    EXPECT_NEAR(final_of(back, MotionKind::displacement), 0, 1e-12) << order;
    // of all polynomials of this order that do so, the least change
    EXPECT_LT(largest(back.values), 1.2 * largest(motion.values));
  }
  EXPECT_NE(refusal(motion, "baseline", {{"order", raw(std::int64_t{0})}, {"end", raw(std::string("displacement"))}}), "");
}

// ---- filter ----

TEST(Bandpass, GainAndPhaseOfAHarmonic) {
  const double low = 0.8, high = 8;
  const int order = 3;
  for (const double frequency : {0.4, 0.8, 3.0, 8.0, 16.0}) {
    const Motion motion = motion_of(8001, 0.005, [&](double t) { return std::sin(2 * pi * frequency * t); });
    const Motion filtered = after(motion, "bandpass", {{"low", raw(low)}, {"high", raw(high)}, {"order", raw(std::int64_t{order})}});
    ASSERT_EQ(filtered.values.size(), motion.values.size());
    const double gain = 1 / (1 + std::pow(low / frequency, 2 * order)) / (1 + std::pow(frequency / high, 2 * order));
    for (std::size_t i = 3000; i < 5000; ++i) ASSERT_NEAR(filtered.values[i], gain * motion.values[i], 2e-5) << frequency << " " << i;
  }
}

TEST(Bandpass, AnImpulseStaysWhereItIs) {
  Motion motion;
  motion.step = 0.01;
  motion.values.assign(1001, 0);
  motion.values[500] = 1;
  for (const char* key : {"low", "high"}) {
    const std::vector<double> y = after(motion, "bandpass", {{key, raw(2.0)}}).values;
    for (std::size_t i = 1; i <= 500; ++i) ASSERT_NEAR(y[500 - i], y[500 + i], 1e-14);
  }
}

TEST(Bandpass, WithItsPaddingTheMotionEndsAtRest) {
  const Motion motion = after(random_motion(), "taper");
  const Motion kept = after(motion, "bandpass", {{"low", raw(0.2)}, {"keep_padding", raw(true)}});
  EXPECT_GT(kept.values.size(), motion.values.size());
  EXPECT_LT(std::abs(final_of(kept, MotionKind::velocity)), 1e-3 * largest(converted(kept, MotionKind::velocity).values));
}

/// A pulse at the very beginning: half of what the filter makes of it lies before the record, and the velocity that is left is told.
TEST(Bandpass, WhatIsCutAwayIsTold) {
  Motion motion = random_motion();
  for (std::size_t i = 0; i < motion.values.size(); ++i) motion.values[i] = i < 20 ? 1 : 0;
  const Motion cut = after(motion, "bandpass", {{"low", raw(0.5)}});
  double velocity = 0;
  for (std::size_t i = 0; i + 1 < cut.values.size(); ++i) velocity += cut.step * (cut.values[i] + cut.values[i + 1]) / 2;
  ASSERT_GT(std::abs(velocity), 0.02 * 20 * motion.step);
  EXPECT_NE(cut.processing.back().find(fmt::format("cut away again. Without what was cut away the velocity ends at {:.3g} m/s", velocity)),
            std::string::npos)
      << cut.processing.back();
  const Motion kept = after(motion, "bandpass", {{"low", raw(0.5)}, {"keep_padding", raw(true)}});
  EXPECT_TRUE(kept.processing.back().ends_with("before and after, kept.")) << kept.processing.back();
}

TEST(Bandpass, CornersAreChecked) {
  const Motion motion = random_motion();
  EXPECT_NE(refusal(motion, "bandpass").find("low, high or both"), std::string::npos);
  EXPECT_NE(refusal(motion, "bandpass", {{"high", raw(50.0)}}).find("50 Hz"), std::string::npos);
  EXPECT_NE(refusal(motion, "bandpass", {{"low", raw(1e-9)}}).find("6e-05 Hz at least"), std::string::npos);
  EXPECT_NE(refusal(motion, "bandpass", {{"high", raw(1.0)}, {"low", raw(2.0)}}).find("case.toml:7"), std::string::npos);
}

// ---- taper, trim ----

TEST(Taper, CosineAtBothEnds) {
  const Motion ones = motion_of(101, 0.1, [](double) { return 1.0; });
  const std::vector<double> y = after(ones, "taper", {{"start", raw(2.0)}, {"end", raw(1.0)}}).values;
  EXPECT_EQ(y.front(), 0);
  EXPECT_NEAR(y[5], 0.5 * (1 - std::cos(pi / 4)), 1e-15);
  EXPECT_NEAR(y[10], 0.5, 1e-15);
  EXPECT_EQ(y[20], 1);
  EXPECT_EQ(y[90], 1);
  EXPECT_NEAR(y[95], 0.5, 1e-13);
  EXPECT_NEAR(y.back(), 0, 1e-15);
  EXPECT_NE(refusal(ones, "taper", {{"start", raw(7.0)}, {"end", raw(7.0)}}), "");
}

TEST(Trim, ByTimes) {
  const Motion line = motion_of(101, 0.1, [](double t) { return t; });
  const Motion part = after(line, "trim", {{"from", raw(0.3)}, {"to", raw(1.25)}});
  ASSERT_EQ(part.values.size(), 10U);
  EXPECT_NEAR(part.values.front(), 0.3, 1e-15);
  EXPECT_NEAR(part.values.back(), 1.2, 1e-15);
  EXPECT_NE(refusal(line, "trim", {{"from", raw(10.0)}}), "");
  EXPECT_NE(refusal(line, "trim", {{"to", raw(11.0)}}), "");
}

TEST(Trim, BySharesOfTheAriasIntensity) {
  const Motion motion = random_motion();
  const Motion part = after(motion, "trim", {{"arias", list({0.1, 0.8})}});
  const double kept = husid(part).back() / husid(motion).back();
  EXPECT_GE(kept, 0.7);  // whole steps around the share
  EXPECT_LE(kept, 0.7 + 2 * 0.01 * 0.25 * pi / (2 * 9.80665) / husid(motion).back());
  EXPECT_EQ(after(motion, "trim", {{"arias", list({0, 1})}}).values, motion.values);
  EXPECT_NE(refusal(motion, "trim", {{"arias", list({0.8, 0.1})}}), "");
}

// ---- another step ----

/// Noise without anything above `highest`, smooth to zero at its ends.
Motion smooth_motion(double highest, double step = 0.005) {
  const Motion rough = after(random_motion(2001, step), "taper", {{"share", raw(0.2)}});
  return after(rough, "bandpass", {{"high", raw(highest)}, {"order", raw(std::int64_t{8})}});
}

TEST(Resample, FinerStepsKeepThePoints) {
  const Motion motion = random_motion();
  for (const char* between : {"band_limited", "straight"}) {
    const Motion fine = after(motion, "resample", {{"step", raw(0.0025)}, {"between", raw(std::string(between))}});
    ASSERT_EQ(fine.values.size(), 4 * (motion.values.size() - 1) + 1);
    EXPECT_EQ(fine.step, 0.0025);
    for (std::size_t i = 0; i < motion.values.size(); ++i) ASSERT_NEAR(fine.values[4 * i], motion.values[i], 1e-15) << i;
  }
}

TEST(Resample, AHarmonicIsMetBetweenItsPoints) {
  const auto wave = [](double t) { return std::sin(2 * pi * 17 * t + 0.3); };
  const Motion motion = motion_of(2001, 0.01, wave);  // 34 % of the Nyquist frequency
  for (const double step : {0.002, 0.0037, 0.015}) {
    const Motion other = after(motion, "resample", {{"step", raw(step)}});
    for (std::size_t i = 0; i < other.values.size(); ++i) {
      const double t = step * static_cast<double>(i);
      if (t > 2 && t < 18) {
        ASSERT_NEAR(other.values[i], wave(t), 2e-4) << step << " " << t;
      }
    }
  }
}

TEST(Resample, WhatTheCoarserStepCannotCarryIsGone) {
  const Motion motion = motion_of(4001, 0.005, [](double t) { return std::sin(2 * pi * 70 * t); });
  const Motion coarse = after(motion, "resample", {{"step", raw(0.01)}});  // Nyquist 50 Hz
  for (std::size_t i = 200; i < 1800; ++i) ASSERT_NEAR(coarse.values[i], 0, 1e-4);
}

TEST(Resample, ThereAndBack) {
  const Motion motion = smooth_motion(20);
  const Motion back = after(after(motion, "resample", {{"step", raw(0.002)}}), "resample", {{"step", raw(0.005)}});
  ASSERT_EQ(back.values.size(), motion.values.size());
  for (std::size_t i = 0; i < back.values.size(); ++i) ASSERT_NEAR(back.values[i], motion.values[i], 2e-4 * largest(motion.values));
}

TEST(Resample, SpectraStay) {
  const Motion motion = smooth_motion(6);
  const std::vector<double> frequencies = log_spaced(0.3, 80, 30);
  const auto psa = [&](const Motion& m) {
    return response_spectra(m.values, m.step, frequencies, {0.05}, Spectrum::Kind::psa, 1, Peaks::between)[0].values;
  };
  const std::vector<double> original = psa(motion);
  const std::vector<double> straight = psa(after(motion, "resample", {{"step", raw(0.001)}, {"between", raw(std::string("straight"))}}));
  const std::vector<double> limited = psa(after(motion, "resample", {{"step", raw(0.001)}}));
  for (std::size_t i = 0; i < frequencies.size(); ++i) {
    EXPECT_NEAR(straight[i] / original[i], 1, 1e-4) << frequencies[i];
    // straight pieces take (pi f step)^2/3 of a harmonic: 0.5 % at 8 Hz, where the filter leaves 1 %
    EXPECT_NEAR(limited[i] / original[i], 1, 5e-3) << frequencies[i];
  }
}

TEST(Resample, StepsThatDoNotFit) {
  EXPECT_NE(refusal(random_motion(), "resample", {{"step", raw(20.0)}}).find("no longer than the record"), std::string::npos);
  EXPECT_NE(refusal(random_motion(), "resample", {{"step", raw(1e-12)}}).find("points at most"), std::string::npos);
}

// ---- scale ----

TEST(Scale, ReachesWhatIsAsked) {
  const Motion motion = random_motion();
  EXPECT_NEAR(largest(after(motion, "scale", {{"pga", raw(3.0)}}).values), 3, 1e-12);
  const Motion sa = after(motion, "scale", {{"sa", raw(2.0)}, {"period", raw(0.4)}, {"damping", raw(0.02)}});
  EXPECT_NEAR(response_spectra(sa.values, sa.step, {2.5}, {0.02}, Spectrum::Kind::psa)[0].values[0], 2, 1e-12);
  EXPECT_EQ(after(motion, "scale", {{"factor", raw(-2.0)}}).values[7], -2 * motion.values[7]);
}

TEST(Scale, OneAimOnly) {
  const Motion motion = random_motion();
  EXPECT_NE(refusal(motion, "scale"), "");
  EXPECT_NE(refusal(motion, "scale", {{"pga", raw(3.0)}, {"factor", raw(2.0)}}), "");
  EXPECT_NE(refusal(motion, "scale", {{"sa", raw(3.0)}}), "");
  EXPECT_NE(refusal(motion_of(10, 0.1, [](double) { return 0.0; }), "scale", {{"pga", raw(3.0)}}), "");
  Motion velocity = motion;
  velocity.kind = MotionKind::velocity;
  EXPECT_NE(refusal(velocity, "scale", {{"pga", raw(3.0)}}).find("acceleration"), std::string::npos);
}

TEST(ScaleToSpectrum, FindsTheFactorOfItsOwnSpectrum) {
  // the target is 4 times the motion's own spectrum: nothing else has that mean
  const Motion motion = random_motion();
  const Spectrum own = response_spectra(motion.values, motion.step, log_spaced(0.5, 10, 100), {0.05}, Spectrum::Kind::psa)[0];
  std::vector<double> four = own.values;
  for (double& value : four) value *= 4;
  const Motion scaled =
      after(motion, "scale_to_spectrum", {{"target", target_of(own.frequencies, four)}, {"from", raw(0.1)}, {"to", raw(2.0)}});
  for (std::size_t i = 0; i < motion.values.size(); ++i) ASSERT_NEAR(scaled.values[i], 4 * motion.values[i], 1e-9);
}

// ---- Fourier transform ----

TEST(Fourier, AgainstTheSum) {
  for (const std::size_t n : {2UL, 7UL, 30UL, 64UL}) {
    const std::vector<double> x = noise(n);
    const std::vector<std::complex<double>> half = fourier(x);
    ASSERT_EQ(half.size(), n / 2 + 1) << n;
    for (std::size_t k = 0; k < half.size(); ++k) {
      std::complex<double> sum = 0;
      for (std::size_t i = 0; i < n; ++i) sum += x[i] * std::polar(1.0, -2 * pi * static_cast<double>(i * k) / static_cast<double>(n));
      EXPECT_NEAR(std::abs(half[k] - sum), 0, 1e-13) << n << " " << k;
    }
    const std::vector<double> back = inverse_fourier(half, n);
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(back[i], x[i], 1e-14) << n;
  }
}

TEST(Fourier, QuickLengths) {
  EXPECT_EQ(fourier_length(1), 2U);
  EXPECT_EQ(fourier_length(120), 120U);
  EXPECT_EQ(fourier_length(121), 128U);
  EXPECT_EQ(fourier_length(16001), 16200U);
}

}  // namespace
}  // namespace uplift::processing_test
