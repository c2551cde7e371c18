#include "uplift/study/study_curve.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "tower_case.h"
#include "uplift/io/text/toml.h"
#include "uplift/study/study_fit.h"

// Which runs a study wants, by what a run is known, and what its outcome counts as.
namespace uplift::study_curve_test {
namespace {

std::string tower() {
  return "title = \"tower\"\n" + support::Tower{}.text() + support::weight + R"([[interface]]
name = "soil"
law = { type = "springs", K_n = "20 MPa/m" }
[interface.footing]
body = "base"
width = 3
points = 11
[[record]]
name = "quake"
generate = { target = { type = "rg_1_60", pga = 1 }, duration = 5, step = 0.01 }
[[ground_acceleration]]
direction = [1, 0]
function = "quake"
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 1
step = "2 ms"
)";
}

constexpr const char* searching = R"(case = "case.toml"
[intensity]
measure = "pga"
[method]
type = "ida"
start = 1
largest = 100
[[record]]
name = "other"
generate = { target = { type = "rg_1_60", pga = 1 }, duration = 5, step = 0.01, seed = 2 }
[[motion]]
name = "own"
replace = ["quake"]
by = ["quake"]
[[motion]]
name = "other"
replace = ["quake"]
by = ["other"]
[[limit]]
name = "opening"
quantity = "max_opening"
limit = "10 mm"
)";

constexpr const char* variable = R"([[variable]]
name = "stiffness"
paths = ["interface[0].law.K_n"]
distribution = { type = "lognormal", median = 1, beta = 0.3 }
)";

/// Where generated records are kept, for this process.
class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / ("uplift_motions_" + std::to_string(::getpid()))) {}
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

std::string motions() {
  static const Folder folder;
  return folder.path();
}

StudyCase study_of(const std::string& plan, const std::string& text = tower(), const std::string& folder = motions()) {
  return study_case(study_plan(read_toml_text(plan, "plan.toml")), read_toml_text(text, "case.toml"), {}, folder);
}

/// A run whose opening is `opening` [m].
StudyResult opened(double opening, StudyOutcome outcome = StudyOutcome::completed) {
  StudyResult result;
  result.outcome = outcome;
  result.numbers = {{"max_opening", "soil", opening}};
  return result;
}

/// Spectra of a lost structure end with it, and failed runs have none: percentiles say over how many runs they are.
TEST(StudyFit, FloorPercentilesSayWhatTheyAreMadeOf) {
  std::string plan = "samples = 5\n" + std::string(searching) + variable;
  plan.replace(plan.find("type = \"ida\""), plan.find("[[record]]") - plan.find("type = \"ida\""), "type = \"stripes\"\nlevels = [1.0]\n");
  const StudyCase study = study_of(plan);
  std::vector<StudyCurve> curves = study_curves(study);
  std::map<std::string, StudyResult> results;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const StudyPoint point = curves[i].wanted([](const std::string&) -> const StudyResult* { return nullptr; }).front();
    StudyResult& result = results[point.id] = opened(0.001, i == 3  ? StudyOutcome::overturned
                                                            : i > 7 ? StudyOutcome::failed
                                                                    : StudyOutcome::completed);
    if (says_something(result.outcome)) result.spectra = {{"top", 0.05, {1}, {static_cast<double>(10 - i)}}};
    curves[i].wanted([&](const std::string& id) { return &results.at(id); });
  }
  const std::vector<StudyFloor> floors = floor_percentiles(study, curves);
  ASSERT_EQ(floors.size(), 1U);
  EXPECT_EQ(floors[0].runs, 8);
  EXPECT_EQ(floors[0].lost, 1);
  EXPECT_EQ(floors[0].missing, 2);
  EXPECT_NEAR(floors[0].p16[0], 3 + 7 * 0.16, 1e-12);  // straight between 3, 4 ... 10
  EXPECT_NEAR(floors[0].p50[0], 6.5, 1e-12);
}

