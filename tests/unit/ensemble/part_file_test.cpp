#include "uplift/ensemble/part_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "uplift/ensemble/store.h"

// Parts of a study: what a line keeps, and which of several lines counts.
namespace uplift::part_file_test {
namespace {

StudyResult result(const std::string& id, StudyOutcome outcome = StudyOutcome::completed, long attempt = 1) {
  StudyResult made;
  made.id = id;
  made.motion = "a \"motion\"";
  made.factor = 0.1 + 0.2;
  made.intensity = 1e-300;
  made.outcome = outcome;
  made.reason = "line\nbreak";
  made.attempt = attempt;
  made.numbers = {{"max_opening", "soil", 1.0 / 3}};
  made.spectra = {{"top", 0.05, {1, 2}, {0.1, 7}}};
  made.steps = 12;
  return made;
}

std::string without_end(std::string line) {
  EXPECT_EQ(line.find('\n'), line.size() - 1);
  line.pop_back();
  return line;
}

TEST(PartFile, ALineKeepsEveryBit) {
  const std::string line = without_end(line_of(result("id")));
  const std::optional<StudyResult> read = read_line(line);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->factor, 0.1 + 0.2);
  EXPECT_EQ(read->intensity, 1e-300);
  EXPECT_EQ(read->reason, "line\nbreak");
  EXPECT_EQ(read->numbers.at(0).value, 1.0 / 3);
  EXPECT_EQ(read->spectra.at(0).values, (std::vector<double>{0.1, 7}));
  EXPECT_EQ(without_end(line_of(*read)), line);
}

TEST(PartFile, EveryFlippedBitAndEveryCutIsNoticed) {
  const std::string line = without_end(line_of(result("id")));
  for (std::size_t at = 0; at < line.size(); ++at) {
    EXPECT_FALSE(read_line(line.substr(0, at))) << at;
    for (int bit = 0; bit < 8; ++bit) {
      std::string changed = line;
      changed[at] = static_cast<char>(changed[at] ^ (1 << bit));
      EXPECT_FALSE(read_line(changed)) << at << " " << bit;
    }
  }
}

class Store : public testing::Test {
 protected:
  Store() : folder_(std::filesystem::temp_directory_path() / ("uplift_store_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_ / "parts");
  }
  ~Store() override { std::filesystem::remove_all(folder_); }
  void part(const std::string& name, const std::string& text) const { std::ofstream(folder_ / "parts" / name) << text; }
  StudyStore store() const { return StudyStore(folder_.string()); }
  std::filesystem::path folder_;
};

TEST_F(Store, OneResultARunWhateverTheOrder) {
  const std::string timeout = line_of(result("a", StudyOutcome::timeout)), again = line_of(result("a", StudyOutcome::completed, 2)),
                    same = line_of(result("a", StudyOutcome::failed, 2));
  for (const auto& [first, second] :
       {std::pair(timeout + again, same), std::pair(same, again + timeout), std::pair(again + same, timeout)}) {
    part("1.jsonl", first);
    part("2.jsonl", second);
    const StudyStore read = store();
    EXPECT_EQ(read.size(), 1U);
    EXPECT_EQ(read.repeated(), 2U);
    EXPECT_EQ(read.find("a")->outcome, StudyOutcome::completed);
  }
}

TEST_F(Store, TornLinesAreIgnoredAndDamagedOnesCounted) {
  std::string damaged = line_of(result("b"));
  damaged[10] = '?';
  part("1.jsonl", line_of(result("a")) + damaged + "\n" + line_of(result("c")) + line_of(result("d")).substr(0, 50));
  const StudyStore read = store();
  EXPECT_EQ(read.size(), 2U);
  EXPECT_EQ(read.damaged(), 1U);
  EXPECT_EQ(read.find("b"), nullptr);
  EXPECT_NE(read.find("c"), nullptr);
}

TEST_F(Store, WhatAKilledProcessWroteIsNotContinued) {
  PartFile(folder_ / "parts").append(line_of(result("a")).substr(0, 40));  // a process with this number, killed
  PartFile next(folder_ / "parts");
  next.append(line_of(result("b")));
  next.sync();
  EXPECT_NE(store().find("b"), nullptr);
}

TEST_F(Store, ForgottenRunsKeepTheirAttempts) {
  part("1.jsonl", line_of(result("a", StudyOutcome::memory, 2)) + line_of(result("b")));
  StudyStore read = store();
  EXPECT_EQ(read.forget_failed(), 1U);
  EXPECT_EQ(read.find("a"), nullptr);
  EXPECT_EQ(read.attempts("a"), 2);
  EXPECT_EQ(read.attempts("b"), 1);
  EXPECT_EQ(read.attempts("c"), 0);
}

}  // namespace
}  // namespace uplift::part_file_test
