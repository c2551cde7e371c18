// What readers of records refuse, and what they mend: every message, word by word.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "unit/motion/files.h"
#include "uplift/base/error.h"
#include "uplift/motion/formats/read.h"

namespace uplift::repairs_test {
namespace {

using namespace sample;
using Texts = std::vector<std::string>;

Motion one(const std::string& text, const RecordOptions& options = {}) {
  const std::vector<Motion> motions = read_motions_from(text, "file", options);
  EXPECT_EQ(motions.size(), 1u);
  return motions.at(0);
}

std::string refusal(const std::string& text, const RecordOptions& options = {}) {
  try {
    read_motions_from(text, "file", options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// 25 numbers 1, 2, ... 25 thousandths of g on lines 5 to 9, under any line of counts.
std::string ramp(const std::string& counts) {
  std::vector<double> values;
  for (int i = 1; i <= 25; ++i) values.push_back(0.001 * i);
  return peer(values, counts).text;
}
const std::string sound = "NPTS= 25, DT= .01 SEC";

/// A table of 25 rows "time,value".
std::string table(const std::vector<double>& times) {
  std::string text = "time [s],a [g]\n";
  for (const double time : times) text += fmt::format("{:g},{:g}\n", time, time / 10);
  return text;
}
std::vector<double> equal_times(double from = 0) {
  std::vector<double> times;
  for (int i = 0; i < 25; ++i) times.push_back(from + 0.01 * i);
  return times;
}

TEST(RecordRefusals, StepAndNumberOfPoints) {
  EXPECT_EQ(refusal(ramp("NPTS= 25, DT= 0 SEC")), "file:4: expected a time step from 1e-07 s to 1e+06 s, found 0 s");
  EXPECT_EQ(refusal(ramp("NPTS= 25, DT= -.01 SEC")), "file:4: expected a time step from 1e-07 s to 1e+06 s, found -0.01 s");
  EXPECT_EQ(refusal(ramp("NPTS= 1000000000, DT= .01 SEC")), "file:4: expected 1000000000 points, as announced here, found 25");
  EXPECT_EQ(refusal(ramp("NPTS= 20, DT= .01 SEC")), "file:4: expected 20 points, as announced here, found 25");
  EXPECT_EQ(refusal(ramp("NPTS= 1, DT= .01 SEC")), "file:4: expected at least two points, found 1");
  EXPECT_EQ(refusal(ramp("NPTS= 20.5, DT= .01 SEC")), "file:4: expected a number of points, found 20.5");
  EXPECT_EQ(refusal(ramp("NPTS= 25, DT= UNKNOWN")),
            "file:4: expected the number of points and the step, as in \"NPTS= 4000, DT= .005 SEC\", found \"NPTS= 25, DT= UNKNOWN\"");
  EXPECT_EQ(refusal("0.5\n", {.unit = "g", .step = 0.01}), "file:1: expected at least two points, found one");
  EXPECT_EQ(refusal("0.5\n0.6\n", {.unit = "g", .step = 0.0}), "step: expected a time step from 1e-07 s to 1e+06 s, found 0 s");
  EXPECT_EQ(refusal("0.5\n0.6\n", {.unit = "g"}),
            "file: expected the time step of a file without times (give it, as in step = 0.01), found none");
}

TEST(RecordRefusals, Units) {
  const std::string known = "g, mg, gal, cm/s2, m/s2, mm/s2, in/s2, ft/s2, cm/s, m/s, mm/s, in/s, ft/s, cm, m, mm, in or ft";
  EXPECT_EQ(refusal(replaced(ramp(sound), "OF G", "OF FURLONGS")), "file:3: expected a unit of motion: " + known + ", found \"FURLONGS\"");
  EXPECT_EQ(refusal(replaced(ramp(sound), "OF G", "OF CM/S")),
            "file:3: expected a unit of acceleration, which the file says it holds, found cm/s (of velocity)");
  EXPECT_EQ(refusal("0 0\n0.01 -0.5\n"),
            "file: expected a unit of the values (the file states none: add one, as unit = \"g\" to its [[record]] or --unit g), found "
            "numbers up to 0.5 without a unit");
  EXPECT_EQ(refusal("0 0\n0.01 -0.5\n", {.unit = "cm/s3"}),
            "unit: expected a unit of motion: " + known + ", found \"cm/s3\" (did you mean \"cm/s2\"?)");
  EXPECT_EQ(refusal(cosmos(tone(20, 9), 10, 0, "Uncorrected", "counts(50)").text),
            "file:45: expected a unit of motion: " + known + ", found \"COUNTS\"");
  EXPECT_EQ(refusal(replaced(ramp(sound), "2.5000000E-02", "2.5000000E+99")),
            "file:3: expected values of a ground motion, found up to 2.452e+100 m/s2 with the unit g");
}

TEST(RecordRefusals, WhatIsNoRecord) {
  EXPECT_EQ(refusal(""), "file: expected a record of ground motion, found an empty file");
  EXPECT_EQ(refusal(" \r\n\n"), "file: expected a record of ground motion, found an empty file");
  EXPECT_EQ(refusal("Dear reader,\nthis is prose.\n"),
            "file: expected a record of ground motion (at2, esm, knet, cosmos, csmip, smc or columns), found no row of numbers within the "
            "first 2 lines of text");
  EXPECT_EQ(refusal("0 1\n" + std::string(4'000'001, '1')), "file:2: expected lines of at most 4000000 characters, found 4000001");
  EXPECT_EQ(refusal(std::string("0 1\n0 \0 1\n", 10)), "file:2: expected text, found a zero byte (a binary file, or UTF-16)");
  EXPECT_EQ(refusal(ramp(sound), {.format = "at3"}),
            "format: expected at2, esm, knet, cosmos, csmip, smc or columns, found \"at3\" (did you mean \"at2\"?)");
  EXPECT_EQ(refusal(replaced(ramp(sound), "6.0000000E-03", "6.0000000X-03")), "file:6: expected numbers, found \"X-03\"");
  EXPECT_EQ(
      refusal(smc(tone(20, 9), 1.7e38).text),
      "file:18: expected samples per second in the second real of the head, found none (a digitised film with uneven times is not read)");
  EXPECT_EQ(refusal(smc(tone(20, 9), 100, "5 RESPONSE SPECTRA").text), "file:1: expected a time history, found \"5 RESPONSE SPECTRA\"");
  EXPECT_EQ(refusal(esm(tone(20, 9), 0.01, "ACCELERATION RESPONSE SPECTRUM").text),
            "file:11: DATA_TYPE: expected ACCELERATION, VELOCITY or DISPLACEMENT, found \"ACCELERATION RESPONSE SPECTRUM\"");
  EXPECT_EQ(refusal(replaced(esm(tone(20, 9), 0.01).text, "NDATA: 20", "NDATA: many")),
            "file:8: NDATA: expected the number of points, found \"many\"");
  EXPECT_EQ(refusal(knet(tone(200, 900), 100, "N-S", "3920(gal)/0").text),
            "file:14: expected a scale factor such as 3920(gal)/6182761, found \"3920(gal)/0\"");
  EXPECT_EQ(refusal(replaced(knet(tone(200, 900), 100, "N-S").text, " 100Hz", " 0Hz")),
            "file:11: expected a sampling frequency > 0 Hz, found \"0Hz\"");
  const std::string channel = cosmos(tone(20, 9), 10, 0).text;
  EXPECT_EQ(refusal(channel.substr(0, channel.find(" 100 Real"))),
            "file:25: expected a line \"real-header values follow on ... lines\", found the end of the file");
}

TEST(RecordRefusals, TablesAndTheirTimes) {
  std::vector<double> times = equal_times();
  EXPECT_EQ(refusal("time [s],a [g]\n0,1\n0.02,1\n0.01,1\n"), "file:4: expected times in ascending order, found 0.01 s after 0.02 s");
  EXPECT_EQ(refusal("time [s],a [g]\n0,1\n0.01\n"), "file:3: expected 2 numbers, as in line 2, found 1");
  EXPECT_EQ(refusal("time [s],a [g]\n0,1\n0.01,x\n"), "file:3: expected a number, found \"x\"");
  EXPECT_EQ(refusal("time [s],a [g]\n0,1\nNaN,2\n"), "file:3: expected a time, found \"NaN\"");
  EXPECT_EQ(refusal("3 1\n1 2\n5 3\n", {.unit = "g"}), "file:1: expected two columns: times at equal steps, and values, found \"3 1\"");
  EXPECT_EQ(refusal("time [s],a [g]\n0,1\n1,2\n", {.column = "b"}),
            "file:1: column: expected a column from 1 to 2, or time or a, found \"b\"");
  EXPECT_EQ(refusal("0.5 -0.0012-0.3\n0.1 0.2\n"), "file:1: expected a row of numbers, found \"0.5 -0.0012-0.3\"");
  EXPECT_EQ(refusal("time [s],a [g]\n0,1\n1,2\n", {.column = "1"}), "file:1: column: expected a column of values, found that of the times");
  times.erase(times.begin() + 11, times.begin() + 13);
  EXPECT_EQ(refusal(table(times)), "file:13: expected times at equal steps of 0.01 s, found 0.13 s after 0.1 s");
}

TEST(RecordRefusals, MoreColumnsThanARecordHas) {
  std::string head = "time [s]", rows[] = {"0", "0.01", "0.02"};
  for (int i = 0; i < 101; ++i) {
    head += ",a [g]";
    for (std::string& row : rows) row += ",0.1";
  }
  const std::string text = head + "\n" + rows[0] + "\n" + rows[1] + "\n" + rows[2] + "\n";
  EXPECT_EQ(refusal(text), "file:1: expected at most 100 columns of motion (say which one with `column`), found 101");
  EXPECT_EQ(refusal(text, {.column = "7"}), "none");
}

TEST(RecordRefusals, GapsThatCannotBeFilled) {
  const std::string text = ramp(sound);
  EXPECT_EQ(refusal(replaced(replaced(text, "7.0000000E-03", "          NaN"), "8.0000000E-03", "          NaN")),
            "file:6: expected a number (only single missing points are interpolated), found \"NaN\"");
  EXPECT_EQ(refusal(replaced(text, "1.0000000E-03", "*************")),
            "file:5: expected a number for the first and the last point, found \"*************\"");
  EXPECT_EQ(refusal(replaced(text, "2.5000000E-02", "          Inf")),
            "file:9: expected a number for the first and the last point, found \"Inf\"");
  EXPECT_EQ(refusal(replaced(replaced(text, "7.0000000E-03", "          NaN"), "9.0000000E-03", "          NaN")),
            "file:6: expected at most one missing point in twenty, found 2 of 25");
}

TEST(RecordRepairs, NumberOfPoints) {
  const Motion cut = one(ramp("NPTS= 26, DT= .01 SEC")), long_one = one(ramp("NPTS= 23, DT= .01 SEC"));
  EXPECT_EQ(cut.values.size(), 25u);
  EXPECT_EQ(cut.repairs, Texts{"line 4 announces 26 points, the file has 25: read with 25"});
  EXPECT_EQ(long_one.values.size(), 23u);
  EXPECT_EQ(long_one.repairs, Texts{"line 4 announces 23 points, the file has 25: the last 2 left out"});
}

TEST(RecordRepairs, SingleMissingPoints) {
  const Motion whole = one(ramp(sound)), mended = one(replaced(ramp(sound), "7.0000000E-03", "          NaN"));
  ASSERT_EQ(mended.values.size(), 25u);
  for (std::size_t i = 0; i < 25; ++i) EXPECT_NEAR(mended.values[i], whole.values[i], 1e-15);  // a ramp is straight
  EXPECT_EQ(mended.repairs, Texts{"point 7 (line 6, \"NaN\") is missing: the mean of its neighbours was put there"});

  std::vector<double> times = equal_times();
  times.erase(times.begin() + 11);
  const Motion row = one(table(times));
  ASSERT_EQ(row.values.size(), 25u);
  EXPECT_DOUBLE_EQ(row.step, 0.01);
  EXPECT_NEAR(row.values[11], 0.011 * 9.80665, 1e-15);
  EXPECT_NEAR(row.values[24], 0.024 * 9.80665, 1e-15);
  EXPECT_EQ(row.repairs, Texts{"point 12 (line 13) is missing: the mean of its neighbours was put there"});
}

TEST(RecordRepairs, TimesThatBeginLater) {
  const Motion motion = one(table(equal_times(5)));
  EXPECT_DOUBLE_EQ(motion.step, 0.01);
  EXPECT_EQ(motion.values.size(), 25u);
  EXPECT_EQ(motion.repairs, Texts{"its times begin at 5 s; they are counted from there"});
}

TEST(RecordRepairs, TimesBeforeZero) {
  // without heads the first column is that of the times because its steps are equal, also where a record begins ahead of its trigger
  std::string rows, uneven;
  for (int i = 0; i < 25; ++i) {
    rows += fmt::format("{:.2f} {}\n", -0.1 + 0.01 * i, 3 * i - 7);
    uneven += fmt::format("{:.2f} {}\n", -0.1 + 0.01 * i + (i == 3 ? 0.006 : 0), 3 * i - 7);
  }
  for (const RecordOptions& options : {RecordOptions{.unit = "cm/s2"}, RecordOptions{.unit = "cm/s2", .step = 0.01}}) {
    const Motion motion = one(rows, options);
    ASSERT_EQ(motion.values.size(), 25u);
    EXPECT_DOUBLE_EQ(motion.step, 0.01);
    for (std::size_t i = 0; i < 25; ++i) EXPECT_NEAR(motion.values[i], 0.03 * static_cast<double>(i) - 0.07, 1e-12);
    EXPECT_EQ(motion.repairs, Texts{"its times begin at -0.1 s; they are counted from there"});
  }
  EXPECT_EQ(refusal(uneven, {.unit = "cm/s2"}), "file:1: expected two columns: times at equal steps, and values, found \"-0.10 -7\"");
}

TEST(RecordRepairs, LastNumberThatLostItsExponent) {
  // "4.6E" and "4.6" are no 4.6 where 4.6E-03 was written: the point is left out, not read a thousand times too large
  std::vector<double> values;
  for (int i = 0; i < 40; ++i) values.push_back(0.001 + 0.0001 * i);
  const Written written = peer(values, "NPTS= 40, DT= .01 SEC");
  for (const std::size_t lost : {2, 3, 4, 5, 6, 9}) {
    const Motion cut = one(written.text.substr(0, written.text.size() - lost));
    ASSERT_EQ(cut.values.size(), 39u) << lost;
    for (std::size_t i = 0; i < 39; ++i) EXPECT_NEAR(cut.values[i], values[i] * 9.80665, 1e-9);
    EXPECT_EQ(cut.repairs.size(), 2u);
    EXPECT_TRUE(cut.repairs[0].starts_with("the end of the file cut off its last number, \"4.9")) << cut.repairs[0];
    EXPECT_EQ(cut.repairs[1], "line 4 announces 40 points, the file has 39: read with 39");
  }
  // without a blank before a minus
  std::string glued = peer({}, "NPTS= 16, DT= .01 SEC").text;
  for (int i = 0; i < 8; ++i) glued += "-.1000000E-01-.2000000E-01\n";
  const Motion without = one(glued.substr(0, glued.size() - 4)), whole = one(glued.substr(0, glued.size() - 1));
  EXPECT_EQ(without.values.size(), 15u);
  EXPECT_NEAR(without.values.back(), -0.0980665, 1e-12);
  EXPECT_EQ(whole.values.size(), 16u);
  EXPECT_NEAR(whole.values.back(), -0.196133, 1e-12);
  // numbers of every form: nothing tells that the last one is not whole
  std::string free_form = "# step = 0.01 s; unit = m/s2\n";
  for (int i = 0; i < 8; ++i) free_form += i % 2 == 0 ? "1e-05\n" : "0.25\n";
  EXPECT_EQ(one(free_form + "0.125").values.back(), 0.125);
  // more digits than the numbers above have is no part of such a number, and the point of a table goes with its whole row
  std::string tail = "# step = 0.01 s; unit = m/s2\n", table;
  for (int i = 0; i < 8; ++i) tail += fmt::format("{}.{}e-05\n", i, i + 1), table += fmt::format("{:.2f} {}.{}E-06\n", 0.01 * i, i, i + 1);
  EXPECT_EQ(one(tail + "0.000123").values.back(), 0.000123);
  EXPECT_EQ(one(tail + "8.9").values.size(), 8u);
  EXPECT_EQ(one(tail + "# 9 numbers").values.size(), 8u);
  EXPECT_EQ(one(tail + "# 9 numbers").repairs, Texts{"the last line has no end; it was taken as complete"});
  EXPECT_NE(refusal(tail + "END").find("found \"END\""), std::string::npos) << refusal(tail + "END");
  for (const std::string last : {"0.08 8", "0.08 8.9E", "0.08 8.9E-0", "0.08,8.9"}) {
    std::string rows = table;
    if (last.find(',') != last.npos) std::ranges::replace(rows, ' ', ',');
    const Motion cut = one(rows + last, {.unit = "cm/s2"});
    ASSERT_GE(cut.values.size(), 8u) << last;
    EXPECT_LE(cut.values.size(), 9u) << last;
    for (std::size_t i = 0; i < cut.values.size(); ++i)
      EXPECT_NEAR(cut.values[i], i < 8 ? 1e-8 * (static_cast<double>(i) + 0.1 * (static_cast<double>(i) + 1)) : 0, 1e-16) << last;
  }
}

TEST(RecordRepairs, WhatLooksOdd) {
  EXPECT_EQ(one(replaced(ramp(sound), "2.5000000E-02", "3.4170500E+02")).repairs,
            Texts{"the largest acceleration is 3351 m/s2, more than was ever recorded: is the unit g right?"});
  EXPECT_EQ(one(peer(std::vector<double>(10, 0.0), "NPTS= 10, DT= .01 SEC").text).repairs, Texts{"all values are zero"});
  EXPECT_EQ(one(ramp("NPTS= 25, DT= 2 SEC")).repairs, Texts{"a step of 2 s is longer than that of any accelerograph; taken as it stands"});
  EXPECT_EQ(one(ramp(sound), {.step = 0.02}).repairs, Texts{"the file states a step of 0.01 s; read with 0.02 s, as asked"});
}

TEST(RecordRepairs, StatedPeakAndSign) {
  const std::vector<double> values{0, 1, -2, 25, 3, 0};
  EXPECT_TRUE(one(csmip_v2(values, 0.01, 25).text).repairs.empty());
  EXPECT_EQ(one(csmip_v2(values, 0.01, -25).text).repairs,
            Texts{"line 9 states a peak of -0.25 m/s2, the values have 0.25 m/s2, of the opposite sign: taken as they stand"});
  EXPECT_EQ(one(csmip_v2(values, 0.01, 30).text).repairs,
            Texts{"line 9 states a peak of 0.3 m/s2, the values have 0.25 m/s2: taken as they stand"});
  EXPECT_TRUE(one(smc(values, 100, "2 CORRECTED ACCELEROGRAM", 25, -2).text).repairs.empty());
  EXPECT_EQ(one(smc(values, 100, "2 CORRECTED ACCELEROGRAM", 2, -25).text).repairs,
            Texts{"line 23 states a peak of -0.25 m/s2, the values have 0.25 m/s2, of the opposite sign: taken as they stand"});
  EXPECT_EQ(one(replaced(esm(values, 0.01).text, "USER5:", "PGA_CM/S^2: -25")).repairs,
            Texts{"line 12 states a peak of -0.25 m/s2, the values have 0.25 m/s2, of the opposite sign: taken as they stand"});
}

/// A byte replaced, taken out or put in, a piece doubled, the end cut off.
void damage(std::string& text) {
  const auto position = static_cast<std::size_t>(*rc::gen::inRange(0, static_cast<int>(text.size())));
  const char byte = *rc::gen::element('0', '9', '-', '.', 'E', '\n', '\r', ' ', ',', ';', ':', '=', '(', '*', 'N', '#', '\t', '\xE9');
  switch (*rc::gen::inRange(0, 5)) {
    case 0:
      text[position] = byte;
      break;
    case 1:
      text.erase(position, static_cast<std::size_t>(*rc::gen::inRange(1, 40)));
      break;
    case 2:
      text.insert(position, 1, byte);
      break;
    case 3:
      text.insert(position, text.substr(position, static_cast<std::size_t>(*rc::gen::inRange(1, 200))));
      break;
    default:
      text.resize(position);
  }
}

RC_GTEST_PROP(RecordDamage, IsReadOrRefused, ()) {
  const std::vector<double> values = tone(40, 30);
  const std::string files[] = {peer(tone(40, 0.3), "NPTS= 40, DT= .01 SEC").text,
                               esm(values, 0.01).text,
                               knet(tone(40, 9000), 20, "U-D").text,
                               cosmos(values, 10, 0).text,
                               csmip_v2(values, 0.01, 0).text,
                               csmip_v1(tone(40, 0.3), 100).text,
                               smc(values, 100).text,
                               table(equal_times())};
  std::string text = files[*rc::gen::inRange<std::size_t>(0, std::size(files))];
  for (int i = *rc::gen::inRange(1, 4); i > 0 && !text.empty(); --i) damage(text);
  try {
    for (const Motion& motion :
         read_motions_from(text, "file", *rc::gen::element(RecordOptions{}, RecordOptions{.unit = "g", .step = 0.01}))) {
      RC_ASSERT(motion.step > 0 && std::isfinite(motion.step));
      RC_ASSERT(motion.values.size() >= 2u);
      for (const double value : motion.values) RC_ASSERT(std::isfinite(value));
    }
  } catch (const InputError& error) {
    RC_ASSERT(std::string(error.what()).starts_with("file"));
  }
}

}  // namespace
}  // namespace uplift::repairs_test