/// A level without any spectrum is named with its failed runs.
TEST(StudyFit, FloorPercentilesNameLevelsAtWhichAllRunsFailed) {
  std::string plan = searching;
  plan.replace(plan.find("type = \"ida\""), plan.find("[[record]]") - plan.find("type = \"ida\""),
               "type = \"stripes\"\nlevels = [1.0, 2.0]\n");
  const StudyCase study = study_of(plan);
  std::vector<StudyCurve> curves = study_curves(study);
  std::map<std::string, StudyResult> results;
  for (StudyCurve& curve : curves) {
    for (const StudyPoint& point : curve.wanted([](const std::string&) -> const StudyResult* { return nullptr; })) {
      StudyResult& result = results[point.id] = opened(0.001, point.intensity > 1.5 ? StudyOutcome::failed : StudyOutcome::completed);
      if (says_something(result.outcome)) result.spectra = {{"top", 0.05, {1}, {3.0}}};
    }
    curve.wanted([&](const std::string& id) { return &results.at(id); });
  }
  const std::vector<StudyFloor> floors = floor_percentiles(study, curves);
  ASSERT_EQ(floors.size(), 2U);
  EXPECT_EQ(floors[0].runs, 2);
  EXPECT_EQ(floors[1].level, 2);
  EXPECT_EQ(floors[1].floor, "top");
  EXPECT_EQ(floors[1].runs, 0);
  EXPECT_EQ(floors[1].missing, 2);
  EXPECT_TRUE(floors[1].p50.empty());
}

/// The demand is that of the intensity times the root of the stiffness, but for the stiffest sample, which stays closed at the lowest one:
/// what is left of it must not be compared with all demands of the others.
TEST(StudyFit, TornadoComparesTheSameMotionsAndIntensities) {
  std::string plan = "samples = 3\n" + std::string(searching) + variable;
  plan.replace(plan.find("type = \"ida\""), plan.find("[[record]]") - plan.find("type = \"ida\""),
               "type = \"stripes\"\nlevels = [0.1, 1.0, 2.0]\n");
  const StudyCase study = study_of(plan);
  std::vector<double> stiffness;
  for (const auto& sample : study.samples) stiffness.push_back(sample.values[0]);
  const auto [soft, stiff] = std::ranges::minmax(stiffness);
  std::vector<StudyCurve> curves = study_curves(study);
  std::map<std::string, StudyResult> results;
  for (StudyCurve& curve : curves) {
    for (const StudyPoint& point : curve.wanted([](const std::string&) -> const StudyResult* { return nullptr; })) {
      const double k = stiffness[curve.sample()];
      const bool lost = k == soft && point.intensity > 1.5;  // its demand is that up to the loss
      results[point.id] = opened(k == stiff && point.intensity < 0.5 ? 0
                                 : lost                              ? 1
                                                                     : 1e-3 * point.intensity * std::sqrt(k),
                                 lost ? StudyOutcome::overturned : StudyOutcome::completed);
    }
    curve.wanted([&](const std::string& id) { return &results.at(id); });
  }
  const StudyLimitFit fit = fit_limit(study, curves, 0);
  ASSERT_EQ(fit.tornado.size(), 1U);
  const double level = std::cbrt(0.1 * 1.0 * 2.0);  // of all intensities: what is missing is that of the fit, which is exact here
  EXPECT_NEAR(fit.tornado[0].low, 1e-3 * level * std::sqrt(soft), 1e-15);
  EXPECT_NEAR(fit.tornado[0].high, 1e-3 * level * std::sqrt(stiff), 1e-15);
  EXPECT_EQ(fit.tornado_samples, 3);
  EXPECT_EQ(fit.tornado_responses, 18 - 4);
  EXPECT_EQ(fit.no_tornado, "");
}

