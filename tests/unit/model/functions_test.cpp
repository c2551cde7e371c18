#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "unit/model/model_support.h"
#include "uplift/model/function_jumps.h"

namespace uplift::functions_test {
namespace {

using std::numbers::pi;

Raw raw(decltype(Raw::data) data) {
  return {std::move(data), {"case.toml", 3}, "function[0]"};
}

std::unique_ptr<const TimeFunction> make(std::vector<std::pair<std::string, Raw>> entries) {
  for (auto& [key, value] : entries) value.path = "function[0]." + key;
  Raw table = raw(std::make_shared<RawTable>(RawTable{std::move(entries)}));
  return make_part(function_catalog(), check_part(table, time_functions()));
}

Raw number_list(const std::vector<double>& values) {
  RawList list;
  for (const double value : values) list.push_back(raw(value));
  return raw(std::move(list));
}

void expect_derivatives(const TimeFunction& f, const std::vector<double>& times) {
  const double h = 1e-5;
  for (const double t : times) {
    EXPECT_NEAR(f.rate(t), (f.value(t + h) - f.value(t - h)) / (2 * h), 1e-6 * (1 + std::abs(f.rate(t)))) << t;
    EXPECT_NEAR(f.acceleration(t), (f.rate(t + h) - f.rate(t - h)) / (2 * h), 1e-6 * (1 + std::abs(f.acceleration(t)))) << t;
  }
}

TEST(TimeFunctions, TheCatalogHoldsThemAll) {
  std::vector<std::string_view> names;
  for (const PartInfo* info : time_functions()) names.push_back(info->name);
  const std::vector<std::string_view> expected{"constant", "half_sine", "ramp", "ricker", "harmonic", "table", "csv"};
  EXPECT_EQ(names, expected);
}

/// A run of 0.1 s steps does not end at 1 s but 1.1e-16 s beside it; a step further the table is zero.
TEST(TimeFunctions, ATableKeepsItsEndsAtRoundOff) {
  double end = 0;
  for (int i = 0; i < 3; ++i) end += 0.1;
  ASSERT_GT(end, 0.3);
  const auto table = make({{"type", raw(std::string("table"))},
                           {"times", number_list({0.1, 0.2, 0.3})},
                           {"values", number_list({4, 5, 7})},
                           {"outside", raw(std::string("zero"))}});
  EXPECT_EQ(table->value(end), 7);
  EXPECT_EQ(table->value(0.1 - 1e-16), 4);
  EXPECT_EQ(table->value(0.3001), 0);
  EXPECT_EQ(table->value(0.0999), 0);
  const std::vector<FunctionJump> jumps = jumps_of(*table);
  ASSERT_EQ(jumps.size(), 2u);
  EXPECT_EQ(jumps[0].time, 0.1);
  EXPECT_EQ(jumps[0].after, 4);
  EXPECT_EQ(jumps[1].time, 0.3);
  EXPECT_EQ(jumps[1].before, 7);
  EXPECT_TRUE(jumps_of(*make({{"type", raw(std::string("constant"))}})).empty());
}

TEST(TimeFunctions, ClosedForms) {
  const auto constant = make({{"type", raw(std::string("constant"))}, {"value", raw(2.5)}});
  EXPECT_EQ(constant->value(-7), 2.5);
  EXPECT_EQ(constant->rate(3), 0);

  const auto pulse = make({{"type", raw(std::string("half_sine"))}, {"amplitude", raw(4.0)}, {"duration", raw(0.1)}, {"start", raw(0.2)}});
  EXPECT_EQ(pulse->value(0.19), 0);
  EXPECT_EQ(pulse->value(0.31), 0);
  EXPECT_NEAR(pulse->value(0.25), 4, 1e-14);
  EXPECT_NEAR(pulse->value(0.2 + 0.1 / 6), 2, 1e-14);
  expect_derivatives(*pulse, {0.1, 0.21, 0.25, 0.29, 0.4});

  const auto ramp =
      make({{"type", raw(std::string("ramp"))}, {"from", raw(1.0)}, {"to", raw(3.0)}, {"start", raw(2.0)}, {"duration", raw(4.0)}});
  EXPECT_EQ(ramp->value(1), 1);
  EXPECT_NEAR(ramp->value(3), 1.5, 1e-15);
  EXPECT_EQ(ramp->value(9), 3);
  expect_derivatives(*ramp, {1, 3, 5, 8});

  const auto ricker = make({{"type", raw(std::string("ricker"))}, {"amplitude", raw(2.0)}, {"frequency", raw(3.0)}});
  EXPECT_NEAR(ricker->value(0.5), 2, 1e-15);  // the peak is at 1.5/f
  EXPECT_NEAR(ricker->value(0), 0, 1e-7);
  EXPECT_NEAR(ricker->value(0.5 + 1 / (3 * pi * std::sqrt(2.0))), 0, 1e-14);  // zeros at s^2 = 1/2
  expect_derivatives(*ricker, {0.1, 0.4, 0.5, 0.63, 0.9});

  const auto wave = make(
      {{"type", raw(std::string("harmonic"))}, {"frequency", raw(2.0)}, {"phase", raw(pi / 2)}, {"start", raw(1.0)}, {"end", raw(3.0)}});
  EXPECT_NEAR(wave->value(1), 1, 1e-15);
  EXPECT_NEAR(wave->value(1.25), -1, 1e-14);
  EXPECT_EQ(wave->value(3.1), 0);
  expect_derivatives(*wave, {0.5, 1.1, 2.9, 3.5});
}

TEST(TimeFunctions, Table) {
  const auto held = make({{"type", raw(std::string("table"))}, {"times", number_list({0, 1, 3})}, {"values", number_list({2, 4, 0})}});
  EXPECT_EQ(held->value(-1), 2);
  EXPECT_EQ(held->value(0.5), 3);
  EXPECT_EQ(held->value(1), 4);
  EXPECT_EQ(held->value(2), 2);
  EXPECT_EQ(held->value(3), 0);
  EXPECT_EQ(held->value(7), 0);
  for (const auto& [t, rate] : {std::pair{-1.0, 0.0}, {0.5, 2.0}, {1.0, -2.0}, {2.0, -2.0}, {3.0, -2.0}, {4.0, 0.0}})
    EXPECT_EQ(held->rate(t), rate);
  // The slope jumps from 2 to -2 at 1: a triangle over both pieces, 3 s long, with the area -4.
  for (const auto& [t, acceleration] : {std::pair{-1.0, 0.0}, {0.0, 0.0}, {0.5, -4.0 / 3}, {1.0, -8.0 / 3}, {2.0, -4.0 / 3}, {3.0, 0.0}})
    EXPECT_NEAR(held->acceleration(t), acceleration, 1e-15);
  const auto cut = make({{"type", raw(std::string("table"))},
                         {"times", number_list({0, 1})},
                         {"values", number_list({2, 4})},
                         {"outside", raw(std::string("zero"))}});
  EXPECT_EQ(cut->value(1), 4);
  EXPECT_EQ(cut->value(1.1), 0);
  EXPECT_NE(support::refusal([] {
              make({{"type", raw(std::string("table"))}, {"times", number_list({0, 2, 1})}, {"values", number_list({2, 4, 0})}});
            }).find("function[0].times: expected times in ascending order, found 1 s after 2 s"),
            std::string::npos);
  EXPECT_NE(support::refusal([] {
              make({{"type", raw(std::string("table"))}, {"times", number_list({0, 2})}, {"values", number_list({2})}});
            }).find("function[0].values: expected as many values as times (2), found 1"),
            std::string::npos);
}

class Csv : public testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::path(testing::TempDir()) / ("uplift_csv_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name) << text;
    return (folder / name).string();
  }
  std::unique_ptr<const TimeFunction> read(const std::string& path, std::vector<std::pair<std::string, Raw>> more = {}) const {
    std::vector<std::pair<std::string, Raw>> entries{{"type", raw(std::string("csv"))}, {"file", raw(path)}};
    for (auto& entry : more) entries.push_back(entry);
    return make(std::move(entries));
  }
  std::filesystem::path folder;
};

TEST_F(Csv, ReadsColumnsByNameOrNumber) {
  const std::string file = write("record.csv", "# a comment\n\ntime, noise, accel\n0, 9, 10\n20, 9, 30\n40, 9, -1e1\n");
  const auto f = read(file, {{"time_column", raw(std::string("time"))},
                             {"value_column", raw(std::string("accel"))},
                             {"time_unit", raw(std::string("ms"))},
                             {"unit", raw(std::string("cm/s2"))},
                             {"scale", raw(2.0)}});
  EXPECT_NEAR(f->value(0.01), 2 * 0.2, 1e-15);
  EXPECT_NEAR(f->rate(0.03), 2 * -0.4 / 0.02, 1e-12);
  EXPECT_EQ(f->value(0.05), 0);  // zero after the end of a record
  const auto blanks = read(write("plain.dat", "  0.0   1.0\n  0.5\t2.0 \n"), {{"unit", raw(std::string("g_n"))}});
  EXPECT_NEAR(blanks->value(0.25), 1.5 * 9.80665, 1e-12);
}

TEST_F(Csv, ReadsDecimalCommasBetweenSemicolons) {
  const auto f = read(write("comma.csv", "t;a\n0;0,5\n1;-1,25\n2,5;0\n"));
  EXPECT_EQ(f->value(0), 0.5);
  EXPECT_EQ(f->value(1), -1.25);
  EXPECT_NEAR(f->value(1.6), -0.75, 1e-15);
}

TEST_F(Csv, TakesNoMarkOfTheByteOrderForAHead) {
  const auto f = read(write("mark.csv",
                            "\xEF\xBB\xBF"
                            "0,2\n1,4\n"));
  EXPECT_EQ(f->value(0), 2);
  EXPECT_EQ(f->value(0.5), 3);
}

TEST_F(Csv, ErrorsPointToTheLine) {
  const auto message = [&](const std::string& path, std::vector<std::pair<std::string, Raw>> more = {}) {
    return support::refusal([&] { read(path, more); });
  };
  const std::string bad = write("bad.csv", "t,a\n0,1\n1,x\n"), back = write("back.csv", "0,1\n1,2\n1,3\n"),
                    cells = write("cells.csv", "0,1\n1\n"), one = write("one.csv", "t,a\n0,1\n");
  EXPECT_EQ(message(bad), bad + ":3: expected a number in column 2, found \"x\"");
  EXPECT_EQ(message(back), back + ":3: expected times in ascending order, found 1 s after 1 s");
  EXPECT_EQ(message(cells), cells + ":2: expected at least 2 columns, found 1");
  EXPECT_EQ(message(one), one + ":2: expected at least two rows of numbers, found 1");
  EXPECT_NE(message(bad, {{"value_column", raw(std::string("b"))}})
                .find("case.toml:3: function[0].value_column: expected a column of " + bad + ":1"),
            std::string::npos);
  EXPECT_NE(message((folder / "missing.csv").string()).find("case.toml:3: function[0].file: expected a file, found"), std::string::npos);
  EXPECT_NE(
      message(bad, {{"unit", raw(std::string("furlong/s3"))}}).find("case.toml:3: function[0].unit: expected a unit that converts to"),
      std::string::npos);
}

}  // namespace
}  // namespace uplift::functions_test
