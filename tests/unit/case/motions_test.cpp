#include "uplift/io/report/motions.h"

#include <nlohmann/json.hpp>

#include "unit/case/record_support.h"
#include "uplift/base/file.h"
#include "uplift/verdict/compare_motions.h"

// `uplift compare` over motions, and what the results say of them.
namespace uplift::motions_test {
namespace {

const std::string third = R"([[record]]
name = "strong"
file = "strong.txt"
unit = "m/s2"
)";

const std::string two_motions = third + R"([[compare.motion]]
name = "one"
label = "First motion"
replace = ["ex", "ey"]
by = ["ex", "ey"]
[[compare.motion]]
name = "two"
replace = ["ex"]
by = ["strong"]
)";

class MotionCase : public RecordCase {
 protected:
  MotionCase() {
    write_record("ex.txt", 0.02, 151, 1.3);
    write_record("ey.txt", 0.02, 151, 2.1);
    write_record("strong.txt", 0.02, 151, 3.1);
  }
};

std::vector<std::string> names_of(const std::vector<RunSpec>& runs, std::string RunSpec::*member) {
  std::vector<std::string> names;
  for (const RunSpec& spec : runs) names.push_back(spec.*member);
  return names;
}

using Texts = std::vector<std::string>;

TEST_F(MotionCase, RunsTheCaseAndTheBondedModelWithEach) {
  const Case file = read(tower(quick, moving_frame) + two_motions);
  const std::vector<RunSpec> runs = comparison_of_case(file).runs;
  EXPECT_EQ(names_of(runs, &RunSpec::name), (Texts{"run-one", "bonded-one", "run-two", "bonded-two"}));
  EXPECT_EQ(names_of(runs, &RunSpec::group), (Texts{"First motion", "First motion", "two", "two"}));
  EXPECT_TRUE(runs[0].pictures && !runs[2].pictures);
  EXPECT_TRUE(runs[1].bonded && runs[3].bonded);
}

TEST_F(MotionCase, TheMotionOfTheCaseIsAmongThem) {
  const std::string further = third + "[[compare.motion]]\nname = \"two\"\nreplace = [\"ex\"]\nby = [\"strong\"]\n";
  const Case file = read(tower(quick, moving_frame) + further);
  const std::vector<RunSpec> runs = comparison_of_case(file).runs;
  EXPECT_EQ(names_of(runs, &RunSpec::name), (Texts{"run", "bonded", "run-two", "bonded-two"}));
  EXPECT_EQ(names_of(runs, &RunSpec::motion_label), (Texts{"motion of the case", "motion of the case", "two", "two"}));
  EXPECT_EQ(runs[0].motion, nullptr);
  EXPECT_TRUE(runs[0].pictures && runs[1].pictures && !runs[2].pictures);
}

TEST_F(MotionCase, RunsEveryVariantWithEveryDampingAndMotion) {
  const Case file =
      read(tower(quick, moving_frame) + two_motions +
           "[[variant]]\nname = \"a\"\n[[compare.damping]]\nname = \"low\"\nbeta = 1e-4\n[[compare.damping]]\nname = \"none\"\n");
  const std::vector<RunSpec> runs = comparison_of_case(file).runs;
  EXPECT_EQ(names_of(runs, &RunSpec::name), (Texts{"a-one-low", "bonded-one-low", "a-two-low", "bonded-two-low", "a-one-none",
                                                   "bonded-one-none", "a-two-none", "bonded-two-none"}));
  EXPECT_EQ(runs[3].group, "two, low");
  EXPECT_TRUE(runs[0].pictures && !runs[2].pictures && !runs[4].pictures);
}

/// A motion of the comparison is the case with the other name written in it.
TEST_F(MotionCase, TakesTheOtherRecord) {
  const Case file = read(tower(quick, moving_frame) + two_motions);
  const Case written = read(tower(quick, replaced(moving_frame, "function = \"ex\"", "function = \"strong\"")) + third);
  const std::vector<RunSpec> runs = comparison_of_case(file).runs;
  const BuiltCase one = build(file, runs[2]), two = build(written, runs_of_case(written).front());
  const RunResult a = run(one.model, one.plan, one.behaviours), b = run(two.model, two.plan, two.behaviours);
  ASSERT_EQ(to_string(a.status), "completed");
  EXPECT_EQ(a.table, b.table);
  ASSERT_EQ(one.motions.size(), 2u);
  EXPECT_EQ(one.motions[0].history->motion()->name, "strong");
  EXPECT_EQ(one.motions[1].history->motion()->name, "ey");
}