/// A sample that fails in every run is left out alone; where less than three are left, it is said why there is no tornado.
TEST(StudyFit, ASampleWithoutResponsesDoesNotRemoveTheTornado) {
  for (const std::size_t known : {3U, 2U}) {
    std::string plan = "samples = 4\n" + std::string(searching) + variable;
    plan.replace(plan.find("type = \"ida\""), plan.find("[[record]]") - plan.find("type = \"ida\""),
                 "type = \"stripes\"\nlevels = [1.0]\n");
    const StudyCase study = study_of(plan);
    std::vector<StudyCurve> curves = study_curves(study);
    std::map<std::string, StudyResult> results;
    std::vector<double> stiffness;
    for (std::size_t s = 0; s < known; ++s) stiffness.push_back(study.samples[s].values[0]);
    for (StudyCurve& curve : curves) {
      for (const StudyPoint& point : curve.wanted([](const std::string&) -> const StudyResult* { return nullptr; }))
        results[point.id] = curve.sample() < known ? opened(1e-3 * stiffness[curve.sample()]) : opened(0, StudyOutcome::failed);
      curve.wanted([&](const std::string& id) { return &results.at(id); });
    }
    const StudyLimitFit fit = fit_limit(study, curves, 0);
    EXPECT_EQ(fit.tornado_samples, static_cast<long>(known));
    EXPECT_EQ(fit.tornado.empty(), known == 2);
    EXPECT_EQ(fit.no_tornado.find("it takes three samples") == 0, known == 2) << fit.no_tornado;
    if (known == 2) continue;
    EXPECT_NEAR(fit.tornado[0].low, 1e-3 * std::ranges::min(stiffness), 1e-15);
    EXPECT_NEAR(fit.tornado[0].high, 1e-3 * std::ranges::max(stiffness), 1e-15);
  }
}

/// Ten demands, and two runs that failed below the limit between them: with the demands of the latter at least and at most the limit, the
/// maximum of the censored likelihood was found with Nelder and Mead's method (SciPy).
TEST(StudyFit, RunsOfUnknownOutcomeCountBothWaysInACloud) {
  std::string plan = searching;
  plan.replace(plan.find("measure = \"pga\""), 15, "measure = \"factor\"");
  plan.replace(plan.find("type = \"ida\""), plan.find("[[record]]") - plan.find("type = \"ida\""),
               "type = \"cloud\"\nfactors = [0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.41, 0.45, 0.5, 0.6, 0.8, 1.0]\n");
  plan.erase(plan.find("[[motion]]\nname = \"other\""), plan.find("[[limit]]") - plan.find("[[motion]]\nname = \"other\""));
  const StudyCase study = study_of(plan);
  std::vector<StudyCurve> curves = study_curves(study);
  ASSERT_EQ(curves.size(), 1U);
  const std::map<double, double> demands{{.1, .0021}, {.15, .0028}, {.2, .0047}, {.25, .0049}, {.3, .0072},
                                         {.4, .0083}, {.5, .0125},  {.6, .0131}, {.8, .021},   {1., .0236}};
  std::map<std::string, StudyResult> results, closed;
  for (const StudyPoint& point : curves[0].wanted([](const std::string&) -> const StudyResult* { return nullptr; })) {
    const auto known = demands.find(point.intensity);
    results[point.id] = known != demands.end() ? opened(known->second) : opened(0.001, StudyOutcome::failed);
    closed[point.id] = known != demands.end() ? opened(known->second) : opened(0);
  }
  ASSERT_EQ(results.size(), 12U);
  EXPECT_TRUE(curves[0].wanted([&](const std::string& id) { return &results.at(id); }).empty());
  const StudyLimitFit fit = fit_limit(study, curves, 0);
  EXPECT_EQ(fit.unknown, 2);
  const Fragility &middle = std::get<Fragility>(fit.fit.middle), &exceeded = std::get<Fragility>(fit.fit.exceeded),
                  &survived = std::get<Fragility>(fit.fit.survived);
  EXPECT_NEAR(middle.theta(), 0.43853218, 1e-8);
  EXPECT_NEAR(exceeded.theta(), 0.43182863, 1e-8);
  EXPECT_NEAR(middle.beta(), 0.08522703, 1e-8);  // least squares: n - 2 = 8 of 10 demands, and so for both ends
  const double few = std::sqrt(10.0 / 8);
  EXPECT_NEAR(exceeded.beta(), few * 0.07941981, 1e-8);
  EXPECT_NEAR(survived.theta(), 0.44316412, 1e-8);
  EXPECT_NEAR(survived.beta(), few * 0.07684176, 1e-8);
  // runs that were completed with a demand of 0 have survived: the same maximum, now that of the figure in the middle
  std::vector<StudyCurve> again = study_curves(study);
  EXPECT_TRUE(again[0].wanted([&](const std::string& id) { return &closed.at(id); }).empty());
  const StudyLimitFit zeros = fit_limit(study, again, 0);
  EXPECT_EQ(zeros.without_demand, 2);
  EXPECT_NEAR(std::get<Fragility>(zeros.fit.middle).theta(), 0.44316412, 1e-8);
  EXPECT_NEAR(std::get<Fragility>(zeros.fit.middle).beta(), 0.07684176, 1e-8);
}

