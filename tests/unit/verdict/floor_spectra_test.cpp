#include "uplift/verdict/floor_spectra.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "uplift/io/results/floors.h"
#include "uplift/io/text/toml.h"

namespace uplift::floor_spectra_test {
namespace {

FloorSpectra floor_of(const std::vector<double>& values, double zero_period = 1) {
  return {"roof", {"roof", "m/s2", zero_period, 0.5}, {{Spectrum::Kind::psa, 0.05, {1, 2, 4, 8, 16}, values}}, {}};
}

TEST(FloorSpectra, Bands) {
  const std::vector<FrequencyBand> bands = frequency_bands({2, 5});
  ASSERT_EQ(bands.size(), 3U);
  EXPECT_EQ(to_string(bands[0]), "below 2 Hz");
  EXPECT_EQ(to_string(bands[1]), "2 to 5 Hz");
  EXPECT_EQ(to_string(bands[2]), "above 5 Hz");
}

/// By hand: a frequency on an edge belongs to the band above it; a band without frequencies says nothing; where the bonded floor rests
/// there is no ratio without a threshold.
TEST(FloorSpectra, ChangeOfBands) {
  const std::vector<FloorChange> changes = floor_change(floor_of({3, 2, 6, 5, 1}), floor_of({0, 4, 3, 10, 1}), {2, 5, 6, 7}, 0);
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].frequencies, (std::vector<double>{2, 4, 8, 16}));
  EXPECT_EQ(changes[0].ratio, (std::vector<double>{0.5, 2, 0.5, 1}));
  EXPECT_EQ(changes[0].bonded, (std::vector<double>{4, 3, 10, 1}));
  ASSERT_EQ(changes[0].bands.size(), 2U);  // from 2 to 5 Hz, above 7 Hz
  EXPECT_DOUBLE_EQ(changes[0].bands[0].change, 0.5);
  EXPECT_EQ(changes[0].bands[0].least, 0.5);
  EXPECT_EQ(changes[0].bands[0].most, 2);
  EXPECT_DOUBLE_EQ(changes[0].bands[1].change, -0.5);
  EXPECT_EQ(changes[0].bands[1].band.from, 7);
}

/// A direction that is not excited has no ratio; where one of the runs is excited the other counts as the threshold at least.
TEST(FloorSpectra, NoiseIsNotCompared) {
  const FloorSpectra noise = floor_of({1e-14, 3e-15, 2e-14, 1e-15, 1e-13}, 1e-14), excited = floor_of({3, 2, 6, 5, 1}, 2);
  const double least = least_excitation({noise, excited}, {noise});
  EXPECT_DOUBLE_EQ(least, 2e-3);
  const FloorChange nothing = floor_change(noise, floor_of({2e-15, 1e-14, 1e-14, 4e-15, 1e-14}), {2, 5}, least).front();
  EXPECT_TRUE(nothing.bands.empty());
  EXPECT_TRUE(nothing.ratio.empty());
  const FloorChange arises = floor_change(excited, noise, {2, 5}, least).front();
  ASSERT_EQ(arises.bands.size(), 3U);
  EXPECT_DOUBLE_EQ(arises.bands[2].change, 5 / 2e-3 - 1);
  EXPECT_TRUE(arises.bands[2].arises);
  EXPECT_EQ(arises.bands[2].largest, 5);
  const FloorChange vanishes = floor_change(noise, excited, {2, 5}, least).front();
  ASSERT_EQ(vanishes.bands.size(), 3U);
  EXPECT_NEAR(vanishes.bands[0].change, -1, 1e-12);
}

TEST(FloorSpectra, EnvelopeOfRuns) {
  const FloorSpectra a = floor_of({1, 5, 2, 2, 1}, 1), b = floor_of({2, 1, 3, 1, 1}, -2);
  const FloorSpectra both = floor_envelope({&a, &b}, 0.15);
  EXPECT_EQ(both.raw[0].values, (std::vector<double>{2, 5, 3, 2, 1}));
  EXPECT_EQ(both.zero_period.value, -2);
  ASSERT_EQ(both.broadened.size(), 1U);
  for (const double f : {1.7, 2.0, 2.3}) EXPECT_NEAR(value_at(both.broadened[0], f), 5, 1e-12) << f;
}

constexpr const char* base_text = R"(
title = "floors"
[nodes]
top = [0, 4]
[[mass]]
node = "top"
mass = 1000
[[spring]]
nodes = ["top"]
direction = [1, 0]
stiffness = 1e6
[[support]]
node = "top"
fixed = ["uy", "rz"]
[[function]]
name = "shake"
shape = { type = "half_sine", duration = 0.1 }
[[ground_acceleration]]
direction = [1, 0]
function = "shake"
[[stage]]
type = "dynamic"
duration = 0.5
step = 0.005
)";

