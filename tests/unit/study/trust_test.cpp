#include "uplift/study/trust.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "tower_case.h"
#include "uplift/io/text/toml.h"

namespace uplift::trust_test {
namespace {

/// A mass on a column that a push makes rock on tensionless springs.
const std::string rocking = "title = \"tower\"\n" + support::Tower{}.text() + support::weight + R"([[interface]]
name = "soil"
law = { type = "springs", K_n = "200 MPa/m", tangential = "none" }
[interface.footing]
body = "base"
width = 3
points = 21
[[function]]
name = "pulse"
shape = { type = "half_sine", duration = 0.2 }
[[load]]
name = "push"
node = "top"
force = [1e5, 0]
function = "pulse"
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 0.6
step = 1e-3
[output]
frames = 0
[[output.floor_spectrum]]
name = "top"
node = "top"
direction = [1, 0]
damping = [0.05]
)";

struct Answered {
  Raw raw;
  Case read;
  TrustAnswer answer;
};

Answered answered(const std::string& text, int threads) {
  Answered made;
  made.raw = read_toml_text(text, "case.toml");
  made.read = check_case(made.raw, "case.toml");
  const std::vector<RunSpec> specs = runs_of_case(made.read);
  const BuiltCase built = build(made.read, specs[0]), bonded = build(made.read, specs[1]);
  const RunResult one = run(built.model, built.plan, built.behaviours), other = run(bonded.model, bonded.plan, bonded.behaviours);
  const TrustSamples samples = trust_samples(made.raw, made.read, {});
  made.answer = trust_answer(made.read, samples, compute_samples(samples, threads), {built, one, &other});
  return made;
}

const TrustBand& band(const TrustAnswer& answer, std::string_view name) {
  return *std::ranges::find(answer.bands, name, [](const TrustBand& each) { return each.quantity->name; });
}

std::size_t place(const TrustAnswer& answer, std::string_view name) {
  return static_cast<std::size_t>(std::ranges::find(answer.runs, name, &TrustRun::name) - answer.runs.begin());
}

TEST(Trust, BandsHoldEveryRun) {
  const TrustAnswer answer = answered(rocking, 1).answer;
  ASSERT_TRUE(answer.complete);
  ASSERT_EQ(answer.runs.size(), 6u);
  for (const TrustRun& run : answer.runs) EXPECT_TRUE(run.counts()) << run.label << ": " << run.reason;
  ASSERT_GT(answer.bands.size(), 15u);
  for (const TrustBand& each : answer.bands) {
    EXPECT_LE(each.least, each.value);
    EXPECT_GE(each.most, each.value);
    ASSERT_EQ(each.values.size(), answer.runs.size());
    double farthest = 0;
    std::string choice;
    for (std::size_t i = 0; i < each.values.size(); ++i) {
      if (!each.values[i]) continue;
      EXPECT_LE(each.least, *each.values[i]);
      EXPECT_GE(each.most, *each.values[i]);
      if (std::abs(*each.values[i] - each.value) > farthest) {
        farthest = std::abs(*each.values[i] - each.value);
        choice = answer.runs[i].choice;
      }
    }
    if (!each.dominant.empty()) {
      EXPECT_EQ(each.dominant, choice) << each.quantity->name;
    }
  }
}

/// The step of 1 ms is fine beside the periods, the SDM without strength is the same law as the springs, and the tolerance is far below
/// either: what matters is the stiffness, by the statics of a Winkler strip.
TEST(Trust, TellsWhatMatters) {
  const TrustAnswer answer = answered(rocking + "[trust]\nstiffness_factor = 10\n", 1).answer;
  const TrustBand& moment = band(answer, "max_moment");
  const auto moved = [&](const char* name) { return std::abs(*moment.values[place(answer, name)] - moment.value) / moment.value; };
  EXPECT_LT(moved("step_half"), 2e-3);
  EXPECT_LT(moved("other_law"), 2e-3);
  EXPECT_LT(moved("tighter"), 1e-9);
  EXPECT_GT(moved("softer"), 0.05);
  EXPECT_EQ(moment.dominant, "joint stiffness");
  EXPECT_EQ(answer.dominant, "joint stiffness");
  ASSERT_EQ(answer.spectra.size(), 1u);
  EXPECT_EQ(answer.spectra.front().limited_by, "joint stiffness");
  EXPECT_LT(answer.spectra.front().speaks_to, 34);

  // without the stiffness among the choices the spectrum speaks further, and what is left is small
  const TrustAnswer fixed = answered(rocking + "[trust]\nstiffness_factor = 1\n", 1).answer;
  EXPECT_EQ(fixed.runs.size(), 4u);
  EXPECT_GT(fixed.spectra.front().speaks_to, answer.spectra.front().speaks_to);
  // the trapezoidal rule on n strips makes the rocking stiffness 2/n2 too large: 0.5 % with twenty strips, 0.125 % with forty; 0.2 % are
  // the step's, as above
  EXPECT_LT(*band(fixed, "max_moment").share(), (0.00375 + 2e-3) / 2);
  // what is a share, a change or a residual has its band from ... to, and no half of it over the value
  for (const char* name : {"max_uplifted_ratio", "change_of_moment", "residual_rotation", "first_uplift"})
    EXPECT_FALSE(band(answer, name).share().has_value()) << name;
}

/// A spectrum speaks as far as the shortest reach; what the step can carry, ten steps a period, is among them.
TEST(Trust, ASpectrumSpeaksAsFarAsItsShortestReach) {
  const TrustSpectrum spectrum = answered(rocking, 1).answer.spectra.front();
  ASSERT_EQ(spectrum.reaches.size(), 6u);  // step, stiffness, points, tolerance, method; and what the step carries
  EXPECT_EQ(spectrum.reaches.front().to, spectrum.speaks_to);
  EXPECT_EQ(spectrum.reaches.front().choice, spectrum.limited_by);
  EXPECT_TRUE(std::ranges::is_sorted(spectrum.reaches, {}, &TrustSpectrum::Reach::to));
  for (std::size_t i = 0; i < spectrum.frequencies.size() && spectrum.frequencies[i] <= spectrum.speaks_to; ++i) {
    EXPECT_LE(spectrum.most[i], 1.1 * spectrum.value[i]);
    EXPECT_GE(spectrum.least[i], 0.9 * spectrum.value[i]);
  }
  std::string coarse = rocking;
  coarse.replace(coarse.find("step = 1e-3"), 11, "step = 1e-2");
  const TrustSpectrum bounded = answered(coarse + "[trust]\nstiffness_factor = 1\nspectrum_band = 10\n", 1).answer.spectra.front();
  EXPECT_EQ(bounded.limited_by, "length of the step");
  EXPECT_NEAR(bounded.speaks_to, 10, 1e-12);  // 1/(10 x 10 ms)
}

TEST(Trust, DoesNotDependOnThreads) {
  const TrustAnswer one = answered(rocking, 1).answer, three = answered(rocking, 3).answer;
  ASSERT_EQ(one.bands.size(), three.bands.size());
  for (std::size_t i = 0; i < one.bands.size(); ++i) EXPECT_EQ(one.bands[i].values, three.bands[i].values);
  EXPECT_EQ(one.spectra.front().least, three.spectra.front().least);
}

/// Between the case (200 MPa/m) and its ends, half and twice as much, the ratios are equal; every value is that of the case with this
/// stiffness.
TEST(Trust, ComputesTheInterior) {
  const TrustAnswer answer = answered(rocking + "[trust]\ninterior = 2\n", 2).answer;
  EXPECT_EQ(answer.interior, 2);
  EXPECT_EQ(std::ranges::count(answer.runs, joint_stiffness, &TrustRun::choice), 6);
  const TrustBand& moment = band(answer, "max_moment");
  for (const auto& [name, stiffness] : {std::pair{"stiffer", 400.0},
                                        {"stiffer_2", 200 * std::cbrt(4)},
                                        {"stiffer_1", 200 * std::cbrt(2)},
                                        {"softer_1", 200 / std::cbrt(2)},
                                        {"softer_2", 200 / std::cbrt(4)},
                                        {"softer", 100.0}}) {
    std::string own = rocking;
    own.replace(own.find("200 MPa/m"), 9, fmt::format("{:.17g} MPa/m", stiffness));
    const Case read = check_case(read_toml_text(own, "case.toml"), "case.toml");
    const BuiltCase built = build(read, runs_of_case(read).front());
    const RunResult result = run(built.model, built.plan, built.behaviours);
    const std::vector<InterfaceVerdict> verdicts = numbers_of(built, result, nullptr).interfaces;
    const double expected = find_number(verdicts.front().numbers, "max_moment")->value;
    EXPECT_NEAR(moment.values[place(answer, name)].value_or(0) / expected, 1, 1e-9) << name;
  }
}

/// What is computed decides the identity, not what the results are called or how far the other choices go.
TEST(Trust, ASampleIsKnownByWhatItComputes) {
  const auto ids = [](const std::string& text) {
    const Raw raw = read_toml_text(text, "case.toml");
    std::map<std::string, std::string> made;
    for (const TrustSample& sample : trust_samples(raw, check_case(raw, "case.toml"), {}).samples) made[sample.change.name] = sample.id;
    return made;
  };
  const auto one = ids(rocking), more = ids(rocking + "[trust]\ninterior = 1\nspectrum_band = 0.2\n");
  EXPECT_EQ(more.size(), one.size() + 2);
  for (const auto& [name, id] : one) EXPECT_EQ(more.at(name), id) << name;
  std::set<std::string> distinct;
  for (const auto& [name, id] : more) distinct.insert(id);
  EXPECT_EQ(distinct.size(), more.size());
  std::string heavier = rocking;
  heavier.replace(heavier.find("1e5"), 3, "2e5");
  for (const auto& [name, id] : ids(heavier)) EXPECT_NE(one.at(name), id) << name;
}

TEST(Trust, StopsWhenAsked) {
  const Raw raw = read_toml_text(rocking, "case.toml");
  const Case read = check_case(raw, "case.toml");
  const BuiltCase built = build(read, runs_of_case(read).front());
  const RunResult result = run(built.model, built.plan, built.behaviours);
  const TrustSamples samples = trust_samples(raw, read, {});
  const TrustResults results = compute_samples(samples, 2, [](const Progress& progress) { return progress.fraction < 0.1; });
  const TrustAnswer answer = trust_answer(read, samples, results, {built, result, nullptr});
  EXPECT_FALSE(answer.complete);
  EXPECT_TRUE(std::ranges::any_of(answer.runs, [](const TrustRun& run) { return run.status == RunStatus::interrupted; }));
}

}  // namespace
}  // namespace uplift::trust_test