TEST(StudyCurve, ASearchFindsTheIntensityOfTheLimit) {
  const StudyCase study = study_of(searching);
  StudyCurve curve = study_curves(study).front();
  std::map<std::string, StudyResult> results;
  const FindResult find = [&](const std::string& id) { return results.contains(id) ? &results.at(id) : nullptr; };
  // an opening of 1 mm times the square of the intensity reaches 10 mm at sqrt(10)
  for (std::vector<StudyPoint> wanted = curve.wanted(find); !wanted.empty(); wanted = curve.wanted(find)) {
    ASSERT_EQ(wanted.size(), 1U);
    EXPECT_NEAR(wanted[0].factor * study.motions[0].intensity, wanted[0].intensity, 1e-12 * wanted[0].intensity);
    results.emplace(wanted[0].id, opened(1e-3 * wanted[0].intensity * wanted[0].intensity));
  }
  EXPECT_TRUE(curve.complete());
  const std::optional<RecordCapacity> capacity = curve.searches()[0].capacity(Unknown::left_out);
  ASSERT_TRUE(capacity);
  EXPECT_NEAR(std::log(capacity->im), std::log(std::sqrt(10.0)), 0.02);
  // all results at once are the same curve
  StudyCurve again = study_curves(study).front();
  EXPECT_TRUE(again.wanted(find).empty());
  EXPECT_EQ(again.runs().size(), results.size());
}

TEST(StudyCurve, StripesWantEveryLevelOfEveryMotionAndSample) {
  std::string plan = searching;
  plan.replace(plan.find("type = \"ida\"\nstart = 1\nlargest = 100"), 36, "type = \"stripes\"\nlevels = [1, 2, 3]");
  const StudyCase study = study_of("samples = 4\n" + plan + variable);
  std::set<std::string> ids;
  for (StudyCurve& curve : study_curves(study))
    for (const StudyPoint& point : curve.wanted([](const std::string&) { return nullptr; })) ids.insert(point.id);
  EXPECT_EQ(ids.size(), 3U * 2 * 4);
  // results come one by one, the last one first; what is left keeps its order
  StudyCurve curve = study_curves(study).front();
  std::map<std::string, StudyResult> results;
  const FindResult find = [&](const std::string& id) { return results.contains(id) ? &results.at(id) : nullptr; };
  for (std::size_t left = 3; left > 0; --left) {
    const std::vector<StudyPoint> wanted = curve.wanted(find);
    ASSERT_EQ(wanted.size(), left);
    EXPECT_FALSE(curve.complete());
    for (std::size_t i = 0; i < left; ++i) EXPECT_EQ(wanted[i].intensity, static_cast<double>(i + 1));
    results.emplace(wanted.back().id, opened(1e-3));
    EXPECT_EQ(curve.runs().size(), 3 - left);
  }
  EXPECT_TRUE(curve.wanted(find).empty());
  EXPECT_TRUE(curve.complete());
  EXPECT_EQ(curve.runs().size(), 3U);
  const StudyCase paired = study_of("samples = 4\npairing = \"paired\"\n" + plan + variable);
  EXPECT_EQ(study_curves(paired).size(), 4U);
}

