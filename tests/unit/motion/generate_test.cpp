#include "uplift/motion/generate.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <new>
#include <numbers>

#include "unit/motion/target_support.h"
#include "uplift/motion/parallel.h"
#include "uplift/motion/spectrum.h"

namespace uplift::generate_test {
namespace {

using std::numbers::pi;

/// Pseudo-acceleration by central differences in steps of 1/200 period, the acceleration straight between its points: another method than
/// the library's, with an error of (pi/200)^2/6 of the period.
double pseudo_acceleration(const std::vector<double>& a, double step, double frequency, double damping) {
  const double w = 2 * pi * frequency, end = step * static_cast<double>(a.size() - 1);
  const double h = std::min(step, 1 / (200 * frequency));
  double before = 0, now = 0, largest = 0;
  for (double t = 0; t < end; t += h) {
    const double at = std::min(t / step, static_cast<double>(a.size() - 1) - 1e-9);
    const auto i = static_cast<std::size_t>(at);
    const double ground = std::lerp(a[i], a[i + 1], at - static_cast<double>(i));
    const double next =
        (-ground - (w * w - 2 / (h * h)) * now - (1 / (h * h) - damping * w / h) * before) / (1 / (h * h) + damping * w / h);
    before = now;
    now = next;
    largest = std::max(largest, std::abs(now));
  }
  return w * w * largest;
}

/// Velocity and displacement at the end, from rest: exact for straight pieces.
std::pair<double, double> end_of(const std::vector<double>& a, double step) {
  double v = 0, d = 0;
  for (std::size_t i = 0; i + 1 < a.size(); ++i) {
    d += v * step + step * step * (a[i] / 3 + a[i + 1] / 6);
    v += step * (a[i] + a[i + 1]) / 2;
  }
  return {v, d};
}

GenerateOptions short_options() {
  GenerateOptions options;
  options.duration = 8;
  options.step = 0.01;
  options.envelope = {Envelope::Shape::jennings, 1, 5};
  options.from = 0.5;
  options.to = 25;
  return options;
}

GeneratedMotion one(const TargetSpectrum& target, const GenerateOptions& options) {
  const TargetSpectrum* const list[] = {&target};
  return generate_motions(list, options).front();
}

std::unique_ptr<const TargetSpectrum> guide(double pga = 2, double damping = 0.05) {
  return target_of("rg_1_60", {{"pga", target_raw(pga)}, {"damping", target_raw(damping)}});
}

/// The bounds of the fit by the test's own oscillators, between the frequencies of the fit, and the end at rest.
void expect_compatible(const GeneratedMotion& made, const TargetSpectrum& target, const GenerateOptions& options) {
  EXPECT_TRUE(made.fit.good());
  double mean = 0;
  constexpr int count = 23;
  for (int i = 0; i < count; ++i) {
    const double f = options.from * std::pow(options.to / options.from, (i + 0.37) / count);
    const double ratio = pseudo_acceleration(made.motion.values, options.step, f, target.damping()) / target.at(f);
    EXPECT_GE(ratio, 0.90) << f << " Hz";
    mean += std::abs(ratio - 1) / count;
  }
  EXPECT_LE(mean, 0.05);
  const auto [velocity, displacement] = end_of(made.motion.values, options.step);
  EXPECT_NEAR(velocity, 0, 1e-5);
  EXPECT_NEAR(displacement, 0, 1e-4);
  EXPECT_EQ(made.motion.values.size(), static_cast<std::size_t>(std::lround(options.duration / options.step)) + 1);
  EXPECT_EQ(made.motion.step, options.step);
}

TEST(GeneratedMotions, HaveTheSpectrumOfTheGuide) {
  const auto target = guide();
  for (const std::uint64_t seed : {1U, 2U}) {
    GenerateOptions options = short_options();
    options.seed = seed;
    expect_compatible(one(*target, options), *target, options);
  }
}

TEST(GeneratedMotions, HaveTheSpectrumOfTheCodeInAnotherStepAndEnvelope) {
  const auto target = target_of("eurocode_8", {{"a_g", target_raw(1.5)}, {"ground", target_raw("D")}});
  GenerateOptions options = short_options();
  options.step = 0.02;
  options.duration = 12;
  options.to = 20;
  options.envelope = {Envelope::Shape::trapezoid, 2, 8};
  expect_compatible(one(*target, options), *target, options);
}

TEST(GeneratedMotions, HaveTheSpectrumOfATableAtLowDamping) {
  const auto target = target_of("table", {{"frequencies", target_raw({1.0, 3.0, 8.0, 20.0})},
                                          {"accelerations", target_raw({1.0, 4.0, 4.0, 1.5})},
                                          {"damping", target_raw(0.02)}});
  GenerateOptions options = short_options();
  options.from = 1;
  options.to = 20;
  options.envelope = {Envelope::Shape::saragoni_hart, 2, 2};
  expect_compatible(one(*target, options), *target, options);
}

// Without a limit below the band the ground drifts by metres. An oscillator of no stiffness moves as the ground: its displacement is
// bounded by that of the target at the lower end of the band.
// Claim: nowhere below 90 % of the target, between the frequencies at which the motion was changed too. With these seeds a fit that looks
// at 100 frequencies a decade leaves dips to 88.8 % and 89.8 %.
TEST(GeneratedMotions, HaveNoDipsBetweenTheFrequenciesOfTheFit) {
  const auto target = guide();
  GenerateOptions options = short_options();
  const std::vector<double> dense = log_spaced(options.from, options.to, 1531);
  for (const std::uint64_t seed : {3, 17}) {
    options.seed = seed;
    const GeneratedMotion made = one(*target, options);
    EXPECT_TRUE(made.fit.good());
    const Spectrum reached = response_spectra(made.motion.values, options.step, dense, {0.05}, Spectrum::Kind::psa).front();
    for (std::size_t i = 0; i < dense.size(); ++i) EXPECT_GE(reached.values[i], 0.9 * target->at(dense[i])) << dense[i] << " Hz";
  }
}

TEST(GeneratedMotions, SayWhatTheyWereMadeFor) {
  GenerateOptions options = short_options();
  options.seed = 12;
  const std::string said = one(*guide(), options).motion.processing.front();
  EXPECT_TRUE(said.starts_with("generated from seed 12, component 1, for Regulatory Guide 1.60, horizontal, pga 2 m/s2; envelope jennings"))
      << said;
}

TEST(GeneratedMotions, DoNotDrift) {
  const auto target = guide();
  const GenerateOptions options = short_options();
  const GeneratedMotion made = one(*target, options);
  double v = 0, d = 0, largest = 0;
  const std::vector<double>& a = made.motion.values;
  for (std::size_t i = 0; i + 1 < a.size(); ++i) {
    d += v * options.step + options.step * options.step * (a[i] / 3 + a[i + 1] / 6);
    v += options.step * (a[i] + a[i + 1]) / 2;
    largest = std::max(largest, std::abs(d));
  }
  EXPECT_LT(largest, 1.5 * target->at(options.from) / std::pow(2 * pi * options.from, 2));
}

TEST(GeneratedMotions, ComeAgainFromTheirSeed) {
  const auto target = guide();
  GenerateOptions options = short_options();
  options.step = 0.02;
  options.to = 15;
  const GeneratedMotion first = one(*target, options), again = one(*target, options);
  EXPECT_EQ(first.motion.values, again.motion.values);
  options.seed = 2;
  EXPECT_LT(std::abs(correlation(first.motion.values, one(*target, options).motion.values)), 0.3);
  for (const double value : first.motion.values) EXPECT_NEAR(value * 1e5, std::round(value * 1e5), 1e-6);
}

TEST(GeneratedMotions, ThreeComponentsAreIndependent) {
  const auto horizontal = guide();
  const auto vertical = target_of("rg_1_60", {{"pga", target_raw(2.0)}, {"direction", target_raw("vertical")}});
  GenerateOptions options = short_options();
  options.step = 0.02;
  options.to = 15;
  const TargetSpectrum* const targets[] = {horizontal.get(), horizontal.get(), vertical.get()};
  const std::vector<GeneratedMotion> made = generate_motions(targets, options);
  ASSERT_EQ(made.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(made[i].fit.good());
    for (std::size_t j = 0; j < i; ++j) EXPECT_LE(std::abs(correlation(made[i].motion.values, made[j].motion.values)), 0.16);
  }
  EXPECT_EQ(made[0].motion.values, one(*horizontal, options).motion.values);
}

TEST(GeneratedMotions, CorrelationOfKnownPairs) {
  std::vector<double> sine, cosine, shifted;
  for (int i = 0; i < 400; ++i) {
    sine.push_back(std::sin(2 * pi * i / 100));
    cosine.push_back(std::cos(2 * pi * i / 100));
    shifted.push_back(7 - 2 * std::sin(2 * pi * i / 100));
  }
  EXPECT_NEAR(correlation(sine, cosine), 0, 1e-12);
  EXPECT_NEAR(correlation(sine, sine), 1, 1e-12);
  EXPECT_NEAR(correlation(sine, shifted), -1, 1e-12);
  EXPECT_EQ(correlation(sine, std::vector<double>(400, 3.0)), 0);
}

TEST(GeneratedMotions, EnvelopesGrowAndFade) {
  const Envelope trapezoid{Envelope::Shape::trapezoid, 2, 6}, jennings{Envelope::Shape::jennings, 2, 6},
      hart{Envelope::Shape::saragoni_hart, 2, 2};
  for (const Envelope& each : {trapezoid, jennings, hart}) {
    EXPECT_EQ(each.at(0, 10), 0);
    EXPECT_NEAR(each.at(2, 10), 1, 1e-12);
    for (double t = 0; t <= 10; t += 0.1) EXPECT_LE(each.at(t, 10), 1 + 1e-12);
  }
  EXPECT_NEAR(trapezoid.at(1, 10), 0.5, 1e-12);
  EXPECT_NEAR(trapezoid.at(8, 10), 0.5, 1e-12);
  EXPECT_NEAR(jennings.at(1, 10), 0.25, 1e-12);
  EXPECT_NEAR(jennings.at(6, 10), 1, 1e-12);
  EXPECT_NEAR(jennings.at(10, 10), 0.05, 1e-12);
  EXPECT_NEAR(hart.at(10, 10), 0.05, 1e-12);
  EXPECT_LT(hart.at(2.1, 10), 1);
}

// No motion at all: every number of its fit in closed form.
TEST(GeneratedMotions, FitOfAMotionThatDoesNotFit) {
  const auto target = target_of("table", {{"frequencies", target_raw({1.0, 10.0})}, {"accelerations", target_raw({2.0, 2.0})}});
  const SpectrumFit none = spectrum_fit(std::vector<double>(100, 0.0), 0.01, *target, 1, 10);
  EXPECT_NEAR(none.mean_error, 1, 1e-12);
  EXPECT_NEAR(none.largest_error, 1, 1e-12);
  EXPECT_EQ(none.least_ratio, 0);
  EXPECT_FALSE(none.good());
}

// ---- options ----

Values checked(std::vector<std::pair<std::string, Raw>> keys) {
  for (auto& [key, value] : keys) value.path = "generate." + key;
  return check(target_raw(std::make_shared<RawTable>(RawTable{std::move(keys)})), generate_section());
}

TEST(GenerateOptions, DefaultsFollowTheTargetAndTheStep) {
  const auto target = guide();
  const GenerateOptions options = generate_options(checked({{"duration", target_raw(16.0)}, {"step", target_raw(0.02)}}), *target);
  EXPECT_EQ(options.from, 0.25);
  EXPECT_NEAR(options.to, 20, 1e-12);
  EXPECT_NEAR(options.envelope.rise, 2.4, 1e-12);
  EXPECT_NEAR(options.envelope.fall, 9.6, 1e-12);
  EXPECT_EQ(options.seed, 1U);
}

TEST(GenerateOptions, ContradictionsAreRefused) {
  const auto target = guide();
  const auto refused = [&](std::vector<std::pair<std::string, Raw>> keys) {
    EXPECT_THROW(generate_options(checked(std::move(keys)), *target), InputError);
  };
  refused({{"rise", target_raw(25.0)}});
  refused({{"fall", target_raw(20.0)}});
  refused({{"rise", target_raw(8.0)}, {"fall", target_raw(7.0)}});
  refused({{"from", target_raw(0.01)}});
  refused({{"to", target_raw(200.0)}});
  refused({{"from", target_raw(10.0)}, {"to", target_raw(12.0)}});
  refused({{"envelope", target_raw("saragoni_hart")}, {"fall", target_raw(7.0)}});
  refused({{"duration", target_raw(1000.0)}, {"step", target_raw(1e-4)}});
}

TEST(InParallel, AnExceptionOfAnyThreadIsThrownWhereTheWorkWasAsked) {
  for (const int threads : {1, 2, 4})
    EXPECT_THROW(in_parallel(8, threads,
                             [](int i) {
                               if (i % 2 == 1) throw std::bad_alloc();
                             }),
                 std::bad_alloc);
  std::atomic<int> sum = 0;
  in_parallel(8, 4, [&](int i) { sum += i; });
  EXPECT_EQ(sum, 28);
}

}  // namespace
}  // namespace uplift::generate_test
