#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "uplift/base/error.h"
#include "uplift/base/file.h"
#include "uplift/io/files.h"
#include "uplift/io/report/parts.h"
#include "uplift/io/report/report.h"
#include "uplift/io/results/histories.h"
#include "uplift/io/results/summary.h"
#include "uplift/io/text/json_writer.h"
#include "uplift/io/text/numbers.h"

namespace uplift::output_test {
namespace {

std::string number(double value, int digits = 10) {
  std::string text;
  append_number(text, value, digits);
  return text;
}

TEST(Numbers, AreShortAndPlain) {
  EXPECT_EQ(number(0), "0");
  EXPECT_EQ(number(-1), "-1");
  EXPECT_EQ(number(300000), "300000");
  EXPECT_EQ(number(0.1 + 0.2), "0.3");
  EXPECT_EQ(number(-0.0358759137), "-0.0358759137");
  EXPECT_EQ(number(0.001, 6), "0.001");
  EXPECT_EQ(number(1.25e-7, 6), "1.25e-07");
  EXPECT_EQ(number(123456.5, 6), "123456");  // a tie goes to the even digit
  EXPECT_EQ(number(9999999.5, 7), "1e+07");
  EXPECT_EQ(number(99999.99, 6), "100000");
  EXPECT_EQ(number(5e-324), "4.940656458e-324");
  EXPECT_EQ(number(-0.0), "0");
}

TEST(Numbers, InALineHaveCommasBetweenThemHoweverMany) {
  std::vector<double> values;
  std::string wanted, text = "[";
  for (int i = 0; i < 500; ++i) {
    values.push_back(i % 7 == 0 ? std::nan("") : i - 250.5);
    wanted += (i > 0 ? "," : "") + (i % 7 == 0 ? "null" : number(values.back()));
  }
  append_numbers(text, values);
  EXPECT_EQ(text, "[" + wanted);
  append_numbers(text, {});
  EXPECT_EQ(text, "[" + wanted);
}

RC_GTEST_PROP(Numbers, ReadBackWithinHalfAUnitOfTheLastDigit, ()) {
  const double mantissa = *rc::gen::inRange<int>(-1000000000, 1000000000) * 1e-9 + 1e-17;
  const int exponent = *rc::gen::inRange(-250, 250), digits = *rc::gen::inRange(1, 16);
  const double value = mantissa * std::pow(10.0, exponent);
  RC_PRE(value != 0);
  const double back = std::strtod(number(value, digits).c_str(), nullptr);
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - digits + 1);
  RC_ASSERT(std::abs(back - value) <= 0.5000001 * unit + 1e-15 * std::abs(value));
}

RC_GTEST_PROP(Numbers, ExactOnesReadBackToTheSameBits, (double value)) {
  RC_PRE(std::isfinite(value));
  std::string text;
  append_exact(text, value);
  RC_ASSERT(std::strtod(text.c_str(), nullptr) == value);
}

TEST(Hash, MatchesTheStandardsExamples) {
  // FIPS 180-4, examples of NIST
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST(JsonWriterTest, EscapesAndNests) {
  JsonWriter json(0, 2);
  json.begin_object().member("text", "a \"b\"\n\\ \x01").member("truth", true).member("whole", 3).member("real", 0.1);
  json.member("lost", std::numeric_limits<double>::quiet_NaN())
      .key("list")
      .numbers(std::vector<double>{1, 2.5, INFINITY})
      .key("empty")
      .begin_array()
      .end_array()
      .end_object();
  const auto read = nlohmann::json::parse(json.take());
  EXPECT_EQ(read["text"], "a \"b\"\n\\ \x01");
  EXPECT_EQ(read["truth"], true);
  EXPECT_EQ(read["whole"], 3);
  EXPECT_EQ(read["real"], 0.1);
  EXPECT_TRUE(read["lost"].is_null());
  EXPECT_EQ(read["list"].dump(), "[1,2.5,null]");
  EXPECT_TRUE(read["empty"].empty());
}

RunResult small_result() {
  RunResult result;
  result.name = "run";
  Request column;
  column.name = "top.ux";
  column.unit = "m";
  result.columns = {column};
  result.table = {{0, 0.5, 1}, {0, -2e-3, std::numeric_limits<double>::quiet_NaN()}};
  return result;
}

TEST(Histories, QuoteTheirHead) {
  RunResult result = small_result();
  result.columns[0].name = "moment, \"top\"";
  EXPECT_EQ(histories_csv(result), "time [s],\"moment, \"\"top\"\" [m]\"\n0,0\n0.5,-0.002\n");
}

TEST(Histories, HaveUnitsAndNoRowThatIsNotFinite) {
  EXPECT_EQ(histories_csv(small_result()), "time [s],top.ux [m]\n0,0\n0.5,-0.002\n");
}

TEST(Thinning, LeavesOutWhatIsNotFinite) {
  std::vector<double> x, y, thin_x, thin_y;
  for (int i = 0; i < 1000; ++i) x.push_back(i), y.push_back(i % 3 == 0 ? std::nan("") : i == 500 ? 7 : std::sin(i));
  y.back() = std::numeric_limits<double>::infinity();
  thin_history(x, y, 100, thin_x, thin_y);
  EXPECT_LE(thin_y.size(), 100u);
  EXPECT_EQ(std::ranges::max(thin_y), 7);
  EXPECT_TRUE(std::ranges::all_of(thin_y, [](double value) { return std::isfinite(value); }));
  EXPECT_EQ(thin_x.size(), thin_y.size());
}

TEST(Thinning, KeepsEveryPeak) {
  std::vector<double> x, y;
  for (int i = 0; i < 20000; ++i) {
    x.push_back(i);
    y.push_back(std::sin(0.01 * i));
  }
  y[7777] = 5;  // one step high
  y[12345] = -7;
  thin_history(x, y, 1500);
  EXPECT_LE(y.size(), 1500u);
  EXPECT_EQ(*std::max_element(y.begin(), y.end()), 5);
  EXPECT_EQ(*std::min_element(y.begin(), y.end()), -7);
  EXPECT_TRUE(std::is_sorted(x.begin(), x.end()));
  EXPECT_EQ(x[static_cast<std::size_t>(std::max_element(y.begin(), y.end()) - y.begin())], 7777);
}

class Folder : public testing::Test {
 protected:
  void SetUp() override {
    root_ = std::filesystem::temp_directory_path() / ("uplift_results_" + std::to_string(getpid()));
    std::filesystem::create_directories(root_);
  }
  void TearDown() override { std::filesystem::remove_all(root_); }
  std::string path(const char* name) const { return (root_ / name).string(); }
  std::filesystem::path root_;
};

TEST_F(Folder, AppearsOnlyWhenItIsFinished) {
  ResultFolder folder(path("out/r"));
  folder.write("a/b.txt", "text");
  EXPECT_FALSE(std::filesystem::exists(path("out/r")));
  EXPECT_EQ(folder.finish(), "");
  EXPECT_EQ(read_file(path("out/r/a/b.txt")), "text");
}

TEST_F(Folder, LeavesNothingWithoutFiles) {
  { ResultFolder(path("r")).place("fields/run.h5"); }
  EXPECT_TRUE(std::filesystem::is_empty(root_));
}

TEST_F(Folder, KeepsFilesWhenItIsNotFinished) {
  std::string work;
  {
    ResultFolder folder(path("r"));
    folder.write("a.txt", "text");
    EXPECT_TRUE(folder.has_files());
    work = folder.working_path();
  }
  EXPECT_EQ(read_file(work + "/a.txt"), "text");
  ResultFolder next(path("r"));  // of the same process: its folder has another name
  EXPECT_NE(next.working_path(), work);
}

TEST_F(Folder, WritesWhatItCanAndReportsTheRest) {
  ResultFolder folder(path("r"));
  std::filesystem::create_directories(std::filesystem::path(folder.working_path()) / "taken");
  folder.write("taken", "a folder has this name");
  folder.write("histories.csv", "text");
  try {
    folder.finish();
    FAIL();
  } catch (const OutputError& error) {
    EXPECT_EQ(std::string(error.what()), path("r/taken") + ": cannot write the file: Is a directory");
  }
  EXPECT_EQ(read_file(folder.working_path() + "/histories.csv"), "text");
  EXPECT_FALSE(std::filesystem::exists(path("r")));
}

TEST_F(Folder, ResolvesLinksAndDots) {
  std::filesystem::create_directories(root_ / "disk");
  std::filesystem::create_symlink("disk", path("link"));
  EXPECT_EQ(ResultFolder(path("link")).path(), std::filesystem::canonical(root_ / "disk").string());
  EXPECT_EQ(ResultFolder(path("disk/.")).path(), path("disk"));
  EXPECT_EQ(ResultFolder(path("disk/")).path(), path("disk"));
  EXPECT_EQ(ResultFolder(path("link/r/")).path(), path("link/r"));
}

TEST_F(Folder, MovesEarlierResultsAside) {
  for (const std::string& expected : {std::string(), path("r.1"), path("r.2")}) {
    ResultFolder folder(path("r"));
    folder.write("summary.json", expected);
    EXPECT_EQ(folder.finish(), expected);
  }
  EXPECT_EQ(read_file(path("r.1/summary.json")), "");
  EXPECT_EQ(read_file(path("r.2/summary.json")), path("r.1"));
}

TEST_F(Folder, MovesNothingThatIsNotResults) {
  std::filesystem::create_directories(root_ / "tower");
  write_file_atomically(path("tower/case.toml"), "title = \"mine\"");
  const auto refusal = [this](const char* name) -> std::string {
    try {
      ResultFolder folder(path(name));
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal("tower"),
            path("tower") +
                ": expected a new folder for the results, or one with earlier results, found a folder with something else "
                "in it (it has no summary.json)");
  EXPECT_EQ(refusal("tower/case.toml"), path("tower/case.toml") + ": expected a folder for the results, found a file");
  std::filesystem::create_directories(root_ / "empty");
  ResultFolder folder(path("empty"));
  EXPECT_EQ(folder.finish(), "");
  EXPECT_TRUE(std::filesystem::exists(root_ / "tower/case.toml"));
}

TEST_F(Folder, RefusesAPlaceThatCannotBeMade) {
  EXPECT_THROW(ResultFolder("/proc/uplift/r"), InputError);
}

// That the data decode to the same document is tested from outside: report_of() in tests/cli/support.py.
TEST(ReportPage, HoldsCompressedDataInPlaceOfThePlaceholder) {
  std::string json = "{\"a\":\"</script>\",\"numbers\":[";
  for (int i = 0; i < 2000000; ++i) json += std::to_string(i % 7) + ",";  // 4 MB: smaller ones are stored as they are
  json += "0]}";
  const std::string page = report_page(json);
  if (report_template().empty()) {
    EXPECT_TRUE(page.empty());
    GTEST_SKIP() << "built without web/dist/report.html";
  }
  EXPECT_EQ(page.find("/*UPLIFT_DATA*/"), page.npos);
  const std::size_t begin = report_template().find("/*UPLIFT_DATA*/"), end = page.find('<', begin);
  EXPECT_LT(end - begin, json.size() / 20);  // seven digits that repeat
}

}  // namespace
}  // namespace uplift::output_test