TEST(StudyRun, IdentityIsWhatIsComputed) {
  const StudyCase study = study_of(searching);
  const std::string id = run_identity(study, 0, 0, 0.3);
  EXPECT_EQ(id.size(), 64U);
  EXPECT_NE(id, run_identity(study, 0, 1, 0.3));
  EXPECT_NE(id, run_identity(study, 0, 0, std::nextafter(0.3, 1)));
  std::string moved = tower();
  moved.replace(moved.find("20 MPa/m"), 8, "21 MPa/m");
  EXPECT_NE(id, run_identity(study_of(searching, moved), 0, 0, 0.3));
  // what does not change the run: limits, other motions, comments and units
  std::string plan = searching;
  plan.replace(plan.find("10 mm"), 5, "20 mm");
  EXPECT_EQ(id, run_identity(study_of(plan), 0, 0, 0.3));
  plan = searching;
  plan.erase(plan.find("[[motion]]\nname = \"other\""), plan.find("[[limit]]") - plan.find("[[motion]]\nname = \"other\""));
  EXPECT_EQ(id, run_identity(study_of(plan), 0, 0, 0.3));
  std::string same = "# a comment\n" + tower();
  same.replace(same.find("\"tower\""), 7, "\"another title\"");
  same.replace(same.find("20 MPa/m"), 8, "2e7 Pa/m");
  EXPECT_EQ(id, run_identity(study_of(searching, same), 0, 0, 0.3));
}

TEST(StudyRun, KeptRecordsAreTheGeneratedOnesToTheLastBit) {
  const StudyCase generated = study_of(searching, tower(), ""), kept = study_of(searching);
  ASSERT_EQ(generated.read.records.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(generated.read.records[i].motion().values, kept.read.records[i].motion().values);
    EXPECT_EQ(generated.read.records[i].motion().step, kept.read.records[i].motion().step);
    EXPECT_NE(kept.read.records[i].motion().file, "");
  }
  EXPECT_EQ(run_identity(generated, 0, 1, 0.3), run_identity(kept, 0, 1, 0.3));
}

TEST(StudyRun, AFactorIsTheProcessScale) {
  const StudyCase study = study_of(searching);
  const BuiltCase built = build(study.read, run_of_study(study, study.read, 1, 0.7));
  const std::string text = resolved_run(study, 0, 1, 0.7);
  const Case alone = check_case(read_toml_text(text, "case.toml"), "case.toml");
  const BuiltCase other = build(alone, runs_of_case(alone).front());
  const CaseRecord& record = study.read.records.back();
  ASSERT_EQ(record.name, "other");
  for (double t = 0; t < 5; t += 0.0123) {
    EXPECT_EQ(built.model.ground_acceleration(Vec3::UnitX(), t), other.model.ground_acceleration(Vec3::UnitX(), t));
    EXPECT_NEAR(built.model.ground_acceleration(Vec3::UnitX(), t), 0.7 * record.history->at(MotionKind::acceleration, t), 1e-15);
  }
}

TEST(StudyRun, OutcomesCountForALimit) {
  const StudyLimit limit{"opening", "", QuantityName("max_opening"), "soil", 0.01};
  using enum StudyOutcome;
  EXPECT_EQ(outcome_of(limit, opened(0.009)), RunOutcome::survived);
  EXPECT_EQ(outcome_of(limit, opened(0.011)), RunOutcome::exceeded);
  EXPECT_EQ(outcome_of(limit, opened(0.009, overturned)), RunOutcome::exceeded);
  for (const StudyOutcome outcome : {failed, timeout, crashed, memory}) {
    EXPECT_EQ(outcome_of(limit, opened(0.009, outcome)), RunOutcome::unknown);
    EXPECT_EQ(outcome_of(limit, opened(0.011, outcome)), RunOutcome::exceeded);  // before it ended
  }
  EXPECT_EQ(outcome_of(limit, opened(0.011, energy)), RunOutcome::unknown);
  const StudyLimit other{"opening", "", QuantityName("max_opening"), "wall", 0.01};
  EXPECT_EQ(outcome_of(other, opened(0.011)), RunOutcome::survived);
}

