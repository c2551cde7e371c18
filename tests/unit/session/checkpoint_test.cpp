#include "uplift/session/checkpoint.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>

#include "uplift/base/file.h"

// Checkpoints on disk: whole, or not used.
namespace uplift::checkpoint_test {
namespace {

namespace fs = std::filesystem;

CheckpointOrigin some_origin() {
  return {.verb = "run",
          .case_file = "tower/case.toml",
          .from_folder = "/home",
          .resolved = "title = \"tower\"\nstep = 0.002\n",
          .inputs = {{"soil.msh", "ab12"}},
          .program = "cd34",
          .processor = "some",
          .step_check = false};
}

RunState some_state(long step) {
  RunState state;
  state.step = step;
  state.march.state.displacement = Vector::LinSpaced(100, 0.1, 0.7);
  return state;
}

/// A folder of its own for every test.
class CheckpointFiles : public testing::Test {
 protected:
  CheckpointFiles() : root_(fs::temp_directory_path() / ("uplift checkpoints " + std::to_string(getpid()))) {
    fs::create_directories(root_);
  }
  ~CheckpointFiles() override { fs::remove_all(root_); }
  std::string results(const std::string& name) const { return (root_ / name).string(); }
  const fs::path root_;
};

TEST(Checkpoint, IsReadAsWritten) {
  const Checkpoint written{some_origin(), "as in the case", write_run_state(some_state(512)), {}};
  std::string why;
  const std::optional<Checkpoint> read = read_checkpoint(write_checkpoint(written), why);
  ASSERT_TRUE(read) << why;
  EXPECT_EQ(read->label, written.label);
  EXPECT_EQ(read->origin.case_file, "tower/case.toml");
  EXPECT_EQ(read->origin.inputs, written.origin.inputs);
  EXPECT_FALSE(read->origin.step_check);
  EXPECT_TRUE(read->state == written.state);
}

TEST(Checkpoint, IsRefusedWithAnyBitFlippedOrCutAnywhere) {
  const std::string bytes = write_checkpoint({some_origin(), "as in the case", write_run_state(some_state(512)), {}});
  std::mt19937 random(20261124);
  std::uniform_int_distribution<std::size_t> any_byte(0, bytes.size() - 1);
  std::string why;
  for (int i = 0; i < 10000; ++i) {
    std::string changed = bytes;
    changed[any_byte(random)] ^= static_cast<char>(1 << (i % 8));
    ASSERT_FALSE(read_checkpoint(changed, why)) << i;
    ASSERT_FALSE(why.empty());
  }
  for (std::size_t size = 0; size < bytes.size(); ++size) ASSERT_FALSE(read_checkpoint(std::string_view(bytes).substr(0, size), why));
}

TEST_F(CheckpointFiles, TheOneBeforeIsTakenWhereTheLastOneIsDamaged) {
  const ResultFolder folder(results("tower"));
  Checkpoints written(some_origin(), 60, folder, "");
  for (const long step : {256, 512, 768}) written.write("as in the case", some_state(step), nullptr);
  const std::string from = folder.working_path() + "/" + Checkpoints::subfolder;
  const ResultFolder next(results("next"));
  const auto step_of = [&] {
    Checkpoints read(some_origin(), 60, next, from);
    const std::optional<Checkpoints::Begin> begin = read.begin("as in the case");
    EXPECT_EQ(read.notes().empty(), begin && begin->state.step == 768);
    return begin ? begin->state.step : 0;
  };
  EXPECT_EQ(step_of(), 768);
  fs::resize_file(from + "/as_in_the_case.ckp", 1000);
  EXPECT_EQ(step_of(), 512);
  Checkpoints read(some_origin(), 60, next, from);
  EXPECT_FALSE(read.begin("bonded"));
  fs::resize_file(from + "/as_in_the_case.before.ckp", 0);
  EXPECT_THROW(Checkpoints(some_origin(), 60, next, from), InputError);
  written.remove();
  EXPECT_FALSE(fs::exists(from));
}

TEST_F(CheckpointFiles, OfAnotherCaseFileOrProgramAreRefused) {
  const ResultFolder folder(results("tower"));
  Checkpoints(some_origin(), 60, folder, "").write("as in the case", some_state(256), nullptr);
  const std::string from = folder.working_path() + "/" + Checkpoints::subfolder;
  const ResultFolder next(results("next"));
  const auto message = [&](const CheckpointOrigin& origin) -> std::string {
    try {
      const Checkpoints read(origin, 60, next, from);
      return read.notes().empty() ? "" : read.notes().front();
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(message(some_origin()), "");
  CheckpointOrigin other = some_origin();
  other.resolved = "title = \"tower\"\nstep = 0.004\n";
  EXPECT_NE(message(other).find("found `step = 0.004` instead of `step = 0.002`"), std::string::npos) << message(other);
  other = some_origin();
  other.inputs[0].second = "ab13";
  EXPECT_NE(message(other).find("another content of \"soil.msh\""), std::string::npos) << message(other);
  other = some_origin();
  other.program = "cd35";
  EXPECT_NE(message(other).find("expected the program that wrote the checkpoint"), std::string::npos) << message(other);
  other = some_origin();
  other.processor = "another";
  EXPECT_NE(message(other).find("not bit for bit"), std::string::npos) << message(other);
}

TEST_F(CheckpointFiles, ThatCannotBeWrittenAreSaidToBeSo) {
  const ResultFolder folder(results("tower"));
  std::ofstream(folder.working_path() + "/" + Checkpoints::subfolder) << "a file in the place of the folder";
  Checkpoints written(some_origin(), 60, folder, "");
  written.write("as in the case", some_state(256), nullptr);
  ASSERT_EQ(written.notes().size(), 1u);
  EXPECT_NE(written.notes().front().find("could not be written"), std::string::npos);
}

TEST_F(CheckpointFiles, TheNewestOnesAreFound) {
  const auto age = [](const fs::path& path, int minutes) {
    fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::minutes(minutes));
  };
  const auto make = [&](const std::string& name, int minutes) {
    const fs::path folder = root_ / name / Checkpoints::subfolder;
    fs::create_directories(folder);
    std::ofstream(folder / "as_in_the_case.ckp") << "some";
    age(folder / "as_in_the_case.ckp", minutes);
    return folder.string();
  };
  const auto summary = [&](int minutes) {
    std::ofstream(root_ / "tower" / "summary.json") << "{}";
    age(root_ / "tower" / "summary.json", minutes);
  };
  EXPECT_THROW(checkpoints_at(results("tower")), InputError);
  const std::string killed = make("tower.part-999999", 10);
  EXPECT_EQ(checkpoints_at(results("tower")), killed);
  EXPECT_EQ(checkpoints_at(results("tower") + "/"), killed);
  make("tower.part-999998", 20);
  make("tower2.part-999997", 1);
  EXPECT_EQ(checkpoints_at(results("tower")), killed);
  const std::string interrupted = make("tower", 6);  // its checkpoints are older than its results
  summary(5);
  EXPECT_EQ(checkpoints_at(results("tower")), interrupted);
  age(killed + "/as_in_the_case.ckp", 1);  // resumed, and killed then
  EXPECT_EQ(checkpoints_at(results("tower")), killed);
  fs::remove_all(interrupted);
  summary(0);  // complete
  EXPECT_THROW(checkpoints_at(results("tower")), InputError);
  summary(15);  // of an earlier run
  EXPECT_EQ(checkpoints_at(results("tower")), killed);
  const FolderLock running(killed);
  EXPECT_FALSE(running.is_taken());
  EXPECT_THROW(checkpoints_at(results("tower")), InputError);
}

TEST_F(CheckpointFiles, OnesThatWereNotWrittenLeaveNoFolder) {
  const ResultFolder folder(results("tower"));
  { const Checkpoints none(some_origin(), 60, folder, ""); }
  EXPECT_FALSE(fs::exists(folder.working_path() + "/" + Checkpoints::subfolder));
}

}  // namespace
}  // namespace uplift::checkpoint_test
