#include "uplift/base/units.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <thread>
#include <vector>

namespace uplift::units_test {
namespace {

double si(std::string_view text, std::string_view unit) {
  const Quantity quantity = parse_quantity(text, unit);
  EXPECT_TRUE(quantity.ok) << quantity.found;
  return quantity.ok ? quantity.value : std::numeric_limits<double>::quiet_NaN();
}

std::string why_not(std::string_view text, std::string_view unit) {
  const Quantity quantity = parse_quantity(text, unit);
  EXPECT_FALSE(quantity.ok) << text << " was read as " << quantity.value << " " << unit;
  return quantity.found;
}

// Claim: the short table is no second source of truth. Source: UDUNITS-2's data base. Tolerance: rounding of its products.
TEST(Units, EveryRowOfTheShortTableAgreesWithUdunits) {
  ASSERT_GT(common_units().size(), 30u);
  for (const CommonUnit& row : common_units()) {
    const double factor = udunits_factor(row.word, row.si);
    EXPECT_NEAR(row.factor / factor, 1, 4 * std::numeric_limits<double>::epsilon()) << row.word << " -> " << row.si;
    // Whether found in the table or not: white space keeps a word out of it.
    if (row.word.find(' ') == row.word.npos && row.word != "1/s") {
      const std::string outside = "7 (" + std::string(row.word) + ")";
      EXPECT_DOUBLE_EQ(si("7 " + std::string(row.word), row.si), si(outside, row.si)) << row.word;
    }
  }
}

TEST(Units, ConvertsTextsToSi) {
  EXPECT_EQ(si("20000 MPa", "Pa"), 2e10);
  EXPECT_EQ(si("10 Hz", "Hz"), 10);
  EXPECT_EQ(si("3 m", "m"), 3);
  EXPECT_EQ(si("-9.81 m/s2", "m/s2"), -9.81);
  EXPECT_EQ(si("1 kN/m", "N/m"), 1000);
  EXPECT_EQ(si("2.5 t", "kg"), 2500);
  EXPECT_EQ(si("5 %", "1"), 0.05);
  EXPECT_EQ(si("  +1.5e-3 m  ", "m"), 0.0015);
  EXPECT_EQ(si("5m", "m"), 5);
  EXPECT_EQ(si(".5 m", "m"), 0.5);
  EXPECT_EQ(si("1 ft", "m"), 0.3048);
  EXPECT_NEAR(si("1 ksi", "Pa"), 4.4482216152605e3 / (0.0254 * 0.0254), 1e-8);
  EXPECT_NEAR(si("1 h", "s"), 3600, 0);
}

// A pound-force is 0.45359237 kg * 9.80665 m/s2, a foot 0.3048 m, both exact by definition.
TEST(Units, ShortNamesOfPressuresAndModuliOfSubgradeReaction) {
  constexpr double pound_force = 0.45359237 * 9.80665, foot = 0.3048, inch = foot / 12;
  EXPECT_NEAR(si("1 tf", "N"), 9806.65, 1e-9);
  EXPECT_NEAR(si("2 tf/m3", "Pa/m") / (2 * 9806.65), 1, 1e-15);
  EXPECT_NEAR(si("1 psf", "Pa") / (pound_force / (foot * foot)), 1, 1e-15);
  EXPECT_NEAR(si("1 ksf", "Pa") / (1000 * pound_force / (foot * foot)), 1, 1e-15);
  EXPECT_NEAR(si("1 ksf/ft", "Pa/m") / si("1 kcf", "Pa/m"), 1, 1e-15);
  EXPECT_NEAR(si("50 pci", "Pa/m") / (50 * pound_force / (inch * inch * inch)), 1, 1e-15);
  EXPECT_NEAR(si("1 pci", "Pa/m") / si("1.728 kcf", "Pa/m"), 1, 1e-15);
}

TEST(Units, AcceptsTheUsualSpellings) {
  for (const char* text : {"2 kg/m3", "2 kg/m^3", "2 kg/m\u00b3", "2 kg.m-3", "2 kg m-3", "2 kg/(m3)"})
    EXPECT_EQ(si(text, "kg/m3"), 2) << text;
  for (const char* text : {"2 kN m", "2 kN.m", "2 kN\u00b7m", "2 kN*m", "2 m kN"}) EXPECT_EQ(si(text, "N m"), 2000) << text;
  for (const char* text : {"2 um", "2 \u00b5m", "2 micron"}) EXPECT_EQ(si(text, "m"), 2e-6) << text;
}

TEST(Units, DecimalFactorsRoundOnce) {
  // "9 mm" is the double that a bare 0.009 is; 9 * 0.001 is not.
  EXPECT_EQ(si("9 mm", "m"), 0.009);
  EXPECT_NE(9 * 0.001, 0.009);
  EXPECT_EQ(si("7 cm/s", "m/s"), 0.07);
  EXPECT_EQ(si("0.3 kN/cm2", "Pa"), 3e6);
}

TEST(Units, WithoutUnitIsSi) {
  EXPECT_EQ(si("3.5", "Pa"), 3.5);
  EXPECT_EQ(si("1e3", "1"), 1000);
  EXPECT_EQ(si("0.15", "rad"), 0.15);
}

TEST(Units, NumbersDoNotDependOnTheirSpelling) {
  EXPECT_EQ(si("0.1", "1"), 0.1);
  EXPECT_EQ(si("100000000000000000000000e-24", "1"), 0.1);
  EXPECT_EQ(si("1.7976931348623157e308", "1"), std::numeric_limits<double>::max());
  EXPECT_EQ(si("5e-324", "1"), std::numeric_limits<double>::denorm_min());
}

TEST(Units, RefusesWhatIsNoNumber) {
  EXPECT_EQ(why_not("", "m"), "an empty text");
  EXPECT_EQ(why_not("   ", "m"), "an empty text");
  for (const char* text : {"nan", "NaN m", "inf", "-inf m", "Infinity", "m", "abc", "+", "-", ".", "+-3", "--3", "e5", "\u0663 m"})
    EXPECT_EQ(why_not(text, "m"), "\"" + std::string(text) + "\"");
}

TEST(Units, RefusesNumbersBeyondTheRange) {
  for (const char* text : {"1e400", "-1e400 m", "1e-400 m", "1e308 km", "5e-324 mm"})
    EXPECT_EQ(why_not(text, "m"), "\"" + std::string(text) + "\" (beyond the range of numbers)");
}

TEST(Units, RefusesTrailingTextAndFactorsInsideUnits) {
  EXPECT_EQ(why_not("3 m x", "m"), "\"3 m x\" (unknown unit \"m x\")");
  EXPECT_EQ(why_not("1,5 m", "m"), "\"1,5 m\" (use a decimal point, not a comma)");
  EXPECT_EQ(why_not("1,5", "m"), "\"1,5\" (use a decimal point, not a comma)");
  EXPECT_EQ(why_not("5 10 m", "m"), "\"5 10 m\" (a number inside the unit)");
  EXPECT_EQ(why_not("1.5.2", "m"), "\"1.5.2\" (a number inside the unit)");
  EXPECT_EQ(why_not("2 m 3", "m"), "\"2 m 3\" (a number inside the unit)");   // UDUNITS: 6 m
  EXPECT_EQ(why_not("2 m^0.5", "m"), "\"2 m^0.5\" (a unit to the power 0)");  // UDUNITS: 10
  EXPECT_EQ(why_not("0x10", "1"), "\"0x10\" (unknown unit \"x10\")");
  EXPECT_EQ(why_not("3 - 2", "1"), "\"3 - 2\" (a number inside the unit)");
  EXPECT_EQ(why_not("3 - m", "m"), "\"3 - m\" (not a unit after the number)");
  EXPECT_EQ(why_not("3 m\ns", "m"), "\"3 m\\ns\" (no unit has the character \"\\n\")");
  EXPECT_EQ(why_not("3 m;", "m"), "\"3 m;\" (no unit has the character \";\")");
  EXPECT_EQ(why_not("3 m @ 5", "m"), "\"3 m @ 5\" (a unit with an origin)");
  EXPECT_EQ(why_not("20 degC", "K"), "\"20 degC\" (a unit with an origin)");
  EXPECT_EQ(why_not("3 m since 2000", "m"), "\"3 m since 2000\" (a number inside the unit)");
  EXPECT_EQ(why_not("3 s since now", "s").find("3 s since now"), 1u);
  EXPECT_EQ(why_not("3 " + std::string(1000, 'm'), "m"), "\"3 " + std::string(58, 'm') + "...\" (a unit that is too long)");
}

TEST(Units, NamesBothDimensions) {
  EXPECT_EQ(quantity_name("Pa"), "a pressure [Pa]");
  EXPECT_EQ(why_not("3 m", "Pa"), "\"3 m\" (a length)");
  EXPECT_EQ(why_not("3 MPa", "m"), "\"3 MPa\" (a pressure)");
  EXPECT_EQ(why_not("3 kN/m", "N"), "\"3 kN/m\" (a force per length)");
  EXPECT_EQ(why_not("3 s", "1"), "\"3 s\" (a time)");
  EXPECT_EQ(why_not("3 %", "m"), "\"3 %\" (a number)");
  EXPECT_EQ(why_not("3 kg s3", "m"), "\"3 kg s3\" (kg.s3)");
  EXPECT_EQ(quantity_name("1"), "a number");
  EXPECT_EQ(quantity_name("kg s3"), "a number [kg s3]");
}

TEST(Units, NamesAUnitThatWasPerhapsMeant) {
  const Quantity quantity = parse_quantity("3 MPaa", "Pa");
  EXPECT_EQ(quantity.found, "\"3 MPaa\" (unknown unit \"MPaa\")");
  EXPECT_EQ(quantity.nearest, "MPa");
  EXPECT_EQ(parse_quantity("3 KN", "N").nearest, "kN");
  EXPECT_EQ(parse_quantity("3 hz", "Hz").nearest, "Hz");
  EXPECT_EQ(parse_quantity("3 wibble", "Hz").nearest, "");
}

TEST(Units, GravityIsNotTheGram) {
  EXPECT_EQ(si("1 g_n", "m/s2"), 9.80665);
  EXPECT_NEAR(si("2 kN/g_n", "kg"), 2000 / 9.80665, 1e-12);
  EXPECT_EQ(why_not("40 tons", "kg"), "\"40 tons\" (a ton is 907, 1000 or 1016 kg; t is 1000 kg)");
  EXPECT_EQ(why_not("2 ton/m3", "kg/m3"), "\"2 ton/m3\" (a ton is 907, 1000 or 1016 kg; t is 1000 kg)");
  EXPECT_EQ(why_not("2 tonf/m3", "Pa/m"), "\"2 tonf/m3\" (a ton-force is 8.896, 9.807 or 9.964 kN; tf is 9.80665 kN)");
  EXPECT_EQ(why_not("5 kg/cm3", "Pa/m"), "\"5 kg/cm3\" (a density; the forces of kg, t and lb are kgf, tf and lbf)");
  EXPECT_EQ(why_not("5 t", "N"), "\"5 t\" (a mass; the forces of kg, t and lb are kgf, tf and lbf)");
  EXPECT_EQ(why_not("30 deg", "m/s2"), "\"30 deg\" (an angle)");
  EXPECT_EQ(why_not("3 %", "m/s2"), "\"3 %\" (a number)");
  EXPECT_EQ(why_not("3 s", "m/s"), "\"3 s\" (a time)");
  EXPECT_EQ(why_not("0.3 g", "m/s2"), "\"0.3 g\" (g is the gram; standard gravity is g_n)");
  EXPECT_EQ(why_not("0.3 g0", "m/s2"), "\"0.3 g0\" (g0 is the gram to the power 0; standard gravity is g_n)");
  EXPECT_EQ(why_not("0.3 g0", "1"), "\"0.3 g0\" (g0 is the gram to the power 0; standard gravity is g_n)");
  EXPECT_EQ(si("500 g", "kg"), 0.5);
  EXPECT_EQ(si("981 gal", "m/s2"), 9.81);
}

TEST(Units, AnglesAreNeitherRatiosNorHidden) {
  const double pi = std::numbers::pi;
  EXPECT_DOUBLE_EQ(si("180 deg", "rad"), pi);
  EXPECT_DOUBLE_EQ(si("180 degree", "rad"), pi);
  EXPECT_DOUBLE_EQ(si("180 \u00b0", "rad"), pi);
  EXPECT_EQ(si("2 rad", "rad"), 2);
  EXPECT_EQ(si("2 mm/m", "rad"), 0.002);
  EXPECT_EQ(why_not("30 deg", "1"), "\"30 deg\" (an angle)");  // not a friction coefficient
}

// UDUNITS converts 10 Hz to 10 rad/s.
TEST(Units, FrequenciesAreNotAngularVelocities) {
  const double pi = std::numbers::pi;
  EXPECT_EQ(si("10 1/s", "Hz"), 10);
  EXPECT_EQ(si("10 Hz", "1/s"), 10);
  EXPECT_EQ(si("10 s-1", "Hz"), 10);
  EXPECT_EQ(why_not("10 rad/s", "Hz"), "\"10 rad/s\" (an angular velocity)");
  EXPECT_EQ(why_not("10 Hz", "rad/s"), "\"10 Hz\" (a frequency)");
  EXPECT_EQ(why_not("600 rpm", "Hz"), "\"600 rpm\" (an angular velocity)");
  EXPECT_NEAR(si("600 rpm", "rad/s"), 20 * pi, 1e-12);
  EXPECT_NEAR(si("90 deg/s", "rad/s"), pi / 2, 1e-15);
  EXPECT_EQ(why_not("1 s-2", "rad/s2").find("\"1 s-2\""), 0u);
}

// UDUNITS converts 10 s to 0.1 Hz.
TEST(Units, ReciprocalsAreOtherDimensions) {
  EXPECT_EQ(why_not("10 s", "Hz"), "\"10 s\" (a time)");
  EXPECT_EQ(why_not("10 Hz", "s"), "\"10 Hz\" (a frequency)");
  EXPECT_EQ(why_not("10 m", "1/m"), "\"10 m\" (a length)");
  EXPECT_TRUE(std::isnan(udunits_factor("s", "Hz")));
}

TEST(Units, TheRadianOfARotationalStiffnessMayBeLeftOut) {
  EXPECT_EQ(si("2 MN m/rad", "N m/rad"), 2e6);
  EXPECT_EQ(si("2 MN m", "N m/rad"), 2e6);
  EXPECT_NEAR(si("1 kN m/deg", "N m/rad"), 180000 / std::numbers::pi, 1e-9);
  EXPECT_EQ(why_not("2 N m/rad", "N m"), "\"2 N m/rad\" (a rotational stiffness)");
}

TEST(Units, ManyThreadsMayAsk) {
  std::vector<std::thread> threads;
  std::vector<int> wrong(4);
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([t, &wrong] {
      for (int i = 0; i < 200; ++i) wrong[t] += parse_quantity("2 kN/cm^2", "Pa").value != 2e7;
    });
  for (std::thread& thread : threads) thread.join();
  for (const int count : wrong) EXPECT_EQ(count, 0);
}

}  // namespace
}  // namespace uplift::units_test