// Two motions whose opening overturns at twice the intensity of the limit: too few for fractiles; crossed with two samples four are enough.
TEST(StudyFit, FractilesOfTheCurvesReachTheLimitAtTheirCapacities) {
  const auto fitted = [](const StudyCase& study) {
    std::vector<StudyCurve> curves = study_curves(study);
    static std::map<std::string, StudyResult> results;
    results.clear();
    const FindResult find = [](const std::string& id) { return results.contains(id) ? &results.at(id) : nullptr; };
    for (std::size_t k = 0; k < curves.size(); ++k)
      for (std::vector<StudyPoint> wanted = curves[k].wanted(find); !wanted.empty(); wanted = curves[k].wanted(find)) {
        const double part = wanted[0].intensity / (3 + static_cast<double>(k));  // of the intensity that opens it by 10 mm
        results.emplace(wanted[0].id, opened(0.01 * std::min(part, 2.0), part > 2 ? StudyOutcome::overturned : StudyOutcome::completed));
      }
    return fit_limit(study, curves, 0);
  };
  EXPECT_FALSE(fitted(study_of(searching)).fractiles);
  const StudyLimitFit crossed = fitted(study_of("samples = 2\n" + std::string(searching) + variable));
  ASSERT_TRUE(crossed.fractiles);
  const IdaFractiles& found = *crossed.fractiles;
  ASSERT_EQ(found.demands.size(), 40U);
  EXPECT_DOUBLE_EQ(found.demands.back(), 0.01);
  for (const std::size_t i : {0U, 19U, 39U}) {  // straight curves through the capacities 3, 4, 5 and 6
    const double share = found.demands[i] / 0.01;
    EXPECT_NEAR(*found.p16[i], 3.48 * share, 1e-12);
    EXPECT_NEAR(*found.p50[i], 4.5 * share, 1e-12);
    EXPECT_NEAR(*found.p84[i], 5.52 * share, 1e-12);
  }
}

// Two motions of different capacities at the same intensities with two samples: 32 runs that are no 32 independent ones.
TEST(StudyFit, TheIntervalOfStripesKnowsThatRunsShareMotions) {
  std::string plan = searching;
  plan.replace(plan.find("type = \"ida\"\nstart = 1\nlargest = 100"), 36, "type = \"stripes\"\nlevels = [0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4]");
  const StudyCase study = study_of("samples = 2\n" + plan + variable);
  std::vector<StudyCurve> curves = study_curves(study);
  std::map<std::string, StudyResult> results;
  const FindResult find = [&](const std::string& id) { return results.contains(id) ? &results.at(id) : nullptr; };
  for (StudyCurve& curve : curves) {
    for (const StudyPoint& point : curve.wanted(find))
      results.emplace(point.id, opened(0.01 * point.intensity / (curve.motion() == 0 ? 1.2 : 2.7)));
    curve.wanted(find);
  }
  const StudyLimitFit fit = fit_limit(study, curves, 0);
  const Fragility& middle = std::get<Fragility>(fit.fit.middle);
  ASSERT_TRUE(std::holds_alternative<SharedError>(fit.shared));
  const ConfidenceInterval wide = fit.theta_interval(), narrow = middle.theta_interval(study_confidence);
  ASSERT_TRUE(narrow.lower && narrow.upper);
  EXPECT_LT(*wide.lower, *narrow.lower);
  EXPECT_GT(*wide.upper, *narrow.upper);
  // two motions have one degree of freedom: Student's t is 6.313752 for 90 %
  EXPECT_NEAR(std::log(*wide.upper / middle.theta()) / std::get<SharedError>(fit.shared).se_log_theta, 6.313752, 1e-5);
  const ConfidenceInterval band = fit.probability_interval(middle.theta());
  EXPECT_NEAR(*band.upper, 0.5 * std::erfc(-std::log(middle.theta() / *wide.lower) / middle.beta() / std::sqrt(2.0)), 1e-12);
}