Case read_case(const std::string& floor) {
  return check_case(read_toml_text(base_text + floor, "case.toml"), "case.toml");
}

const std::string roof = "[[output.floor_spectrum]]\nname = \"roof\"\nnode = \"top\"\ndirection = [2, 0]\n";

TEST(FloorSpectra, Defaults) {
  const BuiltCase built = build(read_case(roof), {});
  ASSERT_EQ(built.plan.floors.size(), 1U);
  const FloorRequest& floor = built.plan.floors[0];
  EXPECT_EQ(floor.dampings, (std::vector<double>{0.02, 0.05}));
  EXPECT_EQ(floor.frequencies.size(), 75U);
  EXPECT_EQ(floor.broadening, 0.15);
  EXPECT_EQ(floor.direction.x(), 1);
  EXPECT_EQ(built.plan.floor_bands, (std::vector<double>{2, 5, 10, 20}));
  const BuiltCase ranged = build(read_case(roof + "range = { from = 1, to = \"16 Hz\", count = 5 }\n"), {});
  ASSERT_EQ(ranged.plan.floors[0].frequencies.size(), 5U);
  EXPECT_NEAR(ranged.plan.floors[0].frequencies[3], 8, 1e-12);
}

TEST(FloorSpectra, RefusesWhatCannotBe) {
  const auto wanted = [](const std::string& text) -> std::string {
    try {
      build(read_case(text), {});
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  const auto says = [&](const std::string& text, const char* part) {
    EXPECT_NE(wanted(text).find(part), std::string::npos) << wanted(text);
  };
  says("[[output.floor_spectrum]]\nname = \"roof\"\ndirection = [1, 0]\n", "exactly one of node and at");
  says("[[output.floor_spectrum]]\nname = \"roof\"\nnode = \"tip\"\ndirection = [1, 0]\n", "top");
  says("[[output.floor_spectrum]]\nname = \"roof\"\nnode = \"top\"\ndirection = [0, 0]\n", "a direction");
  says(roof + "damping = [1.0]\n", "damping ratios from 0, below 1");
  says(roof + "frequencies = [2, 1]\n", "ascending");
  says(roof + "frequencies = [2, 4]\nrange = { from = 1, to = 2 }\n", "frequencies or range");
  says(roof + "range = { from = 3, to = 2 }\n", "above 3 Hz");
  says(roof + roof, "roof");
  says("[output]\nfloor_bands = [5, 2]\n", "ascending");
  says("[[stage]]\ntype = \"dynamic\"\nduration = 1\nstep = 0.01\n" + roof, "the same step");
}

/// Two variants, one that may fail, and and one that stands for the bonded run: the envelope is that of the sound ones.
TEST(FloorSpectra, SoundRunsOfAGroup) {
  const Case read = read_case(roof + "frequencies = [2, 4, 8]\nbroadening = 0\n");
  std::vector<RunResult> results;
  std::vector<RunSpec> specs(4);
  specs[1].expected_to_fail = true;
  specs[2].bonded = true;
  const double amplitudes[] = {1, 5, 2, 3};
  RunPlan plan;
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const BuiltCase built = build(read, {});
    plan = built.plan;
    results.push_back(run(built.model, built.plan, {}));
    for (double& a : results.back().floors[0].acceleration) a *= amplitudes[i];
  }
  const FloorAnswers answers = floor_answers(plan, results, specs);
  ASSERT_EQ(answers.envelopes.size(), 1U);
  EXPECT_EQ(answers.envelopes[0].runs, 2);
  const std::vector<double>& one = answers.runs[0].floors[0].raw[0].values;
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(answers.envelopes[0].floors[0].raw[0].values[k], 3 * one[k], 1e-12 * one[k]);
    EXPECT_NEAR(answers.runs[3].beside[0][0].ratio[k], 1.5, 1e-12);
  }
  EXPECT_TRUE(answers.runs[2].beside.empty());

  results[3].status = RunStatus::failed;
  EXPECT_TRUE(floor_spectra(plan, results[3]).empty());
  EXPECT_TRUE(floor_answers(plan, results, specs).envelopes.empty());  // one run is no envelope

  const std::string csv = floor_spectra_csv(results, answers);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + (4 + 1) * 2 * 3);
  EXPECT_EQ(csv.find("nan"), std::string::npos);
  JsonWriter json;
  json.begin_object();
  ResultWriter out(json);
  write_floors(out, "floors", answers.runs[3]);
  json.end_object();
  const nlohmann::json written = nlohmann::json::parse(json.take())["floors"];
  EXPECT_EQ(written[0]["name"], "roof");
  EXPECT_EQ(written[0]["spectra"][1]["damping"], 0.05);
  EXPECT_NEAR(written[0]["spectra"][0]["beside_bonded"][0]["change"].get<double>(), 0.5, 1e-12);
}

}  // namespace
}  // namespace uplift::floor_spectra_test
