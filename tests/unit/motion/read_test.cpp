#include "uplift/motion/formats/read.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <numbers>

#include "data_support.h"
#include "unit/motion/files.h"
#include "uplift/base/error.h"
#include "uplift/base/file.h"
#include "uplift/motion/formats/record_format.h"
#include "uplift/motion/formats/write.h"

namespace uplift::read_test {
namespace {

using namespace sample;
using Texts = std::vector<std::string>;
constexpr double g = 9.80665, degree = std::numbers::pi / 180;

Motion one(const std::string& text, const RecordOptions& options = {}) {
  const std::vector<Motion> motions = read_motions_from(text, "file", options);
  EXPECT_EQ(motions.size(), 1u);
  return motions.at(0);
}

/// The numbers of the file times the factor, bit for bit but for the last one of the product.
void expect_values(const Motion& motion, const std::vector<double>& numbers, double factor) {
  ASSERT_EQ(motion.values.size(), numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) ASSERT_DOUBLE_EQ(motion.values[i], numbers[i] * factor) << "point " << i;
  EXPECT_DOUBLE_EQ(motion.factor, factor);
}

void expect_record(const std::string& path, const RecordOptions& options, std::size_t points, double step, double pga) {
  const std::vector<Motion> motions = read_motions(path, options);
  ASSERT_EQ(motions.size(), 1u);
  EXPECT_EQ(motions[0].values.size(), points);
  EXPECT_DOUBLE_EQ(motions[0].step, step);
  EXPECT_DOUBLE_EQ(motions[0].duration(), step * static_cast<double>(points - 1));
  EXPECT_NEAR(std::abs(peak_of(motions[0]).value), pga, 1e-12 * pga);
  EXPECT_EQ(motions[0].sha256, sha256(read_file(path)));
  EXPECT_EQ(motions[0].file, path);
}

// Peaks, counts and steps of El Centro as its publishers give them; those of the tones as tests/data/README.md states them.
TEST(Records, ElCentroOfChopra) {
  const std::string path = support::data_file("records/elcentro.dat");
  expect_record(path, {}, 1559, 0.02, 0.31882 * g);
  const Motion motion = read_motions(path).at(0);
  EXPECT_NEAR(motion.duration(), 31.16, 1e-12);
  EXPECT_EQ(motion.repairs, Texts{"line 2 announces 1559 points, the file has 1560: the last 1 left out"});
  EXPECT_EQ(motion.unit, "g");
}

TEST(Records, ElCentroWithoutComments) {
  const std::string path = support::data_file("records/elcentro_akchopra.dat");
  expect_record(path, {.unit = "g", .step = 0.02}, 1560, 0.02, 0.31882 * g);
}

TEST(Records, ElCentroOfAnotherVersion) {
  const std::string path = support::data_file("records/elcentro_S00E_1940.dat");
  expect_record(path, {.unit = "cm/s2", .step = 0.02}, 2688, 0.02, 3.41705);
}

TEST(Records, PeerNew) {
  const std::string path = support::data_file("records/tone_peer_new.AT2");
  expect_record(path, {}, 203, 0.005, 0.17351642 * g);
  const Motion motion = read_motions(path).at(0);
  EXPECT_EQ(motion.event, "Test tone, 1/2/2024");
  EXPECT_EQ(motion.station, "Example Valley - Mill & Station Road");
  EXPECT_EQ(motion.component, "360");
  EXPECT_NEAR(motion.azimuth.value(), 2 * std::numbers::pi, 1e-12);
  EXPECT_TRUE(motion.repairs.empty());
}

TEST(Records, PeerOld) {
  const std::string path = support::data_file("records/tone_peer_old.AT2");
  expect_record(path, {}, 128, 0.01, 0.4106 * g);
  const Motion motion = read_motions(path).at(0);
  EXPECT_EQ(motion.event, "TEST TONE 01/02/24 0304");
  EXPECT_EQ(motion.station, "EXAMPLE TOWN");
  EXPECT_NEAR(motion.azimuth.value(), 90 * degree, 1e-12);
}

TEST(RecordFormats, PeerInAllSpellings) {
  const std::vector<double> values = tone(23, 0.4);
  for (const char* counts : {"NPTS=     23, DT=   .0050 SEC,", "NPTS=  23, DT= .00500 SEC", "   23    0.0050    NPTS, DT",
                             "npts = 23 , dt = 5E-3 sec", "NPTS: 23 DT: 0.005"}) {
    const Written written = peer(values, counts);
    const Motion motion = one(written.text);
    EXPECT_EQ(motion.format, "at2") << counts;
    EXPECT_DOUBLE_EQ(motion.step, 0.005) << counts;
    EXPECT_EQ(motion.station, "El Centro Array #6");
    EXPECT_EQ(motion.event, "Imperial Valley-06, 10/15/1979");
    EXPECT_NEAR(motion.azimuth.value(), 230 * degree, 1e-12);
    EXPECT_TRUE(motion.repairs.empty()) << motion.repairs.front();
    expect_values(motion, written.numbers, g);
  }
}

// Files of the PEER Strong Motion Database of 2000 state the filter behind the unit.
TEST(RecordFormats, PeerWithFilterPointsBehindTheUnit) {
  const std::vector<double> values = tone(23, 0.4);
  Written written = peer(values, "NPTS=  23, DT= .00500 SEC");
  const std::size_t unit = written.text.find("UNITS OF G");
  ASSERT_NE(unit, written.text.npos);
  written.text.insert(unit + 10, ". FILTER POINTS: HP=0.2 Hz LP=35.0 Hz");
  expect_values(one(written.text), written.numbers, g);
}

TEST(RecordFormats, PeerVelocityAndDisplacement) {
  const Written velocity = peer(tone(40, 30), "NPTS= 40, DT= .01 SEC", "VELOCITY", "CM/S"),
                displacement = peer(tone(40, 8), "NPTS= 40, DT= .01 SEC", "DISPLACEMENT", "CM");
  EXPECT_EQ(one(velocity.text).kind, MotionKind::velocity);
  expect_values(one(velocity.text), velocity.numbers, 0.01);
  EXPECT_EQ(one(displacement.text).kind, MotionKind::displacement);
  expect_values(one(displacement.text), displacement.numbers, 0.01);
}

TEST(RecordFormats, Esm) {
  const Written written = esm(tone(50, 200), 0.005);
  const Motion motion = one(written.text);
  EXPECT_EQ(motion.format, "esm");
  EXPECT_EQ(motion.event, "EMILIA_ROMAGNA, 20120529");
  EXPECT_EQ(motion.station, "IT.MRN, MIRANDOLA");
  EXPECT_EQ(motion.component, "HNE");
  EXPECT_NEAR(motion.azimuth.value(), 90 * degree, 1e-12);
  EXPECT_DOUBLE_EQ(motion.step, 0.005);
  expect_values(motion, written.numbers, 0.01);
  EXPECT_EQ(one(esm(tone(50, 20), 0.005, "VELOCITY", "cm/s").text).kind, MotionKind::velocity);
}

TEST(RecordFormats, KnetWithItsMeanTakenOff) {
  std::vector<double> counts = tone(200, 90000);
  for (double& count : counts) count += 6500;
  const Written written = knet(counts, 100, "N-S");
  const Motion motion = one(written.text);
  double mean = 0;
  for (const double count : written.numbers) mean += count / 200;
  const double factor = 3920.0 / 6182761 * 0.01;
  EXPECT_EQ(motion.format, "knet");
  EXPECT_DOUBLE_EQ(motion.step, 0.01);
  EXPECT_NEAR(motion.factor, factor, 1e-15 * factor);
  ASSERT_EQ(motion.values.size(), 200u);
  for (std::size_t i = 0; i < 200; ++i) EXPECT_NEAR(motion.values[i], factor * (written.numbers[i] - mean), 1e-12);
  EXPECT_EQ(motion.repairs,
            Texts{fmt::format("the zero of these counts is arbitrary: their mean, {:.4g} m/s2, was taken off", factor * mean)});
  EXPECT_EQ(motion.station, "IBR011");
  EXPECT_EQ(motion.event, "2011/03/11 14:46:00, magnitude 9.0");
  EXPECT_EQ(motion.azimuth, 0.0);
  const Motion borehole = one(knet(counts, 200, "2", "2000(gal)/8388608").text);
  EXPECT_EQ(borehole.component, "E-W borehole");
  EXPECT_NEAR(borehole.azimuth.value(), 90 * degree, 1e-12);
  EXPECT_DOUBLE_EQ(borehole.step, 0.005);
  EXPECT_FALSE(one(knet(counts, 100, "6").text).azimuth);
}

TEST(RecordFormats, CosmosWithTwoChannels) {
  const Written written = cosmos(tone(100, -161.9), 10, 0), other = cosmos(tone(60, 33), 5, 0, "Uncorrected");
  const std::vector<Motion> motions = read_motions_from(written.text + other.text, "file.v2");
  ASSERT_EQ(motions.size(), 2u);
  expect_values(motions[0], written.numbers, 0.01);
  expect_values(motions[1], other.numbers, 0.01);
  EXPECT_DOUBLE_EQ(motions[0].step, 0.01);
  EXPECT_DOUBLE_EQ(motions[1].step, 0.005);
  EXPECT_EQ(motions[0].format, "cosmos");
  EXPECT_EQ(motions[0].event, "Yucaipa Earthquake of June 16, 2005");
  EXPECT_EQ(motions[0].station, "CE-J2236  CDMG Yucaipa - Bryant & Oak Glen");
  EXPECT_EQ(motions[0].component, "340 deg");
  EXPECT_EQ(motions[0].name, "file 340 deg");
  EXPECT_NEAR(motions[0].azimuth.value(), 340 * degree, 1e-12);
}

/// Three components of one instrument, each with velocity and displacement behind the acceleration: those are left out.
TEST(RecordFormats, CosmosWithThreeComponents) {
  const auto channel = [](const std::vector<double>& values, const std::string& line, double azimuth) {
    Written written = cosmos(values, 5, 0);
    const std::string head = "Sta Cha:  1: 340 deg (Rcrdr Chan  1) Location: ground\n";
    written.text.replace(written.text.find(head), head.size(), line + "\n");
    const std::string number = fmt::format("{:8.0f}", 340.0);
    written.text.replace(written.text.find(number), 8, fmt::format("{:8.0f}", azimuth));
    for (const char* further : {"velocity pts, approx  1 secs, units=cm/sec(05)", "displacement pts, approx  1 secs, units=cm(06)"}) {
      written.text += fmt::format("{:7}  {},Format=(8F10.5)\n", values.size(), further);
      Written more;
      add_rows(more, std::vector<double>(values.size(), 1.0), 8, "{:10.5f}");
      written.text += more.text + "End-of-data for Chan  1\n";
    }
    return written;
  };
  const Written north = channel(tone(50, 90), "Sta Chan  1: 360 Deg  (Rcrdr Chan  1) Location: Ground floor: east", 360),
                east = channel(tone(50, 60), "Sta Chan   HNE   90 deg   Location: 00", 90),
                up = channel(tone(50, 30), "Sta Chan  3:  Up (Rcrdr Chan  3)  Location: Ground floor", 400);
  const std::vector<Motion> motions = read_motions_from(north.text + east.text + up.text, "three.v2");
  ASSERT_EQ(motions.size(), 3u);
  expect_values(motions[0], north.numbers, 0.01);
  expect_values(motions[1], east.numbers, 0.01);
  expect_values(motions[2], up.numbers, 0.01);
  EXPECT_EQ(motions[0].component, "360 Deg");
  EXPECT_EQ(motions[1].component, "HNE   90 deg");
  EXPECT_EQ(motions[2].component, "Up");
  EXPECT_NEAR(motions[1].azimuth.value(), 90 * degree, 1e-12);
  EXPECT_FALSE(motions[2].azimuth);
  for (const Motion& motion : motions) EXPECT_EQ(motion.kind, MotionKind::acceleration);
}

TEST(RecordFormats, CsmipV2WithTwoChannels) {
  const Written written = csmip_v2(tone(75, 27.1), 0.01, 0);
  const std::vector<Motion> motions = read_motions_from(written.text + written.text, "file");
  ASSERT_EQ(motions.size(), 2u);
  for (const Motion& motion : motions) {
    expect_values(motion, written.numbers, 0.01);
    EXPECT_EQ(motion.kind, MotionKind::acceleration);
    EXPECT_EQ(motion.format, "csmip");
    EXPECT_EQ(motion.event, "Sun Aug 24, 2014 03:20:33.0 PDT");
    EXPECT_EQ(motion.station, "Concord - Clayton & Ellis");
    EXPECT_EQ(motion.component, "360 Deg");
    EXPECT_NEAR(motion.azimuth.value(), 360 * degree, 1e-12);
    EXPECT_DOUBLE_EQ(motion.step, 0.01);
    EXPECT_TRUE(motion.repairs.empty());
  }
}

TEST(RecordFormats, CsmipV1WithFieldsThatTouch) {
  const Written written = csmip_v1({10.5, -0.25, -99.123456 / 10, 12.25, 0.079, -3.5, 1, 2, 10, 11}, 200);
  const Motion motion = one(written.text, {.unit = "cm/s2"});
  expect_values(motion, written.numbers, 0.01);
  EXPECT_DOUBLE_EQ(motion.step, 0.005);
  EXPECT_EQ(motion.station, "Willow Creek");
  EXPECT_EQ(motion.repairs, Texts{"the file states g; read as cm/s2, as asked"});
}

TEST(RecordFormats, Smc) {
  const Written written = smc(tone(64, 180.3), 200), velocity = smc(tone(64, 20), 100, "3 VELOCITY");
  const Motion motion = one(written.text);
  EXPECT_EQ(motion.format, "smc");
  expect_values(motion, written.numbers, 0.01);
  EXPECT_DOUBLE_EQ(motion.step, 0.005);
  EXPECT_EQ(motion.event, "Loma Prieta, CA");
  EXPECT_EQ(motion.station, "San Francisco, 575 Market, 42n");
  EXPECT_EQ(motion.component, "225");
  EXPECT_NEAR(motion.azimuth.value(), 225 * degree, 1e-12);
  EXPECT_EQ(one(velocity.text).kind, MotionKind::velocity);
  expect_values(one(velocity.text), velocity.numbers, 0.01);
}

TEST(RecordFormats, TablesWithAndWithoutHeads) {
  const std::vector<double> numbers{0, 0.5, -1.25, 0.75};
  const auto same = [&](const std::string& text, const RecordOptions& options, double factor) {
    const Motion motion = one(text, options);
    EXPECT_DOUBLE_EQ(motion.step, 0.02) << text;
    expect_values(motion, numbers, factor);
  };
  same("0 0\n0.02 0.5\n0.04 -1.25\n0.06 0.75\n", {.unit = "g"}, g);
  same("time [s],acc [cm/s2]\n0,0\n0.02,0.5\n0.04,-1.25\n0.06,0.75\n", {}, 0.01);
  same("t (s)\tNS (g)\n0\t0\n0.02\t0.5\n0.04\t-1.25\n0.06\t0.75\n", {}, g);
  same("Time Acceleration\n0 0\n.02 .5\n.04 -1.25\n.06 7.5D-1\n", {.unit = "m/s^2"}, 1);
  same("t;a [m/s2]\n0,00;0,0\n0,02;0,5\n0,04;-1,25\n0,06;0,75\n", {}, 1);
  same("time [ms] a [mm/s2]\n0 0\n20 0.5\n40 -1.25\n60 0.75\n", {}, 0.001);
  same("0\n0.5\n-1.25\n0.75\n", {.unit = "cm/sec/sec", .step = 0.02}, 0.01);
  same("acceleration [g]\n0\n0.5\n-1.25\n0.75\n", {.step = 0.02}, g);
  same("# step = 0.02 s; unit = g\n0 0.5 -1.25\n0.75\n", {}, g);
  same("#4 points at equal spacing of 0.02 sec\n#The units are (g)\n0 0.5 -1.25\n0.75 0.0 0\n", {}, g);
  same("x [m/s2],t [s]\n0,0\n0.5,0.02\n-1.25,0.04\n0.75,0.06\n", {}, 1);
}

TEST(RecordFormats, TablesOfSpreadsheets) {
  const std::vector<double> numbers{0, 0.5, -1.25, 0.75};
  const auto same = [&](const std::string& text, const RecordOptions& options, double factor, bool told) {
    const Motion motion = one(text, options);
    EXPECT_DOUBLE_EQ(motion.step, 0.02) << text;
    expect_values(motion, numbers, factor);
    EXPECT_EQ(motion.repairs, told ? Texts{"its commas were read as decimal commas"} : Texts{}) << text;
  };
  // decimal commas that begin below a row of whole numbers, between tabs and between blanks
  same("t;a [m/s2]\n0;0\n0,02;0,5\n0,04;-1,25\n0,06;0,75\n", {}, 1, false);
  same("0\t0\n0,02\t0,5\n0,04\t-1,25\n0,06\t0,75\n", {.unit = "g"}, g, true);
  same("0,00  0,0\n0,02  0,5\n0,04 -1,25\n0,06  0,75\n", {.unit = "m/s2"}, 1, true);
  same("# step = 0.02 s; unit = g\n0,00 0,50 -1,25\n0,75\n", {}, g, true);
  // one column: a whole number is not written "00" or "-0", and none begins with a zero
  same("0,00\n0,50\n-1,25\n0,75\n", {.unit = "m/s2", .step = 0.02}, 1, true);
  same("0\n0,5\n-1,25\n0,75\n", {.unit = "m/s2", .step = 0.02}, 1, true);
  // quotes, separators at the ends, units in a line of their own
  same("\"time [s]\",\"a, NS [g]\"\n\"0\",\"0\"\n\"0.02\",\"0.5\"\n\"0.04\",\"-1.25\"\n\"0.06\",\"0.75\"\n", {}, g, false);
  same("t [s];a [cm/s2];\n0;0;\n0,02;0,5;\n0,04;-1,25;\n0,06;0,75;\n", {}, 0.01, false);
  for (const char* units : {"s,cm/s2", "[s],[cm/s2]", "(s),(gal)"})
    same(std::string("time,acc\n") + units + "\n0,0\n0.02,0.5\n0.04,-1.25\n0.06,0.75\n", {}, 0.01, false);
  same("t a\n(ms) (m/s2)\n0 0\n20 0.5\n40 -1.25\n60 0.75\n", {}, 1, false);
  // whole numbers at whole times remain two columns
  EXPECT_EQ(one("0,3\n1,5\n2,-4\n3,1\n", {.unit = "m/s2"}).values, (std::vector<double>{3, 5, -4, 1}));
  // "1,5" then "-2,7": no one can tell
  EXPECT_THROW(one("1,5\n-2,7\n0,3\n", {.unit = "m/s2", .step = 0.02}), InputError);
}

TEST(RecordFormats, ColumnsOfATable) {
  const std::string table = "time [s],NS [m/s2],EW [m/s2],note\n0,1,4,7\n0.01,2,5,8\n0.02,3,6,9\n", bare = "0 1 4\n0.01 2 5\n0.02 3 6\n";
  const std::vector<Motion> all = read_motions_from(table, "table.csv");
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].component, "NS");
  EXPECT_EQ(all[1].name, "table EW");
  EXPECT_EQ(all[1].values, (std::vector<double>{4, 5, 6}));
  EXPECT_NEAR(all[1].azimuth.value(), 90 * degree, 1e-12);
  EXPECT_EQ(one(table, {.column = "EW"}).values, (std::vector<double>{4, 5, 6}));
  EXPECT_EQ(one(table, {.unit = "m/s2", .column = "4"}).values, (std::vector<double>{7, 8, 9}));
  EXPECT_EQ(one(bare, {.unit = "m/s2"}).values, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(one(bare, {.unit = "m/s2", .column = "3"}).values, (std::vector<double>{4, 5, 6}));
}

TEST(RecordFormats, EveryFormatIsFoundByContentAndByName) {
  const std::vector<double> values = tone(100, 30);
  const std::pair<std::string, std::string> files[] = {{"at2", peer(tone(100, 0.3), "NPTS= 100, DT= .01 SEC").text},
                                                       {"esm", esm(values, 0.01).text},
                                                       {"knet", knet(values, 100, "U-D").text},
                                                       {"cosmos", cosmos(values, 10, 0).text},
                                                       {"csmip", csmip_v2(values, 0.01, 0).text},
                                                       {"smc", smc(values, 100).text},
                                                       {"columns", "0 0\n1 1\n"}};
  EXPECT_EQ(record_catalog().size(), std::size(files));
  for (const auto& [name, text] : files) {
    const RecordOptions options{.unit = name == "columns" ? "g" : ""};
    EXPECT_EQ(read_motions_from(text, "f", options).at(0).format, name);
    for (const RecordFormat* format : record_catalog()) {
      if (format->name == name) break;
      EXPECT_FALSE(format->recognises(RecordText(text, "f"))) << name << " taken for " << format->name;
    }
  }
}

TEST(RecordFormats, LineEndsAndLettersMakeNoDifference) {
  const Written written = peer(tone(23, 0.4), "NPTS= 23, DT= .005 SEC");
  const Motion plain = one(written.text);
  const auto with_ends = [&](const std::string& end) {
    std::string text;
    for (const char c : written.text) text += c == '\n' ? end : std::string(1, c);
    return text;
  };
  for (const char* end : {"\r\n", "\r", "\r\r\n"}) EXPECT_EQ(one(with_ends(end)).values, plain.values);
  EXPECT_TRUE(one(with_ends("\r\n")).repairs.empty());
  std::string mixed = written.text;
  mixed.replace(mixed.find('\n'), 1, "\r\n");
  EXPECT_EQ(one(mixed).values, plain.values);
  EXPECT_EQ(one(mixed).repairs, Texts{"line ends of different systems are mixed; each was taken as one"});
  std::string latin = written.text;
  latin.replace(latin.find("El Centro"), 9, "San Jos\xE9");
  EXPECT_EQ(one(latin).station, "San Jos\u00E9 Array #6");
  EXPECT_EQ(one(latin).repairs, Texts{"bytes that are not UTF-8 were read as Latin-1"});
  EXPECT_EQ(one("\xEF\xBB\xBF" + written.text).values, plain.values);
  const Motion cut = one(written.text.substr(0, written.text.size() - 1));
  EXPECT_EQ(cut.values, plain.values);
  EXPECT_EQ(cut.repairs, Texts{"the last line has no end; it was taken as complete"});
}

TEST(RecordUnits, Spellings) {
  const auto is = [](const char* word, MotionKind kind, double factor) {
    const std::optional<MotionUnit> unit = motion_unit(word);
    ASSERT_TRUE(unit) << word;
    EXPECT_EQ(unit->kind, kind) << word;
    EXPECT_DOUBLE_EQ(unit->factor, factor) << word;
  };
  for (const char* word : {"g", "G", "g_n", "(g)"}) is(word, MotionKind::acceleration, g);
  for (const char* word : {"cm/s2", "CM/SEC/SEC", "cm/sec2", "cm/s^2", "cm/s**2", "gal", "Gal", "CM/S/S", "cm s-2", "cm/s\u00B2"})
    is(word, MotionKind::acceleration, 0.01);
  for (const char* word : {"m/s2", "M/SEC^2", "m s^-2"}) is(word, MotionKind::acceleration, 1);
  is("in/s2", MotionKind::acceleration, 0.0254);
  is("cm/sec", MotionKind::velocity, 0.01);
  is("CM", MotionKind::displacement, 0.01);
  EXPECT_FALSE(motion_unit("counts"));
  EXPECT_FALSE(motion_unit(""));
}

TEST(RecordUnits, Azimuths) {
  const auto degrees = [](const char* word) { return azimuth_of(word).value_or(-degree) / degree; };
  EXPECT_NEAR(degrees("N21E"), 21, 1e-12);
  EXPECT_NEAR(degrees("S 45 W"), 225, 1e-12);
  EXPECT_NEAR(degrees("S30E"), 150, 1e-12);
  EXPECT_NEAR(degrees("N60W"), 300, 1e-12);
  EXPECT_NEAR(degrees("E-W"), 90, 1e-12);
  EXPECT_NEAR(degrees("090 (CUE)"), 90, 1e-12);
  EXPECT_NEAR(degrees("000"), 0, 1e-12);
  for (const char* word : {"UP", "U-D", "V", "", "HNZ", "400", "12AB"}) EXPECT_FALSE(azimuth_of(word)) << word;
}

RC_GTEST_PROP(RecordCsv, ReadsBackBitForBit, ()) {
  const auto value =
      rc::gen::map(rc::gen::arbitrary<std::int64_t>(), [](std::int64_t bits) { return static_cast<double>(bits) * 1e-19 / 3; });
  const double step = 1 / static_cast<double>(*rc::gen::inRange(7, 1000));
  std::vector<Motion> motions(static_cast<std::size_t>(*rc::gen::inRange(1, 4)));
  for (Motion& motion : motions) {
    motion.kind = *rc::gen::element(MotionKind::acceleration, MotionKind::velocity, MotionKind::displacement);
    motion.step = step;
    motion.name = *rc::gen::element<std::string>("NS", "a, b; [c] = \"d\"", "");
    motion.processing = {"scaled to PGA = 3 m/s2, 12 points: step = 1"};
    motion.values = *rc::gen::container<std::vector<double>>(static_cast<std::size_t>(*rc::gen::inRange(2, 60)), value);
  }
  const std::vector<Motion> back = read_motions_from(motion_csv(motions), "m.csv");
  RC_ASSERT(back.size() == motions.size());
  for (std::size_t i = 0; i < motions.size(); ++i) {
    RC_ASSERT(back[i].step == step);
    RC_ASSERT(back[i].kind == motions[i].kind);
    RC_ASSERT(back[i].values == motions[i].values);
  }
}

}  // namespace
}  // namespace uplift::read_test