TEST(StudyFit, TheSiteAsksForProbabilitiesAndARate) {
  std::string plan = searching;
  plan.insert(plan.find("[[limit]]"),
              "[design]\nintensity = 0.5\n[hazard]\nintensities = [0.5, 1, 2]\nrates = [1e-4, 1.7677669529663688e-5, 3.125e-6]\n");
  const StudySite site = study_plan(read_toml_text(plan, "plan.toml")).site;
  const std::vector<RecordCapacity> capacities{{1 / std::exp(0.4 * std::sqrt(1.5)), Known::exact, {}},
                                               {1, Known::exact, {}},
                                               {std::exp(0.4 * std::sqrt(0.5)), Known::exact, {}},
                                               {std::exp(0.4 * std::sqrt(1.5) - 0.4 * std::sqrt(0.5)), Known::exact, {}}};
  const OrRefused<Fragility> curve = fit_capacities(capacities);
  const Fragility& fit = std::get<Fragility>(curve);
  const std::optional<PerformancePair> pair = performance_of(site, curve);
  ASSERT_TRUE(pair);
  EXPECT_NEAR(pair->at_design, 0.5 * std::erfc(-std::log(0.5 / fit.theta()) / fit.beta() / std::sqrt(2.0)), 1e-14);
  EXPECT_NEAR(pair->at_one_and_a_half, 0.5 * std::erfc(-std::log(0.75 / fit.theta()) / fit.beta() / std::sqrt(2.0)), 1e-14);
  // the three points lie on the power law 1e-4 (a/0.5)^-2.5
  const AnnualRisk risk = std::get<AnnualRisk>(risk_of(site, curve));
  const double expected = 1e-4 * std::pow(0.5, 2.5) * std::pow(fit.theta(), -2.5) * std::exp(0.5 * 2.5 * 2.5 * fit.beta() * fit.beta());
  EXPECT_NEAR(risk.rate / expected, 1, 1e-9);
  EXPECT_FALSE(performance_of({}, curve));
  EXPECT_FALSE(performance_of(site, Refused{"no runs"}));
  EXPECT_TRUE(std::holds_alternative<Refused>(risk_of({}, curve)));
  EXPECT_EQ(std::get<Refused>(risk_of(site, Refused{"no runs"})).reason, "no runs");
}

TEST(CaseEdit, NumbersAreFoundByTheirPath) {
  const Case read = check_case(read_toml_text(tower(), "case.toml"), "case.toml");
  EXPECT_EQ(number_at(read.values, "interface[0].law.K_n")->value, 2e7);
  EXPECT_EQ(number_at(read.values, "interface[0].law.K_n")->field->unit, "Pa/m");
  EXPECT_EQ(number_at(read.values, "interface[0].footing.width")->value, 3);
  EXPECT_EQ(number_at(read.values, "ground_acceleration[0].direction[0]")->value, 1);
  for (const char* path : {"", "[", "interface", "interface[1].law.K_n", "interface[0].law.K_m", "interface[0].law", "interface[x].law.K_n",
                           "interface[0", "ground_acceleration[0].direction[3]", "title", "stage[1].step.more"})
    EXPECT_FALSE(number_at(read.values, path)) << path;
}

TEST(CaseEdit, APathIsSuggestedOnlyIfItExists) {
  const Case read = check_case(
      read_toml_text(tower() + "[[function]]\nname = \"f\"\nshape = { type = \"table\", times = [0, 1], values = [0, 2] }\n", "case.toml"),
      "case.toml");
  const auto nearest = [&](std::string_view path) {
    std::string found;
    EXPECT_FALSE(number_at(read.values, path, &found)) << path;
    return found;
  };
  EXPECT_EQ(nearest("function[0].shape[1]"), "function[0].shape.values[1]");
  EXPECT_EQ(nearest("function[0].shape[7]"), "");
  EXPECT_EQ(nearest("interface[0].law[1]"), "");
  EXPECT_EQ(nearest("interface[0].lax.K_m"), "");
  EXPECT_EQ(nearest("interface[0].law.Kn"), "interface[0].law.K_n");
}

}  // namespace
}  // namespace uplift::study_curve_test