TEST_F(MotionCase, SummarisesTheCompletedRuns) {
  const Case file = read(tower(quick, moving_frame) + two_motions +
                         "[[compare.motion]]\nname = \"three\"\nreplace = [\"ey\"]\nby = [\"strong\"]\n[[compare.motion]]\nname = "
                         "\"four\"\nreplace = [\"ey\"]\nby = [\"ex\"]\n");
  std::vector<RunSpec> specs;
  std::deque<BuiltCase> built;
  std::vector<RunResult> results;
  const double moments[] = {-1, 2, 4, 1000};
  for (const RunSpec& spec : comparison_of_case(file).runs) {
    if (spec.bonded) continue;
    specs.push_back(spec);
    built.push_back(build(file, spec));
    RunResult& result = results.emplace_back();
    result.max_base_moment.value = moments[results.size() - 1];
    if (results.size() == 4) result.status = RunStatus::overturned;
  }
  const std::vector<MotionTable> tables = motion_tables(specs, built, results);
  ASSERT_EQ(tables.size(), 1u);
  const MotionTable& table = tables.front();
  EXPECT_EQ(table.run, "as in the case");
  ASSERT_EQ(table.rows.size(), 4u);
  EXPECT_EQ(table.rows[0].motion, "First motion");
  EXPECT_EQ(table.rows[3].status, RunStatus::overturned);
  EXPECT_EQ(table.counted, 3);
  const auto moment = std::ranges::find(table.quantities, "moment", &MotionTable::Quantity::key) - table.quantities.begin();
  ASSERT_LT(moment, std::ssize(table.quantities));
  EXPECT_EQ(table.rows[3].peaks[moment], 1000);
  EXPECT_EQ(table.envelope[moment], 4);
  EXPECT_NEAR(table.mean[moment], 7.0 / 3, 1e-15);
  EXPECT_NEAR(table.spread[moment], std::sqrt(7.0 / 3), 1e-15);  // (16/9 + 1/9 + 25/9)/2

  ComparisonSummary compared;
  compared.agreement.resize(results.size());
  compared.motions = tables;
  const auto json = nlohmann::json::parse(summary_json({Provenance(), results, Verdict(), {}, &compared}));
  const auto& written = json["over_motions"][0];
  EXPECT_EQ(written["motions"][2]["motion"], "three");
  EXPECT_EQ(written["motions"][1]["peaks"]["moment"], 2);
  EXPECT_EQ(written["counted"], 3);
  EXPECT_EQ(written["envelope"]["moment"], 4);
  EXPECT_EQ(written["units"]["moment"], "N m");
}

/// The page of a comparison is about the motion that does most, and says what the others do.
TEST(HardestMotion, ComesBeforeTheOthers) {
  RunResult small, large;
  small.max_uplifted_ratio.value = 0.2;
  large.max_uplifted_ratio.value = 0.3;
  const auto under = [](const std::string& motion, const RunResult& run, int broken, Verdict::Level level = Verdict::Level::uplift) {
    JudgedMotion judged{motion, &run, {}};
    judged.verdict.level = level;
    for (int i = 0; i < 2; ++i)
      judged.verdict.numbers.criteria.push_back(
          {.criterion = {}, .interface = "", .state = i < broken ? CriterionResult::State::not_met : CriterionResult::State::met});
    return judged;
  };
  EXPECT_EQ(hardest({under("a", small, 0), under("b", large, 0), under("c", large, 0)}), 1u);
  EXPECT_EQ(hardest({under("a", small, 1), under("b", large, 0)}), 0u);
  EXPECT_EQ(hardest({under("a", large, 2), under("b", small, 0, Verdict::Level::overturned)}), 1u);

  const MotionTable table{.run = "",
                          .damping = "",
                          .quantities = {{"ratio", "Uplifted", "1"}, {"opening", "Gap", "m"}},
                          .rows = {},
                          .counted = 2,
                          .envelope = {0.3, 0.004},
                          .mean = {0.25, 0.003},
                          .spread = {}};
  EXPECT_EQ(
      said_over_motions({under("a", small, 1), under("b", large, 2)}, table),
      "This page shows the most demanding of 2 motions, b. Mean and maximum over the 2 completed runs: uplifted 25 % and 30 %, gap 3.00 mm "
      "and 4.00 mm. Criteria that are not met, of 2: 1 under a, 2 under b.");
  EXPECT_TRUE(said_over_motions({under("a", small, 0), under("b", large, 0)}, table)
                  .ends_with("All criteria are met under each of the 2 motions."));
}

