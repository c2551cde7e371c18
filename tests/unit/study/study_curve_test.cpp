#include "uplift/study/study_curve.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "tower_case.h"
#include "uplift/io/text/toml.h"
#include "uplift/study/study_fit.h"

// Which runs a study wants, by what a run is known, and what its outcome counts as.
namespace uplift {
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
  const StudyLimit limit{"opening", "", find_verdict_quantity("max_opening"), "soil", 0.01};
  using enum StudyOutcome;
  EXPECT_EQ(outcome_of(limit, opened(0.009)), RunOutcome::survived);
  EXPECT_EQ(outcome_of(limit, opened(0.011)), RunOutcome::exceeded);
  EXPECT_EQ(outcome_of(limit, opened(0.009, overturned)), RunOutcome::exceeded);
  for (const StudyOutcome outcome : {failed, timeout, crashed, memory}) {
    EXPECT_EQ(outcome_of(limit, opened(0.009, outcome)), RunOutcome::unknown);
    EXPECT_EQ(outcome_of(limit, opened(0.011, outcome)), RunOutcome::exceeded);  // before it ended
  }
  EXPECT_EQ(outcome_of(limit, opened(0.011, energy)), RunOutcome::unknown);
  const StudyLimit other{"opening", "", find_verdict_quantity("max_opening"), "wall", 0.01};
  EXPECT_EQ(outcome_of(other, opened(0.011)), RunOutcome::survived);
}

TEST(StudyFit, PercentilesLieBetweenTheValues) {
  EXPECT_EQ(percentile({1, 2, 4}, 0.5), 2);
  EXPECT_EQ(percentile({1, 2, 4}, 0.75), 3);
  EXPECT_EQ(percentile({7}, 0.16), 7);
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

}  // namespace
}  // namespace uplift
