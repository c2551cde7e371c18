#include "uplift/ensemble/compute.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tower_case.h"

// What computes the runs of a study tells how far they are, and ends those that are no longer wanted as if their motions were shorter.
namespace uplift::compute_test {
namespace {

namespace fs = std::filesystem;

class StudyOfTower : public testing::Test {
 protected:
  StudyOfTower() : folder_(fs::temp_directory_path() / ("uplift_compute_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_ / "s.study");
    std::ofstream record(folder_ / "quake.csv");
    record << "t [s],a [m/s2]\n";
    for (int i = 0; i <= 400; ++i) record << fmt::format("{:.3f},{:.9f}\n", 0.01 * i, 4 * std::sin(2 * 3.14159265 * 0.02 * i));
  }
  ~StudyOfTower() override { fs::remove_all(folder_); }
  StudyOfTower(const StudyOfTower&) = delete;
  StudyOfTower& operator=(const StudyOfTower&) = delete;

  /// `durations`: of the dynamic stages [s].
  Study study(const std::vector<double>& durations) const {
    std::string text = "title = \"tower\"\n" + support::Tower().text() + support::weight + R"(
[[interface]]
name = "soil"
[interface.footing]
body = "base"
width = 3
points = 11
[interface.law]
type = "springs"
K_n = 2e7
[[record]]
name = "quake"
file = "quake.csv"
[[ground_acceleration]]
direction = [1, 0]
function = "quake"
[[stage]]
type = "static"
)";
    for (const double duration : durations) text += fmt::format("[[stage]]\ntype = \"dynamic\"\nduration = {}\nstep = 1e-3\n", duration);
    std::ofstream(folder_ / "case.toml") << text;
    std::ofstream(folder_ / "s.study/plan.toml") << R"(case = "../case.toml"
[intensity]
measure = "factor"
[method]
type = "stripes"
levels = [1.0]
[[limit]]
name = "uplift"
quantity = "max_opening"
limit = "1 mm"
)";
    return open_study((folder_ / "s.study").string());
  }

  static RunRequest request(const std::string& id) {
    RunRequest made;
    made.id = id;
    return made;
  }

 private:
  fs::path folder_;
};

double number(const StudyResult& result, const std::string& quantity) {
  for (const StudyNumber& each : result.numbers)
    if (each.quantity == quantity) return each.value;
  return std::nan("");
}

// Of all its stages together.
TEST_F(StudyOfTower, TellsHowFarARunIs) {
  const Study whole = study({1, 3});
  StudyComputer computer(whole);
  std::vector<double> told;
  std::vector<StudyResult> results;
  computer.compute(
      std::vector{request("a")}, [&](const StudyResult& result) { results.push_back(result); },
      [&](double marched) {
        told.push_back(marched);
        return true;
      });
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].outcome, StudyOutcome::completed);
  ASSERT_GE(told.size(), 2U);
  for (std::size_t i = 0; i < told.size(); ++i) {
    EXPECT_GT(told[i], i > 0 ? told[i - 1] : 0);
    EXPECT_LE(told[i], 1);
  }
  EXPECT_GT(told.back(), 0.9);
}

// The first run of two is ended; the second one is computed to its end, and the first has the numbers of a motion that ends there.
TEST_F(StudyOfTower, AnEndedRunIsThatOfAShorterMotion) {
  std::vector<StudyResult> results;
  const Study whole = study({4});
  StudyComputer computer(whole);
  computer.compute(
      std::vector{request("a"), request("b")}, [&](const StudyResult& result) { results.push_back(result); },
      [&](double marched) { return !results.empty() || marched < 0.5; });
  ASSERT_EQ(results.size(), 2U);
  EXPECT_EQ(results[0].outcome, StudyOutcome::completed);
  EXPECT_LT(results[0].end_time, 3);
  EXPECT_NEAR(results[1].end_time, 4, 1e-9);
  EXPECT_EQ(results[1].outcome, StudyOutcome::completed);
  const Study shorter = study({results[0].end_time});
  StudyComputer again(shorter);
  const StudyResult expected = again.compute(request("c"));
  EXPECT_EQ(expected.steps, results[0].steps);
  for (const char* quantity : {"max_opening", "max_moment"}) {
    EXPECT_GT(number(expected, quantity), 0) << quantity;
    EXPECT_EQ(number(results[0], quantity), number(expected, quantity)) << quantity;
  }
}

}  // namespace
}  // namespace uplift::compute_test