TEST_F(MotionCase, OneCompletedRunHasNoSpread) {
  const Case file = read(tower(quick, moving_frame) + two_motions);
  const RunSpec spec = comparison_of_case(file).runs.front();
  std::deque<BuiltCase> built;
  built.push_back(build(file, spec));
  RunResult result;
  result.max_base_shear.value = -3;
  const MotionTable table = motion_tables({spec}, built, {result}).front();
  const auto shear = std::ranges::find(table.quantities, "shear", &MotionTable::Quantity::key) - table.quantities.begin();
  EXPECT_EQ(table.mean[shear], 3);
  EXPECT_EQ(table.spread[shear], 0);
}

TEST_F(MotionCase, RefusesNamesThatDriveNothing) {
  const std::string good = tower(quick, moving_frame) + two_motions;
  const auto says = [&](const std::string& old, const std::string& with, const std::string& rest) {
    const std::string text = replaced(good, old, with);
    const std::string said = support::refusal_of([&] { comparison_of_case(read(text)); });
    EXPECT_EQ(said, name() + ":" + std::to_string(line_of(text, with)) + ": " + rest);
  };
  says("by = [\"ex\", \"ey\"]", "by = [\"ex\"]", "compare.motion[0].by: expected as many names as in replace (2), found 1");
  says("by = [\"strong\"]", "by = [\"storng\"]",
       "compare.motion[1].by: expected the name of a function or record, found \"storng\" (did you mean \"strong\"?)");
  says("replace = [\"ex\"]", "replace = [\"strong\"]",
       "compare.motion[1].replace: expected the name of a function or record of a ground acceleration, prescribed motion or incident wave, "
       "ex or ey, found \"strong\"");
  says("name = \"two\"", "name = \"to/\"",
       "compare.motion[1].name: expected letters, digits, '_', '-' and '.' (it names files; `label` may be anything), found \"to/\"");
}

TEST_F(MotionCase, SaysWhereTheMotionsComeFrom) {
  const Case file = read(tower(quick, moving_frame));
  const BuiltCase built = build(file, runs_of_case(file).front());
  EXPECT_EQ(input_files(file), (Texts{(folder_ / "ex.txt").string(), (folder_ / "ey.txt").string()}));
  const Histories motions = motions_of({{nullptr, &built, nullptr}, {nullptr, &built, nullptr}});
  ASSERT_EQ(motions.size(), 2u);
  const auto json = nlohmann::json::parse(summary_json({Provenance(), {}, Verdict(), motions}))["motions"];
  ASSERT_EQ(json.size(), 2u);
  EXPECT_EQ(json[0]["name"], "ex");
  EXPECT_EQ(json[0]["file"], "ex.txt");
  EXPECT_EQ(json[0]["sha256"], sha256(read_file(folder_ / "ex.txt")));
  EXPECT_EQ(json[0]["unit"], "m/s2");
  EXPECT_EQ(json[0]["factor"], 1);
  EXPECT_EQ(json[0]["count"], 151);
  EXPECT_NEAR(json[0]["step"].get<double>(), 0.02, 1e-15);
  double largest = 0;
  for (const double value : write_record("ex.txt", 0.02, 151, 1.3)) largest = std::max(largest, std::abs(value));
  EXPECT_NEAR(std::abs(json[0]["pga"]["value"].get<double>()), largest, 1e-15);
}

}  // namespace
}  // namespace uplift::motions_test
